#include <algorithm>
#include <string>

#include "offline/math/refuse.h"
#include "offline/pack/half_solve.h"
#include "offline/pack/pack.h"
#include "online/track/closing.h"

namespace railstep {

void PackedModel::add_fixed_ports(const Track& track) {
  const std::vector<FixedPort> ports = fixed_ports(track);
  if (ports.empty()) return;
  if (ports.size() > static_cast<std::size_t>(kMaxFixedPorts))
    refuse("E-PACK-35", "the track has " + std::to_string(ports.size()) +
                            " one-sided springs; expected at most " +
                            std::to_string(kMaxFixedPorts) +
                            ". They are stops, gaps of joints, and pads and ballast that do not "
                            "pull or have a gap; a pad with a length counts as two");
  FixedPortModel& fixed = model_.fixed;
  std::vector<double> stiffness, damping, gap;
  for (const FixedPort& port : ports) {
    stiffness.push_back(port.stiffness);
    damping.push_back(port.damping);
    gap.push_back(port.gap);
  }
  fixed.count = static_cast<std::int32_t>(ports.size());
  fixed.stiffness = keep(std::move(stiffness));
  fixed.damping = keep(std::move(damping));
  fixed.gap = keep(std::move(gap));
  if (model_.form == Form::condensed)
    add_port_shapes();
  else
    add_port_rows();
  // theta row response; the lower half is used for both, as they differ by rounding.
  const auto n = static_cast<std::size_t>(fixed.count);
  std::vector<double> compliance(n * n);
  const std::ptrdiff_t part = model_.line_unknowns;
  const auto response = [&](std::size_t j) {
    return fixed.response + 2 * static_cast<std::ptrdiff_t>(j) * part;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double sum =
          model_.form == Form::condensed
              ? closing(model_, static_cast<std::int32_t>(i), response(j), response(j) + part)
              : panels_dot({0, model_.line_unknowns / kLanes}, response(i), response(j) + part);
      compliance[i * n + j] = compliance[j * n + i] = model_.scheme.theta * sum;
    }
  fixed.compliance = keep(std::move(compliance));
}

/// For banded lines: sparse rows, and their solves halfway by the step's own factors.
void PackedModel::add_port_rows() {
  FixedPortModel& fixed = model_.fixed;
  const auto n = static_cast<std::size_t>(model_.line_unknowns);
  std::vector<std::int32_t> start = {0}, index, panels;
  std::vector<double> value, response(2 * static_cast<std::size_t>(fixed.count) * n, 0.);
  for (std::int32_t j = 0; j < fixed.count; ++j) {
    double* const own = response.data() + 2 * static_cast<std::size_t>(j) * n;
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      const LineModel& line = model_.line[l];
      std::vector<double> row(static_cast<std::size_t>(line.size), 0.);
      using Entry = Eigen::SparseMatrix<double>::InnerIterator;
      for (Entry entry(lines_[l].closing, j); entry; ++entry) {
        index.push_back(line.first + static_cast<std::int32_t>(entry.row()));
        value.push_back(entry.value());
        row[static_cast<std::size_t>(entry.row())] = value.back();
      }
      const HalfSolve half = solve_halfway(line.step, std::move(row));
      panels.insert(panels.end(), {half.panels.first, half.panels.end});
      std::copy(half.forward.begin(), half.forward.end(), own + line.first);
      std::copy(half.over_pivots.begin(), half.over_pivots.end(),
                own + n + static_cast<std::size_t>(line.first));
    }
    start.push_back(static_cast<std::int32_t>(index.size()));
  }
  fixed.entries = start.back();
  fixed.start = keep(std::move(start));
  fixed.index = keep(std::move(index));
  fixed.value = keep(std::move(value));
  fixed.response = keep(std::move(response));
  fixed.panels = keep(std::move(panels));
}

/// For condensed lines: the share of the modes in each row, and the response of the modes to a
/// force that is held over a step.
void PackedModel::add_port_shapes() {
  FixedPortModel& fixed = model_.fixed;
  const auto n = static_cast<std::size_t>(model_.line_unknowns);
  std::vector<double> shape(static_cast<std::size_t>(fixed.count) * 2 * n, 0.), response = shape;
  for (std::int32_t j = 0; j < fixed.count; ++j) {
    const std::size_t at = static_cast<std::size_t>(j) * 2 * n;
    for (std::size_t l = 0; l < lines_.size(); ++l) {
      const LineModel& line = model_.line[l];
      const PackedLine& own = lines_[l];
      const Eigen::VectorXcd modal =
          own.modes.project(own.basis.shapes.project(Eigen::VectorXd(own.closing.col(j))));
      for (Eigen::Index k = 0; k < modal.size(); ++k) {
        const std::size_t re = at + static_cast<std::size_t>(line.first + k);
        shape[re] = modal[k].real();
        shape[re + n] = modal[k].imag();
      }
      const std::size_t re = at + static_cast<std::size_t>(line.first), im = re + n;
      modes_multiply(line.modal.held_force, {shape.data() + re, shape.data() + im},
                     response.data() + re, response.data() + im, line.size);
    }
  }
  fixed.shape = keep(std::move(shape));
  fixed.response = keep(std::move(response));
}

}  // namespace railstep
