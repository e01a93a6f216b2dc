#pragma once
#include <nlohmann/json.hpp>

namespace railstep {

/// Prints what `railstep hil --json` prints, as a table: rate, frames, overruns, times in us and
/// counts of packets.
void print_hil_table(const nlohmann::ordered_json& told);

}  // namespace railstep
