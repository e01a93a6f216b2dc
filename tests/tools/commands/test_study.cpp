// Speed against error: settings, errors of traces, references by refinement, fronts.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "study/reference.h"
#include "study/resume.h"
#include "study/study.h"
#include "study/study_row.h"
#include "study/tune.h"
#include "support/program.h"
#include "support/shipped.h"
#include "text/read.h"

using namespace railstep;
using Catch::Contains;
using Catch::Matchers::WithinRel;

namespace {

TraceTable table(std::vector<std::string> columns, std::vector<double> values) {
  return {std::move(columns), std::move(values)};
}

SettingRow row(double us, double error) {
  SettingRow made;
  made.cost.us = us;
  made.errors.judged = error;
  made.parts = {.3 * error, .3 * error, .3 * error};
  return made;
}

}  // namespace

TEST_CASE("every default setting makes a scene with that setting", "[study]") {
  for (const char* name : {"moving_load.toml", "ballasted_track.toml", "endless_track.toml",
                           "hanging_sleeper.toml", "bogie_at_speed.toml"}) {
    const Scene own = read_scene(kScenes + name);
    const Studied study = study_of(kScenes + name, {}, {});
    const std::vector<Setting> all = settings_of(default_choices(own));
    CHECK(all.size() >= 20);
    for (const Setting& setting : all) {
      CAPTURE(name, words_of(setting));
      const Scene made = scene_with(study, setting);
      CHECK(made.track.elements_per_bay == setting.elements_per_bay);
      CHECK_THAT(made.step->dt, WithinRel(setting.step, 1e-12));
      CHECK(made.condense.kind.has_value() == is_condensed(setting.model));
      CHECK_THAT(made.step->dt * static_cast<double>(made.step->steps_per_frame),
                 WithinRel(study.frame, 1e-12));
      CHECK(made.step->mean_contact == (setting.scheme == "discrete-gradient"));
    }
  }
}

TEST_CASE("what is varied is a setting's own, and no choice that has a list", "[study]") {
  Choices choices{{"modal:1"}, {2}, {"held:0.6"}, {1e-4}};
  choices.varied = {"track.bays=12,16", "support.damping_z_n_s_per_m=5e4"};
  const std::vector<Setting> all = settings_of(choices);
  REQUIRE(all.size() == 2);
  CHECK(all[1].changes ==
        std::vector<std::string>{"track.bays=16", "support.damping_z_n_s_per_m=5e4"});
  CHECK(overrides_of(all[1]).back() == "support.damping_z_n_s_per_m=5e4");
  CHECK(words_of(all[0]) != words_of(all[1]));
  for (const char* own : {"step.dt_s=1e-4,2e-4", "condense.modes_per_bay=1,2",
                          "track.elements_per_bay=2", "step={}", "condense={kind=\"modal\"}"}) {
    choices.varied = {own};
    CHECK_THROWS_WITH(settings_of(choices), Contains("E-STUDY-16") && Contains(own));
  }
  choices.varied = {"track.bays=12", "track.bays=16"};
  CHECK_THROWS_WITH(settings_of(choices), Contains("E-SWEEP-10"));
}

TEST_CASE("forces of vehicles in space are told apart by their directions", "[study]") {
  const std::vector<std::string> names = {"time_s", "car.w.q_n", "car.w.y_n", "car.set.sum_y_n"};
  const TraceTable reference = table(names, {0., 100., 10., 4.});
  const TraceErrors errors =
      errors_of(table(names, {0., 101., 9.5, 3.}), reference, {0., {"lateral_force"}});
  REQUIRE(errors.kinds.size() == 3);
  CHECK(errors.kinds[0].kind == OutputKind::contact_force);
  CHECK(errors.kinds[0].largest == Approx(.01));
  CHECK(errors.kinds[1].kind == OutputKind::lateral_force);
  CHECK(errors.kinds[1].largest == Approx(.05));
  CHECK(errors.kinds[2].kind == OutputKind::sum_of_lateral_forces);
  CHECK(errors.kinds[2].largest == Approx(.25));
  CHECK(errors.judged == Approx(.05));
}

TEST_CASE("words of models and schemes are read to their last letter", "[study]") {
  const auto overrides = [](const std::string& model, const std::string& scheme) {
    return overrides_of({model, 2, scheme, 1e-4});
  };
  CHECK(overrides("craig-bampton:4:bare", "held:0.6") ==
        std::vector<std::string>{"condense.kind=\"craig-bampton\"", "condense.modes_per_bay=4",
                                 "condense.residual_flexibility=false", "track.elements_per_bay=2",
                                 "step.contact=\"penetration\"", "step.rho_inf=0.6",
                                 "step.dt_s=0.0001"});
  CHECK(overrides("irs:1", "discrete-gradient")[1] == "condense.nodes_per_bay=1");
  for (const char* model : {"", "modes", "full:2", "modal:", "modal:x", "modal:1:lateral"})
    CHECK_THROWS_WITH(overrides(model, "newmark"), Contains("E-STUDY-12"));
  for (const char* scheme : {"", "held", "newmark:1", "hht", "rk4", "held:a"})
    CHECK_THROWS_WITH(overrides("full", scheme), Contains("E-STUDY-13"));
}

