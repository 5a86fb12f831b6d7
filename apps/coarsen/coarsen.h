// From a fine mesh to a coarse one with fitted curves.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "apps/coarsen/guard.h"
#include "apps/coarsen/outline_check.h"
#include "apps/scene/scene.h"
#include "raster/base/workers.h"

namespace limn::coarsen {

struct Settings {
  std::size_t triangles = 500;  ///< at most, >= 4
};

struct Report {
  GuardReport guard;
  std::size_t fineTriangles = 0;
};

/// Gets what is done of the whole, 0 to 1; may be empty.
using Progress = std::function<void(double)>;

/// Simplifies `fine`, fits curves to it and moves the vertices to where the patches want them. Normals, texture
/// coordinates, colours, bones and morph targets are those of the fine mesh's vertices. The same bits for any number of
/// threads. Throws std::invalid_argument for a mesh without triangles or settings out of range.
scene::Mesh coarsenMesh(const scene::Mesh& fine, const Settings& settings, Workers& workers,
                        Report* report = nullptr, const Progress& progress = {});

/// Coarsens `fine` to the least number of triangles (to about 5 %) that keeps the promise over 60 views spread over the
/// sphere and 1,000 by chance. Nothing where that takes as many triangles as the fine mesh has.
std::optional<scene::Mesh> coarsenWithin(const scene::Mesh& fine, const OutlinePromise& promise,
                                         Workers& workers, Report* report = nullptr,
                                         const Progress& progress = {});

/// How many triangles each mesh of a scene gets of `triangles`: in proportion to what it has, at least 4 and at most that.
std::vector<std::size_t> shareTriangles(const std::vector<scene::Mesh>& meshes, std::size_t triangles);

/// Fits curves for `coarse` as it is to `fine`: nothing of it changes but its fitted curves. Both are placed by their origins and scales.
void fitMesh(const scene::Mesh& fine, scene::Mesh& coarse, Workers& workers, Report* report = nullptr,
             const Progress& progress = {});

}  // namespace limn::coarsen
