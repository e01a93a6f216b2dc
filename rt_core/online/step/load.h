#pragma once
#include "online/model/model.h"

namespace railstep {

/// Where a load stands at a step, over the undeformed rail, and what it weighs.
struct PlacedLoad {
  double x;      // m
  double force;  // N, 0 when taken off
  std::int32_t element;
  double shape[3];  // N1, N2, N3 at its place
  double xi;
  bool on_rail;
};

PlacedLoad place(const Model& model, const LoadModel& load, std::int64_t step) noexcept;

/// rhs += force * row, for the line's unknowns.
void spread(const LineModel& line, const LoadModel& load, const PlacedLoad& at,
            double* rhs) noexcept;

/// Vertical displacement of the loaded point, m: the lines' motion and the residual flexibility.
double deflection(const Model& model, const LoadModel& load, const PlacedLoad& at,
                  const double* u) noexcept;

}  // namespace railstep
