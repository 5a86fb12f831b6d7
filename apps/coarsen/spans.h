// Which pixels a triangle covers.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace limn::coarsen {

/// Calls span(row, from, to) for the pixels [from, to) of each row whose centres lie in the triangle, whichever way round.
template <class Span>
void forSpans(int width, int height, glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, const Span& span) {
  if (b.y < a.y) std::swap(a, b);
  if (c.y < b.y) std::swap(b, c);
  if (b.y < a.y) std::swap(a, b);
  // Clamped before they become whole numbers: a point near the eye may be anywhere.
  const auto pixel = [](double x, int size) {
    return static_cast<int>(std::ceil(std::clamp(x - 0.5, -1.0, static_cast<double>(size))));
  };
  const int first = std::max(0, pixel(a.y, height)), end = std::min(height, pixel(c.y, height));
  for (int row = first; row < end; ++row) {
    const double y = row + 0.5;
    const double along = a.x + (c.x - a.x) * (y - a.y) / (c.y - a.y);
    const double across = y < b.y ? a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y)
                                  : (c.y > b.y ? b.x + (c.x - b.x) * (y - b.y) / (c.y - b.y) : b.x);
    const int from = std::max(0, pixel(std::min(along, across), width));
    const int to = std::min(width, pixel(std::max(along, across), width));
    if (from < to) span(row, from, to);
  }
}

}  // namespace limn::coarsen
