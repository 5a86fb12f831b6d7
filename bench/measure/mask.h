// Binary pictures, 16 × 16 samples per pixel, 64 samples per word, and an exact rasterizer of projected
// triangles into them. Independent of the rasterizer that it helps to measure: it shares no code with
// raster/.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "apps/scene/camera.h"
#include "bench/measure/surface.h"

namespace limn::measure {

inline constexpr int kSamplesPerPixel = 16;  ///< in each direction: the edge of a mask is good to 1/32 pixel

/// A triangle in the window; units of 1/256 sample, row 0 on top. |coordinate| <= 2^24.
struct SampleTriangle {
  std::array<std::int32_t, 3> x, y;
};

class Mask {
 public:
  /// All samples of a window of width × height pixels, each at most 2048, are clear.
  Mask(int width, int height);

  int columns() const { return columns_; }  ///< samples per row
  int rows() const { return rows_; }
  std::span<const std::uint64_t> row(int y) const { return {bits_.data() + std::size_t(y) * words_, words_}; }
  /// False outside the window.
  bool at(int x, int y) const {
    if (x < 0 || y < 0 || x >= columns_ || y >= rows_) return false;
    return (bits_[std::size_t(y) * words_ + std::size_t(x) / 64] >> (x % 64) & 1) != 0;
  }
  /// Rows outside [firstRow, endRow) are clear.
  int firstRow() const { return firstRow_; }
  int endRow() const { return endRow_; }

  void clear();
  /// Sets the samples whose centres lie inside a triangle, either way round, by the top-left rule.
  void draw(std::span<const SampleTriangle> triangles);
  /// Area in square pixels.
  double area() const;

 private:
  void draw(const SampleTriangle& triangle, int rowBegin, int rowEnd);
  void fill(int y, std::int64_t begin, std::int64_t end);

  int columns_, rows_;
  std::size_t words_;
  int firstRow_, endRow_ = 0;
  std::vector<std::uint64_t> bits_;
};

/// Area of the symmetric difference of two masks of the same size, in square pixels.
double differenceArea(const Mask& a, const Mask& b);

/// Projects a surface, clipped at the near plane and far outside the window. Front and back faces alike.
void project(const Surface& surface, const scene::CameraView& camera, std::vector<SampleTriangle>& triangles);

}  // namespace limn::measure
