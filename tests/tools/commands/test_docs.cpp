#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "online/model/status.h"
#include "support/program.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

const std::filesystem::path kRoot = RAILSTEP_SOURCE;
constexpr char kVaries = '\x01';  // stands for the values that a sentence gets

// Sentences of the sources -----------------------------------------------------------------------

/// Text of a literal's escape; empty for escapes that no sentence has.
std::string unescaped(char escape) {
  if (escape == 'n') return "\n";
  return escape == '"' || escape == '\\' || escape == '\'' ? std::string(1, escape) : "";
}

/// A literal's text as printed; each {} of a format becomes kVaries.
std::string printed(std::string_view literal) {
  std::string text;
  for (std::size_t i = 0; i < literal.size(); ++i) {
    if (literal[i] == '\\' && i + 1 < literal.size()) {
      text += unescaped(literal[++i]);
      continue;
    }
    const std::size_t end = literal[i] == '{' ? literal.find('}', i) : std::string_view::npos;
    if (end == std::string_view::npos || literal.substr(i, 2) == "{{") {
      text += literal[i];
      continue;
    }
    text += kVaries;
    i = end;
  }
  return text;
}

/// Place after the quote that ends the literal which begins at `begin`.
std::size_t end_of_literal(std::string_view source, std::size_t begin) {
  const char quote = source[begin];
  std::size_t i = begin + 1;
  while (i < source.size() && source[i] != quote) i += source[i] == '\\' ? 2 : 1;
  return std::min(i + 1, source.size());
}

/// Literals of each statement, one after the other; those with only blanks between are joined.
Words statements(std::string_view source) {
  Words all(1);
  bool joined = false;
  for (std::size_t i = 0; i < source.size();) {
    const char c = source[i];
    if (source.substr(i, 2) == "//") {
      i = std::min(source.find('\n', i), source.size());
    } else if (c == '"') {
      const std::size_t end = end_of_literal(source, i);
      if (!joined) all.back() += kVaries;
      all.back() += printed(source.substr(i + 1, end - i - 2));
      joined = true;
      i = end;
    } else if (c == '\'') {
      // A quote between digits separates them; others begin a character.
      const bool digits = i > 0 && std::isxdigit(static_cast<unsigned char>(source[i - 1])) != 0;
      i = digits ? i + 1 : end_of_literal(source, i);
    } else {
      if (std::isspace(static_cast<unsigned char>(c)) == 0) joined = false;
      if ((c == ';' || c == '{' || c == '}') && !all.back().empty()) all.emplace_back();
      ++i;
    }
  }
  return all;
}

