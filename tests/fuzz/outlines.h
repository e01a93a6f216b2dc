#pragma once
#include "section/profile.h"

namespace railstep::fuzz {

/// What holds of every outline that was accepted: finite properties, a polygon that has its area.
/// A small one is fitted, and its section written and read again.
void check_outline(const Profile& profile);

}  // namespace railstep::fuzz
