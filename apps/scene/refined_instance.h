#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "silhouette/refine.h"
#include "silhouette/topology.h"

namespace limn::scene {

/// One instance as a frame has it: a coarse shape, and the stream that replaces some of its triangles.
struct RefinedInstance {
  silhouette::Mesh shape;
  const silhouette::Topology* topology = nullptr;  ///< null in a frame that is flat and was only drawn
  const silhouette::RefinedStream* stream = nullptr;
  std::span<const glm::vec2> texcoords;  ///< of the stream's vertices, as far as the mesh has them
  std::span<const glm::vec4> colors;
  std::span<const glm::vec4> meshTangents, tangents;  ///< of the shape's vertices and of the stream's
  glm::dmat4 shapeToWorld{1.0};
};

}  // namespace limn::scene
