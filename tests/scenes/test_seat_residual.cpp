// Static flexibility of the rails under the wheels of vehicles in space: with the residual
// flexibility it is that of the exact track, whatever the model keeps of it.
#include <Eigen/SparseCholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/pack/pack.h"
#include "offline/start/static_lines.h"
#include "online/contact/wheel_seat.h"
#include "online/model/progress.h"
#include "online/runner/runner_contact.h"
#include "run/simulation.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

using Eigen::Matrix3d;
using Settings = std::vector<std::string>;

/// Displacements of the first seat of either side along its rows by unit forces along them: of the
/// lines alone, and with the residual flexibility.
struct Flexibility {
  Matrix3d lines, whole;
};

std::vector<Flexibility> flexibility_of(const Settings& changes) {
  Settings all = {"irregularity.geometries=[\"gauge\"]"};
  all.insert(all.end(), changes.begin(), changes.end());
  const Built built(read_scene(shipped("manchester_ring"), all));
  const PackedModel& packed = *built.packed;
  const Model& model = packed.model();
  std::vector<double> memory(static_cast<std::size_t>(state_doubles(model)), 0.);
  const State s = state_on(model, memory.data());
  const Configuration at{s.u, {s.u, s.v}, track_offset(model, 0)};
  std::vector<Flexibility> found;
  for (int at_place = 0; at_place < 10; ++at_place) {
    const int side = at_place % 2;
    WheelSeatRow seat[kWheelSeatRows];
    RailForce place[kWheelSeatRows];
    SeatMotions motions;
    const double x = element_place(model, model.runner[0], 0, {0, 0.}) + .053 * at_place;
    locate_wheel_seat(model, at, model.runner[0], x, side, motions, seat, place);
    REQUIRE(seat[0].on_rail);
    Flexibility& own = found.emplace_back(Flexibility{Matrix3d::Zero(), Matrix3d::Zero()});
    for (const PackedLine& line : packed.lines()) {
      const bool banded = model.form == Form::banded;
      Eigen::MatrixXd rows(line.line.unknowns(), kWheelSeatRows);
      for (int k = 0; k < kWheelSeatRows; ++k)
        rows.col(k) = contact_row(line.line, seat[k].row, banded);
      if (banded) {
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(line.line.stiffness);
        own.lines += rows.transpose() * factor.solve(rows);
        continue;
      }
      Eigen::MatrixXd modal(line.basis.omega.size(), kWheelSeatRows);
      for (int k = 0; k < kWheelSeatRows; ++k)
        modal.col(k) = line.basis.shapes.project(Eigen::VectorXd(rows.col(k)));
      own.lines += modal.transpose() * line.basis.static_response(modal);
    }
    const SeatFlexibility more = seat_flexibility(model, model.runner[0], side, place[1]);
    own.whole = own.lines;
    for (int i = 0; i < kWheelSeatRows; ++i)
      for (int j = 0; j < kWheelSeatRows; ++j) own.whole(i, j) += more.along[i][j];
  }
  return found;
}

/// Largest difference of the entries, of a_ij over sqrt(a_ii a_jj).
double apart(const Matrix3d& a, const Matrix3d& b) {
  const Eigen::Vector3d scale = b.diagonal().cwiseSqrt().cwiseInverse();
  return (scale.asDiagonal() * (a - b) * scale.asDiagonal()).cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("the residual flexibility of seats makes models of any detail give way alike",
          "[rail_vehicle]") {
  const std::string cant = GENERATE("rail.cant=0.0", "rail.cant=\"1:20\"");
  // Twice the elements are nearer to the exact track, which 16 parts of an element stand for.
  const std::vector<Flexibility> exact =
      flexibility_of({cant, "condense.kind=\"full\"", "track.elements_per_bay=8"});
  struct Detail {
    Settings changes;
    double missed;  // at least, without the residual flexibility
  };
  for (const Detail& detail : {Detail{{"condense.modes_per_bay=2"}, .1},
                               {{"condense.modes_per_bay=8"}, .02},
                               {{"condense.kind=\"full\""}, .002}}) {
    Settings changes = detail.changes;
    changes.push_back(cant);
    const std::vector<Flexibility> own = flexibility_of(changes);
    double most = 0., without = 0.;
    for (std::size_t i = 0; i < own.size(); ++i) {
      most = std::max(most, apart(own[i].whole, exact[i].whole));
      without = std::max(without, apart(own[i].lines, exact[i].whole));
    }
    CAPTURE(changes, most, without);
    CHECK(most < 2e-3);
    CHECK(without > detail.missed);
  }
}
