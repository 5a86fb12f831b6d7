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
#include "raster/attributes-inl.h"
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
        fragments_(tile, lighting_) {
    for (int x = 0; x < tile.width; x += static_cast<int>(kLanes))
      hn::Store(lighting_.rayX(centersFrom(tile.left + x)), F(), rayX_ + x);
    for (int y = 0; y < tile.height; y += static_cast<int>(kLanes))
      hn::Store(lighting_.rayY(centersFrom(tile.top + y)), F(), rayY_ + y);
  }

  void run() {
    if (tile_.isEmpty()) return fill();
    if (tile_.texturedMaterial != nullptr) setMaterial(*tile_.texturedMaterial, Base::kTextured);
    // Down the strips, as pixels lie in memory.
    for (int x = 0; x < tile_.width; x += Tile::kCellWidth)
      for (int y = 0; y < tile_.height; y += Tile::kCellHeight) shadeCell(x, y);
    flush();
    fragments_.finish();
    tile_.statistics.pixelsShaded += shaded_;
    tile_.statistics.pixelsCovered += shaded_;
  }

 private:
  std::int32_t packed(const glm::vec4& c) const {
    const Encoding e = context_.frame.encoding;
    return static_cast<std::int32_t>(encode(c.x, e) | static_cast<unsigned>(encode(c.y, e)) << 8U |
                                     static_cast<unsigned>(encode(c.z, e)) << 16U |
                                     static_cast<unsigned>(toByte(c.w)) << 24U);
  }

  HWY_INLINE void shadeCell(int left, int top) {
    const int right = std::min(left + Tile::kCellWidth, tile_.width);
    const int bottom = std::min(top + Tile::kCellHeight, tile_.height);
    const bool simple = tile_.hasSoleMaterial() && !tile_.overlaid && right == left + Tile::kCellWidth;
    for (int x = left; x < right; x += static_cast<int>(kLanes))
      if (!tile_.isTouched(left, top))
        for (int y = top; y < bottom; ++y) store(hn::Set(I(), background_), x, y);
      else if (samples_ == 1)
        for (int y = top; y < bottom; ++y) simple ? simpleBlock(x, y) : block(x, y);
      else if (samples_ == kGroup)
        sampledBlocks<1>(x, top, bottom, simple);
      else
        sampledBlocks<2>(x, top, bottom, simple);
  }

  void fill() const {
    for (int y = 0; y < tile_.height; ++y)
      for (int x = 0; x < tile_.width; x += static_cast<int>(kLanes)) store(hn::Set(I(), background_), x, y);
  }

  HWY_INLINE VI idsAt(int x, int y) const {
    return hn::LoadU(I(), reinterpret_cast<const std::int32_t*>(&tile_.ids[tile_.pixelOffset(x, y)]));
  }

  // Sub-pixel columns, or rows, of the centres of the window's pixels from `first` on.
  HWY_INLINE static VI centersFrom(int first) {
    static_assert(kOneSample[0].x == kOneSample[0].y);
    const VI center = hn::Set(I(), first * kSubpixels + kOneSample[0].x);
    return hn::Add(center, hn::ShiftLeft<kSubpixelBits>(hn::Iota(I(), 0)));
  }

  // A vector of pixels that all lie within the tile and show the tile's one material or nothing.
  HWY_INLINE void simpleBlock(int x, int y) {
    const I d;
    const VI ids = idsAt(x, y);
    shadeSimple(x, y, hn::Ne(ids, hn::Set(d, -1)), ids);
  }

  // Writes them all: background where nothing is seen, for now also where fragments are going to be written.
  HWY_INLINE void shadeSimple(int x, int y, MI seen, VI ids) {
    const I d;
    if (hn::AllFalse(d, seen))
      hn::StoreU(hn::Set(d, background_), d, reinterpret_cast<std::int32_t*>(pixelAt(x, y)));
    else if (tile_.plainMaterial != nullptr)
      shadePlain(*tile_.plainMaterial, x, y, seen, true);
    else
      pushTextured(x, y, ids, seen, true);
  }

  // A vector of pixels with one sample.
  HWY_INLINE void block(int x, int y) {
    const I d;
    const VI ids = idsAt(x, y);
    const MI inside = hn::FirstN(d, static_cast<std::size_t>(tile_.width - x));
    const MI whole = tile_.overlaid ? hn::And(inside, notBlended(x, y)) : inside;
    const MI nothing = hn::Eq(ids, hn::Set(d, -1));
    if (!hn::AllFalse(d, hn::And(nothing, whole))) store(hn::Set(d, background_), x, y);
    MI left = hn::AndNot(whole, inside);
    if (const MI seen = hn::AndNot(nothing, whole); !hn::AllFalse(d, seen))
      left = hn::Or(left, pushSeen(x, y, seen, ids));
    for (unsigned bits = bitsOf(left); bits != 0; bits &= bits - 1)
      shadePixelScalar(tile_, x + std::countr_zero(bits), y);
  }

  // Vectors of pixels with several samples, one below the other. What they show is found out for all of them first: what
  // follows from that is hard to foresee, and so would have to wait for each.
  template <std::size_t kGroups>
  HWY_INLINE void sampledBlocks(int x, int top, int bottom, bool simple) {
    const I d;
    const MI inside = hn::FirstN(d, static_cast<std::size_t>(tile_.width - x));
    for (int y = top; y < bottom; ++y) {
      const SampledIds<kGroups> ids(tile_, x, y);
      Shown& shown = shown_[y - top];
      shown.uniform = bitsOf(hn::And(inside, ids.uniform()));
      shown.something = bitsOf(hn::Gt(ids.of[0], hn::Set(d, -1)));
      hn::Store(ids.of[0], d, shown.first);
    }
    if (simple)
      for (int y = top; y < bottom; ++y) simpleSampledBlock(x, y, shown_[y - top]);
    else
      for (int y = top; y < bottom; ++y) sampledBlock(x, y, bitsOf(inside), shown_[y - top]);
  }

  // What pixels' samples show: all the same; the first one of them something, and what.
  struct Shown {
    unsigned uniform, something;
    alignas(64) std::int32_t first[kLanes];
  };

  HWY_INLINE void simpleSampledBlock(int x, int y, const Shown& shown) {
    const unsigned all = bitsOf(hn::FirstN(I(), kLanes));
    shadeSimple(x, y, lanesOf(shown.uniform & shown.something), hn::Load(I(), shown.first));
    if (shown.uniform != all) addFragments(x, y, lanesOf(all & ~shown.uniform));
  }

  HWY_INLINE void addFragments(int x, int y, MI pixels) {
    if (fragments_.isFull()) {
      flush();  // what waits may be over background
      fragments_.finish();
    }
    fragments_.add(x, y, pixels);
  }

  HWY_INLINE void sampledBlock(int x, int y, unsigned inside, const Shown& shown) {
    const I d;
    unsigned whole = shown.uniform;
    if (tile_.overlaid) whole &= bitsOf(notBlended(x, y));
    const unsigned seen = whole & shown.something;
    if (seen != whole) store(hn::Set(d, background_), x, y);
    unsigned left = inside & ~whole;
    if (seen != 0) left |= bitsOf(pushSeen(x, y, lanesOf(seen), hn::Load(d, shown.first)));
    if (left == 0) return;
    if (tile_.overlaid || !tile_.hasSoleMaterial()) left = leaveSome(left, x, y);
    if (left != 0) addFragments(x, y, lanesOf(left));
  }

  // Shades pixels whose samples show one triangle each, or adds them to the points; returns what is left to others.
  HWY_INLINE MI pushSeen(int x, int y, MI seen, VI ids) {
    const MI none = hn::FirstN(I(), 0);
    if (tile_.plainMaterial != nullptr)
      shadePlain(*tile_.plainMaterial, x, y, seen);
    else if (tile_.texturedMaterial != nullptr)
      pushTextured(x, y, ids, seen);
    else
      return pushByMaterial(x, y, ids, seen);
    return none;
  }

  // Leaves to the definition what a vector cannot handle, and returns the others.
  unsigned leaveSome(unsigned pixels, int x, int y) {
    unsigned others = pixels;
    for (unsigned left = pixels; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const bool blended = tile_.overlaid && tile_.isBlended[tile_.pixelOffset(x + lane, y)] != 0;
      if (!blended && !showsComplex(x + lane, y)) continue;
      shadePixelScalar(tile_, x + lane, y);
      others &= ~(1U << lane);
    }
    return others;
  }

  bool showsComplex(int x, int y) const {
    bool complex = false;
    for (int s = 0; s < static_cast<int>(samples_); ++s) {
      const std::uint32_t id = tile_.ids[tile_.offset(s, x, y)];
      complex |= id != kNoRecord && isComplex(*tile_.surfaceOf(tile_.records[id]).material);
    }
    return complex;
  }

  MI notBlended(int x, int y) const {
    const I d;
    alignas(64) std::int32_t free[kLanes];
    for (std::size_t i = 0; i < kLanes; ++i)
      free[i] = tile_.isBlended[tile_.pixelOffset(x, y) + i] == 0 ? 1 : 0;
    return hn::Ne(hn::Load(d, free), hn::Zero(d));
  }

  std::uint8_t* pixelAt(int x, int y) const {
    const std::size_t row = static_cast<std::size_t>(tile_.top + y) * context_.target.rgbaStride;
    return context_.target.rgba + row + static_cast<std::size_t>(tile_.left + x) * 4;
  }

  HWY_INLINE void store(VI color, int x, int y) const {
    const hn::Repartition<std::uint8_t, I> d8;
    std::uint8_t* const to = pixelAt(x, y);
    if (x + static_cast<int>(kLanes) <= tile_.width) {
      hn::StoreU(hn::BitCast(d8, color), d8, to);
      return;
    }
    alignas(64) std::uint8_t bytes[4 * kLanes];
    hn::Store(hn::BitCast(d8, color), d8, bytes);
    std::copy(bytes, bytes + static_cast<std::ptrdiff_t>(4 * (tile_.width - x)), to);
  }

  // Where the points' base colours come from: a texture, or vertex colours and perhaps a texture; or they are lit already.
  enum class Base { kTextured, kColored, kLit };

  void setMaterial(const Material& m, Base base) {
    if (base == base_ && (material_ == &m || base == Base::kLit)) return;
    flush();
    material_ = &m;
    base_ = base;
  }

  HWY_INLINE PointVector pointAt(int x, int y) const {
    const F f;
    const std::size_t o = tile_.pixelOffset(x, y);
    PointVector p{
        hn::Load(f, rayX_ + x), hn::Set(f, rayY_[y]), hn::Zero(f), hn::Zero(f), hn::Zero(f), hn::Zero(f)};
    if (samples_ > 1) {
      loadColumns(f, &tile_.centers[4 * o], p.normalX, p.normalY, p.normalZ, p.depth);
    } else {
      p.normalX = hn::LoadU(f, tile_.normal[0].data() + o),
      p.normalY = hn::LoadU(f, tile_.normal[1].data() + o);
      p.normalZ = hn::LoadU(f, tile_.normal[2].data() + o), p.depth = hn::LoadU(f, tile_.depth.data() + o);
    }
    return p;
  }

  // The pixels in `lanes` show a material that has one base colour; over background, the others are written as such.
  HWY_INLINE void shadePlain(const Material& m, int x, int y, MI lanes, bool overBackground = false) {
    if (!isSole_ || context_.frame.encoding != Encoding::kNone)
      return lightPlain(m, x, y, lanes, overBackground);
    shaded_ += hn::CountTrue(I(), lanes);
    const Color color = lighting_.litColor<true>(pointAt(x, y), m, plainBase(m));
    const VI pixels = packedOf(color, hn::Set(I(), 255), Encoding::kNone);
    write(pixels, pixelAt(x, y), lanes, overBackground);
  }

  // The same where lights or encoding take longer: the points wait to be encoded together, a chain of roots of its own.
  HWY_NOINLINE void lightPlain(const Material& m, int x, int y, MI lanes, bool overBackground) {
    const F f;
    setMaterial(m, Base::kLit);
    const std::size_t n = keepPlace(x, y, lanes, overBackground);
    const PointVector p = pointAt(x, y);
    const Color base = plainBase(m);
    const Color color = isSole_   ? lighting_.litColor<true>(p, m, base)
                        : m.unlit ? base
                                  : lighting_.litColor<false>(p, m, base);
    hn::Store(color.r, f, points_.color[0] + n);
    hn::Store(color.g, f, points_.color[1] + n);
    hn::Store(color.b, f, points_.color[2] + n);
  }

  HWY_INLINE static Color plainBase(const Material& m) {
    const F f;
    return {hn::Set(f, m.baseColor.x), hn::Set(f, m.baseColor.y), hn::Set(f, m.baseColor.z)};
  }

  // Where the next vector of waiting points goes: returns its place among them.
  HWY_INLINE std::size_t keepPlace(int x, int y, MI lanes, bool overBackground) {
    if (points_.count == PointBatch::kSize) flush();
    const std::size_t n = points_.count;
    const unsigned bits = bitsOf(lanes);
    places_[n / kLanes] = {pixelAt(x, y), bits, overBackground};
    shaded_ += static_cast<std::size_t>(std::popcount(bits));
    points_.count = n + kLanes;
    return n;
  }

  // Adds the pixels in `lanes` to the points waiting to be shaded, as above.
  HWY_INLINE std::size_t push(int x, int y, MI lanes, bool overBackground = false) {
    const F f;
    const std::size_t n = keepPlace(x, y, lanes, overBackground);
    const PointVector p = pointAt(x, y);
    hn::Store(p.rayX, f, points_.rayX + n);
    hn::Store(p.rayY, f, points_.rayY + n);
    hn::Store(p.normalX, f, points_.normal[0] + n);
    hn::Store(p.normalY, f, points_.normal[1] + n);
    hn::Store(p.normalZ, f, points_.normal[2] + n);
    hn::Store(p.depth, f, points_.depth + n);
    return n;
  }

  // Shades the points that wait, and writes them.
  void flush() {
    if (points_.count == 0) return;
    if (base_ == Base::kTextured) {
      setTexcoords();
      addTexels<false>(*material_, texture_, points_);
    } else if (base_ == Base::kColored && material_->baseColorTexture != nullptr) {
      addTexels<true>(*material_, texture_, points_);
    }
    if (base_ != Base::kLit) shadePoints(points_, *material_, lighting_);
    if (context_.frame.encoding == Encoding::kSrgb)
      writePoints<Encoding::kSrgb>();
    else
      writePoints<Encoding::kNone>();
    points_.count = 0;
  }

  template <Encoding kEncoding>
  void writePoints() const {
    const F f;
    const VI opaque = hn::Set(I(), 255);
    for (std::size_t i = 0; i < points_.count; i += kLanes) {
      const Color color{hn::Load(f, points_.color[0] + i), hn::Load(f, points_.color[1] + i),
                        hn::Load(f, points_.color[2] + i)};
      const Place& at = places_[i / kLanes];
      write(packedOf(color, opaque, kEncoding), at.to, lanesOf(at.lanes), at.overBackground);
    }
  }

  struct Place {
    std::uint8_t* to;
    unsigned lanes;
    bool overBackground;
  };

  HWY_INLINE void write(VI color, std::uint8_t* to, MI lanes, bool overBackground) const {
    const I d;
    if (!overBackground) return storePixels(color, lanes, to);
    hn::StoreU(hn::IfThenElse(lanes, color, hn::Set(d, background_)), d, reinterpret_cast<std::int32_t*>(to));
  }

  // 1/q of points.
  HWY_INLINE VF distancesOf(std::size_t n) const {
    const F f;
    const VF one = hn::Set(f, 1.0F);
    return context_.map.perspective ? hn::Div(one, hn::Load(f, points_.depth + n)) : one;
  }

  // The same for a tile's one textured material.
  HWY_INLINE void pushTextured(int x, int y, VI ids, MI seen, bool overBackground = false) {
    const I d;
    const std::size_t n = push(x, y, seen, overBackground);
    hn::Store(ids, d, ids_ + n);
    const MI starts = hn::And(startsOf(ids), hn::Gt(ids, hn::Set(d, -1)));
    runs_[n / kLanes] = {tile_.left + x, tile_.top + y, bitsOf(starts)};
  }

  // Texture coordinates of points pushed so. Triangles are runs of pixels: the planes of each go to all lanes from its
  // first on, where later ones replace them.
  void setTexcoords() {
    const I d;
    const TexturePlanes* const planes = tile_.texturePlanes.data();
    for (std::size_t i = 0; i < points_.count; i += kLanes) {
      TexcoordVector texcoords;
      const Runs& runs = runs_[i / kLanes];
      for (unsigned left = runs.starts; left != 0; left &= left - 1) {
        const auto first = static_cast<std::size_t>(std::countr_zero(left));
        texcoords.set(planes[ids_[i + first]], hn::Not(hn::FirstN(d, first)));
      }
      texcoords.store(material_->baseColorTexture->data(), centersFrom(runs.x),
                      hn::Set(d, runs.y * kSubpixels + kOneSample[0].y), distancesOf(i), texture_, i);
    }
  }

  // The same for the triangles' own materials; returns the pixels that are left to the definition.
  MI pushByMaterial(int x, int y, VI ids, MI seen) {
    const I d;
    const F f;
    const VI px = centersFrom(tile_.left + x);
    const std::int32_t py = (tile_.top + y) * kSubpixels + kOneSample[0].y;
    alignas(64) std::uint32_t row[kLanes];
    hn::Store(ids, d, reinterpret_cast<std::int32_t*>(row));
    MI complex = hn::FirstN(d, 0);
    for (MI todo = seen; !hn::AllFalse(d, todo);) {
      const std::uint32_t first = row[static_cast<std::size_t>(hn::FindFirstTrue(d, todo))];
      const Material* const material = tile_.surfaceOf(tile_.records[first]).material;
      MI mine = hn::FirstN(d, 0);
      bool plain = true;
      AttributeVector attributes;
      forTriangles(row, ids, todo, [&](std::uint32_t id, MI same) {
        Record& record = tile_.records[id];
        const Surface surface = tile_.surfaceOf(record);
        if (surface.material != material) return;
        mine = hn::Or(mine, same);
        if (isComplex(*material) || (material->baseColorTexture == nullptr && !surface.hasColors)) return;
        plain = false;
        attributes.set(record, attributesOf(tile_, record), material->baseColorTexture != nullptr,
                       surface.hasColors, py, hn::RebindMask(f, same));
      });
      todo = hn::AndNot(mine, todo);
      if (isComplex(*material)) {
        complex = hn::Or(complex, mine);
        continue;
      }
      if (plain) {
        shadePlain(*material, x, y, mine);
        continue;
      }
      setMaterial(*material, Base::kColored);
      const std::size_t n = push(x, y, mine);
      const VF w = distancesOf(n);
      setBase(*material, attributes.color(px, w), points_, n);
      if (material->baseColorTexture != nullptr)
        storeFootprint(material->baseColorTexture->data(),
                       attributes.footprint(px, w, context_.map.perspective), texture_, n);
    }
    return complex;
  }

  // Calls body(number of the record, lanes) for every triangle that is seen in some lanes of a block.
  template <class Body>
  HWY_INLINE void forTriangles(const std::uint32_t* row, VI ids, MI seen, const Body& body) {
    const I d;
    while (!hn::AllFalse(d, seen)) {
      const std::uint32_t id = row[static_cast<std::size_t>(hn::FindFirstTrue(d, seen))];
      const MI same = hn::And(hn::Eq(ids, hn::Set(d, static_cast<std::int32_t>(id))), seen);
      seen = hn::AndNot(same, seen);
      body(id, same);
    }
  }

  Tile& tile_;
  const FrameContext& context_;
  Lighting lighting_;
  std::int32_t background_;
  Fragments fragments_;
  std::size_t samples_ = context_.samples.size(), shaded_ = 0;

  Shown shown_[Tile::kCellHeight];

  // Points waiting to be shaded, all of one material.
  const Material* material_ = nullptr;
  bool isSole_ =
      tile_.plainMaterial != nullptr && lighting_.isSole(*tile_.plainMaterial) && !tile_.plainMaterial->unlit;
  alignas(64) float rayX_[128 + 16], rayY_[64 + 16];  // of the tile's columns and rows
  Base base_ = Base::kColored;
  PointBatch points_;
  TextureBatch texture_;
  Place places_[PointBatch::kSize / kLanes];
  // Of a tile's one textured material: triangles, the vectors' first pixels in the window, and where triangles begin in them.
  struct Runs {
    std::int32_t x, y;
    unsigned starts;
  };
  alignas(64) std::int32_t ids_[PointBatch::kSize];
  Runs runs_[PointBatch::kSize / kLanes];
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
