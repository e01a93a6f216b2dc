#include "offline/cost/line_cost.h"
#include "online/contact/system_coupling.h"
#include "online/model/system_workspace.h"

namespace railstep {

namespace {

constexpr Cost kBodySolve = branching(30, 30);  // S^-1 of six numbers
constexpr Cost kMotion = branching(37, 8);      // s(t)
constexpr Cost kSines = branching(80, 2);       // of an angle

/// Costs of one marker: its pose, its pose with rates, and its generalised force on its part. On
/// beams and rails they are those in space.
struct MarkerCost {
  Cost pose, jet, force;
};
MarkerCost marker_cost(PartKind kind) {
  if (kind == PartKind::ground) return {branching(0, 24), branching(0, 48), {}};
  if (kind == PartKind::body) return {branching(66, 40), branching(245, 80), branching(65, 40)};
  return {branching(170, 90), branching(500, 150), branching(165, 70)};
}

/// Costs of a chain's kernels for n elements and g groups of four, as the tests count them.
struct BeamCost {
  Cost tangents, factor, inertia, solve_four, solve_one;
};
BeamCost beam_cost(const SystemModel& s, const BeamChainModel& beam) {
  const std::int64_t n = beam.elements, g = straight_groups(beam.elements), u = beam.unknowns;
  const std::int64_t tangents = beam.planar != 0
                                    ? chain_tangent_doubles<kPlanarUnknowns>(beam.elements)
                                    : chain_tangent_doubles<9>(beam.elements);
  const std::int64_t factor = beam.planar != 0
                                  ? chain_factor_doubles<kPlanarUnknowns>(beam.elements)
                                  : chain_factor_doubles<9>(beam.elements);
  const bool mean = s.mean != 0;
  if (beam.planar != 0)
    return {spilling((mean ? 8026 : 7480) * g + 5 * n, tangents + 3 * u),
            spilling(4009 * g + 492 * n + 101, 2 * tangents + 2 * factor),
            spilling(144 * n + 2, 3 * u), spilling(1560 * n + 180, factor + 8 * u),
            spilling(1560 * g + 45, factor + 2 * u)};
  return {spilling((mean ? 26808 : 25552) * g + 9 * n, tangents + 3 * u),
          spilling(21009 * g + 2332 * n + 421, 2 * tangents + 2 * factor),
          spilling(252 * n + 2, 3 * u), spilling(5112 * n + 612, factor + 8 * u),
          spilling(5112 * g + 153, factor + 2 * u)};
}

/// Rows and ends of the parts, and entries of Newton's matrix.
class SystemCost {
 public:
  explicit SystemCost(const Model& model) : model_(model), s_(model.system) {}

  Cost step() const {
    const Cost solve = (s_.cap + std::int64_t{1}) * look() + s_.cap * newton();
    if (!couples_system(model_)) return start() + solve + leave() + finish();
    return start() + (kSystemPasses + std::int64_t{1}) * solve + coupled() + leave() + finish();
  }

 private:
  std::int64_t rows() const { return system_rows(s_); }
  MarkerCost at(std::int32_t marker) const { return marker_cost(s_.marker[marker].kind); }
  /// Cost of placing all markers except the sensors' once.
  Cost poses() const {
    Cost sum{};
    for (std::int32_t m = 0; m < s_.markers - s_.sensors; ++m) sum = sum + at(m).pose;
    return sum;
  }
  bool has_driven_angle(const RowModel& row) const {
    return row.kind == RowKind::square && row.motion >= 0;
  }
  Cost gradient(const RowModel& row) const {
    return branching(60, 60) + (has_driven_angle(row) ? kSines + branching(30, 10) : Cost{}) +
           at(row.a).force + at(row.b).force;
  }
  Cost rates(const RowModel& row) const {
    return motion() + branching(75, 60) +
           (has_driven_angle(row) ? kSines + branching(70, 20) : Cost{});
  }
  std::int64_t track_ends() const { return part_ends(s_, s_.bodies + s_.beams); }

  /// s(t) of a drive or a force.
  Cost motion() const { return kMotion + table_cost(s_.pieces); }

