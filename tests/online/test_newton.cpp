// Newton's method on laws at interfaces: against the convex solver of scalar laws, against a dense
// solution where laws are linear, and at its cap.
#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <unsupported/Eigen/AutoDiff>
#include <vector>

#include "online/contact/ports.h"
#include "online/math/newton.h"

using namespace railstep;

namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Eigen::VectorXd;

double between(double low, double high, std::mt19937& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Matrix compliance(int n, double size, std::mt19937& random) {
  Matrix B(n, n);
  for (double& b : B.reshaped()) b = between(-1., 1., random);
  return size / n * B * B.transpose();
}

std::vector<LawBlock> blocks_of(const std::vector<int>& sizes) {
  std::vector<LawBlock> blocks;
  int first = 0;
  for (const int size : sizes) {
    blocks.push_back({first, size, size});
    first += size;
  }
  return blocks;
}

double elimination_scratch[newton_scratch(kMostNewton, kMostNewton, kMostNewton* kMostLaw)];

/// A law whose slopes are one matrix [size][size], in two factors: one and the matrix.
template <typename Law>
struct Factored {
  const Law& law;
  const LawBlock* block;
  void operator()(int b, const double* z, double* force, const LawSlopes* slopes,
                  double*) const noexcept {
    law(b, z, force, slopes == nullptr ? nullptr : slopes->slope);
    const int size = block[b].size;
    for (int k = 0; k < size * size && slopes != nullptr; ++k)
      slopes->spread[k] = k % (size + 1) == 0 ? 1. : 0.;
  }
};
template <typename Law>
NewtonResult solve_whole(const NewtonProblem& p, const Law& law, double* force, double* z) {
  return solve_laws(p, Factored<Law>{law, p.block}, force, z);
}

/// Solves from where given forces lead. @param force  in: those of the step before
template <typename Law>
NewtonResult solve_from(const NewtonProblem& p, const Law& law, double* force, double* z) {
  for (int i = 0; i < p.n && i < kMostNewton; ++i) {
    z[i] = p.z_free[i];
    for (int j = 0; j < p.n; ++j) z[i] += p.Y[i * p.n + j] * force[j];
  }
  return solve_whole(p, law, force, z);
}

/// Scalar contacts in the terms of ports.h: penetration d = d_free - W f.
struct Contacts {
  const PortLaw* law;
  void operator()(int b, const double* z, double* force, double* slope) const noexcept {
    const double d = *z, C = law[b].hertz;
    const double root = d > 0. ? std::sqrt(d) : 0.;
    *force = -C * d * root;
    if (slope != nullptr) *slope = -1.5 * C * root;
  }
};

/// Forces -K z - c of each block.
struct Linear {
  std::vector<LawBlock> block;
  std::vector<Matrix> K;
  VectorXd c;
  void operator()(int b, const double* z, double* force, double* slope) const noexcept {
    const auto i = static_cast<std::size_t>(b);
    const int size = block[i].size;
    for (int k = 0; k < size; ++k) {
      force[k] = -c[block[i].first + k];
      for (int m = 0; m < size; ++m) {
        force[k] -= K[i](k, m) * z[m];
        if (slope != nullptr) slope[k * size + m] = -K[i](k, m);
      }
    }
  }
};

}  // namespace

TEST_CASE("frictionless contacts have the forces of the convex solver", "[newton]") {
  std::mt19937 random(3);
  for (const int n : {1, 2, 4, 8, 16})
    for (int trial = 0; trial < 200; ++trial) {
      const Matrix W = compliance(n, 3e-9, random);
      std::vector<PortLaw> law;
      VectorXd free(n);
      for (int i = 0; i < n; ++i) {
        law.push_back({between(.5e11, 2e11, random), 0., 0.});
        free[i] = between(-1e-4, 6e-4, random);
      }
      VectorXd f = VectorXd::Zero(n), d(n);
      REQUIRE(solve_ports(n, W.data(), law.data(), free.data(), f.data(), d.data()).status ==
              PortStatus::converged);
      const auto blocks = blocks_of(std::vector<int>(static_cast<std::size_t>(n), 1));
      // From the forces of a step before, which differ by a tenth and by a contact more or less.
      VectorXd force(n), z(n);
      for (int i = 0; i < n; ++i) force[i] = -f[i] * between(.9, 1.1, random);
      force[trial % n] = trial % 2 == 0 ? 0. : force[trial % n];
      const NewtonProblem p{n, n, W.data(), blocks.data(), free.data(), elimination_scratch};
      const NewtonResult met = solve_from(p, Contacts{law.data()}, force.data(), z.data());
      INFO(n << " contacts, trial " << trial << ", residual " << met.residual);
      CHECK(met.status == NewtonStatus::converged);
      CHECK((force + f).cwiseAbs().maxCoeff() <= 1e-10 * f.cwiseAbs().maxCoeff());
    }
}

