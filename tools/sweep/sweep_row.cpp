#include "sweep/sweep_row.h"

#include <fmt/core.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>

#include "offline/math/refuse.h"
#include "text/read.h"
#include "text/write.h"

namespace railstep {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const SweepRow& row) {
  Json columns = Json::array();
  for (const ColumnSummary& c : row.columns)
    columns.push_back({{"name", c.name},
                       {"min", c.least},
                       {"max", c.most},
                       {"mean", c.mean},
                       {"std", c.deviation},
                       {"last", c.last}});
  return {{"error", row.error},
          {"status", row.status},
          {"steps", row.steps},
          {"state_hash", row.state_hash},
          {"max_iterations", row.iterations},
          {"max_constraint_violation", row.constraint_violation},
          {"energy_balance_error", row.energy_balance_error},
          {"numerical_loss", row.numerical_loss},
          {"columns", std::move(columns)}};
}

/// NaN is written as null.
double number(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

SweepRow from_json(const Json& json) {
  SweepRow row;
  json.at("error").get_to(row.error);
  json.at("status").get_to(row.status);
  json.at("steps").get_to(row.steps);
  json.at("state_hash").get_to(row.state_hash);
  json.at("max_iterations").get_to(row.iterations);
  row.constraint_violation = number(json.at("max_constraint_violation"));
  row.energy_balance_error = number(json.at("energy_balance_error"));
  row.numerical_loss = number(json.at("numerical_loss"));
  const Json& columns = json.at("columns");
  row.columns.reserve(columns.size());
  for (const Json& c : columns)
    row.columns.push_back({c.at("name").get<std::string>(), number(c.at("min")),
                           number(c.at("max")), number(c.at("mean")), number(c.at("std")),
                           number(c.at("last"))});
  return row;
}

}  // namespace

void RowStore::create() const {
  for (const std::filesystem::path& folder : {rows_.parent_path(), rows_}) {
    std::error_code failed;
    if (std::filesystem::exists(folder, failed) && !std::filesystem::is_directory(folder, failed))
      throw InputError("E-SWEEP-13",
                       fmt::format("--out {}: this is a file; expected a folder", folder.string()));
    std::filesystem::create_directories(folder, failed);
    if (failed)
      fail("E-SWEEP-14",
           fmt::format("{}: the folder cannot be made: {}", folder.string(), failed.message()));
  }
}

void RowStore::write(const std::string& key, const std::string& about, const SweepRow& row) const {
  const Json whole = {{"key", key}, {"run", about}, {"row", to_json(row)}};
  write_file(file(key), whole.dump(1) + "\n");
}

std::optional<SweepRow> RowStore::find(const std::string& key) const try {
  std::ifstream in(file(key), std::ios::binary);
  if (!in) return std::nullopt;
  const Json whole = Json::parse(std::string((std::istreambuf_iterator<char>(in)), {}));
  if (whole.at("key") != key) return std::nullopt;
  return from_json(whole.at("row"));
} catch (const Json::exception&) {
  return std::nullopt;  // cut short or edited: made again
}

}  // namespace railstep
