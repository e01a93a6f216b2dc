#pragma once
#include <string>
#include <vector>

#include "run/simulate.h"
#include "run/trace_compare.h"

namespace railstep {

/// The columns of traces that are compared, a kind of output each.
enum class OutputKind {
  deflection,
  contact_force,
  lateral_force,
  sum_of_lateral_forces,
  support_force,
  sensor,
  stress
};
inline constexpr OutputKind kOutputKinds[] = {
    OutputKind::deflection,    OutputKind::contact_force,
    OutputKind::lateral_force, OutputKind::sum_of_lateral_forces,
    OutputKind::support_force, OutputKind::sensor,
    OutputKind::stress};

/// "deflection": of the rail under loads and wheels (<load>.deflection_z_m, <wheel>.rail_z_m);
/// "contact_force": mean of a frame (<wheel>.force_z_mean_n), which is the force below the frames'
/// own frequency, of vehicles in space the force at its end (<wheel>.q_n); of these also
/// "lateral_force" (<wheel>.y_n) and "sum_of_lateral_forces" (<wheelset>.sum_y_n); "support_force"
/// (support_<i>.force_z_n); "sensor" (<sensor>.dz_m); "stress" of gauges (<sensor>.stress_x_pa).
const char* name_of(OutputKind kind);

/// The part of a trace that is judged: the time from which on, and the outputs that count as the
/// error.
struct Judged {
  double from = 0.;                  // s; what comes before is left out
  std::vector<std::string> outputs;  // kinds or columns; empty: the first kind that there is
};

/// Over each column's largest value in the reference.
struct KindError {
  OutputKind kind;
  double largest = 0., rms = 0.;  // the worst column's
};

struct TraceErrors {
  double judged = 0.;            // the largest of the outputs that count
  std::vector<KindError> kinds;  // those that the traces have
};

/// The compared columns of a run's trace, and the time.
TraceTable compared(const std::vector<std::string>& columns, const RunRecord& record);

/// Infinite where the run ended early or is not finite. Throws InputError where the reference does
/// not have the columns or the times that are judged.
TraceErrors errors_of(const TraceTable& got, const TraceTable& reference, const Judged& judged);

}  // namespace railstep
