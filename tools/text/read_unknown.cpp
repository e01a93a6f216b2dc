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

struct UnknownKey {
  toml::source_region source;
  std::string table, word, near;
};

/// Unknown keys of `table` and of all opened tables in it.
void find_unknown(const Document& document, const toml::table& table, const std::string& name,
                  std::vector<UnknownKey>& unknown) {
  const auto found = document.known.find(&table);
  if (found == document.known.end()) return;  // never opened: its reader did not want it
  for (const auto& [key, value] : table) {
    const std::string word(key.str());
    if (!found->second.contains(word))
      unknown.push_back({key.source(), name, word, nearest(word, to_vector(found->second))});
    const std::string below = name.empty() ? word : fmt::format("{}.{}", name, word);
    if (const toml::table* sub = value.as_table()) find_unknown(document, *sub, below, unknown);
    if (const toml::array* array = value.as_array())
      for (std::size_t i = 0; i < array->size(); ++i)
        if (const toml::table* sub = array->get(i)->as_table())
          find_unknown(document, *sub, fmt::format("{}[{}]", below, i), unknown);
  }
}

}  // namespace

void refuse_at(const toml::source_region& source, const Document& document,
               const std::string& table, std::string_view sentence) {
  throw InputError(
      one_line(fmt::format("{}: {}{}", place(source, document.file), bracketed(table), sentence)));
}

void check_keys(const Document& document, const toml::table& table, const std::string& name) {
  constexpr std::size_t kMostNamed = 5;
  std::vector<UnknownKey> unknown;
  find_unknown(document, table, name, unknown);
  if (unknown.empty()) return;
  const UnknownKey& first = unknown.front();
  const std::string word = first.word.substr(0, 60);
  std::string sentence =
      first.near.empty() ? fmt::format("unknown key '{}'; no key is accepted here", word)
                         : fmt::format("unknown key '{}'; did you mean '{}'?", word, first.near);
  for (std::size_t i = 1; i < std::min(unknown.size(), kMostNamed); ++i) {
    const UnknownKey& key = unknown[i];
    sentence += fmt::format("{}{}'{}'",
                            i > 1                ? ", "
                            : first.near.empty() ? ". Unknown too: "
                                                 : " Unknown too: ",
                            bracketed(key.table), key.word.substr(0, 60));
    if (!key.near.empty()) sentence += fmt::format(" ('{}'?)", key.near);
  }
  if (unknown.size() > kMostNamed)
    sentence += fmt::format(" and {} more", unknown.size() - kMostNamed);
  refuse_at(first.source, document, first.table, sentence);
}

}  // namespace railstep
