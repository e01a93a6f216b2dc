#include "study/pareto.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "offline/pack/accuracy.h"
#include "study/resume.h"
#include "sweep/sweep_key.h"

namespace railstep {
namespace {

/// Reads every scene, so that what is wrong with a list is known before anything is run.
void check(const Studied& study, const std::vector<Setting>& settings) {
  if (settings.empty())
    throw InputError(
        "E-STUDY-05",
        "none of the models goes with any of the schemes; expected held:RHO_INF or "
        "discrete-gradient with condensed models, and the other schemes with full order");
  for (const Setting& setting : settings) try {
      static_cast<void>(scene_with(study, setting));
    } catch (const InputError& error) {
      throw error.met(words_of(setting));
    }
}

/// The key of a study: studies with the same key have the same numbers.
std::string key_of(const ParetoRequest& request, const Choices& choices, const Studied& study) {
  std::string question = fmt::format("{} from {:a}", program_identity(), study.judged.from);
  for (const std::string& output : study.judged.outputs) question += " " + output;
  question += fmt::format(
      " reference {:a} {} {} {:a} mesh {} step {:a}", request.reference_error,
      request.reference_levels, request.reference.string(), request.reference_own_error,
      *std::max_element(choices.meshes.begin(), choices.meshes.end()), choices.steps.back());
  return RunKeys(question, 0.).of(request.scene, request.overrides);
}

Reference reference_of(const ParetoRequest& request, const Studied& study, const Choices& choices,
                       const std::function<void(int)>& after) {
  if (!request.reference.empty())
    return named_reference(request.reference, request.reference_own_error);
  return refine(
      study,
      {.elements_per_bay = *std::max_element(choices.meshes.begin(), choices.meshes.end()),
       .step = choices.steps.back(),
       .target = request.reference_error,
       .most_levels = request.reference_levels},
      after);
}

/// The steps of every model and mesh on the front.
void add_receptances(const Studied& study, const Scene& scene, ParetoResult& result) {
  result.hz = receptance_frequencies(scene.condense.band_hz);
  std::set<std::pair<std::string, int>> known;
  for (const SettingRow& row : result.rows) {
    if (!row.on_front || !known.insert({row.setting.model, row.setting.elements_per_bay}).second)
      continue;
    const Built built(scene_with(study, row.setting));
    result.receptances.push_back({row.setting.model, row.setting.elements_per_bay,
                                  receptance_errors(built.track, *built.packed, result.hz)});
  }
}

}  // namespace

ParetoResult pareto(const ParetoRequest& request,
                    const std::function<void(std::int64_t, std::int64_t)>& after) {
  const Studied studied = study_of(request.scene, request.overrides, request.judged);
  const Scene scene = read_scene(request.scene, request.overrides);
  const Choices choices = filled(request.choices, scene);
  const std::vector<Setting> settings = settings_of(choices);
  check(studied, settings);
  ResumeFile kept(request.resume, key_of(request, choices, studied));
  const auto all = static_cast<std::int64_t>(settings.size()) + request.reference_levels;
  std::int64_t done = 0;
  after(done, all);
  Reference reference = kept.reference() ? *kept.reference()
                                         : reference_of(request, studied, choices,
                                                        [&](int level) { after(level, all); });
  if (!kept.reference()) kept.keep(reference);
  after(done = request.reference_levels, all);
  Study study(studied, std::move(reference), choices.steps.back() / 4.);
  ParetoResult result{study.reference(), studied.judged, studied.frame, {}, {}, {}};
  for (const Setting& setting : settings) {
    if (const SettingRow* const known = kept.find(setting)) {
      result.rows.push_back(*known);
    } else {
      result.rows.push_back(study.row_of(setting));
      kept.keep(result.rows.back());
    }
    after(++done, all);
  }
  mark_front(result.rows, floor_of(result.reference));
  add_receptances(studied, scene, result);
  return result;
}

}  // namespace railstep
