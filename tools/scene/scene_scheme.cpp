// [step]: time steps, frames and schemes.
#include <fmt/core.h>

#include <cmath>
#include <limits>

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

/// Number of steps `dt` in `time`, a whole number within 1e-9 for the rounding of decimal numbers.
std::int64_t whole_steps(const Table& t, std::string_view key, double time, double dt) {
  const double steps = std::round(time / dt);
  if (!(steps >= 1.0) || std::fabs(time / dt - steps) > 1e-9 * steps)
    t.refuse(key, "E-STEP-06",
             fmt::format("{} = {:.15g} is not a whole number of steps of dt_s = {:.15g}; expected "
                         "a multiple of dt_s",
                         key, time, dt));
  return static_cast<std::int64_t>(steps);
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

StepScene read_times(const Table& t) {
  StepScene s{};
  s.dt = t.number("dt_s", between(1e-7, 0.1));
  const double duration = t.number("duration_s", above_upto(0.0, 1e7));
  if (s.dt > duration)
    t.refuse("dt_s", "E-STEP-07",
             fmt::format("dt_s = {:.15g} is longer than duration_s = {:.15g}; expected at most "
                         "the duration",
                         s.dt, duration));
  const double frame = t.number("frame_s", above_upto(0.0, duration), s.dt);
  s.steps_per_frame = whole_steps(t, "frame_s", frame, s.dt);
  s.steps = whole_steps(t, "duration_s", duration, s.dt);
  return s;
}

StepScene read_track_step(const Table& t) {
  StepScene s = read_times(t);
  read_scheme(t, 0.6, false, s);
  constexpr Start kStarts[] = {Start::equilibrium, Start::released, Start::moving};
  s.start = kStarts[t.choice("start", {"equilibrium", "released", "moving"}, 0)];
  s.mean_contact = t.choice("contact", {"penetration", "discrete-gradient"}, 0) == 1;
  return s;
}

void check_frames(const Table& t, const StepScene& s) {
  if (s.steps % s.steps_per_frame != 0)
    t.refuse("duration_s", "E-STEP-09",
             "duration_s is not a multiple of frame_s, but a run is written in whole "
             "frames; expected a multiple of frame_s");
  if (s.steps_per_frame > std::numeric_limits<int>::max())
    t.refuse("frame_s", "E-STEP-10",
             fmt::format("a frame of {} steps is too long; expected at most {} steps",
                         s.steps_per_frame, std::numeric_limits<int>::max()));
}

void check_moving(const Table& root, const Scene& scene) {
  if (scene.step->start == Start::moving && !scene.track.endless)
    root.table("step").refuse(
        "start", "E-STEP-08",
        "start = \"moving\" needs a track without end; expected track.length = "
        "\"endless\", or another start");
}

void check_contact(const Table& root, const Scene& scene) {
  if (!scene.step->mean_contact) return;
  if (!scene.condense.kind || *scene.condense.kind == ReductionKind::complex_modes)
    root.table("step").refuse(
        "contact", "E-STEP-02",
        "contact = \"discrete-gradient\" keeps energy only where forces are held "
        "over a step; expected condense.kind = \"modal\", \"guyan\", \"irs\", "
        "\"craig-bampton\" or \"krylov\"");
}

}  // namespace railstep
