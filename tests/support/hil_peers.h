#pragma once
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "hil/hil_shm.h"
#include "hil/hil_udp.h"
#include "support/loopback.h"

namespace railstep {

using Values = std::vector<double>;

/// The vehicle's end of an exchange of packets.
struct Peer {
  virtual ~Peer() = default;
  virtual void send(std::int64_t frame, const Values& values) = 0;
  /// @returns the frame whose outputs came, -2 if none came
  virtual std::int64_t receive(Values& values) = 0;
};

class UdpPeer : public Peer {
 public:
  UdpPeer(const ExchangeLayout& layout, std::uint16_t port) : layout_(layout), port_(port) {}

  void send(std::int64_t frame, const Values& values) override {
    Bytes bytes(packet_bytes(values.size()));
    encode({.kind = PacketKind::inputs,
            .names = names_sum(layout_.inputs),
            .count = static_cast<std::uint32_t>(values.size()),
            .sequence = ++sequence_,
            .frame = frame},
           values.data(), bytes.data());
    socket_.send(bytes, port_);
  }
  std::int64_t receive(Values& values) override {
    const auto head = decode(socket_.receive(), PacketKind::outputs, names_sum(layout_.outputs),
                             static_cast<std::uint32_t>(values.size()), values.data());
    return head ? head->frame : -2;
  }

 private:
  const ExchangeLayout& layout_;
  std::uint16_t port_;
  LoopbackSocket socket_;
  std::uint64_t sequence_ = 0;
};

class SharedPeer : public Peer {
 public:
  SharedPeer(const ExchangeLayout& layout, const std::string& name)
      : in_(kBlockHead + layout.inputs.size()), out_(kBlockHead + layout.outputs.size()) {
    const int file = shm_open(("/" + name).c_str(), O_RDWR, 0);
    REQUIRE(file >= 0);
    struct stat about {};
    fstat(file, &about);
    bytes_ = static_cast<std::size_t>(about.st_size);
    word_ = static_cast<SeqLock::Word*>(
        mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    close(file);
  }
  SharedPeer(const SharedPeer&) = delete;
  SharedPeer& operator=(const SharedPeer&) = delete;
  ~SharedPeer() override { munmap(word_, bytes_); }

  void send(std::int64_t frame, const Values& values) override {
    ++in_[0];
    in_[1] = static_cast<std::uint64_t>(frame);
    std::memcpy(&in_[kBlockHead], values.data(), 8 * values.size());
    SeqLock(word_ + word_[4].load() / 8, in_.size()).write(in_.data());
  }
  std::int64_t receive(Values& values) override {
    const SeqLock from(word_ + word_[5].load() / 8, out_.size());
    std::uint64_t seen = 0;
    for (const Deadline deadline; !deadline.passed();) {
      if (from.number() != seen_ && from.read(out_.data(), 8, seen)) {
        seen_ = seen;
        std::memcpy(values.data(), &out_[kBlockHead], 8 * values.size());
        return static_cast<std::int64_t>(out_[1]);
      }
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return -2;
  }

 private:
  std::vector<std::uint64_t> in_, out_;
  SeqLock::Word* word_ = nullptr;
  std::size_t bytes_ = 0;
  std::uint64_t seen_ = 0;
};

}  // namespace railstep
