// Based on: crack following (Rosenfeld & Kak, "Digital Picture Processing", 1982, section 11.1.3); the sector
// test of Williams, "An efficient algorithm for the piecewise linear approximation of planar curves", 1978.
// Differs in: the pieces join crack midpoints, which lie within half a sample of the true border.
#include "bench/measure/outline.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "raster/base/elementary.h"

namespace limn::measure {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// Samples that are set while their left neighbour is clear, row by row: every contour passes by one of them
// upwards.
class LeftBorders {
 public:
  explicit LeftBorders(const Mask& mask) : firstRow_(mask.firstRow()) {
    rowBegin_.push_back(0);
    for (int y = mask.firstRow(); y < mask.endRow(); ++y) {
      std::uint64_t carry = 0;
      const auto row = mask.row(y);
      for (std::size_t i = 0; i < row.size(); ++i) {
        std::uint64_t starts = row[i] & ~(row[i] << 1 | carry);
        carry = row[i] >> 63;
        for (; starts != 0; starts &= starts - 1) {
          columns_.push_back(static_cast<int>(i * 64) + std::countr_zero(starts));
        }
      }
      rowBegin_.push_back(columns_.size());
    }
    seen_.resize(columns_.size());
  }

  std::size_t rowCount() const { return rowBegin_.size() - 1; }
  template <class Body>
  void forUnseen(const Body& body) {
    for (std::size_t row = 0; row < rowCount(); ++row) {
      for (std::size_t i = rowBegin_[row]; i < rowBegin_[row + 1]; ++i) {
        if (seen_[i] == 0) body(columns_[i], firstRow_ + static_cast<int>(row));
      }
    }
  }
  void markSeen(int x, int y) {
    const std::size_t row = static_cast<std::size_t>(y - firstRow_);
    const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(rowBegin_[row]);
    const auto end = columns_.begin() + static_cast<std::ptrdiff_t>(rowBegin_[row + 1]);
    seen_[static_cast<std::size_t>(std::lower_bound(begin, end, x) - columns_.begin())] = 1;
  }

 private:
  int firstRow_;
  std::vector<std::size_t> rowBegin_;
  std::vector<int> columns_;
  std::vector<char> seen_;
};

// Midpoints of the cracks around one contour, in samples; starts up along the left side of sample (x, y) and
// keeps the set samples on its right hand. Samples that touch at a corner only are taken as apart.
void follow(const Mask& mask, LeftBorders& borders, int x, int y, std::vector<glm::dvec2>& points) {
  struct Direction {
    int x, y;
  };
  static constexpr std::array<Direction, 4> kDirections{
      {{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};  // up right down left
  points.clear();
  int cornerX = x, cornerY = y + 1, direction = 0;
  const int startX = cornerX, startY = cornerY;
  do {
    const auto [dx, dy] = kDirections[direction];
    if (direction == 0) borders.markSeen(cornerX, cornerY - 1);
    points.emplace_back(cornerX + dx * 0.5, cornerY + dy * 0.5);
    cornerX += dx;
    cornerY += dy;
    // The samples ahead: right hand and left hand of the way.
    const int rightX = cornerX + (dx - dy - 1) / 2, rightY = cornerY + (dy + dx - 1) / 2;
    const int leftX = cornerX + (dx + dy - 1) / 2, leftY = cornerY + (dy - dx - 1) / 2;
    if (!mask.at(rightX, rightY)) {
      direction = (direction + 1) % 4;
    } else if (mask.at(leftX, leftY)) {
      direction = (direction + 3) % 4;
    }
  } while (cornerX != startX || cornerY != startY || direction != 0);
}

// Straight pieces from point to point that pass all points between them within `tolerance`.
std::vector<glm::dvec2> straighten(const std::vector<glm::dvec2>& points, double tolerance) {
  std::vector<glm::dvec2> corners{points.front()};
  glm::dvec2 anchor = points.front(), previous = anchor;
  glm::dvec2 right{0.0}, left{0.0};  // the sector of directions that pass all points so far
  bool open = true;                  // the sector is still the full circle
  double farthest = 0.0;  // from the anchor; coming back ends a piece, or spikes would lose their tips
  for (std::size_t i = 1; i <= points.size(); ++i) {
    const glm::dvec2 point = points[i % points.size()];
    glm::dvec2 way = point - anchor;
    const bool back = glm::length(way) < farthest - 2 * tolerance;
    if (!open && (back || cross(right, way) < 0 || cross(way, left) < 0)) {
      corners.push_back(previous);
      anchor = previous;
      way = point - anchor;
      open = true;
      farthest = 0.0;
    }
    previous = point;
    const double distance2 = glm::dot(way, way);
    farthest = std::max(farthest, std::sqrt(distance2));
    if (distance2 <= tolerance * tolerance) continue;
    const double along = std::sqrt(distance2 - tolerance * tolerance);
    const glm::dvec2 side{-way.y, way.x};
    const glm::dvec2 newRight = way * along - side * tolerance, newLeft = way * along + side * tolerance;
    if (open || cross(right, newRight) > 0) right = newRight;
    if (open || cross(newLeft, left) > 0) left = newLeft;
    open = false;
  }
  return corners;
}

}  // namespace

Outline traceOutline(const Mask& mask) {
  Outline outline;
  if (mask.firstRow() >= mask.endRow()) return outline;
  LeftBorders borders(mask);
  std::vector<glm::dvec2> points;
  borders.forUnseen([&](int x, int y) {
    follow(mask, borders, x, y, points);
    std::vector<glm::dvec2> contour = straighten(points, kOutlineTolerance * kSamplesPerPixel);
    for (glm::dvec2& point : contour) point /= double(kSamplesPerPixel);
    outline.contours.push_back(std::move(contour));
  });
  return outline;
}

namespace {

double length(const std::vector<glm::dvec2>& contour) {
  double sum = 0.0;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    sum += glm::distance(contour[i], contour[(i + 1) % contour.size()]);
  }
  return sum;
}

// The point `reach` along the contour from corner `from`, forwards (step 1) or backwards (step count - 1).
glm::dvec2 walk(const std::vector<glm::dvec2>& contour, std::size_t from, std::size_t step, double reach) {
  std::size_t at = from;
  for (double left = reach;;) {
    const std::size_t next = (at + step) % contour.size();
    const double piece = glm::distance(contour[at], contour[next]);
    if (piece >= left && piece > 0) return contour[at] + (contour[next] - contour[at]) * (left / piece);
    left -= piece;
    at = next;
  }
}

double turnAt(const std::vector<glm::dvec2>& contour, std::size_t corner) {
  const glm::dvec2 in = contour[corner] - walk(contour, corner, contour.size() - 1, kCornerReach);
  const glm::dvec2 out = walk(contour, corner, 1, kCornerReach) - contour[corner];
  return std::abs(std::atan2(cross(in, out), glm::dot(in, out)));
}

}  // namespace

double length(const Outline& outline) {
  double sum = 0.0;
  for (const auto& contour : outline.contours) sum += length(contour);
  return sum;
}

double largestTurn(const Outline& outline) {
  double largest = 0.0;
  for (const auto& contour : outline.contours) {
    if (length(contour) < 4 * kCornerReach) continue;
    for (std::size_t i = 0; i < contour.size(); ++i) largest = std::max(largest, turnAt(contour, i));
  }
  return largest * 180.0 / kPi;
}

}  // namespace limn::measure
