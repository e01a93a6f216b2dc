#include <fmt/core.h>

#include <charconv>

#include "text/read.h"
#include "text/read_document.h"

namespace railstep {
namespace {

/// One step of a path: `name` or `name[i][j]`.
struct Step {
  std::string name;
  std::vector<std::size_t> indices;
};

[[noreturn]] void refuse_path(const std::string& option) {
  throw InputError("E-SET-01",
                   fmt::format("{}: this is not an assignment; expected key.path=value with bare "
                               "keys, and name[i] for entry i of an array, counted from 0",
                               option));
}

bool is_bare(std::string_view name) {
  for (const char c : name)
    if (!(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '_' &&
        c != '-')
      return false;
  return !name.empty();
}

Step to_step(std::string_view part, const std::string& option) {
  Step step;
  const std::size_t bracket = std::min(part.find('['), part.size());
  step.name = part.substr(0, bracket);
  if (!is_bare(step.name)) refuse_path(option);
  part.remove_prefix(bracket);
  while (!part.empty()) {
    const std::size_t close = part.find(']');
    if (part.front() != '[' || close == std::string_view::npos) refuse_path(option);
    std::size_t index = 0;
    const char* end = part.data() + close;
    const auto [stop, fault] = std::from_chars(part.data() + 1, end, index);
    if (fault != std::errc{} || stop != end) refuse_path(option);
    step.indices.push_back(index);
    part.remove_prefix(close + 1);
  }
  return step;
}

/// The one entry "name = value" as parsed, with the option as its place in errors.
toml::table parse_entry(const std::string& name, const std::string& value,
                        const std::string& option) {
  toml::table entry;
  try {
    entry = parse_toml(fmt::format("{} = {}", name, value), option);
  } catch (const InputError&) {
    throw InputError(
        "E-SET-02",
        fmt::format("{}: '{}' is not a TOML value; expected one such as 0.5, true, [1, 2], or "
                    "\"text\" with its quotes",
                    option, one_line(value.size() <= 60 ? value : value.substr(0, 57) + "...")));
  }
  if (entry.size() != 1) refuse_path(option);  // a newline in the value smuggled in a second key
  return entry;
}

toml::node& entry_of(toml::node& node, const Step& step, const std::string& option) {
  toml::node* at = &node;
  for (const std::size_t index : step.indices) {
    toml::array* array = at->as_array();
    if (!array)
      throw InputError(
          "E-SET-03", fmt::format("{}: '{}' is not an array in this scene; expected it without [i]",
                                  option, step.name));
    if (index >= array->size())
      throw InputError(
          "E-SET-04",
          fmt::format("{}: '{}' has {} entries; expected an index from 0 to {}", option, step.name,
                      array->size(), static_cast<long long>(array->size()) - 1));
    at = array->get(index);
  }
  return *at;
}

/// Goes one step down, creating the table where it is absent, as a header in the file would.
toml::table& descend(toml::table& table, const Step& step, const std::string& option) {
  toml::node* child = table.get(step.name);
  if (!child) {
    if (!step.indices.empty())
      throw InputError(
          "E-SET-05",
          fmt::format("{}: the scene has no array '{}'; expected one of its arrays before [i]",
                      option, step.name));
    toml::table made = parse_entry(step.name, "{}", option);
    table.insert(made.begin()->first, std::move(*made.begin()->second.as_table()));
    child = table.get(step.name);
  }
  toml::node& target = entry_of(*child, step, option);
  if (!target.is_table())
    throw InputError(
        "E-SET-06",
        fmt::format("{}: '{}' is not a table in this scene; expected a table before the point",
                    option, step.name));
  return *target.as_table();
}

}  // namespace

void apply_override(toml::table& root, const std::string& text) {
  // Errors name the option, but not all of one that a script made long.
  const std::string option =
      one_line("--set " + (text.size() <= 120 ? text : text.substr(0, 117) + "..."));
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse_path(option);
  std::string_view path = std::string_view(text).substr(0, equals);
  const std::string value = text.substr(equals + 1);
  while (path.ends_with(' ')) path.remove_suffix(1);
  std::vector<Step> steps;
  while (true) {
    const std::size_t dot = path.find('.');
    steps.push_back(to_step(path.substr(0, dot), option));
    if (dot == std::string_view::npos) break;
    path.remove_prefix(dot + 1);
  }
  if (steps.size() > 16) refuse_path(option);

  toml::table* table = &root;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) table = &descend(*table, steps[i], option);
  Step last = steps.back();
  toml::table entry = parse_entry(last.name, value, option);
  const toml::key key = entry.begin()->first;
  toml::node& made = entry.begin()->second;
  if (last.indices.empty()) {
    made.visit([&](auto& n) { table->insert_or_assign(key, std::move(n)); });
    return;
  }
  toml::node* child = table->get(last.name);
  if (!child)
    throw InputError(
        "E-SET-05",
        fmt::format("{}: the scene has no array '{}'; expected one of its arrays before [i]",
                    option, last.name));
  const std::size_t index = last.indices.back();
  static_cast<void>(entry_of(*child, last, option));  // the whole path must exist
  last.indices.pop_back();
  toml::array& array = *entry_of(*child, last, option).as_array();
  made.visit([&](auto& n) {
    array.replace(array.cbegin() + static_cast<std::ptrdiff_t>(index), std::move(n));
  });
}

}  // namespace railstep
