#include <fmt/core.h>

#include <string>
#include <utility>
#include <vector>

#include "study/tune.h"

namespace railstep {
namespace {

constexpr double kSlower = .9;  // not faster: what runs must not come to the rail's end
constexpr double kHeavier = 1.25;
constexpr double kPhase = .37;  // of a scene's step

/// Overrides of one number of every entry of an array of tables.
class Changes {
 public:
  void add(const char* table, std::size_t index, const char* key, double value) {
    text_.push_back(fmt::format("{}[{}].{}={:.17g}", table, index, key, value));
  }
  std::vector<std::string> take() { return std::move(text_); }

 private:
  std::vector<std::string> text_;
};

/// Index of the [[vehicle]] that a vehicle is of: one table may stand for both rails.
std::size_t table_of(const Scene& scene, std::size_t vehicle) {
  std::size_t index = 0;
  for (std::size_t i = 1; i <= vehicle; ++i)
    if (scene.vehicles[i].table != scene.vehicles[i - 1].table) ++index;
  return index;
}

std::vector<std::string> slower(const Scene& scene) {
  Changes changes;
  for (std::size_t i = 0; i < scene.loads.size(); ++i)
    if (scene.loads[i].speeds.empty() && scene.loads[i].speed != 0.)
      changes.add("load", i, "speed_m_per_s", kSlower * scene.loads[i].speed);
  for (std::size_t i = 0; i < scene.wheelsets.size(); ++i)
    if (scene.wheelsets[i].speeds.empty() && scene.wheelsets[i].speed != 0.)
      changes.add("wheelset", i, "speed_m_per_s", kSlower * scene.wheelsets[i].speed);
  for (std::size_t i = 0; i < scene.vehicles.size(); ++i)
    if (scene.vehicles[i].speeds.empty() && scene.vehicles[i].speed != 0.)
      changes.add("vehicle", table_of(scene, i), "speed_m_per_s",
                  kSlower * scene.vehicles[i].speed);
  return changes.take();
}

std::vector<std::string> heavier(const Scene& scene) {
  Changes changes;
  for (std::size_t i = 0; i < scene.loads.size(); ++i)
    changes.add("load", i, "force_z_n", kHeavier * scene.loads[i].force);
  for (std::size_t i = 0; i < scene.wheelsets.size(); ++i)
    changes.add("wheelset", i, "carried_mass_kg",
                scene.wheelsets[i].carried_mass +
                    (kHeavier - 1.) * (scene.wheelsets[i].mass + scene.wheelsets[i].carried_mass));
  return changes.take();
}

/// All at another place of the step, and of the elements, by what is run in it.
std::vector<std::string> shifted(const Scene& scene) {
  Changes changes;
  const double time = kPhase * scene.step->dt;
  for (std::size_t i = 0; i < scene.loads.size(); ++i)
    changes.add("load", i, "start_m", scene.loads[i].start + time * scene.loads[i].speed);
  for (std::size_t i = 0; i < scene.wheelsets.size(); ++i)
    changes.add("wheelset", i, "start_m",
                scene.wheelsets[i].start + time * scene.wheelsets[i].speed);
  for (std::size_t i = 0; i < scene.vehicles.size(); ++i)
    changes.add("vehicle", table_of(scene, i), "start_m",
                scene.vehicles[i].start + time * scene.vehicles[i].speed);
  return changes.take();
}

}  // namespace

std::vector<Variation> variations_of(const Scene& scene) {
  std::vector<Variation> all;
  if (std::vector<std::string> changes = slower(scene); !changes.empty())
    all.push_back({"at nine tenths of the speed", std::move(changes)});
  if (std::vector<std::string> changes = heavier(scene); !changes.empty())
    all.push_back({"with a quarter more load", std::move(changes)});
  if (std::vector<std::string> changes = shifted(scene); !changes.empty())
    all.push_back({"from 0.37 of a step on", std::move(changes)});
  return all;
}

}  // namespace railstep
