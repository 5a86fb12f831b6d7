// Pixels whose samples show different things: their parts are gathered, shaded a vector at a time and summed up.
// Definition: Shader::pixel in shading.cpp.
#if defined(LIMN_RASTER_FRAGMENTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_FRAGMENTS_INL_H_
#undef LIMN_RASTER_FRAGMENTS_INL_H_
#else
#define LIMN_RASTER_FRAGMENTS_INL_H_
#endif

#include <bit>

#include "raster/attributes-inl.h"
#include "raster/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// The bits at multiples of four, side by side.
HWY_INLINE unsigned everyFourthBit(std::uint64_t bits) {
#if HWY_TARGET <= HWY_AVX3
  return static_cast<unsigned>(_pext_u64(bits, 0x1111111111111111U));
#else
  bits &= 0x1111111111111111U;
  bits = (bits | bits >> 3U) & 0x0303030303030303U;
  bits = (bits | bits >> 6U) & 0x000f000f000f000fU;
  bits = (bits | bits >> 12U) & 0x000000ff000000ffU;
  return static_cast<unsigned>(bits | bits >> 24U) & 0xffffU;
#endif
}

/// The bits of four masks one after the other.
HWY_INLINE std::uint64_t bitsOf(const MI (&masks)[4]) {
#if HWY_TARGET <= HWY_AVX3
  const __mmask32 low = _mm512_kunpackw(masks[1].raw, masks[0].raw),
                  high = _mm512_kunpackw(masks[3].raw, masks[2].raw);
  return _mm512_kunpackd(high, low);
#else
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= static_cast<std::uint64_t>(bitsOf(masks[i])) << (i * kLanes);
  return bits;
#endif
}

/// What the samples of a vector of pixels show, as visibility leaves it: four samples of kLanes / 4 pixels in a vector.
template <std::size_t kGroups>
class SampledIds {
 public:
  HWY_INLINE SampledIds(const Tile& tile, int x, int y)
      : at_(reinterpret_cast<const std::int32_t*>(&tile.ids[tile.offset(0, x, y)])),
        plane_(tile.plane * kGroup) {
    MI same[kGroup], shows[kGroup];
    forEach(std::make_index_sequence<kGroup>(), [&](auto part) HWY_ATTR {
      const VI ids = of(part, 0);
      same[part] = hn::Eq(ids, hn::Shuffle0321(ids));
      if constexpr (kGroups > 1) {
        const VI others = of(part, 1);
        same[part] =
            hn::And(same[part], hn::And(hn::Eq(ids, others), hn::Eq(others, hn::Shuffle0321(others))));
      }
      shows[part] = hn::Gt(ids, hn::Set(I(), -1));
    });
    std::uint64_t uniform = bitsOf(same);
    uniform &= uniform >> 1U;
    uniform_ = everyFourthBit(uniform & uniform >> 2U);
    seen_ = everyFourthBit(bitsOf(shows));
  }

  /// Bit i: all samples of pixel i show the same; its first sample shows something.
  unsigned uniform() const { return uniform_; }
  unsigned seen() const { return seen_; }

  /// Four samples of the pixels [part · kLanes / 4, (part + 1) · kLanes / 4).
  HWY_INLINE VI of(std::size_t part, std::size_t group) const {
    return hn::Load(I(), at_ + group * plane_ + part * kLanes);
  }
  /// What pixels' first samples show.
  HWY_INLINE VI first() const {
    VI first, second, third, fourth;
    hn::LoadInterleaved4(I(), at_, first, second, third, fourth);
    return first;
  }

 private:
  const std::int32_t* at_;
  std::size_t plane_;
  unsigned uniform_, seen_;
};

class Fragments {
 public:
  Fragments(Tile& tile, const Lighting& lighting)
      : tile_(tile), context_(*tile.context), lighting_(lighting), samples_(context_.samples.size()) {
    std::copy(context_.samples.begin(), context_.samples.end(), samplePlaces_);
    samplePlaces_[kMaxSamples] = kOneSample[0];
    for (SamplePosition& place : samplePlaces_)
      place.x += tile.left * kSubpixels, place.y += tile.top * kSubpixels;
  }

  /// Adds pixels (bit i: the one at x + i, y of the tile), none of which has a complex material.
  template <std::size_t kGroups>
  HWY_NOINLINE void add(int x, int y, unsigned pixels) {
    if (pixels_ + kLanes > kSize) finish();
    const auto* const ids = reinterpret_cast<const std::int32_t*>(&tile_.ids[tile_.offset(0, x, y)]);
    std::uint8_t* const row = context_.target.rgba +
                              static_cast<std::size_t>(tile_.top + y) * context_.target.rgbaStride +
                              4 * static_cast<std::size_t>(tile_.left + x);
    for (unsigned left = pixels; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      places_[pixels_] = {x + i, y};
      to_[pixels_] = row + 4 * i;
      addPixel<kGroups>(ids + i * static_cast<int>(kGroup));
      ++pixels_;
    }
  }

