#include "apps/scene/gltf_fitted.h"

#include <cmath>

#include "apps/scene/gltf_accessor.h"
#include "silhouette/topology.h"

namespace limn::scene {
namespace {

/// Normalized signed bytes, three to an element; empty where the accessor holds something else.
std::vector<StoredVector> readVectors(GltfDocument& document, int accessor) {
  const AccessorReader reader(document, accessor);
  if (reader.componentType() != GlbBuilder::kByte || reader.components() != 3 || !reader.normalized())
    return {};
  document.charge(reader.count() * sizeof(StoredVector), reader.place());
  std::vector<StoredVector> vectors(reader.count());
  std::array<float, 3> values{};
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    reader.read(i, 3, values.data());
    for (std::size_t k = 0; k < 3; ++k)
      vectors[i][k] = static_cast<std::int8_t>(std::lround(127.0f * values[k]));
  }
  return vectors;
}

glm::vec3 scaleOf(const tinygltf::Value& value) {
  glm::vec3 scale(0.0f);
  for (int k = 0; k < 3; ++k) scale[k] = static_cast<float>(value.Get(k).GetNumberAsDouble());
  return scale;
}

std::vector<std::uint8_t> bytesOf(const std::vector<StoredVector>& vectors) {
  std::vector<std::uint8_t> bytes;
  for (const StoredVector& vector : vectors)
    for (const std::int8_t step : vector) bytes.push_back(static_cast<std::uint8_t>(step));
  return bytes;
}

}  // namespace

void readFittedCurves(GltfDocument& document, std::size_t index, std::span<const glm::vec3> corners,
                      Mesh& mesh) {
  const tinygltf::ExtensionMap& extensions = document.model.meshes[index].extensions;
  const auto found = extensions.find(kFittedCurvesName);
  if (found == extensions.end()) return;
  const tinygltf::Value& json = found->second;
  StoredCurves curves;
  curves.ends = readVectors(document, json.Get("ends").GetNumberAsInt());
  curves.centers = readVectors(document, json.Get("centers").GetNumberAsInt());
  curves.endScale = scaleOf(json.Get("endScale"));
  curves.centerScale = scaleOf(json.Get("centerScale"));

  const silhouette::Mesh shape{mesh.positions, mesh.normals, mesh.indices};
  const bool whole = json.Get("key").Get<std::string>() == curvesKey(curves, corners);
  if (whole && !curves.empty() && fits(curves, shape, silhouette::Topology(shape))) {
    mesh.curves = std::move(curves);
    return;
  }
  document.notice("Mesh " + std::to_string(index) +
                  ": its fitted curves do not belong to its triangles, or are damaged, and were left out; "
                  "coarsen it again.");
}

nlohmann::ordered_json writeFittedCurves(GlbBuilder& builder, const StoredCurves& curves,
                                         std::span<const glm::vec3> corners) {
  const auto add = [&](const std::vector<StoredVector>& vectors) {
    return builder.addAccessor(builder.addView(bytesOf(vectors), GlbBuilder::kNoTarget), GlbBuilder::kByte,
                               "VEC3", vectors.size(), true);
  };
  // Doubles of the floats print so that they read back as the same floats.
  const auto scale = [](const glm::vec3& v) { return std::array<double, 3>{v.x, v.y, v.z}; };
  const int ends = add(curves.ends), centers = add(curves.centers);
  return {{"ends", ends},
          {"endScale", scale(curves.endScale)},
          {"centers", centers},
          {"centerScale", scale(curves.centerScale)},
          {"key", curvesKey(curves, corners)}};
}

}  // namespace limn::scene
