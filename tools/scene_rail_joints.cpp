#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene_read.h"

namespace railstep {
namespace {

constexpr double kRigid = std::numeric_limits<double>::infinity();

/// A stiffness and the damping beside it; one that may be left out is rigid without.
void read_plates(const Table& t, const std::string& motion, bool turns, double otherwise,
                 double& stiffness, double& damping) {
  const char* k = turns ? "n_m_per_rad" : "n_per_m";
  const char* c = turns ? "n_m_s_per_rad" : "n_s_per_m";
  stiffness = t.number(fmt::format("{}_stiffness_{}", motion, k), between(0.0, 1e13), otherwise);
  const std::string key = fmt::format("{}_damping_{}", motion, c);
  damping = t.number(key, between(0.0, 1e11), 0.0);
  if (damping > 0.0 && std::isinf(stiffness))
    t.refuse(key, fmt::format("{}, but the rail's ends share that motion; accepted beside "
                              "{}_stiffness_{}",
                              key, motion, k));
}

/// On a border of two elements.
double read_place(const Table& t, const TrackScene& track) {
  const double x = t.number("x_m", between(0.0, track.length()));
  const double element = track.bay / track.elements_per_bay;
  const double border = std::round(x / element), last = std::round(track.length() / element);
  if (border < 1.0 || border > last - 1.0)
    t.refuse("x_m", fmt::format("x_m = {:.15g} is at an end of the rail; accepted are joints "
                                "between its ends",
                                x));
  if (std::fabs(x / element - border) > 1e-9)
    t.refuse("x_m",
             fmt::format("x_m = {:.15g} is inside an element; a joint stands where two meet: the "
                         "nearest are {:.15g} and {:.15g}, with other elements_per_bay others",
                         x, std::floor(x / element) * element, std::ceil(x / element) * element));
  return x;
}

struct Jointed {
  RailJoint joint;
  double gap;  // m
};

Jointed read_joint(const Table& t, const Scene& scene) {
  Jointed read{};
  RailJoint& joint = read.joint;
  joint.x = read_place(t, scene.track);
  const std::size_t side = t.choice("rail", {"both", "left", "right"}, 0);
  if (scene.track.rails == 1 && side == 2)
    t.refuse("rail", "rail = \"right\", but the track has one rail; accepted is \"left\"");
  joint.rails = {side != 2, side != 1};
  (void)t.number("bending_vertical_stiffness_n_m_per_rad", between(0.0, 1e13));  // required
  read_plates(t, "along", false, 0.0, joint.stiffness[0], joint.damping[0]);
  read_plates(t, "shear_lateral", false, kRigid, joint.stiffness[1], joint.damping[1]);
  read_plates(t, "shear_vertical", false, kRigid, joint.stiffness[2], joint.damping[2]);
  read_plates(t, "twist", true, 0.0, joint.turn_stiffness[0], joint.turn_damping[0]);
  read_plates(t, "bending_vertical", true, 0.0, joint.turn_stiffness[1], joint.turn_damping[1]);
  read_plates(t, "bending_lateral", true, 0.0, joint.turn_stiffness[2], joint.turn_damping[2]);
  read.gap = t.number("gap_m", between(0.0, 0.1), 0.0);
  return read;
}

/// Warm rails grow into their gaps: each from its middle, those at the ends from there, where they
/// are held.
void check_gaps(const Table& root, const Scene& scene, int rail,
                const std::vector<Jointed>& joints) {
  const RailScene& own = rail == 1 && scene.right_rail ? *scene.right_rail : scene.rail;
  std::vector<std::pair<double, std::size_t>> cuts;
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i].joint.rails[static_cast<std::size_t>(rail)])
      cuts.emplace_back(joints[i].joint.x, i);
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const double x = cuts[i].first;
    const double before = i == 0 ? x : 0.5 * (x - cuts[i - 1].first);
    const double after =
        i + 1 == cuts.size() ? scene.track.length() - x : 0.5 * (cuts[i + 1].first - x);
    const double grown = own.expansion * own.temperature_rise * (before + after);
    const double gap = joints[cuts[i].second].gap;
    if (grown > gap)
      root.tables("rail_joint")[cuts[i].second].refuse(
          "gap_m", fmt::format("gap_m = {:.15g}, but at temperature_rise_k = {:.15g} the rails "
                               "grow by {:.3g} m into it: a closed gap presses, which is not "
                               "modelled; accepted are wider gaps, or colder rails",
                               gap, own.temperature_rise, grown));
  }
}

void check_force(const Table& rail, const Scene& scene) {
  const auto refuse = [](const Table& t) {
    t.refuse("axial_force_n",
             "axial_force_n, but the rails have joints, whose gaps carry no force; accepted is 0");
  };
  if (scene.rail.axial_force != 0.0) refuse(rail);
  if (scene.right_rail && scene.right_rail->axial_force != 0.0) refuse(rail.table("right"));
}

/// Heat makes force in a rail without gaps alone: then the rails differ.
void check_heat(const Table& rail, const Scene& scene, const std::vector<Jointed>& joints) {
  if (scene.track.rails == 1 || scene.right_rail || scene.rail.temperature_rise == 0.0) return;
  std::array<bool, 2> cut{};
  for (const Jointed& one : joints)
    for (const std::size_t side : {0u, 1u}) cut[side] = cut[side] || one.joint.rails[side];
  if (cut[0] != cut[1])
    rail.refuse("temperature_rise_k",
                "temperature_rise_k presses the rail without joints alone; accepted with joints in "
                "both rails, or with a [rail.right]");
}

}  // namespace

std::vector<RailJoint> read_joints(const Table& root, const Table& rail, const Scene& scene) {
  std::vector<Jointed> read;
  for (const Table& t : root.tables("rail_joint")) {
    read.push_back(read_joint(t, scene));
    for (std::size_t i = 0; i + 1 < read.size(); ++i)
      for (const std::size_t side : {0u, 1u})
        if (std::fabs(read[i].joint.x - read.back().joint.x) < 1e-6 && read[i].joint.rails[side] &&
            read.back().joint.rails[side])
          t.refuse("x_m", "x_m: the rail is cut there already; accepted is one joint at a place");
  }
  std::vector<RailJoint> joints;
  if (read.empty()) return joints;
  check_force(rail, scene);
  check_heat(rail, scene, read);
  for (int side = 0; side < scene.track.rails; ++side) check_gaps(root, scene, side, read);
  for (const Jointed& one : read) joints.push_back(one.joint);
  return joints;
}

}  // namespace railstep
