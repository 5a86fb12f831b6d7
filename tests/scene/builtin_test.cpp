#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "apps/scene/load.h"
#include "tests/scene/mesh_facts.h"

namespace limn::scene {
namespace {

using test::factsOf;
using test::MeshFacts;

struct Expectation {
  const char* name;
  std::size_t triangles;
  long eulerCharacteristic;
};

class Builtin : public testing::TestWithParam<Expectation> {};

TEST_P(Builtin, IsClosedAndFacesOutward) {
  const Scene scene = load(std::string("builtin:") + GetParam().name);
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Mesh& mesh = scene.meshes[0];
  const MeshFacts facts = factsOf(mesh);
  EXPECT_EQ(facts.triangles, GetParam().triangles);
  EXPECT_EQ(facts.eulerCharacteristic(), GetParam().eulerCharacteristic);
  EXPECT_TRUE(facts.closedManifold);
  EXPECT_EQ(facts.inward, 0u);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (const glm::vec3& n : mesh.normals) EXPECT_NEAR(glm::length(n), 1.0f, 1e-6f);
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.parts[0].triangleCount, GetParam().triangles);
}

INSTANTIATE_TEST_SUITE_P(Scene, Builtin,
                         testing::Values(Expectation{"sphere-200", 200, 2},
                                         Expectation{"icosphere-320", 320, 2},
                                         Expectation{"torus-576", 576, 0}, Expectation{"knot-480", 480, 0},
                                         Expectation{"cone-70", 70, 2}, Expectation{"pawn", 360, 2},
                                         Expectation{"icosphere:0", 20, 2},
                                         Expectation{"icosphere:4", 5120, 2}, Expectation{"torus:3:3", 18, 0},
                                         Expectation{"knot:100:9", 1800, 0}));

TEST(BuiltinShapes, SpheresLieOnTheUnitSphereWithRadialNormals) {
  for (const char* name : {"builtin:sphere-200", "builtin:icosphere:5"}) {
    const Mesh mesh = load(name).meshes[0];
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      EXPECT_NEAR(glm::length(mesh.positions[i]), 1.0f, 2e-7f);
      EXPECT_LT(glm::distance(mesh.positions[i], mesh.normals[i]), 2e-7f);
    }
  }
}

TEST(BuiltinShapes, TorusVerticesAreRadiusAwayFromTheCircleAlongTheirNormals) {
  const Mesh mesh = load("builtin:torus-576").meshes[0];
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 axis = mesh.positions[i] - 0.4f * mesh.normals[i];
    EXPECT_NEAR(axis.z, 0.0f, 1e-6f);
    EXPECT_NEAR(std::hypot(axis.x, axis.y), 1.0f, 1e-6f);
  }
}

// The tube's first ring: s = 0, p = (0, -1, 0), t = (5, 0, -3)/√34, b = (-3, 0, -5)/√34, n = b × t = (0, -1,
// 0).
TEST(BuiltinShapes, KnotStartsWhereTheFormulaSays) {
  const Mesh mesh = load("builtin:knot-480").meshes[0];
  EXPECT_LT(glm::distance(mesh.positions[0], glm::vec3(0, -1.55f, 0)), 1e-6f);
  EXPECT_LT(glm::distance(mesh.normals[0], glm::vec3(0, -1, 0)), 1e-6f);
}

TEST(BuiltinShapes, ConeTipHasOneNormalPerSectorAndTheRimIsACrease) {
  const Mesh mesh = load("builtin:cone-70").meshes[0];
  std::size_t tips = 0, rims = 0;
  const float slope = 1.0f / std::sqrt(1.36f);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p = mesh.positions[i], n = mesh.normals[i];
    if (p.y == 1.0f) ++tips;
    if (p.x * p.x + p.z * p.z > 0.3f) ++rims;
    if (n.y > -0.5f)
      EXPECT_NEAR(n.y, 0.6f * slope, 1e-6f);
    else
      EXPECT_EQ(n, glm::vec3(0, -1, 0));
  }
  EXPECT_EQ(tips, 35u);
  EXPECT_EQ(rims, 70u);
}

TEST(BuiltinShapes, DemoIsAFewCoarseObjectsWithMaterials) {
  const Scene scene = load("builtin:demo");
  EXPECT_GE(scene.meshes.size(), 5u);
  EXPECT_EQ(scene.inScene.size(), scene.nodes.size());
  std::size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) {
    const MeshFacts facts = factsOf(mesh);
    EXPECT_TRUE(facts.closedManifold) << mesh.name;
    EXPECT_EQ(facts.inward, 0u) << mesh.name;
    triangles += facts.triangles;
    for (const raster::Part& part : mesh.parts) EXPECT_LT(part.material, scene.materials.size());
  }
  EXPECT_LT(triangles, 2000u);
}

TEST(BuiltinNames, EveryListedNameLoads) {
  for (const BuiltinModel& model : builtinModels()) {
    EXPECT_FALSE(model.description.empty());
    if (model.name.find(':') != std::string::npos) continue;
    EXPECT_FALSE(load("builtin:" + model.name).meshes.empty());
  }
}

std::string messageOf(const std::string& model) {
  try {
    load(model);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(BuiltinNames, UnknownOnesAreAnsweredWithTheNearest) {
  EXPECT_NE(messageOf("builtin:shpere-200").find("did you mean builtin:sphere-200?"), std::string::npos);
  EXPECT_NE(messageOf("builtin:torus").find("did you mean builtin:torus-576?"), std::string::npos);
  EXPECT_NE(messageOf("builtin:").find("limn models"), std::string::npos);
  EXPECT_NE(messageOf("builtin:zzzzzzzzzzzz").find("limn models"), std::string::npos);
}

TEST(BuiltinNames, AbsurdResolutionsAreRefused) {
  EXPECT_NE(messageOf("builtin:icosphere:10").find("LEVEL is 0 to 9"), std::string::npos);
  EXPECT_NE(messageOf("builtin:icosphere:-1").find("LEVEL is 0 to 9"), std::string::npos);
  for (const char* name : {"torus:2:3", "torus:3:4097", "knot:4096:4096", "knot:-3:5"}) {
    EXPECT_NE(messageOf(std::string("builtin:") + name).find("M and N are 3 to 4096"), std::string::npos)
        << name;
  }
  for (const char* name : {"torus:3", "torus:3:4:5", "icosphere:", "icosphere:2x", "torus:99999999999:3"}) {
    EXPECT_NE(messageOf(std::string("builtin:") + name).find("no such built-in model"), std::string::npos)
        << name;
  }
}

}  // namespace
}  // namespace limn::scene
