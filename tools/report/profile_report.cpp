#include "report/profile_report.h"

#include <fmt/core.h>

#include <cmath>

#include "report/drawing.h"
#include "report/profile_plots.h"

namespace railstep {
namespace {

using Json = nlohmann::ordered_json;

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

double degrees(double angle) { return angle * 180. / M_PI; }

/// Rows of the text and of the report, a millimetre apart.
bool is_whole_millimetre(double shift) {
  return std::abs(1e3 * shift - std::round(1e3 * shift)) < 1e-6;
}

Json patches_of(const WheelLoaded& wheel) {
  Json list = Json::array();
  for (const WheelPatch& p : wheel.patches)
    list.push_back({{"wheel_m", p.centre.on_wheel},
                    {"angle_rad", p.centre.angle},
                    {"normal_n", p.force.normal},
                    {"approach_m", p.approach},
                    {"half_length_m", p.force.half_length},
                    {"half_width_m", p.force.half_width},
                    {"pressure_pa", p.force.pressure}});
  return list;
}

std::string conicity_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", *value) : "-";
}

std::string place_text(const ProfileAnswer& a) {
  const ProfileRequest& r = a.request;
  return fmt::format(
      "{} on {}, inclination {}, gauge {:.4g} mm, wheels {:.5g} mm back to back, radius {:.4g} mm",
      a.wheel.name, a.rail.name,
      r.inclination > 0. ? fmt::format("1:{:.4g}", 1. / r.inclination) : "0", 1e3 * r.gauge,
      1e3 * r.back_to_back, 1e3 * r.radius);
}

std::string smoothing_text(const char* what, const std::optional<Smoothing>& s) {
  if (!s) return "";
  return fmt::format(
      "{}: smoothed points, {:.4g} mm rms (tolerance {:.4g} mm), {:.4g} mm at most\n", what,
      1e3 * s->rms, 1e3 * s->tolerance, 1e3 * s->largest);
}

/// Amplitudes of the text and of the report's table.
bool is_listed(const ConicityRow& row) {
  return row.amplitude < .6e-3 ? row.amplitude > .4e-3 : is_whole_millimetre(row.amplitude);
}

}  // namespace

Json to_json(const ProfileAnswer& a) {
  Json json;
  for (const ConicityRow& row : a.conicity)
    json["conicity"].push_back({{"amplitude_m", row.amplitude},
                                {"value", number_or_null(a.of(row))},
                                {"without_roll", number_or_null(row.level)},
                                {"at_load", number_or_null(row.loaded)}});
  for (const WheelsetTouch& t : a.rows())
    json["rows"].push_back({{"shift_m", t.shift},
                            {"radius_difference_m", t.radius_difference()},
                            {"roll_rad", t.roll},
                            {"wheel_right_m", t.right.on_wheel},
                            {"wheel_left_m", t.left.on_wheel},
                            {"rail_right_m", t.right.on_rail},
                            {"rail_left_m", t.left.on_rail},
                            {"angle_right_rad", t.right.angle},
                            {"angle_left_rad", t.left.angle}});
  json["jumps"] = Json::array();
  for (const ContactJump& jump : a.jumps)
    json["jumps"].push_back(
        {{"shift_m", jump.shift}, {"wheel_from_m", jump.from}, {"wheel_to_m", jump.to}});
  for (const WheelsetLoaded& w : a.loaded)
    json["loaded_rows"].push_back({{"shift_m", w.shift},
                                   {"radius_difference_m", w.radius_difference()},
                                   {"roll_rad", w.roll},
                                   {"right", patches_of(w.right)},
                                   {"left", patches_of(w.left)}});
  return json;
}

std::string to_table(const ProfileAnswer& a) {
  std::string text = place_text(a) + '\n';
  text += smoothing_text("wheel", a.wheel.smoothing) + smoothing_text("rail", a.rail.smoothing);
  text += fmt::format("rigid contact{}\n{:>9}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n",
                      a.request.roll ? "" : ", the wheelset level", "shift, mm", "dr, mm",
                      "roll, mrad", "s right, mm", "s left, mm", "right, deg", "left, deg");
  for (const WheelsetTouch& t : a.rows())
    if (is_whole_millimetre(t.shift))
      text += fmt::format("{:>9.0f}{:>12.4f}{:>12.4f}{:>12.3f}{:>12.3f}{:>12.3f}{:>12.3f}\n",
                          1e3 * t.shift, 1e3 * t.radius_difference(), 1e3 * t.roll,
                          1e3 * t.right.on_wheel, 1e3 * t.left.on_wheel, degrees(t.right.angle),
                          degrees(t.left.angle));
  for (const ContactJump& jump : a.jumps)
    text += fmt::format("the right contact jumps at {:.3f} mm from s = {:.2f} to {:.2f} mm\n",
                        1e3 * jump.shift, 1e3 * jump.from, 1e3 * jump.to);
  text += fmt::format("equivalent conicity (EN 15302)\n{:>13}{:>12}{:>14}{}\n", "amplitude, mm",
                      "rigid", "without roll",
                      a.loaded.empty() ? "" : fmt::format("{:>16.4g} kN", 1e-3 * a.request.load));
  for (const ConicityRow& row : a.conicity) {
    if (!is_listed(row)) continue;
    text += fmt::format("{:>13.4g}{:>12}{:>14}", 1e3 * row.amplitude, conicity_text(row.rigid),
                        conicity_text(row.level));
    if (!a.loaded.empty()) text += fmt::format("{:>19}", conicity_text(row.loaded));
    text += '\n';
  }
  return text;
}

