#include "raster/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raster/base/check.h"
#include "raster/base/elementary.h"
#include "raster/texel.h"

namespace limn::raster {
namespace {

using DecodeTable = std::array<std::uint16_t, 256>;

DecodeTable decodeTable(Texture::Content content) {
  DecodeTable table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double v = static_cast<double>(i) / 255.0;
    const double linear = v <= 0.04045 ? v / 12.92 : power((v + 0.055) / 1.055, 2.4);
    table[i] = static_cast<std::uint16_t>((content == Texture::Content::kSrgb ? linear : v) * 65535.0 + 0.5);
  }
  return table;
}

// One row or column halved: each new texel is the mean of the old ones under it, by area, whatever the old
// size.
void halve(const float* in, std::int32_t from, std::size_t inStride, float* out, std::int32_t to,
           std::size_t outStride) {
  const float scale = static_cast<float>(from) / static_cast<float>(to);
  for (std::int32_t i = 0; i < to; ++i) {
    const float begin = static_cast<float>(i) * scale, end = static_cast<float>(i + 1) * scale;
    float sum[4] = {};
    for (auto k = static_cast<std::int32_t>(begin); k < from && static_cast<float>(k) < end; ++k) {
      const float part = std::min(end, static_cast<float>(k + 1)) - std::max(begin, static_cast<float>(k));
      for (std::size_t c = 0; c < 4; ++c) sum[c] += in[static_cast<std::size_t>(k) * inStride + c] * part;
    }
    for (std::size_t c = 0; c < 4; ++c) out[static_cast<std::size_t>(i) * outStride + c] = sum[c] / scale;
  }
}

// The next level of a float image, in place of it.
void shrink(std::vector<float>& image, const TextureLevel& from, const TextureLevel& to) {
  const auto fw = static_cast<std::size_t>(from.width), fh = static_cast<std::size_t>(from.height);
  const auto tw = static_cast<std::size_t>(to.width), th = static_cast<std::size_t>(to.height);
  std::vector<float> narrow(4 * tw * fh);
  for (std::size_t y = 0; y < fh; ++y)
    halve(&image[4 * fw * y], from.width, 4, &narrow[4 * tw * y], to.width, 4);
  image.resize(4 * tw * th);
  for (std::size_t x = 0; x < tw; ++x)
    halve(&narrow[4 * x], from.height, 4 * tw, &image[4 * x], to.height, 4 * tw);
}

void buildLevels(Texture::Data& d) {
  std::vector<float> image(d.texels.begin(), d.texels.end());
  while (d.levels.back().width > 1 || d.levels.back().height > 1) {
    const TextureLevel from = d.levels.back();
    const TextureLevel to{std::max(1, from.width / 2), std::max(1, from.height / 2), d.texels.size() / 4};
    shrink(image, from, to);
    for (const float v : image) d.texels.push_back(static_cast<std::uint16_t>(std::min(v + 0.5F, 65535.0F)));
    d.levels.push_back(to);
  }
}

bool usesMips(Filter filter) {
  return filter != Filter::kNearest && filter != Filter::kLinear;
}

}  // namespace

Texture::Texture(int width, int height, std::span<const std::uint8_t> rgba8, Content content,
                 const Sampler& sampler) {
  require(width >= 1 && width <= 16384 && height >= 1 && height <= 16384, "texture sizes are 1 to 16384");
  require(rgba8.size() == 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
          "rgba8 must hold 4 bytes per pixel");
  data_ = std::make_unique<Data>();
  Data& d = *data_;
  d.sampler = sampler;
  d.levels.push_back({width, height, 0});
  d.texels.reserve(rgba8.size() + rgba8.size() / 2);
  const DecodeTable color = decodeTable(content), alpha = decodeTable(Content::kLinear);
  for (std::size_t i = 0; i < rgba8.size(); ++i) {
    const bool isAlpha = i % 4 == 3;
    d.texels.push_back((isAlpha ? alpha : color)[rgba8[i]]);
    d.transparent |= isAlpha && rgba8[i] < 255;
  }
  if (usesMips(sampler.minification)) buildLevels(d);
}

Texture::~Texture() = default;
Texture::Texture(Texture&&) noexcept = default;
Texture& Texture::operator=(Texture&&) noexcept = default;

int Texture::width() const {
  return data_->levels[0].width;
}
int Texture::height() const {
  return data_->levels[0].height;
}
bool Texture::hasTransparency() const {
  return data_->transparent;
}
std::size_t Texture::memoryBytes() const {
  return data_->texels.capacity() * sizeof data_->texels[0] + data_->levels.capacity() * sizeof(TextureLevel);
}

}  // namespace limn::raster
