#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "offline/system/pack_system.h"
#include "online/system/sensor.h"
#include "support/block_fields.h"
#include "support/block_mutations.h"

using namespace railstep;
using Eigen::Vector3d;

namespace {

const std::string kSystemText = "time_s\nsome.column_m";

RigidBody body_at(const Vector3d& place) {
  return {.mass = 2.,
          .inertia = Vector3d(.02, .02, .03).asDiagonal().toDenseMatrix(),
          .position = place};
}

FlexibleBeam beam_from(double x, int elements) {
  FlexibleBeam beam{.section = {.area = 6e-4,
                                .inertia_y = 2e-8,
                                .inertia_z = 4.5e-8,
                                .torsion = 4.7e-8,
                                .moments = rectangle_moments(.02, .03)},
                    .material = {.young = 210e6, .poisson = .3, .density = 7900.}};
  beam.elements = elements;
  beam.length = .4;
  beam.half_height = .01;
  beam.start = {x, 0., 0.};
  return beam;
}

/// A system with some of everything: two beams, one of them clamped, three bodies, joints of which
/// one follows a table, a spring, a force, a moment, and sensors.
System small_system(bool planar) {
  System s;
  s.planar = planar;
  s.bodies = {body_at({.8, 0., -.1}), body_at({0., 0., -.5}), body_at({1., 0., 0.})};
  s.beams = {beam_from(0., 2), beam_from(.4, 1)};
  s.beams[0].ends[0] = BeamEnd::clamped;
  const Vector3d y = Vector3d::UnitY();
  s.joints = {
      {.kind = JointKind::spherical, .a = beam(0), .b = beam(1), .point = {.4, 0., 0.}},
      {.kind = JointKind::revolute, .a = beam(1), .b = body(0), .point = {.8, 0., 0.}, .axis = y},
      {.kind = JointKind::distance,
       .b = body(1),
       .point = {0., 0., -.2},
       .other_point = {0., 0., -.5}},
      {.kind = JointKind::revolute, .b = body(2), .point = {1., 0., 0.}, .axis = y},
      {.kind = JointKind::rotation,
       .b = body(2),
       .point = {1., 0., 0.},
       .axis = y,
       .motion = {.table = {{0., 0.}, {.01, .1}, {.02, 0.}}}}};
  s.springs = {{.a = body(0),
                .b = body(1),
                .point_a = {.8, 0., -.1},
                .point_b = {0., 0., -.5},
                .stiffness = 100.,
                .damping = .5}};
  s.forces = {{.on = beam(1), .point = {.6, 0., 0.}, .factor = {.table = {{0., 0.}, {.01, 5.}}}},
              {.on = body(0), .direction = y, .factor = {.polynomial = {.1}}, .moment = true}};
  s.sensors = {{beam(0), {.2, 0., 0.}}, {body(1), {0., 0., -.5}}};
  return s;
}

SystemOptions options_of(ConstraintMethod hold, Renew renew) {
  SystemOptions o;
  o.scheme = generalised_alpha(1e-3, .8);
  o.constraint_method = hold;
  o.renew = renew;
  o.steps_per_frame = 2;
  o.steps = 40;
  o.traced = {{0, 2}, {0}};
  return o;
}

/// A body joined to the left rail of two, with a spring to the right rail.
std::unique_ptr<PackedSystem> on_rails() {
  Track track = peers_pair(1);
  track.bays = 4;
  track.rail_spacing = 1.5;
  System s;
  s.bodies = {body_at({1.1, .75, 0.})};
  s.joints = {{.a = rail(0), .b = body(0), .point = {1.1, .75, 0.}}};
  s.springs = {{.a = rail(1),
                .b = body(0),
                .point_a = {1.3, -.75, 0.},
                .point_b = {1.1, .75, 0.},
                .stiffness = 1e5,
                .damping = 10.}};
  s.sensors = {{rail(0), {.9, .75, .1}}, {body(0), {1.1, .75, 0.}}};
  Traffic traffic;
  traffic.loads = {{.start = .2, .speed = 10., .stop = 2., .force = -5e3}};
  traffic.track_sensors = {{.displacement = 1., .track = {.rail = {{{0, .4, 0., 0., 2}, 1.}}}}};
  PackOptions of_track = full_order(1e-3);
  of_track.residual_flexibility = false;
  of_track.steps_per_frame = 2;
  of_track.steps = 40;
  SystemOptions options = options_of(ConstraintMethod::augmented_lagrangian, Renew::every_step);
  options.traced = {{0}, {0}};
  return std::make_unique<PackedSystem>(s, options, track, traffic, of_track);
}

constexpr int kKinds = 8;

/// Systems in the plane and in space, with every constraint method, every way to renew the matrix
/// and both kinds of scheme.
std::unique_ptr<PackedSystem> small_model(int kind) {
  const auto make = [](bool planar, const SystemOptions& options) {
    return std::make_unique<PackedSystem>(small_system(planar), options);
  };
  switch (kind) {
    case 0:
      return make(true, options_of(ConstraintMethod::augmented_lagrangian, Renew::every_step));
    case 1:
      return make(false, options_of(ConstraintMethod::augmented_lagrangian, Renew::kept));
    case 2:
      return make(true, options_of(ConstraintMethod::baumgarte, Renew::kept));
    case 3:
      return make(false, options_of(ConstraintMethod::baumgarte, Renew::every_step));
    case 4:
      return make(true, options_of(ConstraintMethod::gear_gupta_leimkuhler, Renew::every_step));
    case 5:
      return make(false, options_of(ConstraintMethod::direct, Renew::every_iteration));
    case 6: {
      SystemOptions options = options_of(ConstraintMethod::augmented_lagrangian, Renew::every_step);
      options.scheme = energy_momentum(1e-3);
      options.energy_momentum = true;
      return make(true, options);
    }
    default:
      return on_rails();
  }
}

/// All readings of a system in its present state.
std::vector<double> read_out(const Model& model, const State& state) {
  std::vector<double> all;
  for (std::int32_t i = 0; i < model.system.sensors; ++i) {
    const PointMotion p = sensor_motion(model, state, i);
    all.insert(all.end(), p.position, p.position + 3);
    all.insert(all.end(), p.acceleration, p.acceleration + 3);
  }
  for (std::int32_t i = 0; i < model.system.traced_joints; ++i) {
    const JointForce f = joint_force(model, state, model.system.traced_joint[i]);
    all.insert(all.end(), f.force, f.force + 3);
    all.insert(all.end(), f.moment, f.moment + 3);
  }
  for (std::int32_t i = 0; i < model.system.traced_springs; ++i)
    all.push_back(state.row_force[model.system.joint_rows + model.system.traced_spring[i]]);
  return all;
}

/// A model whose system can be changed.
struct Open {
  Model model;
  std::vector<RigidBodyModel> body;
  std::vector<BeamChainModel> beam;
  std::vector<RailPortModel> port;
  std::vector<MarkerModel> marker;
  std::vector<RowModel> row;
  std::vector<EndModel> end;
  std::vector<MotionModel> motion;
  std::vector<PointForceModel> force;
  std::vector<std::int32_t> part_end, held, sensor, traced_joint, traced_spring;
  std::vector<double> start;

