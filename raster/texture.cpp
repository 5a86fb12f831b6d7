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

// Where the levels of a picture are, all of them or the first, and room for their texels.
void layOut(Texture::Data& d, std::int32_t width, std::int32_t height, bool mips) {
  for (std::int32_t first = 0;; width = std::max(1, width / 2), height = std::max(1, height / 2)) {
    const TextureLevel level{width, height, first};
    const std::size_t i = d.levels.size();
    d.tables.width[i] = static_cast<float>(width), d.tables.height[i] = static_cast<float>(height);
    d.tables.lastColumn[i] = width - 1, d.tables.lastRow[i] = height - 1;
    d.tables.stride[i] = level.stride(), d.tables.origin[i] = level.texel(0, 0);
    d.levels.push_back(level);
    first += level.texelCount();
    if (!mips || (width == 1 && height == 1)) break;
  }
  d.texels.resize(4 * static_cast<std::size_t>(d.levels.back().first + d.levels.back().texelCount()));
}

// Each texel of a level is the mean of those under it in the one before, by area, whatever the size; row after row, so
// that nothing but the texels themselves takes memory.
void fillLevel(Texture::Data& d, const TextureLevel& from, const TextureLevel& to) {
  const float area = static_cast<float>(from.width) / static_cast<float>(to.width) *
                     (static_cast<float>(from.height) / static_cast<float>(to.height));
  std::vector<float> sum(4 * static_cast<std::size_t>(to.width));
  for (std::int32_t y = 0; y < to.height; ++y) {
    std::fill(sum.begin(), sum.end(), 0.0F);
    const Span under(y, from.height, to.height);
    for (std::int32_t k = under.first; k < from.height && under.holds(k); ++k)
      addNarrowed(d.at(from, 0, k), from.width, to.width, under.partOf(k), sum.data());
    std::transform(sum.begin(), sum.end(), d.at(to, 0, y), [area](float v) {
      return static_cast<std::uint16_t>(std::min(v / area + 0.5F, 65535.0F));
    });
  }
}

// Fills the border of a level whose texels are there.
void fillBorder(Texture::Data& d, const TextureLevel& l) {
  const auto copy = [&](std::int32_t toColumn, std::int32_t toRow, std::int32_t column, std::int32_t row,
                        std::int32_t count) {
    std::copy_n(d.at(l, column, row), 4 * count, d.at(l, toColumn, toRow));
  };
  const bool aroundU = d.sampler.wrapU == Wrap::kRepeat, aroundV = d.sampler.wrapV == Wrap::kRepeat;
  for (std::int32_t y = 0; y < l.height; ++y) {
    copy(-1, y, aroundU ? l.width - 1 : 0, y, 1);
    copy(l.width, y, aroundU ? 0 : l.width - 1, y, 1);
  }
  copy(-1, -1, -1, aroundV ? l.height - 1 : 0, l.stride());
  copy(-1, l.height, -1, aroundV ? 0 : l.height - 1, l.stride());
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
  layOut(d, width, height, usesMips(sampler.minification));
  const DecodeTable color = decodeTable(content), alpha = decodeTable(Content::kLinear);
  std::vector<std::uint8_t> row(4 * static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    nextRow(row);
    std::uint16_t* texels = d.at(d.levels[0], 0, y);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool isAlpha = i % 4 == 3;
      texels[i] = (isAlpha ? alpha : color)[row[i]];
      d.transparent |= isAlpha && row[i] < 255;
    }
  }
  for (std::size_t i = 1; i < d.levels.size(); ++i) fillLevel(d, d.levels[i - 1], d.levels[i]);
  for (const TextureLevel& level : d.levels) fillBorder(d, level);
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