  /// Shades what is left and writes all pixels that were added.
  void finish() {
    flush();
    tile_.clock.lap(tile_.statistics.shadingMs);
    tile_.statistics.pixelsCovered += pixels_;
    for (std::size_t i = 0; i < pixels_; i += kLanes) write(i);
    tile_.clock.lap(tile_.statistics.resolveMs);
    pixels_ = 0;
  }

 private:
  using I4 = hn::Rebind<std::int32_t, F4>;
  using VI4 = hn::Vec<I4>;
  using I2 = hn::Repartition<std::int64_t, F4>;
  static constexpr std::size_t kSize = PointBatch::kSize;
  // A fragment's tag: its pixel's number, its first sample, and how many samples show its triangle.
  static constexpr int kSampleShift = 16, kCountShift = 20;
  alignas(16) static constexpr std::int32_t kSampleTags[kGroup] = {0, 1 << kSampleShift, 2 << kSampleShift,
                                                                   3 << kSampleShift};

  // A pixel's fragments: for each triangle the first sample that shows it.
  template <std::size_t kGroups>
  HWY_INLINE void addPixel(const std::int32_t* at) {
    const I4 d;
    if (count_ + kGroups * kGroup > kSize) flush();
    const VI4 tags = hn::Add(hn::Load(d, kSampleTags), hn::Set(d, static_cast<std::int32_t>(pixels_)));
    const VI4 ids = hn::Load(d, at), turned1 = hn::Shuffle0321(ids), turned2 = hn::Shuffle1032(ids),
              turned3 = hn::Shuffle2103(ids);
    VI4 shown = hn::Set(d, 1);  // by how many samples of the pixel
    const auto first = firstOf(ids, turned1, turned2, turned3, shown);
    if constexpr (kGroups == 1) {
      push(ids, hn::Add(tags, hn::ShiftLeft<kCountShift>(shown)), first);
    } else {
      const VI4 others = hn::Load(d, at + tile_.plane * kGroup);
      const VI4 other1 = hn::Shuffle0321(others), other2 = hn::Shuffle1032(others),
                other3 = hn::Shuffle2103(others);
      VI4 othersShown = hn::Set(d, 1);
      auto firstOther = firstOf(others, other1, other2, other3, othersShown);
      for (const VI4 turned : {others, other1, other2, other3})
        shown = hn::Sub(shown, hn::VecFromMask(d, hn::Eq(ids, turned)));
      for (const VI4 turned : {ids, turned1, turned2, turned3})
        firstOther = hn::AndNot(hn::Eq(others, turned), firstOther);
      push(ids, hn::Add(tags, hn::ShiftLeft<kCountShift>(shown)), first);
      const VI4 otherTags = hn::Add(tags, hn::Set(d, static_cast<std::int32_t>(kGroup << kSampleShift)));
      push(others, hn::Add(otherTags, hn::ShiftLeft<kCountShift>(othersShown)), firstOther);
    }
  }

  // Which of four samples show something that none before them does; and how many show the same is added to `shown`.
  HWY_INLINE static hn::Mask<I4> firstOf(VI4 ids, VI4 turned1, VI4 turned2, VI4 turned3, VI4& shown) {
    // Rotated by n, the last n samples of a pixel meet its first n.
    alignas(16) static constexpr std::int32_t kLast[3][4] = {{0, 0, 0, -1}, {0, 0, -1, -1}, {0, -1, -1, -1}};
    const I4 d;
    const VI4 same1 = hn::VecFromMask(d, hn::Eq(ids, turned1)),
              same2 = hn::VecFromMask(d, hn::Eq(ids, turned2)),
              same3 = hn::VecFromMask(d, hn::Eq(ids, turned3));
    shown = hn::Sub(shown, hn::Add(hn::Add(same1, same2), same3));
    const VI4 later =
        hn::Or(hn::Or(hn::And(same1, hn::Load(d, kLast[0])), hn::And(same2, hn::Load(d, kLast[1]))),
               hn::And(same3, hn::Load(d, kLast[2])));
    return hn::Gt(hn::Or(later, ids), hn::Set(d, -1));
  }

