#include "report/assessment_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/drawing.h"

namespace railstep {
namespace {

/// The section and the wheel where a quantity is the largest, over its limit if it has one.
struct WorstValue {
  const AssessedValue* value;
  const AssessedSection* section;
};
std::map<Assessed, WorstValue> worst_values(const AssessedVehicle& vehicle) {
  std::map<Assessed, WorstValue> worst;
  for (const AssessedSection& section : vehicle.sections)
    for (const AssessedValue& value : section.values) {
      const auto [at, made] = worst.try_emplace(value.quantity, WorstValue{&value, &section});
      if (!made && against_limit(value) > against_limit(*at->second.value))
        at->second = {&value, &section};
    }
  return worst;
}

std::string in_unit(Assessed quantity, double value) {
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", text_of(quantity).scale * value);
}
std::string place_of(const TrackSection& section) {
  const std::string radius = section.radius == 0. || section.kind == SectionKind::transition
                                 ? ""
                                 : fmt::format(", R {:.4g} m", std::fabs(section.radius));
  return fmt::format("{:.4g} to {:.4g} m, {}{}", section.from, section.to, name_of(section.kind),
                     radius);
}

/// The answer in words.
std::string verdict_of(const AssessedVehicle& vehicle) {
  std::string beyond;
  for (const auto& [quantity, worst] : worst_values(vehicle))
    if (worst.value->value > worst.value->limit)
      beyond += fmt::format("{}{} ({} {}, limit {})", beyond.empty() ? "" : "; ",
                            text_of(quantity).title, in_unit(quantity, worst.value->value),
                            text_of(quantity).unit, in_unit(quantity, worst.value->limit));
  if (vehicle.sections.empty()) return "The vehicle goes less than 2 m: nothing is assessed.";
  return beyond.empty() ? "All quantities with a limit are within it."
                        : "Beyond the limit: " + beyond + ".";
}

std::string worst_table(const AssessedVehicle& vehicle) {
  std::string rows;
  for (const auto& [quantity, worst] : worst_values(vehicle)) {
    const AssessedText& text = text_of(quantity);
    rows += fmt::format(
        "<tr><td>{}, {}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}{}{}</td></tr>\n",
        text.title, text.unit, in_unit(quantity, worst.value->value),
        in_unit(quantity, worst.value->limit), escaped(worst.value->where),
        place_of(*worst.section), text.limit, *text.source == '\0' ? "" : "; ", text.source);
  }
  return "<table>\n<tr><th>largest</th><th>value</th><th>limit</th><th>at</th><th>section</th>"
         "<th>limit is</th></tr>\n" +
         rows + "</table>\n";
}

std::string estimates_table(const AssessedVehicle& vehicle) {
  if (vehicle.estimates.empty()) return {};
  std::string rows;
  for (const EstimatedValue& own : vehicle.estimates)
    rows += fmt::format("<tr><td>{}, {}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        text_of(own.quantity).title, text_of(own.quantity).unit, own.track,
                        own.sections, in_unit(own.quantity, own.estimate),
                        in_unit(own.quantity, own.limit));
  return "<h3>Largest values to expect</h3>\n<p>Mean of the sections and 3 (safety) or 2.2 "
         "standard "
         "deviations between them. EN 14363 asks for at least 25 sections of a kind.</p>\n"
         "<table>\n<tr><th>quantity</th><th>track</th><th>sections</th><th>expected</th>"
         "<th>limit</th></tr>\n" +
         rows + "</table>\n";
}

std::string ride_table(const AssessedVehicle& vehicle) {
  if (vehicle.ride.empty())
    return "<p>Ride is assessed at sensors on the vehicle's bodies, in a run of 5 s or more.</p>\n";
  std::string rows;
  for (const RideComfort& own : vehicle.ride)
    rows += fmt::format(
        "<tr><td>{}</td><td>{:.3g}</td><td>{}</td><td>{:.3g}</td><td>{:.3g}</td><td>{:.3g}</td>"
        "<td>{:.3g}</td></tr>\n",
        escaped(own.sensor), own.comfort, own.blocks, own.weighted_y, own.weighted_z, own.index_y,
        own.index_z);
  return "<h3>Ride</h3>\n<p>N<sub>MV</sub> of EN 12299 without accelerations along x, from blocks "
         "of "
         "5 s (the standard asks for 60), and Sperling's W<sub>z</sub> of comfort.</p>\n"
         "<table>\n<tr><th>sensor</th><th>N MV</th><th>blocks</th><th>across, 95 %, m/s2</th>"
         "<th>upwards, 95 %, m/s2</th><th>Wz across</th><th>Wz upwards</th></tr>\n" +
         rows + "</table>\n";
}

/// The limits of a quantity over the sections, as steps.
std::string limit_steps(const AssessedVehicle& vehicle, Assessed quantity) {
  std::string data;
  for (const AssessedSection& section : vehicle.sections)
    for (const AssessedValue& value : section.values)
      if (value.quantity == quantity && !std::isnan(value.limit))
        data += fmt::format("{0:.6g} {2:.6g}\n{1:.6g} {2:.6g}\n", section.from, section.to,
                            text_of(quantity).scale * value.limit);
  return data;
}

std::string way_script(const AssessedVehicle& vehicle, Assessed quantity) {
  constexpr std::size_t kPoints = 2000;
  const AssessedText& text = text_of(quantity);
  std::string blocks, curves;
  int count = 0;
  for (const AssessedCurve& curve : vehicle.curves) {
    if (curve.quantity != quantity) continue;
    const std::size_t every = curve.place.size() / kPoints + 1;
    blocks += fmt::format("$c{} << EOD\n", count);
    for (std::size_t i = 0; i < curve.place.size(); i += every)
      blocks += fmt::format("{:.6g} {:.6g}\n", curve.place[i], text.scale * curve.value[i]);
    blocks += "EOD\n";
    curves += fmt::format("{}$c{} with lines lw 1.5 dashtype {} title \"{}\"",
                          count == 0 ? "" : ", ", count, 1 + count % 4, curve.where);
    ++count;
  }
  if (count == 0) return {};
  const std::string limit = limit_steps(vehicle, quantity);
  if (!limit.empty())
    curves += ", $limit with lines lw 2 lc rgb 'black' dashtype 2 title \"limit\"";
  return fmt::format(
      "set terminal svg size 900,420 name '{}' noenhanced font 'sans,12'\n"
      "set xlabel 'along the track, m'\nset ylabel '{}, {}'\nset grid\n"
      "set key outside right top vertical\n{}{}plot {}\n",
      text.key, text.title, text.unit, blocks,
      limit.empty() ? "" : "$limit << EOD\n" + limit + "EOD\n", curves);
}

std::string section_table(const AssessedVehicle& vehicle) {
  std::string rows;
  for (const AssessedSection& section : vehicle.sections) {
    std::string values;
    for (const AssessedValue& value : section.values)
      values += fmt::format("{}{} {}", values.empty() ? "" : ", ", text_of(value.quantity).key,
                            in_unit(value.quantity, value.value));
    rows += fmt::format("<tr><td>{}</td><td>{:.4g}</td><td>{:.3g}</td><td>{}</td></tr>\n",
                        place_of(section), section.speed, section.across, values);
  }
  return "<h3>Sections</h3>\n<table>\n<tr><th>section</th><th>speed, m/s</th>"
         "<th>uncompensated, m/s2</th><th>largest values</th></tr>\n" +
         rows + "</table>\n";
}

std::string vehicle_html(const AssessedVehicle& vehicle) {
  std::string html = fmt::format("<h2>Running behaviour of {}</h2>\n<p>{}</p>\n",
                                 escaped(vehicle.name), verdict_of(vehicle));
  if (vehicle.sections.empty()) return html;
  if (!std::isnan(vehicle.nadal))
    html += fmt::format(
        "<p>Nadal's limit of Y/Q by the steepest flank of the wheel and the "
        "friction of the rails: {:.3g}.</p>\n",
        vehicle.nadal);
  html += worst_table(vehicle);
  for (const Assessed quantity :
       {Assessed::sum_y, Assessed::y_over_q, Assessed::q, Assessed::body_y, Assessed::body_z}) {
    const std::string script = way_script(vehicle, quantity);
    if (!script.empty()) html += drawn(script) + "\n";
  }
  return html + ride_table(vehicle) + estimates_table(vehicle) + section_table(vehicle);
}

}  // namespace

std::string behaviour_html(const std::vector<AssessedVehicle>& vehicles) {
  std::string html;
  for (const AssessedVehicle& vehicle : vehicles) html += vehicle_html(vehicle);
  return html;
}

std::string behaviour_text(const std::vector<AssessedVehicle>& vehicles) {
  std::string text;
  for (const AssessedVehicle& vehicle : vehicles) {
    text += fmt::format("{}: {}\n", vehicle.name, verdict_of(vehicle));
    for (const auto& [quantity, worst] : worst_values(vehicle))
      text += fmt::format("  {:<20} {:>9} {:<5} limit {:>6}  {}, {}\n", text_of(quantity).key,
                          in_unit(quantity, worst.value->value), text_of(quantity).unit,
                          in_unit(quantity, worst.value->limit), worst.value->where,
                          place_of(*worst.section));
    for (const RideComfort& own : vehicle.ride)
      text += fmt::format("  {:<20} N_MV {:.3g} of {} blocks, Wz {:.3g} across, {:.3g} upwards\n",
                          own.sensor, own.comfort, own.blocks, own.index_y, own.index_z);
  }
  return text;
}

}  // namespace railstep
