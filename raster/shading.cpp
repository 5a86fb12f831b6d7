// Shading of a tile: once per pixel and visible triangle, then the mean of the pixel's samples in linear
// light.
#include <algorithm>
#include <bit>
#include <limits>

#include "raster/encode.h"
#include "raster/lighting.h"
#include "raster/tile.h"

namespace limn::raster {
namespace {

class Shader {
 public:
  explicit Shader(Tile& tile)
      : tile_(tile), context_(*tile.context), samples_(static_cast<int>(context_.samples.size())) {}

  void pixel(int x, int y) {
    glm::vec4 sum(0.0F);
    unsigned left = (1U << samples_) - 1U;
    int nearest = -1;
    float nearestDepth = context_.map.farDepth;
    int empty = 0;
    for (int s = 0; s < samples_; ++s) {
      const std::size_t o = tile_.offset(s, x, y);
      if (tile_.ids[o] == kNoRecord) {
        ++empty;
        continue;
      }
      if (nearest < 0 || tile_.depth[o] > nearestDepth) nearest = s, nearestDepth = tile_.depth[o];
      if (((left >> s) & 1U) == 0) continue;
      const unsigned mask = samplesOf(tile_.ids[o], x, y);
      left &= ~mask;
      sum += fragment(tile_.ids[o], mask, x, y) *
             (static_cast<float>(std::popcount(mask)) / static_cast<float>(samples_));
    }
    writePixel(x, y, sum, empty);
    writePlanes(x, y, nearest);
  }

 private:
  unsigned samplesOf(std::uint32_t id, int x, int y) const {
    unsigned mask = 0;
    for (int s = 0; s < samples_; ++s)
      mask |= static_cast<unsigned>(tile_.ids[tile_.offset(s, x, y)] == id) << s;
    return mask;
  }

  // Where a pixel's triangle is shaded: at the centre if it is covered, else at the first sample that is.
  SamplePosition shadingPoint(const Record& record, unsigned mask, int x, int y) const {
    const std::int32_t px = (tile_.left + x) * kSubpixels, py = (tile_.top + y) * kSubpixels;
    SamplePosition at = kOneSample[0];
    if (mask != (1U << samples_) - 1U) {
      std::array<int, 3> order;
      if (!covers(tile_.cornersOf(record, order), px + at.x, py + at.y))
        at = context_.samples[static_cast<std::size_t>(std::countr_zero(mask))];
    }
    return {px + at.x, py + at.y};
  }

  // Colour times alpha, and alpha.
  glm::vec4 fragment(std::uint32_t id, unsigned mask, int x, int y) {
    Record& record = tile_.records[id];
    const SamplePosition at = shadingPoint(record, mask, x, y);
    const TriangleRef ref = tile_.refOf(record);
    const Batch& batch = context_.batches[ref.batch];
    const Material& m = context_.frame.materials[batch.set->clusters[ref.cluster].material];
    const ScreenMap& map = context_.map;

    const float depth = record.value(3, at.x, at.y), w = map.perspective ? 1.0F / depth : 1.0F;
    glm::vec3 base(m.baseColor);
    if (hasColors(*batch.draw)) {
      const Attributes& a = attributesOf(tile_, record);
      const auto value = [&](int i) {
        return ((a.origin[i] + a.slopeY[i] * static_cast<float>(at.y - record.y0)) +
                a.slopeX[i] * static_cast<float>(at.x - record.x0)) *
               w;
      };
      base = {base.x * value(Attributes::kRed), base.y * value(Attributes::kGreen),
              base.z * value(Attributes::kBlue)};
    }
    ++tile_.statistics.pixelsShaded;
    if (m.unlit) return {base, 1.0F};
    SurfacePoint p;
    p.normal = {record.value(0, at.x, at.y), record.value(1, at.x, at.y), record.value(2, at.x, at.y)};
    const glm::vec3 ray = rayAt(map, at.x, at.y);
    p.toEye = toEye(map, ray);
    p.position = map.perspective ? glm::vec3{ray.x * w, ray.y * w, -w}
                                 : glm::vec3{ray.x, ray.y, -map.viewDepth(depth)};
    return {litColor(p, base, m.emissive, m, context_.frame.lights), 1.0F};
  }

  static bool hasColors(const Draw& draw) {
    return !draw.geometry->data().colors.empty() || !draw.stream.vertices.colors.empty();
  }

  // `sum` is the mean of colour · alpha over the samples but for the `empty` ones.
  void writePixel(int x, int y, glm::vec4 sum, int empty) {
    const Encoding encoding = context_.frame.encoding;
    const glm::vec4 background = context_.frame.background;
    glm::vec4 color = background;
    if (empty < samples_) {
      ++tile_.statistics.pixelsCovered;
      const float share = static_cast<float>(empty) / static_cast<float>(samples_);
      const float alpha = sum.w + background.w * share;
      const float scale = alpha > 0.0F ? 1.0F / alpha : 0.0F, under = background.w * share;
      color = {(sum.x + background.x * under) * scale, (sum.y + background.y * under) * scale,
               (sum.z + background.z * under) * scale, alpha};
    }
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
          sample < 0 ? glm::vec3(0.0F) : normalOf(tile_.ids[o], samplesOf(tile_.ids[o], x, y), x, y);
  }

  std::uint32_t idOf(std::uint32_t id) const {
    const TriangleRef ref = tile_.refOf(tile_.records[id]);
    const Batch& batch = context_.batches[ref.batch];
    return batch.draw->firstId + batch.source(batch.set->clusters[ref.cluster].firstTriangle + ref.triangle);
  }

  glm::vec3 normalOf(std::uint32_t id, unsigned mask, int x, int y) const {
    const Record& record = tile_.records[id];
    const SamplePosition at = shadingPoint(record, mask, x, y);
    const glm::vec3 n{record.value(0, at.x, at.y), record.value(1, at.x, at.y), record.value(2, at.x, at.y)};
    const float inverse = 1.0F / std::sqrt(std::max(dot(n, n), 1e-37F));
    return {n.x * inverse, n.y * inverse, n.z * inverse};
  }

  Tile& tile_;
  const FrameContext& context_;
  int samples_;
};

}  // namespace

void shadeTile(Tile& tile) {
  Shader shader(tile);
  for (int y = 0; y < tile.height; ++y)
    for (int x = 0; x < tile.width; ++x) shader.pixel(x, y);
}

}  // namespace limn::raster
