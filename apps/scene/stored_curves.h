// Fitted curves as a file keeps them: a byte per number. See docs/fitted-curves.md.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "silhouette/fitted_curves.h"

namespace limn::scene {

/// Three numbers, each stored as k in [-127, 127] for scale · c |c| with c = k / 127: fine steps for the many small
/// ones, coarse steps for the few large ones.
using StoredVector = std::array<std::int8_t, 3>;

struct StoredCurves {
  std::vector<StoredVector>
      ends;  ///< two per edge, edges as a walk over the triangles' sides first meets them
  std::vector<StoredVector> centers;            ///< one per triangle
  glm::vec3 endScale{0.0f}, centerScale{0.0f};  ///< per component, 0 to kFittedLimit

  bool empty() const { return centers.empty(); }
};

glm::vec3 decode(const StoredVector& stored, const glm::vec3& scale);
/// The nearest that can be stored. The error is at most scale · (|c| + 1/254) / 127 per component.
StoredVector encode(const glm::vec3& value, const glm::vec3& scale);
/// Encodes all with one scale per component: the largest magnitude, at most kFittedLimit; larger ones are clamped.
std::vector<StoredVector> encodeAll(std::span<const glm::vec3> values, glm::vec3& scale);

/// The curves in the order of a topology, for a refiner.
struct DecodedCurves {
  std::vector<silhouette::FittedEnds> edges;
  std::vector<glm::vec3> centers;

  silhouette::FittedCurves view() const { return {edges, centers}; }
};

/// Empty where nothing is stored. `stored` must fit the mesh: fits().
DecodedCurves decode(const StoredCurves& stored, const silhouette::Mesh& mesh,
                     const silhouette::Topology& topology);

/// Whether there are two ends for each edge, a centre for each triangle, and scales in range.
bool fits(const StoredCurves& stored, const silhouette::Mesh& mesh, const silhouette::Topology& topology);

/// Ties curves to what they were fitted for, so that neither a changed mesh nor a damaged byte goes unnoticed: 32
/// hexadecimal digits of XXH3-128 over the positions of the triangles' corners, three per triangle as
/// the file has them, the two scales (little-endian floats), and the
/// bytes of ends and centres.
std::string curvesKey(const StoredCurves& curves, std::span<const glm::vec3> corners);

}  // namespace limn::scene
