#include "offline/condense/free_mode.h"

#include <stdexcept>

#include "offline/track/statics.h"

namespace railstep {

void refuse_free_mode(const Line& line, double lowest_hz) {
  constexpr double kLeastHz = 1e-3;  // below it a mode is rigid
  if (lowest_hz >= kLeastHz) return;
  refuse_free_modes(line);
  throw std::invalid_argument(
      "a condensed track is held in every direction in which it is moved: this one has a free "
      "rigid mode");
}

}  // namespace railstep
