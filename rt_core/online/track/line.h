#pragma once
#include "online/model/model.h"

namespace railstep {

/// Displacement of a material point of one rail in one direction, over the nodes of its element and
/// the roll (a_z - b_y)/2 of its section over the seats around it:
///   sum coefficient[i][k] q_k(node i) + sum lever[s] roll(node seat[s]),
/// q = [r, a, b] in the rail's own axes.
struct RailRow {
  std::int32_t rail, element;
  double coefficient[3][9];
  std::int32_t seats;  // in use, 0 to kPDeltaSeats; see track/p_delta.h
  std::int32_t seat[kPDeltaSeats];
  double lever[kPDeltaSeats];  // m
};

/// A node of a rail's element: its first, middle or last node.
struct ElementNode {
  std::int32_t element;
  int node;  // 0 to 2
};
/// The element of a node that is counted from 0 along the rail. A node of two elements is the last
/// node of the first one.
constexpr ElementNode element_node(std::int32_t node) noexcept {
  const std::int32_t element = node > 0 ? (node - 1) / 2 : 0;
  return {element, node - 2 * element};
}
/// Index in a rail's table (LineModel::unknown_of) of unknown k of a node.
constexpr std::int32_t table_place(ElementNode at, int k) noexcept {
  return 27 * at.element + 9 * at.node + k;
}
constexpr std::int32_t table_place(std::int32_t node, int k) noexcept {
  return table_place(element_node(node), k);
}

/// Displacements at which rows are evaluated: u [unknowns] of banded lines and bodies, modes of
/// condensed lines.
struct Configuration {
  const double* u;
  Complex modes;
  double track_offset = 0.;  // m, from the elements' x to the distance along a track without end
};

/// Displacement of an unknown by its number in the line's tables.
double unknown_value(const LineModel& line, std::int32_t unknown, const Configuration& at) noexcept;

/// The value of unknown k of a node on a line, without its weight in the rail; 0 if the line does
/// not have it.
double nodal_value(const LineModel& line, std::int32_t rail, ElementNode node, int k,
                   const Configuration& at) noexcept;

/// The weight of a line's unknown k in a rail. The y components of the mirrored right rail (r_y,
/// a_x, a_z, b_y) change sign, and so does b_y of a section that does not strain.
inline double weight_of(const LineModel& line, std::int32_t rail, int k) noexcept {
  const bool flips = line.mirrored != 0 && rail == 1 && (k == 1 || k == 3 || k == 5 || k == 7);
  return flips != (line.rigid_section != 0 && k == 7) ? -line.rail_factor[rail]
                                                      : line.rail_factor[rail];
}

/// Vertical displacement of a rail's axis by the lines alone, m.
double axis_height(const Model& model, std::int32_t rail, std::int32_t element, double xi,
                   const Configuration& at) noexcept;

/// Whether a line has an unknown that a row carries.
bool carries(const LineModel& line, const RailRow& row) noexcept;

/// The part of a row's displacement by a line.
double motion(const LineModel& line, const RailRow& row, const Configuration& at) noexcept;
/// Displacement along a row by all lines, without residual flexibility.
inline double motion(const Model& model, const RailRow& row, const Configuration& at) noexcept {
  double sum = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l) sum += motion(model.line[l], row, at);
  return sum;
}

/// rhs += force * row for a banded line; rhs [unknowns] of all lines.
void spread(const LineModel& line, const RailRow& row, double force, double* rhs) noexcept;

/// The unknowns of a line that a row carries, with their weights.
inline constexpr int kMostCarried = 3 * 9 + 2 * kPDeltaSeats;
struct CarriedRow {
  int count;
  std::int32_t unknown[kMostCarried];
  double weight[kMostCarried];
};
void carry(const LineModel& line, const RailRow& row, CarriedRow& carried) noexcept;

/// The same, in memory of another.
struct CarriedPart {
  int count;
  const std::int32_t* unknown;
  const double* weight;
};
/// Whether the compliance between places of a line is in a table.
inline bool is_tabled(const LineModel& line) noexcept { return line.modal.between != nullptr; }
/// Displacements of unknowns by a unit force along a row, held over the step, by the table of a
/// condensed line.
/// @param own      of the row, at least one unknown
/// @param unknown  [count]
/// @param y        [count] out
void read_table(const Modal& modal, const CarriedPart& own, const std::int32_t* unknown, int count,
                double* y) noexcept;

/// Panels of a banded line that hold the unknowns of a row; none for a line that it does not move.
Panels panels_of(const LineModel& line, const RailRow& row) noexcept;

/// Shape of a row in the modes of a condensed line; the line's part of re and im [unknowns] is
/// overwritten.
void shape_row(const LineModel& line, const RailRow& row, double* re, double* im) noexcept;

/// The same, and the part of the row's displacement by the line in two configurations of all lines'
/// modes, which saves reading the shape twice.
struct TwoMotions {
  double first, second;
};
TwoMotions shape_moving_row(const LineModel& line, const RailRow& row, Complex first,
                            Complex second, double* re, double* im) noexcept;

/// A part of the roll over a seat: weight times the motion of a shape in the modes of a line.
struct RollPart {
  std::int32_t seat;  // its number in the row
  double weight;
  Complex shape;
};
inline constexpr int kMostRollParts = 2 * kPDeltaSeats;
/// The rolls over the seats of a row by a condensed line. @param part  [kMostRollParts] out
/// @returns the number of parts
int roll_parts(const LineModel& line, const RailRow& row, RollPart* part) noexcept;
/// Their motions in two configurations of all lines' modes. @param motion  [row.seats] out
void move_rolls(const LineModel& line, const RailRow& row, Complex first, Complex second,
                TwoMotions* motion) noexcept;

/// shape += force * row for a condensed line: [unknowns] of all lines, complex.
void spread_modes(const LineModel& line, const RailRow& row, double force, double* re,
                  double* im) noexcept;

/// Shape functions -xi(1-xi)/2, 1-xi^2, xi(1+xi)/2.
inline void shape_functions(double xi, double* shape) noexcept {
  shape[0] = -.5 * xi * (1. - xi);
  shape[1] = 1. - xi * xi;
  shape[2] = .5 * xi * (1. + xi);
}

}  // namespace railstep
