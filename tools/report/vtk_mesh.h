#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace railstep {

/// The part to which a polygon belongs; cell array "part" of the files.
enum class VtkPart : std::int32_t { rail, sleeper, wheel, force, body };

/// The mesh of one time, in VTK's terms: points at rest, their displacements, and the faces between
/// them.
class VtkMesh {
 public:
  using Vector = std::array<float, 3>;

  /// @returns the point's number
  std::int32_t add_point(const Vector& rest, const Vector& displacement,
                         const Vector& force = {0.F, 0.F, 0.F});
  /// A face between points, in order around it.
  void add_face(VtkPart part, const std::vector<std::int32_t>& points);
  /// A point that shows a force, N.
  void add_force(const Vector& at, const Vector& displacement, const Vector& force);
  /// The two outlines of a prism, both of `sides` points from `first` and `second` on, joined by
  /// faces and closed at its ends where asked for.
  void add_prism(VtkPart part, std::int32_t first, std::int32_t second, std::int32_t sides,
                 bool first_end, bool second_end);

  /// A wheel's disc about an axle across the track.
  /// @param centre  m
  /// @param moved   displacement of a point so far ahead of, beside and over the centre, m
  void add_disc(const std::array<double, 3>& centre, double radius,
                const std::function<std::array<double, 3>(double, double, double)>& moved);

  std::size_t points() const { return rest_.size(); }
  /// VTK XML PolyData, base64: point arrays displacement_m and force_n, cell array part.
  std::string polydata() const;

 private:
  std::vector<Vector> rest_, displacement_, force_;
  std::vector<std::int32_t> verts_, polys_, offsets_, part_;
};

VtkMesh::Vector vtk_vector(const std::array<double, 3>& v);

/// A time series for ParaView: one file of each time, s, beside it.
std::string vtk_series(const std::vector<double>& times, const std::vector<std::string>& files);

}  // namespace railstep
