#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "support/wait.h"

namespace railstep {

using Bytes = std::vector<unsigned char>;

/// A UDP socket on the loopback with a port of its own.
class LoopbackSocket {
 public:
  LoopbackSocket() : file_(socket(AF_INET, SOCK_DGRAM, 0)) {
    const sockaddr_in any = place(0);
    REQUIRE(bind(file_, reinterpret_cast<const sockaddr*>(&any), sizeof any) == 0);
    const timeval patience{kPatience.count(), 0};
    setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  LoopbackSocket(const LoopbackSocket&) = delete;
  LoopbackSocket& operator=(const LoopbackSocket&) = delete;
  ~LoopbackSocket() { close(file_); }

  std::uint16_t port() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(file_, reinterpret_cast<sockaddr*>(&own), &size);
    return ntohs(own.sin_port);
  }
  std::string address() const { return "127.0.0.1:" + std::to_string(port()); }

  /// Sends a packet to a port; nobody has to listen there.
  void send(const Bytes& bytes, std::uint16_t port) const {
    const sockaddr_in to = place(port);
    static_cast<void>(sendto(file_, bytes.data(), bytes.size(), 0,
                             reinterpret_cast<const sockaddr*>(&to), sizeof to));
  }
  /// @returns the next packet, or an empty one if none comes in time
  Bytes receive() const {
    Bytes bytes(65536);
    const ssize_t got = recv(file_, bytes.data(), bytes.size(), 0);
    bytes.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return bytes;
  }

 private:
  static sockaddr_in place(std::uint16_t port) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(port);
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return at;
  }
  int file_;
};

/// A port that was free a moment ago.
inline std::uint16_t free_port() { return LoopbackSocket().port(); }

}  // namespace railstep
