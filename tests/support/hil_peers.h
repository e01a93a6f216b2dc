#pragma once
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "hil/hil_shm.h"
#include "hil/hil_udp.h"

namespace railstep {

using Values = std::vector<double>;

/// A UDP port of the loopback that was free a moment ago.
inline std::uint16_t free_port() {
  const int file = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  REQUIRE(bind(file, reinterpret_cast<const sockaddr*>(&at), size) == 0);
  getsockname(file, reinterpret_cast<sockaddr*>(&at), &size);
  close(file);
  return ntohs(at.sin_port);
}

/// The vehicle's end of an exchange of packets.
struct Peer {
  virtual ~Peer() = default;
  virtual void send(std::int64_t frame, const Values& values) = 0;
  /// @returns the frame whose outputs came, -2 if none came
  virtual std::int64_t receive(Values& values) = 0;
};

class UdpPeer : public Peer {
 public:
  UdpPeer(const ExchangeLayout& layout, std::uint16_t port)
      : layout_(layout), file_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{60, 0};
    setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    REQUIRE(connect(file_, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0);
  }
  UdpPeer(const UdpPeer&) = delete;
  UdpPeer& operator=(const UdpPeer&) = delete;
  ~UdpPeer() override { close(file_); }

  void send(std::int64_t frame, const Values& values) override {
    std::vector<unsigned char> bytes(packet_bytes(values.size()));
    encode({.kind = PacketKind::inputs,
            .names = names_sum(layout_.inputs),
            .count = static_cast<std::uint32_t>(values.size()),
            .sequence = ++sequence_,
            .frame = frame},
           values.data(), bytes.data());
    static_cast<void>(::send(file_, bytes.data(), bytes.size(), 0));
  }
  std::int64_t receive(Values& values) override {
    unsigned char bytes[4096];
    const ssize_t got = recv(file_, bytes, sizeof bytes, 0);
    const auto head = decode({bytes, static_cast<std::size_t>(std::max<ssize_t>(got, 0))},
                             PacketKind::outputs, names_sum(layout_.outputs),
                             static_cast<std::uint32_t>(values.size()), values.data());
    return head ? head->frame : -2;
  }

 private:
  const ExchangeLayout& layout_;
  int file_;
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
    for (int n = 0; n < 600'000; ++n) {
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
