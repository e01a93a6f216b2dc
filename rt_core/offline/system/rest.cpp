#include "offline/system/rest.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "offline/math/refuse.h"
#include "offline/system/pack_system.h"
#include "offline/system/system_energy.h"
#include "online/step/step.h"
#include "online/system/track_ports.h"

namespace railstep {

namespace {

constexpr double kFirstStep = 1e-2, kShortestStep = 1e-6, kLongestStep = 40.;  // s
constexpr double kLonger = 4.;            // factor from one step length to the next
constexpr int kPatience = 100;            // number of steps before longer ones are tried
constexpr int kMostSteps = 40'000;        // of all step lengths together
constexpr double kNoAcceleration = 1e-9;  // m/s2: 1e-10 of the weight

constexpr double kAway = 1e5;  // m: a part that moved so far is falling

enum class Outcome { settled, slow, lost, away };

/// The largest magnitude.
double largest(const double* values, std::int32_t count) {
  double most = 0.;
  for (std::int32_t i = 0; i < count; ++i) most = std::max(most, std::abs(values[i]));
  return most;
}

/// A system whose steps all end at t = 0.
class Still {
 public:
  Still(std::unique_ptr<PackedSystem> packed, const std::optional<Rest>& from)
      : packed_(std::move(packed)),
        memory_(static_cast<std::size_t>(state_doubles(model()))),
        scratch_(static_cast<std::size_t>(workspace_doubles(model()))),
        state_(state_on(model(), memory_.data())),
        workspace_(workspace_on(model(), scratch_.data())) {
    reset(model(), state_);
    if (from) {
      std::copy(from->u.begin(), from->u.end(), state_.u);
      std::copy(from->quaternion.begin(), from->quaternion.end(), state_.quaternion);
      std::copy(from->row_force.begin(), from->row_force.end(), state_.row_force);
    }
    stop();
    last_ = memory_;
  }

  /// Makes up to `most` steps, and counts `left` down.
  Outcome settle(int most, int& left) {
    for (; most > 0 && left > 0; --most, --left) {
      const bool from_rest = at_rest_;
      last_ = memory_;
      state_.steps = -1;  // the step ends at t = 0, which is where forces are taken
      state_.latched = Status::ok;
      const Status met = advance_frame(model(), state_, workspace_, outputs_);
      if (has(met, Status::cap_reached) || has(met, Status::nonfinite_state)) return Outcome::lost;
      if (from_rest && is_still()) return Outcome::settled;
      if (largest_place() > kAway) return Outcome::away;
      const double kinetic = system_energy(model(), state_).kinetic;
      at_rest_ = kinetic <= kinetic_;
      kinetic_ = kinetic;
      if (at_rest_) stop();
    }
    return Outcome::slow;
  }

  /// The present positions, or those before a lost step.
  Rest rest(bool before_last) {
    if (before_last) memory_ = last_;
    const auto n = static_cast<std::size_t>(model().unknowns);
    const auto bodies = static_cast<std::size_t>(model().system.bodies);
    const auto rows = static_cast<std::size_t>(system_rows(model().system));
    Rest rest{{state_.u, state_.u + n},
              std::vector<double>(n, 0.),
              {state_.quaternion, state_.quaternion + 4 * bodies},
              {state_.row_force, state_.row_force + rows},
              {model().system.port, model().system.port + model().system.ports},
              std::vector<double>(std::size_t{9} * static_cast<std::size_t>(model().system.ports))};
    find_port_forces(model(), state_, workspace_, rest.port_force.data());
    return rest;
  }

  /// Name of the body or beam that accelerates most; the track if none of these accelerates.
  std::string restless() const {
    const SystemModel& s = model().system;
    std::string name = "the track";
    double most = kNoAcceleration;
    const auto compare = [&](const char* kind, std::int32_t index, std::int32_t first,
                             std::int32_t count) {
      const double own = largest(state_.g + s.first + first, count);
      if (own > most) name = kind + std::to_string(index);
      most = std::max(most, own);
    };
    for (std::int32_t b = 0; b < s.bodies; ++b)
      compare("body ", b, s.body[b].first, s.body[b].unknowns);
    for (std::int32_t b = 0; b < s.beams; ++b)
      compare("beam ", b, s.beam[b].first, s.beam[b].unknowns);
    return name;
  }

