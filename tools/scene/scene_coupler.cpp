#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scene/vehicle_read.h"

namespace railstep {
namespace {

/// Where a vehicle of the scene is in its train.
struct InTrain {
  std::size_t train;  // index of the vehicle that stands for it
  int first_body;
};

/// A body of a vehicle, or the ground.
struct CouplerEnd {
  std::size_t vehicle = 0;
  int body = kGround;
};

CouplerEnd end_of(const Table& t, const std::string& name,
                  const std::vector<RailVehicleScene>& vehicles) {
  std::vector<std::string> names;
  for (std::size_t v = 0; v < vehicles.size(); ++v)
    for (std::size_t b = 0; b < vehicles[v].runner.bodies.size(); ++b) {
      names.push_back(vehicles[v].name + "." + vehicles[v].runner.bodies[b].name);
      if (names.back() == name) return {v, static_cast<int>(b)};
    }
  if (name == kGroundName) return {};
  names.emplace_back(kGroundName);
  t.refuse("between", "E-COUPLER-01",
           fmt::format("\"{}\" is not a body of a vehicle in space; expected one of {}", name,
                       fmt::join(names, ", ")));
}

void check_alike(const Table& t, const RailVehicleScene& a, const RailVehicleScene& b) {
  if (a.speed != b.speed || a.speeds != b.speeds || a.rolls_freely != b.rolls_freely)
    t.refuse("between", "E-COUPLER-02",
             fmt::format("the speeds of {} and {} differ, or their drives; expected one speed and "
                         "drive of all vehicles that are coupled",
                         a.name, b.name));
  if (!has_profiles(a.contact) && a.contact.hertz != b.contact.hertz)
    t.refuse("between", "E-COUPLER-03",
             fmt::format("the wheels of {} and {} have other radii, and with them other Hertz "
                         "constants; expected contact.hertz_n_per_m15, which is then that of all",
                         a.name, b.name));
}

void move_on(RunnerElement& e, int bodies, double ahead) {
  for (int* body : {&e.a, &e.b})
    if (*body != kGround) *body += bodies;
  e.point_a[0] += ahead;
  e.point_b[0] += ahead;
}
void move_on(RunnerForceElement& s, int bodies, double ahead) {
  for (int* body : {&s.a, &s.b})
    if (*body != kGround) *body += bodies;
  s.point_a[0] += ahead;
  s.point_b[0] += ahead;
}

/// Adds a train to another one. Its places count from the other's origin then.
void append(const RailVehicleScene& more, RailVehicleScene& train) {
  const auto bodies = static_cast<int>(train.runner.bodies.size());
  const auto elements = static_cast<int>(train.runner.elements.size());
  const double ahead = more.start - train.start;
  for (RunnerBody body : more.runner.bodies) {
    body.centre[0] += ahead;
    train.runner.bodies.push_back(body);
  }
  for (RunnerElement element : more.runner.elements) {
    move_on(element, bodies, ahead);
    train.runner.elements.push_back(element);
  }
  for (RunnerForceElement element : more.runner.force_elements) {
    move_on(element, bodies, ahead);
    if (element.pressed_by >= 0) element.pressed_by += elements;
    train.runner.force_elements.push_back(element);
  }
  for (OuterForce force : more.forces) {
    force.direction += kMotions * bodies;
    train.forces.push_back(force);
  }
  for (RailVehicleScene::Part part : more.parts) {
    part.first += static_cast<std::size_t>(bodies);
    train.parts.push_back(part);
  }
  for (auto names : {&RailVehicleScene::wheelsets, &RailVehicleScene::rods,
                     &RailVehicleScene::force_elements, &RailVehicleScene::traced}) {
    std::vector<std::string>& all = train.*names;
    all.insert(all.end(), (more.*names).begin(), (more.*names).end());
  }
}

/// Each end of an element counts from the origin of its own vehicle.
void place(RunnerElement& e, double ahead_a, double ahead_b) {
  e.point_a[0] += ahead_a;
  e.point_b[0] += e.kind == RunnerElement::Kind::mid_frame ? ahead_a : ahead_b;
}
void place(RunnerForceElement& e, double ahead_a, double ahead_b) {
  e.point_a[0] += ahead_a;
  e.point_b[0] += e.along == RunnerForceElement::Along::line ? ahead_b : ahead_a;
}

/// Couplers along a line are always in the trace.
void note_element(RunnerElement& e, RailVehicleScene& train) {
  if (e.kind == RunnerElement::Kind::rod) train.rods.push_back(e.name);
  e.traced = e.traced || e.kind == RunnerElement::Kind::line;
  train.traced.insert(train.traced.end(), traced_entries(e).size(), e.name);
}
void note_element(const RunnerForceElement& s, RailVehicleScene& train) {
  train.force_elements.push_back(s.name);
}

/// Trains that grow coupler by coupler.
struct Trains {
  const std::vector<RailVehicleScene> vehicles;  // as they are alone
  std::vector<RailVehicleScene> trains;          // by their first vehicle
  std::vector<InTrain> in;                       // of each vehicle

  explicit Trains(std::vector<RailVehicleScene> alone)
      : vehicles(std::move(alone)), trains(vehicles) {
    for (std::size_t v = 0; v < vehicles.size(); ++v) in.push_back({v, 0});
  }
  void join(std::size_t a, std::size_t b) {
    const auto [kept, gone] = std::minmax(in[a].train, in[b].train);
    if (kept == gone) return;
    const auto bodies = static_cast<int>(trains[kept].runner.bodies.size());
    append(trains[gone], trains[kept]);
    for (InTrain& own : in)
      if (own.train == gone) own = {kept, own.first_body + bodies};
  }
  void add(const Table& t) {
    const std::vector<RunnerPart> parts = read_runner_parts(t);
    const std::string name = checked_name(t, "name", t.string("name"));
    const std::vector<std::string> between = t.strings("between", 2, 2);
    if (between.size() != 2) return;  // its error is kept
    CouplerEnd a = end_of(t, between[0], vehicles), b = end_of(t, between[1], vehicles);
    if (a.body == kGround && b.body == kGround)
      t.refuse("between", "E-COUPLER-04",
               "a coupler lies between the ground and itself; expected a body of a vehicle");
    if (a.body == kGround) a.vehicle = b.vehicle;
    if (b.body == kGround) b.vehicle = a.vehicle;
    check_alike(t, vehicles[a.vehicle], vehicles[b.vehicle]);
    join(a.vehicle, b.vehicle);
    RailVehicleScene& train = trains[in[a.vehicle].train];
    const auto body_of = [&](const CouplerEnd& end) {
      return end.body == kGround ? kGround : end.body + in[end.vehicle].first_body;
    };
    RunnerParts own_parts(train.runner);
    for (RunnerPart part : parts) {
      std::visit(
          [&](auto& own) {
            own.name = name + part.suffix;
            place(own, vehicles[a.vehicle].start - train.start,
                  vehicles[b.vehicle].start - train.start);
            note_element(own, train);
          },
          part.of);
      own_parts.add_part(part, {name, body_of(a), body_of(b)}, {part.pressed_by + part.of_presser});
    }
    own_parts.find_pressers(t, "name");
  }
};

}  // namespace

void read_couplers(const Table& root, std::vector<RailVehicleScene>& vehicles) {
  Trains all(std::move(vehicles));
  root.each("coupler", [&](const Table& t) { all.add(t); });
  vehicles.clear();
  for (std::size_t v = 0; v < all.trains.size(); ++v)
    if (all.in[v].train == v) vehicles.push_back(std::move(all.trains[v]));
}

}  // namespace railstep
