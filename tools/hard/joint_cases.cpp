#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "hard/hard_run.h"
#include "offline/math/constants.h"
#include "offline/system/system_energy.h"

namespace railstep {
namespace {

/// An angle and its rate by the classical Runge-Kutta method, at equal steps from t = 0 on.
/// @param pull  angle'' at a time, an angle and a rate
class Angle {
 public:
  using Pull = std::function<double(double, double, double)>;
  Angle(Pull pull, double angle, double rate, double step)
      : pull_(std::move(pull)), at_{angle, rate}, step_(step) {}
  double angle() const { return at_[0]; }
  void advance() {
    const auto slope = [&](double t, const Pair& y) { return Pair{y[1], pull_(t, y[0], y[1])}; };
    const auto from = [&](const Pair& k, double h) {
      return Pair{at_[0] + h * k[0], at_[1] + h * k[1]};
    };
    const double h = step_, t = h * static_cast<double>(steps_++);
    const Pair k1 = slope(t, at_), k2 = slope(t + .5 * h, from(k1, .5 * h));
    const Pair k3 = slope(t + .5 * h, from(k2, .5 * h)), k4 = slope(t + h, from(k3, h));
    for (std::size_t i = 0; i < 2; ++i)
      at_[i] += h / 6. * (k1[i] + 2. * k2[i] + 2. * k3[i] + k4[i]);
  }

 private:
  using Pair = std::array<double, 2>;
  Pull pull_;
  Pair at_;
  double step_;
  std::int64_t steps_ = 0;
};

std::string dt_is(double dt) { return fmt::format("step.dt_s={}", dt); }

/// Largest distance in x and z of a sensor of two runs with the same frames, m.
double apart(const HardRun& a, const HardRun& b, const std::string& sensor) {
  double most = 0.;
  for (const char* quantity : {".x_m", ".y_m", ".z_m"}) {
    const std::vector<double> one = a.column(sensor + quantity), two = b.column(sensor + quantity);
    for (std::size_t i = 0; i < one.size(); ++i) most = std::max(most, std::abs(one[i] - two[i]));
  }
  return most;
}

/// Every n-th point of a curve, as marks.
HardCurve marks(const HardCurve& curve, std::size_t every) {
  HardCurve some{curve.name, {}, {}, true};
  for (std::size_t i = 0; i < curve.x.size(); i += every) {
    some.x.push_back(curve.x[i]);
    some.y.push_back(curve.y[i]);
  }
  return some;
}

// H20 ------------------------------------------------------------------------------------------

HardResult doubled_hinge(const std::filesystem::path& scene) {
  const std::string single =
      "joint=[{name=\"hinge\", kind=\"revolute\", between=[\"ground\", \"rod\"], "
      "point_m=[0.0, 0.0, 0.0], axis=[0.0, 1.0, 0.0]}]";
  const std::string direct = "joints.hold=\"direct\"";
  const HardRun once(scene, {single}), twice(scene);
  const HardRun once_direct(scene, {single, direct}), twice_direct(scene, {direct});
  HardResult result;
  result.checks = {
      {"augmented Lagrangian: apart from a single hinge, m", apart(once, twice, "end"), 1e-9},
      holds("augmented Lagrangian: no status bit", twice.status().empty()),
      {"direct: apart from a single hinge, m", apart(once_direct, twice_direct, "end"), 1e-9},
      holds("direct: one of the two is named as redundant",
            twice_direct.status() == "redundant_joint" &&
                twice_direct.record().redundant.size() == 1 &&
                once_direct.record().redundant.empty())};
  result.picture = {
      "time, s",
      "height of the end, m",
      {marks(once.curve("end.z_m", "one hinge"), 50), twice.curve("end.z_m", "said twice")}};
  result.frame_us = twice.frame_us();
  return result;
}

// H21 ------------------------------------------------------------------------------------------

/// A run with its energy after each frame.
struct Linkage {
  std::unique_ptr<Simulation> run;
  RunRecord record;
  double start, off = 0.;  // energy, J; the largest difference from it

