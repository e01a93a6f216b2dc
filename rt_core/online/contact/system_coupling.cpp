#include "online/contact/system_coupling.h"

#include "online/contact/track_response.h"
#include "online/math/dense.h"
#include "online/math/scalar.h"
#include "online/system/track_ports.h"
#include "online/track/closing.h"

namespace railstep {

namespace {

/// Displacement of contacts, m, below which what is left of it is rounding.
constexpr double kRounding = 1e-14;

/// Views into Workspace::beside. They are not kept on the stack of couple(), which all scenes pay
/// for.
struct CoupledSystem {
  double* free;     // [9 ports] displacements of the rails without contacts and the system
  double* by_port;  // [9 ports][ports of contacts] displacement by a unit force on a port
  double* change;   // [ports of contacts][9 ports] of the forces by a unit force of each
  double* moved;    // [3][9 ports] scratch
  double* beyond;   // [ports of contacts] displacement by the system that W does not give
  double* by;       // [ports of contacts] its last change
};
CoupledSystem views(const Model& model, const Coupling& c, const Workspace& w) noexcept {
  const std::ptrdiff_t n = std::ptrdiff_t{9} * model.system.ports;
  double* const free = w.beside;
  double* const by_port = free + n;
  double* const change = by_port + n * c.ports;
  double* const moved = change + n * c.ports;
  return {free, by_port, change, moved, moved + 3 * n, moved + 3 * n + c.ports};
}

/// Displacements of the ports by the lines without contacts.
void find_free(const Model& model, Workspace& w, double* free) noexcept {
  if (model.form == Form::condensed)
    return read_ports(model, {w.solved, {w.solved, w.imaginary}}, free);
  double* const line = w.beside + beside_doubles(model) - model.line_unknowns;
  for (std::int32_t i = 0; i < model.line_unknowns; ++i) line[i] = w.solved[i];
  for (std::int32_t l = 0; l < model.lines; ++l)
    solve_backward(model.line[l].step, line + model.line[l].first);
  read_ports(model, {line, {}}, free);
}

/// Displacements along the rows of all contacts by a unit force on each port.
void find_by_port(const Model& model, const Workspace& w, const Coupling& c,
                  double* by_port) noexcept {
  for (std::int32_t k = 0; k < 9 * model.system.ports; ++k) {
    double* const own = by_port + std::ptrdiff_t{c.ports} * k;
    const PortShape shape = port_shape(model, k);
    const auto under = [&](int base, std::int32_t l, const LineModel&) noexcept {
      return shape_under(model, w, c, base, l, shape.re, shape.im);
    };
    sum_rows(model, c, under, own);
    for (std::int32_t j = 0; j < model.fixed.count; ++j)
      own[c.rows + j] = closing(model, j, shape.re, shape.im);
  }
}

/// Motion of the ports by the contacts' forces: moved = free - by_port force.
void move_ports(const Model& model, const Coupling& c, const CoupledSystem& beside,
                double* moved) noexcept {
  for (std::int32_t k = 0; k < 9 * model.system.ports; ++k) {
    const double* own = beside.by_port + std::ptrdiff_t{c.ports} * k;
    double sum = beside.free[k];
    for (int i = 0; i < c.ports; ++i) sum -= own[i] * c.force[i];
    moved[k] = sum;
  }
}

/// Displacement along a contact's row by forces on the ports, where its law takes it.
double moved_by(const Model& model, const Coupling& c, const CoupledSystem& beside, int row,
                const double* force) noexcept {
  double sum = 0.;
  for (std::int32_t k = 0; k < 9 * model.system.ports; ++k)
    sum += beside.by_port[std::ptrdiff_t{c.ports} * k + row] * force[k];
  return model.scheme.theta * sum;
}

void solve_beside(const Model& model, State& s, Workspace& w, const Coupling& c,
                  const CoupledSystem& beside, SystemResult& result) noexcept {
  move_ports(model, c, beside, system_workspace_on(model.system, w.system, s.kept).free_ports);
  const std::int32_t most = result.iterations;
  result = solve_system(model, s, w);
  if (most > result.iterations) result.iterations = most;
}

/// Change of the system's forces by each contact's force, and its part in W.
void add_compliance(const Model& model, const State& s, const Workspace& w, Coupling& c,
                    const CoupledSystem& beside) noexcept {
  const std::int32_t n = 9 * model.system.ports;
  for (int j = 0; j < c.ports; ++j) {
    double* const change = beside.change + std::ptrdiff_t{n} * j;
    for (std::int32_t k = 0; k < n; ++k)
      beside.moved[k] = -beside.by_port[std::ptrdiff_t{c.ports} * k + j];
    find_port_change(model, s, w, beside.moved, change);
  }
  for (int i = 0; i < c.ports; ++i)
    for (int j = 0; j <= i; ++j) {
      const double own =
          .5 * (moved_by(model, c, beside, i, beside.change + std::ptrdiff_t{n} * j) +
                moved_by(model, c, beside, j, beside.change + std::ptrdiff_t{n} * i));
      c.W[i * c.ports + j] += own;
      if (i != j) c.W[j * c.ports + i] += own;
    }
}

/// Moves the contacts by what the system's present forces do beyond W, in which the part by the
/// contacts' forces is symmetric; the system's own change need not be.
/// @param runners  whose seats move too, or null
/// @returns whether this is too little to count; then nothing moves
bool move_beyond(const Model& model, const State& s, const Workspace& w, Coupling& c,
                 const CoupledSystem& beside, CoupledRunners* runners) noexcept {
  const std::int32_t n = 9 * model.system.ports;
  double *const now = beside.moved, *const expected = now + n, *const pressed = expected + n;
  find_port_forces(model, s, w, now);
  for (std::int32_t k = 0; k < n; ++k) {
    expected[k] = pressed[k] = 0.;
    for (int j = 0; j < c.ports; ++j) {
      expected[k] += beside.change[std::ptrdiff_t{n} * j + k] * c.force[j];
      pressed[k] += beside.by_port[std::ptrdiff_t{c.ports} * k + j] * c.force[j];
    }
    pressed[k] *= model.scheme.theta;
  }
  double most = 0., largest = 0., *const by = beside.by;
  for (int i = 0; i < c.ports; ++i) {
    const double by_system = moved_by(model, c, beside, i, now);
    const double in_w = .5 * (moved_by(model, c, beside, i, expected) +
                              dot(beside.change + std::ptrdiff_t{n} * i, pressed, n));
    by[i] = (by_system - in_w) - beside.beyond[i];
    most = larger(most, magnitude(by[i]));
    largest = larger(largest, magnitude(by_system));
  }
  if (most <= model.system.tolerance * largest || most <= kRounding) return true;
  for (int i = 0; i < c.ports; ++i) {
    beside.beyond[i] += by[i];
    c.track_free[i] -= by[i];
    if (runners != nullptr && i >= c.contacts && i < c.rows) move_seat(c, i, -by[i], *runners);
  }
  return false;
}

}  // namespace

void couple_system(const Model& model, State& s, Workspace& w, Coupling& c,
                   SystemResult& result) noexcept {
  const CoupledSystem beside = views(model, c, w);
  find_free(model, w, beside.free);
  find_by_port(model, w, c, beside.by_port);
  begin_system(model, s, w);
  for (int i = c.contacts; i < c.rows; ++i) c.force[i] = 0.;  // not known yet
  solve_beside(model, s, w, c, beside, result);
  add_compliance(model, s, w, c, beside);
  for (int i = 0; i < c.ports; ++i) beside.beyond[i] = 0.;
  static_cast<void>(move_beyond(model, s, w, c, beside, nullptr));
}

bool settle_system(const Model& model, State& s, Workspace& w, Coupling& c, CoupledRunners* runners,
                   SystemResult& result) noexcept {
  const CoupledSystem beside = views(model, c, w);
  solve_beside(model, s, w, c, beside, result);
  return move_beyond(model, s, w, c, beside, runners);
}

}  // namespace railstep
