#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "online/model/block.h"
#include "run/simulate.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Contains;

namespace {

using Json = nlohmann::json;
const std::string kCondensed = " --set 'condense={kind=\"modal\", modes_per_bay=1}'";

/// Condenses the scene into the file. @returns the JSON that is printed
Json condense(const std::string& words, const std::filesystem::path& file) {
  const Ran ran = railstep_program("condense " + words + " --json --out " + file.string());
  CAPTURE(words, ran.err);
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  return Json::parse(ran.out);
}

/// Expects exit code 2, one sentence and nothing on stdout.
void check_refused(const Ran& ran, const std::string& said) {
  CAPTURE(ran.out, ran.err);
  CHECK(ran.code == 2);
  CHECK_THAT(ran.err, Contains(said));
  CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
  CHECK(ran.out.empty());
}

}  // namespace

TEST_CASE("a full or condensed model file gives the same bits as its scene", "[condense]") {
  const auto folder = fresh_folder("same_bits");
  for (const char* name : {"moving_load", "wheelset_on_track", "ballasted_track"})
    for (const bool modal : {false, true}) {
      std::string scene = kScenes + name + ".toml --set step.duration_s=0.05";
      scene += modal ? kCondensed : " --set 'condense={kind=\"full\"}'";
      const auto file = folder / "made.model";
      const Json made = condense(scene + " --skip-errors", file);
      const Ran of_scene =
          railstep_program("run --json " + scene + " --trace " + (folder / "scene.csv").string());
      const Ran of_model = railstep_program("run --json " + file.string() + " --trace " +
                                            (folder / "model.csv").string());
      CAPTURE(name, modal, of_scene.err, of_model.err);
      REQUIRE(of_scene.code == 0);
      REQUIRE(of_model.code == 0);
      const Json a = Json::parse(of_scene.out), b = Json::parse(of_model.out);
      for (const char* key : {"steps", "final_time_s", "state_hash", "status", "steps_per_frame",
                              "max_iterations", "max_constraint_violation"})
        CHECK(a.at(key) == b.at(key));
      CHECK(text_of(folder / "scene.csv") == text_of(folder / "model.csv"));
      CHECK(made.at("bytes") == std::filesystem::file_size(file));
    }
}

TEST_CASE("every kind of condensed model gives the same bits from its file as from its scene",
          "[condense]") {
  const auto folder = fresh_folder("kinds");
  const auto file = folder / "made.model";
  for (const char* kind : {"guyan", "irs", "craig-bampton", "krylov", "complex-modes"}) {
    const std::string scene =
        kScenes + "wheelset_on_track.toml --set step.duration_s=0.02 --set 'condense.kind=\"" +
        kind + "\"' --set condense.modes_per_bay=2";
    const Json made = condense(scene, file);
    const Ran of_scene = railstep_program("run --json " + scene);
    const Ran of_model = railstep_program("run --json " + file.string());
    CAPTURE(kind, of_scene.err, of_model.err);
    REQUIRE(of_scene.code == 0);
    REQUIRE(of_model.code == 0);
    const Json a = Json::parse(of_scene.out);
    CHECK(a.at("state_hash") == Json::parse(of_model.out).at("state_hash"));
    CHECK(a.at("allocations") == 0);
    CHECK(made.at("kept_unknowns") < made.at("full_unknowns"));
    CHECK(made.at("static_error") < 1e-3);  // the limit of design section 8
  }
}

TEST_CASE("a model file of a system gives the same bits as its scene", "[condense]") {
  const auto folder = fresh_folder("system_bits");
  const auto file = folder / "made.model";
  for (const std::string& words :
       {std::string("double_pendulum.toml"),
        std::string("double_pendulum.toml --set "
                    "system.planar=true"),
        std::string("double_pendulum.toml --set 'joints.tangent=\"kept\"'"),
        std::string("double_pendulum.toml --set 'step.scheme=\"energy-momentum\"'"),
        std::string("slider_crank.toml --set 'joints.hold=\"baumgarte\"'"),
        std::string("spring_pendulum.toml"), std::string("exciter_on_track.toml")}) {
    const std::string scene = kScenes + words + " --set step.duration_s=0.1";
    const Json made = condense(scene, file);
    const Ran of_scene =
        railstep_program("run --json " + scene + " --trace " + (folder / "scene.csv").string());
    const Ran of_model = railstep_program("run --json " + file.string() + " --trace " +
                                          (folder / "model.csv").string());
    CAPTURE(words, of_scene.err, of_model.err);
    REQUIRE(of_scene.code == 0);
    REQUIRE(of_model.code == 0);
    const Json a = Json::parse(of_scene.out), b = Json::parse(of_model.out);
    for (const char* key : {"steps", "final_time_s", "state_hash", "status", "steps_per_frame",
                            "max_iterations", "max_constraint_violation", "allocations"})
      CHECK(a.at(key) == b.at(key));
    CHECK(b.at("energy_balance_error").is_null());
    CHECK(text_of(folder / "scene.csv") == text_of(folder / "model.csv"));
    CHECK(made.at("bytes") == std::filesystem::file_size(file));
    CHECK(made.at("full_unknowns") == made.at("kept_unknowns"));
    CHECK(made.at("transient_error").is_null());
    for (const char* key : {"flops_per_frame", "bytes_per_frame", "instructions_per_frame"})
      CHECK(made.at(key) > 0);
  }
}