namespace {

/// The same contacts; they may tell how steep they are.
struct TellingContacts {
  const PortLaw* law;
  bool tell;
  void operator()(int b, const double* z, double* force, const LawSlopes* slopes,
                  double* steep) const noexcept {
    double slope = 0.;
    Contacts{law}(b, z, force, &slope);
    if (tell) *steep = -slope;
    if (slopes == nullptr) return;
    *slopes->spread = 1.;
    *slopes->slope = slope;
  }
};

}  // namespace

TEST_CASE("laws that tell how steep they are take fewer iterations", "[newton]") {
  std::mt19937 random(7);
  constexpr int n = 8;
  int iterations = 0, silent = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Matrix Y = compliance(n, 3e-9, random);
    std::vector<PortLaw> law;
    VectorXd free(n), near(n);
    for (int i = 0; i < n; ++i) {
      law.push_back({between(.5e11, 2e11, random), 0., 0.});
      near[i] = between(3e-5, 1e-4, random);
    }
    VectorXd load(n);
    for (int i = 0; i < n; ++i)
      load[i] = law[static_cast<std::size_t>(i)].hertz * std::pow(near[i], 1.5);
    free = near + Y * load;  // so that the penetrations are `near`
    const auto blocks = blocks_of(std::vector<int>(n, 1));
    const NewtonProblem p{n, n, Y.data(), blocks.data(), free.data(), elimination_scratch};
    VectorXd start(n), force(n), z(n);
    for (int i = 0; i < n; ++i) start[i] = near[i] * between(.8, 1.2, random);
    z = start;
    const NewtonResult met =
        solve_laws(p, TellingContacts{law.data(), true}, force.data(), z.data());
    CHECK(met.status == NewtonStatus::converged);
    CHECK((z - near).cwiseAbs().maxCoeff() < 1e-10 * near.maxCoeff());
    iterations += met.iterations;
    z = start;
    silent += solve_laws(p, TellingContacts{law.data(), false}, force.data(), z.data()).iterations;
  }
  INFO(iterations << " iterations, " << silent << " without being told");
  CHECK(iterations < silent);
}

TEST_CASE("linear creep is solved in one iteration", "[newton]") {
  std::mt19937 random(5);
  for (const std::vector<int>& sizes :
       {std::vector<int>{6, 6, 6, 6}, {12, 12, 12, 12}, {12, 1, 6, 3, 1}, {1}, {}}) {
    Linear law;
    law.block = blocks_of(sizes);
    int n = 0;
    for (const int size : sizes) n += size;
    const Matrix Y = compliance(n, 1e-7, random);
    Matrix J = Matrix::Zero(n, n);
    for (const LawBlock& b : law.block) {
      // Dissipative and without symmetry, as creep with spin and rolling radii is.
      Matrix K = compliance(b.size, 1e7, random);
      for (int i = 0; i < b.size; ++i)
        for (int j = 0; j < i; ++j) {
          const double turn = between(-1e6, 1e6, random);
          K(i, j) += turn;
          K(j, i) -= turn;
        }
      J.block(b.first, b.first, b.size, b.size) = -K;
      law.K.push_back(K);
    }
    VectorXd free(n), force(n), z(n);
    law.c = VectorXd(n);
    for (int i = 0; i < n; ++i) {
      free[i] = between(-1e-3, 1e-3, random);
      law.c[i] = between(-1e4, 1e4, random);
      force[i] = between(-1e4, 1e4, random);
    }
    const NewtonProblem p{n,           static_cast<int>(sizes.size()),
                          Y.data(),    law.block.data(),
                          free.data(), elimination_scratch};
    const NewtonResult met = solve_from(p, law, force.data(), z.data());
    CHECK(met.status == NewtonStatus::converged);
    CHECK(met.iterations <= (n == 0 ? 0 : 1));
    const VectorXd wanted =
        (Matrix::Identity(n, n) - Y * J).partialPivLu().solve(VectorXd(free - Y * law.c));
    if (n > 0) CHECK((z - wanted).cwiseAbs().maxCoeff() < 1e-11 * wanted.cwiseAbs().maxCoeff());
    if (n > 0)
      CHECK((force - (J * wanted - law.c)).cwiseAbs().maxCoeff() <
            1e-10 * force.cwiseAbs().maxCoeff());
  }
}

