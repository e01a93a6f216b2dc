#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "build/build.h"
#include "build/build_system.h"
#include "online/model/state.h"
#include "scene/scene.h"

namespace railstep {

/// A model in its block, the state at its start, and scratch: ready to step.
class Simulation {
 public:
  /// Builds a scene, condensed where it says so. Throws InputError.
  explicit Simulation(const Scene& scene);
  /// Builds a scene of bodies and beams. Throws InputError.
  explicit Simulation(const SystemScene& scene);
  /// Loads a block that `railstep condense` wrote. Throws InputError.
  explicit Simulation(const std::filesystem::path& artefact);
  /// Loads such a block; `name` is its name in errors. Throws InputError.
  Simulation(std::vector<std::byte> block, const std::string& name);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  const Model& model() const { return model_; }
  const std::vector<std::byte>& block() const { return block_; }
  /// The packed model with all matrices, from which the block was made; null for a model file,
  /// which carries none.
  const PackedModel* packed() const { return built_ ? built_->packed.get() : nullptr; }
  /// The built scene of a track alone: where packed() is not null.
  const Track& track() const { return built_->track; }
  /// The system that is stepped, with its names; null where it is a track, and for a model file.
  const BuiltSystem* system() const { return system_.get(); }
  /// Columns of a trace: time_s, then those of every load, wheel, sensor and support.
  const std::vector<std::string>& columns() const { return columns_; }
  /// Names of the model's inputs, in its order: NAME.force_n or NAME.moment_n_m.
  const std::vector<std::string>& inputs() const { return inputs_; }

  State state;
  Workspace workspace;

 private:
  void load(const std::string& name);
  void place();

  std::unique_ptr<Built> built_;
  std::unique_ptr<BuiltSystem> system_;
  std::vector<std::byte> block_;
  Model model_{};
  std::vector<std::string> columns_, inputs_;
  std::vector<double> memory_, scratch_;
};

/// Builds either kind of scene. Throws InputError.
std::unique_ptr<Simulation> simulation_of(const AnyScene& scene);

/// All of a file. Throws InputError.
std::vector<std::byte> read_bytes(const std::filesystem::path& file);

/// Whether a file begins as a block does.
bool is_artefact(const std::filesystem::path& file);

}  // namespace railstep
