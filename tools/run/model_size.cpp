#include "run/model_size.h"

#include "offline/track/assembly.h"

namespace railstep {

std::pair<int, int> unknowns_of(const Track& track, const PackedModel& packed) {
  int full = 0, kept = 0;
  for (const Line& line : assemble(track)) full += line.unknowns();
  for (const PackedLine& own : packed.lines())
    kept += packed.model().form == Form::condensed ? kept_coordinates(own.basis, own.modes)
                                                   : own.line.unknowns();
  return {full, kept};
}

}  // namespace railstep
