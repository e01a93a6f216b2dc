// Rails, pads, sleepers and ballast of a random track.
#include <algorithm>

#include "generators.h"

namespace railstep::property {
namespace {

/// A rectangle or three near 60E1, which have a shape, or constants, which have no shape.
void add_section(Draw& draw, Document& rail) {
  switch (draw.whole(0, 2)) {
    case 0:
      rail["rectangle"] = {{"height_m", draw.of_any_size(.08, .2)},
                           {"width_m", draw.of_any_size(.04, .1)}};
      return;
    case 1:
      rail["rectangles"] = {{"foot_width_m", draw.of_any_size(.12, .15)},
                            {"foot_height_m", draw.of_any_size(.015, .025)},
                            {"web_width_m", draw.of_any_size(.015, .03)},
                            {"web_height_m", draw.of_any_size(.08, .13)},
                            {"head_width_m", draw.of_any_size(.06, .08)},
                            {"head_height_m", draw.of_any_size(.03, .045)}};
      return;
    default:
      rail["constants"] = {
          {"area_m2", 8700e-6},        {"inertia_y_m4", draw.of_any_size(15e-6, 50e-6)},
          {"inertia_z_m4", 6.0e-6},    {"torsion_m4", 1.9514e-6},
          {"shear_factor_y", .4796},   {"shear_factor_z", .4721},
          {"centroid_height_m", .085}, {"shear_centre_height_m", .0459},
          {"height_m", .1857375}};
  }
}

void add_rail(Draw& draw, const GroundChoice& choice, Document& scene) {
  Document& rail = scene["rail"];
  add_section(draw, rail);
  rail["young_pa"] = draw.of_any_size(60e9, 220e9);
  rail["poisson"] = .3;
  rail["density_kg_per_m3"] = draw.of_any_size(2700., 8000.);
  rail["crown_radius_m"] = .3;
  if (choice.rails == 2 && draw.chance(.15)) {
    rail["right"] = rail;
    rail["right"]["young_pa"] = draw.of_any_size(60e9, 220e9);
    if (draw.chance(.5)) {
      for (const char* shape : {"rectangle", "rectangles", "constants"}) rail["right"].erase(shape);
      add_section(draw, rail["right"]);
    }
  }
  if (draw.chance(.12)) rail["axial_force_n"] = draw.between(-3e5, 1e6);
  const bool space = std::string(choice.unknowns) != "vertical";
  if (space && draw.chance(.12)) rail["cant"] = draw.one_of({.05, .025});
}

/// A rail that moves in space needs stiffness in x, y and roll; a vertical track does not need y
/// and roll.
void add_pads(Draw& draw, const GroundChoice& choice, Document& scene) {
  Document& pad = scene["support"];
  pad["at"] = draw.one_of({"foot", "axis"});
  pad["stiffness_z_n_per_m"] = draw.of_any_size(5e6, 2e9);
  if (draw.chance(.8)) pad["damping_z_n_s_per_m"] = draw.of_any_size(1e3, 1e5);
  const bool space = std::string(choice.unknowns) != "vertical";
  if (space || draw.chance(.2)) pad["stiffness_x_n_per_m"] = draw.of_any_size(1e6, 1e9);
  if (space) {
    pad["stiffness_y_n_per_m"] = draw.of_any_size(1e6, 1e9);
    pad["stiffness_roll_n_m_per_rad"] = draw.of_any_size(1e5, 1e7);
    if (draw.chance(.5)) pad["damping_y_n_s_per_m"] = draw.of_any_size(1e3, 1e6);
    if (draw.chance(.3)) pad["damping_roll_n_m_s_per_rad"] = draw.of_any_size(1e1, 1e3);
    if (draw.chance(.15)) pad["half_spread_m"] = draw.of_any_size(.02, .08);
  }
  if (draw.chance(.15))
    pad["length_m"] = draw.between(.05, .25);
  else if (draw.chance(.15))
    pad["unilateral"] = true;
}

void add_sleepers(Draw& draw, const GroundChoice& choice, Document& scene) {
  Document& sleeper = scene["sleeper"];
  Document& ballast = scene["ballast"];
  const bool heavy = draw.chance(.9);
  sleeper["mass_kg"] = heavy ? draw.of_any_size(50., 400.) : 0.;
  if (choice.rails == 2) sleeper["roll_inertia_kg_m2"] = heavy ? draw.of_any_size(20., 200.) : 0.;
  ballast["stiffness_z_n_per_m"] = draw.of_any_size(5e6, 5e8);
  if (heavy) ballast["damping_z_n_s_per_m"] = draw.of_any_size(1e3, 1e5);
  if (std::string(choice.unknowns) != "vertical" && draw.chance(.3))
    ballast["stiffness_y_n_per_m"] = draw.of_any_size(1e7, 1e9);
  if (scene["support"].contains("length_m") && draw.chance(.5))
    ballast["length_m"] = draw.of_any_size(.2, .3);
  else if (!scene["support"].contains("unilateral") && draw.chance(.08))
    ballast["unilateral"] = true;
}

void add_change(Draw& draw, int bays, bool sleepers, bool long_pads, Document& change) {
  const int from = draw.whole(0, bays);
  change["from"] = from;
  change["to"] = draw.whole(from, bays);
  if (draw.chance(.3)) change["rail"] = draw.one_of({"left", "both"});
  switch (draw.whole(0, 4)) {
    case 0:
      change["support"] = {{"stiffness_factor", draw.of_any_size(.2, 5.)}};
      return;
    case 1:
      if (change["from"] == change["to"]) {
        change["support"] = {{"damping_factor", draw.of_any_size(.2, 5.)}};
      } else {
        const double first = draw.of_any_size(.5, 1.), last = draw.of_any_size(1., 4.);
        change["support"] = {{"stiffness_factor", {first, last}}};
      }
      return;
    case 2:
      change["support"] = {{"stiffness_scatter", draw.of_any_size(.1, .5)}};
      change["seed"] = draw.whole(0, 1000);
      return;
    case 3:
      change["to"] = from;  // changes of all seats would leave the rail in the air
      if (sleepers && !long_pads && draw.chance(.6))
        change["ballast"] = {{"gap_m", draw.of_any_size(5e-5, 5e-4)}};
      else
        change["missing"] = sleepers ? draw.one_of({"pad", "ballast"}) : "pad";
      return;
    default:
      if (long_pads)
        change["support"] = {{"damping_factor", 2.}};
      else
        change["support"] = {{"gap_m", draw.of_any_size(2e-5, 3e-4)}};
  }
}

void add_stop(Draw& draw, Document& scene) {
  const bool aside = scene["track"]["unknowns"] == "full" && draw.chance(.5);
  Document stop = {{"name", "stop"}};
  if (number(scene["track"], "rails") == 2.) stop["rail"] = draw.one_of({"left", "right"});
  stop["position_m"] = draw.between(.1, .9) * length_of(scene);
  stop["direction"] = aside ? "y" : "z";
  stop["side"] = aside ? draw.one_of({"left", "right"}) : draw.one_of({"above", "below"});
  stop["gap_m"] = draw.chance(.3) ? 0. : draw.of_any_size(1e-6, 1e-4);
  stop["stiffness_n_per_m"] = draw.of_any_size(1e6, 1e9);
  if (draw.chance(.5)) stop["damping_n_s_per_m"] = draw.of_any_size(1e2, 1e5);
  scene["stop"] = Document::array({stop});
}

void add_rail_joint(Draw& draw, Document& scene) {
  const Document& track = scene["track"];
  const int elements =
      static_cast<int>(number(track, "bays") * number(track, "elements_per_bay", 2));
  if (elements < 3 || scene["rail"].contains("axial_force_n")) return;
  Document joint = {{"x_m", draw.whole(1, elements - 1) * number(track, "bay_m") /
                                number(track, "elements_per_bay", 2)}};
  if (number(track, "rails") == 2. && draw.chance(.4))
    joint["rail"] = draw.one_of({"left", "right"});
  joint["bending_vertical_stiffness_n_m_per_rad"] = draw.of_any_size(1e5, 1e7);
  if (draw.chance(.5)) joint["shear_vertical_stiffness_n_per_m"] = draw.of_any_size(1e7, 1e9);
  if (moves_sideways(scene)) {
    joint["bending_lateral_stiffness_n_m_per_rad"] = draw.of_any_size(1e5, 1e7);
    joint["twist_stiffness_n_m_per_rad"] = draw.of_any_size(1e5, 1e7);
    if (draw.chance(.4)) joint["gap_m"] = draw.of_any_size(1e-6, 1e-3);
  }
  scene["rail_joint"] = Document::array({joint});
}

}  // namespace

double length_of(const Document& scene) {
  return number(scene["track"], "bays") * number(scene["track"], "bay_m");
}
double duration_of(const Document& scene) { return number(scene["step"], "duration_s"); }
bool moves_sideways(const Document& scene) { return scene["track"]["unknowns"] != "vertical"; }
bool has_shape(const Document& scene) {
  const Document& rail = scene["rail"];
  return !rail.contains("constants") &&
         !(rail.contains("right") && rail["right"].contains("constants"));
}

void add_ground(Draw& draw, const GroundChoice& choice, Document& scene) {
  Document& track = scene["track"];
  track["unknowns"] = choice.unknowns;
  track["rails"] = choice.rails;
  track["bays"] = choice.bays;
  track["bay_m"] = draw.one_of({.6, .65, .5, .8});
  track["elements_per_bay"] = draw.whole(1, std::string(choice.unknowns) == "vertical" ? 3 : 2);
  track["rail_spacing_m"] = 1.5;
  if (draw.chance(.2)) track["gravity"] = true;
  add_rail(draw, choice, scene);
  add_pads(draw, choice, scene);
  if (draw.chance(.5)) add_sleepers(draw, choice, scene);
}

void add_seats_that_differ(Draw& draw, Document& scene) {
  const int bays = static_cast<int>(number(scene["track"], "bays"));
  const bool long_pads = scene["support"].contains("length_m") ||
                         (scene.contains("ballast") && scene["ballast"].contains("length_m"));
  const int changes = draw.chance(.35) ? draw.whole(1, 2) : 0;
  for (int i = 0; i < changes; ++i) {
    Document change;
    add_change(draw, bays, scene.contains("sleeper"), long_pads, change);
    scene["support_change"].push_back(change);
  }
  if (draw.chance(.1)) add_stop(draw, scene);
  if (draw.chance(.15)) add_rail_joint(draw, scene);
}

}  // namespace railstep::property
