// Distances between outlines: points every 1/8 pixel along the one, nearest piece of the other from a grid of
// cells.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "bench/measure/outline.h"

namespace limn::measure {
namespace {

constexpr double kSpacing =
    1.0 / 8;  // the distance changes by at most half of it between a point and its neighbour
constexpr double kCell = 16.0;  // pixels

struct Piece {
  glm::dvec2 begin, end;
};

double distance2(const glm::dvec2& point, const Piece& piece) {
  const glm::dvec2 along = piece.end - piece.begin, way = point - piece.begin;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0 ? std::clamp(glm::dot(way, along) / length2, 0.0, 1.0) : 0.0;
  const glm::dvec2 offset = way - along * t;
  return glm::dot(offset, offset);
}

// Pieces by the cells that their boxes touch; cells that are full of them are small beside the window.
class PieceGrid {
 public:
  PieceGrid(const Outline& outline, int width, int height)
      : columns_(static_cast<int>(width / kCell) + 1), rows_(static_cast<int>(height / kCell) + 1) {
    for (const auto& contour : outline.contours) {
      for (std::size_t i = 0; i < contour.size(); ++i) cut({contour[i], contour[(i + 1) % contour.size()]});
    }
    std::vector<std::size_t> count(std::size_t(columns_) * rows_ + 1, 0);
    for (const Piece& piece : pieces_) forCells(piece, [&](std::size_t cell) { ++count[cell + 1]; });
    for (std::size_t i = 1; i < count.size(); ++i) count[i] += count[i - 1];
    begin_ = count;
    members_.resize(begin_.back());
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      forCells(pieces_[i], [&](std::size_t cell) { members_[count[cell]++] = i; });
    }
  }

  bool empty() const { return pieces_.empty(); }
  double distance(const glm::dvec2& point) const {
    const int x = column(point.x), y = row(point.y);
    double nearest2 = std::numeric_limits<double>::infinity();
    for (int ring = 0; ring < std::max(columns_, rows_); ++ring) {
      // Everything in this ring and beyond is at least (ring - 1) cells away.
      const double reach = (ring - 1) * kCell;
      if (ring > 0 && nearest2 <= reach * reach) break;
      for (int j = std::max(y - ring, 0); j <= std::min(y + ring, rows_ - 1); ++j) {
        const bool whole = j == y - ring || j == y + ring;
        for (int i = x - ring; i <= x + ring; i += whole || ring == 0 ? 1 : 2 * ring) {
          if (i >= 0 && i < columns_) search(point, i, j, nearest2);
        }
      }
    }
    return std::sqrt(nearest2);
  }

 private:
  int column(double x) const { return std::clamp(static_cast<int>(x / kCell), 0, columns_ - 1); }
  int row(double y) const { return std::clamp(static_cast<int>(y / kCell), 0, rows_ - 1); }
  // Long pieces are cut, so that the box of each touches few cells.
  void cut(const Piece& piece) {
    const int parts = static_cast<int>(glm::distance(piece.begin, piece.end) / kCell) + 1;
    for (int i = 0; i < parts; ++i) {
      pieces_.push_back({glm::mix(piece.begin, piece.end, double(i) / parts),
                         glm::mix(piece.begin, piece.end, double(i + 1) / parts)});
    }
  }
  template <class Body>
  void forCells(const Piece& piece, const Body& body) const {
    const int x0 = column(piece.begin.x), x1 = column(piece.end.x), y0 = row(piece.begin.y),
              y1 = row(piece.end.y);
    for (int j = std::min(y0, y1); j <= std::max(y0, y1); ++j) {
      for (int i = std::min(x0, x1); i <= std::max(x0, x1); ++i)
        body(static_cast<std::size_t>(j) * columns_ + i);
    }
  }
  void search(const glm::dvec2& point, int i, int j, double& nearest2) const {
    const std::size_t cell = static_cast<std::size_t>(j) * columns_ + i;
    for (std::size_t k = begin_[cell]; k < begin_[cell + 1]; ++k) {
      nearest2 = std::min(nearest2, distance2(point, pieces_[members_[k]]));
    }
  }

  int columns_, rows_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> begin_, members_;
};

OutlineDistance directed(const Outline& from, const PieceGrid& to) {
  std::vector<double> distances;
  for (const auto& contour : from.contours) {
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const glm::dvec2 begin = contour[i], end = contour[(i + 1) % contour.size()];
      const int steps = static_cast<int>(std::ceil(glm::distance(begin, end) / kSpacing));
      for (int k = 0; k < steps; ++k)
        distances.push_back(to.distance(glm::mix(begin, end, double(k) / steps)));
    }
  }
  if (distances.empty()) return {};
  const auto p95 = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() * 95 / 100);
  std::nth_element(distances.begin(), p95, distances.end());
  return {*p95, *std::max_element(p95, distances.end())};
}

}  // namespace

OutlineDistance outlineDistance(const Outline& a, const Outline& b, int width, int height) {
  const PieceGrid gridA(a, width, height), gridB(b, width, height);
  if (gridA.empty() || gridB.empty()) return {};
  const OutlineDistance ab = directed(a, gridB), ba = directed(b, gridA);
  return {std::max(ab.p95, ba.p95), std::max(ab.max, ba.max)};
}

}  // namespace limn::measure
