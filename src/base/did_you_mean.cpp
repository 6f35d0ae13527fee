#include "flute_grinder/base/did_you_mean.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace grinder {

namespace {

/// The edit distance: letters to insert, remove, replace or swap with the next.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last, last, row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string didYouMean(const std::string& word, const std::vector<std::string>& known) {
  // Short words may differ less, or every word would be near.
  constexpr std::size_t most = 2;
  const std::size_t farthest = std::min(most, (word.size() - std::min(word.size(), word.find_first_not_of('-'))) / 2);
  const auto far = [&](const std::string& other) -> std::size_t {
    if (other.rfind(word, 0) == 0) return 0;
    if (std::max(word.size(), other.size()) - std::min(word.size(), other.size()) > most) return most + 1;
    return distance(word, other);
  };
  const auto best =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) { return far(a) < far(b); });
  if (best == known.end() || far(*best) > farthest) return "";
  return "; did you mean '" + *best + "'?";
}

}  // namespace grinder
