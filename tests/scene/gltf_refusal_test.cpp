// Files that cannot be drawn safely are refused, and the message names the place and a remedy.
#include <gtest/gtest.h>

#include <limits>

#include "apps/scene/gltf_json.h"
#include "tests/scene/gltf_writer.h"

namespace limn::scene {
namespace {

using test::GltfWriter;
using test::json;

/// What `change` makes of a file with one indexed triangle is refused at `place`.
template <class Change>
void expectRefusal(const std::string& place, const Change& change) {
  GltfWriter writer;
  const int positions = writer.addArray<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  writer.addMesh({{"POSITION", positions}}, writer.addArray<std::uint16_t>({0, 1, 2}, "SCALAR"));
  ASSERT_EQ(writer.refusal(), "");
  change(writer);
  const std::string message = writer.refusal();
  EXPECT_TRUE(message.starts_with("test.glb: " + place + ": ")) << place << "\n" << message;
}

TEST(GltfRefusal, MembersOfTheWrongKind) {
  expectRefusal("/meshes", [](GltfWriter& w) { w.root["meshes"] = 3; });
  expectRefusal("/meshes/0/primitives/0/attributes", [](GltfWriter& w) {
    w.root["meshes"][0]["primitives"][0].erase("attributes");
    w.root["meshes"][0]["primitives"][0]["attributes"] = {1};
  });
  expectRefusal("/accessors/0/type", [](GltfWriter& w) { w.root["accessors"][0]["type"] = "VEC5"; });
  expectRefusal("/accessors/0/count", [](GltfWriter& w) { w.root["accessors"][0]["count"] = -1; });
  expectRefusal("/accessors/0/count", [](GltfWriter& w) { w.root["accessors"][0]["count"] = 2.5; });
  expectRefusal("/accessors/0/componentType",
                [](GltfWriter& w) { w.root["accessors"][0]["componentType"] = 5124; });
  expectRefusal("/accessors/0", [](GltfWriter& w) { w.root["accessors"][0].erase("componentType"); });
  expectRefusal("/nodes/0/rotation", [](GltfWriter& w) { w.root["nodes"][0]["rotation"] = {0, 0, 1}; });
  expectRefusal("/nodes/0/translation/1", [](GltfWriter& w) {
    w.root["nodes"][0]["translation"] = {0, 1.1e15, 1};
  });
  expectRefusal("/asset/version", [](GltfWriter& w) { w.root["asset"]["version"] = "1.0"; });
  expectRefusal("/", [](GltfWriter& w) { w.root.erase("asset"); });
}

TEST(GltfRefusal, ReferencesToWhatIsNotThere) {
  expectRefusal("/nodes/0/mesh", [](GltfWriter& w) { w.root["nodes"][0]["mesh"] = 1; });
  expectRefusal("/nodes/0/skin", [](GltfWriter& w) { w.root["nodes"][0]["skin"] = 0; });
  expectRefusal("/scene", [](GltfWriter& w) { w.root["scene"] = 0; });
  expectRefusal("/meshes/0/primitives/0/material",
                [](GltfWriter& w) { w.root["meshes"][0]["primitives"][0]["material"] = 0; });
  expectRefusal("/meshes/0/primitives/0/attributes/A~1B~0",
                [](GltfWriter& w) { w.root["meshes"][0]["primitives"][0]["attributes"]["A/B~"] = 9; });
  expectRefusal("/accessors/0/bufferView", [](GltfWriter& w) { w.root["accessors"][0]["bufferView"] = 2; });
  expectRefusal("/bufferViews/1/buffer", [](GltfWriter& w) { w.root["bufferViews"][1]["buffer"] = 1; });
}

TEST(GltfRefusal, AccessorsAndViewsBeyondTheirBytes) {
  expectRefusal("/accessors/0", [](GltfWriter& w) { w.root["accessors"][0]["count"] = 4; });
  expectRefusal("/accessors/0", [](GltfWriter& w) { w.root["accessors"][0]["byteOffset"] = 4; });
  expectRefusal("/accessors/0", [](GltfWriter& w) { w.root["accessors"][0]["count"] = 9007199254740992; });
  expectRefusal("/accessors/0", [](GltfWriter& w) { w.root["bufferViews"][0]["byteStride"] = 16; });
  expectRefusal("/bufferViews/0/byteStride",
                [](GltfWriter& w) { w.root["bufferViews"][0]["byteStride"] = 8; });
  expectRefusal("/bufferViews/0/byteStride",
                [](GltfWriter& w) { w.root["bufferViews"][0]["byteStride"] = 13; });
  expectRefusal("/bufferViews/0",
                [](GltfWriter& w) { w.root["bufferViews"][0]["byteOffset"] = 9007199254740992; });
  expectRefusal("/buffers/0/byteLength", [](GltfWriter& w) { w.root["buffers"] = {{{"byteLength", 1000}}}; });
  expectRefusal("/meshes/0/primitives/0/attributes/POSITION", [](GltfWriter& w) {
    w.root["accessors"][0] = {{"componentType", 5126}, {"count", 4000000000U}, {"type", "VEC3"}};
  });
}

TEST(GltfRefusal, SparseAccessors) {
  const auto sparse = [](int count, const std::vector<std::uint8_t>& indices) {
    return [=](GltfWriter& w) {
      const int view = w.addView(indices), values = w.addView<float>({1, 2, 3, 4, 5, 6});
      w.root["accessors"][0]["sparse"] = {{"count", count},
                                          {"indices", {{"bufferView", view}, {"componentType", 5121}}},
                                          {"values", {{"bufferView", values}}}};
    };
  };
  expectRefusal("/accessors/0/sparse/count", sparse(4, {0, 1, 2, 3}));
  expectRefusal("/accessors/0/sparse/indices", sparse(2, {1, 1}));
  expectRefusal("/accessors/0/sparse/indices", sparse(2, {1, 3}));
  expectRefusal("/accessors/0/sparse/indices", sparse(2, {1}));
  expectRefusal("/accessors/0/sparse/values", sparse(3, {0, 1, 2}));
}

TEST(GltfRefusal, FloatsThatAreNoCoordinates) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.1e15f}) {
    expectRefusal("/accessors/2", [=](GltfWriter& w) {
      w.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
          w.addArray<float>({0, 0, 0, 1, 0, 0, 0, 1, bad}, "VEC3");
    });
  }
}

