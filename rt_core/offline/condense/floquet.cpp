#include "offline/condense/floquet.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

#include "offline/irregularity/sincos.h"
#include "offline/math/refuse.h"

namespace railstep {

namespace {

/// e^(2 pi i t), the same bits on every machine.
std::complex<double> phase(double t) {
  const CosineSine at = cosine_sine(t);
  return {at.cosine, at.sine};
}

/// One unknown of a bay, and its mirror image about the seat at the bay's start.
struct CellUnknown {
  int at;        // among the line's unknowns, in bay 0; later bays follow at equal steps
  int mirror;    // index of its image among the cell's
  bool is_next;  // the image lies a bay further back: nodes between the seats
  bool on_seat;  // it is its own image, at the bay's start
  double sign;   // of the image: -1 along x
};

bool flips_along(int k) { return k == 0 || k == 3 || k == 6; }  // r_x, a_x, b_x
bool flips_along(SleeperMotion motion) {
  return motion == kAlongX || motion == kYaw || motion == kPitch;
}

/// Whether unknown k of a node is a separate one: b_y of a section that does not strain is its a_z.
bool is_own(const Line& line, int k) { return !(line.rigid_section && k == 7); }

/// The unknowns of every bay, in the same order; [bays][unknowns of a bay].
std::vector<std::vector<int>> cells_of(const Track& ring, const Line& line) {
  const int per_bay = 2 * ring.elements_per_bay;
  std::vector<std::vector<int>> cells(static_cast<std::size_t>(ring.bays));
  for (int bay = 0; bay < ring.bays; ++bay) {
    std::vector<int>& cell = cells[static_cast<std::size_t>(bay)];
    const auto add = [&](int unknown) {
      if (unknown >= 0) cell.push_back(unknown);
    };
    for (const int rail : {0, 1}) {
      if (rail == 1 && line.mirrored) continue;
      for (int node = 0; node < per_bay; ++node)
        for (int k = 0; k < 9; ++k)
          if (is_own(line, k)) add(line.unknown(rail, bay * per_bay + node, k));
    }
    for (const int unknown : line.sleeper_unknown_of[static_cast<std::size_t>(bay)]) add(unknown);
  }
  return cells;
}

/// The unknowns of bay 0 with their images, in the order of cells_of().
std::vector<CellUnknown> mirrored_cell(const Track& ring, const Line& line) {
  const int per_bay = 2 * ring.elements_per_bay;
  std::vector<CellUnknown> cell;
  for (const int rail : {0, 1}) {
    if (rail == 1 && line.mirrored) continue;
    for (int node = 0; node < per_bay; ++node)
      for (int k = 0; k < 9; ++k) {
        const int unknown = line.unknown(rail, node, k);
        const int image = line.unknown(rail, node == 0 ? 0 : per_bay - node, k);
        if (unknown >= 0 && is_own(line, k))
          cell.push_back({unknown, image, node != 0, node == 0, flips_along(k) ? -1. : 1.});
      }
  }
  const auto& sleeper = line.sleeper_unknown_of[0];
  for (std::size_t motion = 0; motion < sleeper.size(); ++motion)
    if (sleeper[motion] >= 0)
      cell.push_back({sleeper[motion], sleeper[motion], false, true,
                      flips_along(static_cast<SleeperMotion>(motion)) ? -1. : 1.});
  for (CellUnknown& own : cell)
    own.mirror = static_cast<int>(
        std::find_if(cell.begin(), cell.end(),
                     [&](const CellUnknown& other) { return other.at == own.mirror; }) -
        cell.begin());
  return cell;
}

/// A(k) = sum A_d e^(i k d) of the blocks between bay 0 and its neighbours.
class Blocks {
 public:
  Blocks(const Eigen::SparseMatrix<double>& A, const std::vector<std::vector<int>>& cells) {
    const std::size_t n = cells[0].size();
    const std::size_t bay[3] = {cells.size() - 1, 0, 1};
    for (int d = 0; d < 3; ++d) {
      Eigen::MatrixXd& block = block_[d];
      block.resize(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
              A.coeff(cells[0][i], cells[bay[d]][j]);
    }
  }
  /// T' A(k) T, which is real if T rotates every vector until it is its own conjugate image.
  Eigen::MatrixXd real(std::complex<double> step, const Eigen::MatrixXcd& T) const {
    const Eigen::MatrixXcd A =
        std::conj(step) * block_[0] + block_[1].cast<std::complex<double>>() + step * block_[2];
    const Eigen::MatrixXcd rotated = T.adjoint() * A * T;
    if (!(rotated.imag().norm() <= 1e-9 * rotated.norm()))
      refuse("E-CONDENSE-13",
             "a bay of a ring is not its own mirror image about its seat; expected a bay that is "
             "symmetric");
    return .5 * (rotated.real() + rotated.real().transpose());
  }

 private:
  Eigen::MatrixXd block_[3];
};

/// Columns that do not change when they are mirrored and conjugated, a unitary basis. At k = 0 and
/// k = pi each is real or imaginary.
Eigen::MatrixXcd real_basis(const std::vector<CellUnknown>& cell, double m_over_n) {
  const std::complex<double> i(0., 1.), half = phase(.5 * m_over_n), whole = phase(m_over_n);
  const auto n = static_cast<Eigen::Index>(cell.size());
  Eigen::MatrixXcd T = Eigen::MatrixXcd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const CellUnknown& own = cell[static_cast<std::size_t>(j)];
    const Eigen::Index image = own.mirror;
    if (image == j) {
      const std::complex<double> at = own.on_seat ? 1. : half;
      T(j, j) = own.sign > 0. ? at : i * at;
    } else if (j < image) {
      const double part = std::sqrt(.5);
      T(j, j) = part;
      T(image, j) = own.sign * part * whole;
      T(j, image) = i * part;
      T(image, image) = -i * own.sign * part * whole;
    }
  }
  return T;
}

/// One real system of a wave number: some columns of T, and the modes they make.
struct Wave {
  Eigen::MatrixXcd T;
  Basis basis;
  DampedModes modes;
};

Line small_line(const Eigen::MatrixXd& M, const Eigen::MatrixXd& C, const Eigen::MatrixXd& K) {
  Line line{};
  line.mass = M.sparseView();
  line.damping = C.sparseView(1., 0.);
  line.end_damping.resize(line.damping.rows(), line.damping.cols());
  line.stiffness = K.sparseView();
  return line;
}

/// Eigenvalues 1/omega^2, which a massless unknown leaves finite.
Eigen::VectorXd softness(const Line& line) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
             Eigen::MatrixXd(line.mass), Eigen::MatrixXd(line.stiffness), Eigen::EigenvaluesOnly)
      .eigenvalues();
}

