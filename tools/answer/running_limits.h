#pragma once

namespace railstep {

/// Quantities of running behaviour by EN 14363 / UIC 518.
enum class Assessed {
  sum_y,               // force of a wheelset across the track, sliding mean over 2 m
  y_over_q,            // of a wheel, sliding mean over 2 m
  unloading,           // part of the static wheel load that leaves a wheel, sliding mean over 2 m
  unstable_sum_y,      // rms over 100 m of the force across at the frequency of hunting
  q,                   // wheel load
  y_quasistatic,       // median of a wheel's force across
  q_quasistatic,       // median wheel load
  body_y,              // acceleration in a body, 0.4 to 10 Hz
  body_z,              //
  body_y_rms,          // the same as rms
  body_z_rms,          //
  body_y_quasistatic,  // median acceleration across
  t_gamma              // mean energy that a wheel's creep turns to heat by a metre
};

/// How a quantity is written, and where its limit is from.
struct AssessedText {
  Assessed quantity;
  const char *key, *title, *unit;
  double scale;        // from SI to the unit
  double deviations;   // between sections that the largest value to expect has; 0: no such value
  const char* limit;   // in words; "" without one
  const char* source;  // of the limit
};
const AssessedText& text_of(Assessed quantity);

/// Where and how a vehicle runs.
struct LimitedBy {
  double speed;       // m/s
  double wheel_load;  // static, N
};
/// The limit of a quantity in SI units. It is NaN if the quantity has none.
double limit_of(Assessed quantity, const LimitedBy& by);

}  // namespace railstep
