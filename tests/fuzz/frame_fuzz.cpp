// Any mesh from any side by any method: a consistent stream, planes without a number that is none, and the same picture from
// the vector kernels and two threads as from the scalar ones and one.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "apps/scene/load.h"
#include "raster/raster.h"
#include "tests/fuzz/frame_input.h"

namespace {

using namespace limn;

void check(bool holds) {
  if (!holds) std::abort();
}

struct Drawn {
  scene::Image image;
  scene::Planes planes;

  Drawn(const fuzz::HostileFrame& frame, int threads, const raster::Tuning& tuning) {
    planes.wantsDepth = planes.wantsNormals = planes.wantsIds = true;
    scene::FrameDrawer drawer(frame.scene, threads, tuning);
    drawer.draw(frame.pose, frame.camera, frame.settings, image, nullptr, &planes);
    for (std::size_t i = 0; i < frame.pose.instances.size(); ++i)
      if (frame.pose.instances[i].visible) {
        const scene::RefinedInstance instance = drawer.instance(i);
        check(instance.stream->isConsistent(instance.shape));
      }
  }
};

void checkPlanes(const Drawn& drawn, std::size_t triangles) {
  for (std::size_t i = 0; i < drawn.planes.ids.size(); ++i) {
    const bool nothing = drawn.planes.ids[i] == raster::kNoId;
    check(nothing || drawn.planes.ids[i] < triangles);
    check(nothing ? drawn.planes.depth[i] == INFINITY : drawn.planes.depth[i] > 0.0f);
    const glm::vec3& n = drawn.planes.normals[i];
    check(std::abs(n.x * n.x + n.y * n.y + n.z * n.z - (nothing ? 0.0f : 1.0f)) < 1e-3f);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const fuzz::HostileFrame frame = fuzz::decodeFrame({data, size});
    const Drawn vectors(frame, 2, {});
    const Drawn scalars(frame, 1, {.tileWidth = 16, .tileHeight = 8, .scalar = true});
    checkPlanes(vectors, frame.scene.meshes[0].indices.size() / 3);
    check(vectors.image.rgba == scalars.image.rgba);
    check(vectors.planes.depth == scalars.planes.depth && vectors.planes.ids == scalars.planes.ids);
    check(vectors.planes.normals == scalars.planes.normals);
  } catch (const scene::InputError&) {
    // refused, as it should be
  }
  return 0;
}
