#include "apps/scene/gltf_load.h"

#include <utility>

#include "apps/scene/gltf_accessor.h"
#include "apps/scene/gltf_document.h"
#include "apps/scene/gltf_mesh.h"
#include "apps/scene/gltf_nodes.h"
#include "raster/base/check.h"

namespace limn::scene {
namespace {

std::size_t countTriangles(const Scene& scene) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (!scene.inScene[i] || scene.nodes[i].mesh < 0) continue;
    count += scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)].indices.size() / 3;
  }
  return count;
}

}  // namespace

Scene loadGltf(const std::string& file, std::vector<std::uint8_t> bytes,
               const std::optional<std::filesystem::path>& folder, const LoadOptions& options) {
  require(options.creaseDegrees >= 0.0 && options.creaseDegrees <= 180.0,
          "the crease angle is 0 to 180 degrees");
  GltfDocument document(file, std::move(bytes), folder);
  checkAccessors(document);
  Scene scene;
  scene.name = file;
  for (std::size_t i = 0; i < document.model.meshes.size(); ++i) {
    scene.meshes.push_back(readMesh(document, i, options.creaseDegrees));
  }
  const std::vector<std::uint32_t> nodeOf = readNodes(document, scene);
  readSkins(document, nodeOf, scene);
  readAnimations(document, nodeOf, scene);
  scene.materials.resize(document.model.materials.size() + 1);
  scene.notices = std::move(document.notices);
  if (countTriangles(scene) == 0) scene.notices.emplace_back("The file holds no triangles to draw.");
  return scene;
}

}  // namespace limn::scene
