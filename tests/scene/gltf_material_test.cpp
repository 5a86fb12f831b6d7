#include "apps/scene/gltf_material.h"

#include <gtest/gtest.h>
#include <png.h>
#include <stb_image_write.h>

#include <cmath>
#include <numbers>

#include "apps/scene/image.h"
#include "tests/scene/gltf_writer.h"

namespace limn::scene {
namespace {

using test::GltfWriter;
using test::json;

/// 2 x 2: red, green, blue, and `last`.
std::vector<std::uint8_t> smallPng(const std::array<std::uint8_t, 4>& last) {
  Image image{2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, last[0], last[1], last[2], last[3]}};
  return encodePng(image, {}, 1);
}

/// A triangle with one material, one texture and one image of these bytes.
GltfWriter textured(const std::vector<std::uint8_t>& image, const json& material) {
  GltfWriter writer;
  writer.addTriangle()["material"] = 0;
  writer.root["materials"] = json::array({material});
  writer.root["images"] = {{{"bufferView", writer.addView(image)}, {"mimeType", "image/png"}}};
  writer.root["textures"] = {{{"source", 0}}};
  return writer;
}

const json kTextured = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};

TEST(BlinnPhong, FollowsTheDocumentedFormulas) {
  const raster::Material plastic = blinnPhongOf(glm::vec4(0.8f, 0.4f, 0.2f, 0.5f), 0.0, 0.5);
  EXPECT_EQ(plastic.baseColor, glm::vec4(0.8f, 0.4f, 0.2f, 0.5f));
  EXPECT_EQ(plastic.shininess, 30);                        // 2 / 0.25^2 - 2
  EXPECT_FLOAT_EQ(plastic.specular.x, 0.04f * 32.0f / 8);  // F (s + 2) / 8
  const raster::Material metal = blinnPhongOf(glm::vec4(0.8f, 0.4f, 0.2f, 1.0f), 1.0, 1.0);
  EXPECT_EQ(metal.shininess, 1);
  EXPECT_FLOAT_EQ(metal.baseColor.x, 0.4f);
  EXPECT_FLOAT_EQ(metal.specular.y, 0.4f * 3.0f / 8);
  const raster::Material mirror = blinnPhongOf(glm::vec4(1.0f), 7.0, -3.0);
  EXPECT_EQ(mirror.shininess, 1024);
  EXPECT_EQ(mirror.specular, glm::vec3(1.0f));
}

TEST(GltfMaterial, ReadsFactorsModesAndExtensions) {
  GltfWriter writer;
  writer.addTriangle()["material"] = 0;
  writer.root["materials"] = json::array(
      {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 2.0, 0.5}}, {"metallicFactor", 0}}},
        {"emissiveFactor", {1, 0.5, 0}},
        {"alphaMode", "BLEND"},
        {"doubleSided", true},
        {"extensions",
         {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
          {"KHR_materials_unlit", json::object()}}}}});
  const Scene scene = writer.load();
  ASSERT_EQ(scene.materials.size(), 2u);
  const raster::Material& m = scene.materials[0];
  EXPECT_EQ(m.baseColor, glm::vec4(0.5f, 0.25f, 1.0f, 0.5f));
  EXPECT_EQ(m.emissive, glm::vec3(4, 2, 0));
  EXPECT_EQ(m.alphaMode, raster::AlphaMode::kBlend);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_TRUE(m.unlit);
}

TEST(GltfMaterial, BlendWithoutTransparencyIsDrawnAsOpaque) {
  json material = kTextured;
  material["alphaMode"] = "BLEND";
  EXPECT_EQ(textured(smallPng({9, 9, 9, 255}), material).load().materials[0].alphaMode,
            raster::AlphaMode::kOpaque);
  EXPECT_EQ(textured(smallPng({9, 9, 9, 254}), material).load().materials[0].alphaMode,
            raster::AlphaMode::kBlend);
}

TEST(GltfMaterial, TextureTransformIsOffsetTimesRotationTimesScale) {
  json material = kTextured;
  material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.5, 0.25}}, {"rotation", std::numbers::pi / 2}, {"scale", {2, 3}}};
  const Scene scene = textured(smallPng({0, 0, 0, 255}), material).load();
  const raster::Material& m = scene.materials[0];
  // (u, v) -> scale (2u, 3v) -> counter-clockwise with v downward (3v, -2u) -> offset.
  const glm::vec3 uv(0.1f, 0.2f, 1.0f);
  EXPECT_NEAR(glm::dot(m.texcoordRow0, uv), 0.5f + 0.6f, 1e-6f);
  EXPECT_NEAR(glm::dot(m.texcoordRow1, uv), 0.25f - 0.2f, 1e-6f);
}

TEST(GltfTexture, TheSameImageIsDecodedOncePerUse) {
  json material = kTextured;
  material["normalTexture"] = {{"index", 0}};
  GltfWriter writer = textured(smallPng({0, 0, 0, 255}), material);
  writer.root["materials"].push_back(kTextured);
  writer.root["materials"].push_back(kTextured);  // not used by any triangle
  writer.addTriangle()["material"] = 1;
  const Scene scene = writer.load();
  EXPECT_EQ(scene.textures.size(), 2u);  // as colours and as numbers
  EXPECT_EQ(scene.materials[0].baseColorTexture, scene.materials[1].baseColorTexture);
  EXPECT_NE(scene.materials[0].baseColorTexture, scene.materials[0].normalTexture);
  EXPECT_EQ(scene.materials[2].baseColorTexture, nullptr);
  EXPECT_EQ(scene.textures[0]->width(), 2);
}

