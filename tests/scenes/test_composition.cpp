// Everything runs beside everything on every form of track: a vehicle in space with each partner
// and each feature of the rails (docs/composition.md). A cell runs, its energy is balanced, and its
// model file, its snapshot and a second run have the same bits.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "offline/energy/energy_account.h"
#include "offline/energy/system_account.h"
#include "online/model/snapshot.h"
#include "online/step/step.h"
#include "run/simulation.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

using Changes = std::vector<std::string>;

struct TrackForm {
  const char *name, *scene;
  Changes words;
  double start;  // of the vehicle, m; a partner stands 14.07 m ahead, not over a node
};

const std::string kTrack = "rails=2,bay_m=0.6,elements_per_bay=2,rail_spacing_m=1.5";

std::vector<TrackForm> forms() {
  const std::string with_ends = "track={unknowns=\"full\",bays=50," + kTrack + "}";
  const std::string endless = "track={unknowns=\"full\",length=\"endless\",bays=80," + kTrack + "}";
  return {
      {"rigid", "manchester_straight", {}, 13.},
      {"with ends, full order", "manchester_ring", {with_ends, "condense={kind=\"full\"}"}, 13.},
      {"with ends, condensed", "manchester_ring", {with_ends, "condense={kind=\"modal\"}"}, 13.},
      {"window", "manchester_ring", {endless, "condense={kind=\"full\"}"}, 11.4},
      {"ring", "manchester_ring", {endless, "condense={kind=\"modal\",modes_per_bay=2}"}, 11.4}};
}

/// A partner or a feature, and the words that bring it. 'AT' and 'V' stand for the partner's place
/// and for the speed of all.
struct Partner {
  const char* name;
  Changes words;
  /// Rigid rails do not give way, all bays of a track without end are alike, and it goes along with
  /// vehicles of a given speed.
  enum Needs { nothing, rails, ends, standing } needs;
};

