#include "text/read.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>

#include "online/math/sha256.h"
#include "text/read_document.h"

namespace railstep {

struct Table::View {
  std::shared_ptr<Document> document;
  const toml::table* table;
  std::string name;
};

namespace {

/// A value as the file writes it, short enough for a sentence.
std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array()) return "an array";
  if (const auto* n = node.as_floating_point()) return fmt::format("{}", n->get());
  std::ostringstream out;
  node.visit([&](const auto& n) {
    if constexpr (toml::is_value<decltype(n)>) out << n;
  });
  std::string text = out.str();
  if (const auto* s = node.as_string()) text = '"' + s->get() + '"';
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

std::string hex_digest(Sha256& sum) {
  std::array<std::uint8_t, 32> digest{};
  sum.finish(digest.data());
  std::string text;
  text.reserve(2 * digest.size());
  for (const std::uint8_t byte : digest) fmt::format_to(std::back_inserter(text), "{:02x}", byte);
  return text;
}

std::string kind(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
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

bool Range::holds(double value) const {
  return (value > least || (least_itself && value == least)) &&
         (value < most || (most_itself && value == most));
}

std::string Range::text() const {
  std::string low, high;
  if (least > -std::numeric_limits<double>::infinity())
    low = fmt::format("{} {:.15g}", least_itself ? "at least" : "above", least);
  if (most < std::numeric_limits<double>::infinity())
    high = fmt::format("{} {:.15g}", most_itself ? "at most" : "below", most);
  if (low.empty() && high.empty()) return "any finite number";
  return low + (low.empty() || high.empty() ? "" : ", ") + high;
}

void Table::refuse(std::string_view key, std::string_view sentence) const {
  const toml::node* node = view_->table->get(key);
  refuse_at(node ? node->source() : view_->table->source(), *view_->document, view_->name,
            sentence);
}

struct Table::Entry {
  const View& view;
  std::string_view key;
  const toml::node* node;  // null where the key is absent

  [[noreturn]] void refuse(const toml::node& at, std::string_view sentence) const {
    refuse_at(at.source(), *view.document, view.name, sentence);
  }
  [[noreturn]] void refuse_kind(std::string_view accepted) const {
    refuse(*node,
           fmt::format("{} = {} is {}; {} is accepted", key, shown(*node), kind(*node), accepted));
  }
  [[nodiscard]] double number(const toml::node& at, const Range& accepted) const {
    const std::string found = fmt::format("{} = {}", key, shown(at));
    if (!at.is_number()) refuse(at, fmt::format("{} is {}; a number is accepted", found, kind(at)));
    const double value = *at.value<double>();
    if (!std::isfinite(value))
      refuse(at, fmt::format("{} is not finite; accepted is {}", found, accepted.text()));
    if (accepted.holds(value)) return value + 0.;  // -0.0 is 0.0: no sign without a size
    refuse(at, fmt::format("{} is out of range; accepted is {}{}", found, accepted.text(),
                           likely_slip(key, value, accepted)));
  }
  [[nodiscard]] std::size_t choice(const toml::node& at, Names names) const {
    const std::string found = fmt::format("{} = {}", key, shown(at));
    const auto* value = at.as_string();
    if (!value)
      refuse(at, fmt::format("{} is {}; one of {} is accepted", found, kind(at), listed(names)));
    const auto* name = std::find(names.begin(), names.end(), value->get());
    if (name == names.end())
      refuse(at, fmt::format("{} is unknown; accepted are {}", found, listed(names)));
    return static_cast<std::size_t>(name - names.begin());
  }
  [[nodiscard]] const toml::array& array(std::size_t least, std::size_t most) const {
    const toml::array* found = node->as_array();
    if (!found) refuse_kind("an array");
    if (found->size() < least || found->size() > most)
      refuse(*node, fmt::format("{} has {} entries; accepted are {} to {}", key, found->size(),
                                least, most));
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
  // The likeliest reason is a misspelt key: name the nearest one nobody has asked for yet.
  const auto& known = view_->document->known[view_->table];
  std::vector<std::string> unread;
  for (const auto& [other, value] : *view_->table)
    if (!known.contains(other.str())) unread.emplace_back(other.str());
  const std::string near = misspelt(key, unread);
  if (near.empty()) refuse(key, fmt::format("key '{}' is missing; it has no default", key));
  refuse_at(view_->table->find(near)->first.source(), *view_->document, view_->name,
            fmt::format("key '{}' is missing; did you mean it by '{}'?", key, near));
}

bool Table::has(std::string_view key) const { return look_up(key).node != nullptr; }

double Table::number(std::string_view key, const Range& accepted) const {
  const Entry entry = need(key);
  return entry.number(*entry.node, accepted);
}

double Table::number(std::string_view key, const Range& accepted, double otherwise) const {
  return has(key) ? number(key, accepted) : otherwise;
}

double Table::slope(std::string_view key, const Range& accepted, double otherwise) const {
  if (!has(key)) return otherwise;
  const Entry entry = need(key);
  const auto* text = entry.node->as_string();
  if (!text) return entry.number(*entry.node, accepted);
  const std::string& slope = text->get();
  double n = 0.0;
  const char* const end = slope.data() + slope.size();
  const bool is_slope = slope.starts_with("1:") &&
                        std::from_chars(slope.data() + 2, end, n).ptr == end && n > 0.0 &&
                        accepted.holds(1.0 / n);
  if (!is_slope)
    entry.refuse(*entry.node,
                 fmt::format("{} = \"{}\"; accepted is \"1:n\", or a number that is {}", key, slope,
                             accepted.text()));
  return 1.0 / n;
}

std::int64_t Table::integer(std::string_view key, std::int64_t least, std::int64_t most) const {
  const Entry entry = need(key);
  const auto* value = entry.node->as_integer();
  if (!value) entry.refuse_kind("an integer");
  if (value->get() < least || value->get() > most)
    entry.refuse(*entry.node, fmt::format("{} = {} is out of range; accepted is {} to {}", key,
                                          value->get(), least, most));
  return value->get();
}

std::int64_t Table::integer(std::string_view key, std::int64_t least, std::int64_t most,
                            std::int64_t otherwise) const {
  return has(key) ? integer(key, least, most) : otherwise;
}

bool Table::boolean(std::string_view key) const {
  const Entry entry = need(key);
  const auto* value = entry.node->as_boolean();
  if (!value) entry.refuse_kind("true or false");
  return value->get();
}

bool Table::boolean(std::string_view key, bool otherwise) const {
  return has(key) ? boolean(key) : otherwise;
}

std::string Table::string(std::string_view key) const {
  const Entry entry = need(key);
  const auto* value = entry.node->as_string();
  if (!value) entry.refuse_kind("a string");
  if (value->get().empty())
    entry.refuse(*entry.node, fmt::format("{} is an empty string; a name is accepted", key));
  return value->get();
}

std::string Table::string(std::string_view key, std::string_view otherwise) const {
  return has(key) ? string(key) : std::string(otherwise);
}

std::size_t Table::choice(std::string_view key, Names names) const {
  const Entry entry = need(key);
  return entry.choice(*entry.node, names);
}

std::size_t Table::choice(std::string_view key, Names names, std::size_t otherwise) const {
  return has(key) ? choice(key, names) : otherwise;
}

std::vector<std::size_t> Table::choices(std::string_view key, Names names, std::size_t count,
                                        std::size_t otherwise) const {
  if (!has(key)) return std::vector<std::size_t>(count, otherwise);
  const Entry entry = need(key);
  if (!entry.node->is_array())
    return std::vector<std::size_t>(count, entry.choice(*entry.node, names));
  std::vector<std::size_t> chosen;
  for (const toml::node& node : entry.array(count, count))
    chosen.push_back(entry.choice(node, names));
  return chosen;
}

std::filesystem::path Table::path(std::string_view key) const {
  const std::string text = string(key);
  if (text.find('\0') != std::string::npos) refuse(key, "a path with NUL; a file name is accepted");
  return (file().parent_path() / text).lexically_normal();
}

std::array<double, 2> Table::number_or_pair(std::string_view key, const Range& accepted) const {
  const Entry entry = need(key);
  if (!entry.node->is_array()) {
    const double value = entry.number(*entry.node, accepted);
    return {value, value};
  }
  const std::vector<double> values = numbers(key, accepted, 2, 2);
  return {values[0], values[1]};
}

std::vector<double> Table::numbers(std::string_view key, const Range& accepted, std::size_t least,
                                   std::size_t most) const {
  const Entry entry = need(key);
  std::vector<double> values;
  for (const toml::node& node : entry.array(least, most))
    values.push_back(entry.number(node, accepted));
  return values;
}

std::vector<std::string> Table::strings(std::string_view key, std::size_t least,
                                        std::size_t most) const {
  const Entry entry = need(key);
  std::vector<std::string> values;
  for (const toml::node& node : entry.array(least, most)) {
    const auto* value = node.as_string();
    if (!value)
      entry.refuse(
          node, fmt::format("{} = {} is {}; a string is accepted", key, shown(node), kind(node)));
    values.push_back(value->get());
  }
  return values;
}

std::vector<double> Table::rows(std::string_view key, std::size_t columns) const {
  const Entry entry = need(key);
  std::vector<double> values;
  for (const toml::node& row : entry.array(1, 100'000)) {
    const toml::array* array = row.as_array();
    if (!array || array->size() != columns)
      entry.refuse(row, fmt::format("{}: {} of {} entries; accepted are rows of {} numbers", key,
                                    kind(row), array ? array->size() : 0, columns));
    for (const toml::node& node : *array) values.push_back(entry.number(node, any_number()));
  }
  return values;
}

Table Table::table(std::string_view key) const {
  const Entry entry = need(key);
  const toml::table* found = entry.node->as_table();
  if (!found) entry.refuse_kind("a table");
  view_->document->known[found];  // opened, so its keys are checked even if none is asked for
  return Table(std::make_shared<const View>(
      View{view_->document, found,
           name().empty() ? std::string(key) : fmt::format("{}.{}", name(), key)}));
}

std::optional<Table> Table::table_if(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return table(key);
}

std::vector<Table> Table::tables(std::string_view key) const {
  const Entry entry = look_up(key);
  if (!entry.node) return {};
  std::vector<Table> found;
  const std::string prefix = name().empty() ? "" : name() + ".";
  for (const toml::node& node : entry.array(0, 100'000)) {
    const toml::table* table = node.as_table();
    if (!table)
      entry.refuse(node, fmt::format("{} holds {}; [[{}]] tables are accepted", key, kind(node),
                                     prefix + std::string(key)));
    view_->document->known[table];
    found.push_back(Table(std::make_shared<const View>(
        View{view_->document, table, fmt::format("{}{}[{}]", prefix, key, found.size())})));
  }
  return found;
}

void Table::finish() const { check_keys(*view_->document, *view_->table, view_->name); }

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
