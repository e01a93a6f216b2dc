// Project Chrono (9.0 and later) on the scenes of peers_table, in its columns:
// ChElementBeamANCF_3333, nonlinear, HHT, Eigen's sparse LU. It links only Chrono, which is often
// built for other vector instructions than railstep; references come from files.
//
// Usage: chrono_peer REFERENCES PENDULUM_CSV
//
// REFERENCES is the folder that `peers_table --references` wrote, PENDULUM_CSV
// tests/data/double_pendulum.csv. Prints the rows without their head.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "chrono/core/ChTypes.h"
#include "chrono/core/ChVector3.h"
#include "chrono/fea/ChElementBeamANCF_3333.h"
#include "chrono/fea/ChLinkNodeFrame.h"
#include "chrono/fea/ChLinkNodeNode.h"
#include "chrono/fea/ChMaterialBeamANCF.h"
#include "chrono/fea/ChMesh.h"
#include "chrono/fea/ChNodeFEAxyzDD.h"
#include "chrono/physics/ChBody.h"
#include "chrono/physics/ChLoad.h"
#include "chrono/physics/ChLoadContainer.h"
#include "chrono/physics/ChSystemSMC.h"
#include "chrono/solver/ChDirectSolverLS.h"
#include "chrono/timestepper/ChTimestepperHHT.h"
#include "reference_file.h"

namespace {

using namespace chrono;
using namespace chrono::fea;

constexpr double kStep = 1e-3, kBay = .6, kSpeed = 30., kForce = -50e3;  // s, m, m/s, N
constexpr std::size_t kStartUp = 50;                                     // steps, moving_load.h
constexpr int kRounds = 5;

/// Newton stops when the root mean square change of the accelerations is below this part of them
/// plus this in m/s2. With 1e-4 (1e-5 m/s2) and 1e-6 (1e-7) the errors have the same three digits
/// at 1.1 to 1.4 times the iterations.
constexpr double kTolerance = 1e-2;
/// AssemblyLevel::FULL of 9.0, AssemblyAnalysis::Level::FULL since.
constexpr int kFullAssembly = 0xFFFF;

/// When Newton's matrix is computed again. `kept`: only when Newton fails with the old one, which
/// releases after 9 offer. They also offer "never", which fails on the pendulum: 920 of 1000 steps
/// end at 20 iterations without convergence. On the moving load `kept` and "never" are the same.
enum class Jacobian { every_step, kept };

/// A spring and damper from a node to the ground in each direction. It gives its Jacobian, so
/// Chrono does not compute one by differences.
class Seat : public ChLoadCustom {
 public:
  Seat(std::shared_ptr<ChNodeFEAxyzDD> node, const ChVector3d& stiffness, double damping)
      : ChLoadCustom(node), node_(node), rest_(node->GetPos()), k_(stiffness), c_(damping) {}
  Seat* Clone() const override { return new Seat(*this); }
  bool IsStiff() override { return true; }
  void ComputeQ(ChState* x, ChStateDelta* w) override {
    load_Q.setZero(LoadGetNumCoordsVelLevel());
    for (int i = 0; i < 3; ++i) {
      const double moved = (x ? (*x)(i) : node_->GetPos()[i]) - rest_[i];
      const double speed = w ? (*w)(i) : node_->GetPosDt()[i];
      load_Q(i) = -k_[i] * moved - c_ * speed;
    }
  }
  void ComputeJacobian(ChState*, ChStateDelta*) override {
    for (int i = 0; i < 3; ++i) {
      GetJacobians()->K(i, i) = k_[i];
      GetJacobians()->R(i, i) = c_;
    }
  }

 private:
  std::shared_ptr<ChNodeFEAxyzDD> node_;
  ChVector3d rest_, k_;  // m, N/m
  double c_;             // N s/m
};

/// A straight beam along x that begins at a point: its nodes in order, with mid nodes between.
struct Beam {
  std::vector<std::shared_ptr<ChNodeFEAxyzDD>> node;

