#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "hard/contact_checks.h"
#include "offline/math/constants.h"

namespace railstep {
namespace {

// H15 ------------------------------------------------------------------------------------------

/// Midspan deflection of a beam under a mass that comes over it, known by another way.
struct KnownCrossing {
  const char* name;
  std::vector<std::string> overrides;
  double length, speed, before;     // m, m/s; m from the mass to the beam at the start
  double largest, at;               // m; over the time of the crossing, 0: not known
  std::vector<double> at_quarters;  // m, of the way
};

/// Yang and Yau's bridge of 25 m: E I = 8.323e9 N m2 without shear, as E 1e13 and A 1 leave it.
std::vector<std::string> bridge() {
  std::string mass = "vehicle=[{name=\"mass\",type=\"sprung_mass\",mass_kg=5750.0,";
  mass += "stiffness_n_per_m=1595e3,start_m=-1.0,speed_m_per_s=27.77777777777778,";
  mass += "may_leave_rail=true}]";
  return {"track.bays=10",
          "track.bay_m=2.5",
          "track.elements_per_bay=2",
          "rail.young_pa=1e13",
          "rail.density_kg_per_m3=2303.0",
          "rail.constants.area_m2=1.0",
          "rail.constants.inertia_y_m4=8.323e-4",
          "rail.constants.shear_factor_z=1.2",
          mass,
          "sensor[0].position_m=12.5",
          "step.dt_s=2e-4",
          "step.duration_s=0.93"};
}

std::vector<KnownCrossing> known_crossings() {
  const std::vector<std::string> fast = {"vehicle[0].speed_m_per_s=100.0", "step.dt_s=1e-5",
                                         "step.duration_s=0.066"};
  return {{"R4, 30 m/s", {}, 6., 30., .6, 1.11880e-3, .357, {9.2547e-4, 1.0686e-3, 9.3573e-4}},
          {"R4, 100 m/s", fast, 6., 100., .6, 2.3461e-3, .913, {1.868e-4, 9.966e-4, 1.9469e-3}},
          {"Yang and Yau", bridge(), 25., 100. / 3.6, 1., 2.4073e-3, .4123, {}}};
}

HardResult moving_mass(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"part of the way", "midspan, down, mm", {}};
  for (const KnownCrossing& known : known_crossings()) {
    const HardRun run(scene, known.overrides);
    const std::string at = known.name + std::string(": ");
    HardCurve curve = run.curve("midspan.dz_m", known.name, -1.);
    for (double& t : curve.x) t = (t * known.speed - known.before) / known.length;
    const auto top = std::max_element(curve.y.begin(), curve.y.end());
    result.checks.push_back(off_by(at + "largest deflection", *top, known.largest, 5e-4));
    result.checks.push_back(apart_by(at + "where, of the way",
                                     curve.x[static_cast<std::size_t>(top - curve.y.begin())],
                                     known.at, 1e-3));
    for (std::size_t i = 0; i < known.at_quarters.size(); ++i) {
      const double way = .25 * static_cast<double>(i + 1);
      const double time = (way * known.length + known.before) / known.speed;
      result.checks.push_back(
          {fmt::format("{}deflection at {} of the way, over the largest", at, way),
           std::abs(-run.at(time, "midspan.dz_m") - known.at_quarters[i]) / known.largest, 5e-4});
    }
    result.checks.push_back(holds(at + "no status bit", run.status().empty()));
    for (double& w : curve.y) w *= 1e3;
    result.picture.curves.push_back(std::move(curve));
    result.picture.curves.push_back(
        {known.name + std::string(", known"), {known.at}, {1e3 * known.largest}, true});
    result.frame_us = run.frame_us();
  }
  return result;
}

// H16 ------------------------------------------------------------------------------------------

HardResult rail_end(const std::filesystem::path& scene) {
  const HardRun leaves(scene);
  const std::vector<double> x = leaves.column("axle.x_m"), left = leaves.column("left.force_z_n"),
                            right = leaves.column("right.force_z_n");
  double pressed = 0.;  // the most behind the rail's end
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i] > 4.8 + 1e-9) pressed = std::max({pressed, left[i], right[i]});
  const double fall = leaves.at(.1, "axle.vz_m_per_s") - leaves.at(.06, "axle.vz_m_per_s");
  HardResult result;
  result.checks = {
      holds("leaves: it says so", leaves.status() == "off_rail contact_lost"),
      holds("leaves: all finite", all_finite(leaves)),
      {"leaves: force behind the end, N", pressed, 0.},
      off_by("leaves: it falls by g from then on", fall, -.04 * kGravity, 1e-9),
      {"leaves: the rail's end is at rest again, over what it was",
       std::abs(leaves.last("end.dz_m")) / largest_size(leaves.column("end.dz_m")), 1e-3}};
  const HardRun off(scene, {"wheelset[0].start_m=5.0", "step.start=\"released\""});
  result.checks.push_back(holds("starts off: it says so", off.status() == "off_rail contact_lost"));
  result.checks.push_back({"starts off: force, N", largest_size(off.column("left.force_z_n")), 0.});
  result.checks.push_back(
      {"starts off: the rail moves, m", largest_size(off.column("end.dz_m")), 0.});
  // A vehicle does not fall, but rolls on level ground. The rail's end lies lower, a step up that
  // throws it: its momentum tells that the ground carries it.
  std::string mass = "vehicle=[{name=\"left\",rail=\"left\",type=\"mass\",mass_kg=600.0,";
  mass += "contact=\"hertz\",start_m=-1.0,speed_m_per_s=20.0,may_leave_rail=true}]";
  const HardRun rolls(scene, {"wheelset=[]", "step.duration_s=0.4", mass,
                              "sensor=[{name=\"centre\",on=\"vehicle\",vehicle=\"left\"}]"});
  for (const double time : {0., .04})
    result.checks.push_back(off_by(fmt::format("a vehicle before the rail, {} s: force", time),
                                   rolls.at(time, "left.wheel_1.force_z_n"), 600. * kGravity,
                                   1e-9));
  const std::vector<double> impulse = rolls.column("left.wheel_1.impulse_z_n_s");
  const double weight = 600. * kGravity * .4;
  result.checks.push_back(
      {"a vehicle: momentum less impulses, over its weight's",
       std::abs(std::accumulate(impulse.begin(), impulse.end(), -weight) -
                600. * (rolls.last("centre.vz_m_per_s") - rolls.first("centre.vz_m_per_s"))) /
           weight,
       1e-3});
  result.checks.push_back(holds("a vehicle: all finite", all_finite(rolls)));
  result.picture = {"time, s",
                    "wheel-rail force, kN",
                    {leaves.curve("left.force_z_n", "a wheelset leaves the rail", 1e-3),
                     rolls.curve("left.wheel_1.force_z_n", "a vehicle rolls on and off", 1e-3)}};
  result.frame_us = leaves.frame_us();
  return result;
}

