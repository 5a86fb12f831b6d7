// Based on: glTF 2.0 specification, sections 3.8 "Texture Data"; PNG specification, IHDR.
// Differs in: colour profiles and gamma chunks are passed over, as glTF wants it; 16-bit samples are rounded to 8.
#include "apps/scene/gltf_texture.h"

#include <stb_image.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/scene/gltf_uri.h"
#include "apps/scene/image.h"
#include "apps/scene/input_file.h"
#include "apps/scene/load.h"

namespace limn::scene {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Texels of 16 bits in all levels; a picture that is in memory as a whole while it becomes a texture; and what the JPEG
// decoder takes at most, its planes and the picture.
constexpr std::size_t kTextureBytesPerPixel = 11, kPictureBytesPerPixel = 4, kJpegBytesPerPixel = 8;
// Pictures of a single colour take no memory, but the time to find that out: a file of 64 KiB may hold 16384 x 16384 pixels.
constexpr std::size_t kBytesPerTenPlainPixels = 7;
constexpr std::size_t kLargestImageFile = std::size_t{1} << 28;

bool isPng(Bytes bytes) {
  constexpr std::uint8_t kSignature[] = {137, 80, 78, 71, 13, 10, 26, 10};
  constexpr std::size_t kHeaderEnd = 24;  // signature, chunk header, width, height
  return bytes.size() >= kHeaderEnd && std::memcmp(bytes.data(), kSignature, sizeof kSignature) == 0;
}

bool isJpeg(Bytes bytes) {
  return bytes.size() > 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

std::uint32_t bigEndian32(Bytes bytes, std::size_t at) {
  return std::uint32_t{bytes[at]} << 24 | std::uint32_t{bytes[at + 1]} << 16 |
         std::uint32_t{bytes[at + 2]} << 8 | bytes[at + 3];
}

using Pixel = std::array<std::uint8_t, 4>;

/// The colour of a PNG file whose pixels all have the same one. Stops at the first other one.
std::optional<Pixel> onlyColor(const std::string& name, Bytes bytes) {
  PngRows rows(name, bytes);
  std::vector<std::uint8_t> row(4 * static_cast<std::size_t>(rows.width()));
  Pixel first{};
  for (int y = 0; y < rows.height(); ++y) {
    rows.next(row);
    if (y == 0) std::copy_n(row.begin(), 4, first.begin());
    for (std::size_t i = 0; i < row.size(); i += 4)
      if (!std::equal(first.begin(), first.end(), &row[i])) return std::nullopt;
  }
  return first;
}

class ImageReader {
 public:
  ImageReader(GltfDocument& document, std::size_t index)
      : document_(document), image_(document.images[index]), place_(jsonPointer("images", index)) {}

  std::unique_ptr<raster::Texture> read(raster::Texture::Content content, const raster::Sampler& sampler) {
    std::vector<std::uint8_t> file;
    const Bytes bytes = find(file);
    if (isJpeg(bytes)) return readJpeg(bytes, content, sampler);
    if (!isPng(bytes)) document_.refuse(place_, "is neither PNG nor JPEG; convert it");
    return readPng(bytes, content, sampler);
  }

 private:
  Bytes find(std::vector<std::uint8_t>& file) const {
    if (image_.bufferView >= 0) return viewBytes();
    if (image_.uri.empty()) return image_.embedded;
    std::string problem;
    const std::filesystem::path path = resolveUri(image_.uri, image_.folder, problem);
    if (!problem.empty()) document_.refuse(place_ + "/uri", inQuotes(image_.uri) + " " + problem);
    std::optional<std::vector<std::uint8_t>> bytes = readFileBytes(path, kLargestImageFile);
    if (!bytes) document_.refuse(place_ + "/uri", inQuotes(image_.uri) + " cannot be read; may you read it?");
    file = std::move(*bytes);
    document_.grow(path, file.size());
    return file;
  }

  Bytes viewBytes() const {
    const auto& view = document_.model.bufferViews[static_cast<std::size_t>(image_.bufferView)];
    const GltfBuffer& buffer = document_.buffers[static_cast<std::size_t>(view.buffer)];
    if (!buffer.bytes) document_.refuse(place_ + "/bufferView", "lies in a buffer without bytes");
    return buffer.bytes->subspan(view.byteOffset, view.byteLength);
  }

  void checkSize(std::size_t width, std::size_t height) const {
    const std::size_t largest = kLargestSize;
    if (width == 0 || height == 0 || width > largest || height > largest) {
      document_.refuse(place_, "has " + std::to_string(width) + " x " + std::to_string(height) +
                                   " pixels; limn takes 1 to 16384 each way");
    }
  }

  /// Room for a texture, and while it is built for `more` bytes per pixel.
  void chargeTexture(std::size_t width, std::size_t height, std::size_t more) const {
    const std::size_t bytes = (width + 4) * (height + 4) * kTextureBytesPerPixel;  // levels have borders
    document_.checkRoom(bytes + width * height * more, place_);
    document_.charge(bytes, place_);
  }

  std::unique_ptr<raster::Texture> readPng(Bytes bytes, raster::Texture::Content content,
                                           const raster::Sampler& sampler) const {
    checkSize(bigEndian32(bytes, 16), bigEndian32(bytes, 20));
    const std::string name = document_.file() + ": " + place_ + ": the PNG file";
    PngRows rows(name, bytes);
    const std::size_t width = static_cast<std::size_t>(rows.width()),
                      height = static_cast<std::size_t>(rows.height());
    const std::size_t more = rows.isInterlaced() ? kPictureBytesPerPixel : 0;
    document_.checkRoom(width * height * more, place_);
    // Large pictures in small files have a single colour: one texel says it.
    if (const auto color = onlyColor(name, bytes)) {
      document_.charge(width * height * kBytesPerTenPlainPixels / 10, place_);
      return std::make_unique<raster::Texture>(1, 1, *color, content, sampler);
    }
    chargeTexture(width, height, more);
    return std::make_unique<raster::Texture>(
        rows.width(), rows.height(), [&rows](std::span<std::uint8_t> row) { rows.next(row); }, content,
        sampler);
  }

  std::unique_ptr<raster::Texture> readJpeg(Bytes bytes, raster::Texture::Content content,
                                            const raster::Sampler& sampler) const {
    int width = 0, height = 0, channels = 0;
    const bool fits = bytes.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max());
    const int size = fits ? static_cast<int>(bytes.size()) : 0;
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) refuseJpeg();
    const std::size_t w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    checkSize(w, h);
    document_.checkRoom(w * h * kJpegBytesPerPixel, place_);
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels) refuseJpeg();
    chargeTexture(w, h, kPictureBytesPerPixel);
    return std::make_unique<raster::Texture>(width, height, Bytes(pixels.get(), 4 * w * h), content, sampler);
  }

  [[noreturn]] void refuseJpeg() const {
    const char* reason = stbi_failure_reason();
    document_.refuse(place_,
                     std::string("is a damaged JPEG (") + (reason ? reason : "no reason given") + ")");
  }

  GltfDocument& document_;
  const GltfImage& image_;
  std::string place_;
};

