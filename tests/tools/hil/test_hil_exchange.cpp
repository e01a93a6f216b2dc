#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <bit>
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hil/hil_inputs.h"
#include "hil/hil_mailbox.h"
#include "hil/hil_seqlock.h"
#include "hil/hil_shm.h"
#include "hil/hil_udp.h"
#include "support/loopback.h"
#include "support/wait.h"
#include "text/read.h"

using namespace railstep;
using Catch::Contains;

namespace {

const std::vector<std::string> kPush = {"push.force_n"}, kOutputs = {"time_s", "y_m", "z_m"};
const ExchangeLayout kLayout{kPush, kOutputs, 1e6, -1};

Bytes inputs_packet(std::uint64_t sequence, double value, std::int64_t frame = -1) {
  Bytes bytes(packet_bytes(1));
  encode({.kind = PacketKind::inputs,
          .names = names_sum(kPush),
          .count = 1,
          .sequence = sequence,
          .frame = frame},
         &value, bytes.data());
  return bytes;
}

/// Waits until an exchange has this input.
bool comes(Exchange& exchange, std::int64_t frame, double value) {
  return waited([&] {
    const double* const fresh = exchange.inputs(frame);
    return fresh != nullptr && *fresh == value;
  });
}

/// A name that no other process of a test has.
std::string own_name() { return "railstep_test_" + std::to_string(getpid()); }

}  // namespace

TEST_CASE("the newest value arrives whole and only once", "[hil]") {
  constexpr std::int64_t kMost = 100'000;
  NewestBox box(16);
  std::thread producer([&box] {
    for (std::int64_t n = 1; n <= kMost; ++n) {
      double* const to = box.blank();
      for (int i = 0; i < 16; ++i) to[i] = static_cast<double>(n);
      box.put();
    }
  });
  double last = 0.;
  std::int64_t torn = 0, old = 0;
  for (const Deadline deadline; last < static_cast<double>(kMost) && !deadline.passed();) {
    const double* const came = box.take();
    if (came == nullptr) continue;
    for (int i = 1; i < 16; ++i) torn += came[i] == came[0] ? 0 : 1;
    old += came[0] > last ? 0 : 1;
    last = came[0];
  }
  producer.join();
  CHECK(last == static_cast<double>(kMost));
  CHECK(torn == 0);
  CHECK(old == 0);
  CHECK(box.take() == nullptr);
}