  HWY_INLINE void push(VI4 ids, VI4 tags, hn::Mask<I4> which) {
    const I4 d;
    const std::size_t count = hn::CountTrue(d, which);
    if (soleMaterial_ != nullptr) {
      hn::StoreU(hn::Compress(ids, which), d, id_ + count_);
      hn::StoreU(hn::Compress(tags, which), d, tag_ + count_);
      material_ = soleMaterial_;
      count_ += count;
      return;
    }
    // One batch, one material.
    alignas(16) std::int32_t id[kGroup], tag[kGroup];
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
    interpolate(padded);
    points_.count = padded;
    setBases();
    shadePoints(points_, *material_, lighting_);
    addUp(padded);
    tile_.statistics.pixelsShaded += count_;
    count_ = 0;
  }

  // Adds colours to the sums of their pixels. Fragments of a pixel come in the order of their first samples.
  HWY_INLINE void addUp(std::size_t padded) {
    const I d;
    const F f;
    const F4 f4;
    const VF all = hn::Set(f, static_cast<float>(samples_));
    alignas(64) float parts[kLanes][4];
    for (std::size_t i = 0; i < padded; i += kLanes) {
      const VF count = hn::ConvertTo(f, hn::ShiftRight<kCountShift>(hn::Load(d, tag_ + i)));
      const VF weight = hn::Div(count, all);
      const auto part = [&](int k) HWY_ATTR { return hn::Mul(hn::Load(f, points_.color[k] + i), weight); };
      hn::StoreInterleaved4(part(0), part(1), part(2), count, f, parts[0]);
      for (std::size_t k = 0; k < kLanes && i + k < count_; ++k) {
        float* const sum = sum_[tag_[i + k] & ((1 << kSampleShift) - 1)];
        hn::Store(hn::Add(hn::Load(f4, sum), hn::Load(f4, parts[k])), f4, sum);
      }
    }
  }

  // Where fragments are shaded, and their planes there.
  HWY_INLINE void interpolate(std::size_t padded) {
    const F f;
    const I d;
    for (std::size_t i = 0; i < padded; ++i) interpolateOne(i);
    // Not sooner: what was just stored in parts cannot be loaded as a whole until it has left the processor's queue.
    for (std::size_t i = 0; i < padded; i += kLanes) {
      VF nx, ny, nz, depth;
      hn::LoadInterleaved4(f, planes_[i], nx, ny, nz, depth);
      hn::Store(nx, f, points_.normal[0] + i);
      hn::Store(ny, f, points_.normal[1] + i);
      hn::Store(nz, f, points_.normal[2] + i);
      hn::Store(depth, f, points_.depth + i);
      VI x, y;
      hn::LoadInterleaved2(d, &at_[i].x, x, y);
      hn::Store(lighting_.rayX(x), f, points_.rayX + i);
      hn::Store(lighting_.rayY(y), f, points_.rayY + i);
    }
  }

  // x, y, x, y
  HWY_INLINE static VI4 pairOf(SamplePosition p) {
    return hn::BitCast(I4(), hn::Set(I2(), std::bit_cast<std::int64_t>(p)));
  }

  HWY_INLINE void interpolateOne(std::size_t i) {
    const F4 f;
    const I4 d;
    const auto tag = static_cast<std::uint32_t>(tag_[i]);
    const auto id = static_cast<std::size_t>(id_[i]);
    const VI4 pixel = pairOf(places_[tag & ((1U << kSampleShift) - 1U)]);
    // shadingPoint(): the centre if the triangle covers it, else the sample.
    const CenterEdges& e = tile_.centerEdges[id];
    const VI4 across = hn::Mul(hn::Load(d, e.stepX), hn::Broadcast<0>(pixel)),
              down = hn::Mul(hn::Load(d, e.stepY), hn::Broadcast<1>(pixel));
    const VI4 values = hn::Add(hn::Load(d, e.value), hn::Add(across, down));
    const bool central = hn::AllTrue(d, hn::Gt(values, hn::Set(d, -1)));
    const std::size_t sample = central ? kMaxSamples : (tag >> kSampleShift) & (kMaxSamples - 1);
    const VI4 at = hn::Add(hn::ShiftLeft<kSubpixelBits>(pixel), pairOf(samplePlaces_[sample]));
    at_[i] = std::bit_cast<SamplePosition>(hn::GetLane(hn::BitCast(I2(), at)));
    const Record& r = tile_.records[id];
    const auto from = hn::ConvertTo(f, hn::Sub(at, pairOf({r.x0, r.y0})));
    const auto start = hn::Add(hn::Load(f, r.origin), hn::Mul(hn::Load(f, r.slopeY), hn::Broadcast<1>(from)));
    hn::Store(hn::Add(start, hn::Mul(hn::Load(f, r.slopeX), hn::Broadcast<0>(from))), f, planes_[i]);
  }

