#include "offline/analysis/free_motion.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "offline/analysis/rigid.h"
#include "offline/math/refuse.h"
#include "offline/math/sparse.h"
#include "offline/track/functional.h"

namespace railstep {

namespace {

using Factor = Eigen::SimplicialLDLT<Sparse>;

constexpr double kNothing = 1e-6;  // of the largest: below it a point of a shape stands still

/// The unknown of the first pivot that is not positive, in a factor that does not hold.
int loose_unknown(const Factor& factor, const Sparse& stiffness) {
  const Eigen::VectorXd pivots = factor.vectorD();
  const Eigen::VectorXd diagonal = factor.permutationP() * Eigen::VectorXd(stiffness.diagonal());
  int i = 0;
  while (i + 1 < pivots.size() && pivots[i] > 1e-12 * diagonal[i]) ++i;
  return factor.permutationPinv().indices()[i];
}

/// Where unknown `i` of a line sits, in words.
std::string place_of(const Line& line, int unknown) {
  static const char* const names[9] = {
      "x position",         "lateral position", "height", "lateral slope a_x", "a_y", "roll a_z",
      "vertical slope b_x", "roll b_y",         "b_z"};
  for (const Line::RailUnknowns& table : line.unknown_of)
    for (std::size_t node = 0; node < table.size(); ++node)
      for (std::size_t k = 0; k < 9; ++k)
        if (table[node][k] == unknown)
          return "the " + std::string(names[k]) + " of rail node " + std::to_string(node);
  for (const auto& cuts : line.cuts)
    for (const auto& [node, ahead] : cuts)
      for (std::size_t k = 0; k < 9; ++k)
        if (ahead[k] == unknown)
          return "the " + std::string(names[k]) + " ahead of the joint at rail node " +
                 std::to_string(node);
  return "a sleeper's motion";
}

/// Springs that a track does not have, and the motion that they would resist.
struct Lacking {
  const char* motion;
  std::string remedy;
  std::vector<Functional> strains = {};
};

/// Functional that strains a pad's spring k: along x, y, z, and its roll.
Functional pad_strain(const Track& track, int rail, int seat, int k) {
  if (k == 2) return pad_gap(track, rail, seat);
  const double x = seat * track.bay_length;
  if (k == 3) return {{{{rail, x, 1., 0., 2}, 1.}, {{rail, x, 0., 0., 2}, -1.}}, {}};
  const double z = track.seat(seat).pad[static_cast<std::size_t>(rail)].height_z;
  return {{{{rail, x, 0., z, k}, 1.}}, {{rail, seat, k, -1.}}};
}

double pad_stiffness(const Support& pad, int k) {
  return k == 3 ? pad.roll_stiffness : pad.stiffness[static_cast<std::size_t>(k)];
}

/// Functionals that strain springs k of pads with a stiffness, or of those without.
std::vector<Functional> pad_strains(const Track& track, int k, bool stiff) {
  std::vector<Functional> strains;
  for (int rail = 0; rail < track.rails; ++rail)
    for (int border = 0; border < track.seats(); ++border) {
      const Support pad = track.seat(border).pad[static_cast<std::size_t>(rail)];
      const bool rolls = k == 3 && pad.half_spread > 0. && pad.stiffness[2] > 0.;
      if ((pad_stiffness(pad, k) > 0. || rolls) == stiff)
        strains.push_back(pad_strain(track, rail, border, k));
    }
  return strains;
}

std::vector<Functional> ballast_strains(const Track& track, int k, bool stiff) {
  std::vector<Functional> strains;
  for (int rail = 0; rail < track.rails; ++rail)
    for (int border = 0; border < track.seats(); ++border) {
      const Seat seat = track.seat(border);
      const Ballast& ballast = seat.ballast[static_cast<std::size_t>(rail)];
      if (seat.sleeper && (ballast.stiffness[static_cast<std::size_t>(k)] > 0.) == stiff)
        strains.push_back({{}, {{rail, border, k, 1.}}});
    }
  return strains;
}

/// Springs of 0 N/m, the most important first: along z, y, x, and in roll. If only some changed
/// seats are without a spring, the remedy says so.
std::vector<Lacking> lacking_springs(const Track& track) {
  static const char* const motions[4] = {"along x", "along y", "along z", "in roll"};
  static const char* const keys[4] = {
      "support.stiffness_x_n_per_m above 0", "support.stiffness_y_n_per_m above 0",
      "support.stiffness_z_n_per_m above 0", "support.stiffness_roll_n_m_per_rad above 0"};
  std::vector<Lacking> all;
  for (const int k : {2, 1, 0, 3}) {
    const bool everywhere = pad_stiffness(track.support, k) == 0.;
    all.push_back({motions[k], everywhere ? keys[k] : "[[support_change]] to take away fewer seats",
                   pad_strains(track, k, false)});
    if (k == 2)
      all.push_back(
          {motions[k], "ballast.stiffness_z_n_per_m above 0", ballast_strains(track, k, false)});
  }
  return all;
}

std::vector<Functional> stiff_springs(const Track& track) {
  std::vector<Functional> all;
  const auto add = [&all](const std::vector<Functional>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  for (int k = 0; k < 4; ++k) add(pad_strains(track, k, true));
  for (int k = 0; k < 3; ++k) add(ballast_strains(track, k, true));
  return all;
}

/// Shapes parted into those that strain some springs and those that do not.
std::pair<Eigen::MatrixXd, Eigen::MatrixXd> parted(const Track& track,
                                                   const std::vector<Line>& lines,
                                                   const JoinedLines& joined,
                                                   const std::vector<Functional>& springs,
                                                   const Eigen::MatrixXd& shapes) {
  if (springs.empty() || shapes.cols() == 0) return {Eigen::MatrixXd(shapes.rows(), 0), shapes};
  Eigen::MatrixXd strain =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(springs.size()), shapes.cols());
  double size = 0.;
  for (std::size_t i = 0; i < springs.size(); ++i)
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const Eigen::SparseVector<double> row = functional_row(track, lines[l], springs[i]);
      const auto own = shapes.middleRows(joined.first[l], lines[l].unknowns());
      strain.row(static_cast<Eigen::Index>(i)) += row.transpose() * own;
      for (Eigen::SparseVector<double>::InnerIterator it(row); it; ++it)
        size = std::max(size, std::abs(it.value()));
    }
  size *= shapes.cwiseAbs().maxCoeff();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(strain, Eigen::ComputeFullV);
  const auto met = (svd.singularValues().array() > kNothing * size).count();
  const Eigen::MatrixXd rotated = shapes * svd.matrixV();
  return {rotated.leftCols(met), rotated.rightCols(shapes.cols() - met)};
}

/// The first and the last node of a rail that move; {-1, -1} if no node moves.
std::pair<int, int> moving_nodes(const std::vector<Line>& lines, const JoinedLines& joined,
                                 const Eigen::MatrixXd& shapes, int rail) {
  const double least = kNothing * shapes.cwiseAbs().maxCoeff();
  std::pair<int, int> nodes = {-1, -1};
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const Line& line = lines[l];
    if (line.rail_factor[static_cast<std::size_t>(rail)] == 0.) continue;
    const auto last = static_cast<int>(line.unknown_of[static_cast<std::size_t>(rail)].size());
    for (int node = 0; node < last; ++node)
      for (int k = 0; k < 9; ++k)
        for (const int unknown : {line.unknown(rail, node, k), line.unknown_ahead(rail, node, k)}) {
          if (unknown < 0) continue;
          if (shapes.row(joined.first[l] + unknown).cwiseAbs().maxCoeff() <= least) continue;
          nodes.first = nodes.first < 0 ? node : std::min(nodes.first, node);
          nodes.second = std::max(nodes.second, node);
        }
  }
  return nodes;
}

