// One glTF primitive as triangles with plain vertex arrays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "apps/scene/gltf_document.h"
#include "apps/scene/scene.h"

namespace limn::scene {

/// Arrays per vertex have the length of `positions`, or 0 where the primitive does not have them. Vertices
/// that no triangle uses are left out.
struct PrimitiveArrays {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec4> colors, tangents;
  std::vector<SkinBinding> skinning;
  std::vector<MorphTarget> targets;
  std::vector<std::uint32_t> indices;
};

/// What was mended or passed over in the primitives of a mesh, for one notice each.
struct PrimitiveReport {
  std::size_t pointsAndLines = 0, withoutPositions = 0, cutShort = 0, withoutTexcoords = 0,
              unnormalizedWeights = 0, withoutWeights = 0;
};

/// Reads primitive `primitive` of mesh `mesh` with the texture coordinates of set `texcoordSet`. Empty where
/// it holds nothing to draw. Throws InputError with the place for what cannot be read safely.
PrimitiveArrays readPrimitive(GltfDocument& document, std::size_t mesh, std::size_t primitive,
                              int texcoordSet, PrimitiveReport& report);

/// Triangles of a list, strip or fan (glTF mode 4, 5, 6) over `corners`, all counter-clockwise as glTF says;
/// corners that complete no triangle are left out, and so are the triangles without area that stitch strips
/// together.
std::vector<std::uint32_t> triangulate(std::vector<std::uint32_t> corners, int mode);

}  // namespace limn::scene
