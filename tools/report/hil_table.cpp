#include "report/hil_table.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>
#include <string>

namespace railstep {
namespace {

void print_quantiles(const char* name, const nlohmann::ordered_json& us) {
  if (us["max"].is_null() || std::isnan(us["max"].get<double>())) return;
  fmt::print("{}{:9.2f} {:9.2f} {:9.2f} {:9.2f} {:9.2f}\n", name, us["median"].get<double>(),
             us["p99"].get<double>(), us["p99_9"].get<double>(), us["p99_99"].get<double>(),
             us["max"].get<double>());
}

}  // namespace

void print_hil_table(const nlohmann::ordered_json& told) {
  fmt::print("rate                      {:g} Hz, a frame simulates {:g} s: {:g} of real time\n",
             told["rate_hz"].get<double>(), told["frame_length_s"].get<double>(),
             told["real_time_factor"].get<double>());
  fmt::print("frames                    {}, skipped {}\n", told["frames"].get<std::int64_t>(),
             told["skipped"].get<std::int64_t>());
  fmt::print("overrun count             {} under policy {}, {} in the first {} frames\n",
             told["overruns"].get<std::int64_t>(), told["policy"].get<std::string>(),
             told["grace_overruns"].get<std::int64_t>(), told["grace_frames"].get<std::int64_t>());
  fmt::print("us                           median       p99     p99.9    p99.99       max\n");
  print_quantiles("task execution time      ", told["frame_us"]);
  print_quantiles("  of an empty step       ", told["empty_loop"]["frame_us"]);
  print_quantiles("wake-up latency          ", told["wakeup_us"]);
  print_quantiles("  of an empty step       ", told["empty_loop"]["wakeup_us"]);
  for (const char* key : {"packets", "shared_memory"}) {
    if (!told.contains(key)) continue;
    fmt::print("{:<26}", key);
    const char* comma = "";
    for (const auto& [name, count] : told[key].items()) {
      fmt::print("{}{} {}", comma, name, count.get<std::int64_t>());
      comma = ", ";
    }
    fmt::print("\n");
  }
  fmt::print("allocations               {}\nstate hash                {}\n",
             told["allocations"].get<std::int64_t>(), told["state_hash"].get<std::string>());
}

}  // namespace railstep
