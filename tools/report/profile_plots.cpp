#include "report/profile_plots.h"

#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <vector>

#include "report/drawing.h"

namespace railstep {
namespace {

constexpr double kRaised = 10e-3;       // m, of the wheel in its figure
constexpr double kBetweenLines = 5e-4;  // m, of shifts

/// One curve of a figure.
struct Curve {
  std::string name, data;  // data: "x y" lines
};

template <class Row>
Curve curve_of(const std::string& name, const std::vector<Row>& rows,
               const std::function<std::pair<double, double>(const Row&)>& point) {
  Curve curve{name, ""};
  for (const Row& row : rows) {
    const auto [x, y] = point(row);
    curve.data += fmt::format("{:.7g} {:.7g}\n", x, y);
  }
  return curve;
}

constexpr const char* kLines[] = {"lc rgb '#1f4e8c' lw 3", "lc rgb '#d1495b' lw 2 dt 2",
                                  "lc rgb '#2a9d5c' lw 2 dt 4"};

std::string figure(const std::vector<Curve>& curves, const std::string& settings) {
  std::string blocks, plot;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    blocks += fmt::format("$d{} << EOD\n{}EOD\n", i, curves[i].data);
    plot += fmt::format("{} $d{} using 1:2 with lines {} title \"{}\"", i == 0 ? "" : ",", i,
                        kLines[i], curves[i].name);
  }
  return drawn(
      fmt::format("set terminal svg size 900,420 noenhanced font 'sans,12' background '#ffffff'\n"
                  "set grid xtics ytics lc rgb '#dddddd'\nset tics nomirror\nset border 3\nset key "
                  "tmargin center horizontal\n"
                  "set datafile missing 'nan'\n{}\n{}plot{}\n",
                  settings, blocks, plot));
}

std::string over_shift(const std::vector<Curve>& curves, const std::string& ylabel) {
  return figure(curves, fmt::format("set xlabel 'shift of the wheelset to the right, mm'\nset "
                                    "ylabel '{}'",
                                    ylabel));
}

std::string outline_of(const RunningSurface& surface, double from, double to, double shift,
                       double raise, double sign) {
  std::string data;
  constexpr int kPoints = 600;
  for (int i = 0; i <= kPoints; ++i) {
    const double y = from + (to - from) * i / kPoints;
    data += fmt::format("{:.7g} {:.7g}\n", 1e3 * (y + shift),
                        1e3 * (raise + sign * surface.at(y).height));
  }
  return data;
}

std::string load_name(const ProfileAnswer& a) {
  return fmt::format("under {:.4g} kN a wheel", 1e-3 * a.request.load);
}

}  // namespace

std::string plot_of_contacts(const ProfileAnswer& a) {
  const double axis = .5 * a.request.back_to_back - a.wheel.flange_back;  // of the tread datum
  std::string lines;
  double next = -a.request.range;
  for (const WheelsetTouch& t : a.rows()) {
    if (t.shift < next - 1e-9) continue;
    next += kBetweenLines;
    lines += fmt::format("{:.7g} {:.7g}\n{:.7g} {:.7g}\n\n", 1e3 * (axis + t.right.on_wheel),
                         1e3 * (kRaised - t.right.growth), 1e3 * t.right.on_rail,
                         1e3 * a.rail.surface.at(t.right.on_rail).height);
  }
  const RunningSurface& wheel = a.wheel.growth;
  return drawn(fmt::format(
      "set terminal svg size 900,340 noenhanced font 'sans,12' background '#ffffff'\n"
      "set grid xtics ytics lc rgb '#eeeeee'\nset tics nomirror\nset border 3\nset key tmargin "
      "center horizontal\n"
      "set size ratio -1\nset yrange [-26:16]\nset xlabel 'from the middle of the track, mm'\n"
      "set ylabel 'height, mm'\n$w << EOD\n{}EOD\n$r << EOD\n{}EOD\n$l << EOD\n{}EOD\n"
      "plot $l using 1:2 with lines lc rgb '#888888' lw 1 title 'contacts', $w using 1:2 with "
      "lines "
      "lc rgb '#1f4e8c' lw 3 title \"{}\", $r using 1:2 with lines lc rgb '#333333' lw 3 title "
      "\"{}\"\n",
      outline_of(wheel, wheel.first(), wheel.last(), axis, kRaised, -1.),
      outline_of(a.rail.surface, a.rail.surface.first(), a.rail.surface.last(), 0., 0., 1.), lines,
      "wheel", "rail"));
}

std::string plot_of_radii(const ProfileAnswer& a) {
  const auto rigid = [](const WheelsetTouch& t) {
    return std::pair(1e3 * t.shift, 1e3 * t.radius_difference());
  };
  std::vector<Curve> curves{curve_of<WheelsetTouch>("rigid, with roll", a.rolled, rigid),
                            curve_of<WheelsetTouch>("rigid, without roll", a.level, rigid)};
  if (!a.loaded.empty())
    curves.push_back(curve_of<WheelsetLoaded>(load_name(a), a.loaded, [](const auto& t) {
      return std::pair(1e3 * t.shift, 1e3 * t.radius_difference());
    }));
  return over_shift(curves, "right less left, mm");
}

std::string plot_of_angles(const ProfileAnswer& a) {
  return over_shift(
      {curve_of<WheelsetTouch>(
           "right", a.rows(),
           [](const auto& t) { return std::pair(1e3 * t.shift, t.right.angle * 180. / M_PI); }),
       curve_of<WheelsetTouch>(
           "left", a.rows(),
           [](const auto& t) { return std::pair(1e3 * t.shift, t.left.angle * 180. / M_PI); })},
      "degrees");
}

std::string plot_of_roll(const ProfileAnswer& a) {
  return over_shift(
      {curve_of<WheelsetTouch>(
          "rigid", a.rolled, [](const auto& t) { return std::pair(1e3 * t.shift, 1e3 * t.roll); })},
      "mrad, positive with the right wheel up");
}

std::string plot_of_conicity(const ProfileAnswer& a) {
  const auto of = [](std::optional<double> ConicityRow::*value) {
    return [value](const ConicityRow& row) {
      return std::pair(1e3 * row.amplitude, (row.*value).value_or(std::nan("")));
    };
  };
  std::vector<Curve> curves{
      curve_of<ConicityRow>("rigid, with roll", a.conicity, of(&ConicityRow::rigid)),
      curve_of<ConicityRow>("rigid, without roll", a.conicity, of(&ConicityRow::level))};
  if (!a.loaded.empty())
    curves.push_back(curve_of<ConicityRow>(load_name(a), a.conicity, of(&ConicityRow::loaded)));
  return figure(curves,
                "set xlabel 'amplitude, mm'\nset ylabel 'equivalent conicity'\nset yrange [0:]");
}

}  // namespace railstep
