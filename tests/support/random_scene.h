#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/random_draw.h"

namespace railstep {

inline constexpr double kRandomBay = .6;  // m

/// A force on the rail: constant, by a table of time, or a sine.
struct RandomLoad {
  double start = .3, speed = 0., force = -1e4;        // m, m/s, N
  std::vector<std::pair<double, double>> table = {};  // s, factor
  double amplitude = 0., frequency = 0.;              // N, Hz
};

struct RandomVehicle {
  std::string type = "mass";                 // "mass", "sprung_mass" or "bogie"
  double mass = 500., unsprung = 0.;         // kg
  double stiffness = 1e6, damping = 0.;      // of its suspension
  double wheelbase = 0.;                     // m, of a bogie
  double start = .3, speed = 0.;             // m, m/s
  double drop_speed = .1, drop_height = 0.;  // of a Hertz contact
  double linear = 0.;                        // N/m, of a linear contact; 0: Hertz
  bool gravity = true;
  double reach() const { return .5 * wheelbase; }  // m, of its wheels ahead of its middle
};

/// A small track of one rail under random traffic of a seed, which text_of() writes as a scene.
struct RandomScene {
  std::uint64_t seed = 0;
  bool full = false;  // nine unknowns a node, else the two of vertical motion
  int bays = 1, elements = 1;
  double pad = 1e8, pad_damper = 0.;  // N/m, N s/m
  bool unilateral = false;            // the pads press and do not pull
  bool sleepers = false;
  double sleeper_mass = 0., ballast = 1e8, ballast_damper = 0.;  // kg for both ends
  std::array<std::string, 2> ends = {"free", "free"};
  double dt = 1e-4;
  int steps = 100;
  std::vector<RandomLoad> loads = {};
  std::optional<RandomVehicle> vehicle = std::nullopt;
  std::string scheme;    // lines of [step]
  std::string condense;  // lines of [condense]

