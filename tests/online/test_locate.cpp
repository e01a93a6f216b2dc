#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "online/contact/locate.h"

// The references use long double on purpose; clang warns of these promotions.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

using namespace railstep;

namespace {

using Real = long double;
constexpr double kUlp = 0x1p-52;

struct Rail {
  std::vector<double> nodes;
  RailShape shape() const { return {static_cast<int>(nodes.size() / 9 - 1) / 2, nodes.data()}; }
};

/// 0.6 m elements on an arc in the vertical plane through `angle` (up if positive), rotated by
/// `twist` about its axis from end to end.
Rail arc(int elements, double angle, double twist = 0.0) {
  Rail rail;
  const double length = 0.6 * elements;
  for (int i = 0; i <= 2 * elements; ++i) {
    const double part = 0.5 * i / elements, t = angle * part, s = length * part;
    const double x = angle == 0.0 ? s : length / angle * std::sin(t);
    const double z = angle == 0.0 ? 0.0 : length / angle * (1.0 - std::cos(t));
    const double c = std::cos(twist * part), n = std::sin(twist * part);
    const double up[3] = {-std::sin(t), 0.0, std::cos(t)};
    for (double v : {x, 0.0, z}) rail.nodes.push_back(v);
    for (double v : {n * up[0], c, n * up[2]}) rail.nodes.push_back(v);
    for (double v : {c * up[0], -n, c * up[2]}) rail.nodes.push_back(v);
  }
  return rail;
}

/// r + y a + z b (and its derivative by xi) in long double, independent of the kernel.
void evaluate(const Rail& rail, int element, Real xi, Real y, Real z, Real* at, Real* slope) {
  const Real N[3] = {xi * (xi - 1) / 2, 1 - xi * xi, xi * (xi + 1) / 2};
  const Real N1[3] = {xi - Real(0.5), -2 * xi, xi + Real(0.5)};
  for (int k = 0; k < 3; ++k) {
    at[k] = slope[k] = 0;
    for (int i = 0; i < 3; ++i) {
      const double* node = rail.nodes.data() + 9 * (2 * element + i);
      const Real value = node[k] + y * node[3 + k] + z * node[6 + k];
      at[k] += N[i] * value;
      slope[k] += N1[i] * value;
    }
  }
}

double along(RailPlace at) { return at.element + (at.xi + 1.0) / 2.0; }

struct Axle {
  double p[3], e[3];
};

Axle axle_over(double x, double z) {
  const double size = std::sqrt(0.02 * 0.02 + 1.0 + 0.01 * 0.01);
  return {{x, 0.3, z}, {0.02 / size, 1.0 / size, -0.01 / size}};
}

/// Squared distance of the curve's point from the axle and minus half its slope, long double.
struct Distance {
  Real square, pull;
};

Distance distance(const Rail& rail, const Axle& axle, Real z_crown, int element, Real xi) {
  Real c[3], slope[3], t = 0, e2 = 0;
  evaluate(rail, element, xi, 0, z_crown, c, slope);
  for (int k = 0; k < 3; ++k) {
    t += (c[k] - axle.p[k]) * axle.e[k];
    e2 += static_cast<Real>(axle.e[k]) * axle.e[k];
  }
  Distance out{0, 0};
  for (int k = 0; k < 3; ++k) {
    const Real w = c[k] - axle.p[k] - t / e2 * axle.e[k];
    out.square += w * w;
    out.pull -= w * slope[k];
  }
  return out;
}

/// Nearest place of the whole rail: a fine scan, then golden section around the best point.
Real golden(const Rail& rail, const Axle& axle, Real z_crown) {
  const int elements = rail.shape().elements, cells = 200 * elements;
  const auto square = [&](Real s) {
    const int element = std::min(static_cast<int>(s), elements - 1);
    return distance(rail, axle, z_crown, element, 2 * (s - element) - 1).square;
  };
  Real best = 0;
  for (int i = 1; i <= cells; ++i) {
    const Real s = static_cast<Real>(i) * elements / cells;
    if (square(s) < square(best)) best = s;
  }
  Real low = std::max<Real>(0, best - 0.005L), high = std::min<Real>(elements, best + 0.005L);
  const Real ratio = (std::sqrt(5.0L) - 1) / 2;
  for (int i = 0; i < 80; ++i) {
    const Real left = high - ratio * (high - low), right = low + ratio * (high - low);
    if (square(left) < square(right))
      high = right;
    else
      low = left;
  }
  return (low + high) / 2;
}

const std::vector<Rail> kRails{arc(6, 0.0), arc(3, 1.5707963), arc(3, -1.5707963), arc(4, 1.0, 0.3),
                               arc(1, 0.4)};

}  // namespace

