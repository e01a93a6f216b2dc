#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "scene/scene_read.h"
#include "scene/scene_system_read.h"
#include "scene/scene_vector.h"

namespace railstep {
namespace {

/// Reads the tensor [Ixx, Iyy, Izz], with or without [Ixy, Ixz, Iyz] behind. Refuses one that no
/// mass has.
Eigen::Matrix3d read_inertia(const Table& t, bool planar) {
  const char* const key = "inertia_kg_m2";
  const std::vector<double> i = t.numbers(key, between(-1e12, 1e12), 3, 6);
  if (i.size() != 3 && i.size() != 6)
    t.refuse(key, "E-BODY-13",
             fmt::format("{} has {} entries; expected 3 (Ixx, Iyy, Izz) or 6 (Ixy, Ixz, Iyz "
                         "behind them)",
                         key, i.size()));
  Eigen::Matrix3d inertia = Eigen::Vector3d(i[0], i[1], i[2]).asDiagonal();
  if (i.size() == 6) {
    inertia(0, 1) = inertia(1, 0) = i[3];
    inertia(0, 2) = inertia(2, 0) = i[4];
    inertia(1, 2) = inertia(2, 1) = i[5];
    if (planar && (i[3] != 0. || i[5] != 0.))
      t.refuse(key, "E-BODY-14",
               "Ixy and Iyz turn a body out of the plane of x and z; expected 0 for "
               "both, or system.planar = false");
  }
  const Eigen::Vector3d p =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(p[0] > 0.))
    t.refuse(
        key, "E-BODY-15",
        fmt::format("{} has a least principal inertia of {:.6g}; expected above 0", key, p[0]));
  // A flat body has equality, which decimals miss by their rounding.
  if (p[2] > (p[0] + p[1]) * (1. + 1e-9))
    t.refuse(key, "E-BODY-16",
             fmt::format("{} has principal inertias {:.6g}, {:.6g} and {:.6g}, which no mass can "
                         "have; expected each at most the sum of the two others",
                         key, p[0], p[1], p[2]));
  return inertia;
}

RigidBody read_body(const Table& t, bool planar) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  RigidBody b;
  b.mass = t.number("mass_kg", above_upto(0.0, 1e9));
  b.inertia = read_inertia(t, planar);
  b.position = read_in_plane(t, "position_m", kPlace, planar);
  const Eigen::Vector3d turn =
      read_turn(t, "rotation_deg", between(-360.0, 360.0), planar, zero) * (M_PI / 180.);
  if (turn.norm() > 0.) b.orientation = Eigen::AngleAxisd(turn.norm(), turn.normalized());
  b.velocity = read_in_plane(t, "velocity_m_per_s", kVelocity, planar, zero);
  b.angular_velocity = read_turn(t, "angular_velocity_rad_per_s", kTurning, planar, zero);
  return b;
}

/// Columns along the beam, lateral and up.
Eigen::Matrix3d read_axes(const Table& t, bool planar) {
  const Eigen::Vector3d along =
      t.has("direction") ? read_direction(t, "direction", planar) : Eigen::Vector3d::UnitX();
  if (!t.has("up") && along.y() != 0.)
    t.refuse("direction", "E-BODY-17",
             "the beam leaves the plane of x and z, but key 'up' is missing; expected "
             "up, which has a default only in that plane");
  const Eigen::Vector3d up = t.has("up") ? read_direction(t, "up", planar)
                                         : Eigen::Vector3d(along.cross(Eigen::Vector3d::UnitY()));
  check_square(t, "up", up, "the beam's direction", along);
  const Eigen::Vector3d lateral = up.cross(along).normalized();
  if (planar && lateral.y() < 0.)
    t.refuse("up", "E-BODY-18",
             "up puts the section's left on the ground's right; expected the opposite "
             "direction in the plane of x and z");
  Eigen::Matrix3d axes;
  axes << along, lateral, along.cross(lateral);
  return axes;
}

std::array<BeamEnd, 2> read_beam_ends(const Table& t) {
  constexpr BeamEnd kEnds[] = {BeamEnd::free, BeamEnd::pinned, BeamEnd::clamped};
  const auto ends = t.choices("ends", {"free", "pinned", "clamped"}, 2, 0);
  return {kEnds[ends[0]], kEnds[ends[1]]};
}

FlexibleBeam read_beam(const Table& t, bool planar) {
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  FlexibleBeam b;
  b.start = read_in_plane(t, "start_m", kPlace, planar);
  b.axes = read_axes(t, planar);
  b.length = t.number("length_m", between(1e-3, 1e4));
  b.elements = static_cast<int>(t.integer("elements", 1, 1000));
  b.ends = read_beam_ends(t);
  b.velocity = read_in_plane(t, "velocity_m_per_s", kVelocity, planar, zero);
  b.angular_velocity = read_turn(t, "angular_velocity_rad_per_s", kTurning, planar, zero);
  return b;
}

/// The largest distance between two points of a section, m; for a shape in a file the largest that
/// such a file may have.
double extent(const SectionSource& shape) {
  if (const auto* r = std::get_if<RectangleSize>(&shape)) return std::hypot(r->height, r->width);
  if (const auto* r = std::get_if<RectangleSizes>(&shape))
    return std::hypot(r->foot_height + r->web_height + r->head_height,
                      std::fmax(r->foot_width, std::fmax(r->web_width, r->head_width)));
  return 1.;
}

}  // namespace