/// The rails that move, as in "the left rail (x = 0 to 3.6 m)".
std::string moving_rails(const Track& track, const std::vector<Line>& lines,
                         const JoinedLines& joined, const Eigen::MatrixXd& shapes) {
  std::array<std::pair<int, int>, 2> nodes = {{{-1, -1}, {-1, -1}}};
  for (int rail = 0; rail < track.rails; ++rail)
    nodes[static_cast<std::size_t>(rail)] = moving_nodes(lines, joined, shapes, rail);
  const bool left = nodes[0].first >= 0, right = nodes[1].first >= 0;
  if (!left && !right) return "the sleepers";
  const auto [first, last] = left ? nodes[0] : nodes[1];
  std::string words = left && right      ? "the rails"
                      : track.rails == 1 ? "the rail"
                      : left             ? "the left rail"
                                         : "the right rail";
  if (first == 0 && last == track.nodes() - 1) return words;
  char range[64];
  const double spacing = .5 * track.element_length();
  std::snprintf(range, sizeof range, " (x = %.4g to %.4g m)", first * spacing, last * spacing);
  return words + range;
}

std::string joined_words(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? last : ", ") + words[i];
  return text;
}

/// Sentence about free shapes; empty if no spring would hold them.
std::string motion_and_remedy(const Track& track, const std::vector<Line>& lines,
                              const JoinedLines& joined, Eigen::MatrixXd shapes) {
  std::vector<std::string> motions, remedies;
  Eigen::MatrixXd first;
  for (const Lacking& lacking : lacking_springs(track)) {
    auto [met, left] = parted(track, lines, joined, lacking.strains, shapes);
    if (met.cols() == 0) continue;
    if (first.size() == 0) first = met;
    shapes = std::move(left);
    if (motions.empty() || motions.back() != lacking.motion) motions.push_back(lacking.motion);
    remedies.push_back(lacking.remedy);
    if (shapes.cols() == 0) break;
  }
  if (motions.empty()) return "";
  return "the track has a free rigid mode: nothing holds " +
         moving_rails(track, lines, joined, first) + " " + joined_words(motions, " and ") +
         "; expected " + joined_words(remedies, " and ");
}

