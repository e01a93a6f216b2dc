#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace railstep {

/// Points of a curve in the numbers of its axes.
struct Curve {
  std::vector<double> x, y;
};

/// Numbers behind pixels: two ticks of an axis.
struct Ticks {
  bool logarithmic = false;
  std::vector<double> pixel, value;

  double at(double of) const {
    REQUIRE(pixel.size() >= 2);
    const auto number = [&](double v) { return logarithmic ? std::log(v) : v; };
    const double a = number(value.front()), b = number(value.back());
    const double found = a + (b - a) * (of - pixel.front()) / (pixel.back() - pixel.front());
    return logarithmic ? std::exp(found) : found;
  }
};

/// A curve "with lines" as gnuplot drew it, up to a hundredth of a pixel.
/// @param after  text of the page in front of the plot or in its head
/// @param name   of the curve in the plot's key; "" of the plot's only curve without a key
inline Curve plotted(const std::string& page, const std::string& after, const std::string& name,
                     bool log_x = false, bool log_y = false) {
  const std::size_t start = page.find(after);
  REQUIRE(start != std::string::npos);
  std::istringstream lines(page.substr(start, page.find("</svg>", start) - start));
  Ticks across{log_x, {}, {}}, up{log_y, {}, {}};
  std::vector<std::array<double, 2>> points;
  bool own = false;
  std::size_t in_key = 0;  // points of the curve's sample
  for (std::string line, text; std::getline(lines, line);) {
    const std::size_t path = line.find("d='M");
    const bool tick = path != std::string::npos && line.find("text-anchor=") != std::string::npos;
    if (tick && std::getline(lines, text)) {
      Ticks& axis = line.find("\"end\"") != std::string::npos ? up : across;
      const char* const from = line.c_str() + path + 4;
      char* comma = nullptr;
      const double x = std::strtod(from, &comma);
      axis.pixel.push_back(&axis == &across ? x : std::strtod(comma + 1, nullptr));
      axis.value.push_back(std::strtod(text.c_str() + text.find('>') + 1, nullptr));
    } else if (name.empty() ? line.find("_plot_1\"") != std::string::npos
                            : line.find("<text>" + name + "</text>") != std::string::npos) {
      own = true;
      in_key = name.empty() ? 0 : 2;
    } else if (own && line == "\t</g>") {
      break;
    } else if (own && path != std::string::npos) {
      std::istringstream words(line.substr(path + 3));
      for (std::string word; words >> word && (word[0] == 'M' || word[0] == 'L');) {
        std::array<double, 2> at{};
        REQUIRE(std::sscanf(word.c_str() + 1, "%lf,%lf", &at[0], &at[1]) == 2);
        if (in_key > 0)
          --in_key;
        else if (points.empty() || points.back() != at)  // a long curve goes on in another path
          points.push_back(at);
      }
    }
  }
  CAPTURE(after, name);
  REQUIRE(points.size() > 1);
  Curve curve;
  for (const auto& [x, y] : points) {
    curve.x.push_back(across.at(x));
    curve.y.push_back(up.at(y));
  }
  return curve;
}

/// A drawn curve goes through all these points and no others.
/// @param off  how far it may be beside them, over the largest: a pixel's hundredth on an axis of
///             some 300 is 3e-5, thrice that with the rounding of two ticks
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
