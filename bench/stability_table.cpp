// Largest growth factor of the coupled step over step size, pad stiffness, wheel mass and scheme,
// as CSV for docs/make-stability-figure.
#include <cstdio>
#include <exception>

#include "hard/step_stability.h"

int main() try {
  using namespace railstep;
  std::puts("scheme,step_s,pad_n_per_m,wheel_kg,growth_less_1");
  for (const SteppedWay& way : stepped_ways())
    for (const Growth& at : stability_map(RAILSTEP_SOURCE "/config/hard/h49_stability.toml", way))
      std::printf("\"%s\",%g,%g,%g,%.3e\n", way.name, at.step, at.pad, at.mass, at.factor - 1.);
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 1;
}
