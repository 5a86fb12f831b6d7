#include "apps/scene/stored_curves.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "apps/scene/image.h"
#include "raster/base/check.h"

namespace limn::scene {
namespace {

constexpr float kSteps = 127.0f;

std::int8_t nearestStep(float value, float scale) {
  if (!(scale > 0.0f)) return 0;
  const float c = std::sqrt(std::min(std::abs(value) / scale, 1.0f));
  // Rounding c is not rounding c²: the better of the two neighbours counts.
  const float below = std::floor(c * kSteps), above = std::min(below + 1.0f, kSteps);
  const float wanted = std::abs(value) / scale * (kSteps * kSteps);
  const float step = wanted - below * below <= above * above - wanted ? below : above;
  return static_cast<std::int8_t>(value < 0.0f ? -step : step);
}

float valueOf(std::int8_t step, float scale) {
  const float c = static_cast<float>(step) / kSteps;
  return scale * (c * std::abs(c));
}

}  // namespace

glm::vec3 decode(const StoredVector& stored, const glm::vec3& scale) {
  return {valueOf(stored[0], scale.x), valueOf(stored[1], scale.y), valueOf(stored[2], scale.z)};
}

StoredVector encode(const glm::vec3& value, const glm::vec3& scale) {
  return {nearestStep(value.x, scale.x), nearestStep(value.y, scale.y), nearestStep(value.z, scale.z)};
}

std::vector<StoredVector> encodeAll(std::span<const glm::vec3> values, glm::vec3& scale) {
  scale = glm::vec3(0.0f);
  for (const glm::vec3& value : values)
    for (int k = 0; k < 3; ++k)
      scale[k] = std::min(std::max(scale[k], std::abs(value[k])), silhouette::kFittedLimit);
  std::vector<StoredVector> stored;
  stored.reserve(values.size());
  for (const glm::vec3& value : values) stored.push_back(encode(value, scale));
  return stored;
}

bool fits(const StoredCurves& stored, const silhouette::Mesh& mesh, const silhouette::Topology& topology) {
  const auto inRange = [](const glm::vec3& scale) {
    for (int k = 0; k < 3; ++k)
      if (!(scale[k] >= 0.0f && scale[k] <= silhouette::kFittedLimit)) return false;
    return true;
  };
  return stored.ends.size() == 2 * topology.edges().size() && stored.centers.size() == mesh.triangleCount() &&
         inRange(stored.endScale) && inRange(stored.centerScale);
}

DecodedCurves decode(const StoredCurves& stored, const silhouette::Mesh& mesh,
                     const silhouette::Topology& topology) {
  DecodedCurves curves;
  if (stored.empty()) return curves;
  require(fits(stored, mesh, topology), "stored curves that fit the mesh");
  std::vector<bool> runsBack;
  const std::vector<std::uint32_t> order = silhouette::edgesAsFirstMet(mesh, topology, &runsBack);
  curves.edges.resize(topology.edges().size());
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t end = 0; end < 2; ++end)
      curves.edges[order[k]][runsBack[k] ? 1 - end : end] = decode(stored.ends[2 * k + end], stored.endScale);
  curves.centers.reserve(stored.centers.size());
  for (const StoredVector& center : stored.centers)
    curves.centers.push_back(decode(center, stored.centerScale));
  return curves;
}

std::string curvesKey(const StoredCurves& curves, std::span<const glm::vec3> corners) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(12 * corners.size() + 3 * (curves.ends.size() + curves.centers.size()) + 24);
  const auto append = [&](const glm::vec3& vector) {
    for (int k = 0; k < 3; ++k) {
      // -0 and 0 are one position.
      const auto bits = std::bit_cast<std::uint32_t>(vector[k] + 0.0f);
      for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
  };
  for (const glm::vec3& corner : corners) append(corner);
  append(curves.endScale);
  append(curves.centerScale);
  for (const std::vector<StoredVector>* vectors : {&curves.ends, &curves.centers})
    for (const StoredVector& vector : *vectors)
      for (const std::int8_t step : vector) bytes.push_back(static_cast<std::uint8_t>(step));
  return hashBytes(bytes.data(), bytes.size());
}

}  // namespace limn::scene
