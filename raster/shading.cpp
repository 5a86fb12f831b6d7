// Shading of a tile: once per pixel and visible triangle, then the mean of the pixel's samples in linear
// light.
#include <algorithm>
#include <bit>
#include <limits>

#include "raster/encode.h"
#include "raster/lighting.h"
#include "raster/surface.h"
#include "raster/tile.h"

namespace limn::raster {
namespace {

class Shader {
 public:
  explicit Shader(Tile& tile)
      : tile_(tile), context_(*tile.context), samples_(static_cast<int>(context_.samples.size())) {}

  void pixel(int x, int y) {
    if (!tile_.isTouched(x, y)) return write(x, y, context_.frame.background);
    glm::vec4 sum(0.0F);
    unsigned left = (1U << samples_) - 1U;
    int empty = 0;
    const bool blended = tile_.overlaid && tile_.isBlended[tile_.pixelOffset(x, y)] != 0;
    for (int s = 0; s < samples_; ++s) {
      const std::size_t o = tile_.offset(s, x, y);
      if (tile_.ids[o] == kNoRecord) {
        ++empty;
        continue;
      }
      if (blended || ((left >> s) & 1U) == 0) continue;
      const unsigned mask = tile_.samplesOf(tile_.ids[o], x, y);
      left &= ~mask;
      sum += fragment(tile_.ids[o], mask, x, y) *
             (static_cast<float>(std::popcount(mask)) / static_cast<float>(samples_));
    }
    if (blended)
      writeBlended(x, y);
    else
      writePixel(x, y, sum, empty);
  }

  void planes(int x, int y) {
    int nearest = -1;
    for (int s = 0; s < samples_; ++s) {
      const std::size_t o = tile_.offset(s, x, y);
      if (tile_.ids[o] == kNoRecord) continue;
      if (nearest < 0 || tile_.depth[o] > tile_.depth[tile_.offset(nearest, x, y)]) nearest = s;
    }
    writePlanes(x, y, nearest);
  }

 private:
  // Colour times alpha, and alpha, of an opaque triangle.
  glm::vec4 fragment(std::uint32_t id, unsigned mask, int x, int y) {
    Record& record = tile_.records[id];
    return shadeAt(tile_, record, shadingPoint(tile_, tile_.cornersOf(record), mask, x, y));
  }

  // `sum` is the mean of colour · alpha over the samples but for the `empty` ones.
  void writePixel(int x, int y, glm::vec4 sum, int empty) {
    const glm::vec4 background = context_.frame.background;
    if (empty == samples_) return write(x, y, background);
    const float share = static_cast<float>(empty) / static_cast<float>(samples_);
    const float under = background.w * share;
    ++tile_.statistics.pixelsCovered;
    writePremultiplied(x, y,
                       {sum.x + background.x * under, sum.y + background.y * under,
                        sum.z + background.z * under, sum.w + under});
  }

  void writeBlended(int x, int y) {
    glm::vec4 sum(0.0F);
    for (int s = 0; s < samples_; ++s) sum += tile_.colors[tile_.offset(s, x, y)];
    ++tile_.statistics.pixelsCovered;
    writePremultiplied(x, y, sum * (1.0F / static_cast<float>(samples_)));
  }

  void writePremultiplied(int x, int y, const glm::vec4& c) {
    const float scale = c.w > 0.0F ? 1.0F / c.w : 0.0F;
    write(x, y, {c.x * scale, c.y * scale, c.z * scale, c.w});
  }

  void write(int x, int y, const glm::vec4& color) {
    const Encoding encoding = context_.frame.encoding;
    std::uint8_t* out = context_.target.rgba +
                        static_cast<std::size_t>(tile_.top + y) * context_.target.rgbaStride +
                        static_cast<std::size_t>(tile_.left + x) * 4;
    out[0] = encode(color.x, encoding);
    out[1] = encode(color.y, encoding);
    out[2] = encode(color.z, encoding);
    out[3] = toByte(color.w);
  }

  // Depth, normal and id of the nearest sample; -1: nothing was drawn.
  void writePlanes(int x, int y, int sample) {
    const Target& target = context_.target;
    const auto row = static_cast<std::size_t>(tile_.top + y),
               column = static_cast<std::size_t>(tile_.left + x);
    const std::size_t o = sample < 0 ? 0 : tile_.offset(sample, x, y);
    if (target.depth != nullptr)
      target.depth[row * target.depthStride + column] =
          sample < 0 ? std::numeric_limits<float>::infinity() : context_.map.viewDepth(tile_.depth[o]);
    if (target.ids != nullptr)
      target.ids[row * target.idStride + column] = sample < 0 ? kNoId : idOf(tile_.ids[o]);
    if (target.normals != nullptr)
      target.normals[row * target.normalStride + column] =
          sample < 0 ? glm::vec3(0.0F) : normalOf(tile_.ids[o], tile_.samplesOf(tile_.ids[o], x, y), x, y);
  }

  std::uint32_t idOf(std::uint32_t id) const {
    const TriangleRef ref = tile_.refOf(tile_.records[id]);
    const Batch& batch = context_.batches[ref.batch];
    return batch.draw->firstId + batch.source(batch.set->clusters[ref.cluster].firstTriangle + ref.triangle);
  }

  glm::vec3 normalOf(std::uint32_t id, unsigned mask, int x, int y) const {
    const Record& record = tile_.records[id];
    const SamplePosition at = shadingPoint(tile_, tile_.cornersOf(record), mask, x, y);
    const glm::vec3 n{record.value(0, at.x, at.y), record.value(1, at.x, at.y), record.value(2, at.x, at.y)};
    const float inverse = 1.0F / std::sqrt(std::max(dot(n, n), 1e-37F));
    return {n.x * inverse, n.y * inverse, n.z * inverse};
  }

  Tile& tile_;
  const FrameContext& context_;
  int samples_;
};

}  // namespace

void shadePixelScalar(Tile& tile, int x, int y) {
  Shader(tile).pixel(x, y);
}

void writePlanes(Tile& tile) {
  const Target& target = tile.context->target;
  if (target.depth == nullptr && target.normals == nullptr && target.ids == nullptr) return;
  Shader shader(tile);
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x) shader.planes(x, y);
}

void shadeTile(Tile& tile) {
  Shader shader(tile);
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x) shader.pixel(x, y);
}

}  // namespace limn::raster
