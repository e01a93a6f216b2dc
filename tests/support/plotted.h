#pragma once
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace railstep {

/// Points of a drawn curve in the units of its axes.
struct Curve {
  std::vector<double> x, y;
};

/// Numbers along an axis: pixels of its ticks and what is written at them.
struct Ticks {
  bool logarithmic = false;
  std::vector<double> pixel, value;

  double at(double of) const {
    REQUIRE(pixel.size() >= 2);
    const auto place = [&](double v) { return logarithmic ? std::log(v) : v; };
    const double a = place(value.front()), b = place(value.back());
    const double found = a + (b - a) * (of - pixel.front()) / (pixel.back() - pixel.front());
    return logarithmic ? std::exp(found) : found;
  }
};

/// A curve "with lines" on a report's page, as gnuplot drew it. A pixel has two decimals.
/// @param after  text of the page in front of the plot or in its head
/// @param name   of the curve in the plot's key; "" for the first curve of a plot without a key
inline Curve plotted(const std::string& page, const std::string& after, const std::string& name,
                     bool log_x = false, bool log_y = false) {
  CAPTURE(after, name);
  const std::size_t start = page.find(after), end = page.find("</svg>", start);
  REQUIRE(end != std::string::npos);
  const std::string svg = page.substr(start, end - start);
  const auto point_at = [&](std::size_t at) {
    std::array<double, 2> p{};
    REQUIRE(std::sscanf(svg.c_str() + at, "%lf,%lf", &p[0], &p[1]) == 2);
    return p;
  };

  // A tick's line has its mark and the place of its text; the next line has the number.
  Ticks across{log_x, {}, {}}, up{log_y, {}, {}};
  const std::string anchor = "text-anchor=\"", mark = "d='M";
  for (std::size_t at = svg.find(anchor); at != std::string::npos; at = svg.find(anchor, at + 1)) {
    const std::size_t path = svg.find(mark, svg.rfind('\n', at)), text = svg.find("<text>", at) + 6;
    if (path > at) continue;
    char* behind = nullptr;
    const double value = std::strtod(svg.c_str() + text, &behind);
    if (behind == svg.c_str() + text || *behind != '<') continue;
    const bool is_up = svg[at + anchor.size()] == 'e';  // its text ends at the axis
    Ticks& axis = is_up ? up : across;
    axis.pixel.push_back(point_at(path + mark.size())[is_up ? 1 : 0]);
    axis.value.push_back(value);
  }

  const std::size_t own = svg.find(name.empty() ? "_plot_1\"" : "<text>" + name + "</text>");
  REQUIRE(own != std::string::npos);
  const std::size_t first = svg.find(mark, own) + 3, last = svg.find("</g>\n\t</g>", first);
  std::vector<std::array<double, 2>> pixels;
  for (std::size_t at = first; (at = svg.find_first_of("ML", at)) < last; ++at) {
    const auto p = point_at(at + 1);
    if (pixels.empty() || pixels.back() != p) pixels.push_back(p);  // a long curve has more paths
  }
  REQUIRE(pixels.size() > 2);
  if (!name.empty()) pixels.erase(pixels.begin(), pixels.begin() + 2);  // the key's sample
  Curve curve;
  for (const auto& [x, y] : pixels) {
    curve.x.push_back(across.at(x));
    curve.y.push_back(up.at(y));
  }
  return curve;
}

/// Checks that a drawn curve goes through all these points and no others.
/// @param off  largest distance over the largest value: a hundredth of a pixel on 300 is 3e-5, and
///             the ticks are as exact
inline void check_drawn(const Curve& drawn, const std::vector<double>& x,
                        const std::vector<double>& y, double off = 1e-4) {
  REQUIRE(drawn.x.size() == x.size());
  const auto largest = [](const std::vector<double>& of) {
    double most = 0.;
    for (const double each : of) most = std::max(most, std::abs(each));
    return most;
  };
  for (std::size_t i = 0; i < x.size(); ++i) {
    CAPTURE(i, x[i], y[i], drawn.x[i], drawn.y[i]);
    REQUIRE(std::abs(drawn.x[i] - x[i]) <= off * largest(x));
    REQUIRE(std::abs(drawn.y[i] - y[i]) <= off * largest(y));
  }
}

}  // namespace railstep