/// Number of modes kept of each system of one k: the lowest of all together.
std::vector<int> shares(const std::vector<Line>& systems, const ModalLimit& limit) {
  std::vector<std::pair<double, std::size_t>> all;
  const double least =
      std::isfinite(limit.highest_hz) ? std::pow(2. * M_PI * limit.highest_hz, -2) : 0.;
  for (std::size_t s = 0; s < systems.size(); ++s)
    for (const double soft : softness(systems[s]))
      if (soft > 1e-30 && soft >= least) all.emplace_back(-soft, s);
  std::sort(all.begin(), all.end());
  std::vector<int> count(systems.size(), 0);
  for (std::size_t i = 0; i < all.size() && i < static_cast<std::size_t>(limit.most); ++i)
    ++count[all[i].second];
  return count;
}

/// Columns of T that are real (or imaginary) at k = 0 and k = pi.
Eigen::MatrixXcd of_class(const Eigen::MatrixXcd& T, bool imaginary) {
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index j = 0; j < T.cols(); ++j)
    if ((T.col(j).real().norm() < T.col(j).imag().norm()) == imaginary) chosen.push_back(j);
  Eigen::MatrixXcd result(T.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t j = 0; j < chosen.size(); ++j)
    result.col(static_cast<Eigen::Index>(j)) = T.col(chosen[j]);
  return result;
}

