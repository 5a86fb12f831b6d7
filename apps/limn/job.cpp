#include "apps/limn/job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

#include "apps/limn/names.h"
#include "apps/limn/values.h"

namespace limn::program {
namespace {

/// (B-A)·F is a count; what rounding takes from a whole number is given back.
constexpr double kRounding = 1e-9;

/// The index that `text` names: a name of the list, or its number.
template <class Item>
int indexOf(const std::string& text, const std::vector<Item>& items, const std::string& what) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].name == text && !text.empty()) return static_cast<int>(i);
    names.push_back(items[i].name.empty() ? std::to_string(i) : items[i].name);
  }
  if (items.empty()) throw UsageError("the model has no " + what + "; leave the option out");
  const bool isNumber = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  try {
    if (isNumber) return static_cast<int>(parseInteger(text, 0, static_cast<long>(items.size()) - 1));
    return parseChoice(text, names);
  } catch (const UsageError& error) {
    throw UsageError("--" + what + ": " + error.what());
  }
}

/// The name without its folders; never one that reads like an option.
std::string baseName(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  return name.size() > 1 && name.front() == '-' ? "./" + name : name;
}

/// As a shell reads it back.
std::string shellWord(const std::string& text) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.,:/@+=";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string lightText(const scene::FrameSettings& settings) {
  switch (settings.light) {
    case scene::LightChoice::kHeadlight:
      return "headlight";
    case scene::LightChoice::kDirection:
      return vectorText(settings.lightDirection);
    default:
      return "file";
  }
}

std::string overlayText(const scene::OverlaySet& overlays) {
  std::string text;
  for (std::size_t i = 0; i < overlays.size(); ++i)
    if (overlays[i]) text += (text.empty() ? " --overlay " : ",") + overlayNames()[i];
  return text;
}

const char* onOff(bool on) {
  return on ? "on" : "off";
}

std::string refinementText(const silhouette::Parameters& p) {
  using silhouette::Method;
  std::string text = " --method " + methodNames()[static_cast<std::size_t>(p.method)];
  if (p.method == Method::kFlat) return text;
  text += p.segments > 0 ? " --segments " + std::to_string(p.segments)
                         : " --tolerance " + numberText(p.tolerance);
  if (p.method == Method::kPatches) {
    text += p.wedgeDegrees > 0 ? " --wedge " + numberText(p.wedgeDegrees) : " --beta " + numberText(p.beta);
    text += " --silhouetteness " + silhouettenessNames()[static_cast<std::size_t>(p.silhouetteness)];
  }
  text += " --tangents " + tangentsNames()[static_cast<std::size_t>(p.tangents)];
  text += std::string(" --robust ") + onOff(p.robust);
  text += " --shading-normals " + shadingNormalsNames()[static_cast<std::size_t>(p.shadingNormals)];
  text += std::string(" --features ") + onOff(p.features) + " --boundaries " + onOff(p.boundaries);
  return text;
}

/// What limn::require says of a camera, without the function that said it.
[[noreturn]] void refuseCamera(const std::invalid_argument& error, const std::string& where) {
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  throw UsageError("the camera cannot be used" + where + ": " +
                   (colon == std::string::npos ? text : text.substr(colon + 2)));
}

}  // namespace

Job::Job(const scene::Scene& scene, const JobOptions& options) : scene_(scene), options_(options) {
  resolveAnimation();
  resolveCamera();
  bounds_ = boundsOfAllFrames();
  resolveLookAt();
  text_ = describe();
}

void Job::resolveLookAt() {
  const JobOptions& o = options_;
  if (o.eye) {
    if (o.orthoHeight < 0.0)
      throw UsageError("--ortho fit is for limn's own camera; with --eye give a height, like --ortho 2");
    lookAt_ = {*o.eye, o.target.value_or(bounds_.center), o.up.value_or(glm::dvec3(0.0, 1.0, 0.0)),
               o.fovDegrees, o.orthoHeight};
    return;
  }
  if (camera_ >= 0) return;
  try {
    lookAt_ = scene::frameSphere(bounds_, o.width, o.height, o.azimuthDegrees, o.elevationDegrees, o.zoom,
                                 o.fovDegrees, o.orthoHeight);
  } catch (const std::invalid_argument& error) {
    refuseCamera(error, "");
  }
}

void Job::resolveAnimation() {
  const JobOptions& o = options_;
  if (o.animation) {
    animation_ = indexOf(*o.animation, scene_.animations, "animation");
    to_ = scene_.animations[static_cast<std::size_t>(animation_)].duration;
    if (o.times) std::tie(from_, to_) = *o.times;
    const double frames = std::floor((to_ - from_) * o.fps + kRounding) + 1.0;
    if (!(frames <= kMostFrames))
      throw UsageError("the animation has more than ten million frames; lower --fps or shorten --time");
    frameCount_ = static_cast<int>(frames);
  }
  if (o.turntable > 0) frameCount_ = o.turntable;
}

void Job::resolveCamera() {
  if (!options_.camera) return;
  camera_ = indexOf(*options_.camera, scene_.cameras, "camera");
  for (std::size_t i = 0; i < scene_.nodes.size() && cameraNode_ < 0; ++i)
    if (scene_.inScene[i] && scene_.nodes[i].camera == camera_) cameraNode_ = static_cast<int>(i);
  if (cameraNode_ < 0)
    throw UsageError("no node of the drawn scene holds the camera '" + *options_.camera + "'");
}

