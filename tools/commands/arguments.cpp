#include "commands/arguments.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "commands/options.h"
#include "text/files.h"
#include "text/read.h"

namespace railstep {
namespace {

std::string refused_number(std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool whole = !text.empty() && text.front() != ' ' && *end == '\0';
  if (whole && value == 0.) text = "0";  // of -0.0 too
  if (whole && std::isfinite(value)) return {};
  return fmt::format("'{}' is not a {}; expected a finite number", text.substr(0, 60),
                     whole ? "finite number" : "number");
}

std::string refused_integer(std::string& text) {
  std::int64_t value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, fault] = std::from_chars(text.data(), last, value);
  if (fault == std::errc{} && end == last) return {};
  return fmt::format("'{}' is not a whole number; expected a whole number such as 24",
                     text.substr(0, 60));
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  // Two outputs may go to one device or pipe, and a folder is refused where it is written.
  if (std::filesystem::exists(a, ignored) && !std::filesystem::is_regular_file(a, ignored))
    return false;
  return std::filesystem::weakly_canonical(a, ignored) ==
             std::filesystem::weakly_canonical(b, ignored) ||
         std::filesystem::equivalent(a, b, ignored);
}

/// The first word that was not read; an option before others.
std::string unread_word(const CLI::App& app) {
  const std::vector<std::string> unread = app.remaining(true);
  for (const std::string& word : unread)
    if (word.starts_with("-")) return word;
  return unread.empty() ? "" : unread.front();
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) names.push_back(option->get_name());
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  const std::function<bool(const CLI::App*)> all = [](const CLI::App*) { return true; };
  for (const CLI::App* command : app.get_subcommands(all)) names.push_back(command->get_name());
  return names;
}

}  // namespace

void refuse_empty_words(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool no_value = word.starts_with("--") && word.find('=') == word.size() - 1;
    if (word.empty())
      throw InputError("E-CLI-01",
                       fmt::format("the word after '{}' is empty; expected a value or a name",
                                   std::string_view(argv[i - 1]).substr(0, 60)));
    if (no_value)
      throw InputError(
          "E-CLI-02",
          fmt::format("{} has no value; expected a value or a name after the equals sign", word));
  }
}

void want_finite_numbers(CLI::App& app) {
  const std::function<bool(CLI::App*)> all = [](CLI::App*) { return true; };
  for (CLI::App* command : app.get_subcommands(all))
    for (CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      if (type.starts_with("FLOAT")) option->transform(CLI::Validator(refused_number, ""));
      if (type.starts_with("INT")) option->transform(CLI::Validator(refused_integer, ""));
    }
}

Message usage_message(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::string word = unread_word(app), shown = word.substr(0, 60);
  const std::string name = chosen.empty() ? "" : chosen.front()->get_name() + " ";
  std::string said = error.what();
  MessageId id = "E-CLI-10";
  if (chosen.empty() && !word.empty()) {
    id = "E-CLI-11";
    said = fmt::format("'{}' is not a command; did you mean '{}'?", shown,
                       nearest(word, command_names(app)));
  } else if (!chosen.empty() && word.starts_with("-")) {
    id = "E-CLI-12";
    said = fmt::format("unknown option '{}'; did you mean '{}'?", shown,
                       nearest(word, option_names(*chosen.front())));
  } else if (!chosen.empty() && !word.empty()) {
    id = "E-CLI-13";
    said = fmt::format("'{}' is one word too many", shown);
  }
  std::replace(said.begin(), said.end(), '\n', ' ');
  return {id,
          fmt::format("{}{} see `railstep {}--help`", said, said.ends_with('?') ? "" : ";", name)};
}

void refuse_impossible_places(CLI::App& command) {
  std::error_code ignored;
  for (CLI::Option* option : command.get_options()) {
    if (!is_written(*option) || option->empty()) continue;
    const std::filesystem::path file = option->results().front(), folder = file.parent_path();
    if (is_folder(*option)) continue;
    if (std::filesystem::is_directory(file, ignored))
      throw InputError("E-CLI-03",
                       fmt::format("{} {}: this is a folder; expected the name of a file",
                                   option->get_name(), file.string()));
    // To rename a file over /dev/stdout would remove it for the whole machine, where the user has
    // the right to.
    if (folder == "/dev" && std::filesystem::is_regular_file(file, ignored))
      throw InputError(
          "E-CLI-04",
          fmt::format("{} {}: this name stands for an open file; expected the file's own name",
                      option->get_name(), file.string()));
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
      throw InputError(
          "E-CLI-05",
          fmt::format("{} {}: there is no folder {}; expected a file in a folder that exists",
                      option->get_name(), file.string(), folder.string()));
  }
}

void refuse_same_files(CLI::App& command) {
  const std::vector<CLI::Option*> options = command.get_options();
  for (auto to = options.begin(); to != options.end(); ++to) {
    if (!is_written(**to) || (*to)->empty()) continue;
    const std::string file = (*to)->results().front();
    if (!is_folder(**to)) announce_output((*to)->get_name(), file);
    for (auto other = options.begin(); other != options.end(); ++other) {
      const std::string name = (*other)->get_name();
      const bool taken = is_read(**other) || (other < to && is_written(**other));
      if (taken && !(*other)->empty() && same_file(file, (*other)->results().front()))
        throw InputError("E-CLI-06",
                         fmt::format("{} and {} both name {}; expected a file of its own for each",
                                     name, (*to)->get_name(), file));
    }
  }
}

}  // namespace railstep
