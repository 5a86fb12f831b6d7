// Animations, skins and morph targets against values worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "apps/scene/animate.h"
#include "apps/scene/pose.h"
#include "raster/base/workers.h"
#include "tests/scene/gltf_writer.h"

namespace limn::scene {
namespace {

using test::GltfWriter;
using test::json;

AnimationChannel channelOf(ChannelPath path, Interpolation interpolation, std::vector<float> times,
                           std::vector<float> values) {
  AnimationChannel channel;
  channel.path = path;
  channel.interpolation = interpolation;
  channel.components = path == ChannelPath::kRotation ? 4 : 3;
  channel.times = std::move(times);
  channel.values = std::move(values);
  return channel;
}

std::vector<double> sampled(const AnimationChannel& channel, double seconds) {
  std::vector<double> value(channel.components);
  sampleChannel(channel, seconds, value);
  return value;
}

TEST(AnimationChannel, LinearAndStepBetweenAndBeyondTheKeys) {
  const std::vector<float> values = {0, 10, 0, 4, 20, 0, 8, 0, 2};
  const AnimationChannel linear =
      channelOf(ChannelPath::kTranslation, Interpolation::kLinear, {1, 2, 4}, values);
  EXPECT_EQ(sampled(linear, 0.0), (std::vector<double>{0, 10, 0}));
  EXPECT_EQ(sampled(linear, 1.25), (std::vector<double>{1, 12.5, 0}));
  EXPECT_EQ(sampled(linear, 2.0), (std::vector<double>{4, 20, 0}));
  EXPECT_EQ(sampled(linear, 3.0), (std::vector<double>{6, 10, 1}));
  EXPECT_EQ(sampled(linear, 9.0), (std::vector<double>{8, 0, 2}));
  const AnimationChannel step = channelOf(ChannelPath::kTranslation, Interpolation::kStep, {1, 2, 4}, values);
  EXPECT_EQ(sampled(step, 1.999), (std::vector<double>{0, 10, 0}));
  EXPECT_EQ(sampled(step, 2.0), (std::vector<double>{4, 20, 0}));
  EXPECT_EQ(sampled(step, 3.999), (std::vector<double>{4, 20, 0}));
}

TEST(AnimationChannel, CubicSplineIsTheHermiteCurveOfTheSpecification) {
  // Keys at 1 and 3: (in, value, out) = (·, 1, 2) and (-1, 5, ·). With td = 2 and t = 1/2:
  // 1/2·1 + 1/8·2·2 + 1/2·5 - 1/8·2·(-1) = 3.75.
  const AnimationChannel cubic = channelOf(ChannelPath::kTranslation, Interpolation::kCubicSpline, {1, 3},
                                           {9, 9, 9, 1, 0, 0, 2, 0, 0, -1, 0, 0, 5, 0, 0, 9, 9, 9});
  EXPECT_EQ(sampled(cubic, 2.0)[0], 3.75);
  EXPECT_EQ(sampled(cubic, 1.0)[0], 1.0);
  EXPECT_EQ(sampled(cubic, 0.0)[0], 1.0);
  EXPECT_EQ(sampled(cubic, 3.0)[0], 5.0);
}

TEST(AnimationChannel, SlerpTurnsAtConstantSpeedTheShorterWay) {
  const float s = std::sqrt(0.5f);
  for (const float sign : {1.0f, -1.0f}) {  // a quaternion and its negative are the same rotation
    const AnimationChannel turn = channelOf(ChannelPath::kRotation, Interpolation::kLinear, {0, 1},
                                            {0, 0, 0, 1, 0, 0, sign * s, sign * s});
    for (const double t : {0.1, 0.25, 0.5, 0.9}) {
      const std::vector<double> q = sampled(turn, t);
      const double half = t * 3.14159265358979 / 4;
      EXPECT_NEAR(q[2], std::sin(half), 1e-7) << t;
      EXPECT_NEAR(q[3], std::cos(half), 1e-7) << t;
    }
  }
}

/// A triangle that a node with one animation channel moves.
GltfWriter animated(const char* path, int input, int output, GltfWriter writer,
                    const char* interpolation = "LINEAR") {
  writer.root["animations"] = json::array(
      {{{"samplers", json::array({{{"input", input}, {"output", output}, {"interpolation", interpolation}}})},
        {"channels", json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}})}}});
  return writer;
}

