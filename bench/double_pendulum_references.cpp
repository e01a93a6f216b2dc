// Every reference of the double pendulum (docs/double-pendulum.md): paths as CSV into a folder, and
// on stdout their distances from the finest mesh, energy and time.
// Usage: double_pendulum_references FOLDER [ELEMENTS OF THE FINEST MESH, at least 8]
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "support/pendulum_ancf.h"
#include "support/pendulum_frame.h"
#include "support/pendulum_ida.h"
#include "support/pendulum_rigid.h"

namespace railstep {
namespace {

constexpr double kUntil = 1.;  // s

class References {
 public:
  explicit References(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
    std::printf("%-24s %11s %11s %11s %11s %10s %8s\n", "", "B to .4 s", "C to .4 s", "B to 1 s",
                "C to 1 s", "energy, J", "time, s");
  }

  /// Runs and writes a reference, and compares it with the first one.
  void add(const std::string& name, const std::function<PendulumRun()>& run) {
    const std::clock_t begin = std::clock();
    const PendulumRun found = run();
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    write(name, found.path);
    if (finest_.at.empty()) finest_ = found.path;
    const Eigen::Vector2d early = apart(found.path, finest_, .4);
    const Eigen::Vector2d late = apart(found.path, finest_, kUntil);
    std::printf("%-24s %11.3e %11.3e %11.3e %11.3e %10.1e %8.2f\n", name.c_str(), early[0],
                early[1], late[0], late[1], found.energy_change, seconds);
    std::fflush(stdout);
  }

 private:
  void write(const std::string& name, const PendulumPath& path) const {
    const std::string file = (folder_ / (name + ".csv")).string();
    std::FILE* out = std::fopen(file.c_str(), "w");
    if (out == nullptr) throw std::runtime_error("cannot write " + file);
    std::fprintf(out, "%s\n", kPathColumns);
    for (std::size_t i = 0; i < path.at.size(); ++i) {
      std::fprintf(out, "%.3f", static_cast<double>(i) * path.step);
      for (const double x : path.at[i]) std::fprintf(out, ",%.12g", x);
      std::fprintf(out, "\n");
    }
    if (std::fclose(out) != 0) throw std::runtime_error("cannot write " + file);
  }

  std::filesystem::path folder_;
  PendulumPath finest_;
};

/// If a link bends far, its tangent frame has frequencies above those at rest.
PendulumRun modal(const DoublePendulum& scene, const LinkModes& kept) {
  const FramePendulum model(scene, kept);
  return swing(model, kUntil, (kept.tangent ? 8 : 1) * steps_for(model.highest_frequency()));
}

void add_ancf(References& all, const DoublePendulum& scene, int finest) {
  const auto ancf = [&](int elements, double part) {
    const AncfPendulum model(scene, elements);
    return swing(model, kUntil,
                 static_cast<int>(std::ceil(steps_for(model.highest_frequency()) * part)));
  };
  for (int elements = finest; elements >= 2; elements /= 2)
    all.add("ancf_" + std::to_string(elements), [&] { return ancf(elements, 1.); });
  all.add("ancf_8_steps_x1.5", [&] { return ancf(8, 1.5); });
}

void add_ida(References& all, const DoublePendulum& scene) {
  const auto ida = [&](int elements, double tolerance) {
    const AncfPendulum model(scene, elements);
    return IdaPendulum(model, tolerance).run(kUntil);
  };
  all.add("ida_4_1e-4", [&] { return ida(4, 1e-4); });
  all.add("ida_4_1e-6", [&] { return ida(4, 1e-6); });
  for (const int elements : {4, 8, 16})
    all.add("ida_" + std::to_string(elements), [&] { return ida(elements, 1e-9); });
}

void add_frames(References& all, const DoublePendulum& scene) {
  const auto frame = [&](const std::string& name, const LinkModes& kept) {
    all.add(name + "_" + std::to_string(kept.bending) + "+" + std::to_string(kept.axial),
            [&] { return modal(scene, kept); });
  };
  for (const auto& [bending, axial] : {std::pair{1, 1}, {3, 1}, {6, 2}, {10, 4}}) {
    frame("mean_axes", {bending, axial, false, false});
    frame("mean_axes_stiffened", {bending, axial, true, false});
    frame("tangent", {bending, axial, false, true});
  }
}

}  // namespace
}  // namespace railstep

int main(int count, char** words) {
  using namespace railstep;
  const int finest = count > 2 ? std::atoi(words[2]) : 32;
  if (count < 2 || finest < 8) {
    std::fprintf(stderr, "usage: double_pendulum_references FOLDER [ELEMENTS, at least 8]\n");
    return 2;
  }
  try {
    const DoublePendulum scene;
    References all(words[1]);
    add_ancf(all, scene, finest);
    add_ida(all, scene);
    all.add("rigid", [&] { return swing(RigidPendulum(scene), kUntil, 1); });
    add_frames(all, scene);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
