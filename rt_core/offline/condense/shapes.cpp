#include "offline/condense/shapes.h"

#include <cstdint>

#include "offline/irregularity/sincos.h"

namespace railstep {

Shapes::Shapes(std::vector<std::vector<int>> cells, std::vector<Wave> waves)
    : cells_(std::move(cells)), waves_(std::move(waves)) {
  const auto bays = static_cast<int>(cells_.size());
  place_.resize(cells_.size() * cells_[0].size());
  around_.reserve(cells_.size());
  for (int bay = 0; bay < bays; ++bay) {
    const std::vector<int>& cell = cells_[static_cast<std::size_t>(bay)];
    for (std::size_t i = 0; i < cell.size(); ++i)
      place_[static_cast<std::size_t>(cell[i])] = {bay, static_cast<int>(i)};
    const CosineSine at = cosine_sine(static_cast<double>(bay) / bays);
    around_.emplace_back(at.cosine, at.sine);
  }
}

/// e^(i k b), times -i where the wave is an imaginary part: the real part of the product is used.
std::complex<double> Shapes::wave_phase(const Wave& wave, int bay) const {
  const std::int64_t whole = static_cast<std::int64_t>(wave.number) * bay;
  const std::complex<double> at =
      around_[static_cast<std::size_t>(whole % static_cast<std::int64_t>(around_.size()))];
  return wave.imaginary ? at * std::complex<double>(0., -1.) : at;
}

Eigen::Index Shapes::rows() const {
  return waves_.empty() ? dense_.rows() : static_cast<Eigen::Index>(place_.size());
}

Eigen::Index Shapes::cols() const {
  if (waves_.empty()) return dense_.cols();
  Eigen::Index sum = 0;
  for (const Wave& wave : waves_) sum += wave.x.cols();
  return sum;
}

Eigen::VectorXd Shapes::row(int unknown) const {
  if (waves_.empty()) return dense_.row(unknown);
  const Place at = place_[static_cast<std::size_t>(unknown)];
  Eigen::VectorXd result(cols());
  Eigen::Index first = 0;
  for (const Wave& wave : waves_) {
    result.segment(first, wave.x.cols()) =
        (wave_phase(wave, at.bay) * wave.x.row(at.index)).real().transpose();
    first += wave.x.cols();
  }
  return result;
}

Eigen::VectorXd Shapes::project(const Eigen::VectorXd& load) const {
  if (waves_.empty()) return dense_.transpose() * load;
  std::vector<std::pair<int, Eigen::VectorXd>> nonzero;  // bays that have any
  for (std::size_t bay = 0; bay < cells_.size(); ++bay) {
    const Eigen::VectorXd own = load(cells_[bay]);
    if (!own.isZero(0.)) nonzero.emplace_back(static_cast<int>(bay), own);
  }
  Eigen::VectorXd result(cols());
  Eigen::Index first = 0;
  for (const Wave& wave : waves_) {
    Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(wave.x.rows());
    for (const auto& [bay, own] : nonzero) sum += wave_phase(wave, bay) * own;
    result.segment(first, wave.x.cols()) = (wave.x.transpose() * sum).real();
    first += wave.x.cols();
  }
  return result;
}

Eigen::VectorXd Shapes::displacement(const Eigen::VectorXd& y) const {
  if (waves_.empty()) return dense_ * y;
  const auto bays = static_cast<Eigen::Index>(cells_.size()),
             cell = static_cast<Eigen::Index>(cells_[0].size()),
             waves = static_cast<Eigen::Index>(waves_.size());
  Eigen::MatrixXd parts(cell, 2 * waves), phases(2 * waves, bays);  // Re (a + i b)(c + i d)
  Eigen::Index first = 0;
  for (Eigen::Index w = 0; w < waves; ++w) {
    const Wave& wave = waves_[static_cast<std::size_t>(w)];
    const Eigen::VectorXcd x = wave.x * y.segment(first, wave.x.cols());
    parts.col(2 * w) = x.real();
    parts.col(2 * w + 1) = -x.imag();
    for (int bay = 0; bay < static_cast<int>(bays); ++bay) {
      const std::complex<double> at = wave_phase(wave, bay);
      phases(2 * w, bay) = at.real();
      phases(2 * w + 1, bay) = at.imag();
    }
    first += wave.x.cols();
  }
  const Eigen::MatrixXd moved = parts * phases;
  Eigen::VectorXd result(rows());
  for (Eigen::Index bay = 0; bay < bays; ++bay)
    result(cells_[static_cast<std::size_t>(bay)]) = moved.col(bay);
  return result;
}

Eigen::MatrixXd Shapes::dense() const {
  if (waves_.empty()) return dense_;
  Eigen::MatrixXd result(rows(), cols());
  for (int unknown = 0; unknown < static_cast<int>(rows()); ++unknown)
    result.row(unknown) = row(unknown).transpose();
  return result;
}

}  // namespace railstep
