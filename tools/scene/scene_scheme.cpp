#include <fmt/core.h>

#include "scene/scene_read.h"

namespace railstep {
namespace {

/// A key that only one scheme has. It is refused beside other schemes, where it would have no
/// effect.
double number_of(const Table& t, const char* key, bool in_use, const char* scheme,
                 const Range& accepted, double otherwise) {
  if (t.has(key) && !in_use)
    t.refuse(key, "E-STEP-01",
             fmt::format("{} has no effect with this scheme; expected scheme = \"{}\" beside it",
                         key, scheme));
  return t.number(key, accepted, otherwise);
}

}  // namespace

void read_scheme(const Table& t, double rho_inf, bool of_bodies, StepScene& s) {
  constexpr TimeScheme kSchemes[] = {TimeScheme::generalised_alpha, TimeScheme::backward_euler,
                                     TimeScheme::newmark, TimeScheme::hht, TimeScheme::tr_bdf2};
  constexpr TimeScheme kOfBodies[] = {TimeScheme::generalised_alpha, TimeScheme::backward_euler,
                                      TimeScheme::newmark, TimeScheme::hht,
                                      TimeScheme::energy_momentum};
  s.scheme =
      of_bodies
          ? kOfBodies[t.choice(
                "scheme",
                {"generalised-alpha", "backward-euler", "newmark", "hht", "energy-momentum"}, 0)]
          : kSchemes[t.choice(
                "scheme", {"generalised-alpha", "backward-euler", "newmark", "hht", "tr-bdf2"}, 0)];
  s.rho_inf = t.number("rho_inf", between(0.0, 1.0), rho_inf);
  const bool newmark = s.scheme == TimeScheme::newmark, hht = s.scheme == TimeScheme::hht;
  s.newmark_gamma = number_of(t, "newmark_gamma", newmark, "newmark", between(0.5, 1.0), 0.5);
  const double damped = 0.25 * (s.newmark_gamma + 0.5) * (s.newmark_gamma + 0.5);
  s.newmark_beta =
      number_of(t, "newmark_beta", newmark, "newmark", between(0.5 * s.newmark_gamma, 1.0), damped);
  s.hht_alpha = number_of(t, "hht_alpha", hht, "hht", between(-1.0 / 3.0, 0.0), -0.1);
}

void read_contact(const Table& root, Scene& scene) {
  const Table t = root.table("step");
  scene.step->mean_contact = t.choice("contact", {"penetration", "discrete-gradient"}, 0) == 1;
  if (!scene.step->mean_contact) return;
  if (!scene.condense.kind || *scene.condense.kind == ReductionKind::complex_modes)
    t.refuse("contact", "E-STEP-02",
             "contact = \"discrete-gradient\" keeps energy only where forces are held "
             "over a step; expected condense.kind = \"modal\", \"guyan\", \"irs\", "
             "\"craig-bampton\" or \"krylov\"");
}

}  // namespace railstep
