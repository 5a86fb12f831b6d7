// The scene of the frame benchmarks: copies of one mesh on a grid that fills the window, every copy turned another way,
// all turning on from view to view. limn and its peer draw it from this one description.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "apps/scene/scene.h"
#include "raster/base/projection.h"

namespace limn::bench {

/// Display values of the background; its alpha is 0.
inline constexpr glm::vec3 kBackground{0.10f, 0.12f, 0.18f};

/// The copies stand on the plane z = -distance, which is 2 units high and fills the window: a field of view of 30°.
class Grid {
 public:
  Grid(int copies, int width, int height);

  int copies() const { return copies_; }
  const Projection& projection() const { return projection_; }
  double distance() const { return distance_; }

  /// Where copy `copy` of a mesh in the unit sphere stands in view space in view `view` of `views`. `scale` is its
  /// radius in halves of the smaller side of a cell.
  glm::dmat4 place(int copy, int view, int views, double scale) const;

 private:
  int copies_;
  int columns_, rows_;
  double cellWidth_, cellHeight_, aspect_, distance_;
  Projection projection_;
};

/// A model as the command line names it (a file, builtin:NAME, or NAME alone) as one mesh that is centred and scaled to
/// the unit sphere. Its texture coordinates are (2x, 2y) of the position there.
scene::Mesh loadFitted(const std::string& model);

inline constexpr int kTextureSize = 512;
/// RGBA8, kTextureSize²: a checker of 64-pixel cells with noise, blue halved.
std::vector<std::uint8_t> checkerTexture();

}  // namespace limn::bench
