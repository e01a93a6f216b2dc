#include "study/tune.h"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

namespace railstep {
namespace {

/// The refinement of the scene's reference, which those of the variations take too.
struct Fine {
  int elements_per_bay;
  double step;
};

class Search {
 public:
  Search(const TuneRequest& request, Choices choices, Study& study,
         const std::function<void(const std::string&)>& after)
      : request_(request), choices_(std::move(choices)), study_(study), after_(after) {}

  /// Looks at all models of a mesh, where both are good enough; of each scheme at the longest step
  /// that is.
  void look_at(int mesh) {
    found_.clear();
    after_(fmt::format("{} elements a bay", mesh));
    const double error = study_.mesh_error(mesh);
    least_mesh_ = std::min(least_mesh_, error);
    if (error > share()) return;
    for (const std::string& model : choices_.models) look_at(model, mesh);
    std::stable_sort(found_.begin(), found_.end(), [](const SettingRow& a, const SettingRow& b) {
      return a.cost.us < b.cost.us;
    });
  }

  /// Rows of the last mesh, the cheapest first.
  const std::vector<SettingRow>& found() const { return found_; }
  const std::optional<SettingRow>& best() const { return best_; }
  std::int64_t looked_at() const { return looked_at_; }

  /// Why nothing was found.
  std::string binds() const {
    if (least_mesh_ > share())
      return fmt::format(
          "the mesh: its error is {:.1e} at best, expected a third of {:g} or less; give finer "
          "meshes by --meshes",
          least_mesh_, request_.max_error);
    if (!best_ || !best_->failure.empty())
      return "the models: none runs on a mesh that is fine enough";
    const bool step = best_->parts.step > best_->parts.condensation;
    return fmt::format(
        "the {}: its part of the error is {:.1e} at best, expected a third of {:g} or "
        "less",
        step ? "step" : "condensation", step ? best_->parts.step : best_->parts.condensation,
        request_.max_error);
  }

 private:
  double share() const { return kShare * request_.max_error; }

  void look_at(const std::string& model, int mesh) {
    after_(fmt::format("{} elements a bay, {}", mesh, model));
    try {
      if (study_.condensation_error(model, mesh) > share()) return note_condensation(model, mesh);
    } catch (const std::exception&) {
      return;  // a model that this scene cannot have
    }
    for (const std::string& scheme : choices_.schemes)
      for (const double step : choices_.steps) {
        if (!goes_with(model, scheme)) break;
        ++looked_at_;
        SettingRow row = study_.row_of({model, mesh, scheme, step});
        note(row);
        if (!is_good(row)) continue;
        found_.push_back(std::move(row));
        break;  // shorter ones cost more
      }
  }

  bool is_good(const SettingRow& row) const {
    return row.failure.empty() && row.parts.step <= share() &&
           row.errors.judged <= request_.max_error;
  }

  /// The best so far: whose largest part is least.
  void note(const SettingRow& row) {
    const auto largest = [](const SettingRow& r) {
      return r.failure.empty() ? std::max({r.parts.step, r.parts.condensation, r.parts.mesh})
                               : std::numeric_limits<double>::infinity();
    };
    if (!best_ || largest(row) < largest(*best_)) best_ = row;
  }

  void note_condensation(const std::string& model, int mesh) {
    ++looked_at_;
    note(study_.row_of({model, mesh, "own", choices_.steps.back()}));
  }

  const TuneRequest& request_;
  Choices choices_;
  Study& study_;
  const std::function<void(const std::string&)>& after_;
  std::vector<SettingRow> found_;
  std::optional<SettingRow> best_;
  double least_mesh_ = std::numeric_limits<double>::infinity();
  std::int64_t looked_at_ = 0;
};

/// Runs of the scene on which a choice has to hold, each with a reference of its own.
class Verifier {
 public:
  Verifier(const Studied& studied, const Scene& scene, const Fine& fine)
      : fine_(fine), step_(*scene.step) {
    for (Variation& variation : variations_of(scene)) {
      Studied own = studied;
      own.overrides.insert(own.overrides.end(), variation.overrides.begin(),
                           variation.overrides.end());
      runs_.push_back({std::move(variation.what), std::move(own), std::nullopt});
    }
  }

