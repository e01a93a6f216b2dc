#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hil/hil_latency.h"

namespace railstep {

/// A distribution as a report names it.
struct NamedLatency {
  const char* name;
  const Latency* times;
};

/// Histogram of times: bins of 1 us, both axes logarithmic, so that what is rare and what is late
/// show. One colour each, drawn one over the other; what is 100 ms or longer stands in one bin at
/// the right end.
std::string histogram_svg(const std::vector<NamedLatency>& shown);

/// A page with what `railstep hil --json` prints, and histograms of frame time and wake-up latency,
/// each over that of the empty loop.
std::string hil_report(const std::string& title, const nlohmann::ordered_json& result,
                       const std::vector<NamedLatency>& frame,
                       const std::vector<NamedLatency>& wakeup);

/// Quantiles of a distribution, us: median, p99, p99_9, p99_99, max.
nlohmann::ordered_json quantiles(const Latency& times);

}  // namespace railstep
