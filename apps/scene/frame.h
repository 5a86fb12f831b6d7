// One frame: the only place where the silhouette module and the rasterizer meet.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "apps/scene/camera.h"
#include "apps/scene/image.h"
#include "apps/scene/overlays.h"
#include "apps/scene/pose.h"
#include "apps/scene/refined_instance.h"
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
  OverlaySet overlays{};  ///< lines over the picture
};

/// Counts and times of one frame.
struct FrameStatistics {
  raster::Statistics raster;
  silhouette::RefineReport refine;  ///< summed over the instances
  double refineMs = 0, rasterMs = 0, totalMs = 0;
};

/// Planes beside the picture, one value per pixel, rows as in the picture. What is not wanted stays as it is.
struct Planes {
  bool wantsDepth = false, wantsNormals = false, wantsIds = false;
  std::vector<float> depth;        ///< view depth of the nearest sample, +infinity where nothing was drawn
  std::vector<glm::vec3> normals;  ///< unit, view space; 0 where nothing was drawn
  std::vector<std::uint32_t>
      ids;  ///< triangle of the coarse scene, instances one after the other, or raster::kNoId
};

/// Draws frames of one scene; keeps what does not change between frames.
class FrameDrawer {
 public:
  /// `tuning` changes no pixel.
  FrameDrawer(const Scene& scene, int threads, const raster::Tuning& tuning = {});
  ~FrameDrawer();

  /// mesh → topology (once) → classify → refine → stream → rasterize. The picture is resized as the camera says.
  void draw(const Pose& pose, const CameraView& camera, const FrameSettings& settings, Image& image,
            FrameStatistics* statistics = nullptr, Planes* planes = nullptr);

  /// The geometry of a frame without its pixels.
  void refine(const Pose& pose, const CameraView& camera, const FrameSettings& settings);

  /// One visible instance of the last frame drawn or refined. Borrowed until the next one.
  RefinedInstance instance(std::size_t instance) const;
  /// Silhouetteness of the edges of its topology in that frame; empty where it was not visible.
  void silhouetteness(std::size_t instance, std::vector<float>& alphas);

  /// The threads that draw, for whoever poses the scene between frames.
  Workers& workers();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace limn::scene
