#pragma once
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

#include <stdexcept>
#include <string>

#include "support/pendulum_ancf.h"

namespace railstep {

/// Work that IDA did.
struct IdaCount {
  long steps = 0, residuals = 0, jacobians = 0, failed_error_tests = 0;
};

/// SUNDIALS IDA (variable order and step, backward differences; Hindmarsh and others 2005) on the
/// ANCF pendulum: F(y, y') = 0 with y = (q_0, v_0, q_1, v_1 ...), rows v_i - q_i' and
/// (M v' + f(q) - g)_i. The Jacobian is analytic and banded.
class IdaPendulum {
 public:
  /// @param tolerance  relative; absolute for q (m and 1), times kRate for v
  IdaPendulum(const AncfPendulum& pendulum, double tolerance, int largest_order = 5)
      : pendulum_(pendulum), n_(pendulum.unknowns()), state_(2 * n_), rate_of_v_(n_), force_(n_) {
    check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    y_ = N_VNew_Serial(2 * n_, context_);
    rate_ = N_VNew_Serial(2 * n_, context_);
    allowed_ = N_VNew_Serial(2 * n_, context_);
    const Eigen::VectorXd start = pendulum.start();
    Eigen::VectorXd slope(2 * n_);
    pendulum.slope(start, slope);
    for (int i = 0; i < n_; ++i) {
      at(y_, 2 * i) = start[i];
      at(y_, 2 * i + 1) = start[n_ + i];
      at(rate_, 2 * i) = slope[i];
      at(rate_, 2 * i + 1) = slope[n_ + i];
      at(allowed_, 2 * i) = tolerance;
      at(allowed_, 2 * i + 1) = kRate * tolerance;
    }
    const int band = 2 * pendulum.half_band() + 1;
    matrix_ = SUNBandMatrix(2 * n_, band, band, context_);
    solver_ = SUNLinSol_Band(y_, matrix_, context_);
    memory_ = IDACreate(context_);
    check(IDAInit(memory_, residual, 0., y_, rate_), "IDAInit");
    check(IDASVtolerances(memory_, tolerance, allowed_), "IDASVtolerances");
    check(IDASetUserData(memory_, this), "IDASetUserData");
    check(IDASetMaxNumSteps(memory_, 100000), "IDASetMaxNumSteps");  // between two samples
    check(IDASetMaxOrd(memory_, largest_order), "IDASetMaxOrd");
    check(IDASetLinearSolver(memory_, solver_, matrix_), "IDASetLinearSolver");
    check(IDASetJacFn(memory_, jacobian), "IDASetJacFn");
  }
  ~IdaPendulum() {
    IDAFree(&memory_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(matrix_);
    for (N_Vector v : {y_, rate_, allowed_}) N_VDestroy(v);
    SUNContext_Free(&context_);
  }
  IdaPendulum(const IdaPendulum&) = delete;
  IdaPendulum& operator=(const IdaPendulum&) = delete;

  /// Runs from rest, sampled every kPendulumSample. It may be called once.
  PendulumRun run(double until) {
    PendulumRun run{{kPendulumSample, {}}};
    sample(run);
    for (int i = 1; i <= std::lround(until / kPendulumSample); ++i) {
      double reached = 0.;
      check(IDASolve(memory_, i * kPendulumSample, &reached, y_, rate_, IDA_NORMAL), "IDASolve");
      sample(run);
    }
    return run;
  }

  IdaCount count() const {
    IdaCount c;
    check(IDAGetNumSteps(memory_, &c.steps), "IDAGetNumSteps");
    check(IDAGetNumResEvals(memory_, &c.residuals), "IDAGetNumResEvals");
    check(IDAGetNumJacEvals(memory_, &c.jacobians), "IDAGetNumJacEvals");
    check(IDAGetNumErrTestFails(memory_, &c.failed_error_tests), "IDAGetNumErrTestFails");
    return c;
  }

 private:
  // 1/s: the second bending frequency of the hanging links; most of the motion is slower.
  static constexpr double kRate = 100.;

  static void check(int code, const char* name) {
    if (code < 0) throw std::runtime_error(std::string(name) + ": " + std::to_string(code));
  }
  static double& at(N_Vector v, int i) { return N_VGetArrayPointer(v)[i]; }

  void take(N_Vector y) {
    for (int i = 0; i < n_; ++i) {
      state_[i] = at(y, 2 * i);
      state_[n_ + i] = at(y, 2 * i + 1);
    }
  }

  void sample(PendulumRun& run) {
    take(y_);
    run.path.at.push_back(pendulum_.seen(state_));
    run.energy_change = std::max(run.energy_change, std::abs(pendulum_.energy(state_)));
  }

  static int residual(double, N_Vector y, N_Vector rate, N_Vector result, void* self) {
    auto& s = *static_cast<IdaPendulum*>(self);
    s.take(y);
    s.pendulum_.residual_force(s.state_, s.force_);
    for (int i = 0; i < s.n_; ++i) {
      at(result, 2 * i) = s.state_[s.n_ + i] - at(rate, 2 * i);
      s.rate_of_v_[i] = at(rate, 2 * i + 1);
    }
    s.force_ += s.pendulum_.mass() * s.rate_of_v_;
    for (int i = 0; i < s.n_; ++i) at(result, 2 * i + 1) = s.force_[i];
    return 0;
  }

  /// dF/dy + by_rate dF/dy'.
  static int jacobian(double, double by_rate, N_Vector y, N_Vector, N_Vector, SUNMatrix J,
                      void* self, N_Vector, N_Vector, N_Vector) {
    auto& s = *static_cast<IdaPendulum*>(self);
    s.take(y);
    SUNMatZero(J);
    const auto entry = [J](int i, int j) -> double& { return SUNBandMatrix_Column(J, j)[i - j]; };
    for (int i = 0; i < s.n_; ++i) {
      entry(2 * i, 2 * i) = -by_rate;
      entry(2 * i, 2 * i + 1) = 1.;
    }
    const Eigen::SparseMatrix<double>& M = s.pendulum_.mass();
    for (int j = 0; j < s.n_; ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator it(M, j); it; ++it)
        entry(2 * static_cast<int>(it.row()) + 1, 2 * j + 1) = by_rate * it.value();
    s.pendulum_.tangent(s.state_, [&](int i, int j, double k) { entry(2 * i + 1, 2 * j) += k; });
    return 0;
  }

  const AncfPendulum& pendulum_;
  int n_;
  Eigen::VectorXd state_, rate_of_v_, force_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr, rate_ = nullptr, allowed_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
};

}  // namespace railstep