// H17 ------------------------------------------------------------------------------------------

/// A wheel alone.
HardRun alone(const std::filesystem::path& scene, const char* name, double mass, double start,
              double speed = 0.) {
  return HardRun(scene, {fmt::format("vehicle=[{{name=\"{}\",type=\"mass\",contact=\"hertz\","
                                     "mass_kg={:.1f},start_m={},speed_m_per_s={:.1f}}}]",
                                     name, mass, start, speed)});
}

HardResult one_element(const std::filesystem::path& scene) {
  const HardRun both(scene), rear = alone(scene, "rear", 5000., 3.2),
                             front = alone(scene, "front", 6000., 3.4);
  HardResult result;
  for (const char* place : {"left_of_both", "between", "right_of_both"}) {
    const std::string column = place + std::string(".dz_m");
    const double sum = rear.first(column) + front.first(column);
    result.checks.push_back(off_by(fmt::format("deflection {}: the sum of each alone", place),
                                   both.first(column), sum, 1e-12));
    result.checks.push_back(
        off_by(fmt::format("deflection {} after 500 steps", place), both.last(column), sum, 1e-12));
  }
  for (const auto& [name, mass] : {std::pair{"rear", 5000.}, {"front", 6000.}})
    result.checks.push_back(off_by(fmt::format("force of the {} wheel after 500 steps", name),
                                   both.last(name + std::string(".wheel_1.force_z_n")),
                                   mass * kGravity, 1e-12));
  const std::vector<std::string> move = {"vehicle[0].speed_m_per_s=30.0",
                                         "vehicle[1].speed_m_per_s=30.0", "step.dt_s=5e-5"};
  const HardRun moving(scene, move);
  check_energy(result, moving, "at 30 m/s: ", 1e-3, 1e-5);
  result.checks.push_back(holds("at 30 m/s: no status bit", moving.status().empty()));
  result.picture = {"time, s",
                    "force at 30 m/s, kN",
                    {moving.curve("rear.wheel_1.force_z_n", "rear, 5 t", 1e-3),
                     moving.curve("front.wheel_1.force_z_n", "front, 6 t", 1e-3)}};
  result.frame_us = both.frame_us();
  return result;
}

