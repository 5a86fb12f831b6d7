// Whether a small model's pictures keep to the fine model's outline.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "apps/scene/scene.h"
#include "raster/base/workers.h"

namespace limn::coarsen {

/// What is promised: in every view that frames the mesh as limn does by itself (perspective, 30 degrees), in a window of
/// this size, no point that one of the two models covers is farther than `pixels` from one that the other covers. The
/// small model is drawn as patches with the default tolerance.
struct OutlinePromise {
  double pixels = 1.0;
  int width = 1280, height = 800;
};

/// `count` directions over the sphere: a spiral, or (seed > 0) by chance, the same everywhere.
std::vector<glm::dvec3> viewDirections(int count, std::uint64_t seed = 0);

/// In how many of the views the promise is broken. Exact to about a quarter of a pixel, on the safe side. Both meshes are
/// in the same space.
int brokenViews(const scene::Mesh& fine, const scene::Mesh& small, const OutlinePromise& promise,
                const std::vector<glm::dvec3>& directions, Workers& workers);

}  // namespace limn::coarsen
