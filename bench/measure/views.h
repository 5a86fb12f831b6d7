// The standard set-up of the measures: directions on the sphere, and one camera for truth and method.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/scene/camera.h"
#include "apps/scene/pose.h"

namespace limn::measure {

/// The 26 directions {-1,0,1}³ without 0, normalised and turned by 0.1 rad about (1,2,3): from the object to
/// the eye.
std::vector<glm::dvec3> standardDirections();

/// `count` directions spread evenly over the sphere by chance, the same for the same seed everywhere.
std::vector<glm::dvec3> randomDirections(std::uint64_t seed, int count);

/// Perspective, 30° high, `size` × `size` pixels; the sphere's picture is 0.95 of the window high. The same
/// camera serves truth and methods. y is up, or x where the view goes along y.
scene::CameraView outlineCamera(const scene::Sphere& bounds, const glm::dvec3& direction, int size);

}  // namespace limn::measure
