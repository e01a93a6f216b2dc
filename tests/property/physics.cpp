// Laws of rest, energy and status.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "properties.h"
#include "run/run_energy.h"
#include "transform.h"

namespace railstep::property {
namespace {

/// Keeps only the first value of rows [t, value], from t = 0 on.
void make_constant(Document& carrier, const char* key) {
  if (carrier.contains(key)) carrier[key] = {{0., carrier[key][0][1].get<double>()}};
}

void stand(Document& carrier) {
  if (carrier.contains("speed_table")) carrier.erase("speed_table");
  carrier["speed_m_per_s"] = 0.;
  for (const char* key : {"stop_m", "tread", "drop_height_m", "drop_speed_m_per_s", "amplitude_n",
                          "frequency_hz", "phase_deg"})
    carrier.erase(key);
  make_constant(carrier, "table");
  for (Document& f : carrier["force"]) make_constant(f, "table");
}

void stand_still(Document& scene) {
  for (Document& b : scene["body"])
    for (const char* key : {"velocity_m_per_s", "angular_velocity_rad_per_s"}) b.erase(key);
  for (Document& j : scene["joint"])
    for (const char* key : {"polynomial_rad", "table_rad"})
      if (j.contains(key)) {
        j.erase(key);
        j["polynomial_rad"] = {0.};
      }
  for (Document& f : scene["force"])
    for (const char* unit : {"n", "n_m"}) {
      const std::string polynomial = std::string("polynomial_") + unit,
                        table = std::string("table_") + unit,
                        constant =
                            (std::string(unit) == "n" ? "force_" : "moment_") + std::string(unit);
      if (f.contains(polynomial)) f[constant] = f[polynomial][0].get<double>();
      if (f.contains(table)) f[constant] = f[table][1][1].get<double>();
      f.erase(polynomial);
      f.erase(table);
    }
}

/// The scene with all traffic and drives stopped, in equilibrium.
Document at_rest(const Document& scene) {
  Document still = scene;
  for (const char* carriers : {"load", "wheelset", "vehicle"})
    for (Document& carrier : still[carriers]) stand(carrier);
  stand_still(still);
  still["step"]["start"] = "equilibrium";
  return still;
}

/// Rounding of a rate in a trace at rest: that of displacements over the step or its square, as
/// schemes compute rates so. 0 for other units.
double stray(const std::string& unit, double rounding, double dt, double metres) {
  if (unit == "m_per_s") return rounding * metres / dt;
  if (unit == "m_per_s2") return rounding * metres / (dt * dt);
  return 0.;
}

}  // namespace

Outcome rest(const Document& own, std::uint64_t) {
  constexpr double kFar = 5.;  // m
  const Document scene = at_rest(own);
  const Trace trace = trace_of(scene);
  const std::vector<double> scales = scales_of(trace);
  double metres = 0.;
  for (std::size_t c = 0; c < scales.size(); ++c)
    if (quantity_of(trace.columns, c).unit == "m") {
      metres = std::max(metres, scales[c]);
      if (!is_track_alone(scene)) metres = std::max(metres, std::abs(trace.at(0, c)));
    }
  const double dt = number(scene["step"], "dt_s"), rounding = rounding_of(scene);
  Distance worst;
  for (std::size_t c = 1; c < trace.columns.size(); ++c) {
    const std::string unit = quantity_of(trace.columns, c).unit;
    if (unit == "n_s") continue;  // impulses of frames: the start is not a frame and has 0
    if (metres > kFar) return Outcome::none("it has gone far off to find its rest");
    const double rate = stray(unit, 1., dt, metres), scale = rate > 0. ? rate : scales[c];
    const double size = 4e-16 * std::abs(trace.at(0, c));
    for (std::size_t frame = 1; frame < trace.frames(); ++frame) {
      const double off = std::max(0., std::abs(trace.at(frame, c) - trace.at(0, c)) - size);
      const double part = off == 0. ? 0. : off / scale;
      if (!(part <= worst.largest))
        worst = {part, trace.columns[c], trace.at(frame, 0), trace.at(0, c), trace.at(frame, c)};
    }
  }
  return Outcome::of(worst.largest <= rounding,
                     fmt::format("{}; allowed {:.2g}", worst.text(), rounding));
}

namespace {

struct Energies {
  double error, loss;
};
std::optional<Energies> energies_of(const Document& scene) {
  const auto run = simulation_of(scene);
  const RunRecord record = simulate(*run, frames_of(*run), nullptr, true);
  const Trace trace{run->columns(), record.rows, record.status, true, 0, {}};
  double moved = 0.;
  for (std::size_t c = 1; c < trace.columns.size(); ++c)
    for (std::size_t frame = 0; frame < trace.frames(); ++frame)
      if (quantity_of(trace.columns, c).unit == "m")
        moved = std::max(moved, std::abs(trace.at(frame, c) - trace.at(0, c)));
  if (moved < 1e-9) return std::nullopt;  // rounding has no balance
  const auto found = balance_of_run(*run, record, frames_of(*run));
  if (!found) return std::nullopt;
  return Energies{found->error, found->numerical_loss};
}

Document at_step(const Document& scene, int finer) {
  Document other = scene;
  other["step"]["frame_s"] = number(scene["step"], "frame_s", number(scene["step"], "dt_s"));
  other["step"]["dt_s"] = number(scene["step"], "dt_s") / finer;
  return other;
}

}  // namespace

namespace {

bool is_damped(const Document& scene) {
  const Document& springs = tables(scene, "spring");
  return std::any_of(springs.begin(), springs.end(),
                     [](const Document& s) { return s.contains("damping_n_s_per_m"); });
}

}  // namespace

/// The scheme's own loss is known in closed form. So the error of a track in full order is only the
/// contact's frozen geometry, that of a condensed track the trapezoidal sums, that of a system the
/// loss itself. The error has to fall with the step.
Outcome energy(const Document& scene, std::uint64_t) {
  for (const Document& j : tables(scene, "joint"))
    if (j.contains("table_rad")) return Outcome::none("a spline's drive begins with a jump");
  if (has_bonded(scene))
    return Outcome::none("bonded wheels meet blows at the borders of elements");
  const auto found = energies_of(scene);
  if (!found) return Outcome::none("energies are not told, or nothing moves");
  const bool system = !is_track_alone(scene);
  const auto left_of = [&](const Energies& e) {
    return system ? e.error : std::abs(e.error - std::abs(e.loss));
  };
  const double left = left_of(*found);
  std::string figures = fmt::format("balance {:.3g}, loss {:.3g}", found->error, found->loss);
  if (scene["step"]["scheme"] == "energy-momentum" && tables(scene, "force").empty() &&
      tables(scene, "joint").empty() && !is_damped(scene))
    return Outcome::of(left < 1e-6, figures + ", of a scheme that keeps energy");
  const bool exact = !system && !is_condensed(scene) && !has_hertz(scene) && !is_endless(scene);
  const double small = exact ? 1e-6 : 1e-3;
  if (left <= small) return Outcome::of(true, figures);
  const auto finer = energies_of(at_step(scene, 8));
  if (!finer) return Outcome::of(false, figures + ", and of an eighth of the step none");
  figures += fmt::format("; of an eighth of the step {:.3g}, {:.3g}", finer->error, finer->loss);
  return Outcome::of(left_of(*finer) <= std::max(small, .5 * left), figures);
}

Outcome status(const Document& scene, std::uint64_t) {
  const auto run = simulation_of(scene);
  const Trace trace = trace_of(*run);
  for (std::size_t i = 0; i < trace.rows.size(); ++i)
    if (!std::isfinite(trace.rows[i]))
      return Outcome::of(false, trace.columns[i % trace.columns.size()] + " is not finite");
  Status never = Status::nonfinite_state | Status::nonfinite_input | Status::force_saturated |
                 Status::off_rail | Status::cap_reached | Status::redundant_joint;
  if (!has_hertz(scene)) never = never | Status::contact_lost | Status::contact_unresolved;
  for (const std::string& name : status_names(trace.status & never))
    return Outcome::of(false, name + " of an ordinary scene");
  return {};
}

namespace {

/// Adds an input where a system or a track's bodies can have one.
bool add_input(Document& scene) {
  for (const char* carriers : {"wheelset", "vehicle"})
    if (!tables(scene, carriers).empty()) {
      Document& carrier = scene[carriers][0];
      Document force = {{"direction", "z"}, {"input", "push"}, {"limit_n", 1e3}};
      if (std::string(carriers) == "vehicle")
        force["body"] = carrier["type"] == "bogie" ? "frame" : "body";
      carrier["force"] = Document::array({force});
      return true;
    }
  if (tables(scene, "body").empty()) return false;
  scene["force"].push_back({{"on", scene["body"][0]["name"]},
                            {"point_m", scene["body"][0]["position_m"]},
                            {"direction", {0., 0., 1.}},
                            {"input", "push"},
                            {"limit_n", 1e3}});
  return true;
}

Status met_with(const Document& scene, double value, bool& finite) {
  const auto run = simulation_of(scene);
  const auto inputs = [&value](std::int64_t) { return &value; };
  const RunRecord record = simulate(*run, frames_of(*run), nullptr, true, {}, inputs);
  finite = std::all_of(record.rows.begin(), record.rows.end(),
                       [](double x) { return std::isfinite(x); });
  return record.status;
}

}  // namespace

Outcome provoked(const Document& own, std::uint64_t) {
  Document scene = own;
  if (scene.contains("track") && !is_endless(scene)) {
    const double length = number(scene["track"], "bays") * number(scene["track"], "bay_m");
    Document off = {{"name", "off"}, {"start_m", length + .1}, {"force_z_n", -1e3}};
    off["may_leave_rail"] = true;
    if (number(scene["track"], "rails") == 2.) off["rail"] = "left";
    scene["load"].push_back(off);
    if (!has(trace_of(scene).status, Status::off_rail))
      return Outcome::of(false, "a load off the rail is not told of");
  }
  scene = own;
  if (!add_input(scene)) return Outcome::none("nothing takes an input");
  bool finite = true;
  const Status bad = met_with(scene, std::numeric_limits<double>::quiet_NaN(), finite);
  if (!has(bad, Status::nonfinite_input) || !finite)
    return Outcome::of(false, "an input that is not a number is not told of, or gets through");
  const Status large = met_with(scene, -1e9, finite);
  if (!has(large, Status::force_saturated) || !finite)
    return Outcome::of(false, "an input beyond its limit is not told of, or gets through");
  return {};
}

}  // namespace railstep::property
