#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "offline/profile/elastic_touch.h"
#include "section/running_profile.h"

namespace railstep {

/// A wheelset on rails, and what is asked about their profiles.
struct ProfileRequest {
  std::filesystem::path wheel, rail;
  double inclination = 1. / 40.;  // of the rails, tangent
  double gauge = 1.435;           // m
  double back_to_back = 1.36;     // m, of the wheels
  double radius = kWheelRadius;   // m, of the wheels at the tread datum
  double contact_distance = 1.5;  // m, of the contacts, in the formula of conicity
  double range = 8e-3;            // m, largest shift
  bool roll = true;               // of the rigid contact that is asked for
  double load = 0.;               // N upright on each wheel; 0 for rigid contact alone
};

/// Equivalent conicities at an amplitude; nothing where the wheelset has no such wave within the
/// range.
struct ConicityRow {
  double amplitude;                            // m
  std::optional<double> rigid, level, loaded;  // with roll, without, under the load
};

struct ProfileAnswer {
  ProfileRequest request;
  WheelProfile wheel;
  PlacedRail rail;
  std::vector<WheelsetTouch> rolled, level;  // every 0.05 mm
  std::vector<WheelsetLoaded> loaded;        // every 0.1 mm; none without a load
  std::vector<ContactJump> jumps;            // of the contact that is asked for
  std::vector<ConicityRow> conicity;         // every 0.25 mm from 0.25 mm on

  [[nodiscard]] const std::vector<WheelsetTouch>& rows() const {
    return request.roll ? rolled : level;
  }
  /// The conicity that is asked for.
  [[nodiscard]] std::optional<double> of(const ConicityRow& row) const {
    return request.roll ? row.rigid : row.level;
  }
};

/// Throws InputError for files and values that cannot be used.
ProfileAnswer solve_profile(const ProfileRequest& request);

}  // namespace railstep
