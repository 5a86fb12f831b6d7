// Based on: N. Gupta, R. Sproull, "Filtering edges for gray-scale displays", 1981 (coverage from the distance).
// Differs in: coverage falls off linearly over one pixel about the line's border. What hides a line is decided per
// sample at the nearest point of the line, by the plane of the triangle that the sample shows: a line on the edge of a
// steep face is not lost in it.
#include "raster/lines.h"

#include <algorithm>
#include <cmath>

#include "raster/blend.h"
#include "raster/numbers.h"
#include "raster/tile.h"

namespace limn::raster {
namespace {

struct Segment {
  glm::dvec3 a, b;
};

// Keeps the part where f(a) + t (f(b) - f(a)) >= 0; false if there is none.
bool cut(double fa, double fb, Segment& s) {
  if (fa < 0.0 && fb < 0.0) return false;
  if (fa >= 0.0 && fb >= 0.0) return true;
  const bool firstIn = fa >= 0.0;
  const glm::dvec3 in = firstIn ? s.a : s.b, out = firstIn ? s.b : s.a;
  const double t = std::max(fa, fb) / (std::max(fa, fb) - std::min(fa, fb));
  (firstIn ? s.b : s.a) = in + (out - in) * t;
  return true;
}

// To the space between near and far plane, and to the guard band.
bool clip(const ScreenMap& map, Segment& s) {
  if (!cut(-s.a.z - map.nearPlane, -s.b.z - map.nearPlane, s)) return false;
  if (!cut(map.farPlane + s.a.z, map.farPlane + s.b.z, s)) return false;
  const auto w = [&](const glm::dvec3& p) { return map.perspective ? -p.z : 1.0; };
  const double halfX = (0.5 * map.width + kGuardPixels - 1.0) * kSubpixels;
  const double halfY = (0.5 * map.height + kGuardPixels - 1.0) * kSubpixels;
  for (const double sign : {-1.0, 1.0}) {
    const auto x = [&](const glm::dvec3& p) { return w(p) * halfX + sign * p.x * map.scaleX; };
    if (!cut(x(s.a), x(s.b), s)) return false;
    const auto y = [&](const glm::dvec3& p) { return w(p) * halfY + sign * p.y * map.scaleY; };
    if (!cut(y(s.a), y(s.b), s)) return false;
  }
  return true;
}

ScreenLine projected(const Lines& lines, const Affine& toView, std::size_t i, const ScreenMap& map) {
  const glm::vec3 &p = lines.points[2 * i], &q = lines.points[2 * i + 1];
  const glm::vec3 a = toView(p.x, p.y, p.z), b = toView(q.x, q.y, q.z);
  Segment s{glm::dvec3(a), glm::dvec3(b)};
  ScreenLine line{};
  if (!isFinite(a) || !isFinite(b) || !clip(map, s)) return line;
  const std::array<glm::dvec3, 2> ends{s.a, s.b};
  for (std::size_t k = 0; k < 2; ++k) {
    glm::vec3 view(ends[k]);
    view.z = std::min(view.z, -map.nearPlane);
    const ScreenVertex v = map.project(view);
    line.x[k] = v.x, line.y[k] = v.y, line.depth[k] = v.depth;
  }
  line.width = lines.width;
  line.color = lines.colors[i];
  return line;
}

// How far from its axis a line is seen, in sub-pixels.
std::int32_t reach(const ScreenLine& line) {
  return static_cast<std::int32_t>((std::max(line.width, 1.0F) * 0.5F + 1.0F) * kSubpixels);
}

Box boxOf(const ScreenLine& line) {
  const std::int32_t r = reach(line);
  return {std::min(line.x[0], line.x[1]) - r, std::min(line.y[0], line.y[1]) - r,
          std::max(line.x[0], line.x[1]) + r, std::max(line.y[0], line.y[1]) + r};
}

// The nearest point of a line to a pixel's centre.
struct Nearest {
  std::int32_t x, y;
  float depth, distance;  ///< of the point; from the centre, in pixels
};

Nearest nearestPoint(const ScreenLine& line, std::int32_t px, std::int32_t py) {
  const auto dx = static_cast<float>(line.x[1] - line.x[0]), dy = static_cast<float>(line.y[1] - line.y[0]);
  const auto rx = static_cast<float>(px - line.x[0]), ry = static_cast<float>(py - line.y[0]);
  const float square = dx * dx + dy * dy;
  const float t = square > 0.0F ? std::clamp((rx * dx + ry * dy) / square, 0.0F, 1.0F) : 0.0F;
  const float x = t * dx, y = t * dy, ex = rx - x, ey = ry - y;
  return {line.x[0] + static_cast<std::int32_t>(x), line.y[0] + static_cast<std::int32_t>(y),
          line.depth[0] + (line.depth[1] - line.depth[0]) * t,
          std::sqrt(ex * ex + ey * ey) * (1.0F / kSubpixels)};
}

// Samples of a pixel whose triangle does not hide the line's point.
unsigned visibleSamples(const Tile& tile, const Nearest& point, int x, int y) {
  constexpr float kTolerance = 2e-4F;  // of the depth: what lies on a surface is seen
  unsigned visible = 0;
  for (unsigned s = 0; s < tile.context->samples.size(); ++s) {
    const std::uint32_t id = tile.ids[tile.offset(static_cast<int>(s), x, y)];
    const float surface = id == kNoRecord ? kNoDepth : tile.records[id].value(3, point.x, point.y);
    visible |= static_cast<unsigned>(point.depth + std::fabs(point.depth) * kTolerance >= surface) << s;
  }
  return visible;
}

void drawPixel(Tile& tile, const ScreenLine& line, int x, int y) {
  const std::int32_t px = (tile.left + x) * kSubpixels + kOneSample[0].x;
  const std::int32_t py = (tile.top + y) * kSubpixels + kOneSample[0].y;
  const Nearest point = nearestPoint(line, px, py);
  const float half = std::max(line.width, 1.0F) * 0.5F;
  const float coverage = std::clamp(half + 0.5F - point.distance, 0.0F, 1.0F) * std::min(line.width, 1.0F);
  if (coverage <= 0.0F) return;
  const unsigned visible = visibleSamples(tile, point, x, y);
  if (visible == 0) return;
  openPixel(tile, x, y);
  const glm::vec4 color{line.color.x, line.color.y, line.color.z,
                        std::clamp(line.color.w, 0.0F, 1.0F) * coverage};
  for (unsigned s = 0; visible >> s != 0; ++s)
    if (((visible >> s) & 1U) != 0) blendOver(tile.colors[tile.offset(static_cast<int>(s), x, y)], color);
}

}  // namespace

void LineBins::run(const Frame& frame, const ScreenMap& map, const Tiling& tiling, Workers& workers) {
  std::size_t count = 0;
  for (const Lines& lines : frame.lines) count += lines.colors.size();
  lines_.resize(count);
  if (count == 0) return;
  std::size_t first = 0;
  for (const Lines& lines : frame.lines) {
    const Affine toView(lines.modelToView);
    workers.forBlocks(lines.colors.size(), 1024, [&](std::size_t begin, std::size_t end, int) {
      for (std::size_t i = begin; i < end; ++i) lines_[first + i] = projected(lines, toView, i, map);
    });
    first += lines.colors.size();
  }
  bins_.reset(tiling);
  const auto forRange = [&](std::size_t r, const auto& body) {
    for (std::size_t i = count * r / kRanges; i < count * (r + 1) / kRanges; ++i)
      if (lines_[i].width > 0.0F) body(tilesOf(boxOf(lines_[i]), tiling), static_cast<std::uint32_t>(i));
  };
  workers.forBlocks(kRanges, 1, [&](std::size_t r, std::size_t, int) {
    forRange(r, [&](const TileRect& rect, std::uint32_t) { bins_.count(r, rect); });
  });
  bins_.allocate();
  workers.forBlocks(kRanges, 1, [&](std::size_t r, std::size_t, int) {
    forRange(r, [&](const TileRect& rect, std::uint32_t i) { bins_.place(r, rect, i); });
  });
}

void drawLines(Tile& tile) {
  for (const std::uint32_t item : tile.lines) {
    const ScreenLine& line = tile.context->lines.line(item);
    const Box box = boxOf(line);
    const int x0 = std::max((box.minX >> kSubpixelBits) - tile.left, 0);
    const int x1 = std::min((box.maxX >> kSubpixelBits) - tile.left + 1, tile.width);
    const int y0 = std::max((box.minY >> kSubpixelBits) - tile.top, 0);
    const int y1 = std::min((box.maxY >> kSubpixelBits) - tile.top + 1, tile.height);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) drawPixel(tile, line, x, y);
  }
}

}  // namespace limn::raster
