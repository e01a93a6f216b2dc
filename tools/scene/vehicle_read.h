#pragma once
// The parts of read_runner: bodies, then elements. Only vehicle_*.cpp, scene_coupler.cpp and
// scene_actuator.cpp include this.
#include <array>
#include <functional>

#include "scene/scene_read.h"

namespace railstep {

using Triple = std::array<double, 3>;

inline const Range kPlaceRange = between(-1e3, 1e3);      // m
inline const Range kStiffnessRange = between(0.0, 1e13);  // N/m, N m/rad
inline const Range kDampingRange = between(0.0, 1e11);    // N s/m, N m s/rad
inline const Range kPreloadRange = between(-1e8, 1e8);    // N

inline Triple three_numbers(const Table& t, std::string_view key, const Range& accepted) {
  const std::vector<double> read = t.numbers(key, accepted, 3, 3);
  return read.size() == 3 ? Triple{read[0], read[1], read[2]} : Triple{};
}
inline Triple three_numbers(const Table& t, std::string_view key, const Range& accepted,
                            const Triple& otherwise) {
  return t.has(key) ? three_numbers(t, key, accepted) : otherwise;
}

/// Where the points of a part of the vehicle lie: of a bogie about its pivot, perhaps turned by
/// half a revolution about z.
struct BogiePlace {
  double x = 0.;  // m
  bool turned = false;
  std::string suffix;  // of the names
  [[nodiscard]] Triple at(const Triple& p) const {
    const double sign = turned ? -1. : 1.;
    return {x + sign * p[0], sign * p[1], p[2]};
  }
};

/// One part of an element of a vehicle, without its name and its bodies.
struct RunnerPart {
  std::variant<RunnerElement, RunnerForceElement> of;
  std::string suffix = {};  // of its name, behind that of the element
  /// The element that presses it, if there is one: its name, and a suffix as above.
  std::string pressed_by = {}, of_presser = {};
};
/// The two points of an element that has ends.
std::array<Triple, 2> read_points(const Table& t);
/// The line between two points, or an axis at a point.
void read_direction(const Table& t, RunnerForceElement& e);
/// Elements that are not linear, by their types.
RunnerForceElement read_bump_stop(const Table& t);
RunnerForceElement read_nonlinear_damper(const Table& t);
RunnerPart read_friction(const Table& t);
/// A spring along z that cannot pull.
std::vector<RunnerPart> read_support(const Table& t);
/// A support whose faces rub along x.
std::vector<RunnerPart> read_side_bearer(const Table& t);
/// A pivot on four supports on its rim, whose faces rub across its radius.
std::vector<RunnerPart> read_centre_plate(const Table& t);
/// The parts of an element by its type, in an order in which those that press come first.
std::vector<RunnerPart> read_runner_parts(const Table& t);
RunnerPart placed(RunnerPart part, const BogiePlace& place);
/// Adds a part, and the same on the other side of the vehicle.
/// @param add  adds one of a side: "_left" or "_right"
void add_mirrored(const Table& t, const RunnerPart& part,
                  const std::function<void(const RunnerPart&, const std::string&)>& add);

/// Name and bodies of an element.
struct PartNames {
  std::string name;
  int a, b;
};
/// Adds parts to a runner, and at its end finds the elements that press some of them.
class RunnerParts {
 public:
  explicit RunnerParts(Runner& runner) : runner_(runner), first_(runner.elements.size()) {}
  /// @param pressers  names that the element which presses it may have, the first one first
  void add_part(const RunnerPart& part, const PartNames& names, std::vector<std::string> pressers);
  /// @param key  of `t`, to name where one is not found
  void find_pressers(const Table& t, const std::string& key);

 private:
  struct Part {
    std::size_t element;
    std::string by;
    std::vector<std::string> pressers;
  };
  Runner& runner_;
  std::size_t first_;  // of its own linear elements
  std::vector<Part> pressed_;
};

}  // namespace railstep
