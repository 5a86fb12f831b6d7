#include "apps/scene/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "apps/scene/load.h"

namespace limn::scene {
namespace {

// A parent that turns by 90° about z and moves, a child that scales: x -> ... by hand.
Scene twoNodes() {
  Scene scene = load("builtin:icosphere:0");
  scene.nodes.clear();
  Node parent, child;
  parent.translation = {10, 0, 0};
  parent.rotation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  child.parent = 0;
  child.translation = {0, 2, 0};
  child.scale = {3, 3, -3};
  child.mesh = 0;
  scene.nodes = {parent, child};
  scene.inScene = {true, true};
  return scene;
}

TEST(Pose, MultipliesTransformsFromTheRoot) {
  const Scene scene = twoNodes();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  ASSERT_EQ(pose.instances.size(), 1u);
  EXPECT_EQ(pose.instances[0].node, 1u);
  EXPECT_FALSE(pose.instances[0].deformed());
  const glm::dvec4 p =
      pose.instances[0].toWorld * glm::dvec4(1, 0, 1, 1);  // child: (3, 2, -3); parent: (-2+10, 3, -3)
  EXPECT_NEAR(p.x, 8.0, 1e-12);
  EXPECT_NEAR(p.y, 3.0, 1e-12);
  EXPECT_NEAR(p.z, -3.0, 1e-12);
}

TEST(Pose, LeavesOutNodesThatAreNotInTheScene) {
  Scene scene = twoNodes();
  scene.inScene[1] = false;
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  EXPECT_TRUE(pose.instances.empty());
  EXPECT_EQ(boundingSphere(scene, pose).radius, 0.0);
}

TEST(Pose, BoundingSphereHoldsEveryVertex) {
  const Scene scene = twoNodes();
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  const Sphere sphere = boundingSphere(scene, pose);
  EXPECT_NEAR(sphere.center.x, 8.0, 1e-6);
  EXPECT_NEAR(sphere.radius, 3.0, 1e-6);
}

TEST(Pose, OriginsAreAddedInDoublePrecision) {
  Scene scene = twoNodes();
  scene.meshes[0].origin = {0, 0, 1e15};
  scene.nodes[1].translation.z = 3e15;
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  const Sphere sphere = boundingSphere(scene, pose);
  EXPECT_NEAR(sphere.radius, 3.0, 0.5);  // one unit in the last place of 1e15 is 1/8
  EXPECT_NEAR(sphere.center.z, 0.0, 0.5);
}

TEST(Pose, RefusesAnimationsThatAreNotThere) {
  const Scene scene = twoNodes();
  Pose pose;
  EXPECT_THROW(evaluatePose(scene, 0, 0.0, pose), std::invalid_argument);
  EXPECT_THROW(evaluatePose(scene, -1, std::nan(""), pose), std::invalid_argument);
}

}  // namespace
}  // namespace limn::scene
