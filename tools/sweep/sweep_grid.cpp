#include "sweep/sweep_grid.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <charconv>
#include <set>
#include <string_view>
#include <utility>

#include "text/read.h"

namespace railstep {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// The place of the first comma that parts values, or the text's end. A quote or bracket that is
/// not closed is left to the parser of values, which names it.
std::size_t end_of_value(std::string_view text) {
  int depth = 0;
  char quote = '\0';
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != '\0') {
      if (c == '\\' && quote == '"')
        ++i;
      else if (c == quote)
        quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{') {
      ++depth;
    } else if (c == ']' || c == '}') {
      --depth;
    } else if (c == ',' && depth == 0) {
      return i;
    }
  }
  return text.size();
}

std::string key_of(const std::string& option) {
  return std::string(trimmed(std::string_view(option).substr(0, option.find('='))));
}

/// Whether a value of `key` takes the place of one of `other`, as track does of track.bays.
bool covers(const std::string& key, const std::string& other) {
  if (!other.starts_with(key)) return false;
  return other.size() == key.size() || other[key.size()] == '.' || other[key.size()] == '[';
}

}  // namespace

VariedKey read_varied(const std::string& option) {
  const std::size_t equals = option.find('=');
  VariedKey varied{key_of(option), {}};
  if (equals == std::string::npos || varied.key.empty())
    throw InputError(
        "E-SWEEP-07",
        fmt::format(
            "--vary {}: this is not a list of values; expected key.path=a,b,c with TOML values",
            option));
  std::set<std::string> met;
  std::string_view rest = std::string_view(option).substr(equals + 1);
  while (true) {
    const std::size_t end = end_of_value(rest);
    const std::string value(trimmed(rest.substr(0, end)));
    if (value.empty())
      throw InputError("E-SWEEP-08",
                       fmt::format("--vary {}: value {} is empty; expected a TOML value", option,
                                   varied.values.size() + 1));
    if (!met.insert(value).second)
      throw InputError(
          "E-SWEEP-09",
          fmt::format("--vary {}: the value {} is given twice; expected each value once", option,
                      value));
    varied.values.push_back(value);
    if (end == rest.size()) return varied;
    rest.remove_prefix(end + 1);
  }
}

Grid::Grid(std::vector<std::string> set, const std::vector<std::string>& vary)
    : set_(std::move(set)) {
  std::vector<std::string> before;
  before.reserve(set_.size() + vary.size());
  varied_.reserve(vary.size());
  for (const std::string& option : set_) before.push_back(key_of(option));
  double runs = 1.;
  for (const std::string& option : vary) {
    varied_.push_back(read_varied(option));
    const VariedKey& made = varied_.back();
    for (const std::string& other : before)
      if (covers(made.key, other))
        throw InputError("E-SWEEP-10", fmt::format("--vary {}: this changes {}, which is set or "
                                                   "varied before it; expected one of the two",
                                                   option, other));
    before.push_back(made.key);
    runs *= static_cast<double>(made.values.size());
    if (runs <= static_cast<double>(kMostRuns)) runs_ = static_cast<std::int64_t>(runs);
  }
  if (runs > static_cast<double>(kMostRuns))
    throw InputError(
        "E-SWEEP-11",
        fmt::format("--vary: the values make {:.15g} runs; expected at most {}", runs, kMostRuns));
}

std::vector<std::string> Grid::values(std::int64_t run) const {
  std::vector<std::string> found(varied_.size());
  for (std::size_t k = varied_.size(); k-- > 0;) {
    const auto count = static_cast<std::int64_t>(varied_[k].values.size());
    found[k] = varied_[k].values[static_cast<std::size_t>(run % count)];
    run /= count;
  }
  return found;
}

std::vector<std::string> Grid::changes(std::int64_t run) const {
  std::vector<std::string> own = values(run);
  for (std::size_t k = 0; k < varied_.size(); ++k)
    own[k] = fmt::format("{}={}", varied_[k].key, own[k]);
  return own;
}

std::vector<std::string> Grid::overrides(std::int64_t run) const {
  std::vector<std::string> all = set_;
  for (std::string& own : changes(run)) all.push_back(std::move(own));
  return all;
}

std::string Grid::words(std::int64_t run) const {
  return fmt::format("{}", fmt::join(changes(run), ", "));
}

std::vector<std::int64_t> Shard::runs(std::int64_t all) const {
  std::vector<std::int64_t> mine;
  mine.reserve(static_cast<std::size_t>(all / of + 1));
  for (std::int64_t run = number - 1; run < all; run += of) mine.push_back(run);
  return mine;
}

Shard read_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool parted = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto of = parted ? std::from_chars(number.ptr + 1, end, shard.of) : number;
  if (!parted || of.ec != std::errc() || of.ptr != end || shard.of < 1 || shard.of > kMostRuns ||
      shard.number < 0 || shard.number > shard.of)
    throw InputError("E-SWEEP-12",
                     fmt::format("--shard {}: this is not a shard; expected I/N, the I-th of N "
                                 "shards, with I from 1 to N (or from 0 to N - 1) and N up to {}",
                                 text, kMostRuns));
  if (shard.number == 0) shard.number = shard.of;
  return shard;
}

}  // namespace railstep
