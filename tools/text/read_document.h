#pragma once
// Only read*.cpp include this: it pulls in toml++, which read.h keeps away from everyone else.
#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "text/one_line.h"

namespace railstep {

/// A parsed file and what has been asked of it so far.
struct Document {
  toml::table root;
  std::filesystem::path file;
  std::string sum;                                                         // Table::sum()
  std::map<const toml::table*, std::set<std::string, std::less<>>> known;  // keys asked for
};

/// "file:line:col", or the option's text for a value that came from --set.
std::string place(const toml::source_region& source, const std::filesystem::path& file);
/// Throws InputError: "place: [table] sentence".
[[noreturn]] void refuse_at(const toml::source_region& source, const Document& document,
                            const std::string& table, std::string_view sentence);
/// Refuses unknown keys of `table` and of all opened tables in it: the first with its place, and
/// names a few others.
void check_keys(const Document& document, const toml::table& table, const std::string& name);
/// Parses; `name` is what errors and source regions call the text. Throws InputError.
toml::table parse_toml(std::string_view text, const std::string& name);
/// The entry of `unread` that looks like `wanted` misspelt: at most a third of its letters away.
std::string misspelt(std::string_view wanted, const std::vector<std::string>& unread);
/// Applies one "key.path=value". Throws InputError naming the option.
void apply_override(toml::table& root, const std::string& option);

}  // namespace railstep