  /// Where the iterations begin.
  Cost start() const {
    const std::int64_t u = s_.unknowns;
    return work(2 * u, 4 * u) + s_.ports * (9 * model_.lines) * work(9, 9) +
           s_.bodies * branching(39, 13) + (s_.mean != 0 ? poses() : Cost{}) +
           std::int64_t{s_.spring_rows} * (motion() + branching(20, 20));
  }

  /// Parts placed, forces with their tangents and factors, rows with gradients and slopes.
  Cost look() const {
    const std::int64_t u = s_.unknowns, ends = s_.ends;
    Cost sum = work(9 * u, 14 * u) + s_.bodies * branching(s_.mean != 0 ? 245 : 230, 120) +
               poses() + s_.markers * branching(s_.mean != 0 ? 24 : 0, 24);
    for (std::int32_t b = 0; b < s_.beams; ++b) {
      const BeamCost beam = beam_cost(s_, s_.beam[b]);
      sum = sum + beam.tangents + beam.factor + beam.inertia;
    }
    sum = sum + work(0, 3 * u);
    for (std::int32_t f = 0; f < s_.forces; ++f)
      sum = sum + motion() + at(s_.force[f].marker).force + branching(50, 60);
    for (std::int32_t r = 0; r < rows(); ++r) sum = sum + row(r);
    if (s_.constraint_method == ConstraintMethod::baumgarte)
      sum = sum + work(2 * u, 3 * u) + s_.bodies * branching(180, 40) + poses();
    return sum + work(2 * kMostNodeUnknowns * ends, 3 * kMostNodeUnknowns * ends) +
           work(18 * u + 50 + 2 * rows(), 9 * u + rows());
  }

  /// Value, gradients, slopes and prescribed value of a row.
  Cost row(std::int32_t r) const {
    const RowModel& own = s_.row[r];
    const bool joint = r < s_.joint_rows;
    Cost sum =
        motion() + branching(25, 40) + (has_driven_angle(own) ? kSines : Cost{}) + gradient(own);
    if (has_slopes(s_)) sum = sum + gradient(own) + 2 * branching(30, 20);
    const bool plain = s_.constraint_method == ConstraintMethod::augmented_lagrangian ||
                       s_.constraint_method == ConstraintMethod::direct;
    if (joint ? !plain : s_.mean == 0) sum = sum + at(own.a).jet + at(own.b).jet + rates(own);
    return sum + branching(20, 20);
  }

  Cost ports() const {
    const std::int64_t n = 9 * s_.ports;
    return work(2 * n * n + 3 * n, n * n + 4 * n);
  }

  /// S^-1 of the gradients of all ends, and of the residual.
  Cost ends() const {
    Cost sum = work(s_.unknowns, 2 * s_.unknowns) + ports();
    for (std::int32_t b = 0; b < s_.bodies; ++b) sum = sum + (1 + part_ends(s_, b)) * kBodySolve;
    for (std::int32_t b = 0; b < s_.beams; ++b) {
      const BeamCost beam = beam_cost(s_, s_.beam[b]);
      const std::int64_t groups = beam_groups(s_, b);
      sum = sum + groups * (beam.solve_four + work(0, 4 * std::int64_t{s_.beam[b].unknowns})) +
            beam.solve_one;
    }
    const std::int64_t moved = 9 * std::int64_t{s_.ports};
    return sum + track_ends() * moved * work(18, 11);
  }

  /// The rows' compliance, part by part, and its factor; made twice at most.
  Cost compliance() const {
    const std::int64_t n = rows();
    std::int64_t pairs = 0;
    for (std::int32_t part = 0; part <= s_.bodies + s_.beams; ++part) {
      const std::int64_t own = part_ends(s_, part);
      const int unknowns = part < s_.bodies              ? 6
                           : part < s_.bodies + s_.beams ? kMostNodeUnknowns
                                                         : 9;
      pairs += own * own * (2 * unknowns + 1);
    }
    const Cost once = work(pairs + 3 * n, 2 * pairs + n * n) +
                      work(2 * n * n * n / 3 + 2 * n * n + n, n * n * n + 4 * n * n);
    return (s_.mean != 0 && s_.constraint_method == ConstraintMethod::augmented_lagrangian ? 2
                                                                                           : 1) *
           once;
  }