const std::vector<Partner> kPartners = {
    {"alone", {}, Partner::nothing},
    {"a load",
     {"load=[{name=\"l\",rail=\"left\",force_z_n=-5e4,start_m=AT,speed_m_per_s=V}]"},
     Partner::rails},
    {"a wheelset",
     {"wheelset=[{name=\"w\",wheels=[\"wl\",\"wr\"],mass_kg=1200.0,inertia_roll_kg_m2=700.0,"
      "inertia_spin_kg_m2=100.0,inertia_yaw_kg_m2=700.0,radius_m=0.46,carried_mass_kg=8800.0,"
      "start_m=AT,speed_m_per_s=V}]"},
     Partner::nothing},
    {"an upright bogie",
     {"vehicle=[VEHICLE,{name=\"b\",file=\"../vehicles/manchester_bogie.toml\",rail=\"both\","
      "start_m=AT,speed_m_per_s=V}]"},
     Partner::nothing},
    {"a second vehicle on a rod",
     {"vehicle=[VEHICLE,{name=\"rear\",type=\"rail_vehicle\",start_m=AT,speed_m_per_s=V,"
      "body=[{name=\"box\",mass_kg=6000.0,inertia_kg_m2=[4e3,8e3,8e3],centre_m=[0,0,1.2]}],"
      "wheelset=[{name=\"w1\",mass_kg=1200.0,inertia_kg_m2=[700.0,100.0,700.0],place_m=1.0},"
      "{name=\"w2\",mass_kg=1200.0,inertia_kg_m2=[700.0,100.0,700.0],place_m=-1.0}],"
      "element=[PRIMARY1,PRIMARY2]}]",
      "coupler=[{name=\"bar\",between=[\"car.car\",\"rear.box\"],type=\"rigid_rod\","
      "points_m=[[12.0,0,1.0],[-1.0,0,1.0]]}]"},
     Partner::nothing},
    {"a rod to the ground",
     {"coupler=[{name=\"hold\",between=[\"car.car\",\"ground\"],type=\"rigid_rod\","
      "points_m=[[0,0,1.8],[0,3.0,1.8]]}]"},
     Partner::nothing},
    {"forces on its bodies",
     {"vehicle[0].force=[{body=\"car\",direction=\"z\",table=[[0.0,-2e4]]},"
      "{body=\"bogie_1\",direction=\"pitch\",table=[[0.0,1e3]]}]"},
     Partner::nothing},
    {"an external wheel",
     {"external_wheel=[{name=\"e\",rail=\"left\",limit_n=1e6}]"},
     Partner::nothing},
    {"supports that do not pull",
     {"support_change=[{from=20,to=26,ballast.unilateral=true}]"},
     Partner::ends},
    {"a gap under a sleeper",
     {"support_change=[{from=20,to=22,ballast.gap_m=0.2e-3}]"},
     Partner::ends},
    {"bodies joined to rails",
     {"body=[{name=\"box\",mass_kg=120.0,inertia_kg_m2=[2.0,2.0,2.0],position_m=[24.0,0.75,-0.6]},"
      "{name=\"bar\",mass_kg=40.0,inertia_kg_m2=[1.0,1.0,1.0],position_m=[24.0,-0.75,-0.3]}]",
      "spring=[{between=[\"rail left\",\"box\"],point_m=[24.0,0.75,0.0],"
      "other_point_m=[24.0,0.75,-0.6],stiffness_n_per_m=1e6,damping_n_s_per_m=2e3}]",
      "joint=[{name=\"pin\",kind=\"revolute\",between=[\"rail right\",\"bar\"],"
      "point_m=[24.0,-0.75,-0.1],axis=[1,0,0]}]"},
     Partner::ends},
    {"friction, guards and a controlled damper",
     {"vehicle[0].file=\"../vehicles/freight_wagon.toml\"",
      "vehicle[0].actuator=[{name=\"valve\",between=[\"car\",\"leading\"],acts=\"damping\","
      "point_m=[4.5,0.0,0.46],axis=\"y\",table=[[0.0,0.0],[0.05,1e4]]}]"},
     Partner::nothing},
    {"a brake",
     {"vehicle[0].brake=[{name=\"disc\",wheelset=\"leading_1\",on=\"bogie_1\","
      "table=[[0.0,0.0],[0.01,2e3]]}]"},
     Partner::nothing},
    {"a drive by force", {"vehicle[0].drive=\"force\""}, Partner::standing},
    {"friction that falls",
     {"contact.creep=\"she\"",
      "contact.friction_table=[[0.0,0.3,0.3],[30.0,0.3,0.3],[31.0,0.1,0.1]]",
      "contact.kinetic_part=0.5", "contact.half_slip_m_per_s=0.5"},
     Partner::nothing},
    {"a design line",
     {"line={curvature_table=[[0.0,0.0],[20.0,1e-3]],cant_table=[[0.0,0.0],[20.0,0.06]]}"},
     Partner::nothing},
    {"rails with a cant", {"rail.cant=\"1:40\""}, Partner::rails},
    {"rails that differ", {"rail.right.young_pa=1.9e11"}, Partner::rails},
    {"unevenness",
     {"irregularity={spectrum=\"german_low\",geometries=[\"vertical\",\"alignment\","
      "\"cross_level\"]}"},
     Partner::nothing}};

std::string replaced(std::string text, const std::string& name, const std::string& value) {
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at))
    text.replace(at, name.size(), value);
  return text;
}

