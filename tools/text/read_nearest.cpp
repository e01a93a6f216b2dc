#include <algorithm>
#include <limits>

#include "text/read.h"
#include "text/read_document.h"

namespace railstep {
namespace {

constexpr int kEdit = 8;           // cost of one inserted, dropped or changed letter
constexpr int kMissingLetter = 1;  // of one letter of `known` after the end of `word`

/// Edit distance in eighths of an edit, the end of `known` nearly free. O(lengths' product).
int distance(std::string_view word, std::string_view known) {
  std::vector<int> row(known.size() + 1), next(known.size() + 1);
  for (std::size_t j = 0; j <= known.size(); ++j) row[j] = kEdit * static_cast<int>(j);
  for (std::size_t i = 1; i <= word.size(); ++i) {
    next[0] = kEdit * static_cast<int>(i);
    for (std::size_t j = 1; j <= known.size(); ++j) {
      const int changed = row[j - 1] + (word[i - 1] == known[j - 1] ? 0 : kEdit);
      next[j] = std::min({changed, row[j] + kEdit, next[j - 1] + kEdit});
    }
    std::swap(row, next);
  }
  int best = row[known.size()];
  for (std::size_t j = 0; j < known.size(); ++j)
    best = std::min(best, row[j] + kMissingLetter * static_cast<int>(known.size() - j));
  return best;
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  word = word.substr(0, 200);  // keeps the table small whatever the file says
  const auto closer = [&](const std::string& a, const std::string& b) {
    return distance(word, a) < distance(word, b);
  };
  const auto best = std::min_element(known.begin(), known.end(), closer);
  return best == known.end() ? std::string() : *best;
}

std::string misspelt(std::string_view wanted, const std::vector<std::string>& unread) {
  std::string found;
  int least = std::numeric_limits<int>::max();
  for (const std::string& word : unread) {
    const std::string_view start = std::string_view(word).substr(0, 200);
    const int d = distance(start, wanted);
    if (d <= kEdit * static_cast<int>(start.size()) / 3 && d < least) {
      least = d;
      found = word;
    }
  }
  return found;
}

}  // namespace railstep