  // Base colours, with vertex colours and texels where the material or a mesh has them.
  void setBases() {
    if (soleMaterial_ != nullptr) {
      if (soleMaterial_ == tile_.plainMaterial) return setPlainBase(*material_, points_);
      for (std::size_t i = 0; i < points_.count; i += kLanes) setTexcoords(i);
      return addTexels<false>(*material_, texture_, points_);
    }
    bool needed = material_->baseColorTexture != nullptr;
    for (std::size_t i = 0; i < count_; ++i)
      needed |= tile_.surfaceOf(tile_.records[static_cast<std::size_t>(id_[i])]).hasColors;
    if (!needed) return setPlainBase(*material_, points_);
    for (std::size_t i = 0; i < points_.count; i += kLanes) {
      Color vertex;
      FootprintVector footprint;
      interpolate(i, vertex, footprint);
      setBase(*material_, vertex, points_, i);
      if (material_->baseColorTexture != nullptr)
        storeFootprint(material_->baseColorTexture->data(), footprint, texture_, i);
    }
    if (material_->baseColorTexture != nullptr) addTexels<true>(*material_, texture_, points_);
  }

  HWY_INLINE void setTexcoords(std::size_t i) {
    const F f;
    const I d;
    TexcoordVector texcoords;
    for (std::size_t k = 0; k < kLanes; ++k)
      texcoords.set(tile_.texturePlanes[static_cast<std::size_t>(id_[i + k])], lanesOf(1U << k));
    VI x, y;
    hn::LoadInterleaved2(d, &at_[i].x, x, y);
    const VF one = hn::Set(f, 1.0F), q = hn::Load(f, points_.depth + i);
    texcoords.store(material_->baseColorTexture->data(), x, y,
                    context_.map.perspective ? hn::Div(one, q) : one, texture_, i);
  }

  void interpolate(std::size_t first, Color& vertex, FootprintVector& footprint) const {
    const F f;
    alignas(64) float v[9][kLanes] = {};
    for (std::size_t i = 0; i < kLanes; ++i) {
      Record& record = tile_.records[static_cast<std::size_t>(id_[first + i])];
      const PointAttributes a = attributesAt(tile_, record, at_[first + i]);
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
  HWY_INLINE void write(std::size_t i) {
    const I d;
    const F f;
    const glm::vec4& b = context_.frame.background;
    VF red, green, blue, count;
    hn::LoadInterleaved4(f, sum_[i], red, green, blue, count);
    const VF all = hn::Set(f, static_cast<float>(samples_));
    const VF under = hn::Mul(hn::Set(f, b.w), hn::Div(hn::Sub(all, count), all));
    const VF alpha = hn::Add(hn::Div(count, all), under);
    const VF scale = hn::IfThenElseZero(hn::Gt(alpha, hn::Zero(f)), hn::Div(hn::Set(f, 1.0F), alpha));
    const auto channel = [&](VF sum, float background) HWY_ATTR {
      return hn::Mul(hn::Add(sum, hn::Mul(hn::Set(f, background), under)), scale);
    };
    alignas(64) std::int32_t pixels[kLanes];
    hn::Store(packedOf({channel(red, b.x), channel(green, b.y), channel(blue, b.z)}, byteOf(alpha),
                       context_.frame.encoding),
              d, pixels);
    for (std::size_t k = 0; k < kLanes && i + k < pixels_; ++k) {
      std::copy_n(reinterpret_cast<const std::uint8_t*>(pixels + k), 4, to_[i + k]);
    }
    for (std::size_t k = 0; k < kLanes; ++k) hn::Store(hn::Zero(F4()), F4(), sum_[i + k]);
  }

  Tile& tile_;
  const FrameContext& context_;
  const Lighting& lighting_;
  std::size_t samples_;
  SamplePosition
      samplePlaces_[kMaxSamples + 1];  // in the tile's first pixel: of the samples, and of the centre

  // Fragments waiting to be shaded, all of one material.
  const Material* const soleMaterial_ =
      tile_.plainMaterial != nullptr ? tile_.plainMaterial : tile_.texturedMaterial;
  const Material* material_ = nullptr;
  std::size_t count_ = 0;
  alignas(64) std::int32_t id_[kSize + kLanes], tag_[kSize + kLanes];
  alignas(64) SamplePosition at_[kSize];  // where they are shaded, in the window
  alignas(64) float planes_[kSize][4];
  PointBatch points_;
  TextureBatch texture_;

  // Pixels, and the sums of their fragments so far: colours and how many samples they show.
  std::size_t pixels_ = 0;
  SamplePosition places_[kSize];  // in the tile
  std::uint8_t* to_[kSize];
  alignas(64) float sum_[kSize][4] = {};
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
