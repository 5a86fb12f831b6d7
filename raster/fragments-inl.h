// Pixels whose samples show different things: their parts are gathered, shaded a vector at a time and summed up.
// Definition: Shader::pixel in shading.cpp.
//
// Such pixels wait in a list, so that vectors of them are full. A vector's fragments are listed sample by sample: of the
// pixels whose sample is the first to show its triangle, side by side. What they amount to is spread over the same pixels
// and added, again sample by sample.
#if defined(LIMN_RASTER_FRAGMENTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LIMN_RASTER_FRAGMENTS_INL_H_
#undef LIMN_RASTER_FRAGMENTS_INL_H_
#else
#define LIMN_RASTER_FRAGMENTS_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstring>

#include "raster/attributes-inl.h"
#include "raster/points-inl.h"

HWY_BEFORE_NAMESPACE();
namespace limn::raster {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
/// What the samples of a vector of pixels show.
template <std::size_t kGroups>
struct SampledIds {
  static constexpr std::size_t kSamples = kGroups * kGroup;
  VI of[kSamples];

  HWY_INLINE SampledIds(const Tile& tile, int x, int y) {
    const auto* const at = reinterpret_cast<const std::int32_t*>(&tile.ids[tile.offset(0, x, y)]);
    for (std::size_t g = 0; g < kGroups; ++g)
      loadColumns(I(), at + g * tile.plane * kGroup, of[4 * g], of[4 * g + 1], of[4 * g + 2], of[4 * g + 3]);
  }
  /// Pixels all of whose samples show the same.
  HWY_INLINE MI uniform() const {
    MI same = hn::Eq(of[0], of[1]);
    for (std::size_t s = 2; s < kSamples; ++s) same = hn::And(same, hn::Eq(of[0], of[s]));
    return same;
  }
};

class Fragments {
 public:
  Fragments(Tile& tile, const Lighting& lighting)
      : tile_(tile), context_(*tile.context), lighting_(lighting), samples_(context_.samples.size()) {}

  bool isFull() const { return pixels_ > kPixels - kLanes; }

  /// Unless it is full, adds the pixels `which` of the vector at x, y of the tile, none of which has a complex material.
  HWY_INLINE void add(int x, int y, MI which) {
    const I d;
    const VI places = hn::Add(hn::ShiftLeft<kSubpixelBits>(hn::Iota(d, 0)),
                              hn::Set(d, (x << kSubpixelBits) + (y << kRowShift)));
    hn::StoreU(compressed(places, which), d, place_ + pixels_);
    pixels_ += hn::CountTrue(d, which);
  }

  /// Shades and writes all pixels that were added.
  HWY_NOINLINE void finish() {
    if (samples_ == kGroup)
      finishAll<kGroup>();
    else
      finishAll<kMaxSamples>();
  }

 private:
  static constexpr std::size_t kSize = PointBatch::kSize, kPixels = 256;
  // A place in the tile: sub-pixels across, and down from this bit on. A fragment's tag has its sample's place, and above
  // it how many samples show its triangle, which are less than eight.
  static constexpr int kStripBits = std::countr_zero(Tile::kStripWidth);
  static constexpr int kDownShift = 15, kRowShift = kDownShift + kSubpixelBits, kCountShift = 29;

  template <std::size_t kSamples>
  HWY_INLINE void finishAll() {
    setOffsets();
    std::size_t written = 0;
    for (std::size_t i = 0; i < pixels_; i += kLanes) {
      // Not full, so that what is expanded can be loaded as vectors.
      if (count_ + (kSamples + 1) * kLanes > kSize) {
        write<kSamples>(written, i);
        written = i;
      }
      list<kSamples>(i);
    }
    write<kSamples>(written, pixels_);
    tile_.statistics.pixelsCovered += pixels_;
    pixels_ = 0;
  }

