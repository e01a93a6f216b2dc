#include "document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace railstep::property {
namespace {

std::string inline_text(const Document& value) {
  if (value.is_string()) return fmt::format("\"{}\"", value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return fmt::format("{}", value.get<std::int64_t>());
  if (value.is_number_float()) {
    const std::string text = fmt::format("{}", value.get<double>());
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  std::string text;
  for (const auto& [key, inner] : value.items()) {
    if (!text.empty()) text += ", ";
    text += value.is_object() ? key + " = " + inline_text(inner) : inline_text(inner);
  }
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

std::string lines_of(const Document& table) {
  std::string text;
  for (const auto& [key, value] : table.items())
    if (!value.is_null()) text += fmt::format("{} = {}\n", key, inline_text(value));
  return text + "\n";
}

std::string table_text(const std::string& key, const Document& value) {
  if (value.is_null()) return {};
  if (value.is_object()) return fmt::format("[{}]\n{}", key, lines_of(value));
  std::string text;
  if (value.is_array() && (value.empty() || value[0].is_object())) {
    for (const Document& table : value) text += fmt::format("[[{}]]\n{}", key, lines_of(table));
    return text;
  }
  return fmt::format("{} = {}\n\n", key, inline_text(value));
}

Document of_node(const toml::node& node) {
  if (const toml::table* table = node.as_table()) {
    Document value = Document::object();
    for (const auto& [key, inner] : *table) value[std::string(key.str())] = of_node(inner);
    return value;
  }
  if (const toml::array* array = node.as_array()) {
    Document value = Document::array();
    for (const toml::node& inner : *array) value.push_back(of_node(inner));
    return value;
  }
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* yes = node.as_boolean()) return yes->get();
  if (const auto* whole = node.as_integer()) return whole->get();
  if (const auto* real = node.as_floating_point()) return real->get();
  throw std::runtime_error("a scene has no dates");
}

}  // namespace

std::string text_of(const Document& scene) {
  static const char* const order[] = {
      "schema",   "track",      "rail",   "support",  "sleeper", "ballast",      "support_change",
      "stop",     "rail_joint", "system", "joints",   "body",    "beam",         "joint",
      "spring",   "force",      "load",   "wheelset", "vehicle", "irregularity", "defect",
      "condense", "step",       "sensor", "output"};
  std::string text;
  for (const char* key : order)
    if (scene.contains(key)) text += table_text(key, scene[key]);
  for (const auto& [key, value] : scene.items())
    if (std::find(std::begin(order), std::end(order), key) == std::end(order))
      throw std::invalid_argument("a scene has no place for " + key);
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

Document document_of(const std::filesystem::path& file) {
  return of_node(toml::parse_file(file.string()));
}

double number(const Document& table, const char* key, double otherwise) {
  return table.contains(key) ? table[key].get<double>() : otherwise;
}
std::string word(const Document& table, const char* key, const char* otherwise) {
  return table.contains(key) ? table[key].get<std::string>() : otherwise;
}

const Document& tables(const Document& scene, const char* name) {
  static const Document none = Document::array();
  return scene.contains(name) ? scene[name] : none;
}

void for_each_entry(Document& scene,
                    const std::function<void(const std::string&, Document&)>& change) {
  if (scene.is_object())
    for (auto entry = scene.begin(); entry != scene.end(); ++entry) {
      change(entry.key(), entry.value());
      for_each_entry(entry.value(), change);
    }
  else if (scene.is_array())
    for (Document& inner : scene) for_each_entry(inner, change);
}

void for_each_number(Document& value, const std::function<void(Document&)>& change) {
  if (value.is_number())
    change(value);
  else if (value.is_array())
    for (Document& inner : value) for_each_number(inner, change);
}

}  // namespace railstep::property
