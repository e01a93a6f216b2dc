// Two traces with a byte 0 between them, or one that is compared with itself.
#include <cmath>
#include <cstring>

#include "mutate.h"
#include "oracle.h"
#include "run/trace.h"
#include "run/trace_compare.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

void rewrite(const TraceTable& table, const std::filesystem::path& file) {
  Trace out(file, table.columns);
  const std::size_t width = table.columns.size();
  for (std::size_t row = 0; row < table.rows(); ++row)
    out.row({table.values.data() + row * width, width});
  out.finish();
}

/// Checks that a trace is written and read again with the same bits.
void check_written(const TraceTable& table) {
  const auto file = folder() / "again.csv";
  rewrite(table, file);
  const TraceTable again = TraceTable::read(file);
  const TraceComparison same = compare(table, again, "a", "b");
  check(same.identical && !same.first && same.largest == 0.,
        "a trace is not read as it is written");
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return mutate_text(data, size, most, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  const std::size_t end = std::min(text.find('\0'), text.size());
  const std::string_view second = text.substr(std::min(end + 1, text.size()));
  const auto a = written("a.csv", text.substr(0, end));
  const auto b = written("b.csv", second.empty() ? text.substr(0, end) : second);
  accepts([&] {
    const TraceTable of_a = TraceTable::read(a), of_b = TraceTable::read(b);
    check_written(of_a);
    const TraceComparison found = compare(of_a, of_b, "a", "b"),
                          back = compare(of_b, of_a, "b", "a");
    check(found.identical == back.identical, "a differs from b, but b not from a");
    check(found.identical == !found.first.has_value(), "a difference without a place");
    check(found.largest >= 0. && (!found.identical || found.largest == 0.), "a difference below 0");
  });
  return 0;
}