TEST_CASE("a point of the rail is found where it was made, over every element border", "[locate]") {
  int most = 0;
  double worst = 0.0, worst_section = 0.0;
  const double ulp_in = 1.0 - kUlp / 2.0;
  for (const Rail& rail : kRails) {
    const int elements = rail.shape().elements;
    for (int element = 0; element < elements; ++element)
      for (double xi : {-1.0, -ulp_in, -0.999, -0.3, 0.0, 0.55, 0.98, ulp_in, 1.0})
        for (double y : {-0.04, 0.0, 0.035})
          for (double z : {-0.1, 0.0, 0.1})
            for (double shift : {-0.6, -0.05, 0.0, 0.04, 0.6}) {
              Real exact[3], slope[3];
              evaluate(rail, element, xi, y, z, exact, slope);
              const double point[3] = {static_cast<double>(exact[0]), static_cast<double>(exact[1]),
                                       static_cast<double>(exact[2])};
              const double want = along({element, xi});
              const double from = std::clamp(want + shift, 0.0, static_cast<double>(elements));
              const int e0 = std::min(static_cast<int>(from), elements - 1);
              const auto got = locate_point(rail.shape(), point, {e0, 2.0 * (from - e0) - 1.0});
              CHECK(got.status == LocateStatus::found);
              CHECK(std::abs(got.place.xi) <= 1.0);
              most = std::max(most, got.steps);
              const double error = std::abs(along(got.place) - want) * 0.6;
              worst = std::max({worst, error, got.residual});
              worst_section = std::max({worst_section, std::abs(got.y - y), std::abs(got.z - z)});
            }
  }
  INFO("most steps " << most << ", place off by " << worst << " m, section by " << worst_section);
  // Coordinates up to 3.6 m are rounded to 2^-52 * 2 = 4.4e-16 m each. Some ten such roundings are
  // magnified by up to 1.25 where the section lies inside the bend (1/(1 - 0.1/R), R = 1.15).
  CHECK(worst <= 1.1e-14);
  CHECK(worst_section <= 1.1e-14);
}

TEST_CASE("both sides of a border and one ulp around it are one point", "[locate]") {
  for (const Rail& rail : kRails)
    for (int border = 1; border < rail.shape().elements; ++border) {
      const double* node = rail.nodes.data() + 18 * border;
      for (int ulp : {-1, 0, 1}) {
        double point[3];
        for (int k = 0; k < 3; ++k) {
          point[k] = node[k] + 0.02 * node[3 + k] + 0.08 * node[6 + k];
          if (ulp != 0) point[k] = std::nextafter(point[k], ulp * 10.0);
        }
        const auto left = locate_point(rail.shape(), point, {border - 1, 1.0});
        const auto right = locate_point(rail.shape(), point, {border, -1.0});
        CHECK(left.status == LocateStatus::found);
        CHECK(right.status == LocateStatus::found);
        // As above: ten roundings of 4.4e-16 m over half an element, 0.3 m, in xi.
        CHECK(std::abs(along(left.place) - along(right.place)) <= 1.5e-14);
        CHECK(std::abs(along(left.place) - border) <= 1.5e-14);
        CHECK(std::abs(left.z - right.z) <= 4.4e-15);
      }
    }
}

TEST_CASE("beyond an end of the rail the search says which end", "[locate]") {
  for (const Rail& rail : kRails) {
    const RailShape shape = rail.shape();
    for (int end : {0, 1}) {
      const double* node = rail.nodes.data() + (end != 0 ? rail.nodes.size() - 9 : 0);
      const double tangent[3] = {node[4] * node[8] - node[5] * node[7],
                                 node[5] * node[6] - node[3] * node[8],
                                 node[3] * node[7] - node[4] * node[6]};
      for (double out : {1e-9, 1e-3, 0.2, -1e-9, -1e-3}) {
        double point[3];
        for (int k = 0; k < 3; ++k) point[k] = node[k] + (end != 0 ? out : -out) * tangent[k];
        for (int element = 0; element < shape.elements; ++element) {
          const auto got = locate_point(shape, point, {element, 0.1});
          const auto off = end != 0 ? LocateStatus::off_end : LocateStatus::off_start;
          CHECK(got.status == (out > 0.0 ? off : LocateStatus::found));
          if (out > 0.0) CHECK(along(got.place) == (end != 0 ? shape.elements : 0));
        }
      }
    }
  }
}

