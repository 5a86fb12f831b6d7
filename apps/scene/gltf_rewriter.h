// A glTF file on its way into another one: its JSON is edited as it is, so that what limn does not know survives; only
// references to accessors and buffer views are numbered anew, where glTF 2.0 says they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/scene/glb_builder.h"
#include "apps/scene/gltf_document.h"
#include "apps/scene/load.h"

namespace limn::scene {

class GltfRewriter {
 public:
  using Json = nlohmann::ordered_json;

  /// `file` must be one that loads. Borrowed.
  explicit GltfRewriter(const ModelFile& file);

  GlbBuilder& builder() { return builder_; }
  Json& root() { return builder_.root; }

  /// Brings over everything but the meshes. Pictures in files beside the model come into the GLB.
  void keepRest();
  /// Brings over the materials with their textures and pictures, and drops everything else.
  void keepMaterialsOnly();
  void keepMesh(std::size_t index);

 private:
  void setRoot(Json json);
  void keepAccessor(Json& json, const char* name);
  void keepView(Json& json, const char* name);
  void keepImages();
  void keepImage(Json& image, std::size_t index);
  int accessor(std::size_t old);
  int view(std::size_t old);

  /// A file beside the model that has come into the GLB.
  struct KeptPicture {
    int view;
    const char* mimeType;
  };

  GltfDocument document_;
  Json oldAccessors_, oldViews_;
  std::vector<int> newAccessor_, newView_;
  std::map<std::filesystem::path, KeptPicture> keptPictures_;
  GlbBuilder builder_;
};

/// The highest set of texture coordinates, 0 … 255, that a material of the document asks for.
int highestTexcoordSet(const nlohmann::ordered_json& root);

}  // namespace limn::scene
