#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "support/loopback.h"
#include "support/program.h"
#include "support/shipped.h"
#include "support/started.h"

using namespace railstep;
using Catch::Contains;

namespace {

/// The wheelset with an input that pushes it sideways.
const std::string kPushed =
    kWheelset +
    " --set 'wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1e3}]' --json";

nlohmann::json told(const Ran& ran) {
  CAPTURE(ran.out, ran.err);
  return nlohmann::json::parse(ran.out);
}

std::string free_address() { return LoopbackSocket().address(); }

/// Value of an output that the client printed.
double printed(const std::string& text, const std::string& name) {
  const std::size_t at = text.find("  " + name + " ");
  REQUIRE(at != std::string::npos);
  return std::stod(text.substr(at + 2 + name.size()));
}

}  // namespace

TEST_CASE("a paced run prints its times, settings and state", "[hil][cli]") {
  const Ran ran = railstep_program("hil " + kWheelset + " --rate 500 --duration 0.4 --json");
  REQUIRE(ran.code == 0);
  const auto result = told(ran);
  for (const char* key : {"frame_us", "wakeup_us"})
    for (const char* part : {"median", "p99", "p99_9", "p99_99", "max"})
      CHECK(result[key][part].is_number());
  CHECK(result["rate_hz"] == 500.);
  CHECK(result["empty_loop_us"].is_number());
  CHECK(result["overruns"].is_number_integer());
  CHECK(result["status"].is_array());
  CHECK(result["policy"] == "skip");
  CHECK(result["frames"].get<int>() + result["skipped"].get<int>() == 200);
  CHECK(result["real_time_factor"] == Approx(500. * result["frame_length_s"].get<double>()));
  CHECK(result["allocations"] == 0);
  for (const char* setting : {"memory_locked", "stack_touched", "timer_slack_1ns", "sched_fifo"})
    CHECK_THAT(result["realtime"][setting].get<std::string>(),
               Contains("done") || Contains("refused: "));  // either, as the system allows
  CHECK_FALSE(result["realtime"].contains("cpu_pinned"));
}

TEST_CASE("bodies and joints are paced without the heap too", "[hil][cli]") {
  const auto result = told(
      railstep_program("hil " + kScenes + "slider_crank.toml --rate 500 --duration 0.2 --json"));
  CHECK(result["allocations"] == 0);
  CHECK(result["frames"].get<int>() >= 1);
}

TEST_CASE("paced frames give the same bits as a run", "[hil][cli]") {
  const auto folder = fresh_folder("hil_model");
  const std::string model = (folder / "track.model").string();
  REQUIRE(railstep_program("condense " + kWheelset + " --out " + model).code == 0);
  const auto paced = told(railstep_program(
      "hil " + model + " --rate 1000 --duration 0.1 --grace 0 --policy catch-up --json"));
  const auto frame = paced["frame_length_s"].get<double>();
  const auto run =
      told(railstep_program("run " + model + " --json --duration " + std::to_string(100. * frame)));
  CHECK(paced["frames"] == 100);
  CHECK(paced["state_hash"] == run["state_hash"]);
}

TEST_CASE("each policy treats a stalled frame in its own way", "[hil][cli]") {
  const auto stalled = [](const std::string& policy, int code) {
    const Ran ran = railstep_program("hil " + kWheelset +
                                     " --rate 100 --duration 0.4 --grace 0 --stall-frame 10 "
                                     "--stall-us 50000 --json --policy " +
                                     policy);
    CAPTURE(ran.err);
    CHECK(ran.code == code);
    return told(ran);
  };
  const auto stop = stalled("stop", 1);
  CHECK(stop["overruns"] == 1);
  CHECK(stop["frames"].get<int>() <= 11);  // on a busy machine it may stop earlier
  const auto skip = stalled("skip", 0);
  CHECK(skip["overruns"].get<int>() >= 1);
  CHECK(skip["skipped"].get<int>() >= 4);
  CHECK(skip["frames"].get<int>() + skip["skipped"].get<int>() == 40);
  const auto catch_up = stalled("catch-up", 0);
  CHECK(catch_up["overruns"].get<int>() >= 5);
  CHECK(catch_up["frames"] == 40);
  CHECK(catch_up["skipped"] == 0);
  const auto free_run = stalled("free-run", 0);
  CHECK(free_run["overruns"].get<int>() >= 1);
  CHECK(free_run["frames"] == 40);
  CHECK(free_run["wakeup_us"]["max"].is_null());
  CHECK_FALSE(free_run["realtime"].contains("sched_fifo"));
}