TEST_CASE("the crown point nearest to the axle agrees with golden section and with the slope",
          "[locate]") {
  int most = 0, cases = 0, other_side = 0;
  double worst_distance = 0.0;
  for (const Rail& rail : kRails) {
    const RailShape shape = rail.shape();
    for (int i = 1; i < 40 * shape.elements; ++i) {
      const double s = i / 40.0, z_crown = -0.2;
      const int element = std::min(static_cast<int>(s), shape.elements - 1);
      Real r[3], slope[3];
      evaluate(rail, element, 2 * (s - element) - 1, 0, 0.56L, r, slope);
      const Axle axle = axle_over(static_cast<double>(r[0]), static_cast<double>(r[2]));
      const Real want = golden(rail, axle, z_crown);
      if (want < 0.001L || want > shape.elements - 0.001L) continue;
      for (double shift : {-0.4, -0.02, 0.02, 0.4}) {
        const double from = std::clamp(s + shift, 0.0, static_cast<double>(shape.elements));
        const int e0 = std::min(static_cast<int>(from), shape.elements - 1);
        const auto got =
            locate_wheel(shape, axle.p, axle.e, z_crown, {e0, 2.0 * (from - e0) - 1.0});
        CHECK(got.status == LocateStatus::found);
        most = std::max(most, got.steps);
        ++cases;
        // Where the interpolated curve has a kink towards the axle, each side of that border may
        // have a nearest point of its own. Within one element there is only one.
        if (std::abs(along(got.place) - static_cast<double>(want)) > 1e-6) {
          const double border = std::round(static_cast<double>(want));
          CHECK((along(got.place) - border) * (static_cast<double>(want) - border) <= 0.0);
          ++other_side;
        } else {
          const int we = std::min(static_cast<int>(want), shape.elements - 1);
          const Real nearest =
              std::sqrt(distance(rail, axle, z_crown, we, 2 * (want - we) - 1).square);
          worst_distance =
              std::max(worst_distance, std::abs(got.distance - static_cast<double>(nearest)));
        }
        // The slope's sign changes within 2e-14 of the place, or across the border that it lies on.
        const Real h = 2e-14L;
        const auto pull = [&](Real at) {
          const int e = std::clamp(static_cast<int>(at), 0, shape.elements - 1);
          return distance(rail, axle, z_crown, e, 2 * (at - e) - 1).pull;
        };
        CHECK(pull(along(got.place) - h) > 0);
        CHECK(pull(along(got.place) + h) < 0);
        double size = 0.0, square_to_axle = 0.0;
        for (int k = 0; k < 3; ++k) {
          size += got.normal[k] * got.normal[k];
          square_to_axle += got.normal[k] * axle.e[k];
        }
        CHECK(std::abs(size - 1.0) <= 8 * kUlp);
        CHECK(std::abs(square_to_axle) <= 8 * kUlp);
        // c + distance n is the axle's point at `along`.
        Real c[3];
        evaluate(rail, got.place.element, got.place.xi, 0, z_crown, c, slope);
        for (int k = 0; k < 3; ++k)
          CHECK(std::abs(static_cast<double>(c[k]) + got.distance * got.normal[k] -
                         (axle.p[k] + got.along * axle.e[k])) <= 20 * kUlp);
      }
    }
  }
  INFO(cases << " cases, most steps " << most << ", distance off by " << worst_distance << " m; "
             << other_side << " stand across a kink from the nearest");
  CHECK(cases > 2000);
  CHECK(other_side < cases / 50);      // only beside the borders of the rails bent upwards
  CHECK(worst_distance <= 20 * kUlp);  // twenty roundings of numbers up to 3.6 m and below
}

TEST_CASE("an axle over a kink stands on the border", "[locate]") {
  Rail rail = arc(2, 0.0);
  for (const std::size_t i : {0u, 1u, 3u, 4u})
    rail.nodes[9 * i + 2] = -0.05 * std::abs(static_cast<double>(i) - 2.0);
  for (double x : {0.59, 0.6, 0.605}) {
    const Axle axle = axle_over(x, 0.5);
    for (RailPlace start :
         {RailPlace{0, -0.5}, RailPlace{0, 0.99}, RailPlace{1, -1.0}, RailPlace{1, 0.7}}) {
      const auto got = locate_wheel(rail.shape(), axle.p, axle.e, 0.0, start);
      CHECK(got.status == LocateStatus::found);
      CHECK(along(got.place) == 1.0);
    }
  }
}

TEST_CASE("the cap is kept, and every input gives a finite result", "[locate]") {
  const Rail rail = arc(3, 1.5707963);
  const double* node = rail.nodes.data() + 9 * 5;
  const auto early = locate_point(rail.shape(), node, {0, -0.9}, 2);
  CHECK(early.status == LocateStatus::cap_reached);
  CHECK(early.steps == 2);
  const auto whole = locate_point(rail.shape(), node, {0, -0.9});
  CHECK(whole.status == LocateStatus::found);

  for (double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e308}) {
    const double point[3] = {bad, 0.1, 0.2}, e[3] = {0.0, 1.0, bad};
    const auto got = locate_point(rail.shape(), point, {99, bad});
    CHECK(got.status != LocateStatus::found);
    CHECK((std::isfinite(got.y) && std::isfinite(got.z) && std::isfinite(got.residual)));
    const auto wheel = locate_wheel(rail.shape(), point, e, bad, {-3, bad});
    CHECK(wheel.status != LocateStatus::found);
    CHECK(std::isfinite(wheel.distance + wheel.along + wheel.normal[0]));
    CHECK((wheel.place.element >= 0 && std::abs(wheel.place.xi) <= 1.0));
  }
}
