#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "answer/scene_receptance.h"

namespace railstep {

/// frequency_hz, magnitude_m_per_n and phase_rad of the model that answers, and what else was
/// asked.
nlohmann::ordered_json to_json(const ReceptanceAnswer& answer);

/// The frequencies, then resonances, decay rates and warnings.
std::string to_table(const ReceptanceAnswer& answer);

/// A row a frequency: frequency_hz, then <model>.magnitude_m_per_n and <model>.phase_rad of each,
/// and end_effect where there is one.
std::string to_csv(const ReceptanceAnswer& answer);

/// One self-contained HTML page with plots of magnitude and phase, and of decay rates. Throws
/// Failed where gnuplot fails.
std::string to_html(const ReceptanceAnswer& answer, const std::string& title);

}  // namespace railstep