  double length() const { return bays * kRandomBay; }
  double duration() const { return steps * dt; }
  bool damped() const {
    return pad_damper > 0. || (sleepers && ballast_damper > 0.) ||
           (vehicle && vehicle->damping > 0.);
  }
};

namespace random_scene {

inline std::string track_text(const RandomScene& s) {
  std::string text = fmt::format(
      "[track]\nunknowns = \"{}\"\nrails = 1\nbays = {}\nbay_m = {}\nelements_per_bay = {}\n"
      "ends = [\"{}\", \"{}\"]\n\n"
      "[rail.constants]\narea_m2 = 8700e-6\ninertia_y_m4 = 39.0e-6\ninertia_z_m4 = 6.0e-6\n"
      "torsion_m4 = 1.9514e-6\nshear_factor_y = 0.4796\nshear_factor_z = 0.4721\n"
      "centroid_height_m = 0.085\nshear_centre_height_m = 0.0459\nheight_m = 0.1857375\n\n"
      "[support]\nat = \"{}\"\nstiffness_z_n_per_m = {:.17g}\ndamping_z_n_s_per_m = {:.17g}\n",
      s.full ? "full" : "vertical", s.bays, kRandomBay, s.elements, s.ends[0], s.ends[1],
      s.full ? "foot" : "axis", s.pad, s.pad_damper);
  if (s.full)
    text += fmt::format(
        "stiffness_x_n_per_m = {0:.17g}\nstiffness_y_n_per_m = {0:.17g}\n"
        "stiffness_roll_n_m_per_rad = 1e6\n",
        s.pad);
  if (s.unilateral) text += "unilateral = true\n";
  if (s.sleepers)
    text += fmt::format(
        "\n[sleeper]\nmass_kg = {:.17g}\n\n[ballast]\nstiffness_z_n_per_m = {:.17g}\n"
        "damping_z_n_s_per_m = {:.17g}\n",
        s.sleeper_mass, s.ballast, s.ballast_damper);
  return text;
}

inline std::string load_text(const RandomLoad& load, std::size_t number) {
  std::string text = fmt::format(
      "\n[[load]]\nname = \"load_{}\"\nstart_m = {:.17g}\nspeed_m_per_s = {:.17g}\n"
      "force_z_n = {:.17g}\n",
      number, load.start, load.speed, load.force);
  for (std::size_t i = 0; i < load.table.size(); ++i)
    text += fmt::format("{}[{:.17g}, {:.17g}]{}", i == 0 ? "table = [" : ", ", load.table[i].first,
                        load.table[i].second, i + 1 == load.table.size() ? "]\n" : "");
  if (load.amplitude != 0.)
    text += fmt::format("amplitude_n = {:.17g}\nfrequency_hz = {:.17g}\n", load.amplitude,
                        load.frequency);
  return text;
}

inline std::string vehicle_text(const RandomVehicle& v) {
  std::string text = fmt::format(
      "\n[[vehicle]]\nname = \"wheel\"\ntype = \"{}\"\nstart_m = {:.17g}\n"
      "speed_m_per_s = {:.17g}\ngravity = {}\n",
      v.type, v.start, v.speed, v.gravity);
  if (v.linear > 0.)
    text += fmt::format("contact = \"linear\"\ncontact_stiffness_n_per_m = {:.17g}\n", v.linear);
  else
    text +=
        fmt::format("contact = \"hertz\"\ndrop_height_m = {:.17g}\ndrop_speed_m_per_s = {:.17g}\n",
                    v.drop_height, v.drop_speed);
  if (v.type == "bogie")
    return text + fmt::format(
                      "frame_mass_kg = {:.17g}\nframe_inertia_kg_m2 = {:.17g}\n"
                      "wheel_mass_kg = {:.17g}\nwheelbase_m = {:.17g}\n"
                      "primary_stiffness_n_per_m = {:.17g}\nprimary_damping_n_s_per_m = {:.17g}\n",
                      v.mass, .25 * v.mass, v.unsprung, v.wheelbase, v.stiffness, v.damping);
  text += fmt::format("mass_kg = {:.17g}\n", v.mass);
  if (v.type == "sprung_mass")
    text += fmt::format(
        "unsprung_mass_kg = {:.17g}\nstiffness_n_per_m = {:.17g}\ndamping_n_s_per_m = {:.17g}\n",
        v.unsprung, v.stiffness, v.damping);
  return text;
}

}  // namespace random_scene

/// The text of the scene's file.
inline std::string text_of(const RandomScene& s) {
  std::string text =
      fmt::format("# Seed {}.\nschema = 1\n\n", s.seed) + random_scene::track_text(s);
  for (std::size_t i = 0; i < s.loads.size(); ++i) text += random_scene::load_text(s.loads[i], i);
  if (s.vehicle) text += random_scene::vehicle_text(*s.vehicle);
  text += fmt::format("\n[step]\ndt_s = {:.17g}\nduration_s = {:.17g}\nstart = \"released\"\n{}",
                      s.dt, s.duration(), s.scheme);
  if (!s.condense.empty()) text += "\n[condense]\n" + s.condense;
  return text;
}

/// The scene as the program reads it.
inline Scene read(const RandomScene& s) {
  const auto file = std::filesystem::temp_directory_path() /
                    fmt::format("railstep_random_{}_{}.toml", getpid(), s.seed);
  std::ofstream(file) << text_of(s);
  const struct Removed {
    const std::filesystem::path& file;
    ~Removed() { std::filesystem::remove(file); }
  } removed{file};
  return read_scene(file);
}

/// Track, step and steps of a seed, without traffic.
inline RandomScene random_track(std::uint64_t seed, Draw& draw) {
  RandomScene s;
  s.seed = seed;
  s.full = draw.chance(.15);
  s.bays = draw.whole(1, s.full ? 3 : 8);
  s.elements = draw.whole(1, s.full ? 2 : 3);
  s.pad = draw.of_any_size(1e6, 1e10);
  if (draw.chance(.5)) s.pad_damper = draw.of_any_size(1e2, 1e6);
  s.sleepers = draw.chance(.5);
  if (s.sleepers) {
    s.sleeper_mass = draw.chance(.2) ? 0. : draw.of_any_size(1., 500.);
    s.ballast = draw.of_any_size(1e6, 1e10);
    if (draw.chance(.5)) s.ballast_damper = draw.of_any_size(1e2, 1e6);
  }
  const std::array<std::string, 3> ends = {"free", "pinned", "clamped"};
  s.ends = {draw.one_of(ends), draw.one_of(ends)};
  s.dt = draw.of_any_size(1e-5, 5e-3);
  return s;
}

/// Draws a place and a speed for a runner that reaches `reach` on either side: it stands, or rolls
/// so that it stays on the rail, at 100 m/s at most.
inline void send(Draw& draw, const RandomScene& s, double reach, double& start, double& speed) {
  const double edge = reach + .01;
  start = draw.between(edge, s.length() - edge);
  speed = 0.;
  if (draw.chance(.5))
    speed = std::min(100., draw.between(.2, .99) * (s.length() - edge - start) / s.duration());
}

/// A vehicle that falls on the track.
inline RandomVehicle random_vehicle(Draw& draw, const RandomScene& s, bool linear) {
  RandomVehicle v;
  const std::array<std::string, 3> types = {"mass", "sprung_mass", "bogie"};
  v.type = draw.one_of(types);
  v.mass = draw.of_any_size(10., 5e3);
  if (v.type != "mass") {
    v.unsprung = draw.of_any_size(10., 1e3);
    v.stiffness = draw.of_any_size(1e5, 1e8);
    if (draw.chance(.5)) v.damping = draw.of_any_size(1e2, 1e5);
  }
  if (v.type == "bogie") v.wheelbase = draw.between(.2, .8) * s.length();
  if (linear) v.linear = draw.of_any_size(1e7, 1e11);
  v.drop_speed = draw.of_any_size(1e-3, 1.);
  v.drop_height = draw.between(0., 2.) * v.drop_speed * s.dt;
  v.gravity = draw.chance(.7);
  send(draw, s, v.reach(), v.start, v.speed);
  return v;
}

namespace random_scene {

/// A number rounded to one digit.
inline double rounded(double x) {
  if (x == 0.) return 0.;
  const double unit = std::pow(10., std::floor(std::log10(std::abs(x))));
  return std::round(x / unit) * unit;
}

/// Whether all traffic stays on the rail, after a track was made shorter or a run longer.
inline bool fits(const RandomScene& s) {
  const auto on = [&](double start, double speed, double reach) {
    const double end = start + speed * s.duration();
    return std::min(start, end) >= reach && std::max(start, end) <= s.length() - reach;
  };
  if (s.vehicle && !on(s.vehicle->start, s.vehicle->speed, s.vehicle->reach())) return false;
  return std::all_of(s.loads.begin(), s.loads.end(),
                     [&](const RandomLoad& load) { return on(load.start, load.speed, 0.); });
}

/// Variants that are each simpler by one thing, the largest simplification first.
inline std::vector<RandomScene> simpler(const RandomScene& s) {
  std::vector<RandomScene> all;
  const auto with = [&](const auto& change) {
    RandomScene other = s;
    change(other);
    if (text_of(other) != text_of(s) && fits(other)) all.push_back(other);
  };
  for (const int part : {2, 4, 8})
    with([&](RandomScene& r) { r.steps = std::max(1, r.steps - r.steps / part); });
  with([](RandomScene& r) { r.bays = std::max(1, r.bays / 2); });
  with([](RandomScene& r) { r.bays = std::max(1, r.bays - 1); });
  with([](RandomScene& r) { r.elements = 1; });
  with([](RandomScene& r) { r.full = false; });
  with([](RandomScene& r) { r.sleepers = false; });
  with([](RandomScene& r) { r.pad_damper = 0.; });
  with([](RandomScene& r) { r.ballast_damper = 0.; });
  with([](RandomScene& r) { r.unilateral = false; });
  with([](RandomScene& r) { r.ends = {"free", "free"}; });
  if (s.vehicle) {
    with([](RandomScene& r) { r.vehicle->type = "mass", r.vehicle->wheelbase = 0.; });
    with([](RandomScene& r) { r.vehicle->speed = 0.; });
    with([](RandomScene& r) { r.vehicle->start = .3; });
    with([](RandomScene& r) { r.vehicle->damping = 0.; });
    with([](RandomScene& r) { r.vehicle->drop_height = 0.; });
    with([](RandomScene& r) { r.vehicle->gravity = false; });
    with([](RandomScene& r) { r.vehicle->mass = rounded(r.vehicle->mass); });
    with([](RandomScene& r) { r.vehicle->drop_speed = rounded(r.vehicle->drop_speed); });
  }
  if (s.loads.size() > 1) with([](RandomScene& r) { r.loads.pop_back(); });
  for (std::size_t i = 0; i < s.loads.size(); ++i) {
    with([&](RandomScene& r) { r.loads[i].speed = 0.; });
    with([&](RandomScene& r) { r.loads[i].table.clear(); });
    with([&](RandomScene& r) { r.loads[i].amplitude = 0.; });
    with([&](RandomScene& r) { r.loads[i].start = .3; });
  }
  with([](RandomScene& r) { r.pad = rounded(r.pad); });
  with([](RandomScene& r) { r.sleeper_mass = rounded(r.sleeper_mass); });
  with([](RandomScene& r) { r.ballast = rounded(r.ballast); });
  with([](RandomScene& r) { r.dt = rounded(r.dt); });
  return all;
}

}  // namespace random_scene

/// The smallest scene found that still fails: simpler variants are taken as long as they fail.
/// @param fails  whether the check fails; a scene that is refused does not
inline RandomScene shrunk(RandomScene s, const std::function<bool(const RandomScene&)>& fails) {
  const auto still = [&](const RandomScene& other) {
    try {
      return fails(other);
    } catch (const std::exception&) {
      return false;
    }
  };
  for (bool again = true; again;) {
    again = false;
    for (const RandomScene& other : random_scene::simpler(s))
      if (still(other)) {
        s = other;
        again = true;
        break;
      }
  }
  return s;
}

/// Fails a test case, writes the smallest failing scene found, and says where it is.
inline void report(const RandomScene& s, const std::string& what,
                   const std::function<bool(const RandomScene&)>& fails) {
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("railstep_failing_{}.toml", s.seed);
  std::ofstream(file) << text_of(shrunk(s, fails));
  FAIL_CHECK(what << "; seed " << s.seed << ", shrunk to " << file.string());
}

}  // namespace railstep
