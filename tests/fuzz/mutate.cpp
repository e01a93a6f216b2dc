#include "mutate.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace railstep::fuzz {
namespace {

using Random = std::mt19937_64;

std::size_t below(std::size_t count, Random& random) {
  return count == 0 ? 0 : static_cast<std::size_t>(random() % count);
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1);
    lines.emplace_back(text.substr(0, end + 1));
    text.remove_prefix(end + 1);
  }
  return lines;
}

bool is_of_number(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e';
}

/// Place and length of a number in a line; length 0 if there is none.
struct Span {
  std::size_t at, length;
};
Span some_number(const std::string& line, Random& random) {
  std::vector<Span> found;
  for (std::size_t i = 0; i < line.size();) {
    const bool begins = (line[i] >= '0' && line[i] <= '9') || (line[i] == '-' && i > 0);
    std::size_t end = i;
    while (begins && end < line.size() && is_of_number(line[end])) ++end;
    if (end > i) found.push_back({i, end - i});
    i = std::max(end, i + 1);
  }
  return found.empty() ? Span{0, 0} : found[below(found.size(), random)];
}

std::string some_value(const std::string& old, Random& random) {
  static const char* const kValues[] = {
      "0",     "0.0",   "-1",     "1",    "2",    "3",    "7",      "100",   "1e-300", "1e300",
      "1e-12", "1e-6",  "1e-3",   "0.5",  "1e3",  "1e6",  "1e9",    "1e13",  "nan",    "inf",
      "-inf",  "-0.0",  "1e-323", "1.5",  "1e11", "0.05", "2000.0", "1e8",   "-1e8",   "0.1",
      "1e5",   "1e-15", "0.6",    "0.25", "1e7",  "5",    "1e-7",   "0.999", "300",    "1000000"};
  switch (random() % 6) {
    case 0:
      return "-" + old;
    case 1:
      return old + "e" + std::to_string(static_cast<int>(random() % 25) - 12);
    case 2: {
      std::string digits = old;
      const std::size_t at = below(digits.size(), random);
      digits[at] = static_cast<char>('0' + random() % 10);
      return digits;
    }
    case 3:
      return std::to_string(random() % 12);
    default:
      return kValues[below(std::size(kValues), random)];
  }
}

/// "key = value" with the value of another line.
std::string with_other_value(const std::string& line, const std::string& other) {
  const std::size_t equals = line.find('='), theirs = other.find('=');
  if (equals == std::string::npos || theirs == std::string::npos) return line;
  return line.substr(0, equals) + other.substr(theirs);
}

/// Doubles the lines from a header up to the next one: a table with its keys.
void double_table(std::vector<std::string>& lines, std::size_t at) {
  while (at > 0 && !lines[at].starts_with('[')) --at;
  std::size_t end = at + 1;
  while (end < lines.size() && !lines[end].starts_with('[')) ++end;
  std::vector<std::string> copy(lines.begin() + static_cast<std::ptrdiff_t>(at),
                                lines.begin() + static_cast<std::ptrdiff_t>(end));
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(end), copy.begin(), copy.end());
}

void change(std::vector<std::string>& lines, Random& random) {
  if (lines.empty()) return;
  const std::size_t at = below(lines.size(), random), other = below(lines.size(), random);
  std::string& line = lines[at];
  const auto place = lines.begin() + static_cast<std::ptrdiff_t>(at);
  switch (random() % 12) {
    case 0:
      lines.erase(place);
      return;
    case 1:
      lines.insert(place, std::string(lines[other]));
      return;
    case 2:
      std::swap(line, lines[other]);
      return;
    case 3:
      line = with_other_value(line, lines[other]);
      return;
    case 4:
      double_table(lines, at);
      return;
    case 5:
      if (!line.empty()) line[below(line.size(), random)] = static_cast<char>(random());
      return;
    default:
      if (const Span number = some_number(line, random); number.length > 0)
        line.replace(number.at, number.length,
                     some_value(line.substr(number.at, number.length), random));
  }
}

}  // namespace

std::string changed_text(std::string_view text, std::mt19937_64& random) {
  std::vector<std::string> lines = lines_of(text);
  for (std::uint64_t i = 0, n = 1 + random() % 3; i < n; ++i) change(lines, random);
  std::string made;
  for (const std::string& line : lines) made += line;
  return made;
}

std::size_t mutate_text(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  std::mt19937_64 random(seed);
  if (random() % 4 == 0) return LLVMFuzzerMutate(data, size, most);
  const std::string made = changed_text({reinterpret_cast<const char*>(data), size}, random);
  const std::size_t kept = std::min(made.size(), most);
  std::copy_n(made.data(), kept, data);
  return kept;
}

}  // namespace railstep::fuzz
