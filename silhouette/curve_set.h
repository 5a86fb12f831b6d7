// What silhouette curves know of a mesh from every viewpoint.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "silhouette/blocking.h"
#include "silhouette/edge_curves.h"
#include "silhouette/method.h"
#include "silhouette/robust_ends.h"

namespace limn::silhouette {

struct CurveSet {
  std::vector<EdgeVertices> vertices;       ///< of every edge
  std::vector<CurveOffsets> curves;         ///< bridges and feature curves; zero where an edge stays straight
  std::vector<std::array<float, 2>> trust;  ///< in the ends of bridges, 0 … 1: robust_ends.h
  std::vector<std::uint8_t> always;         ///< edges that are sampled from every viewpoint
  std::vector<glm::vec3> faceNormals;       ///< unit; zero for degenerate triangles
  std::vector<std::uint8_t> bridged;        ///< edges that may have silhouette points
  Blocking blocking;

  void prepare(const Mesh& mesh, const Topology& topology, const Parameters& parameters, const Crew& crew);

 private:
  RobustEnds robust_;
};

}  // namespace limn::silhouette