  // The fragments of the pixels [i, i + kLanes), and how many samples of each show something.
  template <std::size_t kSamples>
  HWY_INLINE void list(std::size_t i) {
    const I d;
    const VI one = hn::Set(d, 1 << kCountShift), place = hn::Load(d, place_ + i);
    VI shown[kSamples], tag[kSamples], covered = hn::Zero(d);
    MI first[kSamples];  // pixels no sample of which before shows the same
    loadShown(i, shown);
    for (std::size_t s = 0; s < kSamples; ++s) {
      const SamplePosition at = context_.samples[s];
      tag[s] = hn::Add(place, hn::Set(d, at.x + (at.y << kDownShift) + (1 << kCountShift)));
      first[s] = hn::Gt(shown[s], hn::Set(d, -1));
      covered = hn::IfThenElse(first[s], hn::Add(covered, hn::Set(d, 1)), covered);
    }
    for (std::size_t s = 1; s < kSamples; ++s)
      for (std::size_t before = 0; before < s; ++before) {
        const MI same = hn::Eq(shown[before], shown[s]);
        tag[before] = hn::IfThenElse(same, hn::Add(tag[before], one), tag[before]);
        first[s] = hn::AndNot(same, first[s]);
      }
    hn::Store(covered, d, covered_ + i);
    std::size_t count = count_;
    begin_[i / kLanes] = count;
    for (std::size_t s = 0; s < kSamples; ++s) {
      hn::StoreU(compressed(shown[s], first[s]), d, listedId_ + count);
      hn::StoreU(compressed(tag[s], first[s]), d, listedTag_ + count);
      first_[s][i / kLanes] = bitsOf(first[s]);
      count += hn::CountTrue(d, first[s]);
    }
    count_ = count;
  }

  // Tile::pixelOffset() of all pixels.
  HWY_INLINE void setOffsets() {
    const I d;
    const VI strip = hn::Set(d, static_cast<std::int32_t>(tile_.strip)),
             column = hn::Set(d, (1 << kStripBits) - 1);
    for (std::size_t i = 0; i < pixels_; i += kLanes) {
      const VI place = hn::Load(d, place_ + i), y = hn::ShiftRight<kRowShift>(place);
      const VI x = hn::ShiftRight<kSubpixelBits>(hn::And(place, hn::Set(d, (1 << kDownShift) - 1)));
      const VI inStrip = hn::Add(hn::And(x, column), hn::ShiftLeft<kStripBits>(y));
      hn::Store(hn::Add(hn::Mul(hn::ShiftRight<kStripBits>(x), strip), inStrip), d, offset_ + i);
    }
    hn::StoreU(hn::Zero(d), d, offset_ + pixels_);
  }

  // What the samples of pixels show; of those beyond the last, nothing.
  template <std::size_t kSamples>
  HWY_INLINE void loadShown(std::size_t i, VI (&shown)[kSamples]) const {
    const I d;
    const MI inside = hn::FirstN(d, pixels_ - i);
    for (std::size_t g = 0; g < kSamples / kGroup; ++g) {
      const auto* const ids =
          reinterpret_cast<const std::int32_t*>(tile_.ids.data()) + g * tile_.plane * kGroup;
      const auto at = [&](std::size_t lane) {
        return ids + static_cast<std::ptrdiff_t>(kGroup) * offset_[i + lane];
      };
      const VI rows[4] = {loadEveryFourth(d, 0, at), loadEveryFourth(d, 1, at), loadEveryFourth(d, 2, at),
                          loadEveryFourth(d, 3, at)};
      transpose(d, rows, shown[4 * g], shown[4 * g + 1], shown[4 * g + 2], shown[4 * g + 3]);
    }
    for (VI& ids : shown) ids = hn::IfThenElse(inside, ids, hn::Set(d, -1));
  }

  // Shades the fragments listed and writes their pixels [from, to).
  template <std::size_t kSamples>
  HWY_INLINE void write(std::size_t from, std::size_t to) {
    if (count_ == 0) return;
    if (tile_.hasSoleMaterial())
      shadeAll();
    else
      shadeByMaterial();
    tile_.statistics.pixelsShaded += count_;
    count_ = 0;
    tile_.clock.lap(tile_.statistics.shadingMs);
    for (std::size_t i = from; i < to; i += kLanes) writeVector<kSamples>(i);
    tile_.clock.lap(tile_.statistics.resolveMs);
  }

