#include "offline/section/section_mesh.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include "offline/math/refuse.h"
#include "offline/section/delaunay.h"
#include "offline/section/outline.h"

namespace railstep {
namespace {

constexpr double kFlattest = 1.5;               // circumradius over shortest edge, 19.5 degrees
constexpr double kGrowth = 0.3;                 // of the triangle size with the distance
constexpr double kFinest = 0.01;                // of the triangle size, at a re-entrant corner
constexpr double kShortest = 1e-6;              // of the outline's size: never halved below
constexpr double kReentrant = 20.0 / 57.29578;  // rad beyond straight, more than any chorded arc
constexpr std::size_t kMostMeshPoints = 200000;
constexpr std::size_t kMostPieces = 20000;  // of the boundary: each point is held against each

Point middle(const Point& a, const Point& b) { return {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])}; }

double perimeter(const std::vector<Point>& outline) {
  double sum = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i)
    sum += distance(outline[i], outline[(i + 1) % outline.size()]);
  return sum;
}

/// True where the interior angle is over 200 degrees.
bool sharp(const Point& before, const Point& at, const Point& after) {
  const double along =
      (at[0] - before[0]) * (after[0] - at[0]) + (at[1] - before[1]) * (after[1] - at[1]);
  return std::atan2(orientation(before, at, after), along) < -kReentrant;
}

std::vector<Point> reentrant_corners(const std::vector<Point>& whole) {
  const std::size_t n = whole.size();
  std::vector<Point> found;
  for (std::size_t i = 0; i < n; ++i)
    if (sharp(whole[(i + n - 1) % n], whole[i], whole[(i + 1) % n])) found.push_back(whole[i]);
  return found;
}

/// Angles on the axis are those of the whole section.
std::vector<Point> reentrant_corners_of_half(const HalfPolygon& half) {
  const std::size_t n = half.size();
  std::vector<Point> found;
  for (std::size_t i = 1; i + 1 < n; ++i)
    if (sharp(half[i - 1], half[i], half[i + 1])) found.push_back(half[i]);
  if (sharp({-half[1][0], half[1][1]}, half[0], half[1])) found.push_back(half[0]);
  if (sharp(half[n - 2], half[n - 1], {-half[n - 2][0], half[n - 2][1]}))
    found.push_back(half[n - 1]);
  return found;
}

class Refiner {
 public:
  Refiner(const std::vector<Point>& outline, std::vector<Point> corners, double size)
      : outline_(outline),
        corners_(std::move(corners)),
        size_(size),
        shortest_(kShortest * perimeter(outline)),
        mesh_(outline[0], perimeter(outline)) {
    for (const Point& p : outline) mesh_.insert(p);
    const int n = static_cast<int>(outline.size());
    for (int i = 0; i < n; ++i) segments_.push_back({3 + i, 3 + (i + 1) % n});
    halve_encroached();
    for (std::size_t t = 0; t < mesh_.triangles().size(); ++t) queue_.push_back(t);
    queued_ = mesh_.triangles().size();
  }

  void run() {
    while (!queue_.empty()) {
      const std::size_t t = queue_.front();
      queue_.pop_front();
      if (is_bad(t)) improve(t);
      while (queued_ < mesh_.triangles().size()) queue_.push_back(queued_++);
    }
  }

  SectionMesh result() const {
    SectionMesh out;
    out.points.assign(mesh_.points().begin() + 3, mesh_.points().end());
    for (const Delaunay::Triangle& t : mesh_.triangles())
      if (belongs(t)) out.triangles.push_back({t.corner[0] - 3, t.corner[1] - 3, t.corner[2] - 3});
    return out;
  }

 private:
  const Point& at(int i) const { return mesh_.points()[static_cast<std::size_t>(i)]; }

  bool belongs(const Delaunay::Triangle& t) const {
    if (!t.alive || *std::min_element(t.corner.begin(), t.corner.end()) < 3) return false;
    return is_inside(outline_, centroid(t));
  }

