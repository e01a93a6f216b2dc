#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "commands/command.h"
#include "commands/options.h"
#include "report/fit_report.h"
#include "section/fit_profile.h"
#include "section/section_file.h"
#include "text/remarks.h"
#include "text/write.h"

namespace railstep {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct FitOptions {
  std::string profile, unit, target, out, report;
  double head_width = kNone;
  bool json = false;
};

double target_value(const std::string& key, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value) || value <= 0.0)
    throw InputError("E-FIT-01",
                     fmt::format("--target: {} = '{}' is not a finite number above 0", key, text));
  return value;
}

/// "area_m2=8.7e-3,inertia_y_m4=..." with each of the five keys once.
FitTargets parse_targets(const std::string& text) {
  FitTargets t{{kNone, kNone, kNone, kNone}, kNone};
  const std::vector<std::pair<std::string, double*>> keys = {
      {"area_m2", &t.area.area},
      {"inertia_y_m4", &t.area.inertia_y},
      {"inertia_z_m4", &t.area.inertia_z},
      {"centroid_height_m", &t.area.centroid_height},
      {"height_m", &t.height}};
  std::vector<std::string> names;
  names.reserve(keys.size());
  for (const auto& [name, value] : keys) names.push_back(name);
  for (const std::string& part : CLI::detail::split(text, ',')) {
    const std::size_t equals = part.find('=');
    if (equals == part.npos)
      throw InputError(
          "E-FIT-02", fmt::format("--target: '{}' is not an assignment; expected key=value", part));
    const std::string key = part.substr(0, equals);
    double* place = nullptr;
    for (const auto& [name, value] : keys)
      if (name == key) place = value;
    if (!place)
      throw InputError("E-FIT-03", fmt::format("--target: unknown key '{}'; did you mean '{}'?",
                                               key, nearest(key, names)));
    if (!std::isnan(*place))
      throw InputError("E-FIT-04",
                       fmt::format("--target: '{}' is given twice; expected once", key));
    *place = target_value(key, part.substr(equals + 1));
  }
  for (const auto& [name, value] : keys)
    if (std::isnan(*value))
      throw InputError(
          "E-FIT-05", fmt::format("--target: '{}' is missing; expected all five properties", name));
  if (t.height > 1.0)
    throw InputError(
        "E-FIT-06",
        fmt::format(
            "--target: height_m = {:.6g}; expected at most 1 m. Was it given in millimetres?",
            t.height));
  if (t.area.centroid_height >= t.height)
    throw InputError(
        "E-FIT-07",
        fmt::format(
            "--target: centroid_height_m = {:.6g}; expected a value below height_m = {:.6g}",
            t.area.centroid_height, t.height));
  return t;
}

FitResult fit_to_targets(const FitTargets& t, double head_width) {
  FitResult r{.name = "targets", .source = "--target"};
  r.fit = fit_targets(t, head_width);
  r.lopsided.share = kNone;
  r.outline = {t.area, {kNone, kNone, kNone, kNone}, t.height};
  r.section = fitted_section(r.fit, t.height);
  return r;
}

bool is_toml(const std::string& file) { return std::filesystem::path(file).extension() == ".toml"; }

void check(const FitOptions& o) {
  if (o.profile.empty() == o.target.empty())
    throw InputError("E-FIT-08", "fit needs a profile or --target; expected one of the two");
  if (!o.target.empty() && std::isnan(o.head_width))
    throw InputError("E-FIT-09",
                     "--target alone leaves one width of the rectangles free; expected "
                     "--head-width-m beside it");
  if (o.target.empty() && !std::isnan(o.head_width))
    throw InputError("E-FIT-10",
                     "--head-width-m is given without --target; expected it beside --target alone, "
                     "since an outline has a head width of its own");
  const bool points = !o.profile.empty() && !is_toml(o.profile);
  if (points && o.unit.empty())
    throw InputError(
        "E-FIT-11",
        fmt::format("{}: a list of points does not say its unit; expected --unit mm or --unit m",
                    o.profile));
  if (!points && !o.unit.empty())
    throw InputError("E-FIT-12",
                     "--unit is given without a list of points; expected it beside a list of "
                     "points (CSV) alone, since a profile has its unit in its keys");
  if (!std::isnan(o.head_width) && !(o.head_width > 0.0 && std::isfinite(o.head_width)))
    throw InputError(
        "E-FIT-13",
        fmt::format("--head-width-m = {}; expected a finite number above 0", o.head_width));
}

Exit run_fit(const FitOptions& o) {
  check(o);
  const FitResult result =
      !o.target.empty() ? fit_to_targets(parse_targets(o.target), o.head_width)
      : is_toml(o.profile)
          ? fit_profile(read_profile(o.profile), o.profile)
          : fit_profile(read_points(o.profile, o.unit == "mm" ? 1e-3 : 1.0), o.profile);
  const bool fits = !result.refusal;
  if (fits && !o.out.empty()) write_file(o.out, to_toml(result));
  if (fits && !o.report.empty()) write_file(o.report, to_html(result));
  Remarks remarks;
  for (const Message& warning : result.warnings) remarks.warning(warning);
  if (!fits) {
    Message refusal = *result.refusal;
    refusal.text = fmt::format("{}: {}", o.profile, refusal.text);
    remarks.error(refusal);
  }
  nlohmann::ordered_json told = to_json(result);
  remarks.add_to(told);
  if (o.json)
    print_json(told);
  else
    fmt::print("{}\n", to_table(result));
  remarks.print();
  return fits ? Exit::done : Exit::not_reached;
}

}  // namespace

Command add_fit(CLI::App& app) {
  auto o = std::make_shared<FitOptions>();
  CLI::App* sub =
      app.add_subcommand("fit", "Three rectangles with the properties of a rail outline");
  sub->add_option("PROFILE", o->profile, "profile (TOML), or outline points (CSV, with --unit)")
      ->check(reads_file());
  sub->add_option("--unit", o->unit, "unit of a list of points")->check(CLI::IsMember({"mm", "m"}));
  sub->add_option("--target", o->target,
                  "properties instead of a profile: area_m2=..,inertia_y_m4=..,inertia_z_m4=..,"
                  "centroid_height_m=..,height_m=..");
  sub->add_option("--head-width-m", o->head_width, "head width, with --target");
  sub->add_option("--out", o->out, "write the section as TOML")->check(writes_file());
  sub->add_option("--report", o->report, "write a page with outline and rectangles (HTML)")
      ->check(writes_file());
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer("Example: railstep fit config/profiles/60e1.toml --out 60e1_section.toml");
  return {sub, [o] { return run_fit(*o); }};
}

}  // namespace railstep
