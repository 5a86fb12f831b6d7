// Shading of a tile, a vector of pixels at a time. Definition: shading.cpp, surface.cpp and lighting.h.
//
// Pixels that a vector cannot handle as one (edges between samples, blended pixels, normal maps) are left to the
// definition itself.
#include <bit>

#include "raster/encode.h"
#include "raster/lighting.h"
#include "raster/surface.h"
#include "raster/texel.h"
#include "raster/vector_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/shading_vector.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "raster/fragments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
void shadeTileVector(Tile& tile) {
  shadeTile(tile);
}
#else

class Shading {
 public:
  explicit Shading(Tile& tile)
      : tile_(tile),
        context_(*tile.context),
        lighting_(context_.map, context_.frame.lights),
        background_(packed(context_.frame.background)),
        fragments_(tile, lighting_) {}

  void run() {
    for (int y = 0; y < tile_.height; ++y)
      for (int x = 0; x < tile_.width; x += static_cast<int>(kLanes)) block(x, y);
    fragments_.finish();
  }

 private:
  std::int32_t packed(const glm::vec4& c) const {
    const Encoding e = context_.frame.encoding;
    return static_cast<std::int32_t>(encode(c.x, e) | static_cast<unsigned>(encode(c.y, e)) << 8U |
                                     static_cast<unsigned>(encode(c.z, e)) << 16U |
                                     static_cast<unsigned>(toByte(c.w)) << 24U);
  }

  HWY_INLINE VI idsAt(std::size_t sample, int x, int y) const {
    const std::size_t o = tile_.offset(static_cast<int>(sample), x, y);
    return hn::LoadU(I(), reinterpret_cast<const std::int32_t*>(&tile_.ids[o]));
  }

  HWY_INLINE void block(int x, int y) {
    const I d;
    const VI ids = idsAt(0, x, y);
    const MI inside = hn::FirstN(d, static_cast<std::size_t>(tile_.width - x));
    MI whole = inside;  // pixels all of whose samples show the same
    for (std::size_t s = 1; s < context_.samples.size(); ++s)
      whole = hn::And(whole, hn::Eq(ids, idsAt(s, x, y)));
    if (tile_.overlaid) whole = hn::And(whole, notBlended(x, y));
    const MI seen = hn::And(whole, hn::Ne(ids, hn::Set(d, -1)));
    MI done = whole;
    VI color = hn::Set(d, background_);
    if (!hn::AllFalse(d, seen)) {
      MI complex = hn::FirstN(d, 0);
      color = hn::IfThenElse(seen, colors(x, y, ids, seen, complex), color);
      done = hn::AndNot(complex, done);
      const std::size_t count = hn::CountTrue(d, hn::And(done, seen));
      tile_.statistics.pixelsShaded += count;
      tile_.statistics.pixelsCovered += count;
    }
    store(color, x, y);
    for (unsigned left = bitsOf(hn::AndNot(done, inside)); left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const bool blended = tile_.overlaid && tile_.isBlended[tile_.offset(0, x + lane, y)] != 0;
      if (blended || tile_.context->samples.size() == 1 || !fragments_.add(x + lane, y))
        shadePixelScalar(tile_, x + lane, y);
    }
  }

  MI notBlended(int x, int y) const {
    const I d;
    alignas(64) std::int32_t free[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i)
      free[i] = tile_.isBlended[tile_.offset(0, x, y) + i] == 0 ? 1 : 0;
    return hn::Ne(hn::Load(d, free), hn::Zero(d));
  }

  void store(VI color, int x, int y) const {
    const std::size_t row = static_cast<std::size_t>(tile_.top + y) * context_.target.rgbaStride;
    std::uint8_t* to = context_.target.rgba + row + static_cast<std::size_t>(tile_.left + x) * 4;
    const hn::Repartition<std::uint8_t, I> d8;
    if (x + static_cast<int>(kLanes) <= tile_.width) {
      hn::StoreU(hn::BitCast(d8, color), d8, to);
      return;
    }
    alignas(64) std::uint8_t bytes[4 * kLanes];
    hn::Store(hn::BitCast(d8, color), d8, bytes);
    std::copy(bytes, bytes + static_cast<std::ptrdiff_t>(4 * (tile_.width - x)), to);
  }

  // Colours of the pixels in `seen`, encoded; those left to the scalar code are added to `complex`.
  HWY_INLINE VI colors(int x, int y, VI ids, MI seen, MI& complex) {
    const I d;
    const F f;
    Inputs in;
    const VI left = hn::Set(d, (tile_.left + x) * kSubpixels + kOneSample[0].x);
    in.points.px = hn::Add(left, hn::ShiftLeft<kSubpixelBits>(hn::Iota(d, 0)));
    const std::int32_t py = (tile_.top + y) * kSubpixels + kOneSample[0].y;
    in.points.py = hn::Set(d, py);
    in.points.nx = in.points.ny = in.points.nz = hn::Zero(f);
    in.points.depth = in.color.r = in.color.g = in.color.b = hn::Set(f, 1.0F);
    in.footprint = {hn::Zero(f), hn::Zero(f), hn::Zero(f), hn::Zero(f), hn::Zero(f), hn::Zero(f)};
    const std::uint32_t* row = &tile_.ids[tile_.offset(0, x, y)];
    if (tile_.plainMaterial != nullptr) {
      forTriangles(row, ids, seen,
                   [&](Record& record, MI same) { interpolate(in, record, py, hn::RebindMask(f, same)); });
      return packedOf(shadePoints(in, *tile_.plainMaterial, lighting_), hn::Set(d, 255),
                      context_.frame.encoding);
    }
    // Usually all triangles of the block have one material; else one material is shaded after the other.
    VI result = hn::Zero(d);
    for (MI todo = seen; !hn::AllFalse(d, todo);) {
      const Material* material = nullptr;
      MI mine = hn::FirstN(d, 0);
      forTriangles(row, ids, todo, [&](Record& record, MI same) {
        const Surface surface = tile_.surfaceOf(record);
        if (material == nullptr) material = surface.material;
        if (surface.material != material) return;
        mine = hn::Or(mine, same);
        if (isComplex(*material)) return;
        interpolate(in, record, py, hn::RebindMask(f, same));
        if (material->baseColorTexture != nullptr || surface.hasColors)
          interpolateAttributes(in, record, surface, py, hn::RebindMask(f, same));
        else
          in.color = {hn::Set(f, 1.0F), hn::Set(f, 1.0F), hn::Set(f, 1.0F)};
      });
      todo = hn::AndNot(mine, todo);
      if (isComplex(*material)) {
        complex = hn::Or(complex, mine);
        continue;
      }
      const Color color = shadePoints(in, *material, lighting_);
      result = hn::IfThenElse(mine, packedOf(color, hn::Set(d, 255), context_.frame.encoding), result);
    }
    return result;
  }

