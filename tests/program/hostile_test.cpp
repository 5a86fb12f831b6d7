// Small files that ask for much: whatever 64 KiB hold, limn takes at most 256 MiB and five seconds to draw or refuse it.
#include <gtest/gtest.h>

#include "apps/scene/image.h"
#include "tests/program/run_program.h"
#include "tests/scene/gltf_writer.h"

namespace {

using limn::scene::test::GltfWriter;
using limn::scene::test::json;
using limn::test::ProgramTest;
using limn::test::Result;
using limn::test::operator+;  // NOLINT(misc-unused-using-decls): it sees no use of operators

class Hostile : public ProgramTest {
 protected:
  /// Draws the model; `message` is part of what is said when it is refused, or null where it is drawn.
  void expect(const std::string& name, const std::string& bytes, const char* message,
              const std::vector<std::string>& options = {}) const {
    ASSERT_LE(bytes.size(), 64U << 10) << name;
    write(name, bytes);
    const Result result = limn(std::vector<std::string>{"render", name, "-o", "picture.png"} + options);
    EXPECT_EQ(result.status, message == nullptr ? 0 : 3) << name << ": " << result.err;
    if (message != nullptr) {
      EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    }
#if defined(__OPTIMIZE__) && !defined(LIMN_SANITIZED)
    EXPECT_LE(result.peakBytes, 256U << 20) << name;
    // Five seconds of two processors, whatever else the machine does.
    EXPECT_LE(result.processorSeconds, 10.0) << name;
#endif
  }
  void expect(const std::string& name, const GltfWriter& writer, const char* message,
              const std::vector<std::string>& options = {}) const {
    const auto bytes = writer.glb();
    expect(name + ".glb", std::string(bytes.begin(), bytes.end()), message, options);
  }
};

/// A sheet of n × n points in folds that turn against the eye everywhere.
json foldedSheet(GltfWriter& writer, std::uint16_t n) {
  std::vector<std::uint8_t> points;
  std::vector<std::uint16_t> indices;
  for (std::uint16_t y = 0; y < n; ++y)
    for (std::uint16_t x = 0; x < n; ++x) {
      const std::uint16_t a = static_cast<std::uint16_t>(y * n + x),
                          below = static_cast<std::uint16_t>(a + n);
      for (const int c : {2 * x, 2 * y, (x * 7 + y * 3) % 11 * 6, 0})
        points.push_back(static_cast<std::uint8_t>(c));
      if (x + 1 == n || y + 1 == n) continue;
      for (const int i : {+a, a + 1, below + 1, +a, below + 1, +below})
        indices.push_back(static_cast<std::uint16_t>(i));
    }
  const int positions = writer.addAccessor({{"bufferView", writer.addView(points, 4)},
                                            {"componentType", 5121},
                                            {"count", n * n},
                                            {"type", "VEC3"}});
  writer.root["extensionsUsed"] = {"KHR_mesh_quantization"};
  return {{"attributes", {{"POSITION", positions}}}, {"indices", writer.addArray(indices, "SCALAR")}};
}

/// An accessor of zeros that takes no bytes in the file.
int zeros(GltfWriter& writer, std::size_t count) {
  return writer.addAccessor({{"componentType", 5126}, {"count", count}, {"type", "VEC3"}});
}

TEST_F(Hostile, CopiesOfAMesh) {
  for (const int copies : {80, 1500}) {
    GltfWriter writer;
    const json primitive = foldedSheet(writer, 40);
    writer.addMesh(primitive["attributes"], primitive["indices"]);
    for (int i = 1; i < copies; ++i) writer.root["nodes"].push_back({{"mesh", 0}});
    expect("copies" + std::to_string(copies), writer, copies == 80 ? nullptr : "/nodes: needs");
  }
}

TEST_F(Hostile, CopiesOfArrays) {
  GltfWriter writer;
  const json primitive = foldedSheet(writer, 40);
  writer.addMesh(primitive["attributes"], primitive["indices"]);
  writer.root["meshes"][0]["primitives"] = std::vector<json>(600, primitive);
  expect("primitives", writer, "MiB are left to a file of this size");

  GltfWriter meshes;
  const int positions = zeros(meshes, 30000);
  for (int i = 0; i < 500; ++i) meshes.addMesh({{"POSITION", positions}});
  expect("meshes", meshes, "/meshes/");

  GltfWriter targets;
  const int offsets = zeros(targets, 3000);
  const json target = {{"POSITION", offsets}, {"NORMAL", offsets}};
  targets.addMesh({{"POSITION", offsets}})["targets"] = std::vector<json>(1500, target);
  expect("targets", targets, "/meshes/0");
}

TEST_F(Hostile, CountsWithoutBytes) {
  for (const std::size_t count : {std::size_t{300'000}, std::size_t{3'000'000}, std::size_t{2'000'000'000}}) {
    GltfWriter writer;
    writer.addMesh({{"POSITION", zeros(writer, count)}});
    expect("zeros" + std::to_string(count), writer, count == 300'000 ? nullptr : "/meshes/0");
  }
}

/// `count` triangles over the whole picture, in 84 layers.
void addLayers(GltfWriter& writer, std::size_t count) {
  constexpr std::size_t kLayers = 84;
  std::vector<float> positions;
  for (std::size_t i = 0; i < kLayers; ++i)
    for (const auto& [x, y] : {std::pair(-1.7f, -1.0f), std::pair(1.7f, -1.0f), std::pair(0.0f, 2.0f)})
      positions.insert(positions.end(), {x, y, 0.0002f * static_cast<float>(i)});
  std::vector<std::uint8_t> indices;
  for (std::size_t t = 0; t < count; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      indices.push_back(static_cast<std::uint8_t>(t * kLayers / count * 3 + k));
  writer.addMesh({{"POSITION", writer.addArray(positions, "VEC3")}},
                 writer.addArray(indices, "SCALAR"))["material"] = 0;
}

TEST_F(Hostile, LayersOverLayers) {
  for (const std::string mode : {"OPAQUE", "MASK", "BLEND"}) {
    GltfWriter writer;
    addLayers(writer, 19000);
    const json color = {{"baseColorFactor", {1, 0.5, 0.2, 0.6}}};
    writer.root["materials"] = {
        {{"alphaMode", mode}, {"doubleSided", true}, {"pbrMetallicRoughness", color}}};
    expect(mode, writer, "/meshes/0: to draw it in so many layers");
  }
}

TEST_F(Hostile, LightsOverLights) {
  GltfWriter writer;
  addLayers(writer, 50);
  writer.root["materials"] = {{{"alphaMode", "BLEND"}, {"doubleSided", true}}};
  writer.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  const json light = {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  for (int i = 0; i < 900; ++i) writer.root["nodes"].push_back(light);
  expect("lights", writer, "/meshes/0: to draw it in so many layers");
}

TEST_F(Hostile, LongEdgesInAllTriangles) {
  GltfWriter writer;
  constexpr std::size_t kPoints = 250, kTriangles = 19000;
  std::uint32_t random = 1;
  const auto below = [&random](std::uint32_t end) {
    random = random * 1664525U + 1013904223U;
    return random / 65536U % end;
  };
  std::vector<float> positions;
  for (std::size_t i = 0; i < 3 * kPoints; ++i) positions.push_back(static_cast<float>(below(1000)));
  std::vector<std::uint8_t> indices;
  for (std::size_t i = 0; i < 3 * kTriangles; ++i)
    indices.push_back(static_cast<std::uint8_t>(below(kPoints)));
  writer.addMesh({{"POSITION", writer.addArray(positions, "VEC3")}}, writer.addArray(indices, "SCALAR"));
  expect("soup", writer, nullptr);
  expect("soup", writer, "/meshes: each of", {"--method", "pn"});
}

TEST_F(Hostile, PicturesOverPictures) {
  GltfWriter writer;
  json primitive = writer.addTriangle();
  const limn::scene::Image black{4096, 2048, std::vector<std::uint8_t>(std::size_t{4} * 4096 * 2048)};
  const json image = {{"bufferView", writer.addView(limn::scene::encodePng(black, {}, 9))},
                      {"mimeType", "image/png"}};
  for (int i = 0; i < 100; ++i) {
    writer.root["images"].push_back(image);
    writer.root["textures"].push_back({{"source", i}});
    writer.root["materials"].push_back({{"normalTexture", {{"index", i}}}});
    primitive["material"] = i;
    writer.root["meshes"][0]["primitives"][i] = primitive;
  }
  expect("pictures", writer, "/images/");
}

TEST_F(Hostile, JsonWithoutEnd) {
  const auto list = [](const std::string& start, const std::string& item, const std::string& end) {
    std::string text = start + item;
    while (text.size() + item.size() + end.size() + 1 < 64U << 10) text += "," + item;
    return text + end;
  };
  const std::string start = R"({"asset":{"version":"2.0"},)";
  expect("nodes.gltf", list(start + R"("nodes":[)", "{}", "]}"), nullptr);
  expect("extras.gltf", list(start + R"("extras":[)", "[]", "]}"), nullptr);
  expect("accessors.gltf",
         list(start + R"("accessors":[)", R"({"componentType":5126,"count":1,"type":"VEC3"})", "]}"),
         nullptr);
  expect("deep.gltf", start + "\"extras\":" + std::string(60000, '['), "nested");
}

}  // namespace
