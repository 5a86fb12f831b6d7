// Based on: Damerau 1964 and Levenshtein 1966, edit distance with swaps of neighbours (optimal string
// alignment).
#include "apps/scene/nearest.h"

#include <algorithm>
#include <vector>

namespace limn::scene {
namespace {

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearestName(std::string_view name, std::span<const std::string> known) {
  constexpr std::size_t kLongestName =
      64;  // the distance takes time in proportion to the product of the lengths
  if (name.empty() || name.size() > kLongestName) return {};
  std::string nearest;
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    std::size_t distance = editDistance(name, candidate);
    if (candidate.starts_with(name) || name.starts_with(candidate))
      distance = std::min<std::size_t>(distance, 1);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace limn::scene
