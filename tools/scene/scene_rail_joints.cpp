#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/scene_read.h"

namespace railstep {
namespace {

constexpr double kRigid = std::numeric_limits<double>::infinity();

/// Reads a stiffness and the damping beside it.
/// @param otherwise  stiffness where the key is absent; kRigid: the ends share the motion
void read_plates(const Table& t, const std::string& motion, bool turns, double otherwise,
                 double& stiffness, double& damping) {
  const char* k = turns ? "n_m_per_rad" : "n_per_m";
  const char* c = turns ? "n_m_s_per_rad" : "n_s_per_m";
  stiffness = t.number(fmt::format("{}_stiffness_{}", motion, k), between(0.0, 1e13), otherwise);
  const std::string key = fmt::format("{}_damping_{}", motion, c);
  damping = t.number(key, between(0.0, 1e11), 0.0);
  if (damping > 0.0 && std::isinf(stiffness))
    t.refuse(key, "E-RAILJOINT-01",
             fmt::format("{} is given, but the rail's ends share that motion; expected "
                         "{}_stiffness_{} beside it",
                         key, motion, k));
}

/// Reads x_m, the border of two elements.
double read_place(const Table& t, const TrackScene& track) {
  const double x = t.number("x_m", between(0.0, track.length()));
  const double element = track.bay / track.elements_per_bay;
  const double border = std::round(x / element), last = std::round(track.length() / element);
  if (border < 1.0 || border > last - 1.0)
    t.refuse("x_m", "E-RAILJOINT-02",
             fmt::format("x_m = {:.15g} is at an end of the rail; expected a place between its "
                         "ends",
                         x));
  if (std::fabs(x / element - border) > 1e-9)
    t.refuse("x_m", "E-RAILJOINT-03",
             fmt::format("x_m = {:.15g} is inside an element; expected a place where two elements "
                         "meet: the nearest are {:.15g} and {:.15g}, and another elements_per_bay "
                         "gives others",
                         x, std::floor(x / element) * element, std::ceil(x / element) * element));
  return x;
}

struct Jointed {
  RailJoint joint;
  JointGap gap;
};

JointGap read_gap(const Table& t) {
  JointGap gap;
  if (t.has("gap_m")) gap.cold = t.number("gap_m", between(0.0, 0.1));
  for (const char* key : {"end_stiffness_n_per_m", "end_damping_n_s_per_m"})
    if (t.has(key) && !gap.cold)
      t.refuse(key, "E-RAILJOINT-04",
               fmt::format("{} belongs to rail ends that meet; expected gap_m beside it", key));
  if (t.has("end_stiffness_n_per_m"))
    gap.end_stiffness = t.number("end_stiffness_n_per_m", above_upto(0.0, 1e13));
  gap.end_damping = t.number("end_damping_n_s_per_m", between(0.0, 1e11), 0.0);
  return gap;
}

Jointed read_joint(const Table& t, const Scene& scene) {
  Jointed read{};
  RailJoint& joint = read.joint;
  joint.x = read_place(t, scene.track);
  const std::size_t side = t.choice("rail", {"both", "left", "right"}, 0);
  if (scene.track.rails == 1 && side == 2)
    t.refuse("rail", "E-SCENE-01",
             "rail = \"right\", but the track has one rail; expected \"left\"");
  joint.rails = {side != 2, side != 1};
  (void)t.number("bending_vertical_stiffness_n_m_per_rad", between(0.0, 1e13));  // required
  read_plates(t, "along", false, 0.0, joint.stiffness[0], joint.damping[0]);
  read_plates(t, "shear_lateral", false, kRigid, joint.stiffness[1], joint.damping[1]);
  read_plates(t, "shear_vertical", false, kRigid, joint.stiffness[2], joint.damping[2]);
  read_plates(t, "twist", true, 0.0, joint.rotation_stiffness[0], joint.rotation_damping[0]);
  read_plates(t, "bending_vertical", true, 0.0, joint.rotation_stiffness[1],
              joint.rotation_damping[1]);
  read_plates(t, "bending_lateral", true, 0.0, joint.rotation_stiffness[2],
              joint.rotation_damping[2]);
  read.gap = read_gap(t);
  return read;
}

/// Whether heat closes all gaps of a rail and presses it. `cuts` are sorted by place.
bool closes_all(const std::vector<std::pair<double, std::size_t>>& cuts,
                const std::vector<Jointed>& joints, double growth) {
  double gaps = 0.0;
  for (const auto& [x, i] : cuts) {
    if (!joints[i].gap.cold) return false;
    gaps += *joints[i].gap.cold;
  }
  return growth > gaps;
}

/// Heat presses the ends alone: no plates may carry a part of the force.
void check_plates(const Table& t, const RailJoint& joint) {
  if (joint.stiffness[0] > 0.0)
    t.refuse("along_stiffness_n_per_m", "E-RAILJOINT-06",
             "along_stiffness_n_per_m is given, but heat closes the gap: plates that "
             "do not slip bear a part of its force; expected 0, a wider gap or a "
             "colder rail");
}

/// Warm rails grow into their gaps: each piece from its middle, the first and the last from the
/// held ends. Where all gaps together have room for the growth, each gap must have room for its
/// part.
void check_gaps(const Table& root, const Scene& scene, int rail, std::vector<Jointed>& joints) {
  const RailScene& own = rail == 1 && scene.right_rail ? *scene.right_rail : scene.rail;
  std::vector<std::pair<double, std::size_t>> cuts;
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].joint.rails[static_cast<std::size_t>(rail)])
      cuts.emplace_back(joints[i].joint.x, i);
  std::sort(cuts.begin(), cuts.end());
  const double strain = own.expansion * own.temperature_rise;
  const bool closed = closes_all(cuts, joints, strain * scene.track.length());
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const double x = cuts[i].first;
    const double before = i == 0 ? x : 0.5 * (x - cuts[i - 1].first);
    const double after =
        i + 1 == cuts.size() ? scene.track.length() - x : 0.5 * (cuts[i + 1].first - x);
    const double grown = strain * (before + after);
    JointGap& gap = joints[cuts[i].second].gap;
    gap.grown[static_cast<std::size_t>(rail)] = grown;
    const Table t = root.tables("rail_joint")[cuts[i].second];
    if (closed) check_plates(t, joints[cuts[i].second].joint);
    if (!closed && grown > gap.cold.value_or(0.0))
      t.refuse("gap_m", "E-RAILJOINT-07",
               fmt::format(
                   "{}, but at temperature_rise_k = {:.15g} the rails grow by {:.3g} m into "
                   "it, and not all gaps of the rail close; expected gaps in all joints "
                   "that all stay open or all close",
                   gap.cold ? fmt::format("gap_m = {:.15g}", *gap.cold) : "the joint has no gap_m",
                   own.temperature_rise, grown));
  }
}

