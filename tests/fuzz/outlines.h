#pragma once
#include "section/profile.h"

namespace railstep::fuzz {

/// Checks an accepted outline: its properties are finite and its polygon has its area. A small one
/// is fitted, and its section is written and read again.
void check_outline(const Profile& profile);

}  // namespace railstep::fuzz
