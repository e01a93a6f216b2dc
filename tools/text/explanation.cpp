#include "text/explanation.h"

#include <algorithm>

namespace railstep {
namespace {

constexpr std::string_view kHeading = "\n## ";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \n") - first + 1);
}

}  // namespace

std::vector<Explanation> explanations() {
  std::vector<Explanation> all;
  for (const std::string_view page : message_pages())
    for (auto at = page.find(kHeading); at != std::string_view::npos;) {
      const auto begin = at + kHeading.size(), end = page.find(kHeading, begin);
      const std::string_view entry = page.substr(begin, end - begin);
      const auto line = std::min(entry.find('\n'), entry.size());
      all.push_back({trimmed(entry.substr(0, line)), trimmed(entry.substr(line))});
      at = end;
    }
  return all;
}

std::string first_sentence(const Explanation& explanation) {
  const std::string_view text = explanation.text;
  const auto stop = std::min(text.find(". "), text.find(".\n"));
  std::string sentence(text.substr(0, stop == std::string_view::npos ? stop : stop + 1));
  std::replace(sentence.begin(), sentence.end(), '\n', ' ');
  return sentence;
}

}  // namespace railstep