TEST(Animation, MovesNodesWithNormalizedIntegersToo) {
  GltfWriter writer;
  writer.addTriangle();
  const int times = writer.addArray<float>({0, 2}, "SCALAR");
  // 0° and 180° about z, as signed bytes.
  const int turns = writer.addArray<std::int8_t>({0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", true);
  const Scene scene = animated("rotation", times, turns, writer).load();
  ASSERT_EQ(scene.animations.size(), 1u);
  EXPECT_EQ(scene.animations[0].duration, 2.0);
  Pose pose;
  evaluatePose(scene, 0, 1.0, pose);  // 90°
  const glm::dvec4 x = pose.instances[0].toWorld * glm::dvec4(1, 0, 0, 1);
  EXPECT_NEAR(x.x, 0.0, 1e-12);
  EXPECT_NEAR(x.y, 1.0, 1e-12);
  evaluatePose(scene, -1, 1.0, pose);
  EXPECT_EQ(pose.instances[0].toWorld, glm::dmat4(1.0));
}

TEST(Morph, AddsWeightedOffsetsToPositionsAndNormals) {
  GltfWriter writer;
  json& primitive = writer.addTriangle();
  primitive["attributes"]["NORMAL"] = writer.addArray<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int move = writer.addArray<float>({0, 0, 4, 0, 0, 0, 0, 0, 0}, "VEC3");
  const int tilt = writer.addArray<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
  primitive["targets"] = {{{"POSITION", move}}, {{"POSITION", tilt}, {"NORMAL", tilt}}};
  writer.root["meshes"][0]["weights"] = {0.5, 0.0};
  Scene scene = writer.load();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  ASSERT_TRUE(pose.instances[0].deformed());
  EXPECT_EQ(pose.instances[0].positions[0], glm::vec3(0, 0, 2));
  EXPECT_EQ(pose.instances[0].normals[0], glm::vec3(0, 0, 1));
  scene.nodes[0].weights = {0.0f, 1.0f};  // the node's override the mesh's
  evaluatePose(scene, -1, 0.0, pose);
  EXPECT_EQ(pose.instances[0].positions[1], glm::vec3(2, 0, 0));
  EXPECT_NEAR(pose.instances[0].normals[2].x, std::sqrt(0.5), 1e-7);
}

TEST(Morph, WeightsAreAnimated) {
  GltfWriter writer;
  json& primitive = writer.addTriangle();
  const int move = writer.addArray<float>({0, 0, 4, 0, 0, 4, 0, 0, 4}, "VEC3");
  primitive["targets"] = {{{"POSITION", move}}, {{"POSITION", move}}};
  const int times = writer.addArray<float>({0, 1}, "SCALAR");
  const int weights = writer.addArray<float>({0, 0, 1, 0.5f}, "SCALAR");
  const Scene scene = animated("weights", times, weights, writer).load();
  Pose pose;
  evaluatePose(scene, 0, 0.5, pose);
  EXPECT_EQ(pose.instances[0].positions[2], glm::vec3(0, 1, 3));
}

// The made normals of a flat strip that a target folds turn with it: groups stay, so no crack opens.
TEST(Morph, MadeNormalsFollowTheTarget) {
  GltfWriter writer;
  json& primitive = writer.addTriangle();
  primitive["targets"] = {{{"POSITION", writer.addArray<float>({0, 0, 0, 0, 0, 0, 0, -1, 1}, "VEC3")}}};
  writer.root["meshes"][0]["weights"] = {1.0};
  const Scene scene = writer.load();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  EXPECT_EQ(pose.instances[0].positions[2], glm::vec3(0, 0, 1));
  for (const glm::vec3& n : pose.instances[0].normals)
    EXPECT_LT(glm::distance(n, glm::vec3(0, -1, 0)), 1e-6f);
}

/// A triangle bound to two joints: vertex 0 to the first, 1 to the second, 2 half to each. Node 0 holds the mesh, 1 and 2 are
/// the joints, at x = 0 and x = 1.
GltfWriter skinned(const std::vector<float>& weights = {1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0}) {
  GltfWriter writer;
  json& primitive = writer.addTriangle();
  primitive["attributes"]["JOINTS_0"] =
      writer.addArray<std::uint8_t>({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4");
  primitive["attributes"]["WEIGHTS_0"] = writer.addArray(weights, "VEC4");
  std::vector<float> inverseBind(32, 0.0f);
  for (const std::size_t diagonal : {0, 5, 10, 15, 16, 21, 26, 31}) inverseBind[diagonal] = 1.0f;
  inverseBind[16 + 12] = -1.0f;
  writer.root["skins"] =
      json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", writer.addArray(inverseBind, "MAT4")}}});
  writer.root["nodes"][0]["skin"] = 0;
  writer.root["nodes"].push_back({{"name", "first"}});
  writer.root["nodes"].push_back({{"name", "second"}, {"translation", {1, 0, 0}}});
  return writer;
}

glm::dvec3 worldPosition(const Pose& pose, std::size_t vertex) {
  return glm::dvec3(pose.instances[0].toWorld * glm::dvec4(pose.instances[0].positions[vertex], 1.0));
}

TEST(Skin, BlendsJointsAndIgnoresTheNodesOwnTransform) {
  GltfWriter writer = skinned();
  writer.root["nodes"][0]["translation"] = {100, 100, 100};
  writer.root["nodes"][2]["translation"] = {1, 0, 6};
  const Scene scene = writer.load();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  EXPECT_LT(glm::distance(worldPosition(pose, 0), glm::dvec3(0, 0, 0)), 1e-6);
  EXPECT_LT(glm::distance(worldPosition(pose, 1), glm::dvec3(1, 0, 6)), 1e-6);
  EXPECT_LT(glm::distance(worldPosition(pose, 2), glm::dvec3(0, 1, 3)), 1e-6);
}

TEST(Skin, WeightsThatDoNotAddUpAreScaledWithANotice) {
  const Scene scene = skinned({0.5f, 0, 0, 0, 0, 2, 0, 0, 3, 3, 0, 0}).load();
  EXPECT_EQ(scene.meshes[0].skinning[0].weights[0], glm::vec4(1, 0, 0, 0));
  EXPECT_EQ(scene.meshes[0].skinning[0].weights[2], glm::vec4(0.5f, 0.5f, 0, 0));
  ASSERT_EQ(scene.notices.size(), 1u);
  EXPECT_NE(scene.notices[0].find("do not add up"), std::string::npos);
}

TEST(Skin, MirroringJointsKeepTheOutsideOutside) {
  GltfWriter writer = skinned();
  for (const int node : {1, 2}) writer.root["nodes"][static_cast<std::size_t>(node)]["scale"] = {-1, 1, 1};
  writer.root["nodes"][2]["translation"] = {-1, 0, 0};
  const Scene scene = writer.load();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  const Instance& instance = pose.instances[0];
  EXPECT_LT(glm::determinant(glm::dmat3(instance.toWorld)), 0.0);
  // In the instance's own space winding and normal agree, as they do in the file.
  const std::uint32_t* corner = scene.meshes[0].indices.data();
  const glm::vec3 a = instance.positions[corner[0]], b = instance.positions[corner[1]],
                  c = instance.positions[corner[2]];
  EXPECT_GT(glm::dot(glm::cross(b - a, c - a), instance.normals[0]), 0.0f);
}

TEST(Skin, FarFromTheOriginTheShapeKeepsItsDigits) {
  GltfWriter writer = skinned();
  const double far = 1099511627776.0;  // 2^40: a double still has 2^-12 there, a float nothing
  writer.root["nodes"][1]["translation"] = {far, 0, 0};
  writer.root["nodes"][2]["translation"] = {far + 1, 0, 0};
  const Scene scene = writer.load();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  EXPECT_EQ(worldPosition(pose, 1) - worldPosition(pose, 0), glm::dvec3(1, 0, 0));
  EXPECT_EQ(worldPosition(pose, 2) - worldPosition(pose, 0), glm::dvec3(0, 1, 0));
}

TEST(Skin, NonUniformScaleTurnsNormalsAsThePlaneTurns) {
  GltfWriter writer = skinned();
  json& primitive = writer.root["meshes"][0]["primitives"][0];
  // The plane x + z = 0 in place of z = 0.
  primitive["attributes"]["POSITION"] = writer.addArray<float>({0, 0, 0, 1, 0, -1, 0, 1, 0}, "VEC3");
  for (const int node : {1, 2}) {
    writer.root["nodes"][static_cast<std::size_t>(node)]["scale"] = {3, 1, 1};
    writer.root["nodes"][static_cast<std::size_t>(node)]["translation"] = {0, 0, 0};
  }
  writer.root["skins"][0].erase("inverseBindMatrices");
  const Scene scene = writer.load();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  const Instance& instance = pose.instances[0];
  const glm::vec3 expected = glm::normalize(glm::vec3(1, 0, 3));  // (3, 0, -1) lies in the plane
  for (const glm::vec3& n : instance.normals) EXPECT_LT(glm::distance(n, expected), 1e-6f);
}

TEST(Pose, TheSameForAnyNumberOfThreadsAndWithReusedArrays) {
  GltfWriter writer = skinned();
  const Scene scene = writer.load();
  Pose alone, shared;
  evaluatePose(scene, -1, 0.0, alone);
  for (const int threads : {1, 2, 7}) {
    Workers workers(threads);
    evaluatePose(scene, -1, 0.0, shared, &workers);
    EXPECT_EQ(alone.instances[0].positions, shared.instances[0].positions);
    EXPECT_EQ(alone.instances[0].normals, shared.instances[0].normals);
    EXPECT_EQ(alone.instances[0].toWorld, shared.instances[0].toWorld);
  }
}

TEST(Pose, AScaleOfZeroHidesTheInstance) {
  GltfWriter writer;
  writer.addTriangle();
  writer.root["nodes"][0]["scale"] = {0, 0, 0};
  const Scene scene = writer.load();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  ASSERT_EQ(pose.instances.size(), 1u);
  EXPECT_FALSE(pose.instances[0].visible);
  EXPECT_EQ(boundingSphere(scene, pose).radius, 0.0);
}

}  // namespace
}  // namespace limn::scene
