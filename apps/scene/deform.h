// Vertices that move by themselves: morph targets and skins.
#pragma once

#include <glm/mat4x4.hpp>
#include <vector>

#include "apps/scene/pose.h"
#include "apps/scene/scene.h"

namespace limn::scene {

/// Fills the posed arrays of `instance` and its toWorld from the morph weights in instance.weights and, where the node has
/// one, the skin. `joints` is scratch. Double precision throughout; the arrays are relative to a place near the shape, so
/// that far from the world's origin they keep their digits.
void deform(const Mesh& mesh, const Skin* skin, const std::vector<glm::dmat4>& nodeToWorld,
            std::vector<glm::dmat4>& joints, Instance& instance, Workers* workers);

/// nodeToWorld · translation by the mesh's origin · its scale: places the mesh's stored positions.
glm::dmat4 placeStored(const glm::dmat4& nodeToWorld, const Mesh& mesh);

}  // namespace limn::scene