  explicit Open(const Model& of) : model(of) {
    SystemModel& s = model.system;
    const auto take = [](auto& own, auto*& at, std::int64_t count) {
      own.assign(at, at + count);
      at = own.data();
    };
    take(body, s.body, s.bodies);
    take(beam, s.beam, s.beams);
    take(port, s.port, s.ports);
    take(marker, s.marker, s.markers);
    take(row, s.row, system_rows(s));
    take(end, s.end, s.ends);
    take(motion, s.motion, s.motions);
    take(force, s.force, s.forces);
    take(part_end, s.part_end, s.bodies + s.beams + 2);
    take(held, s.held_unknown, s.held);
    take(sensor, s.sensor, s.sensors);
    take(traced_joint, s.traced_joint, s.traced_joints);
    take(traced_spring, s.traced_spring, s.traced_springs);
    take(start, model.start, start_doubles(model));
  }
};

template <typename Change>
LoadStatus status_with(int kind, const Change& change) {
  const std::unique_ptr<PackedSystem> packed = small_model(kind);
  Open open(packed->model());
  change(open, open.model.system);
  return status_of(to_block(open.model, kSystemText));
}

}  // namespace

TEST_CASE("a system that was written and read steps to the same bits", "[artefact][system]") {
  for (int kind = 0; kind < kKinds; ++kind) {
    const std::unique_ptr<PackedSystem> packed = small_model(kind);
    const Block block = to_block(packed->model(), kSystemText);
    Model model;
    CAPTURE(kind);
    REQUIRE(read(block, model).status == LoadStatus::ok);
    LoadedRun written(packed->model()), found(model);
    CHECK(read_out(model, found.state) == read_out(packed->model(), written.state));
    CHECK(written.frames(20) == found.frames(20));
    CHECK(found.state.steps == 40);
    CHECK(found.outputs.first_bad_unknown == -1);
    CHECK(state_hash(model, found.state) == state_hash(packed->model(), written.state));
    CHECK(read_out(model, found.state) == read_out(packed->model(), written.state));
    CHECK(written.track_sensors == found.track_sensors);
    CHECK(written.outputs.iterations == found.outputs.iterations);
    CHECK(written.outputs.force_residual == found.outputs.force_residual);
    const bool same = to_block(model, kSystemText) == block;
    CHECK(same);
    const bool again = to_block(small_model(kind)->model(), kSystemText) == block;
    CHECK(again);  // in another heap: nothing is left unset
  }
}