  Linkage(const std::filesystem::path& scene, const std::vector<std::string>& overrides)
      : run(simulation_of(read_any_scene(scene, overrides))),
        start(system_energy(run->model(), run->state).total()) {
    const Model& model = run->model();
    record = simulate(*run, model.steps / model.steps_per_frame, nullptr, true, [&](std::int64_t) {
      off = std::max(off, std::abs(system_energy(model, run->state).total() - start));
    });
  }
};

/// Where a point is at a time, and what it is known to be to 1e-8 m.
struct Known {
  double time;
  std::array<double, 3> place;
};

double off_known(const HardRun& run, const std::string& sensor, const Known& known) {
  double sum = 0.;
  const char* const quantity[3] = {".x_m", ".y_m", ".z_m"};
  for (std::size_t d = 0; d < 3; ++d)
    sum += std::pow(run.at(known.time, sensor + quantity[d]) - known.place[d], 2);
  return std::sqrt(sum);
}

/// @param one, ten  at 1 s and 10 s  @param bound  at 1 s, of a step of 1 ms
HardResult linkage(const std::filesystem::path& scene, const std::string& sensor, const Known& one,
                   const Known& ten, double bound, const std::string& shown) {
  const HardRun run(scene), half(scene, {dt_is(5e-4)});
  const Linkage energy(scene, {});
  HardResult result;
  result.checks = {{"energy lost or made in 10 s, J", energy.off, 1e-3},
                   {"place at 1 s, m", off_known(run, sensor, one), bound},
                   {"error at 1 s, over that at twice the step",
                    off_known(half, sensor, one) / off_known(run, sensor, one), .3},
                   {"error at 10 s, over that at twice the step",
                    off_known(half, sensor, ten) / off_known(run, sensor, ten), .3},
                   {"joints open by, m", run.record().constraint_violation, 1e-6},
                   holds("no status bit", run.status().empty() && half.status().empty())};
  result.picture = {
      "time, s", shown + ", m", {run.curve(sensor + ".x_m", "x"), run.curve(sensor + ".z_m", "z")}};
  result.picture.curves.push_back(
      {"known x", {one.time, ten.time}, {one.place[0], ten.place[0]}, true});
  result.picture.curves.push_back(
      {"known z", {one.time, ten.time}, {one.place[2], ten.place[2]}, true});
  result.frame_us = run.frame_us();
  return result;
}

HardResult four_bars(const std::filesystem::path& scene) {
  HardResult result = linkage(scene, "B", {1., {-.19502030, 0., -.98079921}},
                              {10., {.32845811, 0., .94451854}}, 1e-3, "place of the first head");
  const HardRun run(scene);
  // Along x, where the rows lose their rank: the height is 0 at that time, by a line between rows.
  constexpr double kSingular = .714355529, kRate = 4.88773976;
  const double slope = -kRate, before = .714, height = run.at(before, "B.z_m");
  result.checks.push_back({"time of the first singular position, s",
                           std::abs(before - height / slope - kSingular), 1e-4});
  // The program counts the weight's from the start on: over the ground it is 3.5 kg m.
  const double start = Linkage(scene, {"step.duration_s=1e-3"}).start + 3.5 * kGravity;
  result.checks.push_back(apart_by("energy at the start, J", start, 35.835, 1e-9));
  return result;
}

HardResult slider_crank(const std::filesystem::path& scene) {
  return linkage(scene, "slider", {1., {-1.95128839, 0., 0.}}, {10., {-1.06179862, 0., 0.}}, 1e-4,
                 "place of the slider");
}

// H22 ------------------------------------------------------------------------------------------

double largest_of(const std::vector<double>& values, std::size_t first, std::size_t end) {
  return *std::max_element(values.begin() + static_cast<std::ptrdiff_t>(first),
                           values.begin() + static_cast<std::ptrdiff_t>(end));
}

HardResult long_pendulum(const std::filesystem::path& scene) {
  HardResult result;
  result.picture = {"time, s", "the hinge opens by, m", {}, false, true};
  for (const char* hold : {"augmented-lagrangian", "baumgarte"}) {
    const HardRun run(scene, {fmt::format("joints.hold=\"{}\"", hold)});
    const std::vector<double>& open = run.record().violations;
    const std::size_t all = open.size(), part = all / 10;
    const std::string at = std::string(hold) + ": ";
    if (std::string(hold) == "baumgarte") {
      const double first = largest_of(open, 1, part), last = largest_of(open, all - part, all);
      result.checks.push_back(
          {at + "largest of the last tenth over that of the first", last / first, 1.1});
    } else {
      result.checks.push_back({at + "the hinge opens by, m", largest_of(open, 0, all), 1e-12});
      double off = 0.;  // by the place of the rod's own point, at the frames' ends
      for (const char* column : {"foot.x_m", "foot.z_m"})
        off = std::max({off, run.largest(column), -run.smallest(column)});
      result.checks.push_back({at + "the rod's foot off the hinge, m", off, 1e-12});
    }
    // It has to swing to the end, or it would be no test: nearly a metre up and down.
    const std::vector<double> height = run.column("end.z_m");
    const double highest = largest_of(height, all - part, all);
    result.checks.push_back({at + "the end no longer rises to its start, by, m", -highest, .05});
    result.checks.push_back(holds(at + "no status bit", run.status().empty()));
    HardCurve curve{hold, run.time(), open};
    for (double& value : curve.y) value = std::max(value, 1e-18);
    result.picture.curves.push_back(curve);
    result.frame_us = run.frame_us() / 500.;  // of a step
  }
  return result;
}

// H44 ------------------------------------------------------------------------------------------

/// Largest distance of the rod's end from the one pendulum that both bodies are, m.
double off_pendulum(const HardRun& run, double rod, double bob) {
  const double pull = kGravity * (.5 * rod + bob) / (rod / 3. + bob);
  Angle known([pull](double, double angle, double) { return -pull * std::cos(angle); }, 0., 0.,
              2.5e-4);
  const std::vector<double> x = run.column("end.x_m"), z = run.column("end.z_m");
  double most = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) {
    most =
        std::max(most, std::hypot(x[i] - std::cos(known.angle()), z[i] - std::sin(known.angle())));
    for (int k = 0; k < 4; ++k) known.advance();
  }
  return most;
}

std::vector<std::string> masses(double rod, double bob) {
  const auto inertia = [](int body, double value) {
    return fmt::format("body[{}].inertia_kg_m2=[{:.17g},{:.17g},{:.17g}]", body, value, value,
                       value);
  };
  return {fmt::format("body[0].mass_kg={}", rod), fmt::format("body[1].mass_kg={}", bob),
          inertia(0, rod / 12.), inertia(1, .01 * bob)};
}

HardResult mass_ratio(const std::filesystem::path& scene) {
  struct Pair {
    const char* name;
    double rod, bob;  // kg
  };
  const Pair pairs[] = {{"1 : 1", 1., 1.}, {"1e-3 : 1e3", 1e-3, 1e3}, {"1e3 : 1e-3", 1e3, 1e-3}};
  HardResult result;
  result.picture = {"time, s", "height of the joint, m", {}};
  double alike = 0.;
  for (const Pair& own : pairs) {
    const HardRun run(scene, masses(own.rod, own.bob));
    const double error = off_pendulum(run, own.rod, own.bob);
    const std::string at = std::string(own.name) + ": ";
    result.checks.push_back({at + "off one pendulum in 10 s, m", error, 3e-4});
    if (alike == 0.)
      alike = error;
    else
      result.checks.push_back({at + "error over that of equal masses", error / alike, 1.5});
    result.checks.push_back({at + "joints open by, m", run.record().constraint_violation, 1e-10});
    const auto energy = run.energy();
    result.checks.push_back({at + "energy lost or made, of what is turned over",
                             energy ? energy->error : HUGE_VAL, 1e-4});
    result.checks.push_back(holds(at + "no status bit", run.status().empty()));
    result.picture.curves.push_back(run.curve("end.z_m", own.name));
    result.frame_us = run.frame_us();
  }
  return result;
}

// H45 ------------------------------------------------------------------------------------------

constexpr double kCrank = .1, kRod = .2, kJump = 1e3;  // m, m, rad/s^2

double crank_angle(double t) { return .5 * kJump * t * t; }

/// About its pin the rod is driven by the pin's acceleration and by weight. Angles are about +y,
/// from x towards -z, so that a direction is (cos, -sin).
double rod_pull(double t, double angle, double) {
  constexpr double kHalf = .5 * kRod, kArm = kRod * kRod / 3. / kHalf;
  const double a = crank_angle(t), rate = kJump * t;
  const double pin_x = kCrank * (-kJump * std::sin(a) - rate * rate * std::cos(a));
  const double pin_z = -kCrank * (kJump * std::cos(a) - rate * rate * std::sin(a));
  return (pin_x * std::sin(angle) + (pin_z + kGravity) * std::cos(angle)) / kArm;
}

/// Largest distances of a run from where the crank's end has to be and where the rod's will, m.
std::array<double, 2> off_driven(const HardRun& run, double dt) {
  const int parts = 4;
  Angle rod(rod_pull, 0., 0., dt / parts);
  const auto time = run.time(), x = run.column("crank_end.x_m"), z = run.column("crank_end.z_m"),
             end_x = run.column("end.x_m"), end_z = run.column("end.z_m");
  std::array<double, 2> most{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = crank_angle(time[i]), b = rod.angle();
    const double at[2] = {kCrank * std::cos(a), -kCrank * std::sin(a)};
    most[0] = std::max(most[0], std::hypot(x[i] - at[0], z[i] - at[1]));
    most[1] = std::max(most[1], std::hypot(end_x[i] - at[0] - kRod * std::cos(b),
                                           end_z[i] - at[1] + kRod * std::sin(b)));
    for (int k = 0; k < parts; ++k) rod.advance();
  }
  return most;
}

HardResult jerked_drive(const std::filesystem::path& scene) {
  const HardRun run(scene), half(scene, {dt_is(5e-5)});
  const auto off = off_driven(run, 1e-4), finer = off_driven(half, 5e-5);
  const auto energy = run.energy();
  HardResult result;
  result.checks = {
      {"the crank's end off its polynomial, m", off[0], 1e-10},
      {"the rod's end off Runge-Kutta, m", off[1], 1e-3},
      {"its error over that of twice the step (second order)", finer[1] / off[1], .3},
      {"joints open by, m", run.record().constraint_violation, 1e-12},
      {"energy that the drive's work does not explain", energy ? energy->error : HUGE_VAL, 1e-3},
      holds("no status bit", run.status().empty() && half.status().empty())};
  result.picture = {
      "time, s", "place of the loose end along x, m", {run.curve("end.x_m", "100 us")}};
  HardCurve known{"Runge-Kutta", {}, {}, true};
  Angle rod(rod_pull, 0., 0., 1e-5);
  for (int i = 0; i <= 20000; ++i, rod.advance()) {
    if (i % 200 != 0) continue;
    known.x.push_back(1e-5 * i);
    known.y.push_back(kCrank * std::cos(crank_angle(1e-5 * i)) + kRod * std::cos(rod.angle()));
  }
  result.picture.curves.push_back(known);
  result.frame_us = run.frame_us();
  return result;
}

}  // namespace