TEST_CASE("errors are relative to each column's peak, from a chosen time on", "[study]") {
  const std::vector<std::string> names = {"time_s", "a.deflection_z_m", "b.deflection_z_m",
                                          "w.force_z_mean_n"};
  // Peaks are 4, 10 and 100; the row at t = 0 is left out.
  const TraceTable reference = table(names, {0., 9., 9., 9., 1., 4., -10., 100., 2., 1., 1., 50.});
  const TraceTable got = table(names, {0., 0., 0., 0., 1., 4., -9., 100., 2., .6, 1., 40.});
  const TraceErrors errors = errors_of(got, reference, {.from = 1., .outputs = {}});
  REQUIRE(errors.kinds.size() == 2);
  CHECK_THAT(errors.judged, WithinRel(.1, 1e-12));  // a: 0.4 / 4 = 0.1, b: 1 / 10 = 0.1
  CHECK_THAT(errors.kinds[0].largest, WithinRel(.1, 1e-12));
  CHECK_THAT(errors.kinds[0].rms, WithinRel(.1 / std::sqrt(2.), 1e-12));
  CHECK_THAT(errors.kinds[1].largest, WithinRel(.1, 1e-12));  // 10 / 100
  CHECK_THAT(errors_of(got, reference, {.from = 0., .outputs = {"a.deflection_z_m"}}).judged,
             WithinRel(1., 1e-12));
  CHECK_THAT(errors_of(got, reference, {.from = 2., .outputs = {"contact_force"}}).judged,
             WithinRel(.2, 1e-12));
  CHECK_THROWS_WITH(errors_of(got, reference, {.from = 0., .outputs = {"sensor"}}),
                    Contains("\"sensor\"") && Contains("E-STUDY-02"));
  CHECK_THROWS_WITH(errors_of(got, reference, {.from = 3., .outputs = {}}),
                    Contains("3 s") && Contains("E-STUDY-03"));
}

TEST_CASE("a trace that ended early or is not finite has an infinite error", "[study]") {
  const std::vector<std::string> names = {"time_s", "a.deflection_z_m"};
  const TraceTable reference = table(names, {0., 1., 1., 2.});
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(errors_of(table(names, {0., 1.}), reference, {}).judged == infinite);
  CHECK(errors_of(table(names, {0., 1., 1., std::nan("")}), reference, {}).judged == infinite);
  CHECK_THROWS_WITH(errors_of(reference, table({"time_s", "b.deflection_z_m"}, {0., 1.}), {}),
                    Contains("a.deflection_z_m") && Contains("E-STUDY-01"));
}

TEST_CASE("a reference's own error estimates its distance from a finer one", "[study]") {
  const Studied study = study_of(kMovingLoad, {}, {});
  CHECK(study.judged.from == Approx(.06));  // the scene starts released: a fifth of 0.3 s
  const auto level = [&](int levels) {
    return refine(study,
                  {.elements_per_bay = 1, .step = 1e-4, .target = 0., .most_levels = levels});
  };
  const Reference coarse = level(3), fine = level(5);
  const double off = errors_of(coarse.trace, fine.trace, study.judged).judged;
  CAPTURE(coarse.error, fine.error, off);
  CHECK(fine.error < .3 * coarse.error);
  // An estimate: within a factor of 3 of the error that two more levels show.
  CHECK(coarse.error < 3. * off);
  CHECK(coarse.error > off / 3.);
  // The reference is refined no further than requested.
  CHECK_THAT(
      refine(study, {.elements_per_bay = 1, .step = 1e-4, .target = 1., .most_levels = 5}).how,
      Contains("2 elements a bay") && Contains("2 levels"));
}

TEST_CASE("the parts of an error are those of mesh, condensation and step", "[study]") {
  const Studied study = study_of(kMovingLoad, {}, {});
  const Reference reference =
      refine(study, {.elements_per_bay = 4, .step = 2.5e-5, .target = 1e-5, .most_levels = 2});
  Study all(study, reference, 1.25e-5);
  const SettingRow coarse = all.row_of({"modal:0.25", 1, "held:0.6", 2e-4});
  const SettingRow fine = all.row_of({"modal:0.25", 2, "held:0.6", 2e-4});
  REQUIRE(coarse.failure.empty());
  REQUIRE(fine.failure.empty());
  // Another mesh changes only the mesh's part, by about the fourth power of the element's length.
  CHECK(fine.parts.mesh < .3 * coarse.parts.mesh);
  CHECK(fine.parts.condensation == Approx(coarse.parts.condensation).epsilon(.3));
  // No part is left out: the error is at most their sum.
  for (const SettingRow& own : {coarse, fine})
    CHECK(own.errors.judged <= own.parts.sum() * (1. + 1e-9));
  // Backward Euler has first order in the step and no error of condensation.
  const SettingRow longer = all.row_of({"full", 2, "backward-euler", 1e-3}),
                   shorter = all.row_of({"full", 2, "backward-euler", 5e-4});
  CHECK(longer.parts.condensation == 0.);
  CHECK(longer.parts.mesh == fine.parts.mesh);
  CHECK(longer.parts.step / shorter.parts.step == Approx(2.).epsilon(.25));
  // A setting that the scene cannot have gives a row without a result.
  const SettingRow none = all.row_of({"modal:100000", 1, "held:0.6", 2e-4});
  CHECK(none.failure.empty() == (none.kept_unknowns > 0));
}