// H18 ------------------------------------------------------------------------------------------

/// Rounding of the forces of a run, over the largest. A step rounds each term of K u of the rail by
/// 2^-53: a mid node has (8 + 16 + 8)/3 k G A / L, L of an element, times a deflection of 0.5 mm.
/// This is 1e-14 of the wheel's force; 600 steps add up to 600 times that.
constexpr double kRoundedSteps = 600. * 0x1p-53 * 32. / 3. * 2.5e8 / .3 * .5e-3 / 49e3;

HardResult on_a_node(const std::filesystem::path& scene) {
  const char* const column = "wheel.wheel_1.force_z_n";
  const HardRun on(scene);
  const double before = std::nextafter(3., 0.), behind = std::nextafter(3., 4.);
  HardResult result;
  for (const double start : {before, behind}) {
    const HardRun beside(scene, {fmt::format("vehicle[0].start_m={:.17g}", start)});
    result.checks.push_back(
        {start < 3. ? "force, a unit in the last place before" : "force, one behind",
         largest_gap(beside.column(column), on.column(column)) / on.largest(column),
         kRoundedSteps});
  }
  result.checks.push_back(holds("no status bit", on.status().empty()));
  result.checks.push_back({"force at rest on a node, over the weight",
                           std::abs(on.first(column) / (5000. * kGravity) - 1.), 1e-12});
  result.picture = {"time, s", "wheel-rail force, kN", {on.curve(column, "at 30 m/s", 1e-3)}};
  HardCurve nodes{"on a node", {}, {}, true};
  for (int step = 0; step <= 600; step += 50) {
    nodes.x.push_back(1e-4 * step);
    nodes.y.push_back(1e-3 * on.column(column).at(static_cast<std::size_t>(step)));
  }
  result.picture.curves.push_back(std::move(nodes));
  result.frame_us = on.frame_us();
  return result;
}

// H19 ------------------------------------------------------------------------------------------

HardResult cap_of_one(const std::filesystem::path& scene) {
  const HardRun capped(scene), free(scene, {"wheelset[0].guide.cap=20"});
  const std::vector<double>& violation = capped.record().violations;
  const auto largest_from = [&](std::size_t first, std::size_t last) {
    return *std::max_element(violation.begin() + static_cast<std::ptrdiff_t>(first),
                             violation.begin() + static_cast<std::ptrdiff_t>(last));
  };
  constexpr std::size_t kComes = 400, kGoes = 600;  // steps
  HardResult result;
  result.checks = {
      holds("it says that the cap was reached", capped.status() == "cap_reached"),
      holds("with 20 iterations there is nothing to say", free.status().empty()),
      holds("all finite", all_finite(capped)),
      // The distance by which the force moves a free wheelset in one step.
      {"way off the guide, m", largest_from(0, violation.size()), 1e7 / 1200. * 5e-5 * 5e-5},
      {"way off the guide before the force, m", largest_from(0, kComes), 1e-10},
      {"way off the guide two steps after it has come, m", largest_from(kComes + 3, kGoes), 1e-10},
      {"way off the guide two steps after it has gone, m",
       largest_from(kGoes + 3, violation.size()), 1e-10},
      {"wheel force less that with 20 iterations, over it",
       largest_gap(capped.column("left.force_z_n"), free.column("left.force_z_n")) /
           free.largest("left.force_z_n"),
       1e-6}};
  result.picture = {"time, s", "way off the guide, m", {}, false, true};
  for (const auto& [name, run] : {std::pair{"one iteration", &capped}, {"up to 20", &free}}) {
    HardCurve curve{name, {}, {}, true};
    for (std::size_t i = kComes - 20; i < kGoes + 20; ++i) {
      curve.x.push_back(run->time()[i]);
      curve.y.push_back(std::max(run->record().violations[i], 1e-18));  // of a logarithmic axis
    }
    result.picture.curves.push_back(std::move(curve));
  }
  result.frame_us = capped.frame_us();
  return result;
}

