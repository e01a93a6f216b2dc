#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hil/hil_packet.h"
#include "online/model/status.h"
#include "support/bad_input.h"
#include "support/loopback.h"
#include "support/started.h"
#include "support/wait.h"

using namespace railstep;
using Catch::Contains;

namespace {

const std::vector<std::string> kInputs = {"push.force_n"};
constexpr double kLimit = 1e3;  // N, limit of the input

/// A packet of inputs in the program's own format.
Bytes one_packet(std::uint64_t sequence, double value) {
  Bytes bytes(packet_bytes(1));
  encode({.kind = PacketKind::inputs,
          .names = names_sum(kInputs),
          .count = 1,
          .sequence = sequence,
          .frame = -1},
         &value, bytes.data());
  return bytes;
}

Bytes with(Bytes bytes, std::size_t at, unsigned char value) {
  bytes[at] = value;
  return bytes;
}

/// Content of a packet of outputs.
struct Answer {
  PacketHead head;
  double y;  // y of the wheelset, m
};

/// A paced run of a wheelset that an input pushes sideways; it begins with the first good packet.
class PacedRun {
 public:
  explicit PacedRun(const std::string& words = "", int seconds = 1) {
    const std::string names = folder_.path("names");
    std::string all = "hil " + shipped("wheelset_on_track") +
                      " --set 'wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1e3}]'"
                      " --json --rate 200 --grace 0 --policy catch-up --wait 60 ";
    all += "--duration " + std::to_string(seconds) + " " + words + " --names " + names +
           " --udp 127.0.0.1:" + std::to_string(port_);
    hil_ = std::make_unique<Started>(all);
    hil_->await(std::filesystem::path(names));
    read_outputs(text_of(names));
  }
  PacedRun(const PacedRun&) = delete;
  PacedRun& operator=(const PacedRun&) = delete;

  void send(const Bytes& bytes) const { peer_.send(bytes, port_); }
  /// Sends from another sender.
  void send_as_stranger(const Bytes& bytes) const { LoopbackSocket().send(bytes, port_); }
  /// The next outputs; fails the test if they still come long after the run should have ended, so
  /// that no loop over them is endless.
  Answer receive() const {
    if (deadline_.passed()) FAIL("outputs still come after " << kPatience.count() << " s");
    std::vector<double> values(outputs_.size());
    const auto head = decode(peer_.receive(), PacketKind::outputs, names_sum(outputs_),
                             static_cast<std::uint32_t>(outputs_.size()), values.data());
    if (!head) FAIL("no outputs came");
    const auto y = std::find(outputs_.begin(), outputs_.end(), "wheelset.y_m");
    return {*head, values[static_cast<std::size_t>(y - outputs_.begin())]};
  }
  /// Receives outputs up to those of a frame.
  Answer receive_until(std::int64_t frame) const {
    Answer told = receive();
    while (told.head.frame < frame) told = receive();
    return told;
  }
  /// Receives outputs until these bits are set.
  Answer receive_until(Status bits) const {
    Answer told = receive();
    while ((told.head.status & static_cast<std::uint32_t>(bits)) == 0 &&
           (told.head.flags & kLastFrame) == 0)
      told = receive();
    CHECK((told.head.status & static_cast<std::uint32_t>(bits)) != 0);
    return told;
  }
  /// Ends the program. @returns the JSON that it printed
  nlohmann::json end(int code = 0) {
    ran_ = hil_->end();
    CAPTURE(ran_.err);
    CHECK(ran_.code == code);
    return nlohmann::json::parse(ran_.out);
  }
  const std::string& errors() const { return ran_.err; }

 private:
  /// Reads the names after the line "outputs N SUM".
  void read_outputs(const std::string& text) {
    std::istringstream lines(text.substr(text.find("outputs ")));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) outputs_.push_back(line);
  }

  BadInput folder_{"packets"};
  LoopbackSocket peer_;  // has its port before another one is looked for
  std::uint16_t port_ = free_port();
  std::vector<std::string> outputs_;
  Ran ran_{};
  Deadline deadline_;
  std::unique_ptr<Started> hil_;
};

}  // namespace

TEST_CASE("packets that are short, long, foreign or of another version are dropped and counted",
          "[bad_input][hil][cli]") {
  PacedRun run;
  const Bytes good = one_packet(1, 10.), wild = one_packet(1, 1e9);  // its force would set a bit
  std::vector<Bytes> bad = {{}, {'R'}, Bytes(51, 'R'), Bytes(1500, 0)};
  for (const std::size_t size : {std::size_t{4}, kPacketHead, wild.size() - 8, wild.size() - 1})
    bad.emplace_back(wild.begin(), wild.begin() + static_cast<std::ptrdiff_t>(size));
  bad.push_back(wild);
  bad.back().push_back(0);  // a byte too long
  // Another protocol, version, kind, model, count or, with the old sum, another value.
  for (const std::size_t at : {0u, 4u, 6u, 8u, 12u, 45u})
    bad.push_back(with(wild, at, static_cast<unsigned char>(wild[at] ^ 2)));
  for (const Bytes& each : bad) run.send(each);
  run.send(good);
  run.receive_until(3);
  run.send(one_packet(2, 10.));
  run.send_as_stranger(one_packet(3, 1e9));  // the first sender is not silent yet
  const auto told = run.end();
  CHECK(told["packets"]["foreign"] == bad.size() + 1);
  CHECK(told["packets"]["good"] == 2);
  CHECK(told["frames"] == 200);
  CHECK(told["status"].empty());  // no force of theirs was applied
}