  Point centroid(const Delaunay::Triangle& t) const {
    const Point &a = at(t.corner[0]), &b = at(t.corner[1]), &c = at(t.corner[2]);
    return {(a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0};
  }

  double wanted_size(const Point& p) const {
    double wanted = size_;
    for (const Point& corner : corners_)
      wanted = std::min(wanted, kFinest * size_ + kGrowth * distance(corner, p));
    return wanted;
  }

  bool is_bad(std::size_t index) const {
    const Delaunay::Triangle& t = mesh_.triangles()[index];
    if (!t.alive || *std::min_element(t.corner.begin(), t.corner.end()) < 3) return false;
    const Point &a = at(t.corner[0]), &b = at(t.corner[1]), &c = at(t.corner[2]);
    const double ab = distance(a, b), bc = distance(b, c), ca = distance(c, a);
    const double shortest = std::min({ab, bc, ca});
    const double radius = ab * bc * ca / (2.0 * orientation(a, b, c));
    const bool flat = radius > kFlattest * shortest && shortest > shortest_;
    // An equilateral triangle's edge is sqrt(3) circumradii.
    return (flat || 1.7320508 * radius > wanted_size(centroid(t))) && belongs(t);
  }

  Point circumcentre(const Delaunay::Triangle& t) const {
    const Point &a = at(t.corner[0]), &b = at(t.corner[1]), &c = at(t.corner[2]);
    const double bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
    const double twice = 2.0 * (bx * cy - by * cx);
    const double bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    return {a[0] + (cy * bb - by * cc) / twice, a[1] + (bx * cc - cx * bb) / twice};
  }

  /// p lies within the circle on the segment as diameter (its ends do not).
  bool encroaches(const Point& p, const std::array<int, 2>& segment) const {
    const Point &a = at(segment[0]), &b = at(segment[1]);
    if (p == a || p == b) return false;
    return (a[0] - p[0]) * (b[0] - p[0]) + (a[1] - p[1]) * (b[1] - p[1]) < 0.0;
  }

  /// Adds the circumcentre, or halves the boundary pieces it would encroach upon.
  void improve(std::size_t t) {
    const Point centre = circumcentre(mesh_.triangles()[t]);
    bool rejected = false, halved = false;
    for (std::size_t s = 0, n = segments_.size(); s < n; ++s) {
      if (!encroaches(centre, segments_[s])) continue;
      rejected = true;
      halved = halve(s) || halved;
    }
    if (halved) {
      halve_encroached();
      queue_.push_back(t);  // looked at again if it is still there
    }
    if (rejected || !is_inside(outline_, centre)) return;
    mesh_.insert(centre);
    check_count();
  }

  bool halve(std::size_t s) {
    const std::array<int, 2> segment = segments_[s];
    if (distance(at(segment[0]), at(segment[1])) < 2.0 * shortest_) return false;
    const int mid = mesh_.insert(middle(at(segment[0]), at(segment[1])));
    segments_[s] = {segment[0], mid};
    segments_.push_back({mid, segment[1]});
    check_count();
    return true;
  }

  /// Until no point encroaches; pairs of point and segment seen before are skipped, which is sound
  /// because the circle of half a segment lies within that of the whole.
  void halve_encroached() {
    for (bool again = true; again;) {
      again = false;
      const std::size_t known = mesh_.points().size();
      for (std::size_t s = 0; s < segments_.size(); ++s) {
        std::size_t p = s < checked_segments_ ? checked_points_ : 3;
        while (p < mesh_.points().size()) {
          if (encroaches(mesh_.points()[p], segments_[s]) && halve(s))
            again = true;  // the shorter segment against the same point
          else
            ++p;
        }
      }
      checked_points_ = known;
      checked_segments_ = segments_.size();
    }
  }

  void check_count() const {
    if (mesh_.points().size() <= kMostMeshPoints && segments_.size() <= kMostPieces) return;
    refuse("E-SECTION-27",
           "the outline of the section is too fine or has a part too narrow: its triangles need "
           "more than " +
               std::to_string(kMostMeshPoints) + " points, or more than " +
               std::to_string(kMostPieces) +
               " of them on the outline; expected fewer points, and no sliver");
  }

  std::vector<Point> outline_, corners_;
  double size_, shortest_;
  Delaunay mesh_;
  std::vector<std::array<int, 2>> segments_;  // pieces of the outline and of the axis
  std::deque<std::size_t> queue_;             // triangles to look at, oldest first
  std::size_t queued_ = 0;
  std::size_t checked_points_ = 3, checked_segments_ = 0;
};

}  // namespace

SectionMesh mesh_half(const HalfPolygon& half, double size) {
  Refiner refiner(half, reentrant_corners_of_half(half), size);
  refiner.run();
  return refiner.result();
}

SectionMesh mesh_whole(const std::vector<std::array<double, 2>>& polygon, double size) {
  Refiner refiner(polygon, reentrant_corners(polygon), size);
  refiner.run();
  return refiner.result();
}

}  // namespace railstep
