#pragma once
#include <Eigen/Core>

#include "online/model/state.h"

namespace railstep {

struct SystemEnergy {
  double kinetic = 0., strain = 0., springs = 0.;  // J
  double potential = 0.;                           // of weight, relative to the start, J
  double total() const { return kinetic + strain + springs + potential; }
};
SystemEnergy system_energy(const Model& model, const State& state);

}  // namespace railstep