/// Builds a ring's modes wave by wave.
class Builder {
 public:
  Builder(const Track& ring, const Line& line, const ModalLimit& limit)
      : bays_(ring.bays),
        limit_{static_cast<int>(std::lround(static_cast<double>(limit.most) / ring.bays)),
               limit.highest_hz},
        cells_(cells_of(ring, line)),
        cell_(mirrored_cell(ring, line)),
        mass_(line.mass, cells_),
        damping_(line.damping, cells_),
        stiffness_(line.stiffness, cells_) {}

  RingModes build() {
    for (int m = 0; 2 * m <= bays_; ++m) add(m);
    return gathered();
  }

 private:
  void add(int m) {
    const double t = static_cast<double>(m) / bays_;
    const Eigen::MatrixXcd T = real_basis(cell_, t);
    const bool alone = m == 0 || 2 * m == bays_;
    std::vector<Eigen::MatrixXcd> parts = {T};
    if (alone) parts = {of_class(T, false), of_class(T, true)};
    std::vector<Line> systems;
    systems.reserve(parts.size());
    for (const Eigen::MatrixXcd& part : parts)
      systems.push_back(small_line(mass_.real(phase(t), part), damping_.real(phase(t), part),
                                   stiffness_.real(phase(t), part)));
    const std::vector<int> count = shares(systems, limit_);
    for (std::size_t s = 0; s < parts.size(); ++s) {
      if (count[s] == 0 && systems[s].damping.norm() == 0.) continue;
      const ModalLimit own{count[s], std::numeric_limits<double>::infinity()};
      Wave wave{parts[s], modal_basis(systems[s], own), {}};
      wave.modes = damped_modes(wave.basis, systems[s].damping);
      if (alone) {
        place(wave, m, s == 1, std::sqrt(1. / bays_), 0);
      } else {
        place(wave, m, false, std::sqrt(2. / bays_), 1);
        place(wave, m, true, std::sqrt(2. / bays_), -1);
      }
    }
  }

  /// @param partner  where its partner's modes stand from its own, in times of their number
  void place(const Wave& wave, int m, bool imaginary, double scale, int partner) {
    const std::complex<double> shift = phase(static_cast<double>(m) / bays_);
    const Eigen::Index modes = wave.modes.rate.size();
    for (Eigen::Index k = 0; k < modes; ++k) {
      partner_.push_back(static_cast<int>(count_ + k + partner * modes));
      // u(b + 1): Re e^(ik) (Re, Im) of x e^(ikb), the sine's part with the other sign
      cosine_.push_back(shift.real());
      sine_.push_back(partner == 0 ? 0. : (imaginary ? -shift.imag() : shift.imag()));
    }
    count_ += modes;
    omega_.insert(omega_.end(), wave.basis.omega.begin(), wave.basis.omega.end());
    shapes_.push_back({scale * (wave.T * wave.basis.shapes.dense()), m, imaginary});
    modes_.push_back(wave.modes);
  }

  RingModes gathered() {
    const auto vector = [](const std::vector<double>& values) {
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(
          values.data(), static_cast<Eigen::Index>(values.size())));
    };
    return {{vector(omega_), Shapes(std::move(cells_), std::move(shapes_))},
            std::move(modes_),
            std::move(partner_),
            vector(cosine_),
            vector(sine_)};
  }

  int bays_;
  ModalLimit limit_;
  std::vector<std::vector<int>> cells_;
  std::vector<CellUnknown> cell_;
  Blocks mass_, damping_, stiffness_;
  Eigen::Index count_ = 0;  // of modes
  std::vector<double> omega_, cosine_, sine_;
  std::vector<int> partner_;
  std::vector<Shapes::Wave> shapes_;
  std::vector<DampedModes> modes_;
};

}  // namespace

RingModes ring_modes(const Track& ring, const Line& line, const ModalLimit& limit) {
  return Builder(ring, line, limit).build();
}

}  // namespace railstep
