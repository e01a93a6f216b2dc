#include "sweep/sweep_key.h"

#include <fmt/core.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "build/version.h"
#include "online/math/sha256.h"
#include "run/simulation.h"
#include "text/read.h"

namespace railstep {
namespace {

std::string digest(const void* bytes, std::size_t count) {
  std::array<std::uint8_t, 32> sum{};
  sha256(bytes, count, sum.data());
  std::string text;
  text.reserve(2 * sum.size());
  for (const std::uint8_t byte : sum) fmt::format_to(std::back_inserter(text), "{:02x}", byte);
  return text;
}

std::string digest_of_file(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_bytes(file);
  return digest(bytes.data(), bytes.size());
}

void add_files(const Table& table, std::initializer_list<const char*> keys,
               std::vector<std::filesystem::path>& files) {
  for (const char* key : keys)
    if (table.has(key)) files.push_back(table.path(key));
}

/// All that a scene refers to: sections, profiles, a record of irregularities, vehicles.
std::vector<std::filesystem::path> files_of(const Table& root) {
  std::vector<std::filesystem::path> files;
  if (const std::optional<Table> rail = root.table_if("rail")) {
    add_files(*rail, {"profile", "section"}, files);
    if (const std::optional<Table> right = rail->table_if("right"))
      add_files(*right, {"profile", "section"}, files);
  }
  if (const std::optional<Table> contact = root.table_if("contact"))
    add_files(*contact, {"wheel_profile", "rail_profile"}, files);
  for (const Table& beam : root.tables("beam")) add_files(beam, {"profile", "section"}, files);
  if (const std::optional<Table> rough = root.table_if("irregularity"))
    add_files(*rough, {"file"}, files);
  for (const Table& vehicle : root.tables("vehicle")) add_files(vehicle, {"file"}, files);
  return files;
}

}  // namespace

std::string program_identity() {
  std::string version = version_text();
  if (!version.ends_with("-dirty") && !version.ends_with("unknown")) return version;
  return fmt::format("{}, sha256 {}", version, digest_of_file("/proc/self/exe"));
}

RunKeys::RunKeys(std::string program, double from) : program_(std::move(program)), from_(from) {}

std::string RunKeys::of(const std::filesystem::path& scene,
                        const std::vector<std::string>& overrides) {
  const Table root = read_toml(scene, overrides);
  std::string all =
      fmt::format("railstep sweep 1\n{}\nfrom {:a} s\n{}", program_, from_, root.sum());
  for (const std::filesystem::path& file : files_of(root)) {
    all += '\n';
    all += digest_of(file);
  }
  return digest(all.data(), all.size());
}

std::string RunKeys::digest_of(const std::filesystem::path& file) {
  const std::lock_guard<std::mutex> hold(lock_);
  std::string& known = digests_[file];
  if (known.empty()) known = digest_of_file(file);
  return known;
}

}  // namespace railstep
