// Any bytes as a model: loaded or refused, never anything else, and posed without a number that is none.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "apps/scene/gltf_load.h"
#include "apps/scene/pose.h"

namespace {

using namespace limn::scene;

void check(bool holds) {
  if (!holds) std::abort();
}

void checkPose(const Scene& scene, const Pose& pose) {
  for (const Instance& instance : pose.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    check(!instance.deformed() || instance.positions.size() == mesh.positions.size());
    for (const glm::vec3& p : instance.positions) check(std::isfinite(p.x + p.y + p.z));
    for (const glm::vec3& n : instance.normals) check(std::isfinite(n.x + n.y + n.z));
  }
  check(std::isfinite(boundingSphere(scene, pose).radius));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const Scene scene = loadGltf("fuzz", std::vector<std::uint8_t>(data, data + size), std::nullopt, {});
    for (const Mesh& mesh : scene.meshes) {
      check(mesh.normals.size() == mesh.positions.size());
      for (const std::uint32_t i : mesh.indices) check(i < mesh.positions.size());
    }
    Pose pose;
    evaluatePose(scene, -1, 0.0, pose);
    checkPose(scene, pose);
    for (int a = 0; a < static_cast<int>(scene.animations.size()) && a < 4; ++a) {
      evaluatePose(scene, a, scene.animations[static_cast<std::size_t>(a)].duration / 3, pose);
      checkPose(scene, pose);
    }
  } catch (const InputError&) {
    // refused, as it should be
  }
  return 0;
}