TEST_CASE("an overrun during the grace time is counted separately", "[hil][cli]") {
  const auto result = told(railstep_program("hil " + kWheelset +
                                            " --rate 100 --duration 0.3 --grace 0.3 --policy stop "
                                            "--stall-frame 2 --stall-us 30000 --json"));
  CHECK(result["overruns"] == 0);
  CHECK(result["grace_overruns"].get<int>() >= 1);
  CHECK(result["frame_us"]["max"].is_null());  // no frame is left to report
}

TEST_CASE("the program and the client exchange packets over UDP", "[hil][cli]") {
  const auto folder = fresh_folder("hil_udp");
  const std::string address = free_address(), names = (folder / "names").string();
  Started hil("hil " + kPushed +
              " --rate 200 --duration 0.5 --grace 0 --policy catch-up --wait 60 --names " + names +
              " --udp " + address);
  hil.await(std::filesystem::path(names));
  const Ran client =
      run_program(RAILSTEP_HIL_CLIENT,
                  "--seconds 60 --input push.force_n=30 --udp " + address + " --names " + names);
  const Ran ran = hil.end();
  CAPTURE(ran.err, client.out, client.err);
  REQUIRE(ran.code == 0);
  CHECK(client.code == 0);
  const auto result = told(ran);
  CHECK(result["packets"]["good"].get<int>() >= 1);
  CHECK(result["packets"]["foreign"] == 0);
  CHECK(result["packets"]["sent"].get<int>() >= 1);
  CHECK(result["allocations"] == 0);
  CHECK_THAT(client.out, Contains("frame 99, ") && Contains("flags 1"));
  CHECK(printed(client.out, "wheelset.y_m") > 0.);  // the input pushed it
  CHECK(printed(client.out, "time_s") == Approx(result["final_time_s"].get<double>()));
}

TEST_CASE("the program and the client exchange blocks over shared memory", "[hil][cli]") {
  const auto folder = fresh_folder("hil_shm");
  const std::string name = "railstep_cli_" + std::to_string(getpid());
  const std::string recording = (folder / "recording").string();
  Started hil("hil " + kPushed +
              " --rate 200 --duration 0.5 --grace 0 --policy catch-up --wait 60 --record " +
              recording + " --shm " + name);
  const Ran client = run_program(RAILSTEP_HIL_CLIENT, "--seconds 60 --input 0=30 --shm " + name);
  const Ran ran = hil.end();
  CAPTURE(ran.err, client.out, client.err);
  REQUIRE(ran.code == 0);
  CHECK(client.code == 0);
  CHECK(told(ran)["shared_memory"]["fresh"].get<int>() >= 1);
  CHECK(told(ran)["allocations"] == 0);
  CHECK_THAT(client.out, Contains("frame 99, ") && Contains("flags 1"));
  CHECK(printed(client.out, "wheelset.y_m") > 0.);
  const Ran again = railstep_program("replay " + recording + " --json");
  CHECK(again.code == 0);  // the recording has the inputs at the frames in which they came
  CHECK(told(again)["frames"] == 100);
}

