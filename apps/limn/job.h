// A job: all frames that one command line describes, whichever of them this process draws.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "apps/scene/camera.h"
#include "apps/scene/frame.h"
#include "apps/scene/pose.h"
#include "apps/scene/scene.h"

namespace limn::program {

/// What decides the pixels of a job's frames.
struct JobOptions {
  std::string model = "builtin:demo";
  double creaseDegrees = 40.0;
  int width = 1280, height = 800;

  int turntable = 0;  ///< frames of a full turn, 0: no turn
  std::optional<std::string> animation;
  double fps = 24.0;
  std::optional<std::pair<double, double>> times;

  double azimuthDegrees = 30.0, elevationDegrees = 20.0, zoom = 1.0;
  std::optional<glm::dvec3> eye, target, up;
  double fovDegrees = 30.0;
  double orthoHeight = 0.0;  ///< 0: perspective, < 0: fitted
  std::optional<std::string> camera;

  scene::FrameSettings settings;
};

class Job {
 public:
  /// Borrows the scene. Resolves names and evaluates the pose of every frame once, for the framing. Throws UsageError.
  Job(const scene::Scene& scene, const JobOptions& options);

  int frameCount() const { return frameCount_; }
  const scene::Sphere& bounds() const { return bounds_; }

  /// `workers` as for scene::evaluatePose.
  void pose(int frame, scene::Pose& pose, Workers* workers = nullptr) const;
  /// Throws UsageError where the frame's camera cannot be used; an animated one may be so in any frame.
  scene::CameraView camera(int frame, const scene::Pose& pose) const;
  scene::FrameSettings settings(int frame) const;

  /// Version and options that decide the job's pixels, in one canonical order; never threads, shards, frames or output
  /// names.
  const std::string& text() const { return text_; }
  /// The same for one frame: a command that draws it again.
  std::string text(int frame) const { return text_ + " --frames " + std::to_string(frame); }

 private:
  double seconds(int frame) const;
  double turnDegrees(int frame) const;
  scene::Sphere boundsOfAllFrames() const;
  glm::dmat4 turn(int frame) const;
  void resolveCamera();
  void resolveLookAt();
  scene::CameraView cameraOrThrow(int frame, const scene::Pose& pose) const;
  void resolveAnimation();
  std::string describe() const;

  const scene::Scene& scene_;
  JobOptions options_;
  int animation_ = -1;
  int camera_ = -1, cameraNode_ = -1;
  double from_ = 0.0, to_ = 0.0;  ///< seconds of the animation
  int frameCount_ = 1;
  scene::Sphere bounds_;
  scene::LookAt lookAt_;  ///< unless the camera is the file's
  std::string text_;
};

/// A job whose first frame has a usable camera. Throws UsageError.
Job makeJob(const scene::Scene& scene, const JobOptions& options);

/// Triangles as drawn: a mesh counts once per node of the scene that holds it.
std::size_t drawnTriangles(const scene::Scene& scene);

}  // namespace limn::program
