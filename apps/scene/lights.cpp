#include "apps/scene/lights.h"

#include <algorithm>
#include <cmath>

#include "raster/base/elementary.h"

namespace limn::scene {
namespace {

// KHR_lights_punctual gives lux and candela, and a white Lambertian surface reflects 1/pi of what arrives.
constexpr float kLambert = 0.318309886f;
// The file has no ambient light; a little keeps what no lamp reaches from turning black.
constexpr float kFileAmbient = 0.03f;

/// Scaled by a power of two first: squares neither overflow nor vanish, and nothing is rounded.
glm::vec3 unitOr(const glm::dvec3& v, const glm::vec3& otherwise) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0 && std::isfinite(largest))) return otherwise;
  const int exponent = std::ilogb(largest);
  const glm::dvec3 scaled(std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent), std::ldexp(v.z, -exponent));
  return glm::vec3(scaled / std::sqrt(glm::dot(scaled, scaled)));
}

raster::Light fromFile(const Light& light, const glm::dmat4& lightToView) {
  raster::Light out;
  out.kind = light.kind;
  out.color = glm::vec3(light.color) * kLambert;  // of highlights too (docs/materials.md)
  out.ambient = kFileAmbient;
  out.diffuse = 1.0f;
  out.position = glm::vec3(glm::dvec3(lightToView[3]));
  out.direction = unitOr(-glm::dvec3(lightToView[2]), {0.0f, 0.0f, -1.0f});
  out.toLight = -out.direction;
  out.range = static_cast<float>(light.range);
  if (light.kind == raster::Light::Kind::kSpot) {
    // The specification's angular attenuation: scale = 1 / max(0.001, cos inner - cos outer), offset = -cos
    // outer · scale.
    const double inner = sinCos(light.innerCone).cos, outer = sinCos(light.outerCone).cos;
    const double scale = 1.0 / std::max(0.001, inner - outer);
    out.spotScale = static_cast<float>(scale);
    out.spotOffset = static_cast<float>(-outer * scale);
  }
  return out;
}

}  // namespace

void viewLights(const Scene& scene, const Pose& pose, const CameraView& camera, const FrameSettings& settings,
                std::vector<raster::Light>& lights) {
  lights.clear();
  if (settings.light == LightChoice::kFile) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
      if (scene.nodes[i].light < 0 || !scene.inScene[i]) continue;
      const Light& light = scene.lights[static_cast<std::size_t>(scene.nodes[i].light)];
      lights.push_back(fromFile(light, camera.worldToView * pose.nodeToWorld[i]));
    }
    if (!lights.empty()) return;
  }
  raster::Light light;  // the peer scene's, as the defaults say
  if (settings.light == LightChoice::kHeadlight) light.toLight = {0.0f, 0.0f, 1.0f};
  if (settings.light == LightChoice::kDirection)
    light.toLight = unitOr(glm::dmat3(camera.worldToView) * settings.lightDirection, light.toLight);
  lights.push_back(light);
}

}  // namespace limn::scene
