#include "offline/irregularity/rails.h"

#include "offline/math/refuse.h"

namespace railstep {

namespace {

/// mean + factor * difference
Signal combined(const Signal& mean, const Signal& difference, double factor) {
  if (difference.coefficient.empty()) return mean;
  Signal sum = mean;
  if (mean.coefficient.empty()) {
    sum = difference;
    for (double& c : sum.coefficient) c = 0.;
  }
  if (sum.coefficient.size() != difference.coefficient.size() || sum.start != difference.start ||
      sum.step != difference.step || sum.periodic != difference.periodic)
    refuse("E-IRREGULARITY-09",
           "the geometries of a track stand at different places; expected the same places");
  for (std::size_t i = 0; i < sum.coefficient.size(); ++i)
    sum.coefficient[i] += factor * difference.coefficient[i];
  return sum;
}

}  // namespace

RailSignals rails_of(const std::array<Signal, kGeometries>& geometry) {
  const auto of = [&](Geometry g) -> const Signal& {
    return geometry[static_cast<std::size_t>(g)];
  };
  RailSignals rails;
  for (std::size_t rail = 0; rail < 2; ++rail) {
    const double half = rail == 0 ? .5 : -.5;
    rails.z[rail] = combined(of(Geometry::vertical), of(Geometry::cross_level), half);
    rails.y[rail] = combined(of(Geometry::alignment), of(Geometry::gauge), half);
  }
  return rails;
}

}  // namespace railstep
