#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "answer/static_solution.h"
#include "build/build.h"
#include "hard/hard_run.h"
#include "hard/spinning_bar.h"
#include "offline/analysis/damped.h"
#include "offline/analysis/statics.h"
#include "offline/beam/equilibrium.h"
#include "offline/beam/track_structure.h"
#include "offline/track/fixed_port.h"

namespace railstep {
namespace {

constexpr double kNotFound = std::numeric_limits<double>::quiet_NaN();

std::string elements(int count) { return fmt::format("track.elements_per_bay={}", count); }
std::string model_is(const char* model) { return fmt::format("track.model=\"{}\"", model); }

/// Displacement of a scene's only sensor, m.
std::array<double, 3> tip(const std::filesystem::path& scene,
                          const std::vector<std::string>& overrides) {
  const StaticSolution found = solve_static(read_scene(scene, overrides));
  return found.converged ? found.points.at(0).displacement
                         : std::array{kNotFound, kNotFound, kNotFound};
}

/// The axis of a solution: where each point stands, m.
HardCurve axis_of(const StaticSolution& solution, const std::string& name) {
  HardCurve curve{name, {}, {}};
  for (const StaticPoint& at : solution.axis) {
    curve.x.push_back(at.rest[0] + at.displacement[0]);
    curve.y.push_back(at.displacement[2]);
  }
  return curve;
}

// H11 ------------------------------------------------------------------------------------------

HardResult incompressible(const std::filesystem::path& scene) {
  constexpr double kTip = 2.0950868e-2, kLength = 2., kForce = 63e3, kBending = 210e9 * 39e-6;
  constexpr double kShear = .472 * 210e9 / 2.998 * 8.7e-3;  // k G A
  HardResult result;
  for (const int count : {1, 4, 10})
    for (const char* model : {"linearised", "nonlinear"})
      result.checks.push_back(off_by(fmt::format("deflection, {} elements, {}", count, model),
                                     -tip(scene, {elements(count), model_is(model)})[2], kTip,
                                     1e-3));
  // The other way to couple the strains of the section locks: the case can tell.
  result.checks.push_back(
      {"locked: deflection over the reference, coupling over the section",
       -tip(scene, {"rail.rule.coupling=\"section\"", model_is("nonlinear")})[2] / kTip, .1});
  HardCurve known{"Timoshenko's beam", {}, {}, true};
  for (int i = 0; i <= 10; ++i) {
    const double x = .1 * i * kLength;
    known.x.push_back(x);
    known.y.push_back(-kForce * (x * x * (3. * kLength - x) / (6. * kBending) + x / kShear));
  }
  result.picture = {"along the rail, m",
                    "deflection, m",
                    {axis_of(solve_static(read_scene(scene)), "4 elements"), known}};
  return result;
}

// H12 ------------------------------------------------------------------------------------------

HardResult slender(const std::filesystem::path& scene) {
  constexpr double kTip = 2e-4;  // P L^3/3EI, m
  // Each entry of an assembled stiffness K is rounded. Were all 64 elements' rounded once, in the
  // worst way, that would be half an ulp of u'|K|u / (P w), 3.0e-4. The nonlinear rail takes its
  // forces from strains: its third iteration, where it makes one, mends it.
  struct Form {
    const char *name, *model, *unknowns;
    double many;  // bound of 64 elements
  };
  const Form forms[] = {{"nonlinear", "nonlinear", "full", 1e-4},
                        {"linearised", "linearised", "full", 3e-4},
                        {"deflection and turn alone", "linearised", "vertical", 3e-4}};
  HardResult result;
  result.picture = {"elements", "relative error", {}, true, true};
  for (const Form& form : forms) {
    HardCurve errors{form.name, {}, {}, true};
    for (const int count : {1, 2, 4, 8, 16, 32, 64}) {
      const double found = -tip(scene, {elements(count), model_is(form.model),
                                        fmt::format("track.unknowns=\"{}\"", form.unknowns)})[2];
      errors.x.push_back(count);
      errors.y.push_back(std::max(std::abs(found / kTip - 1.), 1e-16));
      if (count == 4 || count == 64)
        result.checks.push_back(off_by(fmt::format("{}, {} elements", form.name, count), found,
                                       kTip, count == 4 ? 1e-6 : form.many));
    }
    result.picture.curves.push_back(errors);
  }
  return result;
}

// H13 ------------------------------------------------------------------------------------------

constexpr double kCriticalForce = 8.703979e6;  // N, of vertical bending
/// P/(4 m L^2), 1/s2.
double per_half_wave(double force) { return force / (4. * 7850. * 8.7e-3 * 9.); }
std::string pressed(double force) { return fmt::format("rail.axial_force_n={:.17g}", -force); }

std::vector<double> frequencies(const std::filesystem::path& scene,
                                const std::vector<std::string>& overrides, int count) {
  return natural_modes(linear_about_rest(track_of(read_scene(scene, overrides))), count).frequency;
}

/// By how much (f_0^2 - f^2) / (P/(4 m L^2)) is off the square of a whole number, relative: the
/// largest of `count` modes, which compression must not have reordered.
double off_law(const std::vector<double>& free, const std::vector<double>& under, double force) {
  double most = 0.;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double square = (free[i] * free[i] - under[i] * under[i]) / per_half_wave(force);
    const double n = std::max(std::round(std::sqrt(square)), 1.);
    most = std::max(most, std::abs(square / (n * n) - 1.));
  }
  return most;
}

void add_refusal(const std::filesystem::path& scene, HardResult& result) {
  const std::string said = refusal(scene, {pressed(1.01 * kCriticalForce)});
  result.checks.push_back(holds("1.01 of the critical force is refused, with that force",
                                said.find("8791019 N") != std::string::npos));
  result.checks.push_back(holds("and with the force at which the rail buckles",
                                said.find("buckles at 870") != std::string::npos));
}

HardResult preload(const std::filesystem::path& scene) {
  constexpr int kModes = 8, kInSpace = 17;  // these hold n = 1 to 4 of all three motions
  const std::string space = "track.unknowns=\"full\"";
  const std::vector<double> free = frequencies(scene, {pressed(0.)}, kModes);
  const std::vector<double> wide = frequencies(scene, {pressed(0.), space}, kInSpace);
  // Sideways the rail is softer than upwards, and buckles first.
  const double lateral = kCriticalForce * std::pow(wide[0] / free[0], 2);
  HardResult result;
  result.checks.push_back(off_by("first frequency without force", free[0], 59.49949, 1e-3));
  for (const auto& [part, first] : {std::pair{.9, 18.81539}, std::pair{.99, 5.94995}}) {
    const std::vector<double> under = frequencies(scene, {pressed(part * kCriticalForce)}, kModes);
    const std::string at = fmt::format("{} of the critical force: ", part);
    result.checks.push_back(off_by(at + "first frequency", under[0], first, 1e-3));
    double most = 0.;
    for (int n = 1; n <= kModes; ++n) {
      const auto i = static_cast<std::size_t>(n - 1);
      const double known =
          std::sqrt(free[i] * free[i] - n * n * per_half_wave(part * kCriticalForce));
      most = std::max(most, std::abs(under[i] / known - 1.));
    }
    result.checks.push_back({at + "frequencies 1 to 8 by the law", most, 1e-3});
    const double force = part * lateral;
    result.checks.push_back(
        {at + "17 modes in space by the law",
         off_law(wide, frequencies(scene, {pressed(force), space}, kInSpace), force), 1e-3});
  }
  add_refusal(scene, result);

  result.picture = {"compression over the critical force", "frequency, Hz", {}};
  for (int n = 1; n <= 3; ++n) {
    HardCurve law{fmt::format("n = {}, by the law", n), {}, {}};
    for (int k = 0; k <= 100; ++k) {
      const double f = free[static_cast<std::size_t>(n - 1)];
      law.x.push_back(.01 * k);
      law.y.push_back(
          std::sqrt(std::max(0., f * f - n * n * per_half_wave(.01 * k * kCriticalForce))));
    }
    result.picture.curves.push_back(law);
  }
  HardCurve found{"railstep", {}, {}, true};
  for (const double part : {0., .3, .6, .9, .99})
    for (const double f : frequencies(scene, {pressed(part * kCriticalForce)}, 3)) {
      found.x.push_back(part);
      found.y.push_back(f);
    }
  result.picture.curves.push_back(found);
  return result;
}

// H23 ------------------------------------------------------------------------------------------

constexpr double kDown = 100e3;  // N, on the wheel of H23

/// The effect of a lateral force on the head over the seat in the middle.
struct Roll {
  double head, turn;  // m, rad
};

/// Statics of the scene's rail, with the section's own coordinates for what the wheel does.
class RollingRail {
 public:
  explicit RollingRail(const std::filesystem::path& scene)
      : RollingRail(read_scene(scene, {model_is("nonlinear")})) {}

