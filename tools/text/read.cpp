#include "text/read.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include "online/math/sha256.h"
#include "text/read_document.h"
#include "text/read_value.h"

namespace railstep {

namespace {

constexpr MessageId kMissing = "E-KEY-01";
/// Stands for a number that could not be read: it bounds nothing and is neither less nor more.
constexpr double kUnread = std::numeric_limits<double>::quiet_NaN();

std::string hex_digest(Sha256& sum) {
  std::array<std::uint8_t, 32> digest{};
  sum.finish(digest.data());
  std::string text;
  text.reserve(2 * digest.size());
  for (const std::uint8_t byte : digest) fmt::format_to(std::back_inserter(text), "{:02x}", byte);
  return text;
}

std::string listed(std::initializer_list<std::string_view> names) {
  std::string text;
  for (const std::string_view name : names)
    text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
  return text;
}

/// The unit that would explain a value out of its range, as a question; else empty.
const char* likely_slip(std::string_view key, double value, const Range& accepted) {
  if (key.ends_with("_m") && !key.ends_with("_per_m") && accepted.holds(value / 1000.0))
    return " (metres; was it given in millimetres?)";
  if (key.ends_with("_pa") && accepted.holds(value * 1e6)) return " (Pa; was it given in N/mm2?)";
  return "";
}

}  // namespace

void Table::refuse(std::string_view key, MessageId id, std::string_view sentence) const {
  const toml::node* node = view_->table->get(key);
  refuse_at(node ? node->source() : view_->table->source(), *view_->document, view_->name, id,
            sentence);
}

struct Table::Entry {
  const View& view;
  std::string_view key;
  const toml::node* node;  // null where the key is absent

