#include "apps/scene/mesh_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "apps/scene/shapes.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/mesh_facts.h"

namespace limn::scene {
namespace {

using test::GltfWriter;

/// `mesh` written without normals and read again.
Mesh withoutNormals(const Mesh& mesh, double creaseDegrees, double scale = 1.0,
                    const glm::dvec3& offset = {}) {
  GltfWriter writer;
  std::vector<float> positions;
  for (const glm::vec3& p : mesh.positions) {
    for (int c = 0; c < 3; ++c)
      positions.push_back(static_cast<float>(static_cast<double>(p[c]) * scale + offset[c]));
  }
  writer.addMesh({{"POSITION", writer.addArray(positions, "VEC3")}}, writer.addArray(mesh.indices, "SCALAR"));
  return writer.load({.creaseDegrees = creaseDegrees}).meshes[0];
}

Mesh cube() {
  const ProfilePiece profile[] = {straightPiece({0, 0}, {1, 0}), straightPiece({1, 0}, {1, 1}),
                                  straightPiece({1, 1}, {0, 1})};
  return revolve(profile, 4);
}

TEST(MeshNormals, ACubeIsSplitBelowNinetyDegreesAndWholeAbove) {
  const Mesh split = withoutNormals(cube(), 89.0), whole = withoutNormals(cube(), 91.0);
  std::size_t axes = 0;
  for (const glm::vec3& n : split.normals) {
    axes += std::abs(std::abs(n.y) - 1.0f) < 1e-6f || std::abs(n.y) < 1e-6f ? 1 : 0;
  }
  EXPECT_EQ(axes, split.normals.size());  // every normal is one of a face
  const test::MeshFacts facts = test::factsOf(whole);
  EXPECT_TRUE(facts.closedManifold);
  EXPECT_EQ(facts.points, 10u);  // eight corners and the middles of top and bottom
  // Angle weights make the corner of a cube symmetric, however its faces are cut into triangles.
  for (std::size_t v = 0; v < whole.positions.size(); ++v) {
    if (std::abs(whole.positions[v].x) + std::abs(whole.positions[v].z) < 0.5f) continue;
    EXPECT_NEAR(std::abs(whole.normals[v].y), 1 / std::sqrt(3.0f), 1e-6f);
  }
}

TEST(MeshNormals, ASphereComesCloseToItsAnalyticNormals) {
  const Mesh sphere = icosphere(3);
  const Mesh read = withoutNormals(sphere, 40.0);
  ASSERT_EQ(read.positions.size(), sphere.positions.size());
  for (std::size_t v = 0; v < read.positions.size(); ++v) {
    EXPECT_GT(glm::dot(read.normals[v], sphere.normals[v]), 0.9995f);
  }
}

TEST(MeshNormals, DegenerateTrianglesDivideNothing) {
  Mesh sphere = icosphere(1);
  sphere.indices.insert(sphere.indices.end(), {0, 0, 1, 2, 2, 2});
  const Mesh read = withoutNormals(sphere, 60.0);
  EXPECT_EQ(read.positions.size(), sphere.positions.size());
}

// Re-basing: the stored shape does not depend on where the file puts it or how large it is.
TEST(MeshRebase, PowersOfTwoOfScaleChangeNothingOfTheStoredShape) {
  const Mesh sphere = icosphere(2);
  const Mesh huge = withoutNormals(sphere, 40.0, std::ldexp(1.0, 40)),
             tiny = withoutNormals(sphere, 40.0, std::ldexp(1.0, -60));
  EXPECT_EQ(huge.positions, tiny.positions);
  EXPECT_EQ(huge.normals, tiny.normals);
  EXPECT_EQ(huge.scale / tiny.scale, std::ldexp(1.0, 100));
}

TEST(MeshRebase, FarFromTheOriginWhatTheFloatsHoldIsKept) {
  Mesh box = cube();
  const Mesh read =
      withoutNormals(box, 40.0, 1024.0, glm::dvec3(1e7, 0, 0));  // floats there are whole numbers
  EXPECT_NEAR(read.origin.x, 1e7, 1.0);
  double widest = 0.0;
  for (const glm::vec3& p : read.positions) widest = std::max(widest, std::abs(static_cast<double>(p.x)));
  EXPECT_EQ(widest * read.scale, 1024.0);
}

}  // namespace
}  // namespace limn::scene
