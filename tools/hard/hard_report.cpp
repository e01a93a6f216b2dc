#include "hard/hard_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "report/drawing.h"

namespace railstep {
namespace {

constexpr std::size_t kPieces = 150;  // of a curve: of each its lowest and highest point are drawn

std::string curve_data(const HardCurve& curve, const HardPicture& picture) {
  std::string data;
  const auto draw = [&](std::size_t i) {
    const bool drawn = (!picture.log_x || curve.x[i] > 0.) && (!picture.log_y || curve.y[i] > 0.);
    if (drawn && std::isfinite(curve.y[i]))
      data += fmt::format("{:.6g} {:.5g}\n", curve.x[i], curve.y[i]);
  };
  const std::size_t size = curve.x.size();
  const std::size_t every = curve.points ? 1 : std::max<std::size_t>(1, size / kPieces);
  for (std::size_t from = 0; from < size; from += every) {
    const std::size_t to = std::min(from + every, size);
    const auto [low, high] =
        std::minmax_element(curve.y.begin() + static_cast<std::ptrdiff_t>(from),
                            curve.y.begin() + static_cast<std::ptrdiff_t>(to));
    const auto a = static_cast<std::size_t>(low - curve.y.begin());
    const auto b = static_cast<std::size_t>(high - curve.y.begin());
    draw(std::min(a, b));
    if (a != b) draw(std::max(a, b));
  }
  return data;
}

/// Gnuplot's eight colours, then the same dashed.
std::string line_style(int number) {
  return fmt::format("lines lw 1.5 dt {}", 1 + (number - 1) / 8);
}

std::string drawn_picture(const HardCase& of, const HardPicture& picture) {
  std::string data, plot;
  int number = 0;
  for (const HardCurve& curve : picture.curves) {
    const std::string points = curve_data(curve, picture);
    ++number;
    if (points.empty()) continue;
    data += fmt::format("$c{} << EOD\n{}EOD\n", number, points);
    plot += fmt::format("{} $c{} with {} title \"{}\"", plot.empty() ? "" : ",", number,
                        curve.points ? "points pt 7 ps .6" : line_style(number), curve.name);
  }
  if (plot.empty()) return {};
  return drawn(fmt::format(
      "set terminal svg size 900,330 name '{}' noenhanced font 'sans,12'\nset xlabel \"{}\"\n"
      "set ylabel \"{}\"\nset grid\nset key outside right top Left reverse samplen 2\n{}{}{}"
      "plot{}\n",
      of.id, picture.x_label, picture.y_label, picture.log_x ? "set logscale x\n" : "",
      picture.log_y ? "set logscale y\nset format y '%.0e'\n" : "", data, plot));
}

std::string frame_text(const HardResult& result) {
  return result.frame_us > 0. ? fmt::format("{:.3g}", result.frame_us) : "";
}

std::string summary_row(const HardOutcome& own) {
  const HardCheck& check = tightest(own.result);
  return fmt::format(
      "<tr class={}><td><a href=\"#{}\">{}</a></td><td>{}</td><td>{}</td><td>{:.3g}</td>"
      "<td>{:.3g}</td><td>{}</td><td>{}</td></tr>\n",
      own.passed() ? "passed" : "failed", own.of.id, own.of.id, escaped(own.of.title),
      escaped(check.what), check.figure, check.bound, margin_text(check), frame_text(own.result));
}

std::string section(const HardOutcome& own) {
  std::string checks;
  for (const HardCheck& check : own.result.checks)
    checks +=
        fmt::format("<tr class={}><td>{}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td></tr>\n",
                    check.passed() ? "passed" : "failed", escaped(check.what), check.figure,
                    check.bound, margin_text(check));
  const HardCase& of = own.of;
  return fmt::format(
      "<h2 id=\"{0}\">{0}: {1}</h2>\n<p>{2}</p>\n<p>Scene <code>config/hard/{3}.toml</code>. "
      "{4}</p>\n<table>\n<tr><th>what</th><th>figure</th><th>bound</th><th>margin</th></tr>\n{5}"
      "</table>\n{6}\n",
      of.id, escaped(of.title), escaped(of.why), of.scene, escaped(of.source), checks,
      drawn_picture(of, own.result.picture));
}

}  // namespace

bool HardOutcome::passed() const {
  return std::all_of(result.checks.begin(), result.checks.end(),
                     [](const HardCheck& check) { return check.passed(); });
}

std::string margin_text(const HardCheck& check) {
  if (!check.passed()) return "over";
  if (check.bound == 0.) return "met";
  if (check.figure <= 0.) return check.figure == 0. ? "exact" : "under";
  return fmt::format("{:.3g}", check.bound / check.figure);
}

std::string hard_report(const std::vector<HardOutcome>& outcomes) {
  std::string rows, sections;
  std::size_t passed = 0;
  for (const HardOutcome& own : outcomes) {
    rows += summary_row(own);
    sections += section(own);
    passed += own.passed() ? 1 : 0;
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>Hard "
      "cases</title>\n"
      "<style>{}.failed td{{background:#fdd}}</style></head>\n<body>\n<h1>Hard cases</h1>\n"
      "<p>{} of {} passed. The figure of each case is the one nearest to its bound; the margin is "
      "the bound over the figure. Frames are medians of wall time, beside whatever else ran.</p>\n"
      "<table>\n<tr><th>case</th><th>what it is</th><th>tightest figure</th><th>figure</th>"
      "<th>bound</th><th>margin</th><th>us a frame</th></tr>\n{}</table>\n{}</body>\n</html>\n",
      kReportStyle, passed, outcomes.size(), rows, sections);
}

}  // namespace railstep
