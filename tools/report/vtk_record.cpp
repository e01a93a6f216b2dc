#include "report/vtk_record.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "build/build.h"
#include "offline/section/rectangles.h"
#include "online/track/moving_load.h"
#include "run/track_motion.h"
#include "section/profile.h"
#include "section/section_file.h"
#include "text/read.h"
#include "text/write.h"

namespace railstep {
namespace {

using Polygon = std::vector<std::array<double, 2>>;

constexpr double kChord = 5e-4;  // m, by which a drawn outline may leave the true one
constexpr double kSleeperWidth = .25, kSleeperLength = 2.6, kSleeperHeight = .2;  // m

Polygon box(double width, double height) {
  return {{-.5 * width, 0.}, {.5 * width, 0.}, {.5 * width, height}, {-.5 * width, height}};
}

// The shape of a section as the scene gives it, from the foot's underside up.
Polygon shape_of(const ProfileFile& file, const Section&) {
  return polygon(read_profile(file.path).outline, kChord);
}
Polygon shape_of(const SectionFile& file, const Section& own) {
  const auto shape = read_dimensions(file.path);
  return shape ? polygon(*shape) : box(own.area.area / own.height, own.height);
}
Polygon shape_of(const Section&, const Section& own) {
  return box(own.area.area / own.height, own.height);
}
Polygon shape_of(const RectangleSizes& r, const Section&) {
  return polygon(Rectangles<double>{{r.foot_width, r.web_width, r.head_width},
                                    {r.foot_height, r.web_height, r.head_height}});
}
Polygon shape_of(const RectangleSize& r, const Section&) { return box(r.width, r.height); }

/// The outline of a rail about its axis.
Polygon outline_of(const Scene& scene, int rail) {
  const bool right = rail == kRightRail && scene.right_rail;
  const BarScene& bar = right ? *scene.right_rail : scene.rail;
  const Section own = rail_section_of(scene, rail).section;
  Polygon shape = std::visit([&](const auto& source) { return shape_of(source, own); }, bar.shape);
  for (auto& point : shape) point[1] -= own.area.centroid_height;
  return shape;
}

void add_rail(const Simulation& run, const TrackMotion& motion, int rail, const Polygon& outline,
              VtkMesh& mesh) {
  const Model& model = run.model();
  const Cant& cant = model.cant[rail];
  const auto sides = static_cast<std::int32_t>(outline.size());
  std::int32_t before = -1;
  const int nodes = run.track().nodes();
  for (int node = 0; node < nodes; ++node) {
    const std::array<double, 9> q = motion.node(rail, node);
    const auto first = static_cast<std::int32_t>(mesh.points());
    for (const auto& [y, z] : outline) {
      const double own[3] = {.5 * node * model.element_length, y, z};
      const double along[3] = {q[0] + y * q[3] + z * q[6], q[1] + y * q[4] + z * q[7],
                               q[2] + y * q[5] + z * q[8]};
      std::array<double, 3> rest, moved;
      to_track(cant, own, rest.data());
      to_track(cant, along, moved.data());
      mesh.add_point(
          vtk_vector({rest[0], model.rail_y[rail] + rest[1], model.rail_z[rail] + rest[2]}),
          vtk_vector(moved));
    }
    if (before >= 0)
      mesh.add_prism(VtkPart::rail, before, first, sides, node == 1, node == nodes - 1);
    before = first;
  }
}

/// A block under the rails' feet, or under the one rail, that moves as the sleeper's ends do.
void add_sleeper(const Track& track, const TrackMotion& motion, int seat, double foot_z,
                 VtkMesh& mesh) {
  const double x = seat * track.bay_length, length = track.rails == 2 ? kSleeperLength : 1.;
  std::array<std::array<double, 4>, 2> end;  // x, y, z, pitch of the left and right one
  for (std::size_t rail : {0u, 1u})
    end[rail] = motion.sleeper(track.rails == 2 ? static_cast<int>(rail) : 0, seat);
  std::int32_t first[2];
  for (const int side : {0, 1}) {
    const double y = (side == 0 ? .5 : -.5) * length;
    const double left = track.rails == 2 ? .5 + y / track.rail_spacing : 1.;  // weight of its end
    first[side] = static_cast<std::int32_t>(mesh.points());
    for (const auto& [along, up] : box(kSleeperWidth, -kSleeperHeight)) {
      std::array<double, 3> moved;
      for (std::size_t d = 0; d < 3; ++d) moved[d] = left * end[0][d] + (1. - left) * end[1][d];
      moved[2] -= along * (left * end[0][3] + (1. - left) * end[1][3]);
      mesh.add_point(vtk_vector({x + along, y, foot_z + up}), vtk_vector(moved));
    }
  }
  mesh.add_prism(VtkPart::sleeper, first[0], first[1], 4, true, true);
}

/// A disc about an axle, and the force on the rail under it.
void add_wheel(const Simulation& run, ContactId wheel, VtkMesh& mesh) {
  const ContactModel& contact = run.model().contact[wheel];
  const WheelsetModel& set = run.model().wheelset[contact.bodies];
  const double* p = run.state.u + set.first;
  const int side = contact.rail;
  const double x = set.start + p[0], y = run.model().rail_y[side];
  mesh.add_disc({x, y, set.rest_z}, set.radius, [&](double ahead, double beside, double up) {
    return std::array<double, 3>{-p[5] * (y + beside), p[1] + p[5] * ahead - p[3] * up,
                                 p[2] + p[3] * (y + beside)};
  });
  const Cant& cant = run.model().cant[side];
  const CrownTop top = crown_top(cant, run.model().head_z[side], run.model().crown_radius[side]);
  const double aside = cant.cosine * top.y - cant.sine * top.z;
  mesh.add_force(vtk_vector({x, y + aside, set.rest_z - set.radius}), vtk_vector({0., 0., p[2]}),
                 vtk_vector({0., 0., -run.state.contact_force[wheel]}));
}

void add_load(const Simulation& run, const LoadModel& load, VtkMesh& mesh) {
  const Model& model = run.model();
  const PlacedLoad at = place(model, load, run.state.steps);
  if (!at.on_rail) return;
  const double down = motion(model, at.row, {run.state.u, {run.state.u, run.state.v}});
  const double in_section[3] = {at.place, 0., model.head_z[load.rail]};
  std::array<double, 3> head;
  to_track(model.cant[load.rail], in_section, head.data());
  mesh.add_force(
      vtk_vector({head[0], model.rail_y[load.rail] + head[1], model.rail_z[load.rail] + head[2]}),
      vtk_vector({0., 0., down}), vtk_vector({0., 0., at.force}));
}

}  // namespace

VtkRecord::VtkRecord(const Scene& scene, const Simulation& run, std::filesystem::path folder,
                     std::int64_t frames)
    : run_(run), name_(scene.file.stem().string()), folder_(std::move(folder)), frames_(frames) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (!std::filesystem::is_directory(folder_))
    throw InputError("E-REPORT-06",
                     fmt::format("--vtk {}: no file can be written there ({}); expected a folder, "
                                 "or a name for a new one",
                                 folder_.string(), error ? error.message() : "it is a file"));
  outline_ = {outline_of(scene, kLeftRail), outline_of(scene, kRightRail)};
  for (const VehicleScene& v : scene.vehicles) vehicles_.push_back(drawn_vehicle(v));
}

