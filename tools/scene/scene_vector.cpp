#include "scene/scene_vector.h"

#include <fmt/core.h>

#include <cmath>

namespace railstep {
namespace {

void check_plane(const Table& t, std::string_view key, const Eigen::Vector3d& v, bool planar) {
  if (planar && v.y() != 0.)
    t.refuse(key, "E-BODY-30",
             fmt::format("{} has y = {:.15g}, which leaves the plane of x and z; expected y = 0, "
                         "or system.planar = false",
                         key, v.y()));
}

Eigen::Vector3d unit(const Table& t, std::string_view key, const Eigen::Vector3d& v) {
  const double length = v.norm();
  if (!(length > 0.))
    t.refuse(key, "E-BODY-31",
             fmt::format("{} = [0, 0, 0] has no direction; expected a vector that is not 0", key));
  return v / length;
}

}  // namespace

Eigen::Vector3d read_vector(const Table& t, std::string_view key, const Range& accepted) {
  const std::vector<double> v = t.numbers(key, accepted, 3, 3);
  return {v[0], v[1], v[2]};
}

Eigen::Vector3d read_in_plane(const Table& t, std::string_view key, const Range& accepted,
                              bool planar) {
  Eigen::Vector3d v = read_vector(t, key, accepted);
  check_plane(t, key, v, planar);
  return v;
}

Eigen::Vector3d read_in_plane(const Table& t, std::string_view key, const Range& accepted,
                              bool planar, const Eigen::Vector3d& otherwise) {
  return t.has(key) ? read_in_plane(t, key, accepted, planar) : otherwise;
}

Eigen::Vector3d read_turn(const Table& t, std::string_view key, const Range& accepted, bool planar,
                          const Eigen::Vector3d& otherwise) {
  if (!t.has(key)) return otherwise;
  Eigen::Vector3d v = read_vector(t, key, accepted);
  if (planar && (v.x() != 0. || v.z() != 0.))
    t.refuse(key, "E-BODY-32",
             fmt::format("{} = [{:.15g}, {:.15g}, {:.15g}] turns out of the plane of x and z; "
                         "expected a turn about y alone, or system.planar = false",
                         key, v.x(), v.y(), v.z()));
  return v;
}

Eigen::Vector3d read_direction(const Table& t, std::string_view key, bool planar) {
  return unit(t, key, read_in_plane(t, key, any_number(), planar));
}

Eigen::Vector3d read_turn_axis(const Table& t, std::string_view key, bool planar) {
  if (!planar) return read_direction(t, key, false);
  const Eigen::Vector3d axis = read_turn(t, key, any_number(), true, Eigen::Vector3d::UnitY());
  if (!(axis.y() > 0.))
    t.refuse(key, "E-BODY-33",
             fmt::format("{} has y = {:.15g}, but turns in the plane are about +y; expected [0, "
                         "1, 0]",
                         key, axis.y()));
  return Eigen::Vector3d::UnitY();
}

void check_square(const Table& t, std::string_view key, const Eigen::Vector3d& a,
                  std::string_view other, const Eigen::Vector3d& b) {
  if (std::fabs(a.dot(b)) <= 1e-9) return;
  t.refuse(key, "E-BODY-34",
           fmt::format("{} stands at {:.6g} degrees to {}; expected 90 degrees", key,
                       std::acos(std::fmax(-1., std::fmin(1., a.dot(b)))) * 180. / M_PI, other));
}

}  // namespace railstep
