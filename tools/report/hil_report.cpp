#include "report/hil_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "report/drawing.h"

namespace railstep {
namespace {

constexpr const char* kColours[] = {"#0b6bab", "#d9731a"};
constexpr double kLeft = 70., kRight = 880., kTop = 20., kBottom = 360.;
constexpr double kLeastUs = .5;  // where the bin [0, 1) us begins on a logarithmic axis

struct Axes {
  double most_us, most_count;

  double x(double us) const {
    return kLeft + (kRight - kLeft) * std::log(std::max(us, kLeastUs) / kLeastUs) /
                       std::log(most_us / kLeastUs);
  }
  /// From half a sample, so that one shows.
  double y(double count) const {
    return kBottom - (kBottom - kTop) * std::log(count / .5) / std::log(most_count / .5);
  }
};

using Counts = std::vector<std::int64_t>;

Axes axes_of(const std::vector<Counts>& all) {
  double last = 10., most = 10.;
  for (const Counts& counts : all)
    for (std::size_t us = 0; us < counts.size(); ++us) {
      if (counts[us] == 0) continue;
      last = std::max(last, static_cast<double>(us + 1));
      most = std::max(most, static_cast<double>(counts[us]));
    }
  const auto decade = [](double value) {
    return std::pow(10., std::ceil(std::log10(value) - 1e-9));
  };
  return {decade(last), decade(most)};
}

std::string grid(const Axes& axes) {
  std::string svg;
  const auto line = [&svg](double x1, double y1, double x2, double y2) {
    svg += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#ccc\"/>\n", x1, y1,
        x2, y2);
  };
  const auto text = [&svg](double x, double y, const char* anchor, const std::string& words) {
    svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y,
                       anchor, words);
  };
  for (double us = 1.; us <= 1.01 * axes.most_us; us *= 10.) {
    line(axes.x(us), kTop, axes.x(us), kBottom);
    text(axes.x(us), kBottom + 18., "middle", fmt::format("{:.0f}", us));
  }
  for (double count = 1.; count <= 1.01 * axes.most_count; count *= 10.) {
    line(kLeft, axes.y(count), kRight, axes.y(count));
    text(kLeft - 8., axes.y(count) + 4., "end", fmt::format("{:.0f}", count));
  }
  text(.5 * (kLeft + kRight), kBottom + 40., "middle", "us, bins of 1 us");
  text(kLeft, kTop - 6., "start", "frames");
  return svg;
}

/// One path of bars over all bins that are not empty.
std::string bars(const Axes& axes, const Counts& counts) {
  std::string path;
  for (std::size_t us = 0; us < counts.size(); ++us) {
    if (counts[us] == 0) continue;
    const auto from = static_cast<double>(us);
    path += fmt::format("M{:.2f} {:.1f}V{:.1f}H{:.2f}V{:.1f}Z", axes.x(from), kBottom,
                        axes.y(static_cast<double>(counts[us])), axes.x(from + 1.), kBottom);
  }
  return path;
}

/// {"a": {"b": 1}} as rows "a, b | 1".
void rows_of(const nlohmann::ordered_json& value, const std::string& name, std::string& html) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items())
      rows_of(inner, name.empty() ? key : fmt::format("{}, {}", name, key), html);
    return;
  }
  const std::string text = value.is_string()         ? value.get<std::string>()
                           : value.is_number_float() ? fmt::format("{:.6g}", value.get<double>())
                                                     : value.dump();
  html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(name), escaped(text));
}

}  // namespace

std::string histogram_svg(const std::vector<NamedLatency>& shown) {
  std::vector<Counts> all;
  all.reserve(shown.size());
  for (const NamedLatency& each : shown) all.push_back(each.times->microseconds());
  const Axes axes = axes_of(all);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 410\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n" +
      grid(axes);
  for (std::size_t i = shown.size(); i-- > 0;) {  // the first lies on top
    const char* const colour = kColours[i % std::size(kColours)];
    svg += fmt::format(
        "<path d=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"0.5\" fill-opacity=\"0.8\"/>\n",
        bars(axes, all[i]), colour, colour);
    const double y = kTop + 16. * static_cast<double>(i + 1);
    svg +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\" fill=\"{}\">{}</text>\n",
                    kRight - 6., y, colour, escaped(shown[i].name));
  }
  return svg + "</svg>\n";
}

std::string hil_report(const std::string& title, const nlohmann::ordered_json& result,
                       const std::vector<NamedLatency>& frame,
                       const std::vector<NamedLatency>& wakeup) {
  std::string rows;
  rows_of(result, "", rows);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n"
      "<p>Figures of this run on this machine; they bound nothing{2}.</p>\n"
      "<h2>Task execution time: what a frame takes</h2>\n{3}"
      "<h2>Wake-up latency: how late a frame begins</h2>\n{4}"
      "<table>\n{5}</table>\n</body>\n</html>\n",
      escaped(title), kReportStyle,
      result["virtual_machine"] == true ? ", the less as it is a virtual one" : "",
      histogram_svg(frame), histogram_svg(wakeup), rows);
}

nlohmann::ordered_json quantiles(const Latency& times) {
  return {{"median", times.quantile_us(.5)},
          {"p99", times.quantile_us(.99)},
          {"p99_9", times.quantile_us(.999)},
          {"p99_99", times.quantile_us(.9999)},
          {"max", times.quantile_us(1.)}};
}

}  // namespace railstep
