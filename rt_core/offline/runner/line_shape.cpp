#include "offline/runner/line_shape.h"

#include <algorithm>

namespace railstep {

namespace {

LineTable view(const std::vector<double>& table) {
  return {static_cast<std::int32_t>(table.size() / 2), table.empty() ? nullptr : table.data()};
}

}  // namespace

DesignLine design_line(const LineShape& shape, double reach) {
  DesignLine line{shape.transition, view(shape.curvature), view(shape.cant), view(shape.gradient),
                  1};
  for (const LineTable* table : {&line.curvature, &line.gradient})
    line.pieces = std::max(line.pieces, pieces_within(*table, reach));
  return line;
}

}  // namespace railstep
