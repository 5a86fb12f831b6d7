// The lights of a frame, in view space.
#pragma once

#include <vector>

#include "apps/scene/camera.h"
#include "apps/scene/frame.h"
#include "apps/scene/pose.h"
#include "apps/scene/scene.h"

namespace limn::scene {

/// Fills `lights` for the choice of `settings`. The peer scene's light and the headlight stand still relative
/// to the camera; a direction and the file's lights stand still in the world.
void viewLights(const Scene& scene, const Pose& pose, const CameraView& camera, const FrameSettings& settings,
                std::vector<raster::Light>& lights);

}  // namespace limn::scene
