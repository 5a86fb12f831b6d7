// Based on: Pineda's half-open coverage on a sub-pixel grid, evaluated row by row with the exact rational
// line algorithm (Bresenham 1965). Differs in: spans of bits instead of pixels; two crossings per row, in any
// order.
#include "bench/measure/mask.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "raster/base/check.h"

namespace limn::measure {
namespace {

constexpr std::int64_t kUnits = 256;  // of coordinates per sample
constexpr double kGuard = 1 << 24;    // largest coordinate, in units

std::int64_t floorDivide(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t quotient = numerator / denominator;
  return quotient - (numerator % denominator < 0 ? 1 : 0);
}

// First row whose centre is at or below y.
int firstRowFrom(std::int32_t y) {
  return static_cast<int>(floorDivide(y + kUnits / 2 - 1, kUnits));
}

// Where an edge crosses the rows' centres: the first sample whose centre is at or right of it, exactly.
class Crossing {
 public:
  Crossing(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1, int row) {
    const std::int64_t dx = x1 - x0, dy = y1 - y0;  // dy > 0
    const std::int64_t centre = row * kUnits + kUnits / 2;
    denominator_ = kUnits * dy;
    // ceil((x - half) / units) with x = x0 + (centre - y0) dx / dy
    const std::int64_t numerator = (x0 - kUnits / 2) * dy + (centre - y0) * dx + denominator_ - 1;
    sample_ = floorDivide(numerator, denominator_);
    remainder_ = numerator - sample_ * denominator_;
    step_ = floorDivide(dx, dy);
    remainderStep_ = kUnits * (dx - step_ * dy);
  }
  std::int64_t sample() const { return sample_; }
  void nextRow() {
    sample_ += step_;
    remainder_ += remainderStep_;
    if (remainder_ >= denominator_) {
      remainder_ -= denominator_;
      ++sample_;
    }
  }

 private:
  std::int64_t denominator_, sample_, remainder_, step_, remainderStep_;
};

}  // namespace

Mask::Mask(int width, int height)
    : columns_(width * kSamplesPerPixel),
      rows_(height * kSamplesPerPixel),
      words_((static_cast<std::size_t>(columns_) + 63) / 64 +
             8),  // a cache line more: rows fall into all cache sets
      firstRow_(rows_) {
  require(width >= 1 && height >= 1 && width <= 2048 && height <= 2048, "a mask has 1 to 2048 pixels a side");
  bits_.assign(words_ * static_cast<std::size_t>(rows_), 0);
}

void Mask::clear() {
  if (firstRow_ < endRow_) {
    std::fill(bits_.begin() + static_cast<std::ptrdiff_t>(firstRow_ * words_),
              bits_.begin() + static_cast<std::ptrdiff_t>(endRow_ * words_), 0);
  }
  firstRow_ = rows_;
  endRow_ = 0;
}

void Mask::fill(int y, std::int64_t begin, std::int64_t end) {
  begin = std::max<std::int64_t>(begin, 0);
  end = std::min<std::int64_t>(end, columns_);
  if (begin >= end) return;
  std::uint64_t* const row = bits_.data() + static_cast<std::size_t>(y) * words_;
  const std::size_t first = static_cast<std::size_t>(begin) / 64,
                    last = static_cast<std::size_t>(end - 1) / 64;
  const std::uint64_t head = ~std::uint64_t{0} << (begin % 64);
  const std::uint64_t tail = ~std::uint64_t{0} >> (63 - (end - 1) % 64);
  if (first == last) {
    row[first] |= head & tail;
    return;
  }
  row[first] |= head;
  std::fill(row + first + 1, row + last, ~std::uint64_t{0});
  row[last] |= tail;
}

void Mask::draw(const SampleTriangle& triangle, int rowBegin, int rowEnd) {
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return triangle.y[a] < triangle.y[b]; });
  const auto [top, middle, bottom] = order;
  const auto &x = triangle.x, &y = triangle.y;  // not a structured binding: clang++ 14 cannot capture those
  const int begin = std::clamp(firstRowFrom(y[top]), rowBegin, rowEnd);
  const int end = std::clamp(firstRowFrom(y[bottom]), rowBegin, rowEnd);
  if (begin >= end) return;
  const int turn = std::clamp(firstRowFrom(y[middle]), begin, end);
  firstRow_ = std::min(firstRow_, begin);
  endRow_ = std::max(endRow_, end);

  Crossing across(x[top], y[top], x[bottom], y[bottom], begin);
  const auto drawRows = [&](int from, int to, int upper, int lower) {
    if (from >= to) return;
    Crossing side(x[upper], y[upper], x[lower], y[lower], from);
    for (int row = from; row < to; ++row, side.nextRow(), across.nextRow()) {
      fill(row, std::min(side.sample(), across.sample()), std::max(side.sample(), across.sample()));
    }
  };
  drawRows(begin, turn, top, middle);
  drawRows(turn, end, middle, bottom);
}

