// Traffic of a random track, its steps and its condensation.
#include <fmt/format.h>

#include <algorithm>

#include "generators.h"

namespace railstep::property {
namespace {

/// Motion along the track: a start, m, and a speed, m/s.
struct Way {
  double start, speed;
};

/// Length for traffic, m. On a track without end it stands together, as the ring must be longer
/// than it by a decay length.
double room_of(const Document& scene) {
  return (scene["track"].contains("length") ? .3 : 1.) * length_of(scene);
}

/// A way on which wheels up to `reach` on either side stay on the rail.
Way draw_way(Draw& draw, const Document& scene, double reach, const double* common) {
  const double edge = reach + .02, length = room_of(scene);
  Way way{draw.between(edge, length - edge), 0.};
  if (common != nullptr) return {way.start, *common};
  if (!draw.chance(.65)) return way;
  const bool back = draw.chance(.3);
  const double room = back ? way.start - edge : length - edge - way.start;
  way.speed = std::min(120., draw.between(.3, .98) * room / duration_of(scene));
  if (back) way.speed = -way.speed;
  return way;
}

void add_way(Draw& draw, const Document& scene, const Way& way, bool may_vary, Document& table) {
  table["start_m"] = way.start;
  if (may_vary && way.speed != 0. && draw.chance(.15)) {
    const double end = duration_of(scene);
    table["speed_table"] = {{0., way.speed}, {.43 * end, .3 * way.speed}, {end, .6 * way.speed}};
  } else {
    table["speed_m_per_s"] = way.speed;
  }
}

void add_side(Draw& draw, const Document& scene, Document& table) {
  if (number(scene["track"], "rails") == 2.) table["rail"] = draw.one_of({"left", "right"});
}

Document time_table(Draw& draw, double end, double least, double most) {
  Document rows = Document::array();
  double t = draw.chance(.5) ? 0. : draw.between(0., .3) * end;
  for (int i = draw.whole(1, 3); i > 0; --i) {
    rows.push_back({t, draw.between(least, most)});
    t += draw.between(.1, .4) * end;
  }
  return rows;
}

Document random_load(Draw& draw, const Document& scene, int n, const double* common) {
  Document load = {{"name", fmt::format("load_{}", n)}};
  add_side(draw, scene, load);
  const Way way = draw_way(draw, scene, 0., common);
  add_way(draw, scene, way, common == nullptr, load);
  load["force_z_n"] = -draw.of_any_size(1e3, 2e5);
  if (draw.chance(.2)) load["at"] = "head";
  if (draw.chance(.25)) load["table"] = time_table(draw, duration_of(scene), -.5, 2.);
  if (draw.chance(.25)) {
    load["amplitude_n"] = draw.of_any_size(1e3, 1e5);
    load["frequency_hz"] = draw.between(.02, .11) / number(scene["step"], "dt_s");
    load["phase_deg"] = draw.between(-180., 180.);
  }
  if (common == nullptr && way.speed > 0. && draw.chance(.15))
    load["stop_m"] = way.start + .4 * way.speed * duration_of(scene);
  return load;
}

/// Adds a tread defect whose wave takes at least eight steps.
void add_tread(Draw& draw, const Document& scene, double speed, Document& carrier,
               const Document& wheel) {
  const double dt = number(scene["step"], "dt_s");
  if (9. * std::abs(speed) * dt > .03) return;
  Document tread = {{"kind", draw.one_of({"fresh_flat", "rounded_flat", "out_of_round"})}};
  tread["wheel"] = wheel;
  if (tread["kind"] == "out_of_round") {
    tread["order"] = draw.whole(1, 3);
    tread["amplitude_m"] = draw.of_any_size(1e-5, 3e-4);
  } else {
    tread["length_m"] = draw.of_any_size(.03, .06);
    tread["first_m"] = draw.between(.02, .4);
    if (tread["kind"] == "rounded_flat") tread["depth_m"] = draw.of_any_size(1e-4, 6e-4);
  }
  tread["contact_patch_m"] = .012;
  carrier["tread"].push_back(tread);
}

void add_flange(Draw& draw, Document& wheelset) {
  Document& flange = wheelset["flange"];
  flange = {{"clearance_m", draw.of_any_size(1e-4, 5e-3)}, {"angle_deg", 70.}, {"height_m", .028}};
  if (draw.chance(.5)) {
    flange["contact"] = "linear";
    flange["stiffness_n_per_m"] = draw.of_any_size(1e6, 1e8);
    flange["damping_n_s_per_m"] = draw.of_any_size(1e2, 1e4);
  }
}

Document random_wheelset(Draw& draw, const Document& scene, const double* common) {
  Document w = {{"name", "axle"}};
  const double mass = draw.of_any_size(100., 2000.);
  w["mass_kg"] = mass;
  w["inertia_roll_kg_m2"] = .5 * mass;
  w["inertia_spin_kg_m2"] = .05 * mass;
  w["inertia_yaw_kg_m2"] = .5 * mass;
  w["radius_m"] = .46;
  w["tread_half_width_m"] = .065;
  const Way way = draw_way(draw, scene, 0., common);
  add_way(draw, scene, way, common == nullptr, w);
  if (draw.chance(.7)) w["carried_mass_kg"] = draw.of_any_size(500., 1e4);
  if (draw.chance(.2))
    w["guide"] = {{"method", "baumgarte"}, {"alpha_per_s", 100.}, {"beta_per_s", 100.}};
  else if (draw.chance(.3))
    w["guide"] = {{"method", "elimination"}};
  const bool flange = moves_sideways(scene) && has_shape(scene);
  if (flange && draw.chance(.5)) add_flange(draw, w);
  if (draw.chance(.5)) {
    const bool aside = moves_sideways(scene) && draw.chance(.6);
    const double most = aside ? 1e3 : .3 * mass * 9.81;
    w["force"] = Document::array({{{"direction", aside ? "y" : "z"},
                                   {"table", time_table(draw, duration_of(scene), -most, most)}}});
  }
  if (draw.chance(.2) && way.speed != 0.)
    add_tread(draw, scene, way.speed, w, draw.one_of({"left", "right", "both"}));
  return w;
}

void add_bogie(Draw& draw, double wheelbase, Document& v) {
  const double mass = draw.of_any_size(200., 5e3);
  v["frame_mass_kg"] = mass;
  v["frame_inertia_kg_m2"] = .25 * mass;
  v["wheel_mass_kg"] = draw.of_any_size(100., 1000.);
  v["wheelbase_m"] = wheelbase;
  if (draw.chance(.3)) v["axles"] = 3;
  v["primary_stiffness_n_per_m"] = draw.of_any_size(3e5, 1e7);
  v["primary_damping_n_s_per_m"] = draw.chance(.2) ? 0. : draw.of_any_size(1e3, 1e5);
}

/// Adds type and masses of a vehicle. @returns how far its wheels are ahead of its middle, m.
double add_kind(Draw& draw, const Document& scene, Document& v) {
  const double room = room_of(scene);
  const char* type = draw.one_of({"mass", "sprung_mass", "bogie", "vehicle"});
  v["type"] = type;
  v["radius_m"] = .46;
  if (v["type"] == "mass" || v["type"] == "sprung_mass") {
    v["mass_kg"] = draw.of_any_size(50., 2e4);
    if (v["type"] == "mass") return 0.;
    v["unsprung_mass_kg"] = draw.of_any_size(50., 1000.);
    v["stiffness_n_per_m"] = draw.of_any_size(1e5, 1e7);
    v["damping_n_s_per_m"] = draw.chance(.2) ? 0. : draw.of_any_size(1e3, 1e5);
    return 0.;
  }
  if (v["type"] == "bogie") {
    const double base = draw.between(.15, .5) * room;
    add_bogie(draw, base, v);
    if (draw.chance(.5)) v["carried_mass_kg"] = draw.of_any_size(1e3, 1e4);
    return .5 * base;
  }
  const double base = draw.between(.1, .2) * room, apart = draw.between(.25, .4) * room;
  add_bogie(draw, base, v);
  const double mass = draw.of_any_size(1e3, 2e4);
  v["body_mass_kg"] = mass;
  v["body_inertia_kg_m2"] = 2. * mass;
  v["bogie_distance_m"] = apart;
  v["secondary_stiffness_n_per_m"] = draw.of_any_size(1e5, 2e6);
  v["secondary_damping_n_s_per_m"] = draw.of_any_size(1e3, 1e5);
  return .5 * (base + apart);
}

Document random_vehicle(Draw& draw, const Document& scene, int n, const double* common) {
  Document v = {{"name", fmt::format("vehicle_{}", n)}};
  add_side(draw, scene, v);
  const double reach = add_kind(draw, scene, v);
  const bool mass = v["type"] == "mass";
  const char* contact = draw.one_of({"hertz", "hertz", "linear", "bonded"});
  v["contact"] = contact;
  if (v["contact"] == "linear") {
    v["contact_stiffness_n_per_m"] = draw.of_any_size(1e8, 1e10);
    if (draw.chance(.5)) v["contact_damping_n_s_per_m"] = draw.of_any_size(1e2, 1e4);
  }
  const Way way = draw_way(draw, scene, reach, common);
  add_way(draw, scene, way, common == nullptr, v);
  if (v["contact"] == "hertz" && scene["step"]["start"] == "released" && draw.chance(.5)) {
    v["drop_height_m"] = draw.of_any_size(1e-6, 1e-4);
    v["drop_speed_m_per_s"] = draw.of_any_size(1e-2, .5);
  }
  if (draw.chance(.2))
    v["force"] =
        Document::array({{{"body", mass                   ? "body"
                                   : v["type"] == "bogie" ? "frame"
                                                          : "body"},
                          {"direction", v["type"] == "bogie" && draw.chance(.5) ? "pitch" : "z"},
                          {"table", time_table(draw, duration_of(scene), -500., 500.)}}});
  if (draw.chance(.15) && way.speed != 0.) add_tread(draw, scene, way.speed, v, 1);
  return v;
}

void add_unevenness(Draw& draw, Document& scene) {
  if (draw.chance(.2)) {
    Document& all = scene["irregularity"];
    all["spectrum"] = draw.one_of({"fra_4", "fra_5", "german_low"});
    if (!moves_sideways(scene) || draw.chance(.6)) all["geometries"] = {"vertical"};
    all["seed"] = draw.whole(1, 1000);
    all["shortest_wavelength_m"] = 3.;
    all["longest_wavelength_m"] = 25.;
    all["period_m"] = 400.;
    all["contact_patch_m"] = .012;
  }
  if (!draw.chance(.2)) return;
  Document defect;
  if (draw.chance(.5))
    defect = {{"kind", "dipped_joint"},
              {"at_m", draw.between(.1, .9) * length_of(scene)},
              {"depth_m", draw.of_any_size(1e-4, 1e-3)},
              {"ramp_m", draw.of_any_size(.2, .8)}};
  else
    defect = {{"kind", "corrugation"},
              {"from_m", .1 * length_of(scene)},
              {"to_m", .9 * length_of(scene)},
              {"wavelength_m", draw.between(.2, .3) * length_of(scene)},
              {"amplitude_m", draw.of_any_size(1e-5, 2e-4)}};
  if (number(scene["track"], "rails") == 2.)
    defect["rail"] = draw.one_of({"left", "right", "both"});
  defect["contact_patch_m"] = .012;
  scene["defect"].push_back(defect);
}

void add_sensors(Draw& draw, Document& scene) {
  Document sensor = {{"name", "point"}, {"on", "rail"}};
  add_side(draw, scene, sensor);
  sensor["position_m"] = draw.between(.1, .9) * room_of(scene);
  if (draw.chance(.5)) sensor["at"] = draw.one_of({"head", "foot"});
  if (draw.chance(.3)) sensor["gauge_length_m"] = .01;
  scene["sensor"].push_back(sensor);
  if (scene.contains("sleeper") && draw.chance(.5)) {
    Document on = {{"name", "tie"}, {"on", "sleeper"}};
    on["sleeper"] =
        draw.whole(1, static_cast<int>(room_of(scene) / number(scene["track"], "bay_m")));
    if (number(scene["track"], "rails") == 2. && draw.chance(.7))
      on["rail"] = draw.one_of({"left", "right"});
    scene["sensor"].push_back(on);
  }
  if (scene.contains("wheelset") && draw.chance(.7))
    scene["sensor"].push_back({{"name", "centre"}, {"on", "wheelset"}, {"wheelset", "axle"}});
  if (scene.contains("vehicle") && draw.chance(.4))
    scene["sensor"].push_back({{"name", "box"}, {"on", "vehicle"}, {"vehicle", "vehicle_0"}});
}

}  // namespace

void add_traffic(Draw& draw, Document& scene, const double* speed) {
  if (number(scene["track"], "rails") == 2. && draw.chance(.4))
    scene["wheelset"].push_back(random_wheelset(draw, scene, speed));
  const int vehicles = draw.chance(.4) ? draw.whole(1, 2) : 0;
  for (int n = 0; n < vehicles; ++n)
    scene["vehicle"].push_back(random_vehicle(draw, scene, n, speed));
  const bool wheels = scene.contains("wheelset") || scene.contains("vehicle");
  for (int n = draw.whole(wheels ? 0 : 1, 2); n > 0; --n)
    scene["load"].push_back(random_load(draw, scene, n, speed));
  if (wheels) add_unevenness(draw, scene);
  add_sensors(draw, scene);
}

void add_condensation(Draw& draw, Document& scene) {
  if (draw.chance(.5)) return;
  Document& condense = scene["condense"];
  condense["kind"] =
      draw.one_of({"modal", "modal", "guyan", "irs", "craig-bampton", "krylov", "complex-modes"});
  const std::string kind = condense["kind"];
  if (kind == "modal" && draw.chance(.3))
    condense["highest_hz"] = draw.of_any_size(300., 3000.);
  else if (kind != "guyan" && kind != "irs")
    condense["modes_per_bay"] = draw.whole(kind == "complex-modes" ? 2 : 1, 4);
  if (draw.chance(.1)) condense["residual_flexibility"] = false;
}

void add_step(Draw& draw, Document& scene) {
  Document& step = scene["step"];
  const double dt = draw.one_of({2.5e-5, 5e-5, 1e-4, 2e-4, 5e-4});
  const int in_frame = draw.one_of({1, 1, 2, 4}), frames = draw.whole(20, 60);
  step["dt_s"] = dt;
  step["frame_s"] = in_frame * dt;
  step["duration_s"] = frames * in_frame * dt;
  step["start"] = draw.one_of({"equilibrium", "equilibrium", "released"});
  step["scheme"] = draw.one_of({"generalised-alpha", "generalised-alpha", "generalised-alpha",
                                "backward-euler", "newmark", "hht", "tr-bdf2"});
  if (step["scheme"] == "generalised-alpha") step["rho_inf"] = draw.one_of({0., .6, .6, .9, 1.});
  if (scene.contains("condense") && draw.chance(.2)) step["contact"] = "discrete-gradient";
}

Document random_track_scene(std::uint64_t seed) {
  Draw draw(seed, 1);
  Document scene = {{"schema", 1}};
  const char* unknowns = draw.one_of({"vertical", "vertical", "full", "rigid-section"});
  const bool vertical = std::string(unknowns) == "vertical";
  add_ground(draw, {unknowns, draw.whole(1, 2), draw.whole(3, vertical ? 12 : 6)}, scene);
  Document& track = scene["track"];
  const auto end = [&] { return draw.one_of({"free", "pinned", "clamped", "non-reflecting"}); };
  track["ends"] = {end(), end()};
  if (track["ends"][0] == "non-reflecting" || track["ends"][1] == "non-reflecting")
    track["end_zone_bays"] = 1;
  add_seats_that_differ(draw, scene);
  add_condensation(draw, scene);
  add_step(draw, scene);
  add_traffic(draw, scene, nullptr);
  if (draw.chance(.4)) scene["output"] = {{"supports", true}};
  return scene;
}

}  // namespace railstep::property