  void shadeAll() {
    material_ = tile_.plainMaterial != nullptr ? tile_.plainMaterial : tile_.texturedMaterial;
    shade(listedId_, listedTag_, count_);
    for (std::size_t k = 0; k < 3; ++k) parts_[k] = points_.color[k];
  }

  // One material after the other.
  void shadeByMaterial() {
    const Material* materials[kSize];
    for (std::size_t i = 0; i < count_; ++i)
      materials[i] = tile_.surfaceOf(tile_.records[static_cast<std::size_t>(listedId_[i])]).material;
    for (std::size_t i = 0; i < count_; ++i) {
      if (materials[i] == nullptr) continue;
      material_ = materials[i];
      std::size_t count = 0, of[kSize];
      for (std::size_t k = i; k < count_; ++k) {
        if (materials[k] != material_) continue;
        id_[count] = listedId_[k], tag_[count] = listedTag_[k];
        of[count++] = k;
        materials[k] = nullptr;
      }
      shade(id_, tag_, count);
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t n = 0; n < count; ++n) colors_[k][of[n]] = points_.color[k][n];
    }
    for (std::size_t k = 0; k < 3; ++k) parts_[k] = colors_[k];
  }

  // What fragments of one material add to their pixels.
  void shade(std::int32_t* ids, std::int32_t* tags, std::size_t count) {
    const std::size_t padded = (count + kLanes - 1) / kLanes * kLanes;
    for (std::size_t i = count; i < padded; ++i) ids[i] = ids[0], tags[i] = tags[0];
    points_.count = padded;
    for (std::size_t i = 0; i < padded; i += kLanes) interpolate(ids + i, tags + i, i);
    setBases(ids, count);
    shadePoints(points_, *material_, lighting_);
    for (std::size_t i = 0; i < padded; i += kLanes) weigh(tags + i, i);
  }

  HWY_INLINE void weigh(const std::int32_t* tags, std::size_t i) {
    const F f;
    const hn::Rebind<std::uint32_t, F> u;
    const auto count = hn::ShiftRight<kCountShift>(hn::BitCast(u, hn::Load(I(), tags)));
    const VF weight =
        hn::Div(hn::ConvertTo(f, hn::BitCast(I(), count)), hn::Set(f, static_cast<float>(samples_)));
    for (float* const color : points_.color) hn::Store(hn::Mul(hn::Load(f, color + i), weight), f, color + i);
  }

  // Where a vector of fragments is shaded, and their planes there.
  HWY_INLINE void interpolate(const std::int32_t* ids, const std::int32_t* tags, std::size_t i) {
    const F f;
    const I d;
    const VI tag = hn::Load(d, tags);
    const VI sampleX = hn::And(tag, hn::Set(d, (1 << kDownShift) - 1));
    const VI sampleY =
        hn::And(hn::ShiftRight<kDownShift>(tag), hn::Set(d, (1 << (kCountShift - kDownShift)) - 1));
    const MI central =
        coversCenters(ids, hn::ShiftRight<kSubpixelBits>(sampleX), hn::ShiftRight<kSubpixelBits>(sampleY));
    const auto placed = [&](VI sample, int corner) HWY_ATTR {
      const VI center = hn::Or(hn::And(sample, hn::Set(d, -kSubpixels)), hn::Set(d, kOneSample[0].x));
      return hn::Add(hn::IfThenElse(central, center, sample), hn::Set(d, corner * kSubpixels));
    };
    const VI x = placed(sampleX, tile_.left), y = placed(sampleY, tile_.top);
    hn::Store(x, d, atX_ + i);
    hn::Store(y, d, atY_ + i);
    hn::Store(lighting_.rayX(x), f, points_.rayX + i);
    hn::Store(lighting_.rayY(y), f, points_.rayY + i);
    setPlanes(ids, x, y, i);
  }

