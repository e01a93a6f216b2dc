#include <algorithm>
#include <catch2/catch.hpp>
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
      faults.push_back(words[1] + " is not a command");
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

TEST_CASE("the page of status bits describes every bit and no other", "[docs]") {
  Words told;
  for (const std::string& line : lines_of(page("messages/status.md")))
    if (line.starts_with("## ")) told.push_back(line.substr(3));
  Words bits;
  for (const StatusText& text : kStatusTexts) bits.push_back(text.name);
  std::sort(told.begin(), told.end());
  std::sort(bits.begin(), bits.end());
  CHECK(told == bits);
}

TEST_CASE("commands of a page have a name, options and files that exist", "[docs]") {
  const std::vector<Words> bad = {{"railstep", "walk"},
                                  {"railstep", "run", "config/scenes/none.toml", "--haste"},
                                  {"railstep", "replay", "a.recording"}};
  CHECK(faults_of(bad).size() == 4);
  for (const char* name : {"promises.md", "messages/status.md"}) {
    const std::vector<Words> commands = commands_of(page(name));
    CAPTURE(name);
    CHECK(std::count_if(commands.begin(), commands.end(),
                        [](const Words& words) { return is_program(words[0]); }) > 4);
    CHECK(faults_of(commands) == Words{});
  }
}

TEST_CASE("links of pages lead to files, and its hashes are the stored ones", "[docs]") {
  static const std::regex kLink(R"(\]\(([\w./-]+\.md)[)#])");
  std::vector<std::filesystem::path> pages = {kRoot / "docs/promises.md",
                                              kRoot / "docs/troubleshooting.md"};
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / "docs/messages"))
    pages.push_back(entry.path());
  for (const std::filesystem::path& file : pages) {
    const std::string text = text_of(file);
    for (auto i = std::sregex_iterator(text.begin(), text.end(), kLink);
         i != std::sregex_iterator(); ++i) {
      CAPTURE(file.string(), i->str());
      CHECK(std::filesystem::exists(file.parent_path() / i->str(1)));
    }
  }
  const Words stored = lines_of(text_of(kRoot / "tests/data/models/hashes"));
  const auto own = std::find_if(stored.begin(), stored.end(), [](const std::string& line) {
    return line.starts_with("moving_load.full ");
  });
  REQUIRE(own != stored.end());
  CHECK(page("promises.md").find(words_of(*own)[2]) != std::string::npos);
}