// Band by band, so that the rows at work stay in the cache.
void Mask::draw(std::span<const SampleTriangle> triangles) {
  constexpr int kBandRows = 256;
  const int bands = (rows_ + kBandRows - 1) / kBandRows;
  const auto forBands = [&](const SampleTriangle& triangle, const auto& body) {
    const auto [low, high] = std::minmax({triangle.y[0], triangle.y[1], triangle.y[2]});
    const int begin = std::clamp(firstRowFrom(low), 0, rows_), end = std::clamp(firstRowFrom(high), 0, rows_);
    if (begin >= end) return;
    for (int band = begin / kBandRows; band <= (end - 1) / kBandRows; ++band)
      body(static_cast<std::size_t>(band));
  };
  std::vector<std::size_t> bandEnd(static_cast<std::size_t>(bands) + 1, 0);
  for (const SampleTriangle& t : triangles) forBands(t, [&](std::size_t band) { ++bandEnd[band + 1]; });
  for (std::size_t i = 1; i < bandEnd.size(); ++i) bandEnd[i] += bandEnd[i - 1];
  std::vector<std::uint32_t> members(bandEnd.back());
  std::vector<std::size_t> next = bandEnd;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    forBands(triangles[i], [&](std::size_t band) { members[next[band]++] = static_cast<std::uint32_t>(i); });
  }
  for (int band = 0; band < bands; ++band) {
    const int rowBegin = band * kBandRows, rowEnd = std::min(rowBegin + kBandRows, rows_);
    for (std::size_t i = bandEnd[band]; i < bandEnd[band + 1]; ++i)
      draw(triangles[members[i]], rowBegin, rowEnd);
  }
}

double Mask::area() const {
  std::int64_t samples = 0;
  for (const std::uint64_t word : bits_) samples += std::popcount(word);
  return static_cast<double>(samples) / (kSamplesPerPixel * kSamplesPerPixel);
}

double differenceArea(const Mask& a, const Mask& b) {
  require(a.columns() == b.columns() && a.rows() == b.rows(), "the masks must have the same size");
  std::int64_t samples = 0;
  for (int y = std::min(a.firstRow(), b.firstRow()); y < std::max(a.endRow(), b.endRow()); ++y) {
    const auto rowA = a.row(y), rowB = b.row(y);
    for (std::size_t i = 0; i < rowA.size(); ++i) {
      if (rowA[i] != rowB[i]) samples += std::popcount(rowA[i] ^ rowB[i]);
    }
  }
  return static_cast<double>(samples) / (kSamplesPerPixel * kSamplesPerPixel);
}

namespace {

// A convex polygon of view-space or window points, at most a triangle cut by five planes.
template <class Point>
struct Polygon {
  std::array<Point, 8> points;
  int count = 0;
};

// Keeps the part where distance(point) >= 0.
template <class Point, class Distance>
Polygon<Point> clip(const Polygon<Point>& in, const Distance& distance) {
  Polygon<Point> out;
  for (int i = 0; i < in.count; ++i) {
    const Point &a = in.points[i], &b = in.points[(i + 1) % in.count];
    const double da = distance(a), db = distance(b);
    if (da >= 0) out.points[out.count++] = a;
    if ((da >= 0) != (db >= 0)) out.points[out.count++] = a + (b - a) * (da / (da - db));
  }
  return out;
}

class Projector {
 public:
  Projector(const scene::CameraView& camera, std::vector<SampleTriangle>& triangles)
      : projection_(camera.projection), triangles_(triangles) {}

  glm::dvec2 toUnits(const glm::dvec3& view) const {
    const double w = projection_.perspective ? -view.z : 1.0;
    constexpr double scale = double(kSamplesPerPixel) * kUnits;
    return {(projection_.width / 2.0 + view.x / w * projection_.pixelsX) * scale,
            (projection_.height / 2.0 - view.y / w * projection_.pixelsY) * scale};
  }
  bool needsClipping(const glm::dvec3& view) const {
    if (-view.z < projection_.nearPlane) return true;
    const glm::dvec2 units = toUnits(view);
    return !(std::abs(units.x) <= kGuard && std::abs(units.y) <= kGuard);
  }
  void add(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const auto snap = [](double units) { return static_cast<std::int32_t>(std::floor(units + 0.5)); };
    triangles_.push_back({{snap(a.x), snap(b.x), snap(c.x)}, {snap(a.y), snap(b.y), snap(c.y)}});
  }
  void addClipped(const std::array<glm::dvec3, 3>& corners) {
    Polygon<glm::dvec3> inView{{corners[0], corners[1], corners[2]}, 3};
    inView = clip(inView, [&](const glm::dvec3& p) { return -p.z - projection_.nearPlane; });
    Polygon<glm::dvec2> polygon;
    polygon.count = inView.count;
    for (int i = 0; i < inView.count; ++i) polygon.points[i] = toUnits(inView.points[i]);
    polygon = clip(polygon, [](const glm::dvec2& p) { return kGuard - p.x; });
    polygon = clip(polygon, [](const glm::dvec2& p) { return kGuard + p.x; });
    polygon = clip(polygon, [](const glm::dvec2& p) { return kGuard - p.y; });
    polygon = clip(polygon, [](const glm::dvec2& p) { return kGuard + p.y; });
    for (int i = 2; i < polygon.count; ++i) add(polygon.points[0], polygon.points[i - 1], polygon.points[i]);
  }

 private:
  Projection projection_;
  std::vector<SampleTriangle>& triangles_;
};

}  // namespace

void project(const Surface& surface, const scene::CameraView& camera,
             std::vector<SampleTriangle>& triangles) {
  triangles.clear();
  triangles.reserve(surface.triangleCount());
  Projector projector(camera, triangles);
  std::vector<glm::dvec3> view(surface.positions.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    view[i] = glm::dvec3(camera.worldToView * glm::dvec4(surface.positions[i], 1.0));
  }
  for (std::size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
    const std::array<glm::dvec3, 3> corners{view[surface.indices[i]], view[surface.indices[i + 1]],
                                            view[surface.indices[i + 2]]};
    if (std::any_of(corners.begin(), corners.end(),
                    [&](const auto& p) { return projector.needsClipping(p); })) {
      projector.addClipped(corners);
    } else {
      projector.add(projector.toUnits(corners[0]), projector.toUnits(corners[1]),
                    projector.toUnits(corners[2]));
    }
  }
}

}  // namespace limn::measure
