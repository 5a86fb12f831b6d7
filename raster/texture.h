// Images as the rasterizer samples them: a mip chain with wrap modes and a filter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

namespace limn::raster {

enum class Wrap { kRepeat, kMirroredRepeat, kClampToEdge };
enum class Filter {
  kNearest,
  kLinear,  ///< bilinear, base level only
  kNearestMipNearest,
  kLinearMipNearest,  ///< bilinear in the nearest level
  kNearestMipLinear,
  kLinearMipLinear,  ///< trilinear
};

struct Sampler {
  Wrap wrapU = Wrap::kRepeat, wrapV = Wrap::kRepeat;
  Filter minification = Filter::kLinearMipLinear;
  bool linearMagnification = true;
};

class Texture {
 public:
  enum class Content { kSrgb, kLinear };  ///< colours decoded from sRGB, or numbers as they are (normal maps)

  /// `rgba8`: width · height pixels, first row is v = 0. Any size from 1×1 to 16384×16384, not only powers of
  /// two. Throws std::invalid_argument for other sizes or a span of the wrong length.
  Texture(int width, int height, std::span<const std::uint8_t> rgba8, Content content,
          const Sampler& sampler);
  /// The same from rows that are made one after the other, so that the picture need not be in memory as well:
  /// `nextRow` fills in the next one, of 4 · width bytes, from the first on.
  Texture(int width, int height, const std::function<void(std::span<std::uint8_t> row)>& nextRow,
          Content content, const Sampler& sampler);
  ~Texture();
  Texture(Texture&&) noexcept;
  Texture& operator=(Texture&&) noexcept;

  int width() const;
  int height() const;
  bool hasTransparency() const;  ///< some alpha below 255
  std::size_t memoryBytes() const;

  struct Data;
  const Data& data() const { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

}  // namespace limn::raster