TEST_CASE("the unknowns of a system are counted without those that are held", "[condense]") {
  const auto folder = fresh_folder("system_keys");
  const Json pendulum = condense(kScenes + "double_pendulum.toml", folder / "a.model");
  CHECK(pendulum.at("full_unknowns") == 2 * 9 * 9 - 3);  // beams, nodes, the pin
  for (const char* key : {"static_error", "receptance_error"}) CHECK(pendulum.at(key) == 0.);
  const Ran table = railstep_program("condense " + kScenes + "slider_crank.toml --out " +
                                     (folder / "b.model").string());
  CHECK(table.code == 0);
  CHECK_THAT(table.out, Contains("9 of 9 unknowns") && Contains("not known"));
}

TEST_CASE("a run of a system's model file names a redundant joint by its place in the scene",
          "[condense]") {
  const auto folder = fresh_folder("redundant");
  const std::string scene = kScenes +
                            "slider_crank.toml --set step.duration_s=0.01 --set "
                            "system.planar=false --set 'joints.hold=\"direct\"'";
  condense(scene, folder / "a.model");
  const Ran ran = railstep_program("run " + (folder / "a.model").string());
  CHECK(ran.code == 0);
  CHECK_THAT(ran.err, Contains("note: redundant_joint") && Contains("(joint["));
}

TEST_CASE("the option --json has the contract's keys with their meaning", "[condense]") {
  const auto folder = fresh_folder("keys");
  const Json made = condense(kMovingLoad + kCondensed, folder / "a.model");
  for (const char* key :
       {"full_unknowns", "kept_unknowns", "bytes", "state_bytes", "workspace_bytes",
        "flops_per_frame", "bytes_per_frame", "instructions_per_frame", "sha256", "static_error",
        "receptance_error", "transient_error", "one_sided_supports"})
    CHECK(made.contains(key));
  const std::pair<const char*, const char*> shares[] = {
      {"model", "bytes"}, {"state", "state_bytes"}, {"workspace", "workspace_bytes"}};
  for (const auto& [share, whole] : shares)
    CHECK(made.at("bytes_per_bay").at(share) == (made.at(whole).get<int>() + 15) / 16);
  CHECK(made.at("full_unknowns") == 2 * 33 * 2);        // rails, nodes, r_z and b_x
  CHECK(made.at("kept_unknowns") == 2 * (16 + 17));     // rails, modes and seat dampers
  CHECK(made.at("state_bytes") == 4 * 2 * 40 * 8);      // u v a g, rails, 33 modes padded, double
  CHECK(made.at("workspace_bytes") == 5 * 2 * 40 * 8);  // u* v* scaled, solved in two parts
  const double static_error = made.at("static_error"), transient = made.at("transient_error");
  // The cubics of tables with 16 intervals miss (1/16)^4 of a bay's own modulation.
  CHECK(static_error > 0.);
  CHECK(static_error < 1e-4);
  CHECK(transient < 1e-3 + 2e-3);  // errors of the model and of a reference with 2 elements per bay
  const Json& parts = made.at("transient_error_parts");
  const double mesh = parts.at("mesh"), condensation = parts.at("condensation"),
               step = parts.at("step"), reference = made.at("transient_reference_error");
  CHECK(transient <= (mesh + condensation + step) * (1. + 1e-9));
  CHECK(mesh > 10. * reference);  // one element per bay, from which the reference is refined
  CHECK(step < mesh);
  CHECK(parts.at("contact_law").is_null());  // loads have no contact law
  CHECK(made.at("receptance_error") > static_error);
  const std::string sum = made.at("sha256");
  CHECK(sum.find_first_not_of("0123456789abcdef") == std::string::npos);
  // The same scene gives the same bytes, another scene gives other bytes.
  CHECK(condense(kMovingLoad + kCondensed, folder / "b.model").at("sha256") == sum);
  CHECK(text_of(folder / "a.model") == text_of(folder / "b.model"));
  const Json other =
      condense(kMovingLoad + kCondensed + " --set 'load[0].force_z_n=-49e3'", folder / "c.model");
  CHECK(other.at("sha256") != sum);
  const Ran table =
      railstep_program("condense " + kMovingLoad + " --out " + (folder / "d.model").string());
  CHECK(table.code == 0);
  CHECK_THAT(table.out, Contains("132 of 132 unknowns"));
  CHECK_THAT(table.out, !Contains("one-sided"));
  const Ran pads = railstep_program("condense " + kMovingLoad +
                                    " --set support.unilateral=true --set track.bays=15 --set "
                                    "step.duration_s=0.05 --set 'track.ends=\"pinned\"'" +
                                    " --out " + (folder / "e.model").string());
  CHECK(pads.code == 0);
  CHECK_THAT(pads.out, Contains("32 supports: as springs, or where each force alone presses them"));
}

