// Small meshes made on the spot, and what the tests of this folder ask of a refined stream.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "silhouette/refine.h"

namespace limn::silhouette::test {

struct Shape {
  std::string name;
  std::vector<glm::vec3> positions, normals;
  std::vector<std::uint32_t> indices;

  Mesh mesh() const { return {positions, normals, indices}; }
};

/// The unit sphere: an icosahedron divided `level` times, normals radial.
Shape icosphere(int level);
/// A torus about z, radii 1 and 0.4, its quads split along alternate diagonals, normals of the surface.
Shape torus(int around, int tube);
/// A closed cylinder of radius 1, z from -1 to 1, split normals at the rims.
Shape cylinder(int sides);
/// A unit cube with split normals, each face two triangles.
Shape cube();
/// A grid in the plane z = 0 with a boundary, all normals +z.
Shape flatGrid(int cells);
/// A height field with a boundary and smooth normals.
Shape bumpyGrid(int cells);
/// The shape with every vertex doubled as a texture seam would: no two triangles share a vertex, normals as
/// they were.
Shape torn(const Shape& shape);
/// The shape's vertices moved and its normals replaced pseudo-randomly: not smooth, not consistent.
Shape shaken(const Shape& shape, std::uint32_t seed);

/// All of the above, small.
std::vector<Shape> allShapes();

/// A perspective view from `eye` at the origin: vertical field of view 30 degrees, 1000 by 800 pixels.
View perspectiveFrom(const glm::vec3& eye, float nearPlane = 0.01f);
/// An orthographic view along `direction`; a unit is 300 pixels.
View orthographicAlong(const glm::vec3& direction);
/// A few of each around the origin at a distance of about `distance`, none on an axis.
std::vector<View> someViews(float distance);

/// The whole drawn surface: the triangles that were not replaced and the stream's, three positions each.
std::vector<glm::vec3> drawnTriangles(const Mesh& mesh, const RefinedStream& stream);

/// Number of directed sides of `triangles` (by position, bit for bit) without exactly one opposite; sides of
/// zero length are passed over.
std::size_t openSides(const std::vector<glm::vec3>& triangles);

/// New vertices between the ends of boundary edges: each makes one open side of the mesh two.
std::size_t verticesOnBoundaries(const Topology& topology, const RefinedStream& stream);

}  // namespace limn::silhouette::test
