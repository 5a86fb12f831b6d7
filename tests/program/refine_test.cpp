// limn refine: the file is sound glTF, holds what is drawn, and limn draws it to the same picture.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/scene/image.h"
#include "tests/program/run_program.h"
#include "tests/scene/gltf_writer.h"

namespace {

namespace scene = limn::scene;
using limn::test::operator+;  // NOLINT(misc-unused-using-decls): it sees no use of operators
using limn::test::ProgramTest;
using limn::test::Result;
using nlohmann::json;
using Words = std::vector<std::string>;

struct Glb {
  json document;
  std::string binary;

  explicit Glb(const std::string& bytes) {
    const auto word = [&](std::size_t at) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + at, 4);
      return std::size_t{value};
    };
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(8), bytes.size());
    const std::size_t length = word(12);
    EXPECT_EQ(length % 4, 0U);
    document = json::parse(bytes.substr(20, length));
    EXPECT_EQ(word(20 + length), bytes.size() - 28 - length);
    binary = bytes.substr(28 + length);
    EXPECT_EQ(document["buffers"][0]["byteLength"], binary.size());
  }

  template <class T>
  std::vector<T> values(int accessor, std::size_t width) const {
    const json& a = document["accessors"][static_cast<std::size_t>(accessor)];
    const json& view = document["bufferViews"][a["bufferView"].get<std::size_t>()];
    std::vector<T> all(a["count"].get<std::size_t>() * width);
    EXPECT_EQ(all.size() * sizeof(T), view["byteLength"].get<std::size_t>());
    std::memcpy(all.data(), binary.data() + view["byteOffset"].get<std::size_t>(), all.size() * sizeof(T));
    return all;
  }
};

class Refine : public ProgramTest {};

TEST_F(Refine, HoldsSoundTrianglesWithUnitNormals) {
  for (const char* method : {"flat", "patches", "curves", "pn"}) {
    const Result result = limn({"refine", "builtin:pawn", "-o", "p.glb", "--method", method});
    ASSERT_EQ(result.status, 0) << result.err;
    const Glb glb(contents("p.glb"));
    const json& primitive = glb.document["meshes"][0]["primitives"][0];
    const auto positions = glb.values<float>(primitive["attributes"]["POSITION"], 3);
    const auto normals = glb.values<float>(primitive["attributes"]["NORMAL"], 3);
    const auto indices = glb.values<std::uint16_t>(primitive["indices"], 1);
    ASSERT_EQ(positions.size(), normals.size());
    for (std::size_t i = 0; i < normals.size(); i += 3)
      ASSERT_NEAR(std::hypot(normals[i], normals[i + 1], normals[i + 2]), 1.0, 1e-6);
    for (const std::uint32_t index : indices) ASSERT_LT(index, positions.size() / 3);
    if (std::string(method) == "flat")
      EXPECT_EQ(indices.size(), 3 * 360U);
    else
      EXPECT_GT(indices.size(), 3 * 360U) << method;
  }
}

TEST_F(Refine, IsDrawnToTheOutlineItWasMadeFrom) {
  // Drawn flat, the refined triangles cover exactly what the smooth frame covers. (The colours differ a little: glTF's
  // metallic-roughness materials cannot say limn's own highlight.)
  const Words view = {"--eye", "0,3,6", "--target", "0,1,0", "--size", "160x160"};
  const Words raw = {"--samples", "1", "--format", "rgba"};
  ASSERT_EQ(limn(Words{"refine", "builtin:pawn", "-o", "p.glb"} + view).status, 0);
  ASSERT_EQ(limn(Words{"render", "builtin:pawn", "-o", "smooth.rgba"} + view + raw).status, 0);
  const Result drawn = limn(Words{"render", "p.glb", "-o", "refined.rgba", "--method", "flat"} + view + raw);
  ASSERT_EQ(drawn.status, 0) << drawn.err;
  const std::string smooth = contents("smooth.rgba"), refined = contents("refined.rgba");
  ASSERT_EQ(smooth.size(), 4U * 160 * 160);
  ASSERT_EQ(refined.size(), smooth.size());
  int covered = 0, differ = 0;
  for (std::size_t alpha = 3; alpha < smooth.size(); alpha += 4) {
    covered += smooth[alpha] != 0;
    differ += smooth[alpha] != refined[alpha];
  }
  EXPECT_GT(covered, 160 * 160 / 40);
  EXPECT_EQ(differ, 0);
}

TEST_F(Refine, AlphasAreThoseOfTheCoarseEdges) {
  ASSERT_EQ(limn({"refine", "builtin:icosphere-320", "-o", "s.glb", "--alpha"}).status, 0);
  const Glb glb(contents("s.glb"));
  const json& lines = glb.document["meshes"][1]["primitives"][0];
  EXPECT_EQ(lines["mode"], 1);
  const auto alphas = glb.values<float>(lines["attributes"]["_ALPHA"], 1);
  ASSERT_EQ(alphas.size(), 2 * 480U);
  std::size_t smooth = 0, flat = 0;
  for (std::size_t i = 0; i < alphas.size(); i += 2) {
    ASSERT_EQ(alphas[i], alphas[i + 1]);
    ASSERT_GE(alphas[i], 0.0f);
    ASSERT_LE(alphas[i], 1.0f);
    (alphas[i] > 0 ? smooth : flat) += 1;
  }
  EXPECT_GT(smooth, 20U);
  EXPECT_GT(flat, 20U);
}

