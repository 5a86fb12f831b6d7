// Pixels whose samples show different things: their parts are gathered, shaded a vector at a time and summed up.
// Definition: Shader::pixel in shading.cpp.
#if defined(LIMN_RASTER_FRAGMENTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_FRAGMENTS_INL_H_
#undef LIMN_RASTER_FRAGMENTS_INL_H_
#else
#define LIMN_RASTER_FRAGMENTS_INL_H_
#endif

#include <bit>

#include "raster/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
class Fragments {
 public:
  Fragments(Tile& tile, const Lighting& lighting)
      : tile_(tile), context_(*tile.context), lighting_(lighting), samples_(context_.samples.size()) {
    for (std::size_t n = 0; n <= samples_; ++n)
      weights_[n] = static_cast<float>(n) / static_cast<float>(samples_);
  }

  /// Adds pixels of the vector at (x, y) of the tile, none of which has a complex material, with the records that their
  /// samples show. `to` is the vector's place in the target.
  template <std::size_t kSamples>
  HWY_INLINE void add(int x, int y, MI pixels, const VI (&ids)[kSamples], std::uint8_t* to) {
    const I d;
    const F f;
    if (blocks_ == kBlocks) finish();
    const std::size_t slot = blocks_ * kLanes;
    blockOf_[blocks_++] = {to, pixels};
    for (auto& sum : sum_) hn::Store(hn::Zero(f), f, sum + slot);
    const VI ramp = hn::Iota(d, 0), none = hn::Set(d, -1);
    hn::Store(hn::Add(hn::Set(d, (tile_.left + x) * kSubpixels), hn::ShiftLeft<kSubpixelBits>(ramp)), d,
              pixelX_ + slot);
    hn::Store(hn::Set(d, (tile_.top + y) * kSubpixels), d, pixelY_ + slot);
    const auto placeOf = [&](std::size_t s) HWY_ATTR {
      return hn::Add(ramp, hn::Set(d, static_cast<std::int32_t>(slot | s << kSampleShift)));
    };
    VI empty = hn::Zero(d);
    forEach(std::make_index_sequence<kSamples>(), [&](auto s) HWY_ATTR {
      constexpr std::size_t kSample = s;
      // The pixels whose first sample of a triangle this is, and how many samples show it.
      const MI free = hn::Eq(ids[s], none);
      empty = hn::Sub(empty, hn::VecFromMask(d, free));
      MI first = hn::AndNot(free, pixels);
      VI count = hn::Set(d, 1);
      forEach(std::make_index_sequence<kSamples>(), [&](auto t) HWY_ATTR {
        if constexpr (t < kSample)
          first = hn::AndNot(hn::Eq(ids[t], ids[s]), first);
        else if constexpr (t > kSample)
          count = hn::Sub(count, hn::VecFromMask(d, hn::Eq(ids[t], ids[s])));
      });
      if (!hn::AllFalse(d, first))
        push(ids[s], hn::Add(placeOf(s), hn::ShiftLeft<kCountShift>(count)), first);
    });
    hn::Store(hn::ConvertTo(f, empty), f, empty_ + slot);
    tile_.statistics.pixelsCovered += hn::CountTrue(d, pixels);
  }

  /// Shades what is left and writes all pixels that were added.
  void finish() {
    flush();
    tile_.clock.lap(tile_.statistics.shadingMs);
    for (std::size_t i = 0; i < blocks_; ++i) write(i);
    tile_.clock.lap(tile_.statistics.resolveMs);
    blocks_ = 0;
  }

 private:
  static constexpr std::size_t kBlocks = 16, kSlots = kBlocks * kLanes, kSize = PointBatch::kSize;
  // A fragment's tag: its pixel's slot, its first sample, and how many samples show its triangle.
  static constexpr int kSampleShift = 16, kCountShift = 20;

  HWY_INLINE void push(VI ids, VI tags, MI which) {
    const I d;
    const std::size_t count = hn::CountTrue(d, which);
    if (count_ + count > kSize) flush();
    if (tile_.plainMaterial != nullptr) {
      hn::StoreU(hn::Compress(ids, which), d, id_ + count_);
      hn::StoreU(hn::Compress(tags, which), d, tag_ + count_);
      material_ = tile_.plainMaterial;
      count_ += count;
      return;
    }
    // One batch, one material.
    alignas(64) std::int32_t id[kLanes], tag[kLanes];
    hn::Store(hn::Compress(ids, which), d, id);
    hn::Store(hn::Compress(tags, which), d, tag);
    for (std::size_t i = 0; i < count; ++i) {
      const Material* material = tile_.surfaceOf(tile_.records[static_cast<std::size_t>(id[i])]).material;
      if (material != material_) flush();
      material_ = material;
      id_[count_] = id[i], tag_[count_] = tag[i];
      ++count_;
    }
  }

