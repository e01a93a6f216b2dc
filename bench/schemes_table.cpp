// The time schemes, as CSV for docs/make-schemes-figure:
//   schemes_table stiff    errors on reference.md's stiff track
//   schemes_table radius   spectral radius of the coupled step of a wheel over pads, the largest of
//                          a seat and mid-bay
#include <cstdio>
#include <string>

#include "support/contact_step.h"
#include "support/stiff_track.h"

using namespace railstep;

namespace {

void print_stiff() {
  const StiffTrace reference = stiff_exponential(1e-5);
  std::printf("scheme,dt_s,height,force\n");
  const auto row = [&](const char* name, double dt, const StiffTrace& trace) {
    const StiffError found = stiff_error(trace, reference);
    std::printf("%s,%g,%.3e,%.3e\n", name, dt, found.height, found.force);
    std::fflush(stdout);
  };
  for (const double dt : {1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6, 2e-6}) {
    for (const NamedScheme& own : named_schemes())
      row(own.name.c_str(), dt, stiff_trace(own.scheme(dt)));
    if (dt > 1.5e-5) row("exponential", dt, stiff_exponential(dt));
  }
}

void print_radius() {
  std::printf("scheme,stiffness_n_per_m,damping_n_s_per_m,dt_s,radius_less_1\n");
  for (const double stiffness : {1e7, 3e7, 1e8, 3e8, 1e9})
    for (const double damping : {0., 3e4, 3e5})
      for (const double dt : {1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2}) {
        const auto row = [&](const std::string& name, const PackOptions& options) {
          double radius = 0.;
          for (const bool over_seat : {false, true})
            radius = std::max(
                radius, spectral_radius(contact_step({stiffness, damping, over_seat}, options)));
          std::printf("%s,%g,%g,%g,%.3e\n", name.c_str(), stiffness, damping, dt, radius - 1.);
        };
        for (const NamedScheme& own : named_schemes()) row(own.name, full_contact(own.scheme(dt)));
        row("held 0.6", held_contact(dt, .6));
        row("held 1", held_contact(dt, 1.));
        std::fflush(stdout);
      }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "stiff") print_stiff();
  if (what == "radius") print_radius();
  return what == "stiff" || what == "radius" ? 0 : 2;
}
