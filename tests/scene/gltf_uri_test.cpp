// What a file may refer to.
#include "apps/scene/gltf_uri.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "apps/scene/gltf_document.h"
#include "tests/scene/gltf_writer.h"

namespace limn::scene {
namespace {

namespace fs = std::filesystem;
using test::GltfWriter;
using test::json;

class Folder : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "limn-uri-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    root_ = pattern;
    fs::create_directories(root_ / "models" / "below");
    write(root_ / "secret.bin", "secret");
    write(root_ / "models" / "a b.bin", "beside");
    write(root_ / "models" / "below" / "c%20d.bin", "below");
    fs::create_symlink("../secret.bin", root_ / "models" / "link.bin");
  }
  void TearDown() override { fs::remove_all(root_); }

  static void write(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }

  std::string problemOf(const std::string& uri) const {
    std::string problem;
    resolveUri(uri, root_ / "models", problem);
    return problem;
  }

  fs::path root_;
};

TEST_F(Folder, FilesBesideAndBelowAreFound) {
  EXPECT_EQ(problemOf("a%20b.bin"), "");
  EXPECT_EQ(problemOf("a b.bin"), "");
  EXPECT_EQ(problemOf("./a b.bin"), "");
  EXPECT_EQ(problemOf("below/c%2520d.bin"), "");
  EXPECT_NE(problemOf("missing.bin").find("names no file"), std::string::npos);
  EXPECT_NE(problemOf("below").find("names no file"), std::string::npos);
}

TEST_F(Folder, AFileHasOnePathHoweverItIsNamed) {
  fs::create_symlink("a b.bin", root_ / "models" / "inside.bin");
  std::string problem;
  const fs::path path = resolveUri("a%20b.bin", root_ / "models", problem);
  EXPECT_EQ(path, fs::canonical(root_ / "models" / "a b.bin"));
  for (const char* uri : {"a b.bin", "./a b.bin", "inside.bin"})
    EXPECT_EQ(resolveUri(uri, root_ / "models", problem), path) << uri;
}

TEST_F(Folder, NothingElseIs) {
  const std::string absolute = (root_ / "secret.bin").string();
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"), std::string("below/../../secret.bin"),
        absolute, "file://" + absolute, std::string("http://host/x"), std::string("..%2fsecret.bin"),
        std::string("..\\secret.bin"), std::string("C:/x"), std::string("link.bin"), std::string(),
        std::string("a%00b")}) {
    EXPECT_NE(problemOf(uri), "") << uri;
  }
}

TEST_F(Folder, AGltfReadsItsBufferBesideIt) {
  GltfWriter writer;
  writer.addTriangle();
  writer.root["buffers"] = {{{"byteLength", writer.binary.size()}, {"uri", "tri%61ngle.bin"}}};
  const fs::path file = root_ / "models" / "triangle.gltf";
  write(root_ / "models" / "triangle.bin", std::string(writer.binary.begin(), writer.binary.end()));
  write(file, writer.root.dump());
  EXPECT_EQ(load(file.string()).meshes[0].positions[1], glm::vec3(1, 0, 0));
  write(root_ / "models" / "triangle.bin", "short");
  EXPECT_THROW(load(file.string()), InputError);
  EXPECT_THROW(load((root_ / "models").string()), InputError);
  EXPECT_THROW(load((root_ / "none.gltf").string()), InputError);
}

TEST_F(Folder, BuffersShareTheFileThatTheyName) {
  GltfWriter writer;
  writer.addTriangle();
  const std::string bytes(writer.binary.begin(), writer.binary.end());
  write(root_ / "models" / "triangle.bin", bytes + std::string(1000, 'x'));
  const json whole = {{"byteLength", 36}, {"uri", "triangle.bin"}},
             more = {{"byteLength", 1000}, {"uri", "./triangle.bin"}};
  writer.root["buffers"] = {whole, more, whole};
  const std::string text = writer.root.dump();
  const GltfDocument document("test.gltf", {text.begin(), text.end()}, root_ / "models");
  EXPECT_EQ(document.inputBytes(), text.size() + 1000);  // as far as the longest buffer, once
  for (const GltfBuffer& buffer : document.buffers) {
    EXPECT_EQ(buffer.bytes->data(), document.buffers[0].bytes->data());
    EXPECT_EQ(buffer.bytes->size(), buffer.length);
  }
  EXPECT_EQ(std::string(document.buffers[2].bytes->begin(), document.buffers[2].bytes->end()), bytes);
}

TEST_F(Folder, TheBudgetGrowsOncePerFile) {
  const std::string text = R"({"asset":{"version":"2.0"}})";
  GltfDocument document("test.gltf", {text.begin(), text.end()}, root_ / "models");
  constexpr std::size_t kMiB = 1U << 20;
  document.grow("a", kMiB);
  EXPECT_NO_THROW(document.checkRoom(400 * kMiB, "/images/0"));
  document.grow("a", kMiB);
  EXPECT_THROW(document.checkRoom(500 * kMiB, "/images/1"), InputError);
  document.grow("b", kMiB);
  EXPECT_NO_THROW(document.checkRoom(500 * kMiB, "/images/2"));
}

TEST(DataUri, DecodesBase64AndNothingElse) {
  const auto decoded = [](const char* uri) {
    const auto bytes = decodeDataUri(uri);
    return bytes ? std::string(bytes->begin(), bytes->end()) : std::string("refused");
  };
  EXPECT_EQ(decoded("data:application/octet-stream;base64,bGltbg=="), "limn");
  EXPECT_EQ(decoded("data:;base64,bGltbg"), "limn");
  EXPECT_EQ(decoded("data:image/png;base64,"), "");
  EXPECT_EQ(decoded("data:text/plain,limn"), "refused");
  EXPECT_EQ(decoded("data:;base64,bGlt*g=="), "refused");
  EXPECT_EQ(decoded("data:;base64,bGltb"), "refused");
  EXPECT_EQ(decoded("data:base64"), "refused");
}

TEST(DataUri, OnStandardInputFilesAreRefused) {
  GltfWriter writer;
  writer.addTriangle();
  writer.root["buffers"] = {{{"byteLength", 36}, {"uri", "x.bin"}}};
  EXPECT_NE(writer.refusal().find("/buffers/0/uri: names a file, but a model on standard input"),
            std::string::npos);
}

}  // namespace
}  // namespace limn::scene