  [[noreturn]] void refuse(const toml::node& at, MessageId id, std::string_view sentence) const {
    refuse_at(at.source(), *view.document, view.name, id, sentence);
  }
  [[noreturn]] void refuse_type(const toml::node& at, std::string_view expected) const {
    refuse(at, "E-KEY-03",
           fmt::format("{} = {} is {}; expected {}", key, shown(at), type_of(at), expected));
  }
  [[nodiscard]] double number(const toml::node& at, const Range& accepted) const {
    const std::string found = fmt::format("{} = {}", key, shown(at));
    if (!at.is_number()) refuse_type(at, "a number");
    const double value = *at.value<double>();
    if (!std::isfinite(value))
      refuse(at, "E-KEY-04", fmt::format("{} is not finite; expected {}", found, accepted.text()));
    if (accepted.holds(value)) return value + 0.;  // -0.0 is 0.0: no sign without a size
    refuse(at, "E-KEY-05",
           fmt::format("{} is out of range; expected {}{}", found, accepted.text(),
                       likely_slip(key, value, accepted)));
  }
  [[nodiscard]] std::size_t choice(const toml::node& at, Names names) const {
    const auto* value = at.as_string();
    if (!value) refuse_type(at, fmt::format("one of {}", listed(names)));
    const auto* name = std::find(names.begin(), names.end(), value->get());
    if (name == names.end())
      refuse(at, "E-KEY-06",
             fmt::format("{} = {} is unknown; expected one of {}", key, shown(at), listed(names)));
    return static_cast<std::size_t>(name - names.begin());
  }
  /// The table at or in this key. It counts as opened: its keys are checked even if none is read.
  [[nodiscard]] Table opened(const toml::table& table, std::string_view index = "") const {
    view.document->known[&table];
    const std::string prefix = view.name.empty() ? "" : view.name + ".";
    return Table(std::make_shared<const View>(
        View{view.document, &table, fmt::format("{}{}{}", prefix, key, index)}));
  }
  [[nodiscard]] const toml::array& array(std::size_t least, std::size_t most) const {
    const toml::array* found = node->as_array();
    if (!found) refuse_type(*node, "an array");
    if (found->size() < least || found->size() > most)
      refuse(*node, "E-KEY-07",
             fmt::format("{} has {} entries; expected {} to {}", key, found->size(), least, most));
    return *found;
  }
};

Table::Entry Table::look_up(std::string_view key) const {
  view_->document->known[view_->table].emplace(key);
  return {*view_, key, view_->table->get(key)};
}

Table::Entry Table::need(std::string_view key) const {
  const Entry entry = look_up(key);
  if (entry.node) return entry;
  // The likeliest reason is a misspelt key: name the nearest one that no getter has asked for yet.
  const auto& known = view_->document->known[view_->table];
  std::vector<std::string> unread;
  for (const auto& [other, value] : *view_->table)
    if (!known.contains(other.str())) unread.emplace_back(other.str());
  const std::string near = misspelt(key, unread);
  if (near.empty())
    refuse(key, kMissing, fmt::format("key '{}' is missing; it has no default", key));
  refuse_at(view_->table->find(near)->first.source(), *view_->document, view_->name, kMissing,
            fmt::format("key '{}' is missing; did you mean it by '{}'?", key, near));
}

template <typename Read, typename Value>
Value Table::kept(std::string_view key, Read read, Value otherwise) const {
  Document& document = *view_->document;
  if (view_->table == &document.absent) return otherwise;
  try {
    return read(need(key));
  } catch (const PlacedError& error) {
    if (!document.collects) throw;
    document.tainted = true;
    const bool is_missing = error.messages().front().id == kMissing.name();
    if (!is_missing || !document.doubtful.contains(view_->table))
      document.bad_values.push_back({error.source, error.messages()});
    return otherwise;
  }
}

bool Table::has(std::string_view key) const { return look_up(key).node != nullptr; }

double Table::number(std::string_view key, const Range& accepted) const {
  return kept(
      key, [&](const Entry& entry) { return entry.number(*entry.node, accepted); }, kUnread);
}

double Table::number(std::string_view key, const Range& accepted, double otherwise) const {
  return has(key) ? number(key, accepted) : otherwise;
}

double Table::slope(std::string_view key, const Range& accepted, double otherwise) const {
  if (!has(key)) return otherwise;
  const Entry entry = need(key);
  const auto* text = entry.node->as_string();
  if (!text) return number(key, accepted);
  const std::string& slope = text->get();
  double n = 0.0;
  const char* const end = slope.data() + slope.size();
  const bool is_slope = slope.starts_with("1:") &&
                        std::from_chars(slope.data() + 2, end, n).ptr == end && n > 0.0 &&
                        accepted.holds(1.0 / n);
  if (is_slope) return 1.0 / n;
  return kept(
      key,
      [&](const Entry&) -> double {
        entry.refuse(*entry.node, "E-KEY-08",
                     fmt::format("{} = \"{}\"; expected \"1:n\", or a number {}", key, slope,
                                 accepted.text()));
      },
      otherwise);
}

std::int64_t Table::integer(std::string_view key, std::int64_t least, std::int64_t most) const {
  return kept(
      key,
      [&](const Entry& entry) {
        const auto* value = entry.node->as_integer();
        if (!value) entry.refuse_type(*entry.node, "an integer");
        if (value->get() < least || value->get() > most)
          entry.refuse(*entry.node, "E-KEY-05",
                       fmt::format("{} = {} is out of range; expected {} to {}", key, value->get(),
                                   least, most));
        return value->get();
      },
      most);
}

std::int64_t Table::integer(std::string_view key, std::int64_t least, std::int64_t most,
                            std::int64_t otherwise) const {
  return has(key) ? integer(key, least, most) : otherwise;
}

bool Table::boolean(std::string_view key) const {
  return kept(
      key,
      [&](const Entry& entry) {
        const auto* value = entry.node->as_boolean();
        if (!value) entry.refuse_type(*entry.node, "true or false");
        return value->get();
      },
      false);
}

bool Table::boolean(std::string_view key, bool otherwise) const {
  return has(key) ? boolean(key) : otherwise;
}

std::string Table::string(std::string_view key) const {
  return kept(
      key,
      [&](const Entry& entry) {
        const auto* value = entry.node->as_string();
        if (!value) entry.refuse_type(*entry.node, "a string");
        if (value->get().empty())
          entry.refuse(*entry.node, "E-KEY-09",
                       fmt::format("{} is an empty string; expected a name", key));
        return value->get();
      },
      std::string());
}

std::string Table::string(std::string_view key, std::string_view otherwise) const {
  return has(key) ? string(key) : std::string(otherwise);
}

std::size_t Table::choice(std::string_view key, Names names) const {
  const std::size_t chosen = kept(
      key, [&](const Entry& entry) { return entry.choice(*entry.node, names); }, names.size());
  if (chosen < names.size()) return chosen;
  view_->document->doubtful.insert(view_->table);
  return 0;
}

std::size_t Table::choice(std::string_view key, Names names, std::size_t otherwise) const {
  return has(key) ? choice(key, names) : otherwise;
}

std::vector<std::size_t> Table::choices(std::string_view key, Names names, std::size_t count,
                                        std::size_t otherwise) const {
  if (!has(key)) return std::vector<std::size_t>(count, otherwise);
  if (!need(key).node->is_array()) return std::vector<std::size_t>(count, choice(key, names));
  return kept(
      key,
      [&](const Entry& entry) {
        std::vector<std::size_t> chosen;
        for (const toml::node& node : entry.array(count, count))
          chosen.push_back(entry.choice(node, names));
        return chosen;
      },
      std::vector<std::size_t>(count, otherwise));
}

std::filesystem::path Table::path(std::string_view key) const {
  const std::string text = string(key);
  if (text.find('\0') != std::string::npos)
    refuse(key, "E-KEY-10", "a path with a NUL byte; expected the name of a file");
  return (file().parent_path() / text).lexically_normal();
}

std::array<double, 2> Table::number_or_pair(std::string_view key, const Range& accepted) const {
  if (const Entry entry = look_up(key); entry.node && entry.node->is_array()) {
    const std::vector<double> values = numbers(key, accepted, 2, 2);
    return {values[0], values[1]};
  }
  const double value = number(key, accepted);
  return {value, value};
}

std::vector<double> Table::numbers(std::string_view key, const Range& accepted, std::size_t least,
                                   std::size_t most) const {
  return kept(
      key,
      [&](const Entry& entry) {
        std::vector<double> values;
        for (const toml::node& node : entry.array(least, most))
          values.push_back(entry.number(node, accepted));
        return values;
      },
      std::vector<double>(least, kUnread));
}

std::vector<std::string> Table::strings(std::string_view key, std::size_t least,
                                        std::size_t most) const {
  return kept(
      key,
      [&](const Entry& entry) {
        std::vector<std::string> values;
        for (const toml::node& node : entry.array(least, most)) {
          const auto* value = node.as_string();
          if (!value) entry.refuse_type(node, "a string");
          values.push_back(value->get());
        }
        return values;
      },
      std::vector<std::string>(least));
}

std::vector<double> Table::rows(std::string_view key, std::size_t columns) const {
  return kept(
      key,
      [&](const Entry& entry) {
        std::vector<double> values;
        for (const toml::node& row : entry.array(1, 100'000)) {
          const toml::array* array = row.as_array();
          if (!array || array->size() != columns)
            entry.refuse(row, "E-KEY-11",
                         fmt::format("{}: {} of {} entries; expected rows of {} numbers", key,
                                     type_of(row), array ? array->size() : 0, columns));
          for (const toml::node& node : *array) values.push_back(entry.number(node, any_number()));
        }
        return values;
      },
      std::vector<double>(columns, kUnread));
}

Table Table::table(std::string_view key) const {
  return kept(
      key,
      [&](const Entry& entry) {
        const toml::table* found = entry.node->as_table();
        if (!found) entry.refuse_type(*entry.node, "a table");
        return entry.opened(*found);
      },
      look_up(key).opened(view_->document->absent));
}

std::optional<Table> Table::table_if(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return table(key);
}

std::vector<Table> Table::tables(std::string_view key) const {
  if (!has(key)) return {};
  return kept(
      key,
      [&](const Entry& entry) {
        std::vector<Table> found;
        for (const toml::node& node : entry.array(0, 100'000)) {
          const toml::table* table = node.as_table();
          if (!table)
            entry.refuse(node, "E-KEY-12",
                         fmt::format("{} holds {}; expected [[{}{}]] tables", key, type_of(node),
                                     name().empty() ? "" : name() + ".", key));
          found.push_back(entry.opened(*table, fmt::format("[{}]", found.size())));
        }
        return found;
      },
      std::vector<Table>());
}

std::string Table::name() const { return view_->name; }

const std::filesystem::path& Table::file() const { return view_->document->file; }
const std::string& Table::sum() const { return view_->document->sum; }

Table read_toml_text(std::string_view text, const std::filesystem::path& file,
                     const std::vector<std::string>& overrides) {
  auto document = std::make_shared<Document>();
  document->file = file;
  document->root = parse_toml(text, file.string());
  Sha256 sum;
  sum.add(text.data(), text.size());
  for (const std::string& option : overrides) {
    apply_override(document->root, option);
    sum.add(option.data(), option.size());
    sum.add("\n", 1);
  }
  document->sum = hex_digest(sum);
  const toml::table* root = &document->root;
  document->known[root];
  return Table(std::make_shared<const Table::View>(Table::View{std::move(document), root, ""}));
}

Table read_toml(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return read_toml_text(read_text(file), file, overrides);
}

}  // namespace railstep
