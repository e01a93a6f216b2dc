#include "online/contact/track_compliance.h"

#include "online/contact/track_response.h"

namespace railstep {

namespace {

/// Adds the compliance of a line between two bases to W of their rows.
/// @param same  the bases are one
void add_between(const RowsOfBase& a, const RowsOfBase& b, bool same, double value,
                 Coupling& c) noexcept {
  if (b.row[b.count - 1] < a.row[0]) {  // of two wheelsets
    for (int k = 0; k < a.count; ++k)
      for (int m = 0; m < b.count; ++m)
        c.W[a.row[k] * c.ports + b.row[m]] += (a.factor[k] * b.factor[m]) * value;
    return;
  }
  for (int k = 0; k < a.count; ++k)
    for (int m = 0; m < b.count; ++m) {
      const int own = a.row[k], other = b.row[m];
      if (same && own < other) continue;
      const int more = own > other ? own : other, less = own > other ? other : own;
      // Two bases that are parts of one row count both ways.
      const double both = !same && own == other ? 2. : 1.;
      c.W[more * c.ports + less] += both * (a.factor[k] * b.factor[m]) * value;
    }
}

/// The unknowns of a line that some bases carry, base after base. There is room for all bases of a
/// vehicle on eight wheels.
struct CarriedBases {
  static constexpr int kMost = 24, kMostUnknowns = 10 * kMostCarried;
  int first, end;  // the bases
  int unknowns, weights;
  std::int32_t unknown[kMostUnknowns];
  double weight[kMostUnknowns];
  int at[kMost], weight_at[kMost], count[kMost];  // of each; count 0: it does not act
  RowsOfBase rows[kMost];

  CarriedPart part(int base) const noexcept {
    const int i = base - first;
    return {count[i], unknown + at[i], weight + weight_at[i]};
  }
};

/// Takes as many bases as there is room for. The levers of the right rail, which follow those of
/// the left one, carry the same unknowns.
void take_bases(const LineModel& line, std::int32_t l, const Coupling& c, int first,
                CarriedBases& all) noexcept {
  all.first = all.end = first;
  all.unknowns = all.weights = 0;
  for (; all.end < c.bases && all.end - first < CarriedBases::kMost; ++all.end) {
    if (all.weights + kMostCarried > CarriedBases::kMostUnknowns) return;
    const int i = all.end - first;
    CarriedRow own;
    own.count = 0;
    if (c.acts[all.end][l]) carry(line, base_row(c, all.end), own);
    all.rows[i] = rows_of_base(c, all.end, line);
    all.count[i] = own.count;
    all.at[i] = all.unknowns;
    all.weight_at[i] = all.weights;
    const bool shares = i > 0 && own.count > 0 && all.count[i - 1] == own.count &&
                        is_by_levers(c, all.end) && is_by_levers(c, all.end - 1) &&
                        all.unknown[all.at[i - 1]] == own.unknown[0];
    if (shares) all.at[i] = all.at[i - 1];
    for (int k = 0; k < own.count; ++k) {
      all.weight[all.weights++] = own.weight[k];
      if (!shares) all.unknown[all.unknowns++] = own.unknown[k];
    }
  }
}

/// Adds the compliance of a line to W by its table.
void add_tabled(const LineModel& line, std::int32_t l, Coupling& c) noexcept {
  CarriedBases all;
  double y[CarriedBases::kMostUnknowns];
  for (int first = 0; first < c.bases; first = all.end) {
    take_bases(line, l, c, first, all);
    for (int j = 0; j < all.end; ++j) {
      if (!c.acts[j][l]) continue;
      CarriedRow before;
      if (j < first) carry(line, base_row(c, j), before);
      const CarriedPart own =
          j < first ? CarriedPart{before.count, before.unknown, before.weight} : all.part(j);
      if (own.count == 0) continue;
      const RowsOfBase of_own = j < first ? rows_of_base(c, j, line) : all.rows[j - first];
      const int from = j > first ? j : first, begin = all.at[from - first];
      read_table(line.modal, own, all.unknown + begin, all.unknowns - begin, y + begin);
      for (int i = from; i < all.end; ++i) {
        const CarriedPart other = all.part(i);
        if (other.count == 0) continue;
        const double* const under = y + all.at[i - first];
        double sum = 0.;
        for (int k = 0; k < other.count; ++k) sum += other.weight[k] * under[k];
        add_between(all.rows[i - first], of_own, i == j, sum, c);
      }
    }
  }
}

/// Takes rows along y and z with their part by the rolls, W in its lower triangle.
void lean_compliance(Coupling& c) noexcept {
  const auto at = [&](int a, int b) noexcept -> double& {
    return a > b ? c.W[a * c.ports + b] : c.W[b * c.ports + a];
  };
  for (int own = c.contacts; own < c.rows; ++own) {
    const int roll = own + 2 - (own - c.contacts) % kWheelSeatRows;
    const double lean = c.seat[own - c.contacts].lean;
    if (own == roll || lean == 0.) continue;
    const double by_roll = at(own, roll);
    for (int i = 0; i < c.rows; ++i) at(own, i) -= lean * at(roll, i);
    // The row itself counts in both factors.
    at(own, own) -= lean * (by_roll - lean * at(roll, roll));
  }
}

/// Adds the compliance of a line to W by the responses to each base.
void add_summed(const Model& model, const Workspace& w, std::int32_t l, Coupling& c) noexcept {
  const LineModel& line = model.line[l];
  for (int j = 0; j < c.bases; ++j) {
    if (!c.acts[j][l]) continue;
    const std::ptrdiff_t unit = j * std::ptrdiff_t{model.unknowns};
    const LineResponse by{c.panels[j][l], w.unit + unit, w.unit_second + unit};
    const RowsOfBase rows = rows_of_base(c, j, line);
    for (int i = j; i < c.bases; ++i)
      if (c.acts[i][l])
        add_between(rows_of_base(c, i, line), rows, i == j, line_compliance(model, w, c, i, l, by),
                    c);
  }
}

}  // namespace

void track_compliance(const Model& model, const Workspace& w, Coupling& c) noexcept {
  for (int i = 0; i < c.rows; ++i)
    for (int j = 0; j <= i; ++j) c.W[i * c.ports + j] = 0.;
  for (std::int32_t l = 0; l < model.lines; ++l)
    if (is_tabled(model.line[l]))
      add_tabled(model.line[l], l, c);
    else
      add_summed(model, w, l, c);
  lean_compliance(c);
}

}  // namespace railstep
