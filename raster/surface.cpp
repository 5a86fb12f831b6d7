// Based on: M. Mikkelsen, "Simulation of wrinkled surfaces revisited", 2008 (tangent frames) and glTF 2.0, section 3.9.
// Differs in: where a mesh has no tangents, a triangle's tangent is the direction in which u grows on it.
#include "raster/surface.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "raster/lighting.h"
#include "raster/texel.h"

namespace limn::raster {
namespace {

// Attributes of a record at a point, perspective-correct.
class Interpolator {
 public:
  Interpolator(const Attributes& attributes, const Record& record, SamplePosition at, float w,
               bool perspective)
      : a_(attributes),
        record_(record),
        dx_(static_cast<float>(at.x - record.x0)),
        dy_(static_cast<float>(at.y - record.y0)),
        w_(w),
        perspective_(perspective) {}

  float operator()(int i) const { return ((a_.origin[i] + a_.slopeY[i] * dy_) + a_.slopeX[i] * dx_) * w_; }

  // Quotient rule: u = (u/w) / (1/w), and both are planes.
  Footprint footprint() const {
    const float qx = perspective_ ? record_.slopeX[3] : 0.0F, qy = perspective_ ? record_.slopeY[3] : 0.0F;
    const float u = (*this)(Attributes::kU), v = (*this)(Attributes::kV), scale = w_ * kSubpixels;
    return {u,
            v,
            (a_.slopeX[Attributes::kU] - u * qx) * scale,
            (a_.slopeX[Attributes::kV] - v * qx) * scale,
            (a_.slopeY[Attributes::kU] - u * qy) * scale,
            (a_.slopeY[Attributes::kV] - v * qy) * scale};
  }

 private:
  const Attributes& a_;
  const Record& record_;
  float dx_, dy_, w_;
  bool perspective_;
};

Interpolator interpolator(Tile& tile, Record& record, SamplePosition at) {
  const bool perspective = tile.context->map.perspective;
  const float w = perspective ? 1.0F / record.value(3, at.x, at.y) : 1.0F;
  return {attributesOf(tile, record), record, at, w, perspective};
}

glm::vec3 scaled(const glm::vec3& v, float s) {
  return {v.x * s, v.y * s, v.z * s};
}

glm::vec3 unit(const glm::vec3& v) {
  return scaled(v, 1.0F / std::sqrt(std::max(dot(v, v), 1e-37F)));
}

glm::vec3 cross(const glm::vec3& a, const glm::vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The normal that a normal map gives, of `normal` as the record has it.
glm::vec3 mappedNormal(const glm::vec3& normal, const Interpolator& value, const Attributes& a,
                       const Material& m) {
  const glm::vec3 n = scaled(unit(normal), a.isBackFace ? -1.0F : 1.0F);
  const glm::vec3 raw{value(Attributes::kTangentX), value(Attributes::kTangentY),
                      value(Attributes::kTangentZ)};
  const float along = dot(n, raw);
  const glm::vec3 flat{raw.x - n.x * along, raw.y - n.y * along, raw.z - n.z * along};
  if (!(dot(flat, flat) > 1e-12F * dot(raw, raw))) return normal;
  const glm::vec3 t = unit(flat), b = scaled(cross(n, t), a.handedness);
  const glm::vec4 texel = sample(m.normalTexture->data(), value.footprint());
  const float x = (texel.x * 2.0F - 1.0F) * m.normalScale, y = (texel.y * 2.0F - 1.0F) * m.normalScale;
  const float z = texel.z * 2.0F - 1.0F, sign = a.isBackFace ? -1.0F : 1.0F;
  return {((t.x * x + b.x * y) + n.x * z) * sign, ((t.y * x + b.y * y) + n.y * z) * sign,
          ((t.z * x + b.z * y) + n.z * z) * sign};
}

}  // namespace

glm::vec4 baseColorAt(Tile& tile, Record& record, const Surface& surface, SamplePosition at) {
  const Material& m = *surface.material;
  glm::vec4 base = m.baseColor;
  if (!surface.hasColors && m.baseColorTexture == nullptr) return base;
  const Interpolator value = interpolator(tile, record, at);
  if (surface.hasColors)
    base = {base.x * value(Attributes::kRed), base.y * value(Attributes::kGreen),
            base.z * value(Attributes::kBlue), base.w * value(Attributes::kAlpha)};
  if (m.baseColorTexture != nullptr) {
    const glm::vec4 texel = sample(m.baseColorTexture->data(), value.footprint());
    base = {base.x * texel.x, base.y * texel.y, base.z * texel.z, base.w * texel.w};
  }
  return base;
}

PointAttributes attributesAt(Tile& tile, Record& record, SamplePosition at) {
  const Interpolator value = interpolator(tile, record, at);
  return {{value(Attributes::kRed), value(Attributes::kGreen), value(Attributes::kBlue),
           value(Attributes::kAlpha)},
          value.footprint()};
}

glm::vec4 shadeAt(Tile& tile, Record& record, SamplePosition at) {
  const FrameContext& context = *tile.context;
  const ScreenMap& map = context.map;
  const Surface surface = tile.surfaceOf(record);
  const Material& m = *surface.material;
  ++tile.statistics.pixelsShaded;
  const glm::vec4 base = baseColorAt(tile, record, surface, at);
  const float alpha = m.alphaMode == AlphaMode::kBlend ? std::clamp(base.w, 0.0F, 1.0F) : 1.0F;
  if (m.unlit) return {base.x, base.y, base.z, alpha};

  SurfacePoint p;
  p.normal = {record.value(0, at.x, at.y), record.value(1, at.x, at.y), record.value(2, at.x, at.y)};
  if (m.normalTexture != nullptr) {
    const Interpolator value = interpolator(tile, record, at);
    p.normal = mappedNormal(p.normal, value, attributesOf(tile, record), m);
  }
  glm::vec3 emissive = m.emissive;
  if (m.emissiveTexture != nullptr) {
    const glm::vec4 texel = sample(m.emissiveTexture->data(), interpolator(tile, record, at).footprint());
    emissive = {emissive.x * texel.x, emissive.y * texel.y, emissive.z * texel.z};
  }
  const glm::vec3 ray = rayAt(map, at.x, at.y);
  setEye(map, ray, p);
  const float depth = map.viewDepth(record.value(3, at.x, at.y));
  p.position =
      map.perspective ? glm::vec3{ray.x * depth, ray.y * depth, -depth} : glm::vec3{ray.x, ray.y, -depth};
  const glm::vec3 color = litColor(p, glm::vec3(base), emissive, m, context.frame.lights);
  return {color.x, color.y, color.z, alpha};
}

SamplePosition shadingPoint(const Tile& tile, const Corners& corners, unsigned mask, int x, int y) {
  const std::int32_t px = (tile.left + x) * kSubpixels, py = (tile.top + y) * kSubpixels;
  const std::span<const SamplePosition> samples = tile.context->samples;
  SamplePosition at = kOneSample[0];
  if (mask != (1U << samples.size()) - 1U && !covers(corners, px + at.x, py + at.y))
    at = samples[static_cast<std::size_t>(std::countr_zero(mask))];
  return {px + at.x, py + at.y};
}

}  // namespace limn::raster