  Cost solve_rows() const {
    const std::int64_t n = rows();
    return work(2 * n * n + n, n * n + 5 * n);
  }

  /// Motion of all parts by forces in the rows.
  Cost moved() const {
    Cost sum = track_ends() * 9 * s_.ports * work(2, 3);
    for (std::int32_t b = 0; b < s_.bodies; ++b) sum = sum + part_ends(s_, b) * work(12, 18);
    for (std::int32_t b = 0; b < s_.beams; ++b)
      sum = sum + beam_groups(s_, b) * std::int64_t{s_.beam[b].unknowns} * work(8, 6);
    return sum;
  }
  Cost lines_moved() const {
    const std::int64_t n = model_.line_unknowns;
    return track_ends() * 9 * work(1 + 2 * n, 3 * n);
  }

  Cost newton() const {
    const std::int64_t u = s_.unknowns, along = kMostNodeUnknowns * std::int64_t{s_.ends};
    Cost sum = ends() + compliance() + work(2 * along, 3 * along) + solve_rows() + moved() +
               work(u + rows(), 7 * u + 3 * rows());
    if (s_.constraint_method == ConstraintMethod::gear_gupta_leimkuhler)
      sum = sum + solve_rows() + moved() + work(2 * u + rows(), 7 * u + 3 * rows());
    return sum;
  }

  /// Ports and contacts that move the same lines.
  Cost coupled() const {
    const std::int64_t n = 9 * s_.ports, contacts = port_count(model_);
    Cost read{}, back{};
    for (std::int32_t l = 0; l < model_.lines; ++l) {
      const LineCost line = line_cost(model_, model_.line[l]);
      read = read + track_row_count(model_) * line.wheel_row;
      if (model_.form == Form::condensed)
        read = read + track_row_count(model_) * line.read;
      else
        back = back + solve_cost(model_.line[l].step);
    }
    const std::int64_t closings = model_.form == Form::condensed
                                      ? std::int64_t{model_.fixed.count} * model_.line_unknowns
                                      : model_.fixed.entries;
    const Cost linear = work(4 * n * contacts, 3 * n * contacts);  // of ports by contacts, or back
    return back + n * (read + work(4 * closings, 4 * closings)) +
           contacts * (solve_rows() + work(2 * n + 40 * track_ends(), n + 40 * track_ends())) +
           (contacts + 6 * (kSystemPasses + std::int64_t{1})) * linear +
           (kSystemPasses + std::int64_t{1}) * track_ends() * work(20, 30);
  }

  Cost leave() const {
    return ports() + lines_moved() + work(2 * s_.unknowns, 4 * s_.unknowns + 2 * rows());
  }

  /// Velocities and accelerations projected.
  Cost finish() const {
    Cost sum = work(s_.unknowns, 3 * s_.unknowns);
    if (s_.constraint_method != ConstraintMethod::augmented_lagrangian || s_.mean != 0) return sum;
    if (s_.renew == Renew::kept) sum = sum + ends() + compliance();
    Cost looked{};
    std::int32_t at_a = -1, at_b = -1;  // rows of a joint share their markers
    for (std::int32_t r = 0; r < s_.joint_rows; ++r) {
      const RowModel& own = s_.row[r];
      looked = looked + rates(own);
      if (own.a != at_a) looked = looked + at(at_a = own.a).jet;
      if (own.b != at_b) looked = looked + at(at_b = own.b).jet;
    }
    const Cost once =
        solve_rows() + work(2 * rows(), 4 * rows()) + 2 * (moved() + lines_moved()) + looked;
    return sum + looked + 2 * std::int64_t{s_.projections} * once;
  }

  const Model& model_;
  const SystemModel& s_;
};

}  // namespace

Cost system_cost(const Model& model) {
  return model.system.unknowns > 0 ? SystemCost(model).step() : Cost{};
}

}  // namespace railstep
