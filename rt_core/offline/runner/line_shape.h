#pragma once
#include <vector>

#include "online/model/design_line.h"

namespace railstep {

/// A design line with its tables: DesignLine.
struct LineShape {
  Transition transition = Transition::linear;
  std::vector<double> curvature = {}, cant = {}, gradient = {};  // m, value, m, value, ...
  [[nodiscard]] bool is_there() const {
    return !curvature.empty() || !cant.empty() || !gradient.empty();
  }
};

/// A view of the tables. @param reach  reach_of() the vehicle, m
DesignLine design_line(const LineShape& shape, double reach);

}  // namespace railstep
