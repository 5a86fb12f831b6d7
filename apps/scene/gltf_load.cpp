#include "apps/scene/gltf_load.h"

#include <algorithm>
#include <set>
#include <utility>

#include "apps/scene/gltf_accessor.h"
#include "apps/scene/gltf_document.h"
#include "apps/scene/gltf_material.h"
#include "apps/scene/gltf_mesh.h"
#include "apps/scene/gltf_nodes.h"
#include "apps/scene/gltf_uri.h"
#include "apps/scene/image.h"
#include "apps/scene/input_file.h"
#include "raster/base/check.h"

namespace limn::scene {
namespace {

/// What drawing a triangle takes where its mesh is refined all over.
constexpr std::size_t kBytesPerTriangle = 640;
/// As many triangles are drawn for free per byte of the model beyond the first 64 KiB: a forest is many copies of a tree.
constexpr std::size_t kFreeTrianglesPerByte = 20, kSmallFile = 64U << 10;
/// Nanoseconds of one thread that a frame may take per byte of the model: a file of 64 KiB, eight seconds.
constexpr double kEffortPerByte = 122e3;
/// Triangles that all of them together may become per byte: of 64 KiB, a million.
constexpr double kRefinedPerByte = 16.0;

/// Counts the triangles that the scene draws and charges what they take to draw: a small file may place a mesh many times.
std::size_t chargeInstances(GltfDocument& document, const Scene& scene) {
  constexpr std::size_t kBytesPerPosedVertex = sizeof(glm::vec3) * 2 + sizeof(glm::vec4);
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (!scene.inScene[i] || scene.nodes[i].mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)];
    const bool deforms = scene.nodes[i].skin >= 0 || !mesh.targets.empty();
    if (deforms) document.charge(mesh.positions.size() * kBytesPerPosedVertex, "/nodes");
    triangles += mesh.indices.size() / 3;
  }
  const std::size_t beyond = document.inputBytes() - std::min(document.inputBytes(), kSmallFile);
  const std::size_t free = beyond * kFreeTrianglesPerByte;
  document.charge((triangles - std::min(triangles, free)) * kBytesPerTriangle, "/nodes");
  return triangles;
}

/// What tells this model from another one of the same name: the hash of its file, and of those that it refers to.
std::string contentHash(const std::string& fileHash, const GltfDocument& document) {
  constexpr std::size_t kLargestImageFile = 256U << 20;
  std::string hashes = fileHash;
  std::set<const void*> hashed;  // what several name counts once, so that a small file asks for little
  for (const GltfBuffer& buffer : document.buffers)
    if (buffer.source && !buffer.source->empty() && hashed.insert(buffer.source.get()).second)
      hashes += hashBytes(buffer.source->data(), buffer.source->size());
  std::set<std::filesystem::path> pictures;
  for (const GltfImage& image : document.images) {
    if (image.uri.empty()) continue;
    std::string problem;
    const std::filesystem::path path = resolveUri(image.uri, image.folder, problem);
    if (!problem.empty()) continue;  // where it is needed, the loader refuses it
    if (!pictures.insert(path).second) continue;
    if (const auto bytes = readFileBytes(path, kLargestImageFile))
      hashes += hashBytes(bytes->data(), bytes->size());
  }
  return hashes == fileHash ? fileHash : hashBytes(hashes.data(), hashes.size());
}

}  // namespace

Scene loadGltf(const std::string& file, std::vector<std::uint8_t> bytes,
               const std::optional<std::filesystem::path>& folder, const LoadOptions& options) {
  require(options.creaseDegrees >= 0.0 && options.creaseDegrees <= 180.0,
          "the crease angle is 0 to 180 degrees");
  const std::string fileHash = hashBytes(bytes.data(), bytes.size());
  GltfDocument document(file, std::move(bytes), folder);
  checkAccessors(document);
  Scene scene;
  scene.name = file;
  scene.contentHash = contentHash(fileHash, document);
  for (std::size_t i = 0; i < document.model.meshes.size(); ++i) {
    scene.meshes.push_back(readMesh(document, i, options.creaseDegrees));
  }
  const std::vector<std::uint32_t> nodeOf = readNodes(document, scene);
  readSkins(document, nodeOf, scene);
  readAnimations(document, nodeOf, scene);
  readMaterials(document, scene);
  const std::size_t triangles = chargeInstances(document, scene);
  checkWorldTransforms(document, scene, nodeOf);
  scene.effortLimit = kEffortPerByte * static_cast<double>(std::max(document.inputBytes(), kSmallFile));
  scene.refinedLimit = kRefinedPerByte * static_cast<double>(std::max(document.inputBytes(), kSmallFile));
  scene.notices = std::move(document.notices);
  if (triangles == 0) scene.notices.emplace_back("The file holds no triangles to draw.");
  return scene;
}

}  // namespace limn::scene
