#pragma once
#include <ida/ida.h>
#include <sunlinsol/sunlinsol_band.h>

#include <utility>

#include "first_order.h"

namespace railstep {

/// The moving-load scene by SUNDIALS IDA: backward differences of variable order and step
/// (Hindmarsh and others 2005). The Jacobian is exact and banded.
class IdaPeer {
 public:
  IdaPeer(LinearTrack track, int passage_steps, const SundialsSettings& settings)
      : track_(std::move(track)), frames_(passage_steps) {
    const int size = 2 * track_.unknowns(), band = track_.half_band();
    check_sundials(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    for (N_Vector* v : {&y_, &rate_, &allowed_}) *v = N_VNew_Serial(size, context_);
    track_.allowed(settings.tolerance, allowed_);
    track_.rest(y_);
    track_.start_rate(rate_);
    matrix_ = SUNBandMatrix(size, band, band, context_);
    solver_ = SUNLinSol_Band(y_, matrix_, context_);
    memory_ = IDACreate(context_);
    check_sundials(IDAInit(memory_, residual, 0., y_, rate_), "IDAInit");
    check_sundials(IDASVtolerances(memory_, settings.tolerance, allowed_), "IDASVtolerances");
    check_sundials(IDASetUserData(memory_, this), "IDASetUserData");
    check_sundials(IDASetMaxNumSteps(memory_, 100000), "IDASetMaxNumSteps");  // within 1 ms
    check_sundials(IDASetMaxOrd(memory_, settings.order), "IDASetMaxOrd");
    check_sundials(IDASetLinearSolver(memory_, solver_, matrix_), "IDASetLinearSolver");
    check_sundials(IDASetJacFn(memory_, jacobian), "IDASetJacFn");
  }
  ~IdaPeer() {
    IDAFree(&memory_);
    SUNLinSolFree(solver_);
    SUNMatDestroy(matrix_);
    for (N_Vector v : {y_, rate_, allowed_}) N_VDestroy(v);
    SUNContext_Free(&context_);
  }
  IdaPeer(const IdaPeer&) = delete;
  IdaPeer& operator=(const IdaPeer&) = delete;

  /// One frame of 1 ms: the steps that the tolerance needs, then interpolation to its end. Returns
  /// the deflection under the first load, m.
  double frame() {
    if (done_ == frames_) restart();
    const double until = ++done_ * kStep;
    double reached = 0.;
    check_sundials(IDASolve(memory_, until, &reached, y_, rate_, IDA_NORMAL), "IDASolve");
    track_.take(y_);
    return track_.deflection(until);
  }

  void restart() {
    track_.rest(y_);
    track_.start_rate(rate_);
    check_sundials(IDAReInit(memory_, 0., y_, rate_), "IDAReInit");
    done_ = 0;
  }

  int frames() const { return frames_; }
  int unknowns() const { return track_.unknowns(); }
  /// Steps since the last restart.
  long steps() const {
    long count = 0;
    check_sundials(IDAGetNumSteps(memory_, &count), "IDAGetNumSteps");
    return count;
  }

 private:
  static int residual(double time, N_Vector y, N_Vector rate, N_Vector to, void* self) {
    static_cast<IdaPeer*>(self)->track_.residual(time, y, rate, to);
    return 0;
  }
  /// dF/dy + by_rate dF/dy'.
  static int jacobian(double, double by_rate, N_Vector, N_Vector, N_Vector, SUNMatrix J, void* self,
                      N_Vector, N_Vector, N_Vector) {
    const FirstOrderTrack& track = static_cast<IdaPeer*>(self)->track_;
    SUNMatZero(J);
    track.add_jacobian(J, 1.);
    track.add_mass(J, -by_rate, by_rate);
    return 0;
  }

  FirstOrderTrack track_;
  int frames_, done_ = 0;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr, rate_ = nullptr, allowed_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
  void* memory_ = nullptr;
};

}  // namespace railstep
