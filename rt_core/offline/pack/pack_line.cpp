#include <cmath>
#include <complex>
#include <map>
#include <utility>

#include "offline/cost/line_cost.h"
#include "offline/math/refuse.h"
#include "offline/pack/band_factor.h"
#include "offline/pack/half_solve.h"
#include "offline/pack/pack.h"

namespace railstep {

namespace {

bool same(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  return a.rows() == 0 || a.cols() == 0 || (a - b).norm() == 0.;
}

/// Whether one table of unknowns serves all rails of a line.
bool has_one_table(const Line& line) {
  return line.mirrored || line.rail_factor[0] == 0. || line.rail_factor[1] == 0.;
}

/// Unknowns of a rail by element and node, [elements][3].
Line::RailUnknowns table_of(const Line& line, int rail) {
  const int elements = static_cast<int>(line.unknown_of[0].size()) / 2;
  Line::RailUnknowns table;
  for (int e = 0; e < elements; ++e)
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 9; ++k) {
        if (k == 0) table.emplace_back();
        table.back()[static_cast<std::size_t>(k)] = line.element_unknown(rail, e, i, k);
      }
  return table;
}

Line::RailUnknowns first_table(const Line& line) { return table_of(line, line.first_rail()); }

bool same_but_for_the_rail(const Line& a, const Line& b) {
  const bool same_tables = has_one_table(a) && has_one_table(b)
                               ? first_table(a) == first_table(b)
                               : a.unknown_of == b.unknown_of && a.cuts == b.cuts;
  return same(a.stiffness, b.stiffness) && same(a.mass, b.mass) && same(a.damping, b.damping) &&
         same_tables && a.mirrored == b.mirrored;
}

/// Real parts, then imaginary parts, padded with zeros.
std::vector<double> parts(const Eigen::VectorXcd& values, std::size_t padded) {
  std::vector<double> result(2 * padded, 0.);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    result[static_cast<std::size_t>(k)] = values[k].real();
    result[padded + static_cast<std::size_t>(k)] = values[k].imag();
  }
  return result;
}

/// (e^w - 1) / w and (e^w - 1 - w) / w^2, by their series if the difference would cancel.
std::pair<std::complex<double>, std::complex<double>> constant_and_linear(std::complex<double> w) {
  if (std::abs(w) > .5) {
    const std::complex<double> first = (std::exp(w) - 1.) / w;
    return {first, (first - 1.) / w};
  }
  std::complex<double> term = 1., first = 0., second = 0.;
  for (int n = 1; n < 20; ++n) {
    first += term / static_cast<double>(n);
    second += term / static_cast<double>(n * (n + 1));
    term *= w / static_cast<double>(n);
  }
  return {first, second};
}

}  // namespace

namespace {

/// A table of more numbers than this is not made.
constexpr std::int64_t kMostTabled = 1 << 19;

/// Whether a table between the rows of a line takes less work for a pair of wheels than its modes,
/// if a wheel's row has `carried` of them.
bool has_table(const Modal& modal, std::int64_t carried) {
  return std::int64_t{modal.rows} * modal.rows <= kMostTabled && carried * carried <= modal.count;
}

/// Modal::between.
std::vector<double> table_between(const Modal& modal) {
  const auto size = static_cast<std::size_t>(modal.count);
  const auto rows = static_cast<std::size_t>(modal.rows);
  std::vector<double> re(size), im(size), table(rows * rows);
  const auto shape = [&](std::int32_t row) {
    const double* at = modal.shape + std::ptrdiff_t{2} * row * modal.count;
    return Complex{at, at + modal.count};
  };
  for (std::int32_t a = 0; a < modal.rows; ++a) {
    modes_multiply(modal.held_force, shape(a), re.data(), im.data(), modal.count);
    for (std::int32_t b = 0; b <= a; ++b) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      table[i * rows + j] = table[j * rows + i] =
          modes_dot(shape(b), {re.data(), im.data()}, modal.count);
    }
  }
  return table;
}

}  // namespace

void PackedModel::add_responses() {
  for (std::int32_t l = 0; l < model_.lines; ++l) {
    LineModel& line = model_.line[l];
    const LineModel& twin = model_.line[line.twin];
    if (line.twin < l) {
      line.reach = twin.reach;
      line.modal.between = twin.modal.between;
    } else if (model_.form == Form::banded) {
      line.reach = reach_of(line.step);
    } else if (track_row_count(model_) > 2 && has_table(line.modal, carried_by(model_, line))) {
      line.modal.between = keep(table_between(line.modal));
    }
  }
}

Diagonals PackedModel::keep_diagonals(const Eigen::SparseMatrix<double>& A, int padded) {
  std::map<std::int32_t, std::vector<double>> found;  // offset -> values by row
  for (int j = 0; j < A.outerSize(); ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(A, j); entry; ++entry) {
      auto& values = found[static_cast<std::int32_t>(j - entry.row())];
      values.resize(static_cast<std::size_t>(padded), 0.);
      values[static_cast<std::size_t>(entry.row())] = entry.value();
    }
  std::vector<std::int32_t> offsets;
  std::vector<double> values;
  for (const auto& [offset, diagonal] : found) {
    offsets.push_back(offset);
    values.insert(values.end(), diagonal.begin(), diagonal.end());
  }
  const int count = static_cast<int>(offsets.size());
  return {padded, count, keep(std::move(offsets)), keep(std::move(values))};
}