TEST_CASE("a block does not hold a matrix that is kept over steps", "[artefact][system]") {
  SystemOptions options = options_of(ConstraintMethod::augmented_lagrangian, Renew::every_step);
  const PackedSystem made_anew(small_system(false), options);
  options.renew = Renew::kept;
  const PackedSystem kept(small_system(false), options);
  CHECK(to_block(kept.model(), kSystemText).size() ==
        to_block(made_anew.model(), kSystemText).size());
  CHECK(state_doubles(kept.model()) > start_doubles(kept.model()));
  // Reset removes the matrix from a state.
  LoadedRun run(kept.model());
  const std::uint64_t at_start = state_hash(run.model, run.state);
  (void)run.frames(1);
  reset(run.model, run.state);
  CHECK(state_hash(run.model, run.state) == at_start);
}

TEST_CASE("a system's block cut short is refused, signed again or not", "[artefact][system]") {
  for (const int kind : {1, 7}) {
    const Block good = to_block(small_model(kind)->model(), kSystemText);
    for (std::size_t size = payload_of(good); size < good.size(); size += 56) {
      Block cut(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
      CAPTURE(kind, size);
      CHECK(status_of(cut) == LoadStatus::wrong_size);
      sign(cut);
      CHECK(status_of(cut) == LoadStatus::bad_content);
    }
  }
}

TEST_CASE("a system's indices and sizes out of range are refused", "[artefact][system]") {
  const auto refused = [](const auto& change, int kind = 1) {
    return status_with(kind, change) == LoadStatus::bad_content;
  };
  CHECK(status_with(1, [](Open&, SystemModel&) {}) == LoadStatus::ok);
  CHECK(status_with(7, [](Open&, SystemModel&) {}) == LoadStatus::ok);
  // parts
  CHECK(refused([](Open& o, SystemModel&) { o.body[0].first = 1; }));
  CHECK(refused([](Open& o, SystemModel&) { o.body[1].unknowns = 3; }));
  CHECK(refused([](Open& o, SystemModel&) { o.body[1].column[5] = 6; }));
  CHECK(refused([](Open& o, SystemModel&) { o.body[1].column[5] = 4; }));
  CHECK(refused([](Open& o, SystemModel&) { o.body[1].column[5] = -2; }));
  CHECK(refused([](Open& o, SystemModel&) { o.beam[0].elements = 3; }));
  CHECK(refused([](Open& o, SystemModel&) { o.beam[0].planar = 1; }));
  CHECK(refused([](Open& o, SystemModel&) { o.beam[0].held = 10; }));
  CHECK(refused([](Open& o, SystemModel&) { o.beam[1].first_held = -1; }));
  CHECK(refused([](Open& o, SystemModel&) { o.held[0] = 45; }));
  CHECK(refused([](Open& o, SystemModel&) { o.port[0].rail = 2; }, 7));
  CHECK(refused([](Open& o, SystemModel&) { o.port[1].element = 4; }, 7));
  CHECK(refused([](Open& o, SystemModel&) { o.port[1].first += 1; }, 7));
  // markers
  CHECK(refused([](Open& o, SystemModel&) { o.marker[0].part = 2; }));
  CHECK(refused([](Open& o, SystemModel&) { o.marker[0].node = 3; }));
  CHECK(refused([](Open& o, SystemModel&) { o.marker[0].kind = PartKind::rail; }));
  CHECK(refused([](Open& o, SystemModel&) { o.marker[0].kind = static_cast<PartKind>(4); }));
  // rows and their ends
  CHECK(refused([](Open& o, SystemModel&) { o.row[0].a = static_cast<int>(o.marker.size()); }));
  CHECK(refused([](Open& o, SystemModel& s) { o.row[0].a = s.sensor[0]; }));  // it has no place
  CHECK(refused([](Open& o, SystemModel&) { o.row[0].i = 3; }));
  CHECK(refused([](Open& o, SystemModel&) { o.row[0].l = -1; }));
  CHECK(refused([](Open& o, SystemModel&) { o.row[0].kind = RowKind::spring; }));
  CHECK(refused([](Open& o, SystemModel&) { o.row.back().kind = RowKind::distance; }));
  CHECK(refused([](Open& o, SystemModel& s) { o.row[0].motion = s.motions; }));
  CHECK(refused([](Open& o, SystemModel&) { o.row[0].end[0] = -1; }));
  CHECK(refused([](Open& o, SystemModel&) { o.row[0].end[0] += 1; }));
  CHECK(refused([](Open& o, SystemModel&) { o.end[0].row = 1; }));
  CHECK(refused([](Open& o, SystemModel&) { o.end[0].side = 2; }));
  CHECK(refused([](Open& o, SystemModel&) { o.part_end[1] += 1; }));
  CHECK(refused([](Open& o, SystemModel& s) { o.part_end[1] = s.ends + 1; }));
  // motions, forces and readings
  CHECK(refused([](Open& o, SystemModel&) { o.motion[0].pieces = 0; }));
  CHECK(refused([](Open& o, SystemModel& s) { o.motion[0].first = s.pieces; }));
  CHECK(refused([](Open& o, SystemModel& s) { o.force[0].motion = s.motions; }));
  CHECK(refused([](Open& o, SystemModel& s) { o.force[0].marker = s.markers; }));
  CHECK(refused([](Open& o, SystemModel&) { o.force[0].moment = 1; }));  // on a beam
  CHECK(refused([](Open& o, SystemModel& s) { o.sensor[0] = s.markers; }));
  CHECK(refused([](Open& o, SystemModel& s) { o.traced_joint[0] = system_rows(s); }));
  CHECK(refused([](Open& o, SystemModel& s) { o.traced_spring[0] = s.spring_rows; }));
  // the whole system
  CHECK(refused([](Open&, SystemModel& s) { s.first = 0; }, 7));
  CHECK(refused([](Open& o, SystemModel&) { o.model.lines = 0; }, 7));
  CHECK(refused([](Open& o, SystemModel&) { o.model.loads = 1; }));  // without a track
  CHECK(refused([](Open&, SystemModel& s) { s.mean = 1; }, 3));
  CHECK(refused(
      [](Open&, SystemModel& s) { s.constraint_method = ConstraintMethod::gear_gupta_leimkuhler; },
      7));
}

TEST_CASE("a system that is physically impossible is refused", "[artefact][system]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const auto& change) {
    return status_with(1, change) == LoadStatus::bad_content;
  };
  for (const double none : {0., -1., nan, std::numeric_limits<double>::infinity()}) {
    CAPTURE(none);
    CHECK(refused([=](Open& o, SystemModel&) { o.body[0].mass = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.body[0].radius = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.body[0].inertia[4] = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.beam[0].mass[0] = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.beam[0].element.per_length = none; }));
    CHECK(refused([=](Open&, SystemModel& s) { s.tolerance = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.model.scheme.kg = none; }));
  }
  for (const double negative : {-1e-9, nan}) {
    CAPTURE(negative);
    CHECK(refused([=](Open& o, SystemModel&) { o.row[0].compliance = negative; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.row.back().stiffness = negative; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.row.back().damping = negative; }));
    CHECK(refused([=](Open&, SystemModel& s) { s.alpha = negative; }));
  }
  for (const double none : {nan, -std::numeric_limits<double>::infinity(), 1e61}) {
    CAPTURE(none);
    CHECK(refused([=](Open& o, SystemModel&) { o.row[0].offset = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.row.back().offset = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.beam[0].element.stiffness[0] = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.marker[0].position[2] = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.marker[0].frame[8] = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.marker[0].value[1] = none; }));
    CHECK(refused([=](Open& o, SystemModel&) { o.force[0].direction[0] = none; }));
  }
  CHECK(refused([](Open& o, SystemModel&) { o.row.back().stiffness = o.row.back().damping = 0.; }));
  CHECK(refused([](Open& o, SystemModel&) {
    for (RowModel& row : o.row)
      if (row.kind == RowKind::distance) row.offset = 0.;
  }));
  CHECK(refused([](Open&, SystemModel& s) { s.cap = 0; }));
  CHECK(refused([](Open&, SystemModel& s) { s.keep_steps = 0; }));
  // Quaternions are after u, v, a, g.
  CHECK(refused([](Open& o, SystemModel&) {
    o.start[4 * static_cast<std::size_t>(o.model.unknowns)] = 1.1;
  }));
}