namespace {

/// A contact with creep that saturates at its friction (Shen, Hedrick and Elkins), over penetration
/// and the slips along and across of a step. Slopes by automatic differentiation.
struct Saturating {
  double hertz, creep, friction;
  template <typename T>
  void forces(const T* z, T* force) const {
    using std::sqrt;
    const T depth = -z[0];
    const T normal = depth > 0. ? T(hertz * depth * sqrt(depth)) : T(0. * depth);
    const T slip = sqrt(z[1] * z[1] + z[2] * z[2] + 1e-24);
    const T most = friction * normal + 1e-9;
    const T u = creep * slip / most;
    const T size = u < 3. ? T(most * u * (1. - u / 3. + u * u / 27.)) : most;
    force[0] = normal;
    force[1] = -size * z[1] / slip;
    force[2] = -size * z[2] / slip;
  }
  void operator()(int, const double* z, double* force, double* slope) const noexcept {
    using Derived = Eigen::AutoDiffScalar<Eigen::Vector3d>;
    Derived at[3], f[3];
    for (int k = 0; k < 3; ++k) at[k] = Derived(z[k], 3, k);
    forces(at, f);
    for (int k = 0; k < 3; ++k) {
      force[k] = f[k].value();
      for (int m = 0; m < 3 && slope != nullptr; ++m) slope[3 * k + m] = f[k].derivatives()[m];
    }
  }
};

}  // namespace

TEST_CASE("creep that saturates is solved within the cap", "[newton]") {
  std::mt19937 random(9);
  const int wheels = 8, n = 3 * wheels;
  const auto blocks = blocks_of(std::vector<int>(wheels, 3));
  const Saturating law{1e11, 2e6, .3};
  int most = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Matrix Y = compliance(n, 3e-9, random);
    VectorXd free(n), force = VectorXd::Zero(n), z(n);
    for (int i = 0; i < n; ++i)
      free[i] = i % 3 == 0 ? between(-6e-4, -2e-4, random) : between(-.02, .02, random);
    const NewtonProblem p{n, wheels, Y.data(), blocks.data(), free.data(), elimination_scratch};
    static_cast<void>(solve_from(p, law, force.data(), z.data()));  // the step before
    // A step later all has moved by 2 %, some wheels from creep to slip or back.
    for (double& x : free) x *= between(.98, 1.02, random);
    const NewtonResult met = solve_from(p, law, force.data(), z.data());
    INFO("trial " << trial << ", residual " << met.residual);
    CHECK(met.status == NewtonStatus::converged);
    most = std::max(most, met.iterations);
    const VectorXd missed = z - free - Y * force;
    CHECK(missed.cwiseAbs().maxCoeff() < 1e-11 * z.cwiseAbs().maxCoeff());
    for (int w = 0; w < wheels; ++w)
      CHECK(force.segment(3 * w + 1, 2).norm() <= .3 * force[3 * w] * (1. + 1e-12) + 1.1e-9);
  }
  CHECK(most < kNewtonSweeps);
}

TEST_CASE("what Newton's method cannot solve has a status", "[newton]") {
  const double Y = 1., free = 1.;
  const LawBlock one{0, 1, 1};
  const NewtonProblem p{1, 1, &Y, &one, &free, elimination_scratch};
  double force = 0., z = 0.;
  // z = 1 + F(z) with F = z^2 has no real solution: the slope passes 1.
  const auto none = [](int, const double* at, double* f, double* slope) noexcept {
    *f = *at * *at;
    if (slope != nullptr) *slope = 2. * *at;
  };
  const NewtonResult lost = solve_from(p, none, &force, &z);
  CHECK(lost.status == NewtonStatus::cap_reached);
  CHECK(lost.residual > kNewtonTolerance);
  CHECK(std::isfinite(z));
  CHECK(force == z * z);
  // A law that moves with its coordinate leaves no pivot.
  const auto level = [](int, const double* at, double* f, double* slope) noexcept {
    *f = *at;
    if (slope != nullptr) *slope = 1.;
  };
  force = 0.;
  CHECK(solve_from(p, level, &force, &z).status == NewtonStatus::weak_pivot);
  // A root that is met too slowly: the best iterate, of a residual that is known.
  const auto flat = [](int, const double* at, double* f, double* slope) noexcept {
    const double x = *at - .5;
    *f = *at - 1. - x * x * x;
    if (slope != nullptr) *slope = 1. - 3. * x * x;
  };
  force = 0.;
  const NewtonResult slow = solve_from(p, flat, &force, &z);
  CHECK(slow.status == NewtonStatus::cap_reached);
  CHECK(slow.iterations == kNewtonSweeps);
  CHECK(slow.residual < .1);
  CHECK(std::fabs(z - .5) < .1);
  // Input that is not usable.
  const auto none_of = [](int, const double*, double*, double*) noexcept { FAIL("was called"); };
  force = std::numeric_limits<double>::quiet_NaN();
  CHECK(solve_from(p, none_of, &force, &z).status == NewtonStatus::bad_input);
  CHECK(force == 0.);
  const LawBlock gap{1, 1, 1};
  CHECK(solve_whole({1, 1, &Y, &gap, &free, elimination_scratch}, none_of, &force, &z).status ==
        NewtonStatus::bad_input);
  std::vector<double> forces(kMostNewton + 1), places(kMostNewton + 1);
  CHECK(solve_whole({kMostNewton + 1, 1, &Y, &one, &free, elimination_scratch}, none_of,
                    forces.data(), places.data())
            .status == NewtonStatus::bad_input);
}
