#include "apps/scene/stored_curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/coarsen/fine_models.h"

namespace limn::coarsen::test {
namespace {

using scene::decode;
using scene::StoredVector;

TEST(StoredCurves, ErrorIsWithinItsBound) {
  const glm::vec3 scale(0.7f, 0.05f, 1.0f);
  for (int k = -5000; k <= 5000; ++k) {
    const float part = static_cast<float>(k) / 5000.0f;
    const glm::vec3 value = part * scale;
    const glm::vec3 back = decode(scene::encode(value, scale), scale);
    const float bound = (std::sqrt(std::abs(part)) + 1.0f / 254.0f) / 127.0f;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_LE(std::abs(back[axis] - value[axis]), scale[axis] * bound * 1.001f) << k;
  }
}

TEST(StoredCurves, EveryByteIsKept) {
  const glm::vec3 scale(0.3f);
  for (int k = -127; k <= 127; ++k) {
    const auto step = static_cast<std::int8_t>(k);
    const StoredVector stored = {step, step, step};
    EXPECT_EQ(scene::encode(decode(stored, scale), scale), stored);
  }
}

TEST(StoredCurves, ScaleIsTheLargestAndClamped) {
  glm::vec3 scale(0.0f);
  const std::vector<glm::vec3> values = {{0.25f, -3.0f, 0.0f}, {-0.5f, 0.5f, 0.0f}};
  const std::vector<StoredVector> stored = scene::encodeAll(values, scale);
  EXPECT_EQ(scale, glm::vec3(0.5f, 1.0f, 0.0f));
  EXPECT_EQ(stored[0][1], -127);
  EXPECT_EQ(decode(stored[1], scale).x, -0.5f);
}

TEST(StoredCurves, AnyBytesStayInRange) {
  std::mt19937 random(99);
  const glm::vec3 scale(silhouette::kFittedLimit);
  for (int k = 0; k < 1000; ++k) {
    const StoredVector stored = {static_cast<std::int8_t>(random()), static_cast<std::int8_t>(random()),
                                 static_cast<std::int8_t>(random())};
    const glm::vec3 value = decode(stored, scale);
    for (int axis = 0; axis < 3; ++axis) EXPECT_LE(std::abs(value[axis]), 1.02f);  // -128 is a step too far
  }
}

TEST(StoredCurves, FitOnlyTheirMesh) {
  const scene::Mesh mesh = builtinMesh("icosphere:1");
  const silhouette::Topology topology(shapeOf(mesh));
  scene::StoredCurves curves;
  curves.ends.resize(2 * topology.edges().size());
  curves.centers.resize(mesh.indices.size() / 3);
  curves.endScale = curves.centerScale = glm::vec3(0.5f);
  EXPECT_TRUE(fits(curves, shapeOf(mesh), topology));
  scene::StoredCurves wrong = curves;
  wrong.ends.pop_back();
  EXPECT_FALSE(fits(wrong, shapeOf(mesh), topology));
  wrong = curves;
  wrong.centers.push_back({});
  EXPECT_FALSE(fits(wrong, shapeOf(mesh), topology));
  wrong = curves;
  wrong.endScale.y = std::nanf("");
  EXPECT_FALSE(fits(wrong, shapeOf(mesh), topology));
  wrong = curves;
  wrong.centerScale.x = 1.5f;
  EXPECT_FALSE(fits(wrong, shapeOf(mesh), topology));
}

TEST(StoredCurves, KeyKnowsPositionsTheirOrderAndEveryByte) {
  std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene::StoredCurves curves;
  curves.ends.assign(6, {1, 2, 3});
  curves.centers.assign(1, {0, 0, 0});
  const std::string key = scene::curvesKey(curves, corners);
  EXPECT_EQ(key.size(), 32u);
  corners[0].x = -0.0f;
  EXPECT_EQ(scene::curvesKey(curves, corners), key);
  corners[0].x = 1e-38f;
  EXPECT_NE(scene::curvesKey(curves, corners), key);
  corners[0].x = 0.0f;
  std::swap(corners[0], corners[1]);
  EXPECT_NE(scene::curvesKey(curves, corners), key);
  std::swap(corners[0], corners[1]);
  curves.ends[5][2] = 4;
  EXPECT_NE(scene::curvesKey(curves, corners), key);
}

}  // namespace
}  // namespace limn::coarsen::test
