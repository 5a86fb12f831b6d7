// Based on: glTF 2.0 specification, section 3.9 "Materials" and appendix B, KHR_materials_unlit,
// KHR_materials_emissive_strength, KHR_texture_transform; B. Walter et al., "Microfacet models for refraction through
// rough surfaces", EGSR 2007 (the Blinn–Phong exponent of a roughness).
// Differs in: Blinn–Phong stands in for the microfacet model, see docs/materials.md; one transform of texture coordinates
// per material; metallic-roughness and occlusion textures are left out.
#include "apps/scene/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "apps/scene/gltf_texture.h"
#include "raster/base/elementary.h"

namespace limn::scene {
namespace {

/// Rows of the matrix that KHR_texture_transform describes: offset · rotation · scale.
struct TexcoordTransform {
  glm::vec3 row0{1.0f, 0.0f, 0.0f}, row1{0.0f, 1.0f, 0.0f};
  bool operator==(const TexcoordTransform&) const = default;
};

double numberOr(const tinygltf::Value& object, const char* name, double otherwise) {
  return object.Has(name) ? object.Get(name).GetNumberAsDouble() : otherwise;
}

glm::dvec2 pairOr(const tinygltf::Value& object, const char* name, const glm::dvec2& otherwise) {
  if (!object.Has(name)) return otherwise;
  const tinygltf::Value& pair = object.Get(name);
  return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

TexcoordTransform transformOf(const tinygltf::ExtensionMap& extensions) {
  const auto found = extensions.find("KHR_texture_transform");
  if (found == extensions.end()) return {};
  const glm::dvec2 offset = pairOr(found->second, "offset", {0.0, 0.0});
  const glm::dvec2 scale = pairOr(found->second, "scale", {1.0, 1.0});
  const SinCos turn = sinCos(std::clamp(numberOr(found->second, "rotation", 0.0), -1e6, 1e6));
  return {glm::vec3(turn.cos * scale.x, turn.sin * scale.y, offset.x),
          glm::vec3(-turn.sin * scale.x, turn.cos * scale.y, offset.y)};
}

class MaterialReader {
 public:
  MaterialReader(GltfDocument& document, Scene& scene)
      : document_(document), textures_(document, scene.textures) {}

  raster::Material read(std::size_t index) {
    const tinygltf::Material& source = document_.model.materials[index];
    place_ = "Material " + std::to_string(index);
    const auto& pbr = source.pbrMetallicRoughness;
    glm::vec4 base(1.0f);
    for (std::size_t c = 0; c < pbr.baseColorFactor.size() && c < 4; ++c) {
      base[static_cast<int>(c)] = static_cast<float>(std::clamp(pbr.baseColorFactor[c], 0.0, 1.0));
    }
    raster::Material material = blinnPhongOf(base, pbr.metallicFactor, pbr.roughnessFactor);
    material.unlit = source.extensions.count("KHR_materials_unlit") != 0;
    if (material.unlit) material.baseColor = base;
    material.doubleSided = source.doubleSided;
    readAlpha(source, material);
    readEmission(source, material);
    readTextures(source, material);
    return material;
  }

 private:
  static void readAlpha(const tinygltf::Material& source, raster::Material& material) {
    using raster::AlphaMode;
    if (source.alphaMode == "MASK") material.alphaMode = AlphaMode::kMask;
    if (source.alphaMode == "BLEND") material.alphaMode = AlphaMode::kBlend;
    material.alphaCutoff = static_cast<float>(source.alphaCutoff);
  }

  static void readEmission(const tinygltf::Material& source, raster::Material& material) {
    const auto strength = source.extensions.find("KHR_materials_emissive_strength");
    const double factor =
        strength == source.extensions.end() ? 1.0 : numberOr(strength->second, "emissiveStrength", 1.0);
    constexpr double kBrightest = 1e6;
    for (std::size_t c = 0; c < 3; ++c) {
      material.emissive[static_cast<int>(c)] =
          static_cast<float>(std::clamp(source.emissiveFactor[c] * factor, 0.0, kBrightest));
    }
  }

  void readTextures(const tinygltf::Material& source, raster::Material& material) {
    using Content = raster::Texture::Content;
    const auto& pbr = source.pbrMetallicRoughness;
    hasTransform_ = false;
    material.baseColorTexture = use(pbr.baseColorTexture, Content::kSrgb);
    if (!material.unlit) {
      material.normalTexture = use(source.normalTexture, Content::kLinear);
      material.normalScale = static_cast<float>(source.normalTexture.scale);
      const bool isDark = material.emissive == glm::vec3(0.0f);
      if (!isDark) material.emissiveTexture = use(source.emissiveTexture, Content::kSrgb);
      if (pbr.metallicRoughnessTexture.index >= 0) leaveOut("the metallic-roughness texture");
      if (source.occlusionTexture.index >= 0) leaveOut("the occlusion texture");
    }
    material.texcoordRow0 = transform_.row0;
    material.texcoordRow1 = transform_.row1;
  }

  /// The texture of a slot, or null. The first slot in use decides how texture coordinates are transformed.
  template <class TextureInfo>
  const raster::Texture* use(const TextureInfo& info, raster::Texture::Content content) {
    if (info.index < 0) return nullptr;
    const raster::Texture* texture = textures_.find(info.index, content);
    if (texture == nullptr) {
      leaveOut("a texture without an image that limn reads");
      return nullptr;
    }
    const TexcoordTransform transform = transformOf(info.extensions);
    const int set = texcoordSetOf(info);
    if (hasTransform_ && (transform != transform_ || set != set_)) {
      leaveOut("that its textures have texture coordinates of their own: all have those of the first");
    } else {
      transform_ = transform;
      set_ = set;
    }
    hasTransform_ = true;
    return texture;
  }

  void leaveOut(const char* what) { document_.notice(place_ + ": left out " + what + "."); }

  GltfDocument& document_;
  TextureCache textures_;
  std::string place_;
  TexcoordTransform transform_;
  int set_ = 0;
  bool hasTransform_ = false;
};

struct Uses {
  bool drawn = false;
  bool transparentColors = false;
};

std::vector<Uses> usesOf(const Scene& scene, std::size_t materials) {
  std::vector<Uses> uses(materials);
  for (const Mesh& mesh : scene.meshes) {
    const bool transparent =
        std::any_of(mesh.colors.begin(), mesh.colors.end(), [](const glm::vec4& c) { return c.a < 1.0f; });
    for (const raster::Part& part : mesh.parts) {
      uses[part.material].drawn = true;
      uses[part.material].transparentColors |= transparent;
    }
  }
  return uses;
}

}  // namespace

raster::Material blinnPhongOf(const glm::vec4& baseColor, double metallic, double roughness) {
  metallic = std::clamp(metallic, 0.0, 1.0);
  roughness = std::clamp(roughness, 0.0, 1.0);
  const double alpha = std::max(roughness * roughness, 1e-3);
  const double exponent = std::clamp(std::floor(2.0 / (alpha * alpha) - 2.0 + 0.5), 1.0, 1024.0);
  raster::Material material;
  material.shininess = static_cast<int>(exponent);
  for (int c = 0; c < 3; ++c) {
    const double base = baseColor[c];
    const double reflectance = 0.04 * (1.0 - metallic) + base * metallic;
    material.specular[c] = static_cast<float>(std::min(reflectance * (exponent + 2.0) / 8.0, 1.0));
    material.baseColor[c] = static_cast<float>(base * (1.0 - 0.5 * metallic));
  }
  material.baseColor.a = baseColor.a;
  return material;
}

void readMaterials(GltfDocument& document, Scene& scene) {
  const std::size_t count = document.model.materials.size();
  const std::vector<Uses> uses = usesOf(scene, count + 1);
  MaterialReader reader(document, scene);
  for (std::size_t i = 0; i < count; ++i) {
    raster::Material& material = scene.materials.emplace_back();
    if (!uses[i].drawn) continue;  // its images are not read
    material = reader.read(i);
    // Blending what has no transparency costs sorting and brings nothing.
    const bool transparentTexture = material.baseColorTexture && material.baseColorTexture->hasTransparency();
    const bool isOpaque = material.baseColor.a >= 1.0f && !transparentTexture && !uses[i].transparentColors;
    if (material.alphaMode == raster::AlphaMode::kBlend && isOpaque)
      material.alphaMode = raster::AlphaMode::kOpaque;
  }
  scene.materials.push_back(blinnPhongOf(glm::vec4(1.0f), 1.0, 1.0));  // the specification's default
}

}  // namespace limn::scene