TEST_CASE("a silence ends with a safe stop and exit code 1", "[hil][cli]") {
  const std::string name = "railstep_silence_" + std::to_string(getpid());
  Started hil("hil " + kPushed +
              " --rate 200 --duration 0.5 --grace 0 --policy catch-up --wait 60 --silence 0.1 "
              "--ramp 0.05 --shm " +
              name);
  const Ran client =
      run_program(RAILSTEP_HIL_CLIENT, "--seconds 60 --frames 3 --input 0=30 --shm " + name);
  const Ran ran = hil.end();
  CAPTURE(ran.err, client.err);
  CHECK(ran.code == 1);
  CHECK_THAT(ran.err, Contains("E-HIL-18"));
  const auto result = told(ran);
  CHECK(result["safe_stop_frame"].get<int>() >= 20);
  REQUIRE(result["errors"].size() == 1);
  CHECK(result["errors"][0]["id"] == "E-HIL-18");
  std::size_t refused = 0;  // each setting that the system refused is a warning
  for (const auto& setting : result["realtime"]) refused += setting == "done" ? 0 : 1;
  CHECK(result["warnings"].size() == refused);
}

TEST_CASE("a run without inputs in time ends before its first frame", "[hil][cli]") {
  const Ran ran = railstep_program("hil " + kPushed +
                                   " --rate 100 --duration 1 --wait 0.05 --udp " + free_address());
  CHECK(ran.code == 1);
  CHECK_THAT(ran.err, Contains("E-HIL-10"));
}

TEST_CASE("hil --report writes histograms", "[hil][cli]") {
  const auto folder = fresh_folder("hil_report");
  const std::string file = (folder / "hil.html").string();
  const Ran ran =
      railstep_program("hil " + kWheelset + " --rate 500 --duration 0.3 --report " + file);
  REQUIRE(ran.code == 0);
  CHECK_THAT(ran.out, Contains("task execution time") && Contains("overrun count") &&
                          Contains("wake-up latency"));
  const std::string page = text_of(file);
  CHECK_THAT(page, Contains("bins of 1 us") && Contains("realtime, sched_fifo"));
  CHECK(entries(folder) == 1);
}

TEST_CASE("bad options of hil are refused in one sentence with exit code 2", "[hil][cli]") {
  const auto refused = [](const std::string& words, const std::string& scene = kWheelset) {
    const Ran ran = railstep_program("hil " + scene + " " + words);
    CAPTURE(words, ran.out, ran.err);
    CHECK(ran.code == 2);
    CHECK(ran.out.empty());
    return ran.err;
  };
  const std::string good = "--rate 100 --duration 0.1 ";
  CHECK_THAT(refused(good + "--cpu 9999"), Contains("--cpu 9999") && Contains("E-HIL-03"));
  CHECK_THAT(refused(good + "--cpu -1"), Contains("--cpu"));
  CHECK_THAT(refused("--duration 0.1"), Contains("--rate is required"));
  CHECK_THAT(refused("--rate 100"), Contains("--duration is required"));
  CHECK_THAT(refused("--rate 0 --duration 1"), Contains("--rate"));
  CHECK_THAT(refused("--rate nan --duration 1"), Contains("--rate: 'nan'") && Contains("E-CLI-10"));
  CHECK_THAT(refused("--rate 100 --duration 0.001"),
             Contains("--duration 0.001") && Contains("E-HIL-01"));
  CHECK_THAT(refused(good + "--policy later"), Contains("--policy"));
  CHECK_THAT(refused(good + "--priority 100"), Contains("--priority"));
  CHECK_THAT(refused(good + "--udp nowhere"), Contains("E-HIL-13"));
  CHECK_THAT(refused(good + "--shm a/b"), Contains("--shm a/b") && Contains("E-HIL-11"));
  CHECK_THAT(refused(good + "--silence 1"), Contains("E-HIL-04"));
  CHECK_THAT(refused(good, kScenes + "no_such_scene.toml"), Contains("no_such_scene.toml"));
  const LoopbackSocket busy;
  CHECK_THAT(refused(good + "--udp " + busy.address()), Contains("E-HIL-15"));
}
