// Small files written here: what comes out must be exactly what went in.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "apps/scene/gltf_primitive.h"
#include "apps/scene/pose.h"
#include "tests/scene/gltf_writer.h"
#include "tests/scene/mesh_facts.h"

namespace limn::scene {
namespace {

using test::GltfWriter;
using test::json;

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

TEST(GltfMesh, RoundTripsPositionsNormalsAndIndicesExactly) {
  GltfWriter writer;
  const std::vector<float> positions = {0.1f, -0.2f, 0.3f, 1.7f, 0.25f, -1e-3f, 0.5f, 1.0f, 1.0f / 3};
  const std::vector<float> normals = {0, 0, 1, 0, 1, 0, 1, 0, 0};
  writer.addMesh(
      {{"POSITION", writer.addArray(positions, "VEC3")}, {"NORMAL", writer.addArray(normals, "VEC3")}},
      writer.addArray<std::uint16_t>({2, 0, 1}, "SCALAR"));
  const Mesh mesh = writer.load().meshes[0];
  ASSERT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{2, 0, 1}));
  EXPECT_EQ(mesh.origin, glm::dvec3(0.0));
  EXPECT_EQ(mesh.scale, 1.0);
  for (std::size_t v = 0; v < 3; ++v) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(mesh.positions[v][c], positions[3 * v + static_cast<std::size_t>(c)]);
      EXPECT_EQ(mesh.normals[v][c], normals[3 * v + static_cast<std::size_t>(c)]);
    }
  }
}

TEST(GltfMesh, TakesEveryIndexTypeAndNone) {
  GltfWriter writer;
  const int positions = writer.addArray(kSquare, "VEC3");
  writer.addMesh({{"POSITION", positions}}, writer.addArray<std::uint8_t>({0, 1, 2}, "SCALAR"));
  writer.addMesh({{"POSITION", positions}}, writer.addArray<std::uint16_t>({0, 1, 2}, "SCALAR"));
  writer.addMesh({{"POSITION", positions}}, writer.addArray<std::uint32_t>({0, 1, 2}, "SCALAR"));
  writer.addMesh({{"POSITION", writer.addArray<float>({0, 0, 0, 1, 0, 0, 1, 1, 0}, "VEC3")}});
  const Scene scene = writer.load();
  for (const Mesh& mesh : scene.meshes) {
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(mesh.positions.size(), 3u);  // the fourth corner of the square is in no triangle
    EXPECT_EQ(mesh.positions[2], glm::vec3(1, 1, 0));
  }
}

TEST(GltfMesh, ZeroIndicesWithoutAViewMakeDegenerateTriangles) {
  GltfWriter writer;
  const int positions = writer.addArray(kSquare, "VEC3");
  writer.addMesh({{"POSITION", positions}},
                 writer.addAccessor({{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}}));
  EXPECT_EQ(writer.load().meshes[0].indices, (std::vector<std::uint32_t>{0, 0, 0}));
}

TEST(GltfMesh, StripsAndFansKeepTheirWinding) {
  for (const int mode : {5, 6}) {
    GltfWriter writer;
    // Strip: zigzag over the square. Fan: round it. Both face +z.
    const std::vector<std::uint16_t> corners =
        mode == 5 ? std::vector<std::uint16_t>{0, 1, 3, 2} : std::vector<std::uint16_t>{0, 1, 2, 3};
    writer.addMesh({{"POSITION", writer.addArray(kSquare, "VEC3")}}, writer.addArray(corners, "SCALAR"),
                   mode);
    const Mesh mesh = writer.load().meshes[0];
    ASSERT_EQ(mesh.indices.size(), 6u);
    for (std::size_t t = 0; t < 6; t += 3) {
      const glm::vec3 a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]];
      EXPECT_GT(glm::cross(b - a, mesh.positions[mesh.indices[t + 2]] - a).z, 0.0f) << "mode " << mode;
    }
    for (const glm::vec3& n : mesh.normals) EXPECT_EQ(n, glm::vec3(0, 0, 1));
  }
}