TEST_CASE("the newest of repeated and reordered packets is held", "[bad_input][hil][cli]") {
  PacedRun run("", 3);
  run.send(one_packet(1, 10.));
  run.receive_until(3);
  run.send(one_packet(5, 20.));
  for (const std::uint64_t old : {5u, 5u, 4u, 2u, 1u}) run.send(one_packet(old, 1e9));
  run.receive_until(40);
  run.send(one_packet(6, 30.));
  const auto told = run.end();
  CHECK(told["status"].empty());
  const auto& in = told["packets"];
  CHECK(in["good"] == 3);
  CHECK(in["repeated"] == 3);   // 5 twice, 1
  CHECK(in["reordered"] == 2);  // 4, 2
  CHECK(in["lost"] == 1);       // 3
}

TEST_CASE("a flood of packets leaves the newest and costs no frame", "[bad_input][hil][cli]") {
  PacedRun run("", 4);
  std::uint64_t sent = 0;
  for (int n = 0; n < 5000; ++n) run.send(one_packet(++sent, 10.));
  bool last = false, saturated = false;  // the system may drop packets: until one comes through
  while (!last && !saturated) {
    for (int n = 0; n < 100; ++n) run.send(one_packet(++sent, 2. * kLimit));
    const Answer told = run.receive();
    saturated = (told.head.status & static_cast<std::uint32_t>(Status::force_saturated)) != 0;
    last = (told.head.flags & kLastFrame) != 0;
  }
  CHECK(saturated);
  const auto told = run.end();
  CHECK(told["frames"] == 800);
  CHECK(told["allocations"] == 0);
  const auto& in = told["packets"];
  CHECK(in["foreign"] == 0);
  CHECK(in["good"].get<std::uint64_t>() + in["lost"].get<std::uint64_t>() <= sent);
  CHECK(in["good"] > 1);
}

TEST_CASE("NaN and infinity set a status bit and the last good force is held",
          "[bad_input][hil][cli]") {
  const auto end_of = [](const std::vector<double>& then) {
    PacedRun run;
    run.send(one_packet(1, 300.));
    std::uint64_t sequence = 1;
    run.receive_until(20);
    for (const double value : then) run.send(one_packet(++sequence, value));
    Answer told = then.empty() ? run.receive() : run.receive_until(Status::nonfinite_input);
    while ((told.head.flags & kLastFrame) == 0) told = run.receive();
    const auto names = run.end()["status"];
    CHECK(names.empty() == then.empty());
    if (!then.empty()) CHECK(names[0] == "nonfinite_input");
    CHECK(told.head.frame == 199);
    return told.y;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const double pushed = end_of({});
  CHECK(pushed > 1e-4);  // the force has an effect
  CHECK(end_of({nan}) == pushed);
  CHECK(end_of({infinite, -infinite}) == pushed);
}

TEST_CASE("a huge force sets a status bit and is cut to its limit", "[bad_input][hil][cli]") {
  const auto end_of = [](double value) {
    PacedRun run;
    run.send(one_packet(1, value));
    Answer told = run.receive();
    while ((told.head.flags & kLastFrame) == 0) told = run.receive();
    const auto names = run.end()["status"];
    CHECK(std::find(names.begin(), names.end(), "force_saturated") != names.end());
    return told.y;
  };
  const double cut = end_of(1.0001 * kLimit);
  CHECK(std::isfinite(cut));
  CHECK(end_of(1e300) == cut);
}

TEST_CASE("while packets are missing the last force is held, then the run makes a safe stop",
          "[bad_input][hil][cli]") {
  constexpr std::int64_t kSilence = 40;  // frames
  PacedRun run("--silence 0.2 --ramp 0.05");
  run.send(one_packet(1, 300.));
  run.receive_until(10);
  run.send(one_packet(8, 300.));  // 6 packets are lost
  Answer told = run.receive();
  const std::int64_t from = told.head.frame;
  while ((told.head.flags & kSafeStop) == 0 && (told.head.flags & kLastFrame) == 0)
    told = run.receive();
  CHECK(told.head.frame >= from + kSilence - 1);
  const std::int64_t stopped = told.head.frame;
  run.send(one_packet(9, 300.));  // too late
  while ((told.head.flags & kLastFrame) == 0) {
    told = run.receive();
    CHECK((told.head.flags & kSafeStop) != 0);
  }
  const auto result = run.end(1);
  CHECK(result["safe_stop_frame"] == stopped);
  CHECK(result["packets"]["lost"] == 6);
  CHECK_THAT(run.errors(),
             Contains("from frame " + std::to_string(stopped)) && Contains("E-HIL-18"));
}
