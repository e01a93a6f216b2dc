#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "commands/command.h"
#include "run/trace_compare.h"

namespace railstep {
namespace {

struct CompareOptions {
  std::string a, b;
  std::optional<double> tolerance;
  bool json = false;
};

nlohmann::ordered_json to_json(const TraceComparison& found) {
  nlohmann::ordered_json result = {{"identical", found.identical},
                                   {"first_difference", nullptr},
                                   {"max_relative_difference", found.largest}};
  if (found.first)
    result["first_difference"] = {{"row", found.first->row},
                                  {"column", found.first->column},
                                  {"a", found.first->a},
                                  {"b", found.first->b}};
  return result;
}

Exit run(const CompareOptions& o) {
  const TraceTable a = TraceTable::read(o.a), b = TraceTable::read(o.b);
  const TraceComparison found = compare(a, b, o.a, o.b);
  if (o.json)
    fmt::print("{}\n", to_json(found).dump(2));
  else if (found.identical)
    fmt::print("identical\n");
  else
    fmt::print(
        "first difference in row {}, {}: {:.17g} and {:.17g}\n"
        "largest over its column's peak: {:.3g}\n",
        found.first->row, found.first->column, found.first->a, found.first->b, found.largest);
  const bool within = o.tolerance && found.largest <= *o.tolerance;
  return found.identical || within ? Exit::done : Exit::not_reached;
}

}  // namespace

Command add_compare(CLI::App& app) {
  auto o = std::make_shared<CompareOptions>();
  CLI::App* sub = app.add_subcommand("compare", "Compare two traces, number by number");
  sub->add_option("A", o->a, "trace (CSV)")->required();
  sub->add_option("B", o->b, "trace (CSV)")->required();
  sub->add_option(
         "--tolerance", o->tolerance,
         "accept differences up to this part of a column's peak in A; without it, the same "
         "bits")
      ->check(within(0., 1e300));
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Rows count from 0. Exit code 1 where the traces differ, or by more than the tolerance;\n"
      "2 where their columns, steps or numbers of rows do.\n\n"
      "Example: railstep compare before.csv after.csv --tolerance 1e-9");
  return {sub, [o] { return run(*o); }};
}

}  // namespace railstep
