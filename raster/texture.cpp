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

// Old texels [begin, end), in parts of whole ones, are under new texel i of `to` where there were `from`.
struct Span {
  float begin, end;
  std::int32_t first;

  Span(std::int32_t i, std::int32_t from, std::int32_t to) {
    const float scale = static_cast<float>(from) / static_cast<float>(to);
    begin = static_cast<float>(i) * scale;
    end = static_cast<float>(i + 1) * scale;
    first = static_cast<std::int32_t>(begin);
  }
  bool holds(std::int32_t k) const { return static_cast<float>(k) < end; }
  float partOf(std::int32_t k) const {
    return std::min(end, static_cast<float>(k + 1)) - std::max(begin, static_cast<float>(k));
  }
};

// A row of texels made narrower and added to `sum`, `weight` times.
void addNarrowed(const std::uint16_t* row, std::int32_t from, std::int32_t to, float weight, float* sum) {
  for (std::int32_t x = 0; x < to; ++x, sum += 4) {
    const Span under(x, from, to);
    for (std::int32_t k = under.first; k < from && under.holds(k); ++k) {
      const float part = under.partOf(k) * weight;
      for (int c = 0; c < 4; ++c) sum[c] += static_cast<float>(row[4 * k + c]) * part;
    }
  }
}

// Each texel of the next level is the mean of those under it, by area, whatever the size; row after row, so that
// nothing but the texels themselves takes memory.
void appendLevel(Texture::Data& d) {
  const TextureLevel from = d.levels.back();
  const TextureLevel to{std::max(1, from.width / 2), std::max(1, from.height / 2), d.texels.size() / 4};
  const float area = static_cast<float>(from.width) / static_cast<float>(to.width) *
                     (static_cast<float>(from.height) / static_cast<float>(to.height));
  std::vector<float> sum(4 * static_cast<std::size_t>(to.width));
  for (std::int32_t y = 0; y < to.height; ++y) {
    std::fill(sum.begin(), sum.end(), 0.0F);
    const Span under(y, from.height, to.height);
    for (std::int32_t k = under.first; k < from.height && under.holds(k); ++k) {
      const std::size_t row = from.first + static_cast<std::size_t>(k) * static_cast<std::size_t>(from.width);
      addNarrowed(&d.texels[4 * row], from.width, to.width, under.partOf(k), sum.data());
    }
    for (const float v : sum)
      d.texels.push_back(static_cast<std::uint16_t>(std::min(v / area + 0.5F, 65535.0F)));
  }
  d.levels.push_back(to);
}

std::size_t texelsOfAllLevels(std::size_t width, std::size_t height) {
  std::size_t texels = width * height;
  while (width > 1 || height > 1) {
    width = std::max<std::size_t>(1, width / 2);
    height = std::max<std::size_t>(1, height / 2);
    texels += width * height;
  }
  return texels;
}

bool usesMips(Filter filter) {
  return filter != Filter::kNearest && filter != Filter::kLinear;
}

}  // namespace

Texture::Texture(int width, int height, const std::function<void(std::span<std::uint8_t> row)>& nextRow,
                 Content content, const Sampler& sampler) {
  require(width >= 1 && width <= 16384 && height >= 1 && height <= 16384, "texture sizes are 1 to 16384");
  data_ = std::make_unique<Data>();
  Data& d = *data_;
  d.sampler = sampler;
  d.levels.push_back({width, height, 0});
  const std::size_t w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  const bool mips = usesMips(sampler.minification);
  d.texels.reserve(4 * (mips ? texelsOfAllLevels(w, h) : w * h));
  const DecodeTable color = decodeTable(content), alpha = decodeTable(Content::kLinear);
  std::vector<std::uint8_t> row(4 * w);
  for (int y = 0; y < height; ++y) {
    nextRow(row);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool isAlpha = i % 4 == 3;
      d.texels.push_back((isAlpha ? alpha : color)[row[i]]);
      d.transparent |= isAlpha && row[i] < 255;
    }
  }
  while (mips && (d.levels.back().width > 1 || d.levels.back().height > 1)) appendLevel(d);
}

namespace {

/// Hands out the rows of a whole picture.
std::function<void(std::span<std::uint8_t>)> rowsOf(int width, int height,
                                                    std::span<const std::uint8_t> rgba8) {
  require(width >= 1 && height >= 1 &&
              rgba8.size() == 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
          "rgba8 must hold 4 bytes per pixel");
  return [rest = rgba8](std::span<std::uint8_t> row) mutable {
    std::copy(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(row.size()), row.begin());
    rest = rest.subspan(row.size());
  };
}

}  // namespace

Texture::Texture(int width, int height, std::span<const std::uint8_t> rgba8, Content content,
                 const Sampler& sampler)
    : Texture(width, height, rowsOf(width, height, rgba8), content, sampler) {}

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
