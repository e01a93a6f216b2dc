#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "offline/math/sparse.h"
#include "offline/track/fixed_port.h"
#include "support/dense_newmark.h"
#include "support/one_sided_tracks.h"
#include "support/vehicles.h"

namespace railstep {

/// Two upright rails of 20 bays with given numbers of bogie wheels, loads and sleepers that hang
/// 0.2 mm over the ballast. Wheels fall on the rail, so they bounce.
struct House {
  Track track;
  Traffic traffic;
};

inline House full_house(int wheels, int hanging, int loads,
                        Unknowns unknowns = Unknowns::vertical) {
  House house;
  Track& t = house.track = s1_track(20, 1);
  t.unknowns = unknowns;
  t.ends = {RailEnd::pinned, RailEnd::pinned};
  for (int i = 0; i < hanging; ++i) t = with_gap(t, 2 + i / 2, 2e-4, i % 2 == 0, i % 2 == 1);
  BogieData bogie_data = kBogie;
  bogie_data.wheelbase = .7;
  bogie_data.carried = 2000.;
  for (int i = 0; 2 * i < wheels; ++i) {
    const bool whole = 2 * i + 1 < wheels;  // an odd wheel is a single mass
    RunningVehicle v = running(whole ? bogie(bogie_data) : point_mass(900.), 0., 20.);
    v.rail = i % 2;
    const int pair = i / 2;
    v.start = .9 + 1.3 * pair;
    v.falling = Falling{0., .05 + .01 * i};
    house.traffic.vehicles.push_back(v);
  }
  for (int i = 0; i < loads; ++i) {
    MovingLoad load;
    load.rail = i % 2;
    load.start = .5 + .3 * i;
    load.speed = -5. + i;
    load.stop = load.speed < 0. ? -1e3 : 1e3;
    load.force = -2e4 + 1e3 * i;
    house.traffic.loads.push_back(load);
  }
  house.traffic.head = kHead;
  return house;
}

/// One step of a house's track and traffic by the trapezoidal rule, dense and in long double:
///   M y'' + C y' + K y = p - sum of c f(c y - gap)
/// over the unknowns y of track and vehicles; c is the row of a wheel or a hanging sleeper. The
/// contacts' equations d + W f(d) = d_free are solved by Newton with halved steps. The program
/// provides only the matrices of lines and vehicles and the rows of points.
class DenseHouse {
 public:
  struct Step {
    Dense y, force;  // unknowns at the step's end; forces of wheels, then of hanging sleepers, N
    bool solved = false;
  };

  DenseHouse(const House& house, const ModelRun& run) : house_(house), run_(run) {
    const std::vector<PackedLine>& lines = run.packed->lines();
    for (std::size_t l = 0; l < lines.size(); ++l)
      add(lines[l].line.mass, lines[l].line.damping, lines[l].line.stiffness,
          run.model().line[l].first);
    for (std::size_t v = 0; v < house.traffic.vehicles.size(); ++v) {
      const VehicleMatrices m = vehicle_matrices(house.traffic.vehicles[v].vehicle);
      first_of_vehicle_.push_back(n_);
      add(m.mass.sparseView(), m.damping.sparseView(), m.stiffness.sparseView(),
          run.model().vehicle[v].first);
      for (Eigen::Index k = 0; k < m.weight.size(); ++k) weight_.push_back(m.weight[k]);
    }
    const long double h = run.model().scheme.dt;
    Dense S(n_ * n_);
    for (std::size_t i = 0; i < S.size(); ++i) S[i] = 0.L;
    for (const Entry& e : entries_)
      S[e.row * n_ + e.column] += e.k + 2.L / h * e.c + 4.L / (h * h) * e.m;
    solver_ = std::make_unique<Eliminated>(std::move(S), n_);
    for (const FixedPort& port : fixed_ports(house.track)) ports_.push_back(port);
  }

  std::size_t unknowns() const { return n_; }
  /// Index of unknown i in the model's state.
  std::size_t in_state(std::size_t i) const { return place_[i]; }