// H37 ------------------------------------------------------------------------------------------

HardResult backwards(const std::filesystem::path& scene) {
  const HardRun ahead(scene),
      back(scene, {"vehicle[0].start_m=18.0", "vehicle[0].speed_m_per_s=-40.0"});
  HardResult result;
  const std::pair<const char*, const char*> mirrored[] = {{"wheel_1", "wheel_2"},
                                                          {"wheel_2", "wheel_1"}};
  for (const auto& [wheel, image] : mirrored)
    for (const char* what : {"force_z_n", "rail_z_m"}) {
      const std::vector<double> a = ahead.column(fmt::format("bogie.{}.{}", wheel, what)),
                                b = back.column(fmt::format("bogie.{}.{}", image, what));
      result.checks.push_back(
          {fmt::format("{} of {} less its image's, over the largest", what, wheel),
           largest_gap(a, b) / largest_size(a), 1e-9});
    }
  const std::vector<double> pitch = ahead.column("bogie.frame.pitch_rad");
  std::vector<double> turned = back.column("bogie.frame.pitch_rad");
  for (double& p : turned) p = -p;
  result.checks.push_back({"pitch of the frame less its image's, over the largest",
                           largest_gap(pitch, turned) / largest_size(pitch), 1e-9});
  result.checks.push_back(holds("no status bit", ahead.status().empty() && back.status().empty()));
  result.picture = {"time, s",
                    "wheel-rail force, kN",
                    {ahead.curve("bogie.wheel_1.force_z_n", "first wheel at 40 m/s", 1e-3),
                     back.curve("bogie.wheel_2.force_z_n", "last wheel at -40 m/s", 1e-3)}};
  result.frame_us = ahead.frame_us();
  return result;
}

// H38 ------------------------------------------------------------------------------------------

/// A wheel of H38's on a linear contact.
std::string linear_wheel(const char* name, double start, double mass, double stiffness) {
  return fmt::format(
      "{{name=\"{}\",type=\"mass\",contact=\"linear\",contact_stiffness_n_per_m={:.1f},"
      "mass_kg={:.1f},start_m={:.6f},speed_m_per_s=30.0}}",
      name, stiffness, mass, start);
}

/// One wheel of both masses there, or two of half of it at both places: the sum of their forces.
std::vector<double> rolled(const std::filesystem::path& scene, const std::string& wheels) {
  const HardRun run(scene, {"vehicle=[" + wheels + "]", "condense.residual_flexibility=false"});
  std::vector<double> sum = run.column("first.wheel_1.force_z_n");
  if (wheels.find("second") == std::string::npos) return sum;
  const std::vector<double> second = run.column("second.wheel_1.force_z_n");
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += second[i];
  return sum;
}