/// Shapes that do not strain a stiffness, over unknowns scaled by their own stiffness. If some
/// unknowns have no stiffness at all, only these.
Eigen::MatrixXd free_shapes(const Sparse& stiffness) {
  constexpr Eigen::Index kMostLoose = 12;
  const Eigen::VectorXd size = stiffness.diagonal();
  Eigen::MatrixXd loose = Eigen::MatrixXd::Zero(size.size(), kMostLoose);
  Eigen::Index found = 0;
  for (Eigen::Index i = 0; i < size.size() && found < kMostLoose; ++i)
    if (!(size[i] > 0.)) loose(i, found++) = 1.;
  if (found > 0) return loose.leftCols(found);
  return rigid_modes(stiffness, Sparse(size.asDiagonal()));
}

/// Sentence about the first pivot that is not positive.
std::string loosest(const std::vector<Line>& lines, const JoinedLines& joined,
                    const Sparse& stiffness, const Factor& factor) {
  Eigen::Index unknown = factor.info() == Eigen::Success ? loose_unknown(factor, stiffness) : 0;
  std::size_t line = 0;
  while (joined.first[line + 1] <= unknown) ++line;
  unknown -= joined.first[line];
  return "the track has a free rigid mode: nothing holds " +
         place_of(lines[line], static_cast<int>(unknown));
}

}  // namespace

bool is_held(const Factor& factor, const Sparse& stiffness) {
  if (factor.info() != Eigen::Success) return false;
  const Eigen::VectorXd diagonal = factor.permutationP() * Eigen::VectorXd(stiffness.diagonal());
  return (factor.vectorD().array() > 1e-12 * diagonal.array()).all();
}

JoinedLines join(const Track& track, const std::vector<Line>& lines,
                 const std::vector<FixedPort>& ports) {
  JoinedLines joined{{0}, {}, {}};
  std::vector<Eigen::Triplet<double>> entries, rows;
  for (const Line& line : lines) {
    const auto first = static_cast<int>(joined.first.back());
    for (int j = 0; j < line.unknowns(); ++j)
      for (Sparse::InnerIterator it(line.stiffness, j); it; ++it)
        entries.emplace_back(first + static_cast<int>(it.row()), first + j, it.value());
    for (std::size_t p = 0; p < ports.size(); ++p) {
      const Eigen::SparseVector<double> row = closing_row(track, line, ports[p]);
      for (Eigen::SparseVector<double>::InnerIterator it(row); it; ++it)
        rows.emplace_back(first + static_cast<int>(it.index()), static_cast<int>(p), it.value());
    }
    joined.first.push_back(joined.first.back() + line.unknowns());
  }
  joined.stiffness.resize(joined.first.back(), joined.first.back());
  joined.stiffness.setFromTriplets(entries.begin(), entries.end());
  joined.closing.resize(joined.first.back(), static_cast<Eigen::Index>(ports.size()));
  joined.closing.setFromTriplets(rows.begin(), rows.end());
  return joined;
}

void refuse_free_modes(const Track& track, const std::vector<Line>& lines,
                       const std::vector<FixedPort>& ports) {
  const JoinedLines joined = join(track, lines, ports);
  Eigen::VectorXd k(static_cast<Eigen::Index>(ports.size()));
  for (std::size_t p = 0; p < ports.size(); ++p)
    k[static_cast<Eigen::Index>(p)] = ports[p].stiffness;
  const Sparse stiffness =
      joined.stiffness + Sparse(joined.closing * k.asDiagonal() * joined.closing.transpose());
  const Factor factor(stiffness);
  if (is_held(factor, stiffness)) return;
  // Shapes that springs hold are not free, however soft these are; beside stiff rails rounding
  // hides soft springs.
  Track bilateral = track;
  if (ports.empty()) bilateral = all_open(bilateral);
  const Eigen::MatrixXd shapes =
      parted(track, lines, joined, stiff_springs(bilateral), free_shapes(stiffness)).second;
  if (shapes.cols() == 0) return;
  std::vector<Functional> open;
  if (ports.empty())
    for (const FixedPort& port : fixed_ports(track)) open.push_back(port.closing);
  const Eigen::MatrixXd alone = parted(track, lines, joined, open, shapes).first;
  if (alone.cols() > 0)
    refuse("E-TRACK-34", "the track has a free rigid mode: one-sided supports alone hold " +
                             moving_rails(track, lines, joined, alone) +
                             ", and a condensed track has them open; expected condense.kind = "
                             "\"full\", or supports that pull too");
  const std::string found = motion_and_remedy(track, lines, joined, shapes);
  refuse("E-TRACK-35", found.empty() ? loosest(lines, joined, stiffness, factor) : found);
}

}  // namespace railstep