  Roll under(double aside, bool nonlinear) const {
    const Eigen::VectorXd load = aside * at(head_, 1) - kDown * at(head_, 2);
    const Structure& s = rail_.structure();
    Eigen::VectorXd moved;
    if (nonlinear) {
      const Equilibrium found = equilibrium(s, {load});
      moved = (found.converged ? 1. : kNotFound) * (found.q - s.rest);
    } else {
      // A millionth of the load is small enough to be linear.
      moved = 1e6 * (equilibrium(s, {1e-6 * load}).q - s.rest);
    }
    const Eigen::VectorXd turn =
        .5 * ((at({1., 0.}, 2) - at({0., 0.}, 2)) - (at({0., 1.}, 1) - at({0., 0.}, 1)));
    return {at(head_, 1).dot(moved), turn.dot(moved)};
  }

 private:
  explicit RollingRail(const Scene& scene)
      : section_(rail_section_of(scene).section), rail_(track_of(scene)) {}
  struct Place {
    double y, z;  // m over the axis
  };
  Eigen::VectorXd at(const Place& place, int direction) const {
    return rail_.row(RailPoint{0, 3.6, place.y, place.z, direction});
  }
  Section section_;
  TrackStructure rail_;
  Place head_{0., height_z(Height::head, section_)};
};

/// A run under 100 kN and a force aside, to rest. Both grow over half of it, so that the rail is
/// not looked for beyond its final place.
HardRun rolled(const std::filesystem::path& scene, double aside) {
  std::vector<double> given = {3.6, 0., 0., 0., 0.};  // x, y and force of the wheel
  return HardRun(scene, {}, [given, aside](std::int64_t frame) mutable {
    const double part = std::min(1., .02 * static_cast<double>(frame));
    given[3] = part * aside;
    given[4] = -part * kDown;
    return given.data();
  });
}

HardResult rolling(const std::filesystem::path& scene) {
  const RollingRail known(scene);
  HardResult result;
  result.picture = {"roll, mrad", "displacement of the head aside, mm", {}};
  HardCurve run{"railstep run", {}, {}, true}, exact{"nonlinear rail", {}, {}},
      plain{"linear rail without the second order", {}, {}};
  for (const double aside : {1.2e3, 6e3, 12e3, 25e3, 60e3, 150e3, 190e3}) {
    const HardRun found = rolled(scene, aside);
    const Roll right = known.under(aside, true);
    const double head = found.last("head.dy_m");
    // The web of the linear rail does not bend, so foot and head give the turn.
    const double turn = (found.last("foot.dy_m") - head) / .1857375;
    const std::string at = fmt::format("{:.1f} kN aside, {:.0f} mrad: ", 1e-3 * aside, 1e3 * -turn);
    if (std::abs(turn) < .055)
      result.checks.push_back(off_by(at + "displacement of the head", head, right.head, .025));
    result.checks.push_back(
        holds(at + "the status says so where half the turn's square is 1 % and only there",
              (found.status().find("large_turn") != std::string::npos) == (turn * turn > .02)));
    const double mrad = 1e3 * std::abs(right.turn);
    run.x.push_back(mrad);
    run.y.push_back(1e3 * head);
    exact.x.push_back(mrad);
    exact.y.push_back(1e3 * right.head);
    plain.x.push_back(mrad);
    plain.y.push_back(1e3 * known.under(aside, false).head);
    result.frame_us = found.frame_us();
  }
  result.picture.curves = {exact, plain, run};
  return result;
}

// H43 ------------------------------------------------------------------------------------------

HardResult elastica(const std::filesystem::path& scene) {
  constexpr double kLength = 2., kDeflection = .66996, kShortening = .32894;
  HardResult result;
  const auto ends = [&](int count) { return tip(scene, {elements(count)}); };
  const auto apart = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) / kLength;
  };
  const auto coarse = ends(16), middle = ends(32), fine = ends(64);
  result.checks.push_back(
      apart_by("deflection over the length", fine[2] / kLength, kDeflection, 5e-5));
  result.checks.push_back(
      apart_by("shortening over the length", -fine[0] / kLength, kShortening, 5e-5));
  // At least of second order in the element's length.
  result.checks.push_back({"change from 32 to 64 elements over that from 16 to 32",
                           apart(fine, middle) / apart(middle, coarse), .25});
  result.checks.push_back(
      {"out of the plane, over the length", std::abs(fine[1]) / kLength, 1e-12});
  result.picture = {"x, m", "z, m", {}};
  for (const double force : {1., 2., 4., 10.})
    result.picture.curves.push_back(
        axis_of(solve_static(read_scene(
                    scene, {elements(32), fmt::format("load[0].force_z_n={}", 1.12 * force)})),
                fmt::format("F L^2/EI = {:.0f}", force)));
  result.picture.curves.push_back(
      {"the elastica's end at 4", {kLength * (1. - kShortening)}, {kLength * kDeflection}, true});
  return result;
}

}  // namespace