  // shadingPoint()'s condition: whether the triangles of fragments cover the centres of their pixels.
  HWY_INLINE MI coversCenters(const std::int32_t* ids, VI x, VI y) const {
    const I d;
    const CenterEdges* const all = tile_.centerEdges.data();
    VI rows[4], edge0, edge1, edge2, unused;
    forEach(std::make_index_sequence<4>(), [&](auto j) HWY_ATTR {
      const auto load = [&](auto member) HWY_ATTR {
        return loadEveryFourth(d, j, [&](std::size_t lane) { return all[ids[lane]].*member; });
      };
      const VI across = hn::Mul(load(&CenterEdges::stepX), hn::Broadcast<j>(x)),
               down = hn::Mul(load(&CenterEdges::stepY), hn::Broadcast<j>(y));
      rows[j] = hn::Add(load(&CenterEdges::value), hn::Add(across, down));
    });
    transpose(d, rows, edge0, edge1, edge2, unused);
    return hn::Gt(hn::Or(hn::Or(edge0, edge1), edge2), hn::Set(d, -1));
  }

  // Record::value() of all planes.
  HWY_INLINE void setPlanes(const std::int32_t* ids, VI x, VI y, std::size_t i) {
    const F f;
    const I d;
    const Record* const records = tile_.records.data();
    VI anchors[4], x0, y0, unused[2];
    forEach(std::make_index_sequence<4>(), [&](auto j) HWY_ATTR {
      anchors[j] = loadEveryFourth(d, j, [&](std::size_t lane) { return &records[ids[lane]].x0; });
    });
    transpose(d, anchors, x0, y0, unused[0], unused[1]);
    const VF dx = hn::ConvertTo(f, hn::Sub(x, x0)), dy = hn::ConvertTo(f, hn::Sub(y, y0));
    VF rows[4], nx, ny, nz, depth;
    forEach(std::make_index_sequence<4>(), [&](auto j) HWY_ATTR {
      const auto load = [&](auto member) HWY_ATTR {
        return loadEveryFourth(f, j, [&](std::size_t lane) { return records[ids[lane]].*member; });
      };
      const VF start = hn::Add(load(&Record::origin), hn::Mul(load(&Record::slopeY), hn::Broadcast<j>(dy)));
      rows[j] = hn::Add(start, hn::Mul(load(&Record::slopeX), hn::Broadcast<j>(dx)));
    });
    transpose(f, rows, nx, ny, nz, depth);
    hn::Store(nx, f, points_.normal[0] + i);
    hn::Store(ny, f, points_.normal[1] + i);
    hn::Store(nz, f, points_.normal[2] + i);
    hn::Store(depth, f, points_.depth + i);
  }

  // Base colours, with vertex colours and texels where the material or a mesh has them.
  void setBases(const std::int32_t* ids, std::size_t count) {
    if (tile_.hasSoleMaterial()) {
      if (tile_.plainMaterial != nullptr) return setPlainBase(*material_, points_);
      for (std::size_t i = 0; i < points_.count; i += kLanes) setTexcoords(ids + i, i);
      return addTexels<false>(*material_, texture_, points_);
    }
    bool needed = material_->baseColorTexture != nullptr;
    for (std::size_t i = 0; i < count; ++i)
      needed |= tile_.surfaceOf(tile_.records[static_cast<std::size_t>(ids[i])]).hasColors;
    if (!needed) return setPlainBase(*material_, points_);
    for (std::size_t i = 0; i < points_.count; i += kLanes) {
      Color vertex;
      FootprintVector footprint;
      interpolate(ids + i, i, vertex, footprint);
      setBase(*material_, vertex, points_, i);
      if (material_->baseColorTexture != nullptr)
        storeFootprint(material_->baseColorTexture->data(), footprint, texture_, i);
    }
    if (material_->baseColorTexture != nullptr) addTexels<true>(*material_, texture_, points_);
  }

