#include <fmt/core.h>

#include <algorithm>
#include <fstream>

#include "text/files.h"
#include "text/read.h"
#include "text/read_document.h"

namespace railstep {
namespace {

constexpr int kDeepest = 32;  // brackets in brackets, and dots in one key

struct Position {
  int line = 1, column = 1;
};

Position position_of(std::string_view text, std::size_t at) {
  Position p;
  for (std::size_t i = 0; i < at; ++i) {
    if (text[i] == '\n') {
      ++p.line;
      p.column = 1;
    } else {
      ++p.column;
    }
  }
  return p;
}

/// The end of the string that opens at `i`: the place after its last quote, or the text's end.
std::size_t skip_string(std::string_view text, std::size_t i) {
  const char quote = text[i];
  const std::string triple(3, quote);
  const bool is_long = text.substr(i, 3) == triple;
  i += is_long ? 3 : 1;
  for (; i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (is_long ? text.substr(i, 3) == triple : text[i] == quote) {
      return i + (is_long ? 3 : 1);
    } else if (!is_long && text[i] == '\n') {
      return i;  // an unfinished string, which the parser will name
    }
  }
  return text.size();
}

/// Refuses deep nesting before the parser sees it: a key of 1e5 dots makes 1e5 tables in each
/// other, whose destructors would run the stack out.
void check_depth(std::string_view text, const std::string& name) {
  int depth = 0, dots = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = skip_string(text, i);
      continue;
    }
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (c == '.')
      ++dots;
    else if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos)
      dots = 0;
    if (depth > kDeepest || dots > kDeepest) {
      const Position p = position_of(text, i);
      throw InputError("E-FILE-02", fmt::format("{}:{}:{}: the file nests arrays or tables deeper "
                                                "than {} levels; expected at most {}",
                                                name, p.line, p.column, kDeepest, kDeepest));
    }
    ++i;
  }
}

}  // namespace

std::string read_text(const std::filesystem::path& file, std::size_t most) {
  const std::string name = file.string();
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw InputError("E-FILE-03", fmt::format("{}: this is a folder; expected a file", name));
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw InputError(
        "E-FILE-04",
        fmt::format("{}: the file cannot be opened; expected a file that is there and may be read",
                    name));
  note_read_file(file);
  std::string text;  // in pieces: what has no size in the file system is read too
  for (std::size_t got = 1; got > 0 && text.size() <= most;) {
    constexpr std::size_t kPiece = 1u << 20;
    const std::size_t before = text.size();
    text.resize(before + std::min(kPiece, most + 1 - before));
    in.read(text.data() + before, static_cast<std::streamsize>(text.size() - before));
    got = static_cast<std::size_t>(in.gcount());
    text.resize(before + got);
  }
  if (in.bad()) throw InputError("E-FILE-05", fmt::format("{}: the file cannot be read", name));
  if (text.size() > most)
    throw InputError("E-FILE-06",
                     fmt::format("{}: the file is longer than {} bytes; expected at most {} MiB",
                                 name, most, most >> 20));
  if (text.empty())
    throw InputError("E-FILE-07",
                     fmt::format("{}: the file is empty; expected a file of text", name));
  return text;
}

std::string place(const toml::source_region& source, const std::filesystem::path& file) {
  std::string name = source.path ? *source.path : file.string();
  if (name.starts_with("--set")) return name;
  if (!source.begin) return name;
  return fmt::format("{}:{}:{}", name, source.begin.line, source.begin.column);
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return text;
}

toml::table parse_toml(std::string_view text, const std::string& name) {
  if (const auto nul = text.find('\0'); nul != std::string_view::npos) {
    const Position p = position_of(text, nul);
    throw InputError("E-FILE-08",
                     fmt::format("{}:{}:{}: the file holds a NUL byte; expected text in UTF-8",
                                 name, p.line, p.column));
  }
  check_depth(text, name);
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw InputError("E-FILE-09", fmt::format("{}: {}; expected a TOML 1.0 document",
                                              place(error.source(), name),
                                              one_line(std::string(error.description()))));
  }
}

}  // namespace railstep
