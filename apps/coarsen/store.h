// From control points to the numbers that a file keeps.
#pragma once

#include <vector>

#include "apps/coarsen/patch_net.h"
#include "apps/scene/scene.h"

namespace limn::coarsen {

/// Fills coarse.curves from the net's control points; `triangles`: the mesh triangle of each patch. The mesh's positions
/// are those of the net's points, rounded to floats.
void storeCurves(const PatchNet& net, const std::vector<Index>& triangles, scene::Mesh& coarse);

}  // namespace limn::coarsen