  HWY_INLINE void setTexcoords(const std::int32_t* ids, std::size_t i) {
    const F f;
    const I d;
    const TexcoordVector texcoords(tile_.texturePlanes.data(), ids);
    const VF one = hn::Set(f, 1.0F), q = hn::Load(f, points_.depth + i);
    texcoords.store(material_->baseColorTexture->data(), hn::Load(d, atX_ + i), hn::Load(d, atY_ + i),
                    context_.map.perspective ? hn::Div(one, q) : one, texture_, i);
  }

  void interpolate(const std::int32_t* ids, std::size_t first, Color& vertex,
                   FootprintVector& footprint) const {
    const F f;
    alignas(64) float v[9][kLanes] = {};
    for (std::size_t i = 0; i < kLanes; ++i) {
      Record& record = tile_.records[static_cast<std::size_t>(ids[i])];
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
  template <std::size_t kSamples>
  HWY_INLINE void writeVector(std::size_t i) {
    const I d;
    const F f;
    VF sum[3] = {hn::Zero(f), hn::Zero(f), hn::Zero(f)};
    std::size_t part = begin_[i / kLanes];
    for (std::size_t s = 0; s < kSamples; ++s) {
      const unsigned lanes = first_[s][i / kLanes];
      for (std::size_t k = 0; k < 3; ++k) sum[k] = hn::Add(sum[k], expanded(parts_[k] + part, lanes));
      part += static_cast<std::size_t>(std::popcount(lanes));
    }
    const glm::vec4& b = context_.frame.background;
    const VF all = hn::Set(f, static_cast<float>(kSamples)),
             covered = hn::ConvertTo(f, hn::Load(d, covered_ + i));
    const VF under = hn::Mul(hn::Set(f, b.w), hn::Div(hn::Sub(all, covered), all));
    const VF alpha = hn::Add(hn::Div(covered, all), under);
    const VF scale = hn::IfThenElseZero(hn::Gt(alpha, hn::Zero(f)), hn::Div(hn::Set(f, 1.0F), alpha));
    const auto channel = [&](VF total, float background) HWY_ATTR {
      return hn::Mul(hn::Add(total, hn::Mul(hn::Set(f, background), under)), scale);
    };
    alignas(64) std::int32_t pixels[kLanes];
    hn::Store(packedOf({channel(sum[0], b.x), channel(sum[1], b.y), channel(sum[2], b.z)}, byteOf(alpha),
                       context_.frame.encoding),
              d, pixels);
    const std::size_t stride = context_.target.rgbaStride, count = std::min(kLanes, pixels_ - i);
    std::uint8_t* const corner = context_.target.rgba + static_cast<std::size_t>(tile_.top) * stride +
                                 4 * static_cast<std::size_t>(tile_.left);
    for (std::size_t k = 0; k < count; ++k) {
      const auto place = static_cast<std::uint32_t>(place_[i + k]);
      const std::size_t x = (place & ((1U << kDownShift) - 1U)) >> kSubpixelBits, y = place >> kRowShift;
      std::memcpy(corner + y * stride + 4 * x, pixels + k, 4);
    }
  }

  Tile& tile_;
  const FrameContext& context_;
  const Lighting& lighting_;
  std::size_t samples_;

  // Places of the pixels that wait.
  std::size_t pixels_ = 0;
  alignas(64) std::int32_t place_[kPixels], offset_[kPixels + kLanes];
  // Of vectors of them: how many samples show something, where their fragments begin, and for each sample the pixels that
  // have one there.
  alignas(64) std::int32_t covered_[kPixels];
  std::size_t begin_[kPixels / kLanes];
  unsigned first_[kMaxSamples][kPixels / kLanes];

  // Fragments of those that are being shaded.
  std::size_t count_ = 0;
  alignas(64) std::int32_t listedId_[kSize + kLanes], listedTag_[kSize + kLanes];
  const float* parts_[3];  // what they add to their pixels

  // Fragments of one material.
  const Material* material_ = nullptr;
  alignas(64) std::int32_t id_[kSize], tag_[kSize];
  alignas(64) std::int32_t atX_[kSize], atY_[kSize];  // where they are shaded, in the window
  alignas(64) float colors_[3][kSize];
  PointBatch points_;
  TextureBatch texture_;
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
