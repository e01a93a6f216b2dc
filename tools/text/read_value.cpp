#include "text/read_value.h"

#include <fmt/core.h>

#include <sstream>

namespace railstep {

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

std::string type_of(const toml::node& node) {
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

}  // namespace railstep
