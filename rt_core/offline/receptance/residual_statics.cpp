#include "offline/receptance/residual_statics.h"

#include <cmath>

#include "offline/condense/line_flexibility.h"

namespace railstep {

namespace {

/// The fewest parts of an element that have every point of the functionals at one of their ends.
int parts_for(const Track& track, const std::vector<Functional>& all) {
  const auto at_ends = [&](int parts) {
    for (const Functional& one : all)
      for (const Functional::OnRail& point : one.rail) {
        const double place = point.at.x / track.element_length() * parts;
        if (std::abs(place - std::round(place)) > 1e-9 * parts) return false;
      }
    return true;
  };
  int parts = 2;
  while (parts < kMostParts && !at_ends(parts)) ++parts;
  return parts;
}

}  // namespace

Eigen::VectorXd residual_statics(const Track& track, const Line& line, const Basis* basis,
                                 const Transfer& transfer) {
  std::vector<Functional> all = transfer.reads;
  all.push_back(transfer.force);
  const auto exact = exact_line(track, line, parts_for(track, all));
  const auto n = static_cast<Eigen::Index>(transfer.reads.size());
  if (!exact->held()) return Eigen::VectorXd::Zero(n);
  if (basis == nullptr)
    return exact->flexibility(transfer.reads, transfer.force) -
           exact_line(track, line, 1)->flexibility(transfer.reads, transfer.force);
  return exact->flexibility(transfer.reads, transfer.force) -
         ReducedLine(track, line, *basis).flexibility(transfer.reads, transfer.force);
}

}  // namespace railstep