raster::Wrap wrapOf(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return raster::Wrap::kClampToEdge;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? raster::Wrap::kMirroredRepeat
                                                       : raster::Wrap::kRepeat;
}

raster::Filter minificationOf(int filter) {
  switch (filter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
      return raster::Filter::kNearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      return raster::Filter::kLinear;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
      return raster::Filter::kNearestMipNearest;
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
      return raster::Filter::kLinearMipNearest;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
      return raster::Filter::kNearestMipLinear;
    default:
      return raster::Filter::kLinearMipLinear;
  }
}

raster::Sampler samplerOf(const GltfDocument& document, int sampler) {
  if (sampler < 0) return {};
  const tinygltf::Sampler& source = document.model.samplers[static_cast<std::size_t>(sampler)];
  return {wrapOf(source.wrapS), wrapOf(source.wrapT), minificationOf(source.minFilter),
          source.magFilter != TINYGLTF_TEXTURE_FILTER_NEAREST};
}

}  // namespace

const raster::Texture* TextureCache::find(int texture, raster::Texture::Content content) {
  const tinygltf::Texture& source = document_.model.textures[static_cast<std::size_t>(texture)];
  if (source.source < 0) return nullptr;
  for (const Entry& entry : entries_) {
    if (entry.image == source.source && entry.sampler == source.sampler && entry.content == content)
      return entry.texture;
  }
  textures_.push_back(ImageReader(document_, static_cast<std::size_t>(source.source))
                          .read(content, samplerOf(document_, source.sampler)));
  entries_.push_back({source.source, source.sampler, content, textures_.back().get()});
  return entries_.back().texture;
}

}  // namespace limn::scene