std::string to_csv(const ProfileAnswer& a) {
  std::string text =
      "shift_m,radius_difference_m,roll_rad,wheel_right_m,wheel_left_m,rail_right_m,rail_left_m,"
      "angle_right_rad,angle_left_rad\n";
  for (const WheelsetTouch& t : a.rows())
    text += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n",
                        t.shift, t.radius_difference(), t.roll, t.right.on_wheel, t.left.on_wheel,
                        t.right.on_rail, t.left.on_rail, t.right.angle, t.left.angle);
  return text;
}

namespace {

std::string answer_in_words(const ProfileAnswer& a) {
  std::string text;
  for (const ConicityRow& row : a.conicity)
    if (std::abs(row.amplitude - 3e-3) < 1e-9) {
      text += fmt::format("Equivalent conicity at 3 mm: <b>{}</b>", conicity_text(row.rigid));
      text += fmt::format(" with roll, {} without", conicity_text(row.level));
      if (!a.loaded.empty())
        text += fmt::format(", {} under {:.4g} kN a wheel", conicity_text(row.loaded),
                            1e-3 * a.request.load);
      text += ". ";
    }
  std::string at;
  for (const ContactJump& jump : a.jumps)
    if (jump.shift > 0.)
      at += fmt::format("{}{:.2f} mm (from {:.1f} to {:.1f} mm on the wheel)",
                        at.empty() ? "" : ", ", 1e3 * jump.shift, 1e3 * jump.from, 1e3 * jump.to);
  if (!at.empty()) text += "The contact of the right wheel jumps at shifts of " + at + ". ";
  return text;
}

std::string conicity_table(const ProfileAnswer& a) {
  std::string rows;
  for (const ConicityRow& row : a.conicity)
    if (is_listed(row))
      rows += fmt::format(
          "<tr><td>{:.4g}</td><td>{}</td><td>{}</td>{}</tr>\n", 1e3 * row.amplitude,
          conicity_text(row.rigid), conicity_text(row.level),
          a.loaded.empty() ? "" : fmt::format("<td>{}</td>", conicity_text(row.loaded)));
  return fmt::format(
      "<table><tr><th>amplitude, mm</th><th>rigid, with roll</th><th>rigid, without roll</th>{}"
      "</tr>\n{}</table>\n",
      a.loaded.empty() ? "" : fmt::format("<th>{:.4g} kN a wheel</th>", 1e-3 * a.request.load),
      rows);
}

std::string patch_rows(double shift, const char* side, const WheelLoaded& wheel) {
  std::string rows;
  for (const WheelPatch& p : wheel.patches)
    rows += fmt::format(
        "<tr><td>{:.0f}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:.1f}</td><td>{:.4f}</td>"
        "<td>{:.2f}</td><td>{:.2f}</td><td>{:.0f}</td></tr>\n",
        1e3 * shift, side, 1e3 * p.centre.on_wheel, degrees(p.centre.angle), 1e-3 * p.force.normal,
        1e3 * p.approach, 1e3 * p.force.half_length, 1e3 * p.force.half_width,
        1e-6 * p.force.pressure);
  return rows;
}

std::string patch_table(const ProfileAnswer& a) {
  if (a.loaded.empty()) return "";
  std::string rows;
  for (const WheelsetLoaded& w : a.loaded)
    if (is_whole_millimetre(w.shift) && w.shift > -1e-9)
      rows += patch_rows(w.shift, "right", w.right) + patch_rows(w.shift, "left", w.left);
  return fmt::format(
      "<h2>Contact patches under {:.4g} kN a wheel</h2>\n<p>Normal forces by strips (Kik and "
      "Piotrowski), each patch by itself; steel on steel.</p>\n<table><tr><th>shift, mm</th>"
      "<th>wheel</th><th>s, mm</th><th>angle, degrees</th><th>N, kN</th><th>approach, mm</th>"
      "<th>a, mm</th><th>b, mm</th><th>pressure, MPa</th></tr>\n{}</table>\n",
      1e-3 * a.request.load, rows);
}

}  // namespace

std::string to_html(const ProfileAnswer& a) {
  const std::string title = fmt::format("{} on {}", a.wheel.name, a.rail.name);
  std::string smoothing;
  for (const std::string& line :
       {smoothing_text("Wheel", a.wheel.smoothing), smoothing_text("Rail", a.rail.smoothing)})
    if (!line.empty()) smoothing += fmt::format("<p>{}</p>\n", escaped(line));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n<p>{2}.</p>\n<p>{3}</p>\n{4}"
      "<h2>Contacts of the right wheel</h2>\n<p>Lines join the places on wheel and rail that "
      "touch, "
      "from a shift of {5:.3g} to {6:.3g} mm; the wheel is drawn 10 mm higher.</p>\n{7}\n"
      "<h2>Difference of the rolling radii</h2>\n{8}\n<h2>Contact angles</h2>\n{9}\n"
      "<h2>Roll of the wheelset</h2>\n{10}\n<h2>Equivalent conicity</h2>\n<p>EN 15302: the cone "
      "with "
      "the wavelength that a wheelset without mass has on these profiles. Where there is no value "
      "the "
      "wheelset has no wave of this amplitude within the shifts.</p>\n{11}\n{12}{13}"
      "<p>Profiles: {14} ({15}); {16} ({17}).</p>\n</body>\n</html>\n",
      escaped(title), kReportStyle, escaped(place_text(a)), answer_in_words(a), smoothing,
      -1e3 * a.request.range, 1e3 * a.request.range, plot_of_contacts(a), plot_of_radii(a),
      plot_of_angles(a), plot_of_roll(a), plot_of_conicity(a), conicity_table(a), patch_table(a),
      escaped(a.wheel.name), escaped(a.wheel.source), escaped(a.rail.name), escaped(a.rail.source));
}

}  // namespace railstep