double Job::seconds(int frame) const {
  return std::min(from_ + (frame - 1) / options_.fps, to_);
}

double Job::turnDegrees(int frame) const {
  return options_.turntable > 0 ? 360.0 * (frame - 1) / options_.turntable : 0.0;
}

void Job::pose(int frame, scene::Pose& pose, Workers* workers) const {
  scene::evaluatePose(scene_, animation_, seconds(frame), pose, workers);
}

/// One sphere around the spheres of all frames: centred on their common box, so their order does not matter.
scene::Sphere Job::boundsOfAllFrames() const {
  std::vector<scene::Sphere> spheres;
  scene::Pose posed;
  for (int frame = 1; frame <= (animation_ < 0 ? 1 : frameCount_); ++frame) {
    pose(frame, posed);
    spheres.push_back(scene::boundingSphere(scene_, posed));
  }
  if (spheres.size() == 1) return spheres.front();
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const scene::Sphere& s : spheres) {
    low = glm::min(low, s.center - s.radius);
    high = glm::max(high, s.center + s.radius);
  }
  scene::Sphere all{0.5 * low + 0.5 * high, 0.0};
  for (const scene::Sphere& s : spheres)
    all.radius = std::max(all.radius, glm::length(s.center - all.center) + s.radius);
  return all;
}

/// The scene turns about the upward line through what the camera looks at.
glm::dmat4 Job::turn(int frame) const {
  const bool isExplicit = options_.eye.has_value();
  return scene::turnAbout(isExplicit ? lookAt_.target : bounds_.center,
                          isExplicit ? lookAt_.up : glm::dvec3(0.0, 1.0, 0.0), turnDegrees(frame));
}

scene::CameraView Job::camera(int frame, const scene::Pose& pose) const {
  try {
    return cameraOrThrow(frame, pose);
  } catch (const std::invalid_argument& error) {
    refuseCamera(error, frameCount_ > 1 ? " in frame " + std::to_string(frame) : "");
  }
}

scene::CameraView Job::cameraOrThrow(int frame, const scene::Pose& pose) const {
  const glm::dmat4 turned = turn(frame);
  const scene::Sphere bounds{glm::dvec3(turned * glm::dvec4(bounds_.center, 1.0)), bounds_.radius};
  scene::CameraView view = camera_ < 0
                               ? scene::makeCamera(lookAt_, bounds, options_.width, options_.height)
                               : scene::makeCamera(scene_.cameras[static_cast<std::size_t>(camera_)],
                                                   pose.nodeToWorld[static_cast<std::size_t>(cameraNode_)],
                                                   bounds, options_.width, options_.height);
  if (options_.turntable > 0) view.worldToView = view.worldToView * turned;
  return view;
}

scene::FrameSettings Job::settings(int frame) const {
  scene::FrameSettings settings = options_.settings;
  // The light of --light x,y,z stands beside the turntable, so seen from the scene it turns the other way.
  settings.lightDirection = glm::dvec3(glm::transpose(glm::dmat3(turn(frame))) * settings.lightDirection);
  return settings;
}

std::string Job::describe() const {
  const JobOptions& o = options_;
  const bool isBuiltin = o.model.starts_with("builtin:");
  std::string text = std::string("limn ") + LIMN_VERSION;
  if (!scene_.contentHash.empty()) text += ", model xxh128 " + scene_.contentHash;
  text += ": render " + shellWord(isBuiltin ? o.model : baseName(o.model));
  text += " --size " + std::to_string(o.width) + "x" + std::to_string(o.height);
  if (!isBuiltin) text += " --crease " + numberText(o.creaseDegrees);
  if (o.turntable > 0) text += " --turntable " + std::to_string(o.turntable);
  if (animation_ >= 0)
    text += " --animation " + std::to_string(animation_) + " --fps " + numberText(o.fps) + " --time " +
            numberText(from_) + ":" + numberText(to_);
  if (camera_ >= 0) {
    text += " --camera " + std::to_string(camera_);
  } else {
    if (o.eye)
      text += " --eye " + vectorText(lookAt_.eye) + " --target " + vectorText(lookAt_.target) + " --up " +
              vectorText(lookAt_.up);
    else
      text += " --azimuth " + numberText(o.azimuthDegrees) + " --elevation " +
              numberText(o.elevationDegrees) + " --zoom " + numberText(o.zoom);
    if (o.orthoHeight == 0.0)
      text += " --fov " + numberText(o.fovDegrees);
    else
      text += " --ortho " + (o.orthoHeight < 0.0 ? std::string("fit") : numberText(o.orthoHeight));
  }
  text += refinementText(o.settings.refinement);
  text += " --samples " + std::to_string(o.settings.samples) + " --light " + lightText(o.settings);
  text += " --background " + shellWord(colorText(o.settings.background));
  return text + overlayText(o.settings.overlays);
}

std::size_t drawnTriangles(const scene::Scene& scene) {
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.inScene[i] && scene.nodes[i].mesh >= 0)
      triangles += scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)].indices.size() / 3;
  return triangles;
}

Job makeJob(const scene::Scene& scene, const JobOptions& options) {
  Job job(scene, options);
  scene::Pose pose;
  job.pose(1, pose);
  job.camera(1, pose);
  return job;
}

}  // namespace limn::program