  Beam(ChMesh& mesh, std::shared_ptr<ChMaterialBeamANCF> material, const ChVector3d& start,
       double length, int elements, double height, double width) {
    for (int i = 0; i <= 2 * elements; ++i) {
      const ChVector3d at = start + ChVector3d(i * length / (2 * elements), 0, 0);
      node.push_back(
          chrono_types::make_shared<ChNodeFEAxyzDD>(at, ChVector3d(0, 1, 0), ChVector3d(0, 0, 1)));
      mesh.AddNode(node.back());
    }
    for (std::size_t e = 0; e + 2 < node.size(); e += 2) {
      auto element = chrono_types::make_shared<ChElementBeamANCF_3333>();
      element->SetNodes(node[e], node[e + 2], node[e + 1]);
      element->SetDimensions(length / elements, width, height);
      element->SetMaterial(material);
      element->SetAlphaDamp(0.);
      mesh.AddElement(element);
    }
  }
};

/// Sets when Newton's matrix is computed, by the names of 9.0 or of later releases, which throw if
/// Newton has not converged. @returns whether the release can do it
template <class Stepper>
bool set_jacobian(Stepper& stepper, Jacobian jacobian) {
  if constexpr (requires { typename Stepper::JacobianUpdate; }) {
    using Update = typename Stepper::JacobianUpdate;
    stepper.SetJacobianUpdateMethod(jacobian == Jacobian::kept ? Update::AUTOMATIC
                                                               : Update::EVERY_STEP);
    stepper.AcceptTerminatedStep(false);
    return true;
  } else {
    stepper.SetModifiedNewton(true);  // one matrix per step
    return jacobian == Jacobian::every_step;
  }
}

/// A system with a mesh, HHT with little damping and a direct solver.
struct Scene {
  ChSystemSMC system;
  std::shared_ptr<ChMesh> mesh = chrono_types::make_shared<ChMesh>();
  bool possible = true;

  Scene(double gravity, double alpha, Jacobian jacobian) {
    system.SetGravitationalAcceleration(ChVector3d(0, 0, -gravity));
    system.SetNumThreads(1, 1, 1);
    mesh->SetAutomaticGravity(gravity != 0.);
    system.Add(mesh);
    auto solver = chrono_types::make_shared<ChSolverSparseLU>();
    solver->UseSparsityPatternLearner(true);
    solver->LockSparsityPattern(true);
    system.SetSolver(solver);
    auto stepper = chrono_types::make_shared<ChTimestepperHHT>(&system);
    stepper->SetAlpha(alpha);
    stepper->SetMaxIters(20);
    stepper->SetRelTolerance(kTolerance);
    stepper->SetAbsTolerances(kTolerance);
    stepper->SetStepControl(false);
    possible = set_jacobian(*stepper, jacobian);
    system.SetTimestepper(stepper);
  }
};

/// Two rails on springs at every bay border, 50 kN moving on each.
class MovingLoad : public Scene {
 public:
  MovingLoad(int bays, Jacobian jacobian) : Scene(0., -.2, jacobian), bays_(bays) {
    const auto steel =
        chrono_types::make_shared<ChMaterialBeamANCF>(7850., 210e9, .3, .8497, .8497);
    const auto seats = chrono_types::make_shared<ChLoadContainer>();
    system.Add(seats);
    for (const double y : {0., 1.5}) {
      rails_.emplace_back(*mesh, steel, ChVector3d(0, y, 0), bays * kBay, bays, .2319, .0375);
      for (std::size_t border = 0; border < rails_.back().node.size(); border += 2)
        seats->Add(chrono_types::make_shared<Seat>(rails_.back().node[border],
                                                   ChVector3d(3e6, 3e7, 3e7), 3e4));
    }
  }
  int steps() const { return static_cast<int>(std::lround((bays_ - 1) * kBay / (kSpeed * kStep))); }
  int unknowns() const { return static_cast<int>(2 * 9 * rails_[0].node.size()); }

  /// One step; returns the deflection under the first load at its end, m. The load's force on the
  /// nodes is exact: only the nodes' positions interpolate the axis.
  double step() {
    const double scaled = .5 + kSpeed * kStep * ++done_ / kBay;
    const int element = std::min(static_cast<int>(scaled), bays_ - 1);
    const double xi = 2. * (scaled - element) - 1.;
    const double shape[3] = {.5 * xi * (xi - 1.), 1. - xi * xi, .5 * xi * (xi + 1.)};
    for (const Beam& rail : rails_) {
      for (int i = 0; i < 3; ++i) rail.node[last_ + i]->SetForce(VNULL);
      for (int i = 0; i < 3; ++i)
        rail.node[2 * element + i]->SetForce(ChVector3d(0, 0, kForce * shape[i]));
    }
    last_ = 2 * element;
    system.DoStepDynamics(kStep);
    double z = 0.;
    for (int i = 0; i < 3; ++i) z += shape[i] * rails_[0].node[last_ + i]->GetPos().z();
    return z;
  }