std::string NameBook::claim(const Table& t) {
  std::string name = checked_name(t, "name", t.string("name"));
  if (name == "ground")
    t.refuse("name", "E-BODY-19",
             "name = \"ground\" is kept for the ground, which does not move; expected "
             "another name");
  claim(t, "name", name);
  return name;
}

void NameBook::claim(const Table& t, std::string_view key, const std::string& name) {
  const auto [first, is_new] = owner_.emplace(name, t.name());
  if (!is_new)
    t.refuse(key, "E-RUNNER-19",
             fmt::format("{} = \"{}\" is taken by [{}]; expected a name that is used once", key,
                         name, first->second));
}

namespace {

/// Name of a body or a beam. Beside a track it differs from the words for `on` of a sensor.
std::string claim_part(const Table& t, const SystemScene& scene, NameBook& names) {
  std::string name = names.claim(t);
  for (const char* kept : {"rail", "sleeper", "wheelset"})
    if (scene.track && name == kept)
      t.refuse(
          "name", "E-BODY-21",
          fmt::format("name = \"{}\" is kept for sensors on a track; expected another name", name));
  return name;
}

}  // namespace

bool read_bodies(const Table& root, SystemScene& scene, NameBook& names) {
  return root.each("body", [&](const Table& t) {
    scene.names.bodies.push_back(claim_part(t, scene, names));
    scene.system.bodies.push_back(read_body(t, scene.system.planar));
  });
}

bool read_beams(const Table& root, SystemScene& scene, NameBook& names) {
  return root.each("beam", [&](const Table& t) {
    scene.names.beams.push_back(claim_part(t, scene, names));
    scene.system.beams.push_back(read_beam(t, scene.system.planar));
    scene.bars.push_back({read_bar(t), read_reference_line(t)});
    if (std::holds_alternative<Section>(scene.bars.back().bar.shape))
      t.refuse("constants", "E-BODY-22",
               "a beam that turns needs its section's shape, for moments of third and "
               "fourth degree; expected profile, section, rectangles or rectangle");
  });
}

Part read_part(const Table& t, std::string_view key, const std::string& name,
               const SystemScene& scene, Naming naming) {
  const bool held = naming == Naming::held;
  if (held && name == "ground") return ground();
  std::string known = held ? "\"ground\"" : "";
  const auto list = [&](const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) return static_cast<int>(i);
      known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", names[i]);
    }
    return -1;
  };
  if (const int i = list(scene.names.bodies); i >= 0) return body(i);
  if (const int i = list(scene.names.beams); i >= 0) return beam(i);
  const int rails = scene.track ? scene.track->track.rails : 0;
  if (held && rails > 0)
    if (const int i = list(rails == 2 ? std::vector<std::string>{"rail left", "rail right"}
                                      : std::vector<std::string>{"rail left"});
        i >= 0)
      return rail(i);
  if (naming == Naming::sensed && rails > 0) known += ", \"rail\", \"sleeper\"";
  const auto sentence = [&](const char* what) {
    return fmt::format("{} has \"{}\", which is {}; expected {}", key, name.substr(0, 64), what,
                       known);
  };
  if (!name.starts_with("rail ")) t.refuse(key, "E-BODY-23", sentence("unknown"));
  if (rails == 0) t.refuse(key, "E-BODY-36", sentence("a rail, but the scene has no track"));
  if (held) t.refuse(key, "E-BODY-37", sentence("a rail that the track does not have"));
  if (naming == Naming::driven)
    t.refuse(key, "E-BODY-38", sentence("a rail, on which a force is a [[load]]"));
  t.refuse(key, "E-BODY-39", sentence("a rail, on which a sensor has on = \"rail\" and rail"));
}

namespace {

/// Refuses a point beyond a bar's ends or outside its section's reach.
void check_reach(const Table& t, std::string_view key, const std::string& bar,
                 const Eigen::Vector3d& local, double length, const SectionSource& shape) {
  // 1e-9 of the length forgives the rounding of decimals.
  if (local.x() < -1e-9 * length || local.x() > length * (1. + 1e-9))
    t.refuse(key, "E-BODY-24",
             fmt::format("{} is at {:.6g} m along {}; expected 0 to {:.6g} m", key, local.x(), bar,
                         length));
  const double across = std::hypot(local.y(), local.z());
  const double most = extent(shape);
  if (across > most)
    t.refuse(key, "E-BODY-25",
             fmt::format("{} is {:.6g} m beside {}; expected at most {:.6g} m, the size of its "
                         "section",
                         key, across, bar, most));
}

}  // namespace

Eigen::Vector3d read_point(const Table& t, std::string_view key, const Part& part,
                           const SystemScene& scene) {
  Eigen::Vector3d point = read_in_plane(t, key, kPlace, scene.system.planar);
  const auto index = static_cast<std::size_t>(part.index);
  if (part.kind == Part::Kind::beam) {
    const FlexibleBeam& b = scene.system.beams[index];
    check_reach(t, key, fmt::format("beam \"{}\"", scene.names.beams[index]),
                b.axes.transpose() * (point - b.start), b.length, scene.bars[index].bar.shape);
  } else if (part.kind == Part::Kind::rail) {
    const TrackScene& track = scene.track->track;
    const double side = track.rails == 1 ? 0. : (index == 0 ? .5 : -.5) * track.rail_spacing;
    check_reach(t, key, index == 0 ? "the left rail" : "the right rail",
                point - Eigen::Vector3d(0., side, 0.), track.length(), scene.track->rail.shape);
    point.x() = std::clamp(point.x(), 0., track.length());
  }
  return point;
}

}  // namespace railstep
