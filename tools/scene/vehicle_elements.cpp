#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/vehicle_read.h"

namespace railstep {
namespace {

/// A spring, a damper, both, or a damper in series with a spring, along a line.
RunnerElement read_line(const Table& t, bool stiff, bool damped, bool series) {
  RunnerElement e{};
  e.kind = RunnerElement::Kind::line;
  const auto [a, b] = read_points(t);
  e.point_a = a;
  e.point_b = b;
  if (stiff) e.stiffness[0] = t.number("stiffness_n_per_m", kStiffnessRange);
  if (damped) e.damping[0] = t.number("damping_n_s_per_m", kDampingRange);
  if (series) e.series[0] = t.number("series_stiffness_n_per_m", above_upto(0.0, 1e13));
  if (stiff) e.preload[0] = t.number("preload_n", kPreloadRange, 0.0);
  return e;
}

RunnerElement read_traction_rod(const Table& t) {
  RunnerElement e = read_line(t, true, false, false);
  e.damping[0] = t.number("damping_n_s_per_m", kDampingRange, 0.0);
  return e;
}

RunnerElement read_rigid_rod(const Table& t) {
  RunnerElement e = read_line(t, false, false, false);
  e.kind = RunnerElement::Kind::rod;
  e.preload[0] = t.number("preload_n", kPreloadRange, 0.0);
  return e;
}

RunnerElement read_bushing(const Table& t) {
  RunnerElement e{};
  e.kind = RunnerElement::Kind::mid_frame;
  e.point_a = e.point_b = three_numbers(t, "point_m", kPlaceRange);
  const Triple k = three_numbers(t, "stiffness_n_per_m", kStiffnessRange),
               c = three_numbers(t, "damping_n_s_per_m", kDampingRange, {}),
               turned = three_numbers(t, "stiffness_n_m_per_rad", kStiffnessRange, {}),
               rolled = three_numbers(t, "damping_n_m_s_per_rad", kDampingRange, {}),
               series = three_numbers(t, "series_stiffness_n_per_m", kStiffnessRange, {}),
               preload = three_numbers(t, "preload_n", kPreloadRange, {});
  e.stiffness = {k[0], k[1], k[2], turned[0], turned[1], turned[2]};
  e.damping = {c[0], c[1], c[2], rolled[0], rolled[1], rolled[2]};
  e.series = {series[0], series[1], series[2]};
  e.preload = {preload[0], preload[1], preload[2]};
  return e;
}

/// A coil, whose shear acts at its middle.
RunnerElement read_shear_spring(const Table& t) {
  RunnerElement e{};
  e.kind = RunnerElement::Kind::mid_frame;
  const auto [a, b] = read_points(t);
  for (std::size_t d = 0; d < 3; ++d) e.point_a[d] = e.point_b[d] = .5 * (a[d] + b[d]);
  const Triple k = three_numbers(t, "stiffness_n_per_m", kStiffnessRange),
               c = three_numbers(t, "damping_n_s_per_m", kDampingRange, {}),
               series = three_numbers(t, "series_stiffness_n_per_m", kStiffnessRange, {}),
               preload = three_numbers(t, "preload_n", kPreloadRange, {});
  const auto bending = t.has("bending_n_m_per_rad")
                           ? t.number_or_pair("bending_n_m_per_rad", kStiffnessRange)
                           : std::array<double, 2>{};
  e.stiffness = {k[0], k[1], k[2], bending[0], bending[1], 0.};
  e.damping = {c[0], c[1], c[2]};
  e.series = {series[0], series[1], series[2]};
  e.preload = {preload[0], preload[1], preload[2]};
  return e;
}

RunnerElement read_anti_roll_bar(const Table& t) {
  RunnerElement e{};
  e.kind = RunnerElement::Kind::mid_frame;  // where it acts does not matter
  e.stiffness[index_of(BodyMotion::roll)] = t.number("stiffness_n_m_per_rad", kStiffnessRange);
  return e;
}

/// A bag of air with a reservoir behind an orifice (Nishimura), about its pressure at rest. With
/// the bag's stiffness k1, the reservoir's k2 and that of its area k3 its force along z is
///   k3 d + k1 (d - w),  k1 (d - w) = k2 w + c w',
/// which is a spring k3 + k1 k2 / (k1 + k2) beside a damper in series with a spring.
RunnerElement read_air_spring(const Table& t) {
  constexpr double kAtmosphere = 101325.;  // Pa
  const Range volume = above_upto(0.0, 10.0);
  RunnerElement e{};
  e.kind = RunnerElement::Kind::mid_frame;
  e.point_a = e.point_b = three_numbers(t, "point_m", kPlaceRange);
  const double pressure = t.number("pressure_pa", above_upto(kAtmosphere, 1e8)),
               area = t.number("area_m2", above_upto(0.0, 10.0)),
               exponent = t.number("polytropic", between(1.0, 1.7), 1.4),
               rises = t.number("area_slope_m", between(0.0, 100.0), 0.0),
               shear = t.number("shear_n_per_m", kStiffnessRange);
  const double stiff = exponent * pressure * area * area, bag = stiff / t.number("bag_m3", volume);
  double z = (pressure - kAtmosphere) * rises, series = bag, damping = 0.;
  if (t.has("reservoir_m3")) {
    const double reservoir = stiff / t.number("reservoir_m3", volume),
                 part = bag / (bag + reservoir);
    z += reservoir * part;
    series = bag * part;
    damping = t.number("orifice_n_s_per_m", kDampingRange) * part * part;
  } else {
    z += bag;
    series = 0.;
  }
  e.stiffness = {shear, shear, z};
  e.series[2] = damping > 0. ? series : 0.;
  e.damping[2] = damping;
  e.preload[2] = t.number("preload_n", kPreloadRange, 0.0);
  return e;
}

std::vector<RunnerPart> alone(const RunnerForceElement& element) { return {{element}}; }
/// A linear element, which is in the trace if the file says so.
std::vector<RunnerPart> linear(const Table& t, RunnerElement element) {
  element.traced = t.boolean("trace", false);
  return {{element}};
}

/// A function for each type of element, in the order of the names in read_runner_parts().
using ReadParts = std::vector<RunnerPart> (*)(const Table& t);
constexpr ReadParts kReadParts[] = {
    [](const Table& t) { return linear(t, read_line(t, true, false, false)); },
    [](const Table& t) { return linear(t, read_line(t, false, true, false)); },
    [](const Table& t) { return linear(t, read_line(t, true, true, false)); },
    [](const Table& t) { return linear(t, read_line(t, false, true, true)); },
    [](const Table& t) { return linear(t, read_traction_rod(t)); },
    [](const Table& t) { return linear(t, read_bushing(t)); },
    [](const Table& t) { return linear(t, read_shear_spring(t)); },
    [](const Table& t) { return linear(t, read_anti_roll_bar(t)); },
    [](const Table& t) { return alone(read_bump_stop(t)); },
    [](const Table& t) { return std::vector<RunnerPart>{{read_rigid_rod(t)}}; },
    [](const Table& t) { return linear(t, read_air_spring(t)); },
    [](const Table& t) { return alone(read_nonlinear_damper(t)); },
    [](const Table& t) { return std::vector<RunnerPart>{read_friction(t)}; },
    read_support,
    read_side_bearer,
    read_centre_plate};
/// The same curve seen from the other direction.
void reverse(RunnerForceElement& e) {
  std::reverse(e.curve.begin(), e.curve.end());
  for (std::size_t i = 0; i + 1 < e.curve.size(); i += 2) {
    std::swap(e.curve[i], e.curve[i + 1]);
    for (const std::size_t k : {i, i + 1}) e.curve[k] = e.curve[k] == 0. ? 0. : -e.curve[k];
  }
  std::swap(e.slope_before, e.slope_behind);
}
bool is_along(const RunnerForceElement& e, int axis) {
  return e.along == RunnerForceElement::Along::axis && e.axis == axis;
}
bool is_about(const RunnerForceElement& e, int axis) {
  return e.along == RunnerForceElement::Along::about_axis && e.axis == axis;
}

RunnerElement mirrored(RunnerElement e) {
  e.point_a[1] = -e.point_a[1];
  e.point_b[1] = -e.point_b[1];
  if (e.kind == RunnerElement::Kind::mid_frame) e.preload[1] = -e.preload[1];
  return e;
}
RunnerForceElement mirrored(RunnerForceElement e) {
  e.point_a[1] = -e.point_a[1];
  e.point_b[1] = -e.point_b[1];
  if (is_along(e, 1) || is_about(e, 0) || is_about(e, 2)) reverse(e);
  return e;
}

RunnerElement placed(RunnerElement e, const BogiePlace& place) {
  e.point_a = place.at(e.point_a);
  e.point_b = place.at(e.point_b);
  if (place.turned && e.kind == RunnerElement::Kind::mid_frame)
    for (const std::size_t d : {0u, 1u}) e.preload[d] = -e.preload[d];
  return e;
}
RunnerForceElement placed(RunnerForceElement e, const BogiePlace& place) {
  e.point_a = place.at(e.point_a);
  e.point_b = place.at(e.point_b);
  const bool level = is_along(e, 0) || is_along(e, 1) || is_about(e, 0) || is_about(e, 1);
  if (place.turned && level) reverse(e);
  return e;
}

/// Place across the vehicle at which an element acts, m.
template <typename Element>
double side_of(const Element& e) {
  return e.point_a[1] != 0. ? e.point_a[1] : e.point_b[1];
}

}  // namespace

std::vector<RunnerPart> read_runner_parts(const Table& t) {
  return kReadParts[t.choice(
      "type", {"spring", "damper", "spring_damper", "maxwell", "traction_rod", "bushing",
               "shear_spring", "anti_roll_bar", "bump_stop", "rigid_rod", "air_spring",
               "nonlinear_damper", "friction", "support", "side_bearer", "centre_plate"})](t);
}

RunnerPart placed(RunnerPart part, const BogiePlace& place) {
  std::visit([&](auto& own) { own = placed(own, place); }, part.of);
  return part;
}

void add_mirrored(const Table& t, const RunnerPart& part,
                  const std::function<void(const RunnerPart&, const std::string&)>& add) {
  const double y = std::visit([](const auto& own) { return side_of(own); }, part.of);
  if (y == 0.)
    t.refuse("mirror", "E-VEHICLE-22",
             "mirror = true, but the element lies in the middle of the vehicle; expected a point "
             "with y other than 0, or no mirror");
  RunnerPart other = part;
  std::visit([](auto& own) { own = mirrored(own); }, other.of);
  add(part, y > 0. ? "_left" : "_right");
  add(other, y > 0. ? "_right" : "_left");
}

void RunnerParts::add_part(const RunnerPart& part, const PartNames& names,
                           std::vector<std::string> pressers) {
  if (const auto* linear = std::get_if<RunnerElement>(&part.of)) {
    RunnerElement& own = runner_.elements.emplace_back(*linear);
    own.name = names.name + part.suffix;
    own.a = names.a;
    own.b = names.b;
    return;
  }
  if (!part.pressed_by.empty())
    pressed_.push_back({runner_.force_elements.size(), part.pressed_by, std::move(pressers)});
  RunnerForceElement& own =
      runner_.force_elements.emplace_back(std::get<RunnerForceElement>(part.of));
  own.name = names.name + part.suffix;
  own.a = names.a;
  own.b = names.b;
}

/// Whether an element has a force along z, or along its line, that follows its deflection.
bool can_press(const RunnerElement& e) {
  return e.kind == RunnerElement::Kind::mid_frame ? e.stiffness[2] > 0.
         : e.kind == RunnerElement::Kind::line    ? e.stiffness[0] > 0.
                                                  : false;
}

void RunnerParts::find_pressers(const Table& t, const std::string& key) {
  for (const Part& part : pressed_) {
    RunnerForceElement& pressed = runner_.force_elements[part.element];
    for (const std::string& wanted : part.pressers) {
      int found = 0;
      for (std::size_t i = first_; i < runner_.elements.size(); ++i) {
        if (runner_.elements[i].name != wanted || !can_press(runner_.elements[i])) continue;
        pressed.pressed_by = static_cast<int>(i);
        ++found;
      }
      if (found == 1) break;
      pressed.pressed_by = -1;
      if (found > 1) break;
    }
    if (pressed.pressed_by < 0)
      t.refuse(key, "E-VEHICLE-34",
               fmt::format("normal = \"{}\" of element {} is not one element with a stiffness "
                           "along z or along its line; expected the name of one spring, bushing, "
                           "shear_spring, air_spring or support",
                           part.by, pressed.name));
  }
}

}  // namespace railstep
