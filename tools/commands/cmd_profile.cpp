#include <fmt/core.h>

#include <memory>
#include <string>

#include "answer/profile_pair.h"
#include "commands/command.h"
#include "commands/options.h"
#include "report/drawing.h"
#include "report/profile_report.h"
#include "text/write.h"

namespace railstep {
namespace {

struct ProfileOptions : ProfileRequest {
  std::string inclination_text = "1:40", report, csv;
  bool level = false, json = false;
};

/// "1:40" or a number.
double inclination_of(const std::string& text) {
  const bool ratio = text.rfind("1:", 0) == 0;
  char* end = nullptr;
  const std::string digits = ratio ? text.substr(2) : text;
  const double value = std::strtod(digits.c_str(), &end);
  const double slope = ratio ? 1. / value : value;
  if (digits.empty() || *end != '\0' || !(slope >= 0. && slope <= .2))
    throw InputError("E-CLI-16", fmt::format("--inclination: '{}' is not a slope; expected 1:40 or "
                                             "a number from 0 to 0.2",
                                             text));
  return slope;
}

Exit run_profile(ProfileOptions& o) {
  o.inclination = inclination_of(o.inclination_text);
  o.roll = !o.level;
  if (!o.report.empty()) need_gnuplot();
  const ProfileAnswer answer = solve_profile(o);
  if (!o.csv.empty()) write_file(o.csv, to_csv(answer));
  if (!o.report.empty()) write_file(o.report, to_html(answer));
  fmt::print("{}", o.json ? to_json(answer).dump(2) + "\n" : to_table(answer));
  return Exit::done;
}

}  // namespace

Command add_profile(CLI::App& app) {
  auto o = std::make_shared<ProfileOptions>();
  CLI::App* sub = app.add_subcommand(
      "profile", "Contacts of a wheel profile on a rail profile, and their equivalent conicity");
  sub->add_option("WHEEL", o->wheel, "wheel profile (TOML)")->required()->check(reads_file());
  sub->add_option("RAIL", o->rail, "rail profile (TOML)")->required()->check(reads_file());
  sub->add_option("--inclination", o->inclination_text, "of the rails (default 1:40)");
  sub->add_option("--gauge", o->gauge, "14 mm below the top of rail, m (default 1.435)")
      ->check(within(0.5, 2.0));
  sub->add_option("--back-to-back", o->back_to_back, "of the wheels, m (default 1.36)")
      ->check(within(0.4, 1.9));
  sub->add_option("--radius", o->radius,
                  fmt::format("of the wheels at the tread datum, m (default {})", kWheelRadius))
      ->check(within(0.1, 2.0));
  sub->add_option("--contact-distance", o->contact_distance,
                  "of the contacts, for the conicity, m (default 1.5)")
      ->check(within(0.5, 2.0));
  sub->add_option("--range", o->range, "largest shift of the wheelset, m (default 0.008)")
      ->check(within(1e-3, 0.02));
  sub->add_option("--load", o->load, "upright on each wheel, N: adds elastic contact")
      ->check(within(1.0, 1e6));
  sub->add_flag("--no-roll", o->level, "rigid contact of a level wheelset, as EN 15302 takes it");
  sub->add_option("--csv", o->csv, "write the contacts (CSV)")->check(writes_file());
  sub->add_option("--report", o->report, "write a page with plots (HTML)")->check(writes_file());
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Example: railstep profile config/profiles/s1002.toml config/profiles/60e1.toml --load 60000 "
      "--report s1002_60e1.html");
  return {sub, [o] { return run_profile(*o); }};
}

}  // namespace railstep
