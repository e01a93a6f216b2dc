#include "report/critical_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "report/drawing.h"

namespace railstep {
namespace {

std::string plot_of_speeds(const char* name, const char* x, const char* y,
                           const std::string& settings, const std::string& data,
                           const std::string& plot) {
  return drawn(
      fmt::format("set terminal svg size 900,480 name '{}' noenhanced font 'sans,12'\n"
                  "set xlabel '{}'\nset ylabel '{}'\nset grid\n{}$modes << EOD\n{}EOD\nplot {}\n",
                  name, x, y, settings, data, plot));
}

/// Roots s / (2 pi) with the damping to the left, each with its speed.
std::string root_locus(const std::vector<ModesAtSpeed>& modes) {
  std::string data;
  for (const ModesAtSpeed& own : modes)
    for (const RunningMode& mode : own.modes) {
      const double part = std::sqrt(std::max(0., 1. - mode.damping_ratio * mode.damping_ratio));
      data += fmt::format("{:.6g} {:.6g} {:.6g}\n", -mode.damping_ratio * mode.frequency,
                          mode.frequency * part, own.speed);
    }
  return plot_of_speeds(
      "locus", "real part over 2 pi, Hz", "imaginary part over 2 pi, Hz",
      "set xrange [-6:*]\nset yrange [0:15]\nset cblabel 'speed, m/s'\nset palette defined (0 "
      "'#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n"
      "set arrow from 0,0 to 0,15 nohead lw 1.5\n",
      data, "$modes using 1:2:3 with points pt 7 ps 0.5 palette notitle");
}

std::string least_damping(const std::vector<ModesAtSpeed>& modes) {
  std::string data;
  for (const ModesAtSpeed& own : modes) {
    if (own.modes.empty()) continue;
    const auto least = std::min_element(own.modes.begin(), own.modes.end(),
                                        [](const RunningMode& a, const RunningMode& b) {
                                          return a.damping_ratio < b.damping_ratio;
                                        });
    data += fmt::format("{:.6g} {:.6g}\n", own.speed, 100. * least->damping_ratio);
  }
  return plot_of_speeds("damping", "speed, m/s", "least damping ratio of all modes, %",
                        "set arrow from graph 0, first 0 to graph 1, first 0 nohead lw 1.5\n", data,
                        "$modes using 1:2 with lines lw 2 notitle");
}

}  // namespace

std::string critical_page(const std::string& title, const std::vector<ModesAtSpeed>& modes,
                          const std::optional<CriticalRunning>& critical) {
  const std::string answer =
      critical ? fmt::format(
                     "The vehicle hunts from {:.2f} m/s ({:.1f} km/h) on, in a mode of "
                     "{:.3g} Hz.",
                     critical->speed, 3.6 * critical->speed, critical->frequency)
               : "No mode loses its damping in this range of speeds.";
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>{1}</style></head>\n<body>\n<h1>Critical speed of {0}</h1>\n<p>{2}</p>\n"
      "<h2>Root locus</h2>\n<p>Eigenvalues of small motions about the steady one, of a frequency "
      "up "
      "to 15 Hz. A mode to the right of the line grows.</p>\n{3}\n<h2>Damping</h2>\n{4}\n</body>\n"
      "</html>\n",
      escaped(title), kReportStyle, answer, root_locus(modes), least_damping(modes));
}

}  // namespace railstep
