#pragma once
#include <vector>

#include "offline/profile/elastic_touch.h"
#include "online/patch/wheel_zones.h"

namespace railstep {

/// Tables of a wheel and its rail for find_zones().
class ContactTables {
 public:
  /// Points of both profiles are 0.125 mm apart or a little less.
  ContactTables(const WheelRail& pair, const Elastic& bodies);
  /// Valid as long as the tables live.
  [[nodiscard]] ProfilePair pair() const;

 private:
  struct Tabled {
    double first, step;
    std::vector<double> coefficient;
    explicit Tabled(const RunningSurface& surface);
    [[nodiscard]] ProfileTable table() const;
  };
  Tabled wheel_, rail_;
  std::vector<double> search_place_, search_growth_, search_slope_;
  double half_distance_, radius_, modulus_;
};

}  // namespace railstep