VtkMesh VtkRecord::mesh() const {
  const Model& model = run_.model();
  const Track& track = run_.track();
  const TrackMotion motion(track, *run_.packed(), model, run_.state);
  VtkMesh mesh;
  for (std::int32_t i = 0; i < model.loads; ++i) add_load(run_, model.load[i], mesh);
  for (int rail = 0; rail < track.rails; ++rail)
    add_rail(run_, motion, rail, outline_[static_cast<std::size_t>(rail)], mesh);
  const auto lowest = [](const auto& a, const auto& b) { return a[1] < b[1]; };
  const double foot_z = (*std::min_element(outline_[0].begin(), outline_[0].end(), lowest))[1];
  for (int seat = 0; seat <= track.bays; ++seat)
    if (track.seat(seat).sleeper) add_sleeper(track, motion, seat, foot_z, mesh);
  for (const ContactId wheel : treads(model)) add_wheel(run_, wheel, mesh);
  for (std::size_t v = 0; v < vehicles_.size(); ++v)
    add_vehicle(run_, static_cast<int>(v), vehicles_[v], mesh);
  return mesh;
}

void VtkRecord::frame(std::int64_t done) {
  const std::int64_t intervals = std::min(kVtkTimes, frames_);
  const auto next = static_cast<std::int64_t>(files_.size());
  if (done * intervals < next * frames_) return;
  files_.push_back(fmt::format("{}_{:04d}.vtp", name_, next));
  times_.push_back(static_cast<double>(run_.state.steps) * run_.model().scheme.dt);
  write_file(folder_ / files_.back(), mesh().polydata());
}

void VtkRecord::finish() { write_file(folder_ / (name_ + ".pvd"), vtk_series(times_, files_)); }

}  // namespace railstep
