#include "hil/hil_udp.h"

#include <fmt/core.h>
#include <netdb.h>
#include <poll.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>

#include "hil/hil_pace.h"
#include "hil/hil_realtime.h"
#include "text/read.h"

namespace railstep {
namespace {

constexpr std::size_t kQueued = 256;  // frames
constexpr int kMostReads = 64;        // packets before outputs have their turn again

struct Endpoint {
  std::string host, port;
};

Endpoint endpoint_of(const std::string& address) {
  const auto refuse = [&] {
    throw InputError("E-HIL-13", fmt::format("--udp {}: this is not an address; expected HOST:PORT "
                                             "or [HOST]:PORT with a port from 1 to 65535",
                                             address));
  };
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0) refuse();
  Endpoint found{address.substr(0, colon), address.substr(colon + 1)};
  if (found.host.front() == '[' && found.host.back() == ']')
    found.host = found.host.substr(1, found.host.size() - 2);
  else if (found.host.find(':') != std::string::npos)
    refuse();
  int port = 0;
  const char* const end = found.port.data() + found.port.size();
  const auto [stop, error] = std::from_chars(found.port.data(), end, port);
  if (found.host.empty() || error != std::errc{} || stop != end || port < 1 || port > 65535)
    refuse();
  return found;
}

int listening_socket(const std::string& address) {
  const Endpoint at = endpoint_of(address);
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = SOCK_DGRAM;
  wanted.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  const int looked_up = getaddrinfo(at.host.c_str(), at.port.c_str(), &wanted, &found);
  if (looked_up != 0)
    throw InputError("E-HIL-14", fmt::format("--udp {}: the host has no address: {}", address,
                                             gai_strerror(looked_up)));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
  const int socket = ::socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket >= 0 && bind(socket, found->ai_addr, found->ai_addrlen) == 0) return socket;
  const int reason = errno;
  if (socket >= 0) close(socket);
  throw InputError("E-HIL-15",
                   fmt::format("--udp {}: the program cannot receive at this address: {}", address,
                               std::strerror(reason)));
}

/// FNV-1a: one sender, one number.
std::uint64_t number_of(const sockaddr_storage& address, socklen_t size) noexcept {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(&address);
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (socklen_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3ULL;
  return hash;
}

timespec wait_of(double period_ns) noexcept {
  return {0, static_cast<long>(std::clamp(.1 * period_ns, 20e3, 1e6))};
}

}  // namespace

UdpExchange::UdpExchange(const std::string& address, const ExchangeLayout& layout)
    : socket_(listening_socket(address)),
      wait_(wait_of(layout.period_ns)),
      keep_off_(layout.keep_off),
      head_{.kind = PacketKind::outputs,
            .names = names_sum(layout.outputs),
            .count = static_cast<std::uint32_t>(layout.outputs.size())},
      receiver_(names_sum(layout.inputs), static_cast<std::uint32_t>(layout.inputs.size())),
      inputs_(layout.inputs.size()),
      outputs_(kQueued, layout.outputs.size()),
      in_(packet_bytes(layout.inputs.size()) + 1),  // one more: too long ones show
      out_(packet_bytes(layout.outputs.size())),
      thread_([this] { serve(); }) {}

UdpExchange::~UdpExchange() {
  finish();
  close(socket_);
}

void UdpExchange::finish() noexcept {
  finish_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

const double* UdpExchange::inputs(std::int64_t frame) noexcept {
  begun_.store(frame, std::memory_order_relaxed);
  return inputs_.take();
}

void UdpExchange::outputs(const FrameOutputs& made) noexcept {
  if (!outputs_.put(made, made.values)) ++refused_;
}

SentCounts UdpExchange::sent() const noexcept {
  SentCounts all = sent_;
  all.dropped += refused_;
  return all;
}

void UdpExchange::serve() noexcept {
  if (keep_off_ >= 0) railstep::keep_off(keep_off_);
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  for (bool last = false; !last;) {
    last = finish_.load(std::memory_order_acquire);  // before the queue is emptied once more
    pollfd ready{socket_, POLLIN, 0};
    if (!last && ppoll(&ready, 1, &wait_, nullptr) > 0) receive_some();
    while (outputs_.take(
        [this](const FrameOutputs& made, const double* values) { send(made, values); })) {
    }
  }
}

void UdpExchange::receive_some() noexcept {
  for (int n = 0; n < kMostReads; ++n) {
    sockaddr_storage from{};
    socklen_t size = sizeof from;
    const ssize_t got =
        recvfrom(socket_, in_.data(), in_.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (got < 0) return;
    if (!receiver_.take({in_.data(), static_cast<std::size_t>(got)}, number_of(from, size),
                        MonotonicClock{}.now(), begun_.load(std::memory_order_relaxed),
                        inputs_.blank()))
      continue;
    inputs_.put();
    peer_ = from;
    peer_size_ = size;
  }
}

void UdpExchange::send(const FrameOutputs& made, const double* values) noexcept {
  if (peer_size_ == 0) {
    ++sent_.unheard;
    return;
  }
  ++head_.sequence;
  head_.frame = made.frame;
  head_.status = static_cast<std::uint32_t>(made.status);
  head_.flags = made.flags;
  encode(head_, values, out_.data());
  const ssize_t gone = sendto(socket_, out_.data(), out_.size(), 0,
                              reinterpret_cast<const sockaddr*>(&peer_), peer_size_);
  ++(gone == static_cast<ssize_t>(out_.size()) ? sent_.sent : sent_.dropped);
}

}  // namespace railstep