TEST(GltfMesh, TriangulateDropsIncompleteAndStitchingTriangles) {
  EXPECT_EQ(triangulate({0, 1, 2, 3, 4}, 4), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(triangulate({0, 1}, 5), std::vector<std::uint32_t>{});
  EXPECT_EQ(triangulate({0, 1, 2, 3}, 5), (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
  EXPECT_EQ(triangulate({0, 1, 2, 2, 3, 3, 4, 5}, 5), (std::vector<std::uint32_t>{0, 1, 2, 3, 5, 4}));
  EXPECT_EQ(triangulate({9, 1, 2, 3}, 6), (std::vector<std::uint32_t>{1, 2, 9, 2, 3, 9}));
}

TEST(GltfMesh, PointsAndLinesAreLeftOutWithANotice) {
  GltfWriter writer;
  writer.addTriangle();
  writer.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
  const Scene scene = writer.load();
  EXPECT_EQ(scene.meshes[0].indices.size(), 3u);
  ASSERT_EQ(scene.notices.size(), 1u);
  EXPECT_NE(scene.notices[0].find("points or lines"), std::string::npos);
}

TEST(GltfMesh, SparseAccessorsReplaceElements) {
  GltfWriter writer;
  const int base = writer.addView(kSquare);
  const json sparse = {
      {"count", 2},
      {"indices", {{"bufferView", writer.addView<std::uint8_t>({1, 3})}, {"componentType", 5121}}},
      {"values", {{"bufferView", writer.addView<float>({5, 6, 7, 8, 9, 10})}}}};
  const json accessor = {{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}, {"sparse", sparse}};
  json based = accessor;
  based["bufferView"] = base;
  const int indices = writer.addArray<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
  writer.addMesh({{"POSITION", writer.addAccessor(based)}}, indices);
  writer.addMesh({{"POSITION", writer.addAccessor(accessor)}}, indices);  // zeros where nothing is replaced
  const Scene scene = writer.load({.creaseDegrees = 180});
  for (const Mesh& mesh : scene.meshes) {
    EXPECT_EQ(mesh.positions[1], glm::vec3(5, 6, 7));
    EXPECT_EQ(mesh.positions[3], glm::vec3(8, 9, 10));
  }
  EXPECT_EQ(scene.meshes[0].positions[2], glm::vec3(1, 1, 0));
  EXPECT_EQ(scene.meshes[1].positions[2], glm::vec3(0, 0, 0));
}

TEST(GltfMesh, InterleavedAttributesWithAStrideAndOffsets) {
  GltfWriter writer;
  std::vector<float> rows;
  for (int v = 0; v < 3; ++v) {
    const float x = static_cast<float>(v == 1), y = static_cast<float>(v == 2), u = static_cast<float>(v) / 4;
    rows.insert(rows.end(), {x, y, 0, 0, 0, 1, u, 1 - u});
  }
  const int view = writer.addView(rows, 32);
  const auto part = [&](const char* type, int offset) {
    return writer.addAccessor({{"bufferView", view},
                               {"byteOffset", offset},
                               {"componentType", 5126},
                               {"count", 3},
                               {"type", type}});
  };
  writer.addMesh(
      {{"POSITION", part("VEC3", 0)}, {"NORMAL", part("VEC3", 12)}, {"TEXCOORD_0", part("VEC2", 24)}});
  const Mesh mesh = writer.load().meshes[0];
  EXPECT_EQ(mesh.positions[2], glm::vec3(0, 1, 0));
  EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.texcoords[1], glm::vec2(0.25f, 0.75f));
}

TEST(GltfMesh, QuantizedAttributes) {
  GltfWriter writer;
  writer.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int view = writer.addView<std::int16_t>({-32768, 0, 32767, 0, 32767, 0, 0, 0, 0, -1, 2, 0}, 8);
  const json position = {{"bufferView", view}, {"componentType", 5122}, {"count", 3}, {"type", "VEC3"}};
  json normalized = position;
  normalized["normalized"] = true;
  const int normals = writer.addAccessor(
      {{"bufferView", writer.addView<std::int8_t>({0, 0, 127, 0, 0, 127, 0, 0, -128, 0, 0, 0}, 4)},
       {"componentType", 5120},
       {"count", 3},
       {"type", "VEC3"},
       {"normalized", true}});
  writer.addMesh({{"POSITION", writer.addAccessor(position)}, {"NORMAL", normals}});
  writer.addMesh({{"POSITION", writer.addAccessor(normalized)}, {"NORMAL", normals}});
  const Scene scene = writer.load();
  const auto inFile = [](const Mesh& mesh, std::size_t v) {
    return mesh.origin + mesh.scale * glm::dvec3(mesh.positions[v]);
  };
  EXPECT_NEAR(inFile(scene.meshes[0], 0).x, -32768.0, 0.01);
  EXPECT_NEAR(inFile(scene.meshes[0], 2).y, -1.0, 0.01);
  EXPECT_EQ(scene.meshes[1].positions[0], glm::vec3(-1, 0, 1));  // the most negative short is -1 too
  EXPECT_EQ(scene.meshes[1].normals[1], glm::vec3(0, 1, 0));
  EXPECT_EQ(scene.meshes[1].normals[2], glm::vec3(-1, 0, 0));
}

TEST(GltfMesh, ColorsOfAllTypes) {
  GltfWriter writer;
  const int positions = writer.addArray<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  writer.addMesh(
      {{"POSITION", positions}, {"COLOR_0", writer.addArray<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3")}});
  writer.addMesh({{"POSITION", positions},
                  {"COLOR_0", writer.addArray<std::uint8_t>({255, 0, 0, 51, 0, 255, 0, 51, 0, 0, 255, 51},
                                                            "VEC4", true)}});
  writer.addMesh(
      {{"POSITION", positions},
       {"COLOR_0", writer.addArray<std::uint16_t>(
                       {65535, 0, 0, 13107, 0, 65535, 0, 13107, 0, 0, 65535, 13107}, "VEC4", true)}});
  const Scene scene = writer.load();
  for (std::size_t m = 0; m < 3; ++m) {
    const float alpha = m == 0 ? 1.0f : 0.2f;
    EXPECT_EQ(scene.meshes[m].colors[0], glm::vec4(1, 0, 0, alpha)) << m;
    EXPECT_EQ(scene.meshes[m].colors[2], glm::vec4(0, 0, 1, alpha)) << m;
  }
}

TEST(GltfMesh, PrimitivesOfAMeshShareArraysAndBecomeParts) {
  GltfWriter writer;
  writer.root["materials"] = json::array({json::object(), json::object()});
  json& first = writer.addTriangle();
  first["material"] = 1;
  const json second = {
      {"attributes",
       {{"POSITION", 0}, {"COLOR_0", writer.addArray<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3")}}},
      {"material", 1}};
  const json third = {{"attributes", {{"POSITION", 0}}}};
  writer.root["meshes"][0]["primitives"].push_back(second);
  writer.root["meshes"][0]["primitives"].push_back(third);
  const Scene scene = writer.load();
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_EQ(mesh.parts[0].material, 1u);
  EXPECT_EQ(mesh.parts[0].triangleCount, 2u);
  EXPECT_EQ(mesh.parts[1].firstTriangle, 2u);
  EXPECT_EQ(mesh.parts[1].material, scene.materials.size() - 1);
  ASSERT_EQ(mesh.colors.size(), 9u);
  EXPECT_EQ(mesh.colors[0], glm::vec4(1));
  EXPECT_EQ(mesh.colors[3], glm::vec4(1, 0, 0, 1));
  EXPECT_EQ(mesh.colors[8], glm::vec4(1));
}

TEST(GltfMesh, NormalsOfNoLengthAreReplacedWithANotice) {
  GltfWriter writer;
  writer.addMesh({{"POSITION", writer.addArray<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")},
                  {"NORMAL", writer.addArray<float>({0, 0, 0, 0, 0, 2, 0, 3, 4}, "VEC3")}});
  const Scene scene = writer.load();
  EXPECT_EQ(scene.meshes[0].normals[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.meshes[0].normals[1], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.meshes[0].normals[2], glm::vec3(0, 0.6f, 0.8f));
  ASSERT_EQ(scene.notices.size(), 1u);
}

}  // namespace
}  // namespace limn::scene