  /// Errors of all variations, or up to the first that is above the error that is asked for.
  Candidate verify(SettingRow row, double max_error,
                   const std::function<void(const std::string&)>& after) {
    Candidate candidate{std::move(row), {}};
    candidate.verified.push_back({"on the scene", candidate.row.errors.judged});
    for (Run& run : runs_) {
      after(fmt::format("{}: {}", words_of(candidate.row.setting), run.what));
      if (!run.reference)
        run.reference = run_of(
            run.studied, {"full", fine_.elements_per_bay, plain_scheme("full", step_), fine_.step});
      const TraceTable trace = run_of(run.studied, candidate.row.setting);
      candidate.verified.push_back(
          {run.what, errors_of(trace, *run.reference, run.studied.judged).judged});
      if (candidate.verified.back().error > max_error) break;
    }
    return candidate;
  }

 private:
  struct Run {
    std::string what;
    Studied studied;
    std::optional<TraceTable> reference;
  };
  Fine fine_;
  StepScene step_;
  std::vector<Run> runs_;
};

/// Takes the cheapest that holds everywhere, or says what binds.
/// @returns whether there is no more to look for
bool choose(const TuneRequest& request, const std::vector<SettingRow>& found, Verifier& verifier,
            const std::function<void(const std::string&)>& after, TuneResult& result) {
  for (const SettingRow& row : found) {
    if (request.deadline_us && row.cost.us > *request.deadline_us) {
      result.best = row;
      result.binds = fmt::format("the deadline: {:.3g} us at least, expected {:g} us or less",
                                 row.cost.us, *request.deadline_us);
      return true;
    }
    Candidate candidate = verifier.verify(row, request.max_error, after);
    if (candidate.verified_error() <= request.max_error) {
      result.choice = std::move(candidate);
      return true;
    }
    result.best = candidate.row;
    result.binds = fmt::format("{}: its error is {:.1e}, expected {:g} or less",
                               candidate.verified.back().what, candidate.verified.back().error,
                               request.max_error);
  }
  return false;
}

/// Finer ones than pareto shows, as each costs time only where those before did not do.
Choices choices_of(const TuneRequest& request, const Scene& scene) {
  Choices choices = filled(request.choices, scene);
  if (request.choices.meshes.empty()) choices.meshes.push_back(2 * choices.meshes.back());
  std::sort(choices.meshes.begin(), choices.meshes.end());
  return choices;
}

}  // namespace

double Candidate::verified_error() const {
  double most = 0.;
  for (const Verification& own : verified) most = std::max(most, own.error);
  return most;
}

TuneResult tune(const TuneRequest& request, const std::function<void(const std::string&)>& after) {
  const Studied studied = study_of(request.scene, request.overrides, request.judged);
  const Scene scene = read_scene(request.scene, request.overrides);
  const Choices choices = choices_of(request, scene);
  // unknown names are refused here; settings that this scene cannot have are left out later
  for (const Setting& each : settings_of(choices)) static_cast<void>(overrides_of(each));
  constexpr int kLevels = 4;
  Fine fine{*std::max_element(choices.meshes.begin(), choices.meshes.end()), choices.steps.back()};
  after("reference");
  int levels = 0;
  Reference reference = refine(studied,
                               {.elements_per_bay = fine.elements_per_bay,
                                .step = fine.step,
                                .target = .1 * request.max_error,
                                .most_levels = kLevels},
                               [&](int level) {
                                 levels = level;
                                 after(fmt::format("reference, level {}", level));
                               });
  fine = {fine.elements_per_bay << (levels - 1), fine.step / (1 << (levels - 1))};
  TuneResult result;
  result.reference = reference;
  result.frame = studied.frame;
  if (reference.error > .5 * request.max_error) {
    result.binds = fmt::format(
        "the reference: after {} levels its own error is {:.1e}, expected half of {:g} "
        "or less",
        levels, reference.error, request.max_error);
    return result;
  }
  Study study(studied, std::move(reference), choices.steps.back() / 4.);
  Search search(request, choices, study, after);
  Verifier verifier(studied, scene, fine);
  // Condensed models cost the same on a finer mesh, full order more: the first that serves, does.
  for (const int mesh : choices.meshes) {
    search.look_at(mesh);
    result.looked_at = search.looked_at();
    if (search.found().empty()) {
      result.best = search.best();
      result.binds = search.binds();
      continue;
    }
    if (choose(request, search.found(), verifier, after, result)) break;
  }
  return result;
}

}  // namespace railstep