TEST_CASE("a queue hands on all values in order and refuses more when it is full", "[hil]") {
  Queue<int> queue(4, 2);
  const double values[2] = {1., 2.};
  for (int n = 0; n < 4; ++n) CHECK(queue.put(n, values));
  CHECK_FALSE(queue.put(4, values));
  const Deadline deadline;
  std::thread producer([&] {
    for (int n = 4; n < 50'000 && !deadline.passed();) {
      const double pair[2] = {static_cast<double>(n), -static_cast<double>(n)};
      if (queue.put(n, pair)) ++n;
    }
  });
  int next = 0, wrong = 0;
  while (next < 50'000 && !deadline.passed())
    queue.take([&](int n, const double* pair) {
      wrong += n == next && (n < 4 || (pair[0] == n && pair[1] == -n)) ? 0 : 1;
      ++next;
    });
  producer.join();
  CHECK(next == 50'000);
  CHECK(wrong == 0);
  CHECK_FALSE(queue.take([](int, const double*) {}));
}

TEST_CASE("inputs are held until a silence takes them to 0 for good", "[hil]") {
  const double good = 8., fresh = 12.;  // the model cut 12 to 8
  HeldInputs held(1, 3, 4);
  for (int n = 0; n < 10; ++n) CHECK(held.next(nullptr, &good)[0] == 0.);
  CHECK_FALSE(held.stopping());  // no input ever came
  CHECK(held.next(&fresh, &good)[0] == 12.);
  CHECK(held.next(nullptr, &good)[0] == 12.);
  CHECK(held.next(nullptr, &good)[0] == 12.);
  CHECK(held.next(&fresh, &good)[0] == 12.);  // just in time: the count starts again
  CHECK(held.next(nullptr, &good)[0] == 12.);
  CHECK(held.next(nullptr, &good)[0] == 12.);
  CHECK_FALSE(held.stopping());
  for (const double want : {6., 4., 2., 0., 0.}) CHECK(held.next(nullptr, &good)[0] == want);
  CHECK(held.stopping());
  CHECK(held.next(&fresh, &good)[0] == 0.);  // it came too late
  const double both[2] = {40., 8.};
  HeldInputs placed(2, 1, 2, {0});  // a place does not go to 0 with its force
  placed.next(both, both);
  CHECK(placed.next(nullptr, both)[1] == 4.);
  CHECK(placed.next(nullptr, both)[1] == 0.);
  CHECK(placed.next(nullptr, both)[0] == 40.);
  HeldInputs patient(1, 0, 1);
  CHECK(patient.next(&fresh, &good)[0] == 12.);
  for (int n = 0; n < 1000; ++n) CHECK(patient.next(nullptr, &good)[0] == 12.);
}

TEST_CASE("over UDP packets come in and are counted, and outputs go back", "[hil]") {
  const std::uint16_t port = free_port();
  UdpExchange exchange("127.0.0.1:" + std::to_string(port), kLayout);
  const LoopbackSocket client, stranger;
  const double values[3] = {1e-3, 2., 3.};
  client.send(inputs_packet(1, 1.), port);
  REQUIRE(comes(exchange, 7, 1.));  // the exchange has the frame before the next packets are sent
  client.send(inputs_packet(2, 2., 9), port);
  client.send(inputs_packet(2, 2., 9), port);  // repeated
  client.send(inputs_packet(5, 5., 6), port);  // 3 and 4 are missing; late
  client.send(inputs_packet(4, 4.), port);     // reordered
  stranger.send(inputs_packet(6, 66.), port);  // foreign
  client.send(Bytes(51), port);                // foreign
  client.send({}, port);                       // foreign
  client.send(inputs_packet(6, 6.), port);
  REQUIRE(comes(exchange, 7, 6.));
  exchange.outputs({7, Status::contact_lost, kSafeStop, values});
  double back[3] = {};
  const auto head = decode(client.receive(), PacketKind::outputs, names_sum(kOutputs), 3, back);
  REQUIRE(head);
  CHECK(head->frame == 7);
  CHECK(head->status == static_cast<std::uint32_t>(Status::contact_lost));
  CHECK(head->flags == kSafeStop);
  CHECK(back[2] == 3.);
  exchange.outputs({8, Status::ok, kLastFrame, values});  // sent by finish() at the latest
  exchange.finish();
  const auto last = decode(client.receive(), PacketKind::outputs, names_sum(kOutputs), 3, back);
  REQUIRE(last);
  CHECK(last->sequence == head->sequence + 1);
  CHECK(last->flags == kLastFrame);
  const PacketCounts& in = exchange.received();
  CHECK(in.good == 4);
  CHECK(in.late == 1);
  CHECK(in.lost == 1);
  CHECK(in.repeated == 1);
  CHECK(in.reordered == 1);
  CHECK(in.foreign == 3);
  CHECK(exchange.sent().sent == 2);
  CHECK(exchange.sent().dropped == 0);
}

TEST_CASE("outputs that no one asked for or that are too many at once are counted", "[hil]") {
  UdpExchange exchange("127.0.0.1:" + std::to_string(free_port()), {kPush, kOutputs, 1e9, -1});
  const double values[3] = {};
  for (int n = 0; n < 100'000; ++n) exchange.outputs({n, Status::ok, 0, values});
  exchange.finish();
  CHECK(exchange.sent().sent == 0);
  CHECK(exchange.sent().unheard >= 256);  // the queue
  CHECK(exchange.sent().unheard + exchange.sent().dropped == 100'000);
}

TEST_CASE("of a flood of packets the newest one stays", "[hil]") {
  const std::uint16_t port = free_port();
  UdpExchange exchange("127.0.0.1:" + std::to_string(port), kLayout);
  const LoopbackSocket client;
  std::uint64_t sequence = 0;
  for (int n = 0; n < 20'000; ++n) client.send(inputs_packet(++sequence, 1.), port);
  std::atomic<bool> came{false};
  std::thread last([&] {  // the system may drop packets: until one comes through
    while (!came) client.send(inputs_packet(++sequence, 2.), port);
  });
  const bool through = comes(exchange, 0, 2.);
  came = true;
  last.join();
  REQUIRE(through);
  exchange.finish();
  const PacketCounts& in = exchange.received();
  CHECK(in.repeated + in.reordered + in.foreign == 0);
  CHECK(in.good + in.lost <= static_cast<std::int64_t>(sequence));
}

TEST_CASE("an address on which no one can listen is refused in one sentence", "[hil]") {
  const LoopbackSocket busy;
  const auto told = [](const std::string& address) {
    try {
      const UdpExchange exchange(address, kLayout);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("it listens");
  };
  for (const char* bad :
       {"", ":", "9000", "localhost", "localhost:", ":9000", "localhost:0", "localhost:65536",
        "localhost:12x", "localhost:-1", "::1:9000", "[]:9000"})
    CHECK_THAT(told(bad), Contains("E-HIL-13"));
  CHECK_THAT(told("127.0.0.1:" + std::to_string(busy.port())),
             Contains("in use") && Contains("E-HIL-15"));
  CHECK_THAT(told("no.such.host.invalid:9000"), Contains("E-HIL-14"));
}

TEST_CASE("no reader sees a half-written change", "[hil]") {
  constexpr std::size_t kWords = 24;
  constexpr std::uint64_t kChanges = 50'000;
  std::vector<SeqLock::Word> memory(1 + kWords);
  SeqLock lock(memory.data(), kWords);
  std::atomic<std::int64_t> torn{0}, whole{0};
  const Deadline deadline;
  const auto read = [&] {
    std::uint64_t words[kWords], seen = 0;
    while (words[0] = 0, seen < 2 * kChanges && !deadline.passed()) {
      if (!lock.read(words, 100, seen)) continue;
      for (const std::uint64_t word : words) torn += word == words[0] ? 0 : 1;
      torn += seen == 2 * words[0] ? 0 : 1;
      ++whole;
    }
  };
  std::thread first(read), second(read);
  std::vector<std::uint64_t> words(kWords);
  for (std::uint64_t n = 1; n <= kChanges; ++n) {
    words.assign(kWords, n);
    lock.write(words.data());
  }
  first.join();
  second.join();
  CHECK_FALSE(deadline.passed());  // both saw the last change
  CHECK(torn == 0);
  CHECK(whole >= 2);
}

TEST_CASE("a writer that is at work or died at work does not delay the reader", "[hil]") {
  std::vector<SeqLock::Word> memory(3);
  SeqLock lock(memory.data(), 2);
  const std::uint64_t words[2] = {4, 5};
  std::uint64_t got[2] = {}, seen = 0;
  lock.write(words);
  CHECK(lock.read(got, 1, seen));
  CHECK(seen == 2);
  memory[0].store(3);
  CHECK_FALSE(lock.read(got, 1000, seen));
  CHECK(seen == 2);
  lock.write(words);  // the next write repairs it
  CHECK(lock.read(got, 1, seen));
  CHECK(seen == 4);
}

TEST_CASE("two processes exchange through shared memory", "[hil]") {
  constexpr std::uint64_t kChanges = 100'000;
  std::vector<std::string> inputs;
  inputs.reserve(12);
  for (int i = 0; i < 12; ++i) inputs.push_back("force_" + std::to_string(i));
  const std::string name = own_name();  // the child has another process number
  SharedExchange exchange(name, {inputs, kOutputs, 1e6, -1});
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {  // only calls that a child of a program with threads may make
    const int file = shm_open(("/" + name).c_str(), O_RDWR, 0);
    auto* const word = static_cast<SeqLock::Word*>(
        mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    SeqLock out(word + word[4].load() / 8, kBlockHead + 12);
    std::uint64_t words[kBlockHead + 12];
    for (std::uint64_t n = 1; n <= kChanges; ++n) {
      for (std::uint64_t& each : words) each = std::bit_cast<std::uint64_t>(static_cast<double>(n));
      words[0] = n;
      words[1] = n % 2 == 0 ? 3 : ~0ULL;  // for frame 3, for any
      out.write(words);
    }
    const SeqLock in(word + word[5].load() / 8, kBlockHead + 3);
    std::uint64_t got[kBlockHead + 3] = {}, seen = 0;
    for (int n = 0; n < 1'000'000 && (!in.read(got, 1, seen) || got[1] != 41); ++n) usleep(100);
    const bool right = got[2] == (2ULL << 32 | 64) && std::bit_cast<double>(got[5]) == 7.5;
    _exit(right ? 0 : 1);
  }
  std::int64_t torn = 0;
  for (double last = 0.; last < static_cast<double>(kChanges);) {
    const double* const came = exchange.inputs(4);
    if (came == nullptr) {
      REQUIRE(waitpid(child, nullptr, WNOHANG) == 0);  // otherwise endless
      continue;
    }
    for (int i = 1; i < 12; ++i) torn += came[i] == came[0] ? 0 : 1;
    torn += came[0] > last ? 0 : 1;
    last = came[0];
  }
  CHECK(torn == 0);
  CHECK(exchange.inputs(4) == nullptr);  // there is no new value
  CHECK(exchange.counts().fresh >= 1);
  CHECK(exchange.counts().late >= 1);  // at least the last one is late
  const double values[3] = {0., 1., 7.5};
  exchange.outputs({41, Status::large_turn, kSafeStop, values});
  int status = -1;
  wait_until([&] { return waitpid(child, &status, WNOHANG) == child; }, "the other process");
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("memory that is cut short gives zeros and counts as lost", "[hil]") {
  const std::string file = "/dev/shm/" + own_name();
  std::vector<std::string> many(2000, "x");  // they fill several pages
  for (const int left : {0, 4096}) {
    SharedExchange exchange(own_name(), {many, many, 1e6, -1});
    const std::vector<double> values(many.size(), 1.);
    CHECK_FALSE(exchange.lost());
    REQUIRE(truncate(file.c_str(), left) == 0);
    exchange.outputs({0, Status::ok, 0, values.data()});
    CHECK(exchange.lost());
    CHECK(exchange.inputs(1) == nullptr);
    exchange.outputs({1, Status::ok, 0, values.data()});
  }
  CHECK(access(file.c_str(), F_OK) != 0);
}

TEST_CASE("the shared memory describes its content and is removed with the exchange", "[hil]") {
  const std::string path = "/dev/shm/" + own_name();
  {
    const SharedExchange exchange(own_name(), kLayout);
    const int file = open(path.c_str(), O_RDONLY);
    REQUIRE(file >= 0);
    std::uint64_t head[kSharedHead];
    CHECK(read(file, head, sizeof head) == sizeof head);
    // Blocks of 4 and 6 words with their locks, on lines of 64 bytes.
    const std::uint64_t want[] = {0x316d68736c696172ULL, 1, 1, 3, 64, 128, 192, 28};
    for (std::size_t i = 0; i < kSharedHead; ++i) CHECK(head[i] == want[i]);
    std::string names(28, ' ');
    CHECK(pread(file, names.data(), 28, 192) == 28);
    CHECK(names == "push.force_n\ntime_s\ny_m\nz_m\n");
    close(file);
    CHECK_THROWS_WITH(SharedExchange(own_name(), kLayout), Contains("E-HIL-12"));
  }
  CHECK(access(path.c_str(), F_OK) != 0);
  for (const char* bad : {"", "a/b", ".hidden", "blank name"})
    CHECK_THROWS_AS(SharedExchange(bad, kLayout), InputError);
}
