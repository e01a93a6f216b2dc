#pragma once
#include <arkode/arkode_arkstep.h>
#include <sunlinsol/sunlinsol_band.h>

#include <utility>

#include "first_order.h"

namespace railstep {

/// The moving-load scene by SUNDIALS ARKODE: embedded Runge-Kutta methods of a fixed order and
/// variable step, diagonally implicit, M in a banded mass matrix factored once. ARKODE is told that
/// the problem is linear with a constant Jacobian, so a stage is one solve. No step goes past a
/// time at which the loads pass an element's border, where their forces on the nodes have a kink.
/// Between such times ARKODE chooses the steps, and results are interpolated.
class ArkodePeer {
 public:
  ArkodePeer(LinearTrack track, int passage_steps, const SundialsSettings& settings)
      : track_(std::move(track)), frames_(passage_steps) {
    const int size = 2 * track_.unknowns(), band = track_.half_band();
    check_sundials(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    for (N_Vector* v : {&y_, &allowed_}) *v = N_VNew_Serial(size, context_);
    track_.allowed(settings.tolerance, allowed_);
    track_.rest(y_);
    for (SUNMatrix* A : {&matrix_, &mass_}) *A = SUNBandMatrix(size, band, band, context_);
    solver_ = SUNLinSol_Band(y_, matrix_, context_);
    mass_solver_ = SUNLinSol_Band(y_, mass_, context_);
    memory_ = ARKStepCreate(nullptr, slope, 0., y_, context_);
    check_sundials(ARKStepSVtolerances(memory_, settings.tolerance, allowed_), "SVtolerances");
    check_sundials(ARKStepSetUserData(memory_, this), "SetUserData");
    check_sundials(ARKStepSetMaxNumSteps(memory_, 100000), "SetMaxNumSteps");  // within 1 ms
    check_sundials(ARKStepSetOrder(memory_, settings.order), "SetOrder");
    check_sundials(ARKStepSetMassLinearSolver(memory_, mass_solver_, mass_, SUNFALSE),
                   "SetMassLinearSolver");
    check_sundials(ARKStepSetMassFn(memory_, fill_mass), "SetMassFn");
    check_sundials(ARKStepSetLinearSolver(memory_, solver_, matrix_), "SetLinearSolver");
    check_sundials(ARKStepSetJacFn(memory_, jacobian), "SetJacFn");
    check_sundials(ARKStepSetLinear(memory_, 0), "SetLinear");
  }
  ~ArkodePeer() {
    ARKStepFree(&memory_);
    for (SUNLinearSolver s : {solver_, mass_solver_}) SUNLinSolFree(s);
    for (SUNMatrix A : {matrix_, mass_}) SUNMatDestroy(A);
    for (N_Vector v : {y_, allowed_}) N_VDestroy(v);
    SUNContext_Free(&context_);
  }
  ArkodePeer(const ArkodePeer&) = delete;
  ArkodePeer& operator=(const ArkodePeer&) = delete;

  /// One frame of 1 ms. Returns the deflection under the first load, m.
  double frame() {
    if (done_ == frames_) restart();
    const double until = ++done_ * kStep;
    double reached = 0.;
    if (until > border_ + 1e-9) {  // s; borders are whole milliseconds apart or more
      border_ = track_.next_border(until);
      check_sundials(ARKStepSetStopTime(memory_, border_), "SetStopTime");
    }
    check_sundials(ARKStepEvolve(memory_, until, y_, &reached, ARK_NORMAL), "ARKStepEvolve");
    track_.take(y_);
    return track_.deflection(until);
  }

  void restart() {
    track_.rest(y_);
    check_sundials(ARKStepReInit(memory_, nullptr, slope, 0., y_), "ARKStepReInit");
    done_ = 0;
    border_ = 0.;
  }

  int frames() const { return frames_; }
  int unknowns() const { return track_.unknowns(); }
  /// Steps since the last restart.
  long steps() const {
    long count = 0;
    check_sundials(ARKStepGetNumSteps(memory_, &count), "ARKStepGetNumSteps");
    return count;
  }

 private:
  static int slope(double time, N_Vector y, N_Vector to, void* self) {
    static_cast<ArkodePeer*>(self)->track_.slope(time, y, to);
    return 0;
  }
  static int jacobian(double, N_Vector, N_Vector, SUNMatrix J, void* self, N_Vector, N_Vector,
                      N_Vector) {
    SUNMatZero(J);
    static_cast<ArkodePeer*>(self)->track_.add_jacobian(J, -1.);
    return 0;
  }
  static int fill_mass(double, SUNMatrix mass, void* self, N_Vector, N_Vector, N_Vector) {
    SUNMatZero(mass);
    static_cast<ArkodePeer*>(self)->track_.add_mass(mass, 1., 1.);
    return 0;
  }

  FirstOrderTrack track_;
  int frames_, done_ = 0;
  double border_ = 0.;  // s, no step goes past it
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr, allowed_ = nullptr;
  SUNMatrix matrix_ = nullptr, mass_ = nullptr;
  SUNLinearSolver solver_ = nullptr, mass_solver_ = nullptr;
  void* memory_ = nullptr;
};

}  // namespace railstep