TEST_CASE("condense states the error of a contact law that is not Hertz's", "[condense]") {
  const auto folder = fresh_folder("law");
  const std::string bogie =
      std::string(RAILSTEP_SOURCE) +
      "/config/scenes/bogie_at_speed.toml --set track.bays=24 --set vehicle[0].start_m=6 --set "
      "sensor[0].position_m=7.2 --set sensor[1].sleeper=12 "
      "--set step.duration_s=0.05 --set vehicle[0].speed_m_per_s=30 ";
  const auto law = [&](const std::string& contact) {
    return condense(bogie + contact, folder / "a.model")
        .at("transient_error_parts")
        .at("contact_law");
  };
  const std::string linear = "--set 'vehicle[0].contact=\"linear\"' ",
                    stiffness = "--set vehicle[0].contact_stiffness_n_per_m=";
  CHECK(law("").is_null());
  const double near = law(linear + stiffness + "1.3e9"), soft = law(linear + stiffness + "1e8");
  CHECK(near > 0.);
  CHECK(soft > 10. * near);
}

TEST_CASE("only the duration of a model file can be changed", "[condense]") {
  const auto folder = fresh_folder("changes");
  const std::string file = (folder / "x.model").string();
  condense(kMovingLoad + kCondensed + " --set step.frame_s=5e-3", file);
  const std::string trace = " --trace " + (folder / "t.csv").string();
  check_refused(railstep_program("run " + file + " --set step.dt_s=1e-4" + trace), "E-RUN-03");
  check_refused(railstep_program("run " + file + " --step 1e-4" + trace), "--step");
  check_refused(railstep_program("run " + file + " --model full" + trace), "--model");
  for (const char* duration : {"0.0125", "0", "-0.01", "nan", "1e300"}) {
    std::string words = "run " + file + " --duration ";
    words += duration;
    check_refused(railstep_program(words + trace), "--duration");
  }
  CHECK(entries(folder) == 1);
  const Ran longer = railstep_program("run --json " + file + " --duration 0.01");
  REQUIRE(longer.code == 0);
  CHECK(Json::parse(longer.out).at("steps") == 400);
}

TEST_CASE("a model file without its errors makes the same steps", "[condense]") {
  const auto folder = fresh_folder("skipped");
  const std::string with = (folder / "with").string(), without = (folder / "without").string();
  const Ran full = railstep_program("condense " + kMovingLoad + " --json --out " + with);
  REQUIRE(full.code == 0);
  const Ran ran =
      railstep_program("condense " + kMovingLoad + " --skip-errors --json --out " + without);
  REQUIRE(ran.code == 0);
  const auto told = nlohmann::json::parse(ran.out);
  CHECK(told.at("sha256") == nlohmann::json::parse(full.out).at("sha256"));
  const std::string a = text_of(with), b = text_of(without);
  REQUIRE(a.size() == b.size());
  const std::size_t errors = offsetof(BlockHeader, static_error);
  const std::size_t hash = offsetof(BlockHeader, check_hash);
  CHECK(a.substr(0, errors) == b.substr(0, errors));
  CHECK(a.substr(errors, hash - errors) != b.substr(errors, hash - errors));  // else NaN
  CHECK(a.substr(kCrcAt + 8) == b.substr(kCrcAt + 8));
  for (const char* key : {"static_error", "receptance_error", "transient_error"})
    CHECK(told.at(key).is_null());
}

TEST_CASE("condense refuses in one sentence and writes nothing", "[condense]") {
  const auto folder = fresh_folder("refused");
  const std::string out = " --out " + (folder / "x.model").string();
  const auto refused = [&](const std::string& words, const std::string& said) {
    CAPTURE(words);
    check_refused(railstep_program("condense " + words + out), said);
    CHECK(entries(folder) == 0);
  };
  refused(kScenes + "no_such_scene.toml", "no_such_scene.toml");
  refused(kMovingLoad + kCondensed + " --set support.stiffness_z_n_per_m=0", "E-TRACK-35");
  refused(kMovingLoad + kCondensed + " --set track.bays=1001 --set condense.modes_per_bay=2",
          "E-CONDENSE-16");
  refused(kMovingLoad + " --set 'condense={kind=\"modal\", modes_per_bay=-1}'", "modes_per_bay");
  refused(kMovingLoad + " --set 'condense={kind=\"moddal\"}'", "modal");
  CHECK(railstep_program("condense " + kMovingLoad).code == 2);  // no --out
  const Ran unwritable = railstep_program("condense " + kMovingLoad + " --out " +
                                          (folder / "no_folder/x.model").string());
  CHECK(unwritable.code == 2);
  CHECK_THAT(unwritable.err, Contains("no_folder/x.model: ") && Contains("E-CLI-05"));
  CHECK(entries(folder) == 0);
}
