#include <fmt/core.h>

#include <algorithm>

#include "text/read.h"
#include "text/read_document.h"

namespace railstep {
namespace {

std::string bracketed(const std::string& name) { return name.empty() ? "" : "[" + name + "] "; }

std::vector<std::string> to_vector(const std::set<std::string, std::less<>>& keys) {
  return {keys.begin(), keys.end()};
}

PlacedError placed(const toml::source_region& source, const Document& document,
                   const std::string& table, MessageId id, std::string_view sentence) {
  const std::string text =
      fmt::format("{}: {}{}", place(source, document.file), bracketed(table), sentence);
  return {source, id, one_line(text)};
}

std::string unknown(const std::string& word, const std::string& near) {
  if (near.empty()) return fmt::format("unknown key '{}'; expected no key here", word);
  return fmt::format("unknown key '{}'; did you mean '{}'?", word, near);
}

void find_unknown(const Document& document, const toml::table& table, const std::string& name,
                  std::vector<Kept>& found) {
  const auto known = document.known.find(&table);
  if (known == document.known.end()) return;  // never opened: no reader asked for it
  if (document.doubtful.contains(&table)) return;
  for (const auto& [key, value] : table) {
    const std::string word(key.str());
    if (!known->second.contains(word))
      found.push_back({key.source(),
                       placed(key.source(), document, name, "E-KEY-02",
                              unknown(word.substr(0, 60), nearest(word, to_vector(known->second))))
                           .messages()});
    const std::string below = name.empty() ? word : fmt::format("{}.{}", name, word);
    if (const toml::table* sub = value.as_table()) find_unknown(document, *sub, below, found);
    if (const toml::array* array = value.as_array())
      for (std::size_t i = 0; i < array->size(); ++i)
        if (const toml::table* sub = array->get(i)->as_table())
          find_unknown(document, *sub, fmt::format("{}[{}]", below, i), found);
  }
}

}  // namespace

void refuse_at(const toml::source_region& source, const Document& document,
               const std::string& table, MessageId id, std::string_view sentence) {
  throw placed(source, document, table, id, sentence);
}

std::vector<Kept> unknown_keys(const Document& document, const toml::table& table,
                               const std::string& name) {
  std::vector<Kept> found;
  find_unknown(document, table, name, found);
  return found;
}

}  // namespace railstep