/// @param speed  of everything, m/s
AnyScene scene_of(const TrackForm& form, const Partner& partner, const std::string& speed) {
  const std::string start = std::to_string(form.start),
                    vehicle =
                        "{name=\"car\",file=\"../vehicles/manchester_1.toml\",start_m=" + start +
                        ",speed_m_per_s=" + speed + "}";
  Changes words{"irregularity={spectrum=\"german_low\",geometries=[\"vertical\"]}",
                "step.dt_s=5e-4", "step.frame_s=5e-4", "step.duration_s=0.02",
                "vehicle=[" + vehicle + "]"};
  words.insert(words.end(), form.words.begin(), form.words.end());
  const auto primary = [](const std::string& set, const std::string& x) {
    return "{name=\"primary_" + set + "\",type=\"bushing\",between=[\"box\",\"" + set +
           "\"],point_m=[" + x +
           ",1.0,0.46],stiffness_n_per_m=[1e7,4e6,1e6],"
           "damping_n_s_per_m=[1e4,4e3,1e4],mirror=true}";
  };
  const std::pair<std::string, std::string> names[] = {{"VEHICLE", vehicle},
                                                       {"=V}", "=" + speed + "}"},
                                                       {"=V,", "=" + speed + ","},
                                                       {"AT", std::to_string(form.start + 14.07)},
                                                       {"PRIMARY1", primary("w1", "1.0")},
                                                       {"PRIMARY2", primary("w2", "-1.0")}};
  for (std::string word : partner.words) {
    for (const auto& [name, text] : names) word = replaced(word, name, text);
    words.push_back(word);
  }
  return read_any_scene(shipped(form.scene), words);
}

/// Steps to the end of the scene, or to `steps`.
void run(const Model& model, State& state, Workspace& workspace, std::int64_t steps) {
  std::vector<double> input(static_cast<std::size_t>(model.inputs));
  if (model.external_wheels > 0) {
    input[0] = 30.;
    input[4] = -2e4;
  }
  Outputs outputs{};
  while (state.steps < steps) {
    static_cast<void>(advance_frame(model, input.data(), state, workspace, outputs));
    REQUIRE((outputs.status & Status::nonfinite_state) == Status::ok);
    REQUIRE((outputs.status & Status::cap_reached) == Status::ok);
    REQUIRE((outputs.status & Status::contact_ill_posed) == Status::ok);
  }
}

EnergyBalance energy_of(const Simulation& made) {
  const std::int64_t steps = made.model().steps;
  return made.system() != nullptr ? balance_of(*made.system()->packed, steps)
                                  : balance_of(*made.packed(), made.model(), steps);
}

void check_cell(const AnyScene& scene) {
  const auto simulation = simulation_of(scene);
  Simulation& made = *simulation;
  Simulation loaded(made.block(), "model");
  const Model &model = made.model(), &file = loaded.model();
  run(model, made.state, made.workspace, model.steps);
  const std::uint64_t hash = state_hash(model, made.state);
  run(file, loaded.state, loaded.workspace, model.steps / 2);
  std::vector<unsigned char> kept(snapshot_bytes(file));
  save_snapshot(file, loaded.state, kept.data());
  run(file, loaded.state, loaded.workspace, model.steps);
  CHECK(state_hash(file, loaded.state) == hash);
  REQUIRE(restore_snapshot(file, kept.data(), kept.size(), loaded.state) == SnapshotStatus::ok);
  run(file, loaded.state, loaded.workspace, model.steps);
  CHECK(state_hash(file, loaded.state) == hash);
  reset(model, made.state);
  run(model, made.state, made.workspace, model.steps);
  CHECK(state_hash(model, made.state) == hash);
  if (model.external_wheels > 0) return;  // the account has no inputs
  CHECK(energy_of(made).error < 2e-3);
}

std::vector<double> forces_of(const Model& model, const Outputs& outputs) {
  std::vector<double> all(outputs.contact_force, outputs.contact_force + contact_count(model));
  all.insert(all.end(), outputs.wheel_q, outputs.wheel_q + 2 * model.runner_wheelsets);
  return all;
}

/// A vehicle and its partner at rest keep their vertical forces from the first step on.
void check_standing(const AnyScene& scene) {
  const auto simulation = simulation_of(scene);
  Simulation& made = *simulation;
  const Model& model = made.model();
  Outputs outputs{};
  publish_start(model, made.state, outputs);
  const std::vector<double> start = forces_of(model, outputs);
  double largest = 0., most = 0.;
  for (const double force : start) largest = std::max(largest, std::fabs(force));
  for (int frame = 0; frame < 40; ++frame) {
    REQUIRE(advance_frame(model, made.state, made.workspace, outputs) == Status::ok);
    const std::vector<double> now = forces_of(model, outputs);
    for (std::size_t i = 0; i < now.size(); ++i)
      most = std::max(most, std::fabs(now[i] - start[i]));
  }
  CHECK(largest > 4e4);
  CHECK(most < 1e-7 * largest);
}

