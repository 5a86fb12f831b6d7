// Runs cut into shards, their manifests, and the pictures beside the frames.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/scene/image.h"
#include "tests/program/run_program.h"

namespace {

using limn::test::operator+;  // NOLINT(misc-unused-using-decls): it sees no use of operators
using limn::test::ProgramTest;
using limn::test::Result;
using Words = std::vector<std::string>;

class Farm : public ProgramTest {
 protected:
  Words job(const std::string& folder) const {
    return {"render", "builtin:cone-70", "--size", "40x30", "--turntable", "7", "-o", folder + "/%02d.png"};
  }
  std::string hashOf(const Result& verified) const {
    return verified.out.substr(verified.out.rfind(' ') + 1);
  }
};

TEST_F(Farm, ShardsVerifyAsOneRunWithTheHashOfTheWhole) {
  ASSERT_EQ(limn(job("whole") + Words{"--manifest", "whole/manifest.json"}).status, 0);
  const Result whole = limn({"verify", "whole/manifest.json"});
  EXPECT_EQ(whole.status, 0) << whole.err;
  EXPECT_NE(whole.out.find("7 frames, whole and of one job: "), std::string::npos) << whole.out;

  Words verify = {"verify"};
  for (const std::string shard : {"1", "2", "3"}) {
    const std::string manifest = "run/m" + shard + ".json";
    ASSERT_EQ(limn(job("run") + Words{"--shard", shard + "/3", "--manifest", manifest}).status, 0);
    verify.push_back(manifest);
  }
  const Result shards = limn(verify);
  EXPECT_EQ(shards.status, 0) << shards.err;
  EXPECT_EQ(hashOf(shards), hashOf(whole));

  verify.pop_back();
  const Result missing = limn(verify);
  EXPECT_EQ(missing.status, 3);
  EXPECT_NE(missing.err.find("frame 3 is in no manifest"), std::string::npos) << missing.err;
}

TEST_F(Farm, VerifyNoticesDamageOtherJobsAndOtherPixels) {
  const Words run = job("f") + Words{"--manifest", "f/m.json"};
  ASSERT_EQ(limn(run).status, 0);
  const std::string third = contents("f/03.png");
  write("f/03.png", third.substr(0, 100));
  Result result = limn({"verify", "f/m.json"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.err.find("f/03.png: is missing or damaged"), std::string::npos) << result.err;

  write("f/03.png", contents("f/04.png"));
  result = limn({"verify", "f/m.json"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.err.find("f/03.png: is of another job"), std::string::npos) << result.err;

  // A forger who writes the right words around other pixels.
  const limn::scene::Image image = limn::scene::readPng(path("f/04.png"));
  write("f/03.png", third);
  limn::scene::PngSummary summary;
  ASSERT_TRUE(limn::scene::inspectPng(path("f/03.png"), summary));
  const auto forged = limn::scene::encodePng(image, summary.texts, 1);
  write("f/03.png", std::string(forged.begin(), forged.end()));
  result = limn({"verify", "f/m.json"});
  EXPECT_EQ(result.status, 5);
  EXPECT_NE(result.err.find("f/03.png: has other pixels"), std::string::npos) << result.err;

  write("f/03.png", third);
  EXPECT_EQ(limn({"verify", "f/m.json"}).status, 0);
  ASSERT_EQ(limn({"render", "builtin:cone-70", "--size", "40x31", "--turntable", "7", "-o", "g/%d.png",
                  "--manifest", "g/m.json"})
                .status,
            0);
  result = limn({"verify", "f/m.json", "g/m.json"});
  EXPECT_EQ(result.status, 3);
  EXPECT_NE(result.err.find("g/m.json"), std::string::npos) << result.err;
}

TEST_F(Farm, BrokenManifestsAreRefusedWithThePlace) {
  const auto expect = [&](const std::string& text, const std::string& message) {
    write("m.json", text);
    const Result result = limn({"verify", "m.json"});
    EXPECT_EQ(result.status, 3) << text;
    EXPECT_NE(result.err.find("m.json: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  };
  expect("", "no JSON");
  expect("[]", "no manifest");
  expect("{}", "/job: is missing");
  expect(R"({"job": 5})", "/job: is of another kind");
  expect("{\"job\": \"x\"", "byte");
  ASSERT_EQ(limn(job("f") + Words{"--manifest", "f/m.json"}).status, 0);
  auto manifest = nlohmann::ordered_json::parse(contents("f/m.json"));
  manifest["frames"][2]["pixels"] = manifest["frames"][1]["pixels"];
  expect(manifest.dump(), "/pixels: does not match");
}

TEST_F(Farm, AResumedRunWritesTheSameManifest) {
  ASSERT_EQ(limn(job("f") + Words{"--manifest", "f/a.json", "--aov", "depth,id"}).status, 0);
  std::filesystem::remove(path("f/05.png"));
  std::filesystem::remove(path("f/02.id.png"));
  const Result again = limn(job("f") + Words{"--manifest", "f/b.json", "--aov", "depth,id", "--skip-existing",
                                             "--stats", "s.json"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(contents("f/a.json"), contents("f/b.json"));
  EXPECT_EQ(nlohmann::json::parse(contents("s.json"))["frames"]["drawn"], 2);
  EXPECT_EQ(limn({"verify", "f/b.json"}).status, 0);
  std::filesystem::copy_file(path("f/01.depth.png"), path("f/02.depth.png"),
                             std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(limn({"verify", "f/b.json"}).status, 3);
}

TEST_F(Farm, RawRowsAreVerifiedToo) {
  const Words run = {"render", "builtin:cone-70", "--size",   "40x30", "--turntable", "2",
                     "-o",     "%d.rgba",         "--format", "rgba"};
  ASSERT_EQ(limn(run + Words{"--manifest", "m.json"}).status, 0);
  EXPECT_EQ(limn({"verify", "m.json"}).status, 0);
  std::string rows = contents("2.rgba");
  EXPECT_EQ(rows.size(), 4800U);
  rows[17] = static_cast<char>(rows[17] + 1);
  write("2.rgba", rows);
  EXPECT_EQ(limn({"verify", "m.json"}).status, 5);
}

const std::string* find(const limn::scene::TextChunks& texts, const std::string& keyword) {
  for (const auto& [key, text] : texts)
    if (key == keyword) return &text;
  return nullptr;
}

TEST_F(Farm, DepthNormalsAndIdsAreThoseOfASphereSeenFromTheFront) {
  ASSERT_EQ(limn({"render", "builtin:icosphere:4", "--size", "65x65", "--azimuth", "0", "--elevation", "0",
                  "--samples", "1", "-o", "s.png", "--aov", "depth,normal,id", "--method", "flat"})
                .status,
            0);
  EXPECT_EQ(names(""), (Words{"s.depth.png", "s.id.png", "s.normal.png", "s.png"}));
  limn::scene::PngSummary summary;
  ASSERT_TRUE(limn::scene::inspectPng(path("s.depth.png"), summary));
  const std::string* nearText = find(summary.texts, "limn-near");
  const std::string* farText = find(summary.texts, "limn-far");
  ASSERT_TRUE(nearText && farText);
  const double nearPlane = std::stod(*nearText), farPlane = std::stod(*farText);
  const auto at = [](const limn::scene::Image16& image, std::size_t x, std::size_t y, std::size_t channel) {
    return image.samples[4 * (y * 65 + x) + channel];
  };
  bool is16 = false;
  const limn::scene::Image16 depth = limn::scene::readPng16(path("s.depth.png"), &is16);
  EXPECT_TRUE(is16);
  const limn::scene::Image16 normal = limn::scene::readPng16(path("s.normal.png"));
  const limn::scene::Image16 id = limn::scene::readPng16(path("s.id.png"));
  // The sphere of radius 1 fills 95 % of 65 pixels; the eye is at distance 1/sin(half angle).
  const double distance = std::sqrt(1 + 1 / std::pow(0.95 * std::tan(15 * 3.14159265358979 / 180), 2));
  const double front = nearPlane + (farPlane - nearPlane) * at(depth, 32, 32, 0) / 65535.0;
  EXPECT_NEAR(front, distance - 1, 0.005);
  EXPECT_EQ(at(depth, 0, 0, 0), 65535);
  EXPECT_NEAR(at(normal, 32, 32, 0), 32768, 200);
  EXPECT_NEAR(at(normal, 32, 32, 1), 32768, 200);
  EXPECT_NEAR(at(normal, 32, 32, 2), 65535, 200);
  EXPECT_GT(at(normal, 55, 32, 0), 50000);
  EXPECT_LT(at(normal, 32, 55, 1), 16000);
  EXPECT_NEAR(at(normal, 0, 0, 0), 32768, 1);
  EXPECT_LT(at(id, 32, 32, 0), 5120);
  EXPECT_EQ(at(id, 0, 0, 0), 65535);
}

}  // namespace