  // Calls body(record, lanes) for every triangle that is seen in some lanes of a block.
  template <class Body>
  HWY_INLINE void forTriangles(const std::uint32_t* row, VI ids, MI seen, const Body& body) {
    const I d;
    while (!hn::AllFalse(d, seen)) {
      const std::uint32_t id = row[static_cast<std::size_t>(hn::FindFirstTrue(d, seen))];
      const MI same = hn::And(hn::Eq(ids, hn::Set(d, static_cast<std::int32_t>(id))), seen);
      seen = hn::AndNot(same, seen);
      body(tile_.records[id], same);
    }
  }

  // Values of one triangle's planes, where it is seen.
  HWY_INLINE void interpolate(Inputs& b, const Record& record, std::int32_t py, MF where) {
    const I d;
    const F f;
    const VF dx = hn::ConvertTo(f, hn::Sub(b.points.px, hn::Set(d, record.x0)));
    const VF dy = hn::Set(f, static_cast<float>(py - record.y0));
    const auto value = [&](int i, VF otherwise) {
      const VF start = hn::Add(hn::Set(f, record.origin[i]), hn::Mul(hn::Set(f, record.slopeY[i]), dy));
      return hn::IfThenElse(where, hn::Add(start, hn::Mul(hn::Set(f, record.slopeX[i]), dx)), otherwise);
    };
    b.points.nx = value(0, b.points.nx);
    b.points.ny = value(1, b.points.ny);
    b.points.nz = value(2, b.points.nz);
    if (lighting_.needsDepth()) b.points.depth = value(3, b.points.depth);
  }

  // The same of texture coordinates and vertex colours, perspective-correct: Interpolator of surface.cpp.
  HWY_INLINE void interpolateAttributes(Inputs& b, Record& record, const Surface& surface, std::int32_t py,
                                        MF where) {
    const I d;
    const F f;
    const bool perspective = context_.map.perspective,
               textured = surface.material->baseColorTexture != nullptr;
    const VF dx = hn::ConvertTo(f, hn::Sub(b.points.px, hn::Set(d, record.x0)));
    const float rise = static_cast<float>(py - record.y0);
    const auto plane = [&](float origin, float slopeX, float slopeY) {
      return hn::Add(hn::Set(f, origin + slopeY * rise), hn::Mul(hn::Set(f, slopeX), dx));
    };
    const VF one = hn::Set(f, 1.0F);
    const VF w =
        perspective ? hn::Div(one, plane(record.origin[3], record.slopeX[3], record.slopeY[3])) : one;
    const Attributes& a = attributesOf(tile_, record);
    const auto value = [&](int i) { return hn::Mul(plane(a.origin[i], a.slopeX[i], a.slopeY[i]), w); };
    const auto put = [&](VF& to, VF v) { to = hn::IfThenElse(where, v, to); };
    put(b.color.r, surface.hasColors ? value(Attributes::kRed) : one);
    put(b.color.g, surface.hasColors ? value(Attributes::kGreen) : one);
    put(b.color.b, surface.hasColors ? value(Attributes::kBlue) : one);
    if (!textured) return;
    const float qx = perspective ? record.slopeX[3] : 0.0F, qy = perspective ? record.slopeY[3] : 0.0F;
    const VF u = value(Attributes::kU), v = value(Attributes::kV);
    const VF scale = hn::Mul(w, hn::Set(f, static_cast<float>(kSubpixels)));
    const auto change = [&](float slope, VF at, float q) {
      return hn::Mul(hn::Sub(hn::Set(f, slope), hn::Mul(at, hn::Set(f, q))), scale);
    };
    put(b.footprint.u, u), put(b.footprint.v, v);
    put(b.footprint.ux, change(a.slopeX[Attributes::kU], u, qx));
    put(b.footprint.vx, change(a.slopeX[Attributes::kV], v, qx));
    put(b.footprint.uy, change(a.slopeY[Attributes::kU], u, qy));
    put(b.footprint.vy, change(a.slopeY[Attributes::kV], v, qy));
  }

  Tile& tile_;
  const FrameContext& context_;
  Lighting lighting_;
  std::int32_t background_;
  Fragments fragments_;
};

void shadeTileVector(Tile& tile) {
  Shading(tile).run();
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace limn::raster {
HWY_EXPORT(shadeTileVector);
namespace {
void shade(Tile& tile) {
  HWY_DYNAMIC_DISPATCH(shadeTileVector)(tile);
}
}  // namespace
void setShadingKernel(Kernels& kernels) {
  kernels.shadeTile = shade;
}
}  // namespace limn::raster
#endif
