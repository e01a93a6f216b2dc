#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "answer/profile_pair.h"

namespace railstep {

/// conicity[] with amplitude_m, value, without_roll and at_load; rows[] with shift_m,
/// radius_difference_m, roll_rad, and the contact of each wheel; jumps[]; with a load also
/// loaded_rows[] with the patches of each wheel.
nlohmann::ordered_json to_json(const ProfileAnswer& answer);

/// The pair, contacts a millimetre apart, jumps and conicities.
std::string to_table(const ProfileAnswer& answer);

/// A row a shift of the contact that was asked for.
std::string to_csv(const ProfileAnswer& answer);

/// One self-contained HTML page: the pair with its contacts, radius differences, angles, conicities
/// and the patches under the load. Throws Failed where gnuplot fails.
std::string to_html(const ProfileAnswer& answer);

}  // namespace railstep
