#include "offline/section/delaunay.h"

#include <algorithm>

namespace railstep {
namespace {

constexpr std::size_t next(std::size_t i) { return (i + 1) % 3; }

/// Positive when p is inside the circle through a, b, c (counter-clockwise). Taken about p, so that
/// the rounding is relative to the triangle's own size.
double in_circle(const Delaunay::Point& a, const Delaunay::Point& b, const Delaunay::Point& c,
                 const Delaunay::Point& p) {
  const double ax = a[0] - p[0], ay = a[1] - p[1];
  const double bx = b[0] - p[0], by = b[1] - p[1];
  const double cx = c[0] - p[0], cy = c[1] - p[1];
  return (ax * ax + ay * ay) * (bx * cy - cx * by) - (bx * bx + by * by) * (ax * cy - cx * ay) +
         (cx * cx + cy * cy) * (ax * by - bx * ay);
}

}  // namespace

double orientation(const Delaunay::Point& a, const Delaunay::Point& b, const Delaunay::Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

Delaunay::Delaunay(const Point& centre, double radius) {
  // Far enough that its corners stay outside the circle of every triangle that matters.
  const double far = 50.0 * radius;
  points_ = {{centre[0] - 2.0 * far, centre[1] - far},
             {centre[0] + 2.0 * far, centre[1] - far},
             {centre[0], centre[1] + 2.0 * far}};
  triangles_ = {{{0, 1, 2}, {-1, -1, -1}, true}};
}

/// Walks from the newest triangle towards p.
int Delaunay::locate(const Point& p) const {
  std::size_t t = triangles_.size() - 1;
  for (std::size_t steps = 0; steps < triangles_.size(); ++steps) {
    const Triangle& triangle = triangles_[t];
    int onward = -1;
    for (std::size_t i = 0; i < 3 && onward < 0; ++i) {
      const Point& a = points_[static_cast<std::size_t>(triangle.corner[next(i)])];
      const Point& b = points_[static_cast<std::size_t>(triangle.corner[next(next(i))])];
      if (orientation(a, b, p) < 0.0) onward = triangle.neighbour[i];
    }
    if (onward < 0) return static_cast<int>(t);
    t = static_cast<std::size_t>(onward);
  }
  return nearest(p);
}

/// A point that lies on an edge to rounding may be outside both triangles of the edge, and the walk
/// would go to and fro between them. Then this returns the triangle that the point is least outside
/// of, relative to the area.
int Delaunay::nearest(const Point& p) const {
  int best = -1;
  double inmost = 0.0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (!triangles_[t].alive) continue;
    const auto corner = [&](std::size_t i) {
      return points_[static_cast<std::size_t>(triangles_[t].corner[i])];
    };
    const double area = orientation(corner(0), corner(1), corner(2));
    const double least =
        std::min({orientation(corner(0), corner(1), p), orientation(corner(1), corner(2), p),
                  orientation(corner(2), corner(0), p)}) /
        area;
    if (best >= 0 && !(least > inmost)) continue;
    best = static_cast<int>(t);
    inmost = least;
  }
  return best;
}

bool Delaunay::sees(int triangle, const Point& p) const {
  const std::array<int, 3>& c = triangles_[static_cast<std::size_t>(triangle)].corner;
  return in_circle(points_[static_cast<std::size_t>(c[0])], points_[static_cast<std::size_t>(c[1])],
                   points_[static_cast<std::size_t>(c[2])], p) > 0.0;
}

/// Removes the triangles around `start` whose circle holds p; returns the border of the hole.
std::vector<Delaunay::Edge> Delaunay::carve(int start, const Point& p) {
  std::vector<Edge> border;
  std::vector<int> cavity{start};
  triangles_[static_cast<std::size_t>(start)].alive = false;
  const auto grow = [&](int t) {
    cavity.push_back(t);
    triangles_[static_cast<std::size_t>(t)].alive = false;
  };
  for (std::size_t k = 0; k < cavity.size(); ++k) {
    const Triangle t = triangles_[static_cast<std::size_t>(cavity[k])];
    for (std::size_t i = 0; i < 3; ++i) {
      const int beyond = t.neighbour[i];
      const bool open = beyond >= 0 && triangles_[static_cast<std::size_t>(beyond)].alive;
      if (open && sees(beyond, p)) grow(beyond);
    }
  }
  // Second pass, since a neighbour may have joined later; an edge in line with p would make a flat
  // triangle, so the one behind it goes too.
  for (std::size_t k = 0; k < cavity.size(); ++k) {
    const Triangle t = triangles_[static_cast<std::size_t>(cavity[k])];
    for (std::size_t i = 0; i < 3; ++i) {
      const int beyond = t.neighbour[i];
      if (beyond < 0 || !triangles_[static_cast<std::size_t>(beyond)].alive) continue;
      const Point& a = points_[static_cast<std::size_t>(t.corner[next(i)])];
      const Point& b = points_[static_cast<std::size_t>(t.corner[next(next(i))])];
      if (orientation(a, b, p) <= 0.0) grow(beyond);
    }
  }
  for (const int c : cavity) {
    const Triangle& t = triangles_[static_cast<std::size_t>(c)];
    for (std::size_t i = 0; i < 3; ++i) {
      const int beyond = t.neighbour[i];
      if (beyond < 0 || triangles_[static_cast<std::size_t>(beyond)].alive)
        border.push_back({t.corner[next(i)], t.corner[next(next(i))], beyond});
    }
  }
  return border;
}

/// Joins the new point to every edge of the hole's border.
void Delaunay::fill(const std::vector<Edge>& border, int apex) {
  const int base = static_cast<int>(triangles_.size());
  const int count = static_cast<int>(border.size());
  for (int k = 0; k < count; ++k) {
    const Edge& e = border[static_cast<std::size_t>(k)];
    Triangle made{{apex, e.from, e.to}, {e.outside, -1, -1}, true};
    for (int m = 0; m < count; ++m) {  // the border is short, so every pair may be looked at
      if (border[static_cast<std::size_t>(m)].from == e.to) made.neighbour[1] = base + m;
      if (border[static_cast<std::size_t>(m)].to == e.from) made.neighbour[2] = base + m;
    }
    triangles_.push_back(made);
    if (e.outside < 0) continue;
    Triangle& outer = triangles_[static_cast<std::size_t>(e.outside)];
    for (std::size_t i = 0; i < 3; ++i)
      if (outer.corner[next(i)] == e.to && outer.corner[next(next(i))] == e.from)
        outer.neighbour[i] = base + k;
  }
}

int Delaunay::insert(const Point& p) {
  const std::vector<Edge> border = carve(locate(p), p);
  points_.push_back(p);
  const int apex = static_cast<int>(points_.size()) - 1;
  fill(border, apex);
  return apex;
}

}  // namespace railstep