/// Two triangles, folded, with a picture on them that lies in a file beside the model.
scene::test::GltfWriter textured() {
  scene::test::GltfWriter writer;
  const json attributes = {
      {"POSITION", writer.addArray<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0.5f, -1, 1, 0}, "VEC3")},
      {"NORMAL",
       writer.addArray<float>({-0.6f, -0.6f, 1, 0.6f, -0.6f, 1, 0.6f, 0.6f, 1, -0.6f, 0.6f, 1}, "VEC3")},
      {"TANGENT", writer.addArray<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4")},
      {"TEXCOORD_1", writer.addArray<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2")}};
  writer.addMesh(attributes, writer.addArray<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR"))["material"] = 1;
  writer.root["images"] = {{{"uri", "four.png"}}};
  writer.root["samplers"] = {{{"magFilter", 9728}}};
  writer.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  const json unused = json::object();
  const json transform = {{"KHR_texture_transform", {{"scale", {2, 3}}}}};
  writer.root["materials"] = {
      unused,
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}, {"extensions", transform}}},
         {"roughnessFactor", 0.3}}},
       {"normalTexture", {{"index", 0}, {"texCoord", 1}, {"extensions", transform}}},
       {"doubleSided", true}}};
  writer.root["extensionsUsed"] = {"KHR_texture_transform"};
  return writer;
}

TEST_F(Refine, KeepsTexturesAndMaterials) {
  const scene::Image four{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 90, 90, 255, 255, 255, 255, 0, 255}};
  const auto png = scene::encodePng(four, {}, 1);
  write("four.png", std::string(png.begin(), png.end()));
  scene::test::GltfWriter embedded = textured();
  embedded.root["images"] = {{{"bufferView", embedded.addView(png)}, {"mimeType", "image/png"}}};
  const Words view = {"--eye", "1,2,4", "--target", "0,0,0", "--size", "120x120", "--method", "flat"};
  for (const scene::test::GltfWriter& fold : {textured(), embedded}) {
    const auto glb = fold.glb();
    write("fold.glb", std::string(glb.begin(), glb.end()));
    ASSERT_EQ(limn(Words{"refine", "fold.glb", "-o", "deep/r.glb"} + view).status, 0);
    const json document = Glb(contents("deep/r.glb")).document;
    EXPECT_EQ(document["materials"], fold.root["materials"]);
    EXPECT_EQ(document["extensionsUsed"], json::array({"KHR_texture_transform"}));
    EXPECT_EQ(document["images"][0]["mimeType"], "image/png");
    // Flat triangles lose nothing on the way, so the pictures are the same to the last bit.
    ASSERT_EQ(limn(Words{"render", "fold.glb", "-o", "a.png"} + view).status, 0);
    ASSERT_EQ(limn(Words{"render", "deep/r.glb", "-o", "b.png"} + view).status, 0);
    const Result compared = limn({"compare", "a.png", "b.png"});
    EXPECT_EQ(compared.status, 0) << compared.out;
    const scene::Image drawn = scene::readPng(path("a.png"));
    EXPECT_TRUE(std::any_of(drawn.rgba.begin(), drawn.rgba.end(), [](std::uint8_t v) { return v > 0; }));
  }
}

TEST_F(Refine, KeepsTheSetsThatMaterialsAskForAndNoOthers) {
  scene::test::GltfWriter writer = textured();
  json& material = writer.root["materials"][1];
  material["extras"] = {{"texCoord", "x"}};
  material["pbrMetallicRoughness"].erase("baseColorTexture");
  material["normalTexture"] = {{"index", 0}, {"texCoord", 1}};
  material["extensions"]["VENDOR_coat"] = {{"coatTexture", {{"index", 0}, {"texCoord", 2}}}};
  const auto png = scene::encodePng({2, 2, std::vector<std::uint8_t>(16, 90)}, {}, 1);
  write("four.png", std::string(png.begin(), png.end()));
  const auto glb = writer.glb();
  write("sets.glb", std::string(glb.begin(), glb.end()));
  const Result result = limn({"refine", "sets.glb", "-o", "r.glb"});
  ASSERT_EQ(result.status, 0) << result.err;
  const json document = Glb(contents("r.glb")).document;
  EXPECT_EQ(document["materials"], writer.root["materials"]);
  const json& attributes = document["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_TRUE(attributes.contains("TEXCOORD_2"));
  EXPECT_FALSE(attributes.contains("TEXCOORD_3"));
}

TEST_F(Refine, TakesAPictureThatSeveralImagesNameOnce) {
  const scene::Image four{2, 2, std::vector<std::uint8_t>(16, 90)};
  const auto png = scene::encodePng(four, {}, 1);
  write("four.png", std::string(png.begin(), png.end()));
  scene::test::GltfWriter writer = textured();
  writer.root["images"] = {{{"uri", "four.png"}}, {{"uri", "./four.png"}}, {{"uri", "f%6Fur.png"}}};
  const auto glb = writer.glb();
  write("fold.glb", std::string(glb.begin(), glb.end()));
  ASSERT_EQ(limn({"refine", "fold.glb", "-o", "r.glb"}).status, 0);
  const json images = Glb(contents("r.glb")).document["images"];
  ASSERT_EQ(images.size(), 3U);
  for (const json& image : images) EXPECT_EQ(image, images[0]);
}

TEST_F(Refine, RefusesWhatCannotBe) {
  EXPECT_EQ(limn({"refine", "builtin:pawn"}).status, 2);
  EXPECT_EQ(limn({"refine", "builtin:pawn", "-o", "a.glb", "--frame", "2"}).status, 2);
  EXPECT_EQ(limn({"refine", "builtin:pawn", "-o", "/dev/full"}).status, 4);
  EXPECT_EQ(limn({"refine", "nothing.glb", "-o", "a.glb"}).status, 3);
}

}  // namespace
