#include "hil/hil_signals.h"

#include <csignal>

#include "hil/hil_shm.h"

namespace railstep {

std::atomic<bool> interrupted_by_signal{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void end_on_signals() {
  struct sigaction action {};
  action.sa_handler = [](int number) {
    if (!interrupted_by_signal.exchange(true)) return;
    SharedExchange::unlink_at_once();
    std::signal(number, SIG_DFL);
    std::raise(number);
  };
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace railstep
