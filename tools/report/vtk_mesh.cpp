#include "report/vtk_mesh.h"

#include <fmt/core.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

namespace railstep {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");

/// RFC 4648.
std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[word >> (18U - 6U * k) & 63U];
  }
  return text;
}

/// A <DataArray>: its size in bytes, then its values.
template <typename T>
std::string array(const char* name, int components, const std::vector<T>& values) {
  const auto size = static_cast<std::uint32_t>(values.size() * sizeof(T));
  std::vector<unsigned char> bytes(sizeof size + size);
  std::memcpy(bytes.data(), &size, sizeof size);
  if (size > 0) std::memcpy(bytes.data() + sizeof size, values.data(), size);
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}"
      "</DataArray>\n",
      std::is_same_v<T, std::int32_t> ? "Int32" : "Float32", name, components, base64(bytes));
}

constexpr double kWheelWidth = .13;  // m
constexpr std::int32_t kWheelSides = 48;

}  // namespace

VtkMesh::Vector vtk_vector(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

std::int32_t VtkMesh::add_point(const Vector& rest, const Vector& displacement,
                                const Vector& force) {
  rest_.push_back(rest);
  displacement_.push_back(displacement);
  force_.push_back(force);
  return static_cast<std::int32_t>(rest_.size()) - 1;
}

void VtkMesh::add_face(VtkPart part, const std::vector<std::int32_t>& points) {
  polys_.insert(polys_.end(), points.begin(), points.end());
  offsets_.push_back(static_cast<std::int32_t>(polys_.size()));
  part_.push_back(static_cast<std::int32_t>(part));
}

void VtkMesh::add_force(const Vector& at, const Vector& displacement, const Vector& force) {
  verts_.push_back(add_point(at, displacement, force));
}

void VtkMesh::add_prism(VtkPart part, std::int32_t first, std::int32_t second, std::int32_t sides,
                        bool first_end, bool second_end) {
  for (std::int32_t i = 0; i < sides; ++i) {
    const std::int32_t next = (i + 1) % sides;
    add_face(part, {first + i, second + i, second + next, first + next});
  }
  std::vector<std::int32_t> end(static_cast<std::size_t>(sides));
  std::iota(end.begin(), end.end(), first);
  if (first_end) add_face(part, end);
  std::iota(end.rbegin(), end.rend(), second);
  if (second_end) add_face(part, end);
}

void VtkMesh::add_disc(const std::array<double, 3>& centre, double radius,
                       const std::function<std::array<double, 3>(double, double, double)>& moved) {
  std::int32_t first[2];
  for (const int face : {0, 1}) {
    const double beside = (face == 0 ? -.5 : .5) * kWheelWidth;
    first[face] = static_cast<std::int32_t>(points());
    for (std::int32_t i = 0; i < kWheelSides; ++i) {
      const double angle = 2. * M_PI * i / kWheelSides;
      const double ahead = radius * std::sin(angle), up = radius * std::cos(angle);
      add_point(vtk_vector({centre[0] + ahead, centre[1] + beside, centre[2] + up}),
                vtk_vector(moved(ahead, beside, up)));
    }
  }
  add_prism(VtkPart::wheel, first[0], first[1], kWheelSides, true, true);
}

std::string VtkMesh::polydata() const {
  const auto flat = [](const std::vector<Vector>& vectors) {
    std::vector<float> values;
    for (const Vector& v : vectors) values.insert(values.end(), v.begin(), v.end());
    return values;
  };
  std::vector<std::int32_t> each(verts_.size());
  std::iota(each.begin(), each.end(), 1);
  // cells are numbered with the vertices first
  std::vector<std::int32_t> part(verts_.size(), static_cast<std::int32_t>(VtkPart::force));
  part.insert(part.end(), part_.begin(), part_.end());
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt32\">\n<PolyData>\n";
  text += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfPolys=\"{}\">\n",
                      rest_.size(), verts_.size(), offsets_.size());
  text += "<Points>\n" + array("rest_m", 3, flat(rest_)) + "</Points>\n";
  text += "<Verts>\n" + array("connectivity", 1, verts_) + array("offsets", 1, each) + "</Verts>\n";
  text +=
      "<Polys>\n" + array("connectivity", 1, polys_) + array("offsets", 1, offsets_) + "</Polys>\n";
  text += "<PointData Vectors=\"displacement_m\">\n" +
          array("displacement_m", 3, flat(displacement_)) + array("force_n", 3, flat(force_)) +
          "</PointData>\n<CellData Scalars=\"part\">\n" + array("part", 1, part) +
          "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  return text;
}

std::string vtk_series(const std::vector<double>& times, const std::vector<std::string>& files) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (std::size_t i = 0; i < times.size(); ++i)
    text += fmt::format("<DataSet timestep=\"{:.9g}\" file=\"{}\"/>\n", times[i], files[i]);
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace railstep
