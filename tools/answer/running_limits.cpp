#include "answer/running_limits.h"

#include <algorithm>
#include <array>
#include <limits>

namespace railstep {
namespace {

constexpr const char* const kNotSourced = "limit not sourced: from memory of EN 14363 and UIC 518";
constexpr double kSafety = 3., kOther = 2.2;  // deviations, as EN 14363

constexpr std::array kTexts = {
    AssessedText{Assessed::sum_y, "sum_y_2m", "sum Y, mean over 2 m", "kN", 1e-3, kSafety,
                 "10 kN + P0/3, P0 the static axle load; 0.85 of it for freight wagons",
                 kNotSourced},
    AssessedText{Assessed::y_over_q, "y_over_q_2m", "Y/Q, mean over 2 m", "1", 1., kSafety, "0.8",
                 "UIC 518 as railwaynews.net quotes it"},
    AssessedText{Assessed::unloading, "unloading_2m", "wheel unloading 1 - Q/Q0, mean over 2 m",
                 "1", 1., 0., "", ""},
    AssessedText{Assessed::unstable_sum_y, "sum_y_rms_100m",
                 "sum Y at its dominant frequency +-2 Hz, rms over 100 m", "kN", 1e-3, 0.,
                 "half of that of sum Y", kNotSourced},
    AssessedText{Assessed::q, "q", "Q", "kN", 1e-3, kOther,
                 "90 kN + Q0; at most 200 kN up to 160 km/h, 190 to 200, 180 to 250, 170 to 300, "
                 "160 beyond",
                 kNotSourced},
    AssessedText{Assessed::y_quasistatic, "y_qst", "Y, quasi-static", "kN", 1e-3, 0., "60 kN",
                 kNotSourced},
    AssessedText{Assessed::q_quasistatic, "q_qst", "Q, quasi-static", "kN", 1e-3, 0., "145 kN",
                 kNotSourced},
    AssessedText{Assessed::body_y, "body_y", "body acceleration across, 0.4 to 10 Hz", "m/s2", 1.,
                 kOther, "2.5 m/s2", kNotSourced},
    AssessedText{Assessed::body_z, "body_z", "body acceleration upwards, 0.4 to 10 Hz", "m/s2", 1.,
                 kOther, "2.5 m/s2 of passenger vehicles", kNotSourced},
    AssessedText{Assessed::body_y_rms, "body_y_rms", "the same across, rms", "m/s2", 1., kOther,
                 "0.5 m/s2", kNotSourced},
    AssessedText{Assessed::body_z_rms, "body_z_rms", "the same upwards, rms", "m/s2", 1., kOther,
                 "0.75 m/s2 of passenger vehicles", kNotSourced},
    AssessedText{Assessed::body_y_quasistatic, "body_y_qst",
                 "body acceleration across, quasi-static", "m/s2", 1., 0., "1.5 m/s2", kNotSourced},
    AssessedText{Assessed::t_gamma, "t_gamma", "T gamma, mean", "N", 1., 0., "", ""}};

double most_q(double speed, double wheel_load) {
  const double km_per_h = 3.6 * speed;
  const double most = km_per_h <= 160.   ? 200e3
                      : km_per_h <= 200. ? 190e3
                      : km_per_h <= 250. ? 180e3
                      : km_per_h <= 300. ? 170e3
                                         : 160e3;
  return std::min(90e3 + wheel_load, most);
}

}  // namespace

const AssessedText& text_of(Assessed quantity) {
  return *std::find_if(kTexts.begin(), kTexts.end(),
                       [&](const AssessedText& own) { return own.quantity == quantity; });
}

double limit_of(Assessed quantity, const LimitedBy& by) {
  const double sum_y = 10e3 + 2. * by.wheel_load / 3.;
  switch (quantity) {
    case Assessed::sum_y:
      return sum_y;
    case Assessed::y_over_q:
      return .8;
    case Assessed::unstable_sum_y:
      return .5 * sum_y;
    case Assessed::q:
      return most_q(by.speed, by.wheel_load);
    case Assessed::y_quasistatic:
      return 60e3;
    case Assessed::q_quasistatic:
      return 145e3;
    case Assessed::body_y:
    case Assessed::body_z:
      return 2.5;
    case Assessed::body_y_rms:
      return .5;
    case Assessed::body_z_rms:
      return .75;
    case Assessed::body_y_quasistatic:
      return 1.5;
    case Assessed::unloading:
    case Assessed::t_gamma:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace railstep