HardResult one_micrometre(const std::filesystem::path& scene) {
  const HardRun two(scene);
  const HardRun one = alone(scene, "first", 6000., 6.1, 30.),
                other = alone(scene, "first", 6000., 6.100001, 30.);
  HardResult result;
  for (const char* wheel : {"first", "second"})
    result.checks.push_back(off_by(fmt::format("at rest: force of the {} wheel", wheel),
                                   two.first(wheel + std::string(".wheel_1.force_z_n")),
                                   3000. * kGravity, 1e-12));
  // Half the load stands 1 um on: deflections are the mean of those of the whole load at either
  // place.
  for (const char* place : {"rail.dz_m", "ahead.dz_m"})
    result.checks.push_back(off_by(std::string("at rest: ") + place, two.first(place),
                                   .5 * (one.first(place) + other.first(place)), 1e-12));
  const std::vector<double> a = two.column("first.wheel_1.force_z_n"),
                            b = two.column("second.wheel_1.force_z_n");
  // The second is where the first will be 33 ns later: 1e-3 of a step of 50 us, and 2e-3 of what
  // a force may change by in a step, a tenth of itself.
  result.checks.push_back({"at 30 m/s: the wheels' forces differ, over the largest",
                           largest_gap(a, b) / largest_size(a), 1e-4});
  result.checks.push_back(holds("at 30 m/s: no status bit", two.status().empty()));
  check_energy(result, two, "at 30 m/s: ", 1e-3, 1e-5);
  // Linear contacts: two wheels are the mean of one at either place but for the square of 1 um over
  // the waves' lengths, 0.1 m.
  const std::vector<double> rear = rolled(scene, linear_wheel("first", 6.1, 6e3, 2e9)),
                            front = rolled(scene, linear_wheel("first", 6.100001, 6e3, 2e9)),
                            both = rolled(scene, linear_wheel("first", 6.1, 3e3, 1e9) + "," +
                                                     linear_wheel("second", 6.100001, 3e3, 1e9));
  std::vector<double> mean = rear;
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = .5 * (rear[i] + front[i]);
  result.checks.push_back({"linear contacts at 30 m/s: less the mean of one wheel at either place",
                           largest_gap(both, mean) / largest_size(mean), 1e-9});
  result.picture = {
      "time, s",
      "wheel-rail force, kN",
      {two.curve("first.wheel_1.force_z_n", "first of two", 1e-3),
       one.curve("first.wheel_1.force_z_n", "one of both their masses, half", .5e-3)}};
  result.frame_us = two.frame_us();
  return result;
}

}  // namespace

std::vector<HardCase> wheel_cases() {
  return {
      {"H15", "h15_moving_mass", "A bonded mass and a sprung one run over a beam",
       "The mass feels its own path: Coriolis and centripetal terms of the moving point.",
       "R4 of the reference solutions (1e-7 m); at 100 m/s 36 modes of the Timoshenko beam by "
       "Runge "
       "and Kutta's rule (2e-4); Yang and Yau's sprung mass over 20 modes.",
       moving_mass},
      {"H16", "h16_rail_end", "Wheels leave the rail's end and start beyond it",
       "There is no rail to look for the wheel's place on.",
       "Free fall; rails that nothing touches stay; a vehicle rolls on with its weight.", rail_end},
      {"H17", "h17_one_element", "Two wheels on one element",
       "Their contacts are coupled through one element.",
       "The track is linear and the forces are the weights: deflections are sums.", one_element},
      {"H18", "h18_on_a_node", "A wheel exactly on a node, and one unit in the last place beside",
       "Which of two elements holds it is a matter of the last bit.",
       "Both elements give the same there, but for the rounding of 600 steps.", on_a_node},
      {"H19", "h19_cap_of_one", "One iteration a step for the guide of a wheelset",
       "The step ends before it has converged.",
       "The same with 20 iterations; F dt^2 / m is all that a step can do.", cap_of_one},
      {"H37", "h37_backwards", "A bogie at negative speed",
       "Order of wheels, sides of elements and signs of slopes all turn round.",
       "Its mirror image at positive speed, to rounding.", backwards},
      {"H38", "h38_one_micrometre", "Two wheels 1 um apart",
       "Their two contacts are all but one equation.",
       "One wheel of both masses; with linear contacts the mean of one at either place. That is "
       "without residual flexibility, whose table between wheels is read by cubics over a quarter "
       "of an element: nearer than that it is off by up to 5e-11 m/N.",
       one_micrometre}};
}

}  // namespace railstep
