#include <fmt/core.h>

#include <cstdlib>
#include <sstream>
#include <utility>

#include "text/read.h"
#include "text/read_document.h"

namespace railstep {
namespace {

/// Keys whose text is the name of a file, wherever they stand in a scene.
bool names_a_file(std::string_view key) {
  return key == "profile" || key == "section" || key == "file";
}

void move_paths(toml::node& node, const std::filesystem::path& from,
                const std::filesystem::path& to) {
  if (toml::array* const array = node.as_array())
    for (toml::node& entry : *array) move_paths(entry, from, to);
  toml::table* const table = node.as_table();
  if (table == nullptr) return;
  for (auto&& [key, value] : *table) {
    toml::value<std::string>* const text = value.as_string();
    if (text == nullptr || !names_a_file(key.str())) {
      move_paths(value, from, to);
      continue;
    }
    const std::filesystem::path old = text->get();
    if (old.is_relative())
      text->get() = std::filesystem::proximate(std::filesystem::absolute(from / old), to).string();
  }
}

bool is_of_number(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == 'e' || c == '+' || c == '-';
}

/// Numbers that toml++ wrote with 17 digits, with as few as give the same number.
std::string with_short_numbers(const std::string& text) {
  std::string out;
  char quote = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '\'' || c == '"') quote = quote == 0 ? c : quote == c ? '\0' : quote;
    std::size_t end = at;
    while (quote == 0 && end < text.size() && is_of_number(text[end])) ++end;
    const std::string token = text.substr(at, end - at);
    if (token.size() > 16 && token.find('.') != std::string::npos)
      out += fmt::format("{}", std::strtod(token.c_str(), nullptr));
    else
      out += token.empty() ? std::string(1, c) : token;
    at = token.empty() ? at + 1 : end;
  }
  return out;
}

}  // namespace

std::string rewritten(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                      const std::filesystem::path& place) {
  toml::table root = parse_toml(read_text(file), file.string());
  for (const std::string& option : overrides) apply_override(root, option);
  move_paths(root, file.parent_path(), std::filesystem::absolute(place).parent_path());
  std::ostringstream text;
  text << root << '\n';
  return with_short_numbers(text.str());
}

}  // namespace railstep
