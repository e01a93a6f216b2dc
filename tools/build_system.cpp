#include "build_system.h"

#include <fmt/core.h>

#include <stdexcept>

#include "build.h"
#include "offline/pack/scheme.h"
#include "sense.h"

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

Scheme scheme_of(const StepScene& step) {
  switch (step.scheme) {
    case TimeScheme::backward_euler:
      return backward_euler(step.dt);
    case TimeScheme::energy_momentum:
      return energy_momentum(step.dt);
    case TimeScheme::generalised_alpha:
      break;
  }
  return generalised_alpha(step.dt, step.rho_inf);
}

SystemOptions options_of(const SystemScene& scene) {
  SystemOptions options = scene.options;
  options.scheme = scheme_of(scene.step);
  options.energy_momentum = scene.step.scheme == TimeScheme::energy_momentum;
  options.steps_per_frame = static_cast<int>(scene.step.steps_per_frame);
  options.steps = scene.step.steps;
  return options;
}

}  // namespace

System system_of(const SystemScene& scene) {
  System system = scene.system;
  for (std::size_t i = 0; i < system.beams.size(); ++i)
    add_section(scene.bars[i], fmt::format("{}: [beam[{}]]", scene.file.string(), i),
                system.beams[i]);
  return system;
}

BuiltSystem::BuiltSystem(const SystemScene& scene) try
    : names(scene.names), system(system_of(scene)) {
  columns = {"time_s"};
  for (const std::string& sensor : names.sensors)
    for (const char* quantity : kSensorQuantities)
      columns.push_back(fmt::format("{}.{}", sensor, quantity));
  packed = std::make_unique<PackedSystem>(system, options_of(scene));
} catch (const std::invalid_argument& error) {
  throw InputError(fmt::format("{}: {}", scene.file.string(), error.what()));
}

}  // namespace railstep