  /// Steps from the present state of the run.
  Step step() const {
    const long double h = run_.model().scheme.dt, t = h * (run_.state.steps + 1);
    Dense p = outer(t);
    for (const Entry& e : entries_) {
      const std::size_t at = place_[e.column];
      const long double u = run_.state.u[at], v = run_.state.v[at], a = run_.state.a[at];
      p[e.row] += e.m * (4.L / (h * h) * u + 4.L / h * v + a) + e.c * (2.L / h * u + v);
    }
    const Dense free = solver_->solve(p);
    const std::vector<Dense> rows = contact_rows(t);
    std::vector<Dense> gives;
    gives.reserve(rows.size());
    for (const Dense& row : rows) gives.push_back(solver_->solve(row));
    const std::size_t n = rows.size();
    Dense W(n * n), d_free(n);
    for (std::size_t i = 0; i < n; ++i) {
      d_free[i] = product(rows[i], free) - gap(i);
      for (std::size_t j = 0; j < n; ++j) W[i * n + j] = product(rows[i], gives[j]);
    }
    Step made{free, Dense(n, 0.L), false};
    made.solved = solve(W, d_free, made.force);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n_; ++i) made.y[i] -= made.force[j] * gives[j][i];
    return made;
  }

 private:
  struct Entry {
    std::size_t row, column;
    long double m, c, k;
  };
  void add(const Sparse& M, const Sparse& C, const Sparse& K, std::int32_t first) {
    const Eigen::MatrixXd m(M), c(C), k(K);
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      for (Eigen::Index j = 0; j < m.rows(); ++j)
        if (m(i, j) != 0. || c(i, j) != 0. || k(i, j) != 0.)
          entries_.push_back({n_ + static_cast<std::size_t>(i), n_ + static_cast<std::size_t>(j),
                              m(i, j), c(i, j), k(i, j)});
      place_.push_back(static_cast<std::size_t>(first + i));
    }
    n_ += static_cast<std::size_t>(m.rows());
  }

  std::size_t wheels() const { return static_cast<std::size_t>(run_.model().vehicle_wheels); }
  long double gap(std::size_t contact) const {
    return contact < wheels() ? 0.L : ports_[contact - wheels()].gap;
  }

  /// Row of the rail's height at a place, over all unknowns.
  Dense rail_row(int rail, long double x) const {
    Dense row(n_, 0.L);
    std::size_t first = 0;
    for (const PackedLine& own : run_.packed->lines()) {
      const Eigen::VectorXd part =
          point_row(house_.track, own.line, {rail, static_cast<double>(x), 0., 0., 2});
      for (Eigen::Index i = 0; i < part.size(); ++i)
        row[first + static_cast<std::size_t>(i)] = part[i];
      first += static_cast<std::size_t>(part.size());
    }
    return row;
  }

  Dense outer(long double t) const {
    Dense p(n_, 0.L);
    for (const MovingLoad& load : house_.traffic.loads) {
      const Dense row = rail_row(load.rail, load.start + load.speed * t);
      for (std::size_t i = 0; i < n_; ++i) p[i] += load.force * row[i];
    }
    if (!first_of_vehicle_.empty())
      for (std::size_t i = 0; i < weight_.size(); ++i) p[first_of_vehicle_[0] + i] -= weight_[i];
    return p;
  }

  /// Rows of each contact's closing: the rail's height less the wheel's, then those of fixed ports.
  std::vector<Dense> contact_rows(long double t) const {
    std::vector<Dense> rows;
    for (std::size_t v = 0; v < house_.traffic.vehicles.size(); ++v) {
      const RunningVehicle& own = house_.traffic.vehicles[v];
      const Eigen::MatrixXd B = vehicle_matrices(own.vehicle).wheels;
      for (Eigen::Index w = 0; w < B.rows(); ++w) {
        const double place = own.vehicle.wheels[static_cast<std::size_t>(w)].place;
        rows.push_back(rail_row(own.rail, own.start + own.speed * t + place));
        for (Eigen::Index k = 0; k < B.cols(); ++k)
          rows.back()[first_of_vehicle_[v] + static_cast<std::size_t>(k)] -= B(w, k);
      }
    }
    for (std::size_t j = 0; j < ports_.size(); ++j) {
      Dense row;
      for (const PackedLine& own : run_.packed->lines()) {
        const Eigen::VectorXd part = own.closing.col(static_cast<Eigen::Index>(j));
        row.insert(row.end(), part.begin(), part.end());
      }
      row.resize(n_, 0.L);
      rows.push_back(row);
    }
    return rows;
  }

  static long double product(const Dense& a, const Dense& b) {
    long double sum = 0.L;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }

  /// Force of a contact and its slope over d. A fixed port's damper has the velocity that the
  /// trapezoidal rule gives for d.
  std::pair<long double, long double> law(std::size_t i, long double d, long double rate) const {
    if (!(d > 0.L)) return {0.L, 0.L};
    if (i < wheels()) {
      const long double C = run_.model().contact[i].law.hertz;
      return {C * d * std::sqrt(d), 1.5L * C * std::sqrt(d)};
    }
    const FixedPort& port = ports_[i - wheels()];
    const long double kv = 2.L / run_.model().scheme.dt;
    const long double jump = port.damping * rate;
    const long double rise = d < 1e-6L && jump > 0.L ? d / 1e-6L : 1.L;
    const long double slope = port.stiffness + port.damping * kv;
    const long double force = slope * d + jump * rise;
    if (!(force > 0.L)) return {0.L, 0.L};
    return {force, rise < 1.L ? slope + jump / 1e-6L : slope};
  }

  /// c y' - kv c y at the step's end, which by the trapezoidal rule follows from the step's start.
  Dense rates() const {
    const long double kv = 2.L / run_.model().scheme.dt;
    Dense rate(wheels() + ports_.size(), 0.L);
    for (std::size_t j = 0; j < ports_.size(); ++j) {
      std::size_t i = 0;
      long double sum = kv * ports_[j].gap;
      for (const PackedLine& own : run_.packed->lines())
        for (Eigen::Index k = 0; k < own.closing.rows(); ++k, ++i)
          sum -= own.closing.coeff(k, static_cast<Eigen::Index>(j)) *
                 (kv * run_.state.u[place_[i]] + run_.state.v[place_[i]]);
      rate[wheels() + j] = sum;
    }
    return rate;
  }

  /// Solves d + W f(d) = d_free. @returns whether it is met to round-off
  bool solve(const Dense& W, const Dense& d_free, Dense& f) const {
    const std::size_t n = d_free.size();
    const Dense rate = rates();
    Dense d = d_free, slope(n), left(n);
    for (std::size_t i = 0; i < n; ++i) d[i] = std::min(d[i], 1e-5L);
    const auto look = [&](const Dense& at) {
      long double size = 0.L;
      for (std::size_t i = 0; i < n; ++i) std::tie(f[i], slope[i]) = law(i, at[i], rate[i]);
      for (std::size_t i = 0; i < n; ++i) {
        left[i] = at[i] - d_free[i];
        for (std::size_t j = 0; j < n; ++j) left[i] += W[i * n + j] * f[j];
        size += left[i] * left[i];
      }
      return std::sqrt(size);
    };
    long double size = look(d);
    for (int turn = 0; turn < 300 && size > 1e-17L; ++turn) {
      Dense J(n * n);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          J[i * n + j] = W[i * n + j] * slope[j] + (i == j ? 1.L : 0.L);
      const Dense change = Eliminated(std::move(J), n).solve(left);
      const Dense from = d;
      const long double before = size;
      for (long double part = 1.L; part > 1e-9L; part *= .5L) {
        for (std::size_t i = 0; i < n; ++i) d[i] = from[i] - part * change[i];
        size = look(d);
        if (size < before) break;
      }
      if (!(size < before)) {
        size = look(from);
        break;
      }
    }
    return size < 1e-15L;
  }

  const House& house_;
  const ModelRun& run_;
  std::size_t n_ = 0;
  std::vector<std::size_t> place_, first_of_vehicle_;
  std::vector<Entry> entries_;
  Dense weight_;
  std::unique_ptr<Eliminated> solver_;
  std::vector<FixedPort> ports_;
};

}  // namespace railstep
