#include <fmt/core.h>

#include <algorithm>

#include "scene/scene_read.h"
#include "scene/scene_system_read.h"
#include "scene/scene_vector.h"

namespace railstep {
namespace {

enum class Axis { none, turn, slide, both };  // turn: about +y in the plane; both: not in the plane

/// The keys that a kind of joint has.
struct JointForm {
  const char* name;
  JointKind kind;
  Axis axis;
  const char* motion = nullptr;  // unit of its drive
  bool may_stand = false;        // may be without a drive
};
constexpr JointForm kForms[] = {
    {"spherical", JointKind::spherical, Axis::none},
    {"revolute", JointKind::revolute, Axis::turn},
    {"prismatic", JointKind::prismatic, Axis::slide},
    {"cylindrical", JointKind::cylindrical, Axis::both},
    {"fixed", JointKind::fixed, Axis::none},
    {"distance", JointKind::distance, Axis::none, "m", true},
    {"point-on-line", JointKind::point_on_line, Axis::slide},
    {"point-on-plane", JointKind::point_on_plane, Axis::slide},
    {"universal", JointKind::universal, Axis::both},
    {"translation", JointKind::translation, Axis::slide, "m"},
    {"rotation", JointKind::rotation, Axis::turn, "rad"},
};

const JointForm& read_form(const Table& t) {
  return kForms[t.choice(
      "kind", {"spherical", "revolute", "prismatic", "cylindrical", "fixed", "distance",
               "point-on-line", "point-on-plane", "universal", "translation", "rotation"})];
}

/// `between`: two parts that differ.
std::array<Part, 2> read_between(const Table& t, const SystemScene& scene) {
  const std::vector<std::string> names = t.strings("between", 2, 2);
  const Part a = read_part(t, "between", names[0], scene, Naming::held);
  const Part b = read_part(t, "between", names[1], scene, Naming::held);
  if (names[0] == names[1])
    t.refuse("between", "E-JOINT-01",
             fmt::format("between names \"{}\" twice; expected two different parts", names[0]));
  return {a, b};
}

/// Rows [time, value] with rising times from 0 on.
std::vector<std::array<double, 2>> read_motion_table(const Table& t, const std::string& key,
                                                     const Range& accepted) {
  const std::vector<double> rows = read_time_table(t, key, accepted);
  std::vector<std::array<double, 2>> table;
  for (std::size_t i = 0; i < rows.size(); i += 2) table.push_back({rows[i], rows[i + 1]});
  if (table.size() < 2)
    t.refuse(key, "E-JOINT-04", fmt::format("{} has 1 row; expected 2 or more", key));
  return table;
}

/// A polynomial or a table of that unit, exactly one.
Motion read_motion(const Table& t, const std::string& unit, const Range& accepted) {
  const std::string polynomial = "polynomial_" + unit, table = "table_" + unit;
  if (t.has(polynomial) && t.has(table))
    t.refuse(table, "E-JOINT-05",
             fmt::format("{} is given beside {}; expected one of them", table, polynomial));
  Motion motion;
  if (t.has(table))
    motion.table = read_motion_table(t, table, accepted);
  else
    motion.polynomial = t.numbers(polynomial, accepted, 1, kMotionCoefficients);
  return motion;
}

/// Reads a drive, which begins at 0.
Motion read_drive(const Table& t, const std::string& unit) {
  Motion motion = read_motion(t, unit, between(-1e6, 1e6));
  const bool tabled = !motion.table.empty();
  const double start = tabled ? motion.table[0][1] : motion.polynomial[0];
  if (start != 0.)
    t.refuse((tabled ? "table_" : "polynomial_") + unit, "E-JOINT-06",
             fmt::format("the motion begins at {:.15g} {}, but the parts stand where it is 0; "
                         "expected a motion that begins at 0",
                         start, unit));
  return motion;
}

/// Whether a joint has a drive.
bool is_driven(const Table& t, const JointForm& form) {
  if (form.motion == nullptr) return false;
  const std::string unit = form.motion, polynomial = "polynomial_" + unit, table = "table_" + unit;
  return !form.may_stand || t.has(polynomial) || t.has(table);
}

/// The distance of two points over time: their distance at the start and its change.
Motion around_length(const Table& t, Motion change, double length) {
  if (change.table.empty()) change.polynomial[0] = length;
  for (std::array<double, 2>& row : change.table)
    if ((row[1] += length) <= 0.)
      t.refuse("table_m", "E-JOINT-07",
               fmt::format("table_m shortens a distance of {:.6g} m by {:.6g} m; expected a "
                           "distance that stays above 0",
                           length, length - row[1]));
  return change;
}

/// Refuses keys that only other kinds of joint have.
void refuse_foreign(const Table& t, const JointForm& form) {
  const auto refuse = [&](const char* key, bool wanted) {
    if (!wanted && t.has(key))
      t.refuse(key, "E-JOINT-08",
               fmt::format("{} does not belong to a {} joint; expected the joint without it", key,
                           form.name));
  };
  refuse("axis", form.axis != Axis::none);
  refuse("other_point_m", form.kind == JointKind::distance);
  refuse("other_axis", form.kind == JointKind::universal);
  const std::string unit = form.motion ? form.motion : "";
  for (const char* other : {"m", "rad"}) {
    refuse(fmt::format("polynomial_{}", other).c_str(), unit == other);
    refuse(fmt::format("table_{}", other).c_str(), unit == other);
  }
}

Joint read_joint(const Table& t, const SystemScene& scene) {
  const bool planar = scene.system.planar;
  const JointForm& form = read_form(t);
  if (planar && form.axis == Axis::both)
    t.refuse("kind", "E-JOINT-09",
             fmt::format("a {} joint leaves the plane of x and z; expected another kind, or "
                         "system.planar = false",
                         form.name));
  refuse_foreign(t, form);
  Joint j;
  j.kind = form.kind;
  const auto [a, b] = read_between(t, scene);
  j.a = a;
  j.b = b;
  j.point = read_point(t, "point_m", a, scene);
  if (form.kind == JointKind::distance) {
    j.other_point = read_point(t, "other_point_m", b, scene);
    if (j.other_point == j.point)
      t.refuse("other_point_m", "E-JOINT-10",
               "other_point_m is the same as point_m, and a distance of 0 cannot be "
               "held; expected another point, or a spherical joint");
  } else {
    static_cast<void>(read_point(t, "point_m", b, scene));  // it is on both
  }
  if (form.axis == Axis::turn)
    j.axis = read_turn_axis(t, "axis", planar);
  else if (form.axis != Axis::none)
    j.axis = read_direction(t, "axis", planar);
  if (form.kind == JointKind::universal) {
    j.other_axis = read_direction(t, "other_axis", false);
    check_square(t, "other_axis", j.other_axis, "axis", j.axis);
  }
  if (is_driven(t, form)) j.motion = read_drive(t, form.motion);
  if (is_driven(t, form) && form.kind == JointKind::distance)
    j.motion = around_length(t, j.motion, (j.other_point - j.point).norm());
  return j;
}

SpringDamper read_spring_damper(const Table& t, const SystemScene& scene) {
  SpringDamper s;
  const auto [a, b] = read_between(t, scene);
  s.a = a;
  s.b = b;
  s.point_a = read_point(t, "point_m", a, scene);
  s.point_b = read_point(t, "other_point_m", b, scene);
  if (s.point_a == s.point_b)
    t.refuse("other_point_m", "E-JOINT-11",
             "other_point_m is the same as point_m, and a spring of no length has no "
             "direction; expected another point");
  s.stiffness = t.number("stiffness_n_per_m", between(0.0, 1e13), 0.0);
  s.damping = t.number("damping_n_s_per_m", between(0.0, 1e11), 0.0);
  if (s.stiffness == 0. && s.damping == 0.)
    t.refuse("stiffness_n_per_m", "E-JOINT-12",
             "the spring has neither stiffness_n_per_m nor damping_n_s_per_m above 0; "
             "expected at least one of them");
  if (t.has("length_m")) s.length = t.number("length_m", above_upto(0.0, 1e4));
  return s;
}

/// A constant, a polynomial or a table, of force or of moment.
Motion read_force_over_time(const Table& t, const std::string& constant, const std::string& unit) {
  const Range accepted = between(-1e12, 1e12);
  if (!t.has(constant)) return read_motion(t, unit, accepted);
  for (const char* way : {"polynomial_", "table_"})
    if (t.has(way + unit))
      t.refuse(way + unit, "E-JOINT-05",
               fmt::format("{}{} is given beside {}; expected one of them", way, unit, constant));
  Motion motion;
  motion.polynomial = {t.number(constant, accepted)};
  return motion;
}

/// Sets the magnitude of a force, over time or frame by frame.
void set_size(const Table& t, SystemScene& scene, SystemForce& force) {
  const char* const constant = force.moment ? "moment_n_m" : "force_n";
  const char* const unit = force.moment ? "n_m" : "n";
  if (!t.has("input")) {
    force.factor = read_force_over_time(t, constant, unit);
    return;
  }
  for (const std::string& key :
       {std::string(constant), fmt::format("polynomial_{}", unit), fmt::format("table_{}", unit)})
    if (t.has(key))
      t.refuse(key, "E-JOINT-05",
               fmt::format("{} is given beside input; expected one of them", key));
  force.input = read_input(t, force.moment ? "moment_n_m" : "force_n", scene.inputs);
}

void read_force(const Table& t, SystemScene& scene) {
  const bool planar = scene.system.planar;
  auto& force = scene.system.forces.emplace_back();
  force.on = read_part(t, "on", t.string("on"), scene, Naming::driven);
  force.moment =
      t.has("moment_n_m") || t.has("polynomial_n_m") || t.has("table_n_m") || t.has("limit_n_m");
  if (force.moment) {
    for (const char* key : {"force_n", "polynomial_n", "table_n", "limit_n", "point_m"})
      if (t.has(key))
        t.refuse(
            key, "E-JOINT-15",
            fmt::format("{} is given beside a moment; expected the keys of a force or those of a "
                        "moment",
                        key));
    if (force.on.kind != Part::Kind::body)
      t.refuse("on", "E-JOINT-16", "a moment does not act on a beam; expected a body");
    force.direction = read_turn_axis(t, "direction", planar);
    set_size(t, scene, force);
    return;
  }
  force.point = read_point(t, "point_m", force.on, scene);
  force.direction = read_direction(t, "direction", planar);
  set_size(t, scene, force);
}

}  // namespace

void read_joints(const Table& root, SystemScene& scene, NameBook& names) {
  root.each("joint", [&](const Table& t) {
    scene.names.joints.push_back(names.claim(t));
    if (t.boolean("trace", false))
      scene.traced.joints.push_back(static_cast<int>(scene.system.joints.size()));
    scene.system.joints.push_back(read_joint(t, scene));
  });
}

void read_springs(const Table& root, SystemScene& scene, NameBook& names) {
  root.each("spring", [&](const Table& t) {
    scene.names.springs.push_back(t.has("name") ? names.claim(t) : "");
    if (t.boolean("trace", false)) {
      if (!t.has("name"))
        t.refuse("trace", "E-JOINT-17",
                 "trace = true needs a name for the spring's column, but key 'name' is "
                 "missing; expected a name");
      scene.traced.springs.push_back(static_cast<int>(scene.system.springs.size()));
    }
    scene.system.springs.push_back(read_spring_damper(t, scene));
  });
}

void read_forces(const Table& root, SystemScene& scene) {
  root.each("force", [&](const Table& t) { read_force(t, scene); });
}

void read_system_sensors(const Table& root, SystemScene& scene, NameBook& names) {
  root.each("sensor", [&](const Table& t) {
    const std::string name = names.claim(t), on = t.string("on");
    if (scene.track && (on == "rail" || on == "sleeper")) {
      scene.track->sensors.push_back(read_sensor(t, *scene.track));
      return;
    }
    scene.names.sensors.push_back(name);
    SystemSensor sensor;
    sensor.on = read_part(t, "on", on, scene, Naming::sensed);
    const auto index = static_cast<std::size_t>(sensor.on.index);
    if (sensor.on.kind == Part::Kind::body && !t.has("position_m"))
      sensor.point = scene.system.bodies[index].position;
    else
      sensor.point = read_point(t, "position_m", sensor.on, scene);
    scene.system.sensors.push_back(sensor);
  });
}

}  // namespace railstep
