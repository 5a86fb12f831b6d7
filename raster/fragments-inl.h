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
      : tile_(tile),
        context_(*tile.context),
        lighting_(lighting),
        samples_(static_cast<int>(context_.samples.size())) {}

  /// Adds a pixel of the tile; false: it has a material that is left to the definition.
  bool add(int x, int y) {
    std::uint32_t ids[kMaxSamples];
    for (int s = 0; s < samples_; ++s) {
      ids[s] = tile_.ids[tile_.offset(s, x, y)];
      if (tile_.plainMaterial == nullptr && ids[s] != kNoRecord &&
          isComplex(*tile_.surfaceOf(tile_.records[ids[s]]).material))
        return false;
    }
    if (pixels_ == kPixels) finish();
    const std::size_t pixel = pixels_++;
    at_[pixel] = {x, y};
    for (int i = 0; i < 3; ++i) sum_[i][pixel] = 0.0F;
    int empty = 0;
    for (unsigned left = (1U << samples_) - 1U; left != 0;) {
      const int s = std::countr_zero(left);
      unsigned mask = 0;
      for (int k = s; k < samples_; ++k) mask |= static_cast<unsigned>(ids[k] == ids[s]) << k;
      left &= ~mask;
      if (ids[s] == kNoRecord)
        empty = std::popcount(mask);
      else
        push(pixel, ids[s], s, std::popcount(mask));
    }
    empty_[pixel] = static_cast<float>(empty);
    return true;
  }

  /// Shades what is left and writes all pixels that were added.
  void finish() {
    flush();
    for (std::size_t i = 0; i < pixels_; i += kLanes) write(i);
    tile_.statistics.pixelsCovered += pixels_;
    pixels_ = 0;
  }

 private:
  static constexpr std::size_t kPixels = 256;

  void push(std::size_t pixel, std::uint32_t id, int sample, int count) {
    const Material* material = tile_.plainMaterial;
    if (material == nullptr) material = tile_.surfaceOf(tile_.records[id]).material;
    if (count_ == kLanes || (count_ > 0 && material != material_)) flush();
    material_ = material;
    const SamplePosition first = context_.samples[static_cast<std::size_t>(sample)];
    const std::int32_t px = (tile_.left + at_[pixel].x) * kSubpixels,
                       py = (tile_.top + at_[pixel].y) * kSubpixels;
    px_[count_] = px, py_[count_] = py;
    sampleX_[count_] = px + first.x, sampleY_[count_] = py + first.y;
    const Corners& c = tile_.corners[id];
    for (int k = 0; k < 3; ++k) cornerX_[k][count_] = c.x[k], cornerY_[k][count_] = c.y[k];
    id_[count_] = id;
    pixel_[count_] = pixel;
    weight_[count_] = static_cast<float>(count) / static_cast<float>(samples_);
    ++count_;
  }

  // shadingPoint(): the pixel's centre where the triangle covers it, else the first sample.
  void placePoints() {
    const I d;
    VI x[3], y[3];
    for (int k = 0; k < 3; ++k) x[k] = hn::Load(d, cornerX_[k]), y[k] = hn::Load(d, cornerY_[k]);
    const VI cx = hn::Add(hn::Load(d, px_), hn::Set(d, kOneSample[0].x));
    const VI cy = hn::Add(hn::Load(d, py_), hn::Set(d, kOneSample[0].y));
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
    hn::Store(hn::IfThenElse(covered, cx, hn::Load(d, sampleX_)), d, px_);
    hn::Store(hn::IfThenElse(covered, cy, hn::Load(d, sampleY_)), d, py_);
    // Edges too long for 32 bits.
    const MI large = hn::And(hn::Gt(extent, hn::Set(d, 1 << 14)), hn::FirstN(d, count_));
    for (unsigned left = bitsOf(large); left != 0; left &= left - 1)
      placePoint(static_cast<std::size_t>(std::countr_zero(left)));
  }

  void placePoint(std::size_t i) {
    const SamplePosition at = at_[pixel_[i]].position(tile_);
    const bool covered = covers(tile_.corners[id_[i]], at.x, at.y);
    px_[i] = covered ? at.x : sampleX_[i];
    py_[i] = covered ? at.y : sampleY_[i];
  }

  void flush() {
    if (count_ == 0) return;
    const F f;
    const I d;
    const F4 f4;
    placePoints();
    alignas(64) float planes[kLanes][4] = {};
    for (std::size_t i = 0; i < count_; ++i) {
      const Record& r = tile_.records[id_[i]];
      const auto dx = hn::Set(f4, static_cast<float>(px_[i] - r.x0)),
                 dy = hn::Set(f4, static_cast<float>(py_[i] - r.y0));
      const auto start = hn::Add(hn::Load(f4, r.origin), hn::Mul(hn::Load(f4, r.slopeY), dy));
      hn::Store(hn::Add(start, hn::Mul(hn::Load(f4, r.slopeX), dx)), f4, planes[i]);
    }
    for (std::size_t i = count_; i < kLanes; ++i) planes[i][3] = 1.0F;
    VF nx, ny, nz, depth;
    hn::LoadInterleaved4(f, planes[0], nx, ny, nz, depth);
    hn::Store(nx, f, points_.normal[0]), hn::Store(ny, f, points_.normal[1]),
        hn::Store(nz, f, points_.normal[2]);
    hn::Store(depth, f, points_.depth);
    hn::Store(lighting_.rayX(hn::Load(d, px_)), f, points_.rayX);
    hn::Store(lighting_.rayY(hn::Load(d, py_)), f, points_.rayY);
    setBase();
    points_.count = kLanes;
    shadePoints(points_, *material_, lighting_);
    const VF weight = hn::Load(f, weight_);
    alignas(64) float out[3][kLanes];
    for (int k = 0; k < 3; ++k) hn::Store(hn::Mul(hn::Load(f, points_.color[k]), weight), f, out[k]);
    for (std::size_t i = 0; i < count_; ++i)
      for (int k = 0; k < 3; ++k) sum_[k][pixel_[i]] += out[k][i];
    tile_.statistics.pixelsShaded += count_;
    count_ = 0;
  }

  // Base colours, with vertex colours and texels where the material or a mesh has them.
  void setBase() {
    const F f;
    const VF one = hn::Set(f, 1.0F), zero = hn::Zero(f);
    bool needed = material_->baseColorTexture != nullptr;
    if (tile_.plainMaterial == nullptr)
      for (std::size_t i = 0; i < count_; ++i) needed |= tile_.surfaceOf(tile_.records[id_[i]]).hasColors;
    Color vertex{one, one, one};
    FootprintVector footprint{zero, zero, zero, zero, zero, zero};
    if (needed) interpolate(vertex, footprint);
    const Color base = baseOf(*material_, vertex, footprint);
    hn::Store(base.r, f, points_.base[0]);
    hn::Store(base.g, f, points_.base[1]);
    hn::Store(base.b, f, points_.base[2]);
  }

  void interpolate(Color& vertex, FootprintVector& footprint) const {
    const F f;
    alignas(64) float v[9][kLanes] = {};
    for (std::size_t i = 0; i < count_; ++i) {
      Record& record = tile_.records[id_[i]];
      const PointAttributes a = attributesAt(tile_, record, {px_[i], py_[i]});
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
  void write(std::size_t i) {
    const F f;
    const glm::vec4& b = context_.frame.background;
    const float all = static_cast<float>(samples_);
    const VF share = hn::Div(hn::Load(f, empty_ + i), hn::Set(f, all));
    const VF under = hn::Mul(hn::Set(f, b.w), share);
    const VF opaque = hn::Div(hn::Sub(hn::Set(f, all), hn::Load(f, empty_ + i)), hn::Set(f, all));
    const VF alpha = hn::Add(opaque, under);
    const VF scale = hn::IfThenElseZero(hn::Gt(alpha, hn::Zero(f)), hn::Div(hn::Set(f, 1.0F), alpha));
    const auto channel = [&](int k, float background) {
      return hn::Mul(hn::Add(hn::Load(f, sum_[k] + i), hn::Mul(hn::Set(f, background), under)), scale);
    };
    const VI packed =
        packedOf({channel(0, b.x), channel(1, b.y), channel(2, b.z)}, byteOf(alpha), context_.frame.encoding);
    alignas(64) std::uint8_t bytes[4 * kLanes];
    const hn::Repartition<std::uint8_t, I> d8;
    hn::Store(hn::BitCast(d8, packed), d8, bytes);
    for (std::size_t k = 0; k < kLanes && i + k < pixels_; ++k) {
      const Pixel& p = at_[i + k];
      const std::size_t row = static_cast<std::size_t>(tile_.top + p.y) * context_.target.rgbaStride;
      std::uint8_t* to = context_.target.rgba + row + static_cast<std::size_t>(tile_.left + p.x) * 4;
      std::copy(bytes + 4 * k, bytes + 4 * k + 4, to);
    }
  }

  struct Pixel {
    int x, y;
    SamplePosition position(const Tile& tile) const {
      return {(tile.left + x) * kSubpixels + kOneSample[0].x, (tile.top + y) * kSubpixels + kOneSample[0].y};
    }
  };

  Tile& tile_;
  const FrameContext& context_;
  const Lighting& lighting_;
  int samples_;

  // Fragments waiting to be shaded, all of one material.
  const Material* material_ = nullptr;
  std::size_t count_ = 0;
  alignas(64) std::int32_t px_[kLanes] = {}, py_[kLanes] = {}, sampleX_[kLanes] = {}, sampleY_[kLanes] = {};
  alignas(64) std::int32_t cornerX_[3][kLanes] = {}, cornerY_[3][kLanes] = {};
  alignas(64) float weight_[kLanes] = {};
  std::uint32_t id_[kLanes] = {};
  std::size_t pixel_[kLanes] = {};

  PointBatch points_;

  // Pixels and the sums of their fragments so far.
  std::size_t pixels_ = 0;
  Pixel at_[kPixels];
  alignas(64) float sum_[3][kPixels + 16], empty_[kPixels + 16];
};
#endif

}  // namespace HWY_NAMESPACE
}  // namespace limn::raster
HWY_AFTER_NAMESPACE();
#endif
