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
#include "text/read.h"

namespace railstep {

/// An error at a place of a file.
struct PlacedError : InputError {
  PlacedError(const toml::source_region& at, MessageId id, const std::string& sentence)
      : InputError(id, sentence), source(at) {}
  toml::source_region source;
};

/// An error that was kept, and where it belongs in the file.
struct Kept {
  toml::source_region source;
  std::vector<Message> messages;
  bool is_refusal = false;
};

/// A parsed file and what has been asked of it so far.
struct Document {
  toml::table root;
  std::filesystem::path file;
  std::string sum;                                                         // Table::sum()
  std::map<const toml::table*, std::set<std::string, std::less<>>> known;  // keys asked for
  bool collects = false;  // the errors of getters are kept below instead of thrown
  std::vector<Kept> bad_values;
  std::vector<Kept> refusals;  // of values that are good each by itself
  std::size_t refused = 0;     // the number of refusals, with those that were dropped
  bool tainted = false;        // refusals are dropped: they may follow from a bad value
  toml::table absent;          // stands for a table that could not be read
  /// Tables with a choice that could not be read, and those that were not read to their end: which
  /// keys they need and know is not known.
  std::set<const toml::table*> doubtful;
};

struct Table::View {
  std::shared_ptr<Document> document;
  const toml::table* table;
  std::string name;
};

/// "file:line:col", or the option's text for a value that came from --set.
std::string place(const toml::source_region& source, const std::filesystem::path& file);
/// Throws PlacedError: "place: [table] sentence".
[[noreturn]] void refuse_at(const toml::source_region& source, const Document& document,
                            const std::string& table, MessageId id, std::string_view sentence);
/// The error of each unknown key of `table` and of all tables in it that were opened.
std::vector<Kept> unknown_keys(const Document& document, const toml::table& table,
                               const std::string& name);
/// Parses; `name` is what errors and source regions call the text. Throws InputError.
toml::table parse_toml(std::string_view text, const std::string& name);
/// The entry of `unread` that looks like `wanted` misspelt: at most a third of its letters away.
std::string misspelt(std::string_view wanted, const std::vector<std::string>& unread);
/// Applies one "key.path=value". Throws InputError naming the option.
void apply_override(toml::table& root, const std::string& option);

}  // namespace railstep
