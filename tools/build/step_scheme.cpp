#include "build/step_scheme.h"

#include <fmt/core.h>

#include "offline/system/pack_system.h"

namespace railstep {

Scheme scheme_of(const StepScene& step) {
  switch (step.scheme) {
    case TimeScheme::backward_euler:
      return backward_euler(step.dt);
    case TimeScheme::newmark:
      return newmark(step.dt, step.newmark_gamma, step.newmark_beta);
    case TimeScheme::hht:
      return hilber_hughes_taylor(step.dt, step.hht_alpha);
    case TimeScheme::tr_bdf2:
      return tr_bdf2(step.dt);
    case TimeScheme::energy_momentum:
      return energy_momentum(step.dt);
    case TimeScheme::generalised_alpha:
      break;
  }
  return generalised_alpha(step.dt, step.rho_inf);
}

Scheme held_scheme_of(const StepScene& step) {
  return step.mean_contact ? held_mean_force(step.dt) : held_force(step.dt, step.rho_inf);
}

std::string held_scheme_text(const StepScene& step) {
  return step.mean_contact
             ? "exact under forces held over a step, contact by the discrete gradient"
             : fmt::format("exact under forces held over a step, rho_inf {:g}", step.rho_inf);
}

std::string scheme_text(const StepScene& step) {
  switch (step.scheme) {
    case TimeScheme::backward_euler:
      return "backward Euler";
    case TimeScheme::newmark:
      return fmt::format("Newmark, gamma {:g}, beta {:g}", step.newmark_gamma, step.newmark_beta);
    case TimeScheme::hht:
      return fmt::format("Hilber-Hughes-Taylor, alpha {:g}", step.hht_alpha);
    case TimeScheme::tr_bdf2:
      return "TR-BDF2";
    case TimeScheme::energy_momentum:
      return "energy-momentum";
    case TimeScheme::generalised_alpha:
      break;
  }
  return fmt::format("generalised-alpha, rho_inf {:g}", step.rho_inf);
}

}  // namespace railstep