TEST_CASE("a front has the settings that no cheaper one equals", "[study]") {
  std::vector<SettingRow> rows = {row(3., 1e-3), row(1., 1e-2), row(2., 2e-2),
                                  row(4., 1e-3), row(5., 1e-6), row(6., 1e-7)};
  rows.push_back(row(.1, 0.));
  rows.back().failure = "lost";
  mark_front(rows, 1e-5);
  std::vector<bool> front;
  front.reserve(rows.size());
  for (const SettingRow& own : rows) front.push_back(own.on_front);
  // The last two errors are both too small to be told apart: the cheaper setting stands for both.
  CHECK(front == std::vector<bool>{true, true, false, false, true, false, false});
  CHECK(cheapest(rows, 1e-2)->cost.us == 1.);
  CHECK(cheapest(rows, 9e-3)->cost.us == 3.);
  CHECK(cheapest(rows, 1e-8) == nullptr);
  rows[1].parts.mesh = 1.;  // an error of the mesh that the step's error cancels
  CHECK(cheapest(rows, 1e-2)->cost.us == 3.);
}

TEST_CASE("a study's file returns what it was given, and only to the same study", "[study]") {
  const auto file = fresh_folder("study_file") / "kept.jsonl";
  SettingRow kept = row(1.25, 1e-3);
  kept.setting = {"modal:1", 2, "held:0.6", 1e-4};
  kept.errors.kinds = {{OutputKind::contact_force, 1e-3, 2e-4}};
  kept.status = {"contact_lost"};
  SettingRow lost;
  lost.setting = {"modal:2", 2, "held:0.6", 1e-4};
  lost.failure = "no \"model\"";
  lost.errors.judged = std::numeric_limits<double>::infinity();
  {
    ResumeFile made(file, "key");
    made.keep(Reference{table({"time_s"}, {0., 1. / 3.}), "words", 1e-6});
    made.keep(kept);
    made.keep(lost);
  }
  std::ofstream(file, std::ios::app) << "{\"row\": {\"model\": \"mod";  // cut off
  const ResumeFile read(file, "key");
  REQUIRE(read.reference());
  CHECK(read.reference()->trace.values == std::vector<double>{0., 1. / 3.});
  CHECK(read.reference()->error == 1e-6);
  REQUIRE(read.find(kept.setting) != nullptr);
  CHECK(to_json(*read.find(kept.setting)) == to_json(kept));
  REQUIRE(read.find(lost.setting) != nullptr);
  CHECK(read.find(lost.setting)->failure == lost.failure);
  CHECK(std::isinf(read.find(lost.setting)->errors.judged));
  CHECK(read.find({"modal:1", 1, "held:0.6", 1e-4}) == nullptr);
  CHECK_THROWS_WITH(ResumeFile(file, "another"), Contains("E-STUDY-10"));
  std::ofstream(file) << "a,b\n";
  CHECK_THROWS_WITH(ResumeFile(file, "key"), Contains("E-STUDY-09"));
}

TEST_CASE("a scene is verified at other speeds, loads and places", "[study]") {
  const Scene scene = read_scene(kScenes + "ballasted_track.toml");
  const std::vector<Variation> all = variations_of(scene);
  REQUIRE(all.size() == 3);
  const auto with = [&](std::size_t i) {
    return read_scene(kScenes + "ballasted_track.toml", all[i].overrides);
  };
  CHECK(with(0).wheelsets[0].speed == Approx(.9 * scene.wheelsets[0].speed));
  const auto carried = [](const Scene& s) {
    return s.wheelsets[0].mass + s.wheelsets[0].carried_mass;
  };
  CHECK(carried(with(1)) == Approx(1.25 * carried(scene)));
  CHECK(with(2).wheelsets[0].start ==
        Approx(scene.wheelsets[0].start + .37 * scene.step->dt * scene.wheelsets[0].speed));
  // One [[vehicle]] for both rails is changed once.
  const Scene bogie = read_scene(kScenes + "bogie_at_speed.toml", {});
  for (const Variation& own : variations_of(bogie))
    CHECK_NOTHROW(read_scene(kScenes + "bogie_at_speed.toml", own.overrides));
}