TEST(GltfTexture, ReadsJpeg) {
  std::vector<std::uint8_t> jpeg;
  const std::vector<std::uint8_t> pixels(8 * 16 * 3, 200);
  stbi_write_jpg_to_func(
      [](void* out, void* data, int size) {
        const auto* bytes = static_cast<const std::uint8_t*>(data);
        static_cast<std::vector<std::uint8_t>*>(out)->insert(
            static_cast<std::vector<std::uint8_t>*>(out)->end(), bytes, bytes + size);
      },
      &jpeg, 8, 16, 3, pixels.data(), 90);
  const Scene scene = textured(jpeg, kTextured).load();
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0]->width(), 8);
  EXPECT_EQ(scene.textures[0]->height(), 16);
  EXPECT_FALSE(scene.textures[0]->hasTransparency());
}

TEST(GltfTexture, BrokenImagesAreRefusedBeforeTheyTakeMemory) {
  std::vector<std::uint8_t> png = smallPng({0, 0, 0, 255});
  std::vector<std::uint8_t> cut(png.begin(), png.end() - 20);
  EXPECT_NE(textured(cut, kTextured).refusal().find("/images/0: "), std::string::npos);
  EXPECT_NE(textured({1, 2, 3, 4}, kTextured).refusal().find("/images/0: is neither PNG nor JPEG"),
            std::string::npos);
  EXPECT_NE(
      textured({0xFF, 0xD8, 0xFF, 0xE0, 0, 0}, kTextured).refusal().find("/images/0: is a damaged JPEG"),
      std::string::npos);
  png[16] = 0x7F;  // the width's first byte
  EXPECT_NE(textured(png, kTextured).refusal().find("limn takes 1 to 16384"), std::string::npos);
  png[16] = 0;
  png[18] = png[22] = 0x20;  // 8194 x 8194 in a hundred bytes
  EXPECT_NE(textured(png, kTextured).refusal().find("/images/0: "), std::string::npos);
}

/// A square of one bit per pixel, all black but the last one, in a few KiB.
std::vector<std::uint8_t> blackPng(int size, bool lastIsWhite, bool interlaced = false) {
  std::vector<std::uint8_t> bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep data, std::size_t count) {
        auto* out = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(p));
        out->insert(out->end(), data, data + count);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(size), static_cast<png_uint_32>(size), 1,
               PNG_COLOR_TYPE_GRAY, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::vector<std::uint8_t> black(static_cast<std::size_t>(size) / 8);
  std::vector<std::uint8_t> last = black;
  last.back() = lastIsWhite ? 1 : 0;
  for (int pass = png_set_interlace_handling(png); pass > 0; --pass)
    for (int y = 0; y < size; ++y) png_write_row(png, y + 1 == size ? last.data() : black.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

TEST(GltfTexture, OfASingleColorIsATexelHoweverLargeThePicture) {
  for (const bool interlaced : {false, true}) {
    const std::vector<std::uint8_t> png = blackPng(4096, false, interlaced);
    ASSERT_LT(png.size(), 64U << 10);
    const Scene scene = textured(png, kTextured).load();
    EXPECT_EQ(scene.textures[0]->width(), 1);
    EXPECT_EQ(textured(blackPng(64, true, interlaced), kTextured).load().textures[0]->width(), 64);
  }
  EXPECT_EQ(textured(blackPng(16384, false), kTextured).load().textures[0]->width(), 1);
}

TEST(GltfTexture, LargePicturesInSmallFilesAreReadUpToTheBudget) {
  const Scene scene = textured(blackPng(4096, true), kTextured).load();
  EXPECT_EQ(scene.textures[0]->width(), 4096);
  EXPECT_LE(scene.textures[0]->memoryBytes(), 11U * 4096 * 4096);
  const std::string refusal = textured(blackPng(8192, true), kTextured).refusal();
  EXPECT_NE(refusal.find("/images/0: needs 704 MiB more"), std::string::npos) << refusal;
  json twice = kTextured;
  twice["normalTexture"] = {{"index", 0}};
  EXPECT_NE(textured(blackPng(4096, true), twice).refusal().find("/images/0: needs 176 MiB more"),
            std::string::npos);
}

TEST(GltfTexture, WithoutCoordinatesIsSaid) {
  const Scene scene = textured(smallPng({0, 0, 0, 255}), kTextured).load();
  ASSERT_EQ(scene.notices.size(), 1u);
  EXPECT_NE(scene.notices[0].find("Mesh 0: 1 primitives have a texture but no coordinates"),
            std::string::npos);
  EXPECT_TRUE(textured(smallPng({0, 0, 0, 255}), json::object()).load().notices.empty());
}

TEST(GltfTexture, SamplersAndTexcoordSets) {
  json material = kTextured;
  material["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
  GltfWriter writer = textured(smallPng({0, 0, 0, 255}), material);
  json& attributes = writer.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = writer.addArray<float>({9, 9, 9, 9, 9, 9}, "VEC2");
  attributes["TEXCOORD_1"] = writer.addArray<std::uint8_t>({0, 0, 255, 0, 0, 255}, "VEC2", true);
  const Scene scene = writer.load();
  EXPECT_EQ(scene.meshes[0].texcoords[1], glm::vec2(1, 0));
}

}  // namespace
}  // namespace limn::scene
