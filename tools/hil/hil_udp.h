#pragma once
#include <sys/socket.h>

#include <atomic>
#include <cstdint>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

#include "hil/hil_exchange.h"
#include "hil/hil_mailbox.h"
#include "hil/hil_receiver.h"

namespace railstep {

/// The names and the period of an exchange.
struct ExchangeLayout {
  std::vector<std::string> inputs, outputs;
  double period_ns = 0.;  // of a frame
  int keep_off = -1;      // CPU that the step thread has for itself; -1: none
};

/// Counts of the outputs.
struct SentCounts {
  std::int64_t sent = 0;
  std::int64_t unheard = 0;  // made before anyone had sent inputs
  std::int64_t dropped = 0;  // the queue to the I/O thread, or the socket's, was full
};

/// Inputs and outputs of each frame over UDP (hil_packet.h). A thread of its own holds the socket;
/// outputs go to whoever sent the last inputs that were taken. It looks for outputs every tenth
/// part of a period (20 us to 1 ms), as nothing may wake it from the step thread; inputs wake it.
class UdpExchange : public Exchange {
 public:
  /// Listens on HOST:PORT, or [HOST]:PORT, and starts the thread. Throws InputError.
  UdpExchange(const std::string& address, const ExchangeLayout& layout);
  ~UdpExchange() override;

  const double* inputs(std::int64_t frame) noexcept override;
  void outputs(const FrameOutputs& made) noexcept override;

  /// Sends what is left and ends the thread; the counts are whole after it.
  void finish() noexcept;
  const PacketCounts& received() const noexcept { return receiver_.counts(); }
  SentCounts sent() const noexcept;

 private:
  void serve() noexcept;
  void receive_some() noexcept;
  void send(const FrameOutputs& made, const double* values) noexcept;

  int socket_ = -1;
  timespec wait_{};
  int keep_off_;
  PacketHead head_;
  Receiver receiver_;
  NewestBox inputs_;
  Queue<FrameOutputs> outputs_;
  std::vector<unsigned char> in_, out_;
  sockaddr_storage peer_{};
  socklen_t peer_size_ = 0;  // 0: no one yet
  SentCounts sent_;
  std::int64_t refused_ = 0;  // of the step thread: the queue was full
  std::atomic<std::int64_t> begun_{-1};
  std::atomic<bool> finish_{false};
  std::thread thread_;
};

}  // namespace railstep
