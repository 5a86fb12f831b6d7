// The bytes of a hostile frame: settings, then a mesh. Any bytes are one; past their end everything is zero.
//
//   0      method (bits 0-1), silhouetteness, robust, features, boundaries, shading normals, orthographic
//   1      tangents (bits 0-1, mod 3), normals given, colours given, double-sided, mirrored, stretched, blended
//   2      segments, mod 65; 0: by tolerance
//   3, 4   tolerance in 32nds of a pixel, beta in 32nds
//   5-7    azimuth, elevation, zoom
//   8      n, signed: coordinates are whole numbers times 2^n
//   9, 10  vertices - 3, triangles - 1
//   11 …   three coordinates of 16 bits per vertex; then, where given, three of a normal and four of a colour of 8 bits each
//   …      three indices of 8 bits per triangle, mod the vertices
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "apps/scene/frame.h"

namespace limn::fuzz {

struct HostileFrame {
  scene::Scene scene;
  scene::Pose pose;
  scene::CameraView camera;
  scene::FrameSettings settings;
};

/// Throws scene::InputError where limn refuses the mesh.
HostileFrame decodeFrame(std::span<const std::uint8_t> bytes);

}  // namespace limn::fuzz