TEST(GltfRefusal, IndicesAndAttributes) {
  expectRefusal("/meshes/0/primitives/0/indices", [](GltfWriter& w) {
    w.root["meshes"][0]["primitives"][0]["indices"] = w.addArray<std::uint16_t>({0, 1, 3}, "SCALAR");
  });
  expectRefusal("/accessors/2/componentType", [](GltfWriter& w) {
    w.root["meshes"][0]["primitives"][0]["indices"] = w.addArray<float>({0, 1, 2}, "SCALAR");
  });
  expectRefusal("/meshes/0/primitives/0/attributes/NORMAL", [](GltfWriter& w) {
    w.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        w.addArray<float>({0, 0, 1, 0, 0, 1}, "VEC3");
  });
  expectRefusal("/meshes/0/primitives/0/attributes/POSITION", [](GltfWriter& w) {
    w.root["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
        w.addArray<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  });
  expectRefusal("/meshes/0/primitives/0/targets/0/POSITION", [](GltfWriter& w) {
    w.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", w.addArray<float>({0, 0, 1}, "VEC3")}}};
  });
}

TEST(GltfRefusal, NodesThatAreNoTree) {
  expectRefusal("/nodes/1/children/0", [](GltfWriter& w) {
    w.root["nodes"][0]["children"] = {2};
    w.root["nodes"].push_back({{"children", {2}}});
    w.root["nodes"].push_back({{"name", "of two parents"}});
  });
  expectRefusal("/nodes/0/children", [](GltfWriter& w) { w.root["nodes"][0]["children"] = {0}; });
  expectRefusal("/nodes/1/children", [](GltfWriter& w) {
    w.root["nodes"].push_back({{"children", {2}}});
    w.root["nodes"].push_back({{"children", {1}}});
  });
  expectRefusal("/nodes/0/matrix",
                [](GltfWriter& w) { w.root["nodes"][0]["matrix"] = std::vector<int>(16, 1); });
  expectRefusal("/nodes/1", [](GltfWriter& w) {
    for (int n = 0; n < 3; ++n) {
      w.root["nodes"][static_cast<std::size_t>(n)]["scale"] = {1e15, 1, 1};
      if (n > 0) w.root["nodes"][static_cast<std::size_t>(n) - 1]["children"] = {n};
    }
  });
}

TEST(GltfRefusal, SkinsAndAnimations) {
  expectRefusal("/nodes/0/skin", [](GltfWriter& w) {
    json& attributes = w.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = w.addArray<std::uint8_t>({0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    attributes["WEIGHTS_0"] = w.addArray<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    w.root["skins"] = {{{"joints", {0}}}};
    w.root["nodes"][0]["skin"] = 0;
  });
  const auto animate = [](const std::vector<float>& times, int sampler) {
    return [=](GltfWriter& w) {
      const json samplers = {{{"input", w.addArray(times, "SCALAR")},
                              {"output", w.addArray<float>({0, 0, 0, 1, 1, 1}, "VEC3")}}};
      const json channels = {{{"sampler", sampler}, {"target", {{"node", 0}, {"path", "translation"}}}}};
      w.root["animations"] = {{{"samplers", samplers}, {"channels", channels}}};
    };
  };
  expectRefusal("/animations/0/samplers/0/input", animate({1, 0}, 0));
  expectRefusal("/animations/0/samplers/0/output", animate({0, 1, 2}, 0));
  expectRefusal("/animations/0/channels/0/sampler", animate({0, 1}, 1));
}

TEST(GltfRefusal, RequiredExtensionsByName) {
  GltfWriter writer;
  writer.addTriangle();
  writer.root["extensionsRequired"] = {"KHR_mesh_quantization", "EXT_marvel"};
  EXPECT_NE(writer.refusal().find("/extensionsRequired/1: the file requires the extension \"EXT_marvel\""),
            std::string::npos);
  writer.root["extensionsUsed"] = writer.root["extensionsRequired"];
  writer.root.erase("extensionsRequired");
  const Scene scene = writer.load();
  ASSERT_EQ(scene.notices.size(), 1u);
  EXPECT_NE(scene.notices[0].find("EXT_marvel"), std::string::npos);
}

std::string refusalOf(std::vector<std::uint8_t> bytes) {
  try {
    loadGltf("x", std::move(bytes), std::nullopt, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(GltfContainer, EveryPrefixOfAFileIsRefused) {
  GltfWriter writer;
  writer.addTriangle();
  const std::vector<std::uint8_t> whole = writer.glb();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(refusalOf({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)}), "") << length;
  }
  std::vector<std::uint8_t> longer = whole;
  longer.push_back(0);
  const Scene scene = loadGltf("x", longer, std::nullopt, {});
  ASSERT_EQ(scene.notices.size(), 1u);  // passed over
}

TEST(GltfContainer, BytesNameThePlaceInBrokenJson) {
  const std::string text = R"({"asset":{"version":"2.0"},"nodes":[{"scale":[1e999,1,1]}]})";
  EXPECT_EQ(refusalOf({text.begin(), text.end()}).find("x: byte 51: a number beyond 1e308"), 0u)
      << refusalOf({text.begin(), text.end()});
  const std::string deep = "{\"asset\":" + std::string(100000, '[');
  EXPECT_NE(refusalOf({deep.begin(), deep.end()}).find("nested more than 64 deep"), std::string::npos);
}

TEST(GltfJson, QuotesNamesSafely) {
  EXPECT_EQ(inQuotes("a\nb\x1b"), "\"a?b?\"");
  EXPECT_EQ(inQuotes(std::string(100, 'x')), "\"" + std::string(60, 'x') + "...\"");
  EXPECT_EQ(jsonPointer("accessors", 3, "count"), "/accessors/3/count");
}

}  // namespace
}  // namespace limn::scene
