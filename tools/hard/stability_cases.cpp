#include <fmt/core.h>

#include <algorithm>

#include "hard/hard_run.h"
#include "hard/step_stability.h"

namespace railstep {
namespace {

// H49 ------------------------------------------------------------------------------------------

HardCheck largest_growth(const std::vector<Growth>& map) {
  const Growth& worst = *std::max_element(
      map.begin(), map.end(), [](const Growth& a, const Growth& b) { return a.factor < b.factor; });
  return {fmt::format("{}: growth of a step, over 1, at most at {:g} s, {:g} N/m, {:g} kg",
                      worst.way->name, worst.step, worst.pad, worst.mass),
          worst.factor - 1., worst.way->bound};
}

/// Growth over the step, for a wheel of 600 kg on pads of 1e8 N/m.
HardCurve over_steps(const std::vector<Growth>& map) {
  HardCurve curve{map.front().way->name, {}, {}};
  for (const Growth& at : map) {
    if (at.pad != 1e8 || at.mass != 600.) continue;
    curve.x.push_back(at.step);
    curve.y.push_back(at.factor);
  }
  return curve;
}

/// Parameters outside of the schemes that are stable at every step.
HardCheck refused(const std::filesystem::path& scene, const char* scheme, const char* key,
                  double value) {
  const std::string said = refusal(
      scene, {fmt::format("step.scheme=\"{}\"", scheme), fmt::format("step.{}={}", key, value)});
  return holds(fmt::format("{} = {:g} is refused", key, value),
               said.find(key) != std::string::npos && said.find("E-KEY-05") != std::string::npos);
}

HardResult stability(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"step, s", "largest growth factor of a step", {}, true, false};
  for (const SteppedWay& way : stepped_ways()) {
    const std::vector<Growth> map = stability_map(scene, way);
    result.checks.push_back(largest_growth(map));
    result.picture.curves.push_back(over_steps(map));
  }
  result.checks.push_back(refused(scene, "newmark", "newmark_gamma", .4));
  result.checks.push_back(refused(scene, "newmark", "newmark_beta", .2));
  result.checks.push_back(refused(scene, "hht", "hht_alpha", -.4));
  result.checks.push_back(refused(scene, "generalised-alpha", "rho_inf", 1.1));
  return result;
}

}  // namespace

std::vector<HardCase> stability_cases() {
  return {{"H49", "h49_stability", "The coupled step over step, pad stiffness and wheel mass",
           "Contact couples a light or heavy wheel to a soft or stiff track within the step.",
           "No reference: the spectral radius of the step's linear map. Where a scheme keeps all "
           "energy, roots on the unit circle are double, and rounding moves them by its root.",
           stability}};
}

}  // namespace railstep