/// @param number  index in the model of unknown k of a node that the traffic visits
template <typename Number>
void PackedModel::keep_tables(const Line& line, LineModel& packed, const Number& number) {
  const auto keep_table = [&](const Line::RailUnknowns& table) {
    std::vector<std::int32_t> unknowns(9 * table.size(), -1);
    for (std::size_t node = 0; node < table.size(); ++node)
      for (std::size_t k = 0; k < 9 && is_met_[node / 3]; ++k)
        if (table[node][k] >= 0 && (moves_along_ || k % 3 != 0)) {
          unknowns[9 * node + k] = static_cast<std::int32_t>(number(table[node][k], k));
          if (unknowns[9 * node + k] >= 0) packed.components |= 1 << k;
        }
    return keep(std::move(unknowns));
  };
  packed.unknown_of[0] = packed.unknown_of[1] = keep_table(first_table(line));
  if (!has_one_table(line)) packed.unknown_of[1] = keep_table(table_of(line, 1));
}

void PackedModel::add_banded(const Track& track, const Line& line, LineModel& packed,
                             double gravity) {
  const Scheme& s = model_.scheme;
  BandFactor factor = factor_band(
      Eigen::SparseMatrix<double>(line.stiffness + s.kv * line.damping + s.kg * line.mass));
  packed.size = 8 * factor.panels;
  packed.step = {factor.panels, factor.left, keep(std::move(factor.forward)),
                 keep(std::move(factor.inverse)), keep(std::move(factor.backward))};
  packed.mass = keep_diagonals(line.mass, packed.size);
  packed.damping = keep_diagonals(line.damping, packed.size);
  if (model_.endless.bays > 0) packed.shift = window_shift(track, line, packed.size, gravity);
  keep_tables(line, packed, [](int unknown, std::size_t) { return unknown; });
}

void PackedModel::add_condensed(const Track& track, PackedLine& own, LineModel& packed,
                                const Reduction& reduction) {
  RingModes ring;
  if (track.ring) {
    ring = ring_modes(track, own.line, limit_of(own.line, reduction));
    own.basis = std::move(ring.basis);
    own.modes = std::move(ring.modes);
  } else {
    auto [basis, modes] = reduce(track, own.line, reduction, own.closing);
    own.basis = std::move(basis);
    own.modes = std::move(modes);
  }
  const auto modes = own.modes.rate().size();
  const auto padded = static_cast<std::size_t>((modes + 7) / 8 * 8);
  const double dt = model_.scheme.dt;
  Eigen::VectorXcd held(modes), rising(modes), keep_rate(modes);
  for (Eigen::Index k = 0; k < modes; ++k) {
    const std::complex<double> w = own.modes.rate()[k] * dt;
    const auto [first, second] = constant_and_linear(w);
    held[k] = dt * first;
    rising[k] = dt * second;
    keep_rate[k] = std::exp(w);
  }
  const auto complex = [&](const Eigen::VectorXcd& values) {
    const double* re = keep(parts(values, padded));
    return Complex{re, re + padded};
  };
  packed.size = static_cast<std::int32_t>(padded);
  if (track.ring) packed.shift = ring_shift(ring, packed.size);
  packed.modal = {packed.size,
                  complex(own.modes.rate()),
                  complex(keep_rate),
                  complex(held - rising),
                  complex(rising),
                  complex(held),
                  0,
                  nullptr,
                  nullptr};
  std::vector<double> shape;
  std::int32_t count = 0;
  std::map<int, int> row_of;  // elements share their borders' rows
  keep_tables(own.line, packed, [&](int unknown, std::size_t k) {
    // The section's own strain (a_y, b_z) has no inertia: it is in the residual flexibility.
    if (k == 4 || k == 8) return -1;
    if (const auto known = row_of.find(unknown); known != row_of.end()) return known->second;
    const Eigen::VectorXcd row = own.modes.project(own.basis.shapes.row(unknown));
    const std::vector<double> values = parts(row, padded);
    shape.insert(shape.end(), values.begin(), values.end());
    return row_of[unknown] = static_cast<int>(count++);
  });
  packed.modal.rows = count;
  packed.modal.shape = keep(std::move(shape));
}

void PackedModel::add_line(const Track& track, PackedLine own, const PackOptions& options) {
  if (model_.lines == kMaxLines)
    refuse("E-PACK-34", "the track splits into too many independent lines; expected at most " +
                            std::to_string(kMaxLines) +
                            ". Under gravity each sleeper without pads is one line");
  LineModel packed{};
  std::size_t twin = 0;
  while (twin < lines_.size() && !(same_but_for_the_rail(lines_[twin].line, own.line) &&
                                   (!options.reduction || same(lines_[twin].closing, own.closing))))
    ++twin;
  if (twin < lines_.size()) {
    packed = model_.line[twin];
    own.basis = lines_[twin].basis;
    own.modes = lines_[twin].modes;
  } else if (options.reduction) {
    add_condensed(track, own, packed, *options.reduction);
  } else {
    add_banded(track, own.line, packed, options.gravity);
  }
  packed.first = model_.unknowns;
  packed.twin = static_cast<std::int32_t>(twin);
  for (int rail = 0; rail < 2; ++rail)
    packed.rail_factor[rail] =
        rail < track.rails ? own.line.rail_factor[static_cast<std::size_t>(rail)] : 0.;
  packed.mirrored = own.line.mirrored ? 1 : 0;
  packed.rigid_section = own.line.rigid_section ? 1 : 0;
  model_.unknowns += packed.size;
  model_.line[model_.lines++] = packed;
  lines_.push_back(std::move(own));
}

}  // namespace railstep
