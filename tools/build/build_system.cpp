#include "build/build_system.h"

#include <fmt/core.h>

#include "build/about.h"
#include "build/build.h"
#include "build/cache_sizes.h"
#include "build/step_scheme.h"
#include "offline/math/refuse.h"
#include "offline/pack/artefact.h"

namespace railstep {
namespace {

void add_section(const BeamBar& made_of, const std::string& place, FlexibleBeam& beam) {
  const BarScene& bar = made_of.bar;
  const RailSection found = bar_section(bar, true, place);
  beam.section = beam_section(found);
  beam.material = {bar.young, bar.poisson, bar.density};
  beam.rule = bar.rule;
  beam.axis_z = axis_z_of(made_of.line, found.section);
  beam.half_height = .5 * found.section.height;
}

SystemOptions options_of(const SystemScene& scene) {
  SystemOptions options = scene.options;
  options.scheme = scheme_of(scene.step);
  options.energy_momentum = scene.step.scheme == TimeScheme::energy_momentum ||
                            (scene.track && scene.track->condense.kind);
  options.steps_per_frame = static_cast<int>(scene.step.steps_per_frame);
  options.steps = scene.step.steps;
  options.at_rest = scene.step.start == Start::equilibrium;
  options.traced = scene.traced;
  return options;
}

}  // namespace

System system_of(const SystemScene& scene) {
  System system = scene.system;
  for (std::size_t i = 0; i < system.beams.size(); ++i)
    add_section(scene.bars[i], fmt::format("{}: [beam[{}]]", scene.file.string(), i),
                system.beams[i]);
  for (const InputScene& input : scene.inputs) system.input_limits.push_back(input.limit);
  return system;
}

namespace {

std::unique_ptr<PackedSystem> packed_of(const SystemScene& scene, const System& system,
                                        TraceNames& names) {
  if (!scene.track) return std::make_unique<PackedSystem>(system, options_of(scene));
  const Track track = track_of(*scene.track);
  const TracedTraffic traced = traffic_of(*scene.track, track);
  names = traced.names;
  return std::make_unique<PackedSystem>(system, options_of(scene), track, traced.traffic,
                                        pack_options_of(*scene.track));
}

}  // namespace

BuiltSystem::BuiltSystem(const SystemScene& scene) try
    : names(scene.names), system((fix_cache_sizes(), system_of(scene))) {
  about = railstep::about(scene);
  if (scene.track) inputs = input_names(*scene.track);
  for (const InputScene& input : scene.inputs) inputs.push_back(input.name);
  TraceNames traced;
  packed = packed_of(scene, system, traced);
  traced.sensors = names.sensors;
  for (const int joint : scene.traced.joints)
    traced.joints.push_back(names.joints[static_cast<std::size_t>(joint)]);
  for (const int spring : scene.traced.springs)
    traced.springs.push_back(names.springs[static_cast<std::size_t>(spring)]);
  columns = columns_of(packed->model(), traced);
} catch (const Refused& error) {
  throw InputError(scene.file.string(), error);
}

std::vector<std::byte> block_of(const BuiltSystem& built, BlockNotes notes) {
  notes.about = built.about;
  return to_block(built.packed->model(), block_text(built.columns, built.inputs), notes);
}

}  // namespace railstep