 private:
  int bays_, done_ = 0, last_ = 0;
  std::vector<Beam> rails_;
};

/// Two links of 0.40 m released from rest along +x; the hinge shares the axis' position.
class DoublePendulum : public Scene {
 public:
  DoublePendulum(int elements, Jacobian jacobian) : Scene(9.81, -.05, jacobian) {
    const auto soft = chrono_types::make_shared<ChMaterialBeamANCF>(7900., 210e6, .3, 1., 1.);
    const auto ground = chrono_types::make_shared<ChBody>();
    ground->SetFixed(true);
    system.Add(ground);
    for (const double x : {0., .4})
      links_.emplace_back(*mesh, soft, ChVector3d(x, 0, 0), .4, elements, .02, .03);
    const auto pin = chrono_types::make_shared<ChLinkNodeFrame>();
    pin->Initialize(links_[0].node.front(), ground);
    const auto hinge = chrono_types::make_shared<ChLinkNodeNode>();
    hinge->Initialize(links_[0].node.back(), links_[1].node.front());
    system.Add(pin);
    system.Add(hinge);
    // HHT starts the first step from the accelerations that it finds. C errs by 1.5 mm with those
    // that gravity gives, by 2.8 mm with none.
    system.DoAssembly(kFullAssembly);
  }
  int unknowns() const { return static_cast<int>(2 * 9 * links_[0].node.size()); }
  /// One step; returns the place of C, m.
  ChVector3d step() {
    system.DoStepDynamics(kStep);
    return links_[1].node.back()->GetPos();
  }

 private:
  std::vector<Beam> links_;
};

double computed_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

/// Runs `steps` steps of a fresh scene every round. Prints a row in the columns of peers_table.
template <class Make>
void print_row(const char* peer, const char* scene, int elements, double error,
               double reference_error, int steps, const std::string& from_start, const Make& make) {
  std::vector<double> us;
  int unknowns = 0;
  for (int round = 0; round < kRounds; ++round) {
    const auto run = make();
    run->step();  // sets up what is needed once
    const double start = computed_us();
    for (int i = 1; i < steps; ++i) run->step();
    us.push_back((computed_us() - start) / (steps - 1));
    unknowns = run->unknowns();
  }
  std::sort(us.begin(), us.end());
  std::printf("%s,%s,%d,%g,%.3g,%.2e,%.1e,%.3g,%.3g,%d,,%s\n", peer, scene, elements, kStep, us[2],
              error, reference_error, us[1], us[3], unknowns, from_start.c_str());
  std::fflush(stdout);
}

void moving_load(const std::string& folder, const char* peer, Jacobian jacobian) {
  for (const int bays : {4, 16, 64, 256}) {
    const auto make = [&] { return std::make_unique<MovingLoad>(bays, jacobian); };
    const auto run = make();
    if (!run->possible) return;
    const railstep::ReferenceFile want(folder + "/moving_load_" + std::to_string(bays) + ".csv");
    double error = 0., from_start = 0., peak = 0.;
    for (std::size_t i = 0; i < want.rows.size(); ++i) {
      const double z = want.rows[i][1], gap = std::abs(run->step() - z);
      from_start = std::max(from_start, gap);
      peak = std::max(peak, std::abs(z));
      if (i >= kStartUp) error = std::max(error, gap);
    }
    char all[32];
    std::snprintf(all, sizeof all, "%.2e", from_start / peak);
    print_row(peer, "moving_load", bays, error / peak, want.own_error, std::min(run->steps(), 300),
              all, make);
  }
}

void double_pendulum(const std::string& path, const char* peer, Jacobian jacobian) {
  const auto make = [&] { return std::make_unique<DoublePendulum>(4, jacobian); };
  const auto run = make();
  if (!run->possible) return;
  const railstep::ReferenceFile want(path);  // every 50 ms from 0 on: time, B, C
  double error = 0.;
  for (std::size_t i = 1; i < want.rows.size(); ++i) {
    ChVector3d c;
    for (int n = 0; n < 50; ++n) c = run->step();
    error = std::max(error, std::hypot(c.x() - want.rows[i][3], c.z() - want.rows[i][4]));
  }
  print_row(peer, "double_pendulum", 4, error, 1e-7, 1000, "", make);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: chrono_peer REFERENCES PENDULUM_CSV\n");
    return 2;
  }
  for (const Jacobian jacobian : {Jacobian::every_step, Jacobian::kept}) {
    const char* const peer =
        jacobian == Jacobian::kept ? "Chrono ANCF 3333 Jacobian kept" : "Chrono ANCF 3333";
    moving_load(argv[1], peer, jacobian);
    double_pendulum(argv[2], peer, jacobian);
  }
}
