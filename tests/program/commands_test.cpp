// limn compare, info, models, --help and --version.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/scene/image.h"
#include "tests/program/run_program.h"

namespace {

using limn::scene::Image;
using limn::test::ProgramTest;
using limn::test::Result;
using Words = std::vector<std::string>;

class Commands : public ProgramTest {
 protected:
  void writeImage(const std::string& name, const Image& image) const {
    const auto bytes = limn::scene::encodePng(image, {}, 1);
    write(name, std::string(bytes.begin(), bytes.end()));
  }
};

TEST_F(Commands, CompareCountsDifferentPixels) {
  Image image{3, 2, std::vector<std::uint8_t>(24, 100)};
  writeImage("a.png", image);
  writeImage("same.png", image);
  image.rgba[4 * 4 + 1] = 90;  // pixel (1, 1), green
  image.rgba[2] = 101;         // pixel (0, 0), blue
  writeImage("b.png", image);
  const Result same = limn({"compare", "a.png", "same.png"});
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(same.out, "identical: 3x2 pixels\n");
  const Result different = limn({"compare", "a.png", "b.png", "-o", "deep/diff.png"});
  EXPECT_EQ(different.status, 5) << different.err;
  EXPECT_EQ(different.out, "2 of 6 pixels differ, the largest difference is 10 of 255 at 1,1\n");
  const Image shown = limn::scene::readPng(path("deep/diff.png"));
  for (std::size_t pixel = 0; pixel < 6; ++pixel)
    EXPECT_EQ(shown.rgba[4 * pixel] == 255, pixel == 0 || pixel == 4) << pixel;
}

TEST_F(Commands, CompareSeesDifferentSizesAndSixteenBits) {
  writeImage("a.png", {2, 2, std::vector<std::uint8_t>(16, 7)});
  writeImage("wide.png", {3, 1, std::vector<std::uint8_t>(12, 7)});
  const Result sizes = limn({"compare", "a.png", "wide.png", "-o", "diff.png"});
  EXPECT_EQ(sizes.status, 5);
  EXPECT_NE(sizes.out.find("sizes differ: 2x2 and 3x1"), std::string::npos) << sizes.out;
  EXPECT_EQ(limn::scene::readPng(path("diff.png")).width, 3);

  limn::scene::Image16 deep{1, 1, 1, {1000}};
  auto bytes = limn::scene::encodePng16(deep, {}, 1);
  write("x.png", std::string(bytes.begin(), bytes.end()));
  deep.samples[0] = 1001;
  bytes = limn::scene::encodePng16(deep, {}, 1);
  write("y.png", std::string(bytes.begin(), bytes.end()));
  const Result result = limn({"compare", "x.png", "y.png"});
  EXPECT_EQ(result.status, 5);
  EXPECT_NE(result.out.find("largest difference is 1 of 65535"), std::string::npos) << result.out;
}

TEST_F(Commands, InfoDescribesTheMesh) {
  const Result json = limn({"info", "builtin:icosphere-320", "--json"});
  ASSERT_EQ(json.status, 0) << json.err;
  const auto info = nlohmann::json::parse(json.out);
  EXPECT_EQ(info["triangles_drawn"], 320);
  EXPECT_EQ(info["meshes"][0]["topology"]["edges"], 480);
  EXPECT_EQ(info["meshes"][0]["topology"]["boundary_edges"], 0);
  EXPECT_EQ(info["meshes"][0]["topology"]["closed"], true);
  EXPECT_NEAR(info["bounds"]["radius"], 1.0, 1e-6);
  const Result text = limn({"info", "builtin:icosphere-320"});
  EXPECT_NE(text.out.find("320 triangles"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("closed: 162 points, 480 edges"), std::string::npos) << text.out;
}

TEST_F(Commands, ModelsCanAllBeDrawn) {
  const Result result = limn({"models"});
  ASSERT_EQ(result.status, 0);
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(0, line.find(' '));
    if (name.find(':', 8) != std::string::npos) continue;  // a form, not a name
    const Result drawn = limn({"render", name, "--hash", "--size", "16x16"});
    EXPECT_EQ(drawn.status, 0) << name << drawn.err;
  }
}

TEST_F(Commands, HelpAndVersionGoToStandardOutput) {
  for (const Words& words : {Words{"--help"}, Words{"render", "--help"}, Words{"info", "--help"},
                             Words{"compare", "-h"}, Words{"models", "--help"}, Words{"--version"}}) {
    const Result result = limn(words);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_NE(result.out.find("limn"), std::string::npos);
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  }
  EXPECT_TRUE(limn({"--version"}).out.starts_with("limn 0.1.0\n"));
}

}  // namespace
