#include "study/study.h"

#include <fmt/core.h>

#include <exception>
#include <limits>
#include <new>
#include <utility>

#include "run/model_size.h"

namespace railstep {

Study::Study(Studied studied, Reference reference, double small_step)
    : studied_(std::move(studied)),
      reference_(std::move(reference)),
      small_step_(small_step),
      step_(*read_scene(studied_.file, studied_.overrides).step) {}

const TraceTable& Study::by_small_steps(const std::string& model, int elements_per_bay,
                                        const std::vector<std::string>& changes) {
  const Setting setting{model, elements_per_bay, plain_scheme(model, step_), small_step_, changes};
  const auto known = small_.find(words_of(setting));
  if (known != small_.end()) return known->second;
  return small_.emplace(words_of(setting), run_of(studied_, setting)).first->second;
}

double Study::change_error(const Setting& own) {
  if (own.changes.empty()) return 0.;
  return errors_of(by_small_steps(own.model, own.elements_per_bay, own.changes),
                   by_small_steps(own.model, own.elements_per_bay), studied_.judged)
      .judged;
}

double Study::mesh_error(int elements_per_bay) {
  return errors_of(by_small_steps("full", elements_per_bay), reference_.trace, studied_.judged)
      .judged;
}

double Study::condensation_error(const std::string& model, int elements_per_bay) {
  if (!is_condensed(model)) return 0.;
  return errors_of(by_small_steps(model, elements_per_bay),
                   by_small_steps("full", elements_per_bay), studied_.judged)
      .judged;
}

SettingRow Study::row_of(const Setting& setting) try {
  if (!timing_)
    timing_ = std::make_unique<Timing>(
        std::make_unique<Simulation>(read_scene(studied_.file, studied_.overrides)));
  SettingRow row;
  row.setting = setting;
  Simulation run(scene_with(studied_, setting));
  const Model& model = run.model();
  const RunRecord record = simulate(run, model.steps / model.steps_per_frame, {}, true);
  row.status = status_names(record.status);
  row.kept_unknowns = unknowns_of(run.track(), *run.packed()).second;
  const TraceTable trace = compared(run.columns(), record);
  row.errors = errors_of(trace, reference_.trace, studied_.judged);
  if (record.first_bad_unknown >= 0)
    row.failure = nonfinite_sentence(run, record.first_bad_unknown);
  if (!row.failure.empty()) return row;
  row.parts = {
      errors_of(trace, by_small_steps(setting.model, setting.elements_per_bay, setting.changes),
                studied_.judged)
          .judged,
      change_error(setting), condensation_error(setting.model, setting.elements_per_bay),
      mesh_error(setting.elements_per_bay)};
  row.cost = timing_->cost_of(run);
  return row;
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::exception& error) {
  SettingRow row;
  row.setting = setting;
  row.errors.judged = std::numeric_limits<double>::infinity();
  row.failure = error.what();
  return row;
}

}  // namespace railstep