  void flush() {
    if (count_ == 0) return;
    const std::size_t padded = (count_ + kLanes - 1) / kLanes * kLanes;
    for (std::size_t i = count_; i < padded; ++i) id_[i] = id_[0], tag_[i] = tag_[0];
    for (std::size_t i = 0; i < padded; i += kLanes) interpolate(i);
    points_.count = padded;
    setBase();
    shadePoints(points_, *material_, lighting_);
    for (std::size_t i = 0; i < count_; ++i) {
      const auto slot = static_cast<std::size_t>(tag_[i] & ((1 << kSampleShift) - 1));
      const float weight = weights_[tag_[i] >> kCountShift];
      for (int k = 0; k < 3; ++k) sum_[k][slot] += points_.color[k][i] * weight;
    }
    tile_.statistics.pixelsShaded += count_;
    count_ = 0;
  }

  // Fragments [i, i + kLanes): where they are shaded, and their planes there.
  HWY_INLINE void interpolate(std::size_t i) {
    const I d;
    const F f;
    const F4 f4;
    alignas(64) std::int32_t cornerX[3][kLanes], cornerY[3][kLanes], x[kLanes], y[kLanes], sampleX[kLanes],
        sampleY[kLanes];
    for (std::size_t k = 0; k < kLanes; ++k) {
      const auto tag = static_cast<std::uint32_t>(tag_[i + k]);
      const std::uint32_t slot = tag & ((1U << kSampleShift) - 1U);
      const SamplePosition sample = context_.samples[(tag >> kSampleShift) & (kMaxSamples - 1)];
      x[k] = pixelX_[slot], y[k] = pixelY_[slot];
      sampleX[k] = sample.x, sampleY[k] = sample.y;
      const Corners& c = tile_.corners[static_cast<std::size_t>(id_[i + k])];
      for (int n = 0; n < 3; ++n) cornerX[n][k] = c.x[n], cornerY[n][k] = c.y[n];
    }
    const VI px = hn::Load(d, x), py = hn::Load(d, y);
    const MI central = coversCenters(cornerX, cornerY, px, py, i);
    const VI center = hn::Set(d, kOneSample[0].x);
    const VI atX = hn::Add(px, hn::IfThenElse(central, center, hn::Load(d, sampleX)));
    const VI atY = hn::Add(py, hn::IfThenElse(central, center, hn::Load(d, sampleY)));
    hn::Store(atX, d, x), hn::Store(atY, d, y);
    hn::Store(atX, d, atX_ + i), hn::Store(atY, d, atY_ + i);
    alignas(64) float planes[kLanes][4];
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Record& r = tile_.records[static_cast<std::size_t>(id_[i + k])];
      const auto dx = hn::Set(f4, static_cast<float>(x[k] - r.x0)),
                 dy = hn::Set(f4, static_cast<float>(y[k] - r.y0));
      const auto start = hn::Add(hn::Load(f4, r.origin), hn::Mul(hn::Load(f4, r.slopeY), dy));
      hn::Store(hn::Add(start, hn::Mul(hn::Load(f4, r.slopeX), dx)), f4, planes[k]);
    }
    VF nx, ny, nz, depth;
    hn::LoadInterleaved4(f, planes[0], nx, ny, nz, depth);
    hn::Store(nx, f, points_.normal[0] + i);
    hn::Store(ny, f, points_.normal[1] + i);
    hn::Store(nz, f, points_.normal[2] + i);
    hn::Store(depth, f, points_.depth + i);
    hn::Store(lighting_.rayX(atX), f, points_.rayX + i);
    hn::Store(lighting_.rayY(atY), f, points_.rayY + i);
  }

  // shadingPoint(): whether triangles cover the centres of the pixels at (px, py).
  HWY_INLINE MI coversCenters(const std::int32_t (&cornerX)[3][kLanes],
                              const std::int32_t (&cornerY)[3][kLanes], VI px, VI py, std::size_t i) const {
    const I d;
    VI x[3], y[3];
    for (int k = 0; k < 3; ++k) x[k] = hn::Load(d, cornerX[k]), y[k] = hn::Load(d, cornerY[k]);
    const VI cx = hn::Add(px, hn::Set(d, kOneSample[0].x)), cy = hn::Add(py, hn::Set(d, kOneSample[0].y));
    VI worst = hn::Zero(d), extent = hn::Zero(d);
    for (int k = 0; k < 3; ++k) {
      const int to = k == 2 ? 0 : k + 1;
      const VI dx = hn::Sub(x[to], x[k]), dy = hn::Sub(y[to], y[k]);
      const MI topLeft =
          hn::Or(hn::Lt(dy, hn::Zero(d)), hn::And(hn::Eq(dy, hn::Zero(d)), hn::Gt(dx, hn::Zero(d))));
      const VI e = hn::Sub(hn::Mul(dx, hn::Sub(cy, y[k])), hn::Mul(dy, hn::Sub(cx, x[k])));
      worst = hn::Or(worst, hn::Add(e, hn::IfThenElse(topLeft, hn::Zero(d), hn::Set(d, -1))));
      extent = hn::Max(extent, hn::Max(hn::Abs(dx), hn::Abs(dy)));
    }
    const MI covered = hn::Gt(worst, hn::Set(d, -1));
    const MI large = hn::Gt(extent, hn::Set(d, 1 << 14));  // edges too long for 32 bits
    if (hn::AllFalse(d, large)) return covered;
    alignas(64) std::int32_t whole[kLanes], cornerOfX[kLanes], cornerOfY[kLanes];
    hn::Store(hn::VecFromMask(d, covered), d, whole);
    hn::Store(cx, d, cornerOfX), hn::Store(cy, d, cornerOfY);
    for (unsigned left = bitsOf(large); left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      whole[k] =
          covers(tile_.corners[static_cast<std::size_t>(id_[i + k])], cornerOfX[k], cornerOfY[k]) ? -1 : 0;
    }
    return hn::Ne(hn::Load(d, whole), hn::Zero(d));
  }

  // Base colours, with vertex colours and texels where the material or a mesh has them.
  void setBase() {
    const F f;
    const VF one = hn::Set(f, 1.0F), zero = hn::Zero(f);
    bool needed = material_->baseColorTexture != nullptr;
    if (tile_.plainMaterial == nullptr)
      for (std::size_t i = 0; i < count_; ++i)
        needed |= tile_.surfaceOf(tile_.records[static_cast<std::size_t>(id_[i])]).hasColors;
    if (!needed) return setPlainBase(*material_, points_);
    for (std::size_t i = 0; i < points_.count; i += kLanes) {
      Color vertex{one, one, one};
      FootprintVector footprint{zero, zero, zero, zero, zero, zero};
      interpolate(i, vertex, footprint);
      const Color base = baseOf(*material_, vertex, footprint);
      hn::Store(base.r, f, points_.base[0] + i);
      hn::Store(base.g, f, points_.base[1] + i);
      hn::Store(base.b, f, points_.base[2] + i);
    }
  }

  void interpolate(std::size_t first, Color& vertex, FootprintVector& footprint) const {
    const F f;
    alignas(64) float v[9][kLanes] = {};
    for (std::size_t i = 0; i < kLanes; ++i) {
      Record& record = tile_.records[static_cast<std::size_t>(id_[first + i])];
      const PointAttributes a = attributesAt(tile_, record, {atX_[first + i], atY_[first + i]});
      const bool colored = tile_.surfaceOf(record).hasColors;
      for (int k = 0; k < 3; ++k) v[k][i] = colored ? a.color[k] : 1.0F;
      const float texcoords[6] = {a.footprint.u,  a.footprint.v,  a.footprint.ux,
                                  a.footprint.vx, a.footprint.uy, a.footprint.vy};
      for (int k = 0; k < 6; ++k) v[3 + k][i] = texcoords[k];
    }
    vertex = {hn::Load(f, v[0]), hn::Load(f, v[1]), hn::Load(f, v[2])};
    footprint = {hn::Load(f, v[3]), hn::Load(f, v[4]), hn::Load(f, v[5]),
                 hn::Load(f, v[6]), hn::Load(f, v[7]), hn::Load(f, v[8])};
  }

  // Shader::writePixel and writePremultiplied.
  HWY_INLINE void write(std::size_t block) const {
    const F f;
    const std::size_t i = block * kLanes;
    const glm::vec4& b = context_.frame.background;
    const VF all = hn::Set(f, static_cast<float>(samples_)), empty = hn::Load(f, empty_ + i);
    const VF under = hn::Mul(hn::Set(f, b.w), hn::Div(empty, all));
    const VF alpha = hn::Add(hn::Div(hn::Sub(all, empty), all), under);
    const VF scale = hn::IfThenElseZero(hn::Gt(alpha, hn::Zero(f)), hn::Div(hn::Set(f, 1.0F), alpha));
    const auto channel = [&](int k, float background) {
      return hn::Mul(hn::Add(hn::Load(f, sum_[k] + i), hn::Mul(hn::Set(f, background), under)), scale);
    };
    storePixels(
        packedOf({channel(0, b.x), channel(1, b.y), channel(2, b.z)}, byteOf(alpha), context_.frame.encoding),
        blockOf_[block].pixels, blockOf_[block].to);
  }

  struct Block {
    std::uint8_t* to;
    MI pixels;
  };

  Tile& tile_;
  const FrameContext& context_;
  const Lighting& lighting_;
  std::size_t samples_;
  float weights_[kMaxSamples + 1];

  // Fragments waiting to be shaded, all of one material.
  const Material* material_ = nullptr;
  std::size_t count_ = 0;
  alignas(64) std::int32_t id_[kSize + kLanes], tag_[kSize + kLanes], atX_[kSize], atY_[kSize];
  PointBatch points_;

  // Vectors of pixels, and the sums of their fragments so far.
  std::size_t blocks_ = 0;
  Block blockOf_[kBlocks];
  alignas(64) std::int32_t pixelX_[kSlots], pixelY_[kSlots];
  alignas(64) float sum_[3][kSlots], empty_[kSlots];
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
