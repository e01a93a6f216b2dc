#pragma once
#include <string>

#include "answer/creep_curves.h"

namespace railstep {

/// One self-contained HTML page: the forces of all laws over each normalised creepage. Throws
/// Failed where gnuplot fails.
std::string creep_page(const CreepRequest& request);

}  // namespace railstep
