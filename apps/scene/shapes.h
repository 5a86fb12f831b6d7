// Procedural meshes with the normals of the analytic surface.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "apps/scene/scene.h"

namespace limn::scene {

inline constexpr int kMaximumLevel = 9;  ///< 5,242,880 triangles

/// The unit icosahedron divided `level` times, 0 … kMaximumLevel: 20·4^level triangles, radial normals.
Mesh icosphere(int level);

/// A tube of `around` sides and radius 0.4 along the unit circle in the plane z = 0, in `along` rings:
/// 2·along·around triangles.
Mesh torus(int along, int around);

/// A tube of radius 0.55 along the trefoil knot (sin s + 2 sin 2s, cos s - 2 cos 2s, -sin 3s).
Mesh knot(int along, int around);

/// A point of a profile: distance from the axis, height, and the outward normal of the surface there in the
/// same plane.
struct ProfilePoint {
  glm::dvec2 position;
  glm::dvec2 normal;
};

/// One smooth piece of a profile, from bottom to top. Where the next piece starts with another normal is a
/// crease.
using ProfilePiece = std::vector<ProfilePoint>;

ProfilePiece straightPiece(glm::dvec2 from, glm::dvec2 to);
/// An arc around `center` from one angle to another (degrees, counter-clockwise is outward), in `segments`
/// chords.
ProfilePiece arcPiece(glm::dvec2 center, double radius, double fromDegrees, double toDegrees, int segments);
/// A quadratic Bézier curve in `segments` chords.
ProfilePiece curvePiece(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, int segments);

/// The surface that the profile sweeps about the y axis, in `sectors` flat sectors. The profile starts and
/// ends on the axis. A smooth pole is one vertex; the tip of a cone has a vertex per sector, with the normal
/// of the sector's middle.
Mesh revolve(std::span<const ProfilePiece> profile, int sectors);

}  // namespace limn::scene
