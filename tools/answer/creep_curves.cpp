#include "answer/creep_curves.h"

#include <fmt/core.h>

#include <charconv>

#include "text/message.h"

namespace railstep {

NamedLaw creep_law_of(const std::string& text) {
  if (text == "she") return {text, CreepLaw::she, 0};
  if (text == "linear") return {text, CreepLaw::linear, 0};
  if (text == "polach") return {text, CreepLaw::polach, 0};
  if (text == "fastsim") return {"fastsim:10", CreepLaw::fastsim, 10};
  int strips = 0;
  if (text.rfind("fastsim:", 0) == 0) {
    const char *first = text.data() + 8, *last = text.data() + text.size();
    const auto [end, error] = std::from_chars(first, last, strips);
    if (error == std::errc() && end == last && strips >= 1 && strips <= kMostStrips)
      return {text, CreepLaw::fastsim, strips};
  }
  throw InputError("E-CLI-17",
                   fmt::format("--law: '{}' is not a law; expected she, linear, polach, "
                               "or fastsim:N with 1 to {} strips",
                               text, kMostStrips));
}

CreepForce solve_creep(const CreepRequest& r, const NamedLaw& law) {
  CreepForce force =
      creep_force(law.law, law.strips, normalised_patch(r.ratio, kalker(r.ratio, r.poisson)),
                  normalised_creepages(r.x, r.e, r.p));
  force.x += 0.;  // no negative zero
  force.y += 0.;
  return force;
}

CreepCurves creep_curves(const CreepRequest& request, char over) {
  constexpr int kPoints = 200;
  constexpr double kLast = 4.;
  CreepCurves all{over, {}, {}};
  for (int i = 0; i <= kPoints; ++i) all.at.push_back(kLast * i / kPoints);
  for (const char* name : {"she", "fastsim:10", "fastsim:50", "polach", "linear"}) {
    CreepCurves::Curve curve{name, {}, {}};
    for (const double at : all.at) {
      CreepRequest own = request;
      (over == 'x' ? own.x : over == 'e' ? own.e : own.p) = at;
      const CreepForce force = solve_creep(own, creep_law_of(name));
      curve.x.push_back(force.x);
      curve.y.push_back(force.y);
    }
    all.curves.push_back(curve);
  }
  return all;
}

}  // namespace railstep
