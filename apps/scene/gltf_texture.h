// Images of a glTF file, decoded once per use.
#pragma once

#include <memory>
#include <vector>

#include "apps/scene/gltf_document.h"
#include "raster/texture.h"

namespace limn::scene {

/// The set of texture coordinates that a slot wants, KHR_texture_transform's choice before its own.
template <class TextureInfo>
int texcoordSetOf(const TextureInfo& info) {
  const auto transform = info.extensions.find("KHR_texture_transform");
  const bool overrides = transform != info.extensions.end() && transform->second.Has("texCoord");
  return overrides ? transform->second.Get("texCoord").GetNumberAsInt() : info.texCoord;
}

/// Decodes textures into `textures`; those with the same image, sampler and content are one.
class TextureCache {
 public:
  TextureCache(GltfDocument& document, std::vector<std::unique_ptr<raster::Texture>>& textures)
      : document_(document), textures_(textures) {}

  /// Texture `texture` of the file, null where it has no image. Throws InputError with the place for images that cannot be
  /// read, are neither PNG nor JPEG, damaged, larger than 16384 pixels, or too large for the file.
  const raster::Texture* find(int texture, raster::Texture::Content content);

 private:
  struct Entry {
    int image, sampler;
    raster::Texture::Content content;
    const raster::Texture* texture;
  };

  GltfDocument& document_;
  std::vector<std::unique_ptr<raster::Texture>>& textures_;
  std::vector<Entry> entries_;
};

}  // namespace limn::scene