void check_force(const Table& rail, const Scene& scene) {
  const auto refuse = [](const Table& t) {
    t.refuse("axial_force_n", "E-RAILJOINT-08",
             "axial_force_n is given, but the rails have joints, whose gaps carry no "
             "force; expected 0");
  };
  if (scene.rail.axial_force != 0.0) refuse(rail);
  if (scene.right_rail && scene.right_rail->axial_force != 0.0) refuse(rail.table("right"));
}

/// Heat presses only a rail without gaps. Where one rail has gaps and the other has none, they
/// differ.
void check_heat(const Table& rail, const Scene& scene, const std::vector<Jointed>& joints) {
  if (scene.track.rails == 1 || scene.right_rail || scene.rail.temperature_rise == 0.0) return;
  std::array<bool, 2> cut{};
  for (const Jointed& one : joints)
    for (const std::size_t side : {0u, 1u}) cut[side] = cut[side] || one.joint.rails[side];
  if (cut[0] != cut[1])
    rail.refuse("temperature_rise_k", "E-RAILJOINT-09",
                "temperature_rise_k presses only the rail without joints; expected "
                "joints in both rails, or a [rail.right]");
}

}  // namespace

void read_joints(const Table& root, const Table& rail, Scene& scene) {
  std::vector<Jointed> read;
  for (const Table& t : root.tables("rail_joint")) {
    read.push_back(read_joint(t, scene));
    for (std::size_t i = 0; i + 1 < read.size(); ++i)
      for (const std::size_t side : {0u, 1u})
        if (std::fabs(read[i].joint.x - read.back().joint.x) < 1e-6 && read[i].joint.rails[side] &&
            read.back().joint.rails[side])
          t.refuse(
              "x_m", "E-RAILJOINT-10",
              fmt::format("x_m = {:.15g}: the rail is cut there already; expected one joint at a "
                          "place",
                          read.back().joint.x));
  }
  if (read.empty()) return;
  check_force(rail, scene);
  check_heat(rail, scene, read);
  for (int side = 0; side < scene.track.rails; ++side) check_gaps(root, scene, side, read);
  for (const Jointed& one : read) {
    scene.joints.push_back(one.joint);
    scene.joint_gaps.push_back(one.gap);
  }
}

}  // namespace railstep