/// Visits all cells that have a meaning.
template <typename Visit>
void for_each_cell(Visit visit) {
  for (const TrackForm& form : forms())
    for (const Partner& partner : kPartners) {
      const std::string name = form.name;
      const bool rigid = name == "rigid", ends = name.find("with ends") != std::string::npos;
      if (partner.needs == Partner::rails && rigid) continue;
      if (partner.needs == Partner::ends && !ends) continue;
      if (partner.needs == Partner::standing && !ends && !rigid) continue;
      INFO(partner.name << " on a track: " << form.name);
      try {
        visit(form, partner);
      } catch (const std::exception& error) {
        FAIL_CHECK(error.what());
      }
    }
}

/// The same partner on the other side of the track.
Partner mirrored(Partner partner) {
  for (std::string& word : partner.words) {
    word = replaced(replaced(replaced(word, "left", "RIGHT"), "right", "left"), "RIGHT", "right");
    for (const std::string y : {",0.75,", ",3.0,", ",1e-3]", ",0.06]"})
      word = replaced(replaced(replaced(word, y, ",PLUS,"), ",-" + y.substr(1), y), ",PLUS,",
                      ",-" + y.substr(1));
  }
  return partner;
}

/// Forces of the wheels of vehicles in space after 20 frames, Q and outwards Y.
std::vector<double> forces_after(const AnyScene& scene) {
  const auto simulation = simulation_of(scene);
  const Model& model = simulation->model();
  run(model, simulation->state, simulation->workspace, 20);
  Outputs outputs{};
  publish_start(model, simulation->state, outputs);
  std::vector<double> all;
  for (int wheel = 0; wheel < 2 * model.runner_wheelsets; ++wheel)
    all.insert(all.end(), {outputs.wheel_q[wheel], outputs.wheel_y[wheel]});
  return all;
}

}  // namespace

TEST_CASE("a vehicle in space runs beside everything on every form of track", "[composition]") {
  for_each_cell([](const TrackForm& form, const Partner& partner) {
    check_cell(scene_of(form, partner, "25.0"));
  });
}

TEST_CASE("the mirror image of what runs beside a vehicle makes that of its forces",
          "[composition]") {
  for_each_cell([](const TrackForm& form, const Partner& partner) {
    const std::string name = partner.name;
    // One of two rails that differ is the left one, and an unevenness is drawn at random.
    if (name == "rails that differ" || name == "unevenness") return;
    const Partner image = mirrored(partner);
    const std::vector<double> own = forces_after(scene_of(form, partner, "25.0")),
                              other = image.words == partner.words
                                          ? own
                                          : forces_after(scene_of(form, image, "25.0"));
    REQUIRE(own.size() == other.size());
    double most = 0., largest = 0.;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const std::size_t mirror = i ^ 2;  // left and right wheel of each wheelset, two numbers each
      largest = std::max(largest, std::fabs(own[i]));
      most = std::max(most, std::fabs(own[i] - other[mirror]));
    }
    CHECK(most < 1e-8 * largest);
  });
}

TEST_CASE("a vehicle in space stands still beside everything that stands", "[composition]") {
  for_each_cell([](const TrackForm& form, const Partner& partner) {
    const std::string name = partner.name;
    // External forces begin with the first frame; along y uneven and canted rails push the bodies.
    if (name == "an external wheel" || name == "unevenness" || name == "a design line") return;
    // A joint on a rail rings by some 1e-6 of the forces as the step takes it over from the start.
    Partner own = partner;
    if (name == "bodies joined to rails")
      own.words.push_back(
          "joint=[{name=\"pin\",kind=\"fixed\",between=[\"ground\",\"bar\"],"
          "point_m=[24.0,-0.75,-0.1]}]");
    check_standing(scene_of(form, own, "0.0"));
  });
}
