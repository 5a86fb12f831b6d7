// Line segments: projected, cut to the window and put into tiles before tiles are drawn.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "raster/front_end.h"

namespace limn::raster {

/// A segment on the sub-pixel grid. Depths are linear along it, as 1/w is.
struct ScreenLine {
  std::int32_t x[2], y[2];
  float depth[2];
  float width;  ///< pixels
  glm::vec4 color;
};

class LineBins {
 public:
  void run(const Frame& frame, const ScreenMap& map, const Tiling& tiling, Workers& workers);
  std::span<const std::uint32_t> of(std::size_t tile) const {
    return lines_.empty() ? std::span<const std::uint32_t>() : bins_.of(tile);
  }
  const ScreenLine& line(std::uint32_t item) const { return lines_[item]; }
  std::size_t memoryBytes() const { return lines_.capacity() * sizeof(ScreenLine) + bins_.memoryBytes(); }

 private:
  std::vector<ScreenLine> lines_;  // width 0: cut away
  Bins bins_;
};

}  // namespace limn::raster