/// All sentences that the program can print.
Words sentences() {
  Words all;
  for (const char* folder : {"tools", "rt_core/offline"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(kRoot / folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".cpp" && ending != ".h") continue;
      const Words own = statements(text_of(entry.path()));
      all.insert(all.end(), own.begin(), own.end());
    }
  return all;
}

/// Whether the parts of `quoted`, between its "...", stand in `said` one after the other.
bool has_parts(const std::string& said, const std::string& quoted) {
  std::size_t at = 0;
  for (std::size_t begin = 0; begin <= quoted.size();) {
    const std::size_t end = std::min(quoted.find("...", begin), quoted.size());
    const std::string part = quoted.substr(begin, end - begin);
    at = said.find(part, at);
    if (at == std::string::npos) return false;
    at += part.size();
    begin = end + 3;
  }
  return true;
}

bool is_said(const Words& all, const std::string& quoted) {
  return std::any_of(all.begin(), all.end(),
                     [&](const std::string& said) { return has_parts(said, quoted); });
}

// Pages ------------------------------------------------------------------------------------------

std::string page(const char* name) { return text_of(kRoot / "docs" / name); }

Words lines_of(const std::string& text) {
  std::istringstream in(text);
  Words lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

Words code_spans(const std::string& text) {
  Words spans;
  for (std::size_t i = text.find('`'); i != std::string::npos;) {
    const std::size_t end = text.find('`', i + 1);
    if (end == std::string::npos) break;
    spans.push_back(text.substr(i + 1, end - i - 1));
    i = text.find('`', end + 1);
  }
  return spans;
}

/// Code spans in the first cells of the tables whose first column is called `head`.
Words first_cells(const std::string& text, const std::string& head) {
  Words spans;
  bool inside = false;
  for (const std::string& line : lines_of(text)) {
    if (!line.starts_with("| ")) {
      inside = inside && line.starts_with("|");
      continue;
    }
    const std::string cell = line.substr(2, line.find(" |", 2) - 2);
    if (inside) {
      const Words own = code_spans(cell);
      spans.insert(spans.end(), own.begin(), own.end());
    }
    inside = inside || cell == head;
  }
  return spans;
}

// Commands ---------------------------------------------------------------------------------------

/// Words of a command, separated as by the shell, without comments.
Words words_of(const std::string& command) {
  Words words;
  static const std::regex kWord(R"((?:'[^']*'|"[^"]*"|[^\s'"])+)");
  for (auto i = std::sregex_iterator(command.begin(), command.end(), kWord);
       i != std::sregex_iterator(); ++i) {
    if (i->str().starts_with("#")) break;
    std::string word = i->str();
    std::erase(word, '\'');
    words.push_back(word);
  }
  return words;
}

/// Indented or fenced lines of a page, and its code spans of more than one word.
std::vector<Words> commands_of(const std::string& text) {
  std::vector<Words> commands;
  bool fenced = false;
  for (const std::string& line : lines_of(text)) {
    if (line.starts_with("```")) {
      fenced = !fenced;
      continue;
    }
    const Words shown = fenced || line.starts_with("    ") ? Words{line} : code_spans(line);
    for (const std::string& own : shown) {
      const Words words = words_of(own);
      if (words.size() > 1) commands.push_back(words);
    }
  }
  return commands;
}

bool is_program(const std::string& word) {
  return word == "railstep" || word.ends_with("/railstep");
}

/// Whether it looks like the name of a file of the repository, or of one that a command made.
bool is_file(const std::string& word) {
  static const std::regex kFolder("^(config|docs|tests|tools|rt_core|bench)/.*");
  static const std::regex kEnding(R"(^[\w./-]+\.(toml|csv|model|recording|html|tuned)$)");
  return std::regex_match(word, kFolder) || std::regex_match(word, kEnding);
}

bool is_written_by(const std::string& option) {
  static const std::set<std::string> kWriting = {"--out",    "--trace", "--report", "--record",
                                                 "--emit-c", "--csv",   "--shape",  "--names",
                                                 "--vtk",    "--resume"};
  return kWriting.count(option) != 0;
}

/// Faults of a page's commands, one line each.
Words faults_of(const std::vector<Words>& commands) {
  Words faults;
  std::set<std::string> written;
  for (const Words& words : commands) {
    const bool own = is_program(words[0]);
    if (!own && words[0].find('/') == std::string::npos) continue;
    const std::string help = own ? railstep_program(words[1] + " --help").out : "";
    if (own && help.find("Usage: railstep " + words[1]) == std::string::npos)
      faults.push_back(words[1] + " is no command");
    for (std::size_t i = own ? 2 : 0; i < words.size(); ++i) {
      const std::string& word = words[i];
      if (own && word.starts_with("--") && help.find(word) == std::string::npos)
        faults.push_back(words[1] + " has no option " + word);
      if (!is_file(word)) continue;
      if (i > 0 && is_written_by(words[i - 1]))
        written.insert(word);
      else if (written.count(word) == 0 && !std::filesystem::exists(kRoot / word))
        faults.push_back(word + " is not there");
    }
  }
  return faults;
}

}  // namespace

TEST_CASE("sentences of sources are found as they are printed", "[docs]") {
  const Words all = statements(R"(// "a comment"
    fail(fmt::format("{}: {:.3g} of \"{}\" is "
                     "not {{there}}", a, 'x', 1'000));
    throw Error("a line of " + std::to_string(n) + " unknowns");)");
  CHECK(is_said(all, R"(... of "..." is not)"));
  CHECK(is_said(all, "a line of ... unknowns"));
  CHECK_FALSE(is_said(all, "a comment"));
  CHECK_FALSE(is_said(all, "is not a line"));
  CHECK_FALSE(is_said(all, "unknowns ... a line of"));
  CHECK_FALSE(is_said(sentences(), "a sentence that no one says"));
}

TEST_CASE("the page describes every status bit and no other", "[docs]") {
  const Words told = first_cells(page("troubleshooting.md"), "bit");
  for (const StatusText& text : kStatusTexts) {
    CAPTURE(text.name);
    CHECK(std::count(told.begin(), told.end(), text.name) == 1);
  }
  CHECK(told.size() == std::size(kStatusTexts));
}

TEST_CASE("every sentence on the page is one of the program's", "[docs]") {
  const Words told = first_cells(page("troubleshooting.md"), "sentence"), all = sentences();
  CHECK(told.size() > 300);
  for (const std::string& quoted : told) {
    CAPTURE(quoted);
    CHECK(is_said(all, quoted));
  }
}

TEST_CASE("commands of a page have a name, options and files that exist", "[docs]") {
  const std::vector<Words> bad = {{"railstep", "walk"},
                                  {"railstep", "run", "config/scenes/none.toml", "--haste"},
                                  {"railstep", "replay", "a.recording"}};
  CHECK(faults_of(bad).size() == 4);
  for (const char* name : {"promises.md", "troubleshooting.md"}) {
    const std::vector<Words> commands = commands_of(page(name));
    CAPTURE(name);
    CHECK(std::count_if(commands.begin(), commands.end(),
                        [](const Words& words) { return is_program(words[0]); }) > 4);
    CHECK(faults_of(commands) == Words{});
  }
}

TEST_CASE("links of a page lead to files, and its hashes are the stored ones", "[docs]") {
  static const std::regex kLink(R"(\]\(([\w-]+\.md)[)#])");
  for (const char* name : {"promises.md", "troubleshooting.md"}) {
    const std::string text = page(name);
    for (auto i = std::sregex_iterator(text.begin(), text.end(), kLink);
         i != std::sregex_iterator(); ++i) {
      CAPTURE(name, i->str());
      CHECK(std::filesystem::exists(kRoot / "docs" / i->str(1)));
    }
  }
  const Words stored = lines_of(text_of(kRoot / "tests/data/models/hashes"));
  const auto own = std::find_if(stored.begin(), stored.end(), [](const std::string& line) {
    return line.starts_with("moving_load.full ");
  });
  REQUIRE(own != stored.end());
  CHECK(page("promises.md").find(words_of(*own)[2]) != std::string::npos);
}
