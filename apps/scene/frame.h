// One frame: the only place where the silhouette module and the rasterizer meet.
#pragma once

#include <memory>

#include "apps/scene/camera.h"
#include "apps/scene/image.h"
#include "apps/scene/pose.h"
#include "apps/scene/scene.h"
#include "silhouette/refine.h"

namespace limn::scene {

enum class LightChoice { kPeer, kHeadlight, kFile, kDirection };

struct FrameSettings {
  silhouette::Parameters refinement;
  int samples = 4;
  glm::vec4 background{0.0f};                  ///< linear RGB, straight alpha
  LightChoice light = LightChoice::kFile;      ///< kFile falls back to kPeer where the file has none
  glm::dvec3 lightDirection{0.36, 0.48, 0.8};  ///< kDirection: towards the light, world space
  raster::Encoding encoding = raster::Encoding::kSrgb;
};

/// Counts and times of one frame.
struct FrameStatistics {
  raster::Statistics raster;
  silhouette::RefineReport refine;  ///< summed over the instances
  double poseMs = 0, refineMs = 0, rasterMs = 0, totalMs = 0;
};

/// Draws frames of one scene; keeps what does not change between frames.
class FrameDrawer {
 public:
  FrameDrawer(const Scene& scene, int threads);
  ~FrameDrawer();

  /// mesh → topology (once) → classify → refine → stream → rasterize. The picture is resized as the camera says.
  void draw(const Pose& pose, const CameraView& camera, const FrameSettings& settings, Image& image,
            FrameStatistics* statistics = nullptr);

  /// The refined stream of one instance in the last frame drawn, in the mesh's space.
  const silhouette::RefinedStream& stream(std::size_t instance) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace limn::scene
