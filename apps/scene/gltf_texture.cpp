// Based on: glTF 2.0 specification, sections 3.8 "Texture Data"; PNG specification, IHDR.
// Differs in: colour profiles and gamma chunks are passed over, as glTF wants it; 16-bit samples are rounded to 8.
#include "apps/scene/gltf_texture.h"

#include <stb_image.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "apps/scene/gltf_uri.h"
#include "apps/scene/image.h"
#include "apps/scene/load.h"

namespace limn::scene {
namespace {

using Bytes = std::span<const std::uint8_t>;

// While a texture is built: pixels of 8 bits, texels of 16 bits in all levels, and two images of floats to shrink.
constexpr std::size_t kPeakBytesPerPixel = 40;
constexpr std::size_t kLastingBytesPerPixel = 11;
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

class ImageReader {
 public:
  ImageReader(GltfDocument& document, std::size_t index)
      : document_(document), image_(document.images[index]), place_(jsonPointer("images", index)) {}

  Image read() {
    std::vector<std::uint8_t> file;
    const Bytes bytes = find(file);
    if (isPng(bytes)) {
      checkSize(bigEndian32(bytes, 16), bigEndian32(bytes, 20));
      try {
        return decodePng("the PNG file", bytes);
      } catch (const InputError& error) {
        document_.refuse(place_, error.what());
      }
    }
    if (isJpeg(bytes)) return readJpeg(bytes);
    document_.refuse(place_, "is neither PNG nor JPEG; convert it");
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
    document_.grow(file.size());
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
    document_.checkRoom(width * height * kPeakBytesPerPixel, place_);
    document_.charge(width * height * kLastingBytesPerPixel, place_);
  }

  Image readJpeg(Bytes bytes) const {
    int width = 0, height = 0, channels = 0;
    const bool fits = bytes.size() <= static_cast<std::size_t>(std::numeric_limits<int>::max());
    const int size = fits ? static_cast<int>(bytes.size()) : 0;
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) refuseJpeg();
    checkSize(static_cast<std::size_t>(width), static_cast<std::size_t>(height));
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), stbi_image_free);
    if (!pixels) refuseJpeg();
    Image image{width, height, {}};
    image.rgba.assign(pixels.get(),
                      pixels.get() + 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    return image;
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
  const Image image = ImageReader(document_, static_cast<std::size_t>(source.source)).read();
  textures_.push_back(std::make_unique<raster::Texture>(image.width, image.height, image.rgba, content,
                                                        samplerOf(document_, source.sampler)));
  entries_.push_back({source.source, source.sampler, content, textures_.back().get()});
  return entries_.back().texture;
}

}  // namespace limn::scene
