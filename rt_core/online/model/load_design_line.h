#pragma once
#include "online/model/model.h"

namespace railstep {

/// Whether the tables of a design line that was read from a block rise and are in range.
bool design_line_is_valid(const DesignLine& line) noexcept;

/// Whether the tables of a runner's frames are there, if there is a design line, and in range.
bool frames_are_valid(const DesignLine& line, const RunnerModel& runner) noexcept;

}  // namespace railstep
