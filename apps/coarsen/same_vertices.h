// Vertices that differ in nothing.
#pragma once

#include <vector>

#include "apps/coarsen/surface.h"
#include "apps/scene/scene.h"

namespace limn::coarsen {

/// The first vertex that has the same attributes, bit for bit, at the same point, for every vertex; `pointOf` as makeSurface()
/// gives it. Files without indices have one vertex per corner, and each would be a seam of its own.
std::vector<Index> firstsOfTheSame(const scene::Mesh& mesh, const std::vector<Index>& pointOf);

}  // namespace limn::coarsen
