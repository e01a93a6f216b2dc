#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/vehicle_read.h"

namespace railstep {
namespace {

/// A body by its name, or the ground.
int acted_on(const Table& t, const Runner& runner, const std::string& name) {
  std::vector<std::string> names = body_names(runner);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  if (name == kGroundName) return kGround;
  names.emplace_back(kGroundName);
  t.refuse("between", "E-VEHICLE-38",
           fmt::format("\"{}\" is not a body of the vehicle; expected one of {}", name,
                       fmt::join(names, ", ")));
}

}  // namespace

RunnerForceElement read_actuator(const Table& t, const Runner& runner,
                                 std::vector<InputScene>& inputs) {
  RunnerForceElement e{};
  e.name = checked_name(t, "name", t.string("name"));
  read_direction(t, e);
  const bool about = e.along == RunnerForceElement::Along::about_axis,
             damps = t.has("acts") && t.choice("acts", {"force", "damping"}) == 1;
  e.law = damps ? ElementLaw::controlled : ElementLaw::actuator;
  if (t.has("input") && t.has("table"))
    t.refuse("table", "E-RUNNER-25", "table is given beside input; expected one of them");
  if (t.has("input"))
    e.input = read_input(t,
                         damps   ? about ? "damping_n_m_s_per_rad" : "damping_n_s_per_m"
                         : about ? "moment_n_m"
                                 : "force_n",
                         inputs);
  else
    e.value = read_time_table(t, "table", damps ? between(0.0, 1e12) : between(-1e12, 1e12));
  const std::vector<std::string> names = t.strings("between", 2, 2);
  if (names.size() != 2) t.end_part();
  e.a = acted_on(t, runner, names[0]);
  e.b = acted_on(t, runner, names[1]);
  if (e.a == e.b)
    t.refuse("between", "E-VEHICLE-39",
             "an actuator lies between a body and itself; expected two bodies, or a body and "
             "\"ground\"");
  return e;
}

}  // namespace railstep