std::vector<HardCase> element_cases() {
  return {
      {"H11", "h11_incompressible", "A cantilever that hardly changes its volume",
       "At Poisson's ratio .499 an element whose section cannot follow its axis' strain locks.",
       "Timoshenko's cantilever, P L^3/3EI + P L/(k G A) = 2.0950868e-2 m. The nonlinear rail's "
       "shorter lever takes 2.7e-4 of it, which is within the bound.",
       incompressible},
      {"H12", "h12_slender", "Length over height 10 000",
       "Stretch is 1e8 times as stiff as bending: digits cancel, the more the finer the mesh.",
       "P L^3/3EI; shear and the shorter lever are 1e-8 of it. With 64 elements some 1e-4 are lost "
       "by "
       "rounding: an assembly in doubles that shares nothing with this one, solved in 60 digits, "
       "is "
       "off by up to 1.3e-4 at 58 to 70 elements. So 1e-4 are asked of the nonlinear rail, and of "
       "linear ones what half an ulp of each entry may make, 3e-4.",
       slender},
      {"H13", "h13_preload", "A rail pressed by .9, .99 and 1.01 of its critical force",
       "The stiffness is nearly singular, then indefinite: no steps could follow the buckled rail.",
       "R7 of the reference solutions: with pinned ends f_n^2 = f_n0^2 - n^2 P/(4 m L^2) for every "
       "mode, in space too, P_cr = 4 m L^2 f_10^2 = 8.703979 MN.",
       preload},
      {"H23", "h23_rolling_rail", "A rail that rolls by 1 to 160 mrad",
       "A vertical force turns a rolled rail on (P-delta). A linear rail lacks it by the same part "
       "however small the roll is.",
       "The nonlinear element on the same mesh; 2.5 % are asked of the run. The estimated error of "
       "what is left out, half the turn's square, passes its limit of 1 % at 141 mrad: a status "
       "bit there, and not before.",
       rolling},
      {"H43", "h43_elastica", "A cantilever bent by two thirds of its length",
       "Turns of a radian: all of the strain is a small difference of large slopes.",
       "The elastica (Bisshopp and Drucker 1945), F L^2/EI = 4: .66996 and .32894 of the length to "
       "5e-6; shear and stretch of this bar are 1.6e-5.",
       elastica},
      {"H46", "h46_spinning_beam", "A bar that spins at 300 rad/s",
       "150 kN pull at its middle, it rings at 2.6 kHz, and turns by 48 rounds: what is not "
       "invariant under turns drifts.",
       "rho w^2 L^3/12E at the rate that the momentum leaves; strains of 3e-4 are left out, and "
       "the "
       "mean of a ringing over 1000 frames errs by 1e-3. Energy-momentum keeps rate and energy; "
       "generalised-alpha turns by its second order, and damps turns by its third.",
       spinning}};
}

}  // namespace railstep