 private:
  const Model& model() const { return packed_->model(); }
  void stop() {
    for (double* const rates : {state_.v, state_.a, state_.g})
      std::fill_n(rates, model().unknowns, 0.);
    kinetic_ = 0.;
    at_rest_ = true;
  }
  bool is_still() const {
    const double most = largest(state_.g, model().unknowns);
    return most <= kNoAcceleration || most <= model().scheme.kg * 1e-15 * largest_place();
  }
  double largest_place() const {
    const SystemModel& s = model().system;
    double place = largest(state_.u, model().unknowns);
    for (std::int32_t b = 0; b < s.bodies; ++b) place = std::max(place, largest(s.body[b].rest, 3));
    for (std::int32_t b = 0; b < s.beams; ++b)
      place = std::max(place, largest(s.beam_rest + s.beam[b].first, s.beam[b].unknowns));
    return place;
  }

  std::unique_ptr<PackedSystem> packed_;
  std::vector<double> memory_, scratch_, last_;
  State state_;
  Workspace workspace_;
  Outputs outputs_{};
  double kinetic_ = 0.;
  bool at_rest_ = true;
};

Rest settle(const StillSystem& make, double shift, std::optional<Rest> from) {
  double dt = kFirstStep, longest = kLongestStep;
  int left = kMostSteps;
  while (true) {
    Still still(make(dt, shift), from);
    const bool may_lengthen = dt * kLonger <= longest;
    const Outcome met = still.settle(may_lengthen ? kPatience : left, left);
    if (met == Outcome::settled) return still.rest(false);
    if (left == 0 || met == Outcome::away || (met == Outcome::lost && dt < kShortestStep))
      refuse("E-SYSTEM-62", "no static equilibrium was found at the start: " + still.restless() +
                                " does not come to rest; expected parts that joints and springs "
                                "hold, or step.start = \"released\"");
    if (met == Outcome::lost) {
      --left;
      longest = dt / kLonger;
      dt = longest;
    } else {
      dt *= kLonger;
    }
    from = still.rest(met == Outcome::lost);
  }
}

/// Rates from one rest to another; of rotations in body axes, as in the state.
std::vector<double> rates(const Model& model, const Rest& before, const Rest& after, double time) {
  const SystemModel& s = model.system;
  std::vector<double> v(before.u.size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = (after.u[i] - before.u[i]) / time;
  for (std::int32_t b = 0; b < s.bodies; ++b) {
    const auto quaternion = [b](const Rest& rest) {
      const double* q = rest.quaternion.data() + std::ptrdiff_t{4} * b;
      return Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    };
    const Eigen::AngleAxisd rotation(quaternion(before).conjugate() * quaternion(after));
    for (int c = 0; c < 3; ++c)
      if (const std::int32_t k = s.body[b].column[3 + c]; k >= 0)
        v.data()[s.first + s.body[b].first + k] = rotation.angle() * rotation.axis()[c] / time;
  }
  return v;
}

}  // namespace

Rest find_rest(const StillSystem& make, const std::vector<StartingPlace>& running, double length) {
  Rest rest = settle(make, 0., std::nullopt);
  constexpr double dt = 1e-4;  // s; 3 mm at 30 m/s, where the shape is straight to 1e-5
  double from = -dt, to = dt;
  bool moves = false;
  for (const StartingPlace& own : running) {
    moves = moves || own.speed != 0.;
    const auto leaves = [&](double t) {
      const double x = own.place + own.speed * t;
      const bool starts_on = own.place >= 0. && own.place <= length;
      return starts_on && (x < 0. || x > length);
    };
    if (leaves(from)) from = 0.;
    if (leaves(to)) to = 0.;
  }
  if (!moves || !(to > from)) return rest;
  const Rest before = from < 0. ? settle(make, from, rest) : rest;
  const Rest after = to > 0. ? settle(make, to, rest) : rest;
  rest.v = rates(make(kFirstStep, 0.)->model(), before, after, to - from);
  for (std::size_t i = 0; i < rest.port_force.size(); ++i)
    rest.port_rate.push_back((after.port_force[i] - before.port_force[i]) / (to - from));
  return rest;
}

}  // namespace railstep
