// What a file may refer to.
#include "apps/scene/gltf_uri.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/scene/gltf_writer.h"

namespace limn::scene {
namespace {

namespace fs = std::filesystem;
using test::GltfWriter;

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