TEST_CASE("every system that loads can be stepped and read, whatever its numbers are",
          "[artefact][system][fuzz]") {
  std::mt19937_64 random(20241103);
  for (int kind = 0; kind < kKinds; ++kind) {
    const Block good = to_block(small_model(kind)->model(), kSystemText);
    int loaded = 0, refused = 0;
    for (int round = 0; round < 1500; ++round) {
      const Block bad = round % 2 == 0 ? mutated(good, random) : with_other_integer(good, random);
      Model model;
      if (read(bad, model).status != LoadStatus::ok) {
        ++refused;
        continue;
      }
      ++loaded;
      model.steps_per_frame = std::min(model.steps_per_frame, 4);  // only to save time, as the caps
      model.system.cap = std::min(model.system.cap, 5);
      model.system.projections = std::min(model.system.projections, 3);
      LoadedRun run(model);
      // The test ends where a state is no longer finite.
      const bool lost = has(run.frames(2), Status::nonfinite_state);
      (void)read_out(model, run.state);
      CHECK((run.state.steps == 2 * model.steps_per_frame || lost));
      CHECK(run.state.steps % model.steps_per_frame == 0);
    }
    CAPTURE(kind, loaded, refused);
    CHECK(loaded > 100);
    CHECK(refused > 100);
  }
}
