#include "silhouette/topology.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "shapes.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

TEST(Topology, ClosedSurfaceObeysEuler) {
  for (const auto& [shape, characteristic] : {std::pair{icosphere(2), 2},
                                              {torus(12, 7), 0},
                                              {cylinder(9), 2},
                                              {cube(), 2},
                                              {torn(icosphere(2)), 2},
                                              {torn(torus(12, 7)), 0}}) {
    const Topology topology(shape.mesh());
    EXPECT_TRUE(topology.isConsistent(shape.mesh())) << shape.name;
    const auto count = static_cast<int>(topology.pointCount()) - static_cast<int>(topology.edges().size()) +
                       static_cast<int>(shape.mesh().triangleCount());
    EXPECT_EQ(count, characteristic) << shape.name;
    EXPECT_EQ(topology.report().boundaryEdges, 0u) << shape.name;
    EXPECT_EQ(topology.report().nonManifoldEdges, 0u) << shape.name;
    EXPECT_EQ(topology.report().opposedTriangles, 0u) << shape.name;
  }
}

TEST(Topology, FeaturesAreWhereNormalsDiffer) {
  const Shape round = icosphere(1), can = cylinder(9), box = cube();
  EXPECT_EQ(Topology(round.mesh()).report().featureEdges, 0u);
  EXPECT_EQ(Topology(torn(round).mesh()).report().featureEdges, 0u);
  EXPECT_EQ(Topology(can.mesh()).report().featureEdges, 18u);
  EXPECT_EQ(Topology(box.mesh()).report().featureEdges, 12u);
  EXPECT_EQ(Topology(box.mesh(), 89.0f).report().featureEdges, 12u);
  EXPECT_EQ(Topology(box.mesh(), 91.0f).report().featureEdges, 0u);
}

TEST(Topology, BoundaryOfAGrid) {
  const Shape grid = flatGrid(4);
  const Topology topology(grid.mesh());
  EXPECT_EQ(topology.report().boundaryEdges, 16u);
  EXPECT_TRUE(topology.isConsistent(grid.mesh()));
}

TEST(Topology, MinusZeroIsZero) {
  Shape shape = torn(flatGrid(1));
  shape.positions[0].z = -0.0f;
  EXPECT_EQ(Topology(shape.mesh()).pointCount(), 4u);
}

// Three triangles on one edge, and two that run along theirs in the same direction.
TEST(Topology, NonManifoldEdgesFallApart) {
  Shape fins{
      "fins", {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}}, {}, {0, 1, 2, 1, 0, 3, 0, 1, 4}};
  fins.normals.assign(5, vec3(0, 0, 1));
  const Topology topology(fins.mesh());
  EXPECT_EQ(topology.report().nonManifoldEdges, 3u);
  EXPECT_EQ(topology.report().boundaryEdges, 6u);
  EXPECT_TRUE(topology.isConsistent(fins.mesh()));

  Shape turned{"turned", {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}}, {}, {0, 1, 2, 0, 1, 3}};
  turned.normals.assign(4, vec3(0, 1, 0));
  const Topology other(turned.mesh());
  EXPECT_EQ(other.report().nonManifoldEdges, 2u);
  EXPECT_EQ(other.report().opposedTriangles, 1u);
  EXPECT_TRUE(other.isConsistent(turned.mesh()));
}

TEST(Topology, DegenerateTrianglesAreKeptOut) {
  Shape shape{"needles",
              {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 0, 0}, {2, 0, 0}},
              {},
              {0, 1, 2, 0, 0, 2, 0, 3, 1, 1, 4, 4}};
  shape.normals.assign(5, vec3(0, 0, 1));
  const Topology topology(shape.mesh());
  EXPECT_EQ(topology.report().degenerateTriangles, 3u);
  EXPECT_TRUE(topology.isConsistent(shape.mesh()));
  ASSERT_EQ(topology.edges().size(), 3u);
  // The side that the collinear triangle lies along must not part from it.
  EXPECT_TRUE(topology.edges()[topology.sideEdges()[0]].nonManifold);
  EXPECT_FALSE(topology.edges()[topology.sideEdges()[1]].nonManifold);
}

TEST(Topology, RefusesWhatItCannotUse) {
  Shape shape = cube();
  shape.indices[5] = 24;
  EXPECT_THROW(Topology{shape.mesh()}, std::invalid_argument);
  shape = cube();
  shape.indices.pop_back();
  EXPECT_THROW(Topology{shape.mesh()}, std::invalid_argument);
  shape = cube();
  shape.normals.pop_back();
  EXPECT_THROW(Topology{shape.mesh()}, std::invalid_argument);
  EXPECT_EQ(Topology(Mesh{}).edges().size(), 0u);
}

}  // namespace
}  // namespace limn::silhouette::test
