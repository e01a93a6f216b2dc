// A random system of bodies, beams, joints, drives and springs, alone or on the rails of a track.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "generators.h"

namespace railstep::property {
namespace {

using Eigen::Vector3d;

Document row(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Builds a scene. Every part hangs on one that exists, so joints close no loops and are not
/// redundant.
class Maker {
 public:
  Maker(std::uint64_t seed, Document& to) : draw_(seed, 2), scene_(to) {}
  void make();

 private:
  struct Placed {
    std::string name;
    Vector3d at;
    bool flies = false;
  };

  Vector3d around(const Vector3d& middle, double reach);
  Vector3d upward() { return around(Vector3d(0., 0., 1.), .8); }
  void add_track();
  void add_step();
  void add_body(int n);
  void hang(const Placed& parent, const Placed& child, int n);
  void add_drive(const Document& joint);
  void add_beam();
  void add_spring(const Placed& a, const Placed& b, double stiffness);
  void add_feet(const Placed& body);
  void add_springs();
  void add_forces();
  void add_sensors();
  const Placed& any_body() {
    return bodies_[static_cast<std::size_t>(draw_.whole(0, static_cast<int>(bodies_.size()) - 1))];
  }

  Draw draw_;
  Document& scene_;
  bool planar_ = false, on_track_ = false, driven_ = false, slides_ = false;
  Vector3d middle_ = Vector3d::Zero();
  std::vector<Placed> bodies_;
  int springs_ = 0;
};

Vector3d Maker::around(const Vector3d& middle, double reach) {
  const double x = draw_.between(-reach, reach), z = draw_.between(-reach, reach);
  const double y = planar_ ? 0. : draw_.between(-reach, reach);
  return middle + Vector3d(x, y, z);
}

void Maker::add_track() {
  const char* unknowns = draw_.one_of({"vertical", "full", "rigid-section"});
  add_ground(draw_, {unknowns, planar_ ? 1 : draw_.whole(1, 2), draw_.whole(4, 6)}, scene_);
  for (const char* table : {"support", "ballast"})
    if (scene_.contains(table)) scene_[table].erase("unilateral");
  scene_["track"]["ends"] = {draw_.one_of({"free", "pinned"}), draw_.one_of({"free", "clamped"})};
  middle_ = Vector3d(.5 * length_of(scene_), 0., .8);
}

void Maker::add_step() {
  Document& step = scene_["step"];
  const double dt = draw_.one_of({1e-4, 2e-4, 5e-4, 1e-3});
  const int in_frame = draw_.one_of({1, 1, 2, 4}), frames = draw_.whole(20, 60);
  step["dt_s"] = dt;
  step["frame_s"] = in_frame * dt;
  step["duration_s"] = frames * in_frame * dt;
  step["start"] = draw_.chance(.25) ? "equilibrium" : "released";
  step["scheme"] = on_track_
                       ? draw_.one_of({"generalised-alpha", "backward-euler", "newmark", "hht"})
                       : draw_.one_of({"generalised-alpha", "generalised-alpha", "backward-euler",
                                       "hht", "energy-momentum"});
  if (step["scheme"] == "generalised-alpha") step["rho_inf"] = draw_.one_of({0., .6, .9});
  Document& joints = scene_["joints"];
  joints["tolerance_m"] = 1e-13;  // so that only rounding is compared
  joints["force_tolerance"] = 1e-12;
  if (!draw_.chance(.3)) return;
  joints["hold"] = step["scheme"] == "generalised-alpha" && !on_track_
                       ? draw_.one_of({"baumgarte", "direct", "gear-gupta-leimkuhler"})
                       : "augmented-lagrangian";
  joints["tangent"] = draw_.one_of({"iteration", "step"});
}

void Maker::add_body(int n) {
  const double mass = draw_.of_any_size(.5, 200.), size = mass * draw_.of_any_size(5e-3, .05);
  Placed placed{fmt::format("body_{}", n), around(middle_, .4)};
  Document b = {{"name", placed.name}, {"mass_kg", mass}};
  b["inertia_kg_m2"] = {size, 1.3 * size, 1.6 * size};
  if (!planar_ && draw_.chance(.3))
    for (const double product : {.1, -.05, .08}) b["inertia_kg_m2"].push_back(product * size);
  b["position_m"] = row(placed.at);
  if (!planar_ && draw_.chance(.3)) b["rotation_deg"] = row(around(Vector3d::Zero(), 90.));
  const bool first = bodies_.empty(), ground = first || draw_.chance(.4);
  scene_["body"].push_back(b);
  if (on_track_ && first) {  // guided along z, so that springs hold it
    scene_["joint"].push_back({{"name", "guide"},
                               {"kind", "prismatic"},
                               {"between", {"ground", placed.name}},
                               {"point_m", row(placed.at)},
                               {"axis", {0., 0., 1.}}});
  } else if (draw_.chance(.85)) {
    hang(ground ? Placed{"ground", around(middle_, .4)} : any_body(), placed, n);
  } else {
    placed.flies = true;
    scene_["body"].back()["velocity_m_per_s"] = row(around(Vector3d::Zero(), 2.));
    scene_["body"].back()["angular_velocity_rad_per_s"] =
        row(planar_ ? Vector3d(0., draw_.between(-10., 10.), 0.) : around(Vector3d::Zero(), 10.));
  }
  bodies_.push_back(placed);
}

void Maker::hang(const Placed& parent, const Placed& child, int n) {
  const std::string kind =
      planar_ ? draw_.one_of({"revolute", "revolute", "prismatic", "distance", "point-on-line"})
              : draw_.one_of({"revolute", "revolute", "spherical", "prismatic", "cylindrical",
                              "universal", "distance", "point-on-line", "point-on-plane", "fixed"});
  Document j = {{"name", fmt::format("joint_{}", n)},
                {"kind", kind},
                {"between", {parent.name, child.name}},
                {"point_m", row(parent.at)}};
  if (kind == "distance") j["other_point_m"] = row(around(child.at, .05));
  if (kind != "spherical" && kind != "distance" && kind != "fixed") {
    const bool turns = planar_ && kind == "revolute";
    const Vector3d axis = turns ? Vector3d(0., 1., 0.) : upward();
    j["axis"] = row(axis);
    if (kind == "universal") j["other_axis"] = row(axis.unitOrthogonal());
  }
  slides_ = slides_ || kind == "prismatic" || kind == "cylindrical" || kind.starts_with("point-on");
  if (draw_.chance(.5)) j["trace"] = true;
  scene_["joint"].push_back(j);
  if (kind == "revolute" && !driven_ && draw_.chance(.4)) add_drive(j);
}

void Maker::add_drive(const Document& joint) {
  driven_ = true;
  Document drive = {{"name", "drive"},
                    {"kind", "rotation"},
                    {"between", joint["between"]},
                    {"point_m", joint["point_m"]},
                    {"axis", joint["axis"]}};
  const double end = duration_of(scene_), turn = draw_.between(-20., 20.) * end;
  if (draw_.chance(.6))
    drive["polynomial_rad"] = {0., 0., turn / (end * end)};
  else
    drive["table_rad"] = {{0., 0.}, {.5 * end, .3 * turn}, {end, turn}};
  scene_["joint"].push_back(drive);
}

void Maker::add_beam() {
  const double length = draw_.of_any_size(.3, 1.);
  const Vector3d start = around(middle_, .4) + Vector3d(0., planar_ ? 0. : .6, 0.);
  Document b = {{"name", "beam"}, {"start_m", row(start)}};
  const Vector3d along = draw_.chance(.5) ? Vector3d::UnitX() : Vector3d(.8, 0., .6);
  b["direction"] = row(along);
  b["up"] = row(Vector3d(-along.z(), 0., along.x()));
  b["length_m"] = length;
  b["elements"] = draw_.whole(1, 3);
  b["ends"] = {draw_.one_of({"clamped", "pinned", "free"}), "free"};
  b["young_pa"] = draw_.of_any_size(1e8, 2e11);
  b["poisson"] = .3;
  b["density_kg_per_m3"] = draw_.of_any_size(1000., 8000.);
  b["rectangle"] = {{"height_m", draw_.of_any_size(.01, .04)},
                    {"width_m", draw_.of_any_size(.01, .04)}};
  scene_["beam"].push_back(b);
  const Placed& held = any_body();
  if (draw_.chance(.5) && !held.flies)  // a hinge would stop a flying body at once
    scene_["joint"].push_back({{"name", "hinge"},
                               {"kind", "spherical"},
                               {"between", {"beam", held.name}},
                               {"point_m", row(start + length * along)},
                               {"trace", true}});
  scene_["sensor"].push_back(
      {{"name", "tip"}, {"on", "beam"}, {"position_m", row(start + length * along)}});
}

void Maker::add_spring(const Placed& a, const Placed& b, double stiffness) {
  Document s = {{"name", fmt::format("spring_{}", springs_++)},
                {"between", {a.name, b.name}},
                {"point_m", row(a.at)},
                {"other_point_m", row(b.at)},
                {"stiffness_n_per_m", stiffness}};
  if (draw_.chance(.6)) s["damping_n_s_per_m"] = stiffness * draw_.of_any_size(1e-4, 1e-2);
  if (draw_.chance(.3)) s["length_m"] = (b.at - a.at).norm() * draw_.between(.7, 1.3);
  if (draw_.chance(.5)) s["trace"] = true;
  scene_["spring"].push_back(s);
}

/// Adds springs from each rail to a body over it.
void Maker::add_feet(const Placed& body) {
  const int rails = static_cast<int>(number(scene_["track"], "rails"));
  const double stiffness = draw_.of_any_size(1e5, 1e7);
  for (int rail = 0; rail < rails; ++rail)
    for (const double ahead : {-.1, .2}) {
      const double y = rails == 1 ? 0. : rail == 0 ? .75 : -.75;
      const Vector3d under(body.at.x() + ahead, y, 0.);
      add_spring({rail == 0 ? "rail left" : "rail right", under},
                 {body.name, under + Vector3d(0., 0., .3)}, stiffness);
    }
}

void Maker::add_springs() {
  for (int n = draw_.whole(0, 2); n > 0; --n) {
    const Placed& a = any_body();
    const Placed& b = any_body();
    const bool ground = a.name == b.name;
    const Placed to{ground ? "ground" : b.name, around(ground ? middle_ : b.at, ground ? .8 : .05)};
    add_spring({a.name, around(a.at, .1)}, to, draw_.of_any_size(1e2, 1e6));
  }
}

void Maker::add_forces() {
  for (int n = draw_.whole(0, 2); n > 0; --n) {
    const Placed& on = any_body();
    Document f = {{"on", on.name}};
    const double size = draw_.of_any_size(1., 500.);
    const bool moment = draw_.chance(.3);
    if (!moment) f["point_m"] = row(around(on.at, .1));
    f["direction"] = row(moment && planar_ ? Vector3d(0., 1., 0.) : upward());
    const std::string unit = moment ? "n_m" : "n";
    const double end = duration_of(scene_);
    switch (draw_.whole(0, 2)) {
      case 0:
        f[(moment ? "moment_" : "force_") + unit] = size;
        break;
      case 1:
        f["polynomial_" + unit] = {size, -size / end};
        break;
      default:
        f["table_" + unit] = {{0., 0.}, {.4 * end, size}, {end, -size}};
    }
    scene_["force"].push_back(f);
  }
}

void Maker::add_sensors() {
  for (const Placed& b : bodies_) {
    Document s = {{"name", "of_" + b.name}, {"on", b.name}};
    if (draw_.chance(.5)) s["position_m"] = row(around(b.at, .2));
    scene_["sensor"].push_back(s);
  }
  if (!on_track_) return;
  Document s = {{"name", "rail_point"}, {"on", "rail"}};
  if (number(scene_["track"], "rails") == 2.) s["rail"] = draw_.one_of({"left", "right"});
  s["position_m"] = draw_.between(.2, .8) * length_of(scene_);
  scene_["sensor"].push_back(s);
}

void Maker::make() {
  scene_["schema"] = 1;
  on_track_ = draw_.chance(.25);
  planar_ = draw_.chance(.35);
  if (on_track_) add_track();
  add_step();
  scene_["system"] = {{"planar", planar_},
                      {"gravity_m_per_s2", {0., 0., draw_.chance(.8) ? -9.81 : 0.}}};
  for (int n = 0, all = draw_.whole(1, 4); n < all; ++n) add_body(n);
  if (on_track_) add_feet(bodies_.front());
  if (draw_.chance(.35)) add_beam();
  add_springs();
  add_forces();
  add_sensors();
  if (slides_) scene_["step"]["start"] = "released";  // without equilibrium
  if (on_track_ && draw_.chance(.4)) {
    scene_["load"].push_back({{"name", "passing"},
                              {"start_m", .2 * length_of(scene_)},
                              {"speed_m_per_s", .5 * length_of(scene_) / duration_of(scene_) > 200.
                                                    ? 200.
                                                    : .5 * length_of(scene_) / duration_of(scene_)},
                              {"force_z_n", -draw_.of_any_size(1e3, 1e5)}});
    if (number(scene_["track"], "rails") == 2.)
      scene_["load"][0]["rail"] = draw_.one_of({"left", "right"});
  }
}

}  // namespace

Document random_mechanism_scene(std::uint64_t seed) {
  Document scene;
  Maker(seed, scene).make();
  return scene;
}

}  // namespace railstep::property
