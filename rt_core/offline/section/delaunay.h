#pragma once

#include <array>
#include <vector>

namespace railstep {

/// Delaunay triangulation to which points are added one by one (Bowyer 1981, Watson 1981), inside
/// a large triangle whose corners are points 0, 1 and 2.
class Delaunay {
 public:
  using Point = std::array<double, 2>;
  struct Triangle {
    std::array<int, 3> corner;     // counter-clockwise
    std::array<int, 3> neighbour;  // across the edge opposite to the corner, -1 outside
    bool alive;                    // false once a later point has replaced it
  };

  /// @param centre, radius  every point to come is within `radius` of `centre`
  Delaunay(const Point& centre, double radius);

  /// Adds a point, replacing the triangles whose circumcircle it is in; new ones are appended.
  /// @return its index
  int insert(const Point& p);

  const std::vector<Point>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  struct Edge {  // of the cavity's border, the cavity on its left
    int from, to, outside;
  };

  int locate(const Point& p) const;
  int nearest(const Point& p) const;
  bool sees(int triangle, const Point& p) const;
  std::vector<Edge> carve(int start, const Point& p);
  void fill(const std::vector<Edge>& border, int apex);

  std::vector<Point> points_;
  std::vector<Triangle> triangles_;
};

/// Twice the signed area of a, b, c: positive when they turn left.
double orientation(const Delaunay::Point& a, const Delaunay::Point& b, const Delaunay::Point& c);

}  // namespace railstep
