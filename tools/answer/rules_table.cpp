#include "answer/rules_table.h"

#include <fmt/core.h>

#include <cmath>

namespace railstep {
namespace {

using nlohmann::ordered_json;

std::string section_rule(int points) {
  return points == 0 ? "moments" : fmt::format("{0}x{0}", points);
}

std::string coupling_place(Coupling coupling) {
  switch (coupling) {
    case Coupling::centroid:
      return "centroid";
    case Coupling::axis:
      return "reference line";
    case Coupling::none:
      return "none";
    case Coupling::section:
      break;
  }
  return "section";
}

std::string shear_form(Shear shear) {
  switch (shear) {
    case Shear::twist:
      return "twist";
    case Shear::factors:
      return "factors";
    case Shear::offset:
      return "offset";
    case Shear::published:
      break;
  }
  return "published";
}

ordered_json number(double value) { return std::isfinite(value) ? ordered_json(value) : nullptr; }

/// A relative error in percent; what round-off alone explains is 0.
std::string percent(double error) {
  if (std::isnan(error)) return "singular";
  if (std::abs(error) < 1e-9) return "0";
  return fmt::format("{:+.3g}", 100. * error);
}

/// The first rule's row among those from `first` on; null where it is not there.
const StudyRow* at(const std::vector<StudyRow>& rows, std::size_t first, double poisson,
                   int elements, const char* load) {
  for (std::size_t i = first; i < rows.size() && rows[i].rule.name == rows[first].rule.name; ++i)
    if (rows[i].poisson == poisson && rows[i].elements == elements && rows[i].load == load)
      return &rows[i];
  return nullptr;
}

std::string error_of(const StudyRow* row) { return row ? percent(row->tip_error) : ""; }

}  // namespace

ordered_json to_json(const StudyRow& row) {
  const StudyRule& rule = row.rule.rule;
  const ElementRule& e = rule.element;
  return {{"family", row.rule.family},
          {"rule", row.rule.name},
          {"axial_points", e.axial_points},
          {"coupling_points", e.coupling_points == 0 ? e.axial_points : e.coupling_points},
          {"section_rule", section_rule(rule.section_points)},
          {"coupling", coupling_place(e.coupling)},
          {"reference_height_m", number(rule.reference_height)},
          {"shear", shear_form(e.shear)},
          {"poisson", row.poisson},
          {"elements", row.elements},
          {"load", row.load},
          {"load_x_m", row.load_x},
          {"tip_error", number(row.tip_error)},
          {"twist_error", number(row.twist_error)},
          {"rank_deficiency", row.rank_deficiency},
          {"negative_eigenvalues", row.negative_eigenvalues},
          {"gauss_points", row.cost.gauss_points},
          {"force_flops", row.cost.force_flops},
          {"force_us", row.cost.force_us},
          {"tangent_us", row.cost.tangent_us}};
}

std::string to_csv(const std::vector<StudyRow>& rows) {
  std::string text;
  for (const StudyRow& row : rows) {
    const ordered_json cells = to_json(row);
    if (text.empty()) {
      for (const auto& [key, value] : cells.items()) text += (text.empty() ? "" : ",") + key;
      text += '\n';
    }
    std::string line;
    for (const auto& [key, value] : cells.items()) {
      if (key != "family") line += ',';
      if (value.is_string())
        line += value.get<std::string>();  // none holds a comma
      else if (value.is_number_float())
        line += fmt::format("{:.17g}", value.get<double>());
      else if (!value.is_null())
        line += value.dump();
    }
    text += line + '\n';
  }
  return text;
}

std::string to_table(const std::vector<StudyRow>& rows) {
  std::string text = fmt::format(
      "Cantilever of section F, {:g} m: error of the deflection under the load, percent (below 0: "
      "too stiff)\n\n"
      "{:<36} {:>29} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>9} {:>6} {:>6} {:>6}\n"
      "{:<36} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>9} {:>6} {:>6} {:>6}\n",
      study::kLength, "", "load at the tip, nu 0.3", "nu 0.499", "between", "twist", "bending",
      "twist", "zero", "negative", "Gauss", "force", "force", "elements", 1, 2, 4, 4, 4, 4,
      "large, 8", "large, 8", "modes", "modes", "points", "flops", "us");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0 && rows[i].rule.name == rows[i - 1].rule.name) continue;
    const StudyRow& row = *at(rows, i, .3, 4, "tip node");
    const auto tip = [&](double nu, int n) { return error_of(at(rows, i, nu, n, "tip node")); };
    text += fmt::format(
        "{:<36} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>6} {:>9} {:>6} {:>6} {:>6.2f}\n",
        row.rule.name, tip(.3, 1), tip(.3, 2), tip(.3, 4), tip(.499, 4),
        error_of(at(rows, i, .3, 4, "between nodes")), percent(row.twist_error),
        error_of(at(rows, i, .3, 8, "large bending")), error_of(at(rows, i, .3, 8, "large twist")),
        6 + row.rank_deficiency, row.negative_eigenvalues, row.cost.gauss_points,
        row.cost.force_flops, row.cost.force_us);
  }
  return text;
}

}  // namespace railstep
