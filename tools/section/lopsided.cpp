#include "section/lopsided.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "text/read.h"

namespace railstep {

double principal_angle(const AreaProperties<double>& area, double product_of_inertia) {
  const double difference = area.inertia_y - area.inertia_z;
  return 0.5 *
         std::atan2(std::copysign(2.0, -difference) * product_of_inertia, std::abs(difference));
}

std::optional<Message> lopsided_warning(const Lopsided& l, const Section& section) {
  constexpr double kFelt = 0.1;
  const double sideways = std::abs(l.product_of_inertia) / section.area.inertia_z;
  const double arm = section.height - section.shear.shear_centre_height;
  const double twisting = std::abs(l.shear_centre_offset) / arm;
  if (!(sideways > kFelt) && !(twisting > kFelt)) return std::nullopt;
  std::string sentence = fmt::format(
      "the outline is lopsided, and its section of three rectangles is not: a vertical force bends "
      "the outline sideways by Iyz/Iz = {:.2g} of its deflection",
      sideways);
  if (std::isfinite(twisting))
    sentence += fmt::format(
        "; at the middle of the foot, {:.1f} mm beside the shear centre, the force twists the "
        "outline as a lateral force of {:.2g} times its size at the crown does",
        1e3 * std::abs(l.shear_centre_offset), twisting);
  return Message(
      "W-SECTION-01",
      sentence + fmt::format("; the centroid lies {:.1f} mm beside the middle of the foot",
                             1e3 * std::abs(l.centroid_offset)));
}

std::optional<Lopsided> read_lopsided(const std::filesystem::path& file) {
  const std::optional<Table> t = read_toml(file).table_if("asymmetry");
  if (!t) return std::nullopt;
  const auto number = [&t](const char* key) {
    return t->number(key, any_number(), std::numeric_limits<double>::quiet_NaN());
  };
  return Lopsided{number("share_of_area"), number("product_of_inertia_m4"),
                  number("centroid_offset_m"), number("shear_centre_offset_m")};
}

}  // namespace railstep