std::vector<HardCase> joint_cases() {
  return {
      {"H20", "h20_doubled_hinge", "A hinge that is said twice",
       "Five of ten joint rows hang on the others: the matrix of the joints is singular at every "
       "step.",
       "The same rod on one hinge.", doubled_hinge},
      {"H21", "h21_four_bars", "Two four-bars through their singular positions",
       "Where all rods lie in line two more motions are possible, and the joint rows lose rank.",
       "R8 of the reference solutions: the one equation of the angle, to 1e-8; energy 35.835 J, of "
       "which 1e-3 J may go in 10 s at 1 ms.",
       four_bars},
      {"H50", "h50_slider_crank", "A slider-crank with equal arms through its singular position",
       "Upright, its arms lie on each other, and the slider could stay where it is.",
       "R8 of the reference solutions, to 1e-8.", slider_crank},
      {"H22", "h22_long_pendulum", "A pendulum over 1e6 steps",
       "The openings of a joint in single steps must not add up.",
       "An invariant: 1e-12 m by the augmented Lagrangian, no trend by Baumgarte's.",
       long_pendulum},
      {"H44", "h44_mass_ratio", "A gram and a tonne on one joint",
       "Masses of 1e6 to 1 make the joints' matrix ill-conditioned.",
       "One pendulum, angle'' = -g (m/2 + M) cos(angle) / (m/3 + M), by Runge-Kutta at 0.25 ms: "
       "the "
       "bob hangs by its centre and does not turn. At 1 ms the scheme may err by w^3 t dt^2 of the "
       "largest w, 5.4 1/s: 1.6e-3, of which a fifth is asked.",
       mass_ratio},
      {"H45", "h45_jerked_drive", "A motor that starts at 1000 rad/s^2 at once",
       "The acceleration jumps at the start and the crank reaches 200 rad/s, a loose rod on its "
       "end.",
       "The polynomial, and the loose rod's one equation by Runge-Kutta at a quarter of the step.",
       jerked_drive}};
}

}  // namespace railstep
