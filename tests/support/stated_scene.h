#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/random_scene.h"

namespace railstep {

/// A random scene for which errors are stated: a damped linear track under loads or wheels that run
/// or stand. One rail or two, vertical or all unknowns, on seats, with or without sleepers, with
/// ends or on a ring, in full order or condensed in any way.
inline std::string stated_scene(std::uint64_t seed) {
  Draw draw(seed);
  const bool ring = draw.chance(.2), full = !ring && draw.chance(.25);
  const int rails = full && draw.chance(.3) ? 2 : 1, elements = draw.whole(1, full ? 2 : 4);
  const double bay = draw.between(.5, .75);
  const int bays = ring ? draw.whole(16, 22) : draw.whole(4, full ? 6 : 12);
  const bool sleepers = draw.chance(.6);
  const double pad = draw.of_any_size(3e7, 1e9), damper = draw.of_any_size(5e3, 5e5);
  const std::array<std::string, 3> ends = {"free", "pinned", "clamped"};
  std::string text = fmt::format(
      "# Seed {}.\nschema = 1\n[track]\nunknowns = \"{}\"\nrails = {}\nbays = {}\nbay_m = {:.17g}\n"
      "elements_per_bay = {}\n",
      seed, full ? "full" : "vertical", rails, bays, bay, elements);
  text += ring ? std::string("length = \"endless\"\n")
               : fmt::format("ends = [\"{}\", \"{}\"]\n", draw.one_of(ends), draw.one_of(ends));
  text += fmt::format("[rail.rectangle]\nheight_m = {:.17g}\nwidth_m = {:.17g}\n",
                      draw.between(.13, .23), draw.between(.03, .06));
  text += fmt::format(
      "[support]\nat = \"{}\"\nstiffness_z_n_per_m = {:.17g}\ndamping_z_n_s_per_m = {:.17g}\n",
      full ? "foot" : "axis", pad, damper);
  if (full)
    text += fmt::format(
        "stiffness_x_n_per_m = {0:.17g}\nstiffness_y_n_per_m = {0:.17g}\n"
        "damping_x_n_s_per_m = {1:.17g}\ndamping_y_n_s_per_m = {1:.17g}\n"
        "stiffness_roll_n_m_per_rad = 1e6\n",
        .3 * pad, damper);
  if (sleepers)
    text += fmt::format(
        "[sleeper]\nmass_kg = {:.17g}\n{}[ballast]\nstiffness_z_n_per_m = {:.17g}\n"
        "damping_z_n_s_per_m = {:.17g}\n",
        draw.between(100., 350.), rails == 2 ? "roll_inertia_kg_m2 = 100.0\n" : "",
        draw.of_any_size(3e7, 2e8), draw.of_any_size(2e4, 2e5));
  const double start = ring ? .3 * bay : draw.between(.3, .6) * bays * bay;
  const double speed = draw.chance(.3) ? 0. : std::min(draw.between(5., 40.), 9. * bays * bay);
  if (draw.chance(.5))
    text += fmt::format(
        "[[load]]\nname = \"load\"\nrail = \"left\"\nstart_m = {:.17g}\nspeed_m_per_s = {:.17g}\n"
        "force_z_n = -5e4\n",
        start, speed);
  else
    text += fmt::format(
        "[[vehicle]]\nname = \"wheel\"\nrail = \"left\"\ntype = \"sprung_mass\"\nstart_m = "
        "{:.17g}\n"
        "speed_m_per_s = {:.17g}\nmass_kg = 4000.0\nunsprung_mass_kg = 700.0\n"
        "stiffness_n_per_m = 1e6\ndamping_n_s_per_m = 2e4\ncontact = \"hertz\"\n",
        start, speed);
  text += "[step]\ndt_s = 1e-4\nframe_s = 1e-3\nduration_s = 0.04\nstart = \"equilibrium\"\n";
  const std::array<std::string, 6> kinds = {"modal",         "guyan",  "irs",
                                            "craig-bampton", "krylov", "complex-modes"};
  const std::string kind = ring || draw.chance(.3) ? "modal" : draw.one_of(kinds);
  if (ring || !draw.chance(.25))
    text += fmt::format("[condense]\nkind = \"{}\"\nmodes_per_bay = {}\n", kind, draw.whole(1, 4));
  return text;
}

/// A file of the scene that exists as long as this object.
class StatedScene {
 public:
  explicit StatedScene(std::uint64_t seed)
      : file_(std::filesystem::temp_directory_path() /
              fmt::format("railstep_stated_{}_{}.toml", getpid(), seed)) {
    std::ofstream(file_) << stated_scene(seed);
  }
  ~StatedScene() { std::filesystem::remove(file_); }
  StatedScene(const StatedScene&) = delete;
  StatedScene& operator=(const StatedScene&) = delete;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
};

}  // namespace railstep
