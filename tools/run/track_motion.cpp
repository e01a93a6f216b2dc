#include "run/track_motion.h"

namespace railstep {
namespace {

Eigen::VectorXd displacements(const PackedLine& own, const LineModel& line, const State& state) {
  if (line.modal.count == 0)
    return Eigen::Map<const Eigen::VectorXd>(state.u + line.first, own.line.unknowns());
  const Eigen::Index modes = own.modes.rate().size();
  Eigen::VectorXcd z(modes);
  z.real() = Eigen::Map<const Eigen::VectorXd>(state.u + line.first, modes);
  z.imag() = Eigen::Map<const Eigen::VectorXd>(state.v + line.first, modes);
  return own.basis.shapes.displacement(own.modes.displacement(z));
}

}  // namespace

TrackMotion::TrackMotion(const Track& track, const PackedModel& packed, const Model& model,
                         const State& state)
    : track_(track), lines_(packed.lines()) {
  for (std::size_t l = 0; l < lines_.size(); ++l)
    u_.push_back(displacements(lines_[l], model.line[l], state));
}

std::array<double, 9> TrackMotion::node(int rail, int node) const {
  std::array<double, 9> q{};
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const Line& line = lines_[l].line;
    const double factor = line.rail_factor[static_cast<std::size_t>(rail)];
    for (int k = 0; k < 9; ++k)
      if (const int unknown = line.unknown(rail, node, k); unknown >= 0 && factor != 0.)
        q[static_cast<std::size_t>(k)] += factor * sign_of(line, rail, k) * u_[l][unknown];
  }
  return q;
}

std::array<double, 4> TrackMotion::sleeper(int rail, int seat) const {
  std::array<double, 4> moved{};
  for (std::size_t l = 0; l < lines_.size(); ++l)
    for (int d = 0; d < 4; ++d)
      moved[static_cast<std::size_t>(d)] +=
          sleeper_row(track_, lines_[l].line, rail, seat, d).dot(u_[l]);
  return moved;
}

}  // namespace railstep
