// The small model as a file: what is written is read back, and what was damaged is never drawn.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "apps/coarsen/coarsen.h"
#include "apps/coarsen/document.h"
#include "apps/scene/gltf_load.h"
#include "tests/coarsen/fine_models.h"

namespace limn::coarsen::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Json = nlohmann::ordered_json;

/// A GLB taken apart and put together again.
struct Glb {
  Json json;
  Bytes binary;

  explicit Glb(const Bytes& file) {
    const std::size_t length = word(file, 12);
    json = Json::parse(file.begin() + 20, file.begin() + 20 + static_cast<std::ptrdiff_t>(length));
    binary.assign(file.begin() + 28 + static_cast<std::ptrdiff_t>(length), file.end());
  }
  Bytes file() const {
    std::string text = json.dump();
    while (text.size() % 4 != 0) text += ' ';
    Bytes out = {'g', 'l', 'T', 'F', 2, 0, 0, 0};
    append(out, 28 + text.size() + binary.size());
    append(out, text.size());
    out.insert(out.end(), {'J', 'S', 'O', 'N'});
    out.insert(out.end(), text.begin(), text.end());
    append(out, binary.size());
    out.insert(out.end(), {'B', 'I', 'N', 0});
    out.insert(out.end(), binary.begin(), binary.end());
    return out;
  }
  Json& extension() { return json["meshes"][0]["extensions"]["LIMN_fitted_curves"]; }
  Json& accessor(const char* member) { return json["accessors"][extension()[member].get<std::size_t>()]; }
  std::size_t offset(const char* member) {
    return json["bufferViews"][accessor(member)["bufferView"].get<std::size_t>()]["byteOffset"]
        .get<std::size_t>();
  }

 private:
  static std::size_t word(const Bytes& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, &bytes[at], 4);
    return value;
  }
  static void append(Bytes& bytes, std::size_t value) {
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
  }
};

const Bytes& smallFile() {
  static const Bytes file = [] {
    const scene::Source source = scene::openSource("builtin:torus:60:30");
    Workers workers(2);
    return withMeshes(source, {coarsenMesh(source.scene.meshes[0], {200}, workers)});
  }();
  return file;
}

scene::Scene loaded(const Bytes& file) {
  return scene::loadGltf("test.glb", file, std::nullopt, {});
}

void expectIgnored(const Bytes& file, const char* what) {
  const scene::Scene scene = loaded(file);
  EXPECT_TRUE(scene.meshes[0].curves.empty()) << what;
  EXPECT_FALSE(scene.notices.empty()) << what;
  EXPECT_GT(scene.meshes[0].indices.size(), 0u) << what;
}

TEST(SmallFile, GivesMeshAndCurvesBack) {
  const scene::Source source = scene::openSource("builtin:torus:60:30");
  Workers workers(2);
  const scene::Mesh mesh = coarsenMesh(source.scene.meshes[0], {200}, workers);
  const scene::Scene scene = loaded(withMeshes(source, {mesh}));
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].positions, mesh.positions);
  EXPECT_EQ(scene.meshes[0].indices, mesh.indices);
  EXPECT_EQ(scene.meshes[0].curves.ends, mesh.curves.ends);
  EXPECT_EQ(scene.meshes[0].curves.centers, mesh.curves.centers);
  EXPECT_EQ(scene.meshes[0].curves.endScale, mesh.curves.endScale);
  EXPECT_TRUE(scene.notices.empty());
}

TEST(SmallFile, KeepsTwelveBytesPerTriangle) {
  Glb glb(smallFile());
  const std::size_t bytes = 3 * (glb.accessor("ends")["count"].get<std::size_t>() +
                                 glb.accessor("centers")["count"].get<std::size_t>());
  EXPECT_EQ(bytes, 12 * glb.accessor("centers")["count"].get<std::size_t>());
}

TEST(SmallFile, AnyChangedByteOfTheCurvesIsNoticed) {
  Glb glb(smallFile());
  ASSERT_FALSE(loaded(glb.file()).meshes[0].curves.empty());
  for (const char* member : {"ends", "centers"})
    for (const std::size_t at : {std::size_t{0}, std::size_t{97}}) {
      glb.binary[glb.offset(member) + at] ^= 0x10;
      expectIgnored(glb.file(), member);
      glb.binary[glb.offset(member) + at] ^= 0x10;
    }
}

TEST(SmallFile, CurvesOfAnotherMeshAreNotDrawn) {
  Glb moved(smallFile());
  const std::size_t position =
      moved.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>();
  const std::size_t view = moved.json["accessors"][position]["bufferView"].get<std::size_t>();
  moved.binary[moved.json["bufferViews"][view]["byteOffset"].get<std::size_t>() + 1] ^= 1;
  expectIgnored(moved.file(), "a vertex moved");

  Glb shorter(smallFile());
  Json& indices =
      shorter.json["accessors"][shorter.json["meshes"][0]["primitives"][0]["indices"].get<std::size_t>()];
  indices["count"] = indices["count"].get<int>() - 3;
  expectIgnored(shorter.file(), "a triangle left out");
}

TEST(SmallFile, WrongArraysAreNotDrawn) {
  Glb fewer(smallFile());
  fewer.accessor("ends")["count"] = fewer.accessor("ends")["count"].get<int>() - 2;
  expectIgnored(fewer.file(), "fewer ends");
  Glb type(smallFile());
  type.extension()["ends"] = type.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
  expectIgnored(type.file(), "floats");
  Glb plain(smallFile());
  plain.accessor("centers").erase("normalized");
  expectIgnored(plain.file(), "not normalized");
  Glb scale(smallFile());
  scale.extension()["endScale"][1] = 1e6;
  expectIgnored(scale.file(), "a scale out of range");
  Glb key(smallFile());
  key.extension()["key"] = "";
  expectIgnored(key.file(), "no key");
}

TEST(SmallFile, WhatIsNoGltfIsRefused) {
  Glb missing(smallFile());
  missing.extension().erase("centers");
  EXPECT_THROW(loaded(missing.file()), scene::InputError);
  Glb beyond(smallFile());
  beyond.extension()["ends"] = 9999;
  EXPECT_THROW(loaded(beyond.file()), scene::InputError);
  Glb text(smallFile());
  text.extension()["endScale"] = "large";
  EXPECT_THROW(loaded(text.file()), scene::InputError);
  Glb outside(smallFile());
  outside.accessor("ends")["count"] = 100000000;
  EXPECT_THROW(loaded(outside.file()), scene::InputError);
}

}  // namespace
}  // namespace limn::coarsen::test
