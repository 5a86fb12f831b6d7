// limn render from the outside: files, bytes, hashes, messages.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "apps/scene/image.h"
#include "tests/program/run_program.h"

namespace {

using limn::test::ProgramTest;
using limn::test::operator+;  // NOLINT(misc-unused-using-decls): it sees no use of operators
using limn::test::Result;
using Words = std::vector<std::string>;

class Render : public ProgramTest {
 protected:
  /// Small frames of a model with creases, on a turntable.
  Words turntable(int frames) const {
    return {"render", "builtin:pawn", "--size", "64x48", "--turntable", std::to_string(frames)};
  }
};

TEST_F(Render, AFrameSaysWhatItIsAndHowToDrawItAgain) {
  const Result result = limn({"render", "builtin:cone-70", "-o", "a.png", "--size", "60x40", "--background",
                              "#336699", "--samples", "8", "--azimuth", "-75.5", "--hash"});
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  limn::scene::PngSummary summary;
  ASSERT_TRUE(limn::scene::inspectPng(path("a.png"), summary));
  const limn::scene::TextChunks& texts = summary.texts;
  const limn::scene::Image image = limn::scene::readPng(path("a.png"));
  EXPECT_EQ(image.width, 60);
  EXPECT_EQ(image.height, 40);
  EXPECT_EQ(result.out, "1 " + limn::scene::pixelHash(image) + "\n");
  ASSERT_EQ(texts.size(), 3U);
  EXPECT_EQ(texts[0].second, "limn 0.1.0");
  EXPECT_EQ(texts[2].second, limn::scene::pixelHash(image));

  const std::string& command = texts[1].second;
  std::istringstream words(command.substr(command.find(": ") + 2));
  Words again;
  for (std::string word; words >> word;) again.push_back(word);
  for (std::string& word : again)
    if (word.starts_with('\'')) word = word.substr(1, word.size() - 2);
  const Result second = limn(again + Words{"--hash"});
  EXPECT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(second.out, result.out) << command;
}

TEST_F(Render, SameBytesForAnyNumberOfThreadsAndAnyDivisionOfTheWork) {
  const Words job = turntable(6);
  const Result one = limn(job + Words{"-o", "one/%02d.png", "--threads", "1", "--hash"});
  ASSERT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(names("one").size(), 6U);
  for (const char* threads : {"2", "3", "8"}) {
    const Result other = limn(job + Words{"-o", "other/##.png", "--threads", threads, "--hash"});
    EXPECT_EQ(other.out, one.out) << threads;
    for (const std::string& name : names("one"))
      EXPECT_EQ(contents("other/" + name), contents("one/" + name));
  }
  for (const char* shard : {"1/4", "2/4", "3/4", "4/4"})
    ASSERT_EQ(limn(job + Words{"-o", "shards/%02d.png", "--shard", shard}).status, 0);
  ASSERT_EQ(names("shards"), names("one"));
  for (const std::string& name : names("one")) EXPECT_EQ(contents("shards/" + name), contents("one/" + name));
}

TEST_F(Render, OverlaysAreDrawnInOneOrderAndNamedInThePicture) {
  const Words plain = {"render", "builtin:pawn", "--size", "90x60", "--hash"};
  const std::string without = limn(plain).out;
  std::set<std::string> pictures = {without};
  for (const char* overlay : {"wire", "edges", "contour", "features"}) {
    for (const char* method : {"patches", "curves"}) {
      const Words job = plain + Words{"--overlay", overlay, "--method", method};
      const Result one = limn(job + Words{"--threads", "1"});
      ASSERT_EQ(one.status, 0) << one.err;
      EXPECT_EQ(limn(job + Words{"--threads", "3"}).out, one.out) << overlay;
      pictures.insert(one.out);
    }
  }
  EXPECT_EQ(pictures.size(), 9U);
  const Result all = limn(plain + Words{"--overlay", "contour,wire", "-o", "a.png"});
  EXPECT_EQ(limn(plain + Words{"--overlay", "wire,contour"}).out, all.out);
  limn::scene::PngSummary summary;
  ASSERT_TRUE(limn::scene::inspectPng(path("a.png"), summary));
  EXPECT_NE(summary.texts.at(1).second.find(" --overlay wire,contour"), std::string::npos)
      << summary.texts[1].second;
  const Result misspelt = limn(plain + Words{"--overlay", "wire,edge"});
  EXPECT_EQ(misspelt.status, 2);
  EXPECT_NE(misspelt.err.find("edges"), std::string::npos) << misspelt.err;
  EXPECT_EQ(limn(plain + Words{"--overlay", "wire,wire"}).status, 2);
}

TEST_F(Render, DrawsTheFramesOfTheListInItsOrder) {
  const Result all = limn(turntable(8) + Words{"--hash"});
  ASSERT_EQ(all.status, 0) << all.err;
  Words lines;
  std::istringstream text(all.out);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_EQ(std::set<std::string>(lines.begin(), lines.end()).size(), 8U);
  const Result some = limn(turntable(8) + Words{"--hash", "--frames", "7,2-6:2"});
  EXPECT_EQ(some.out, lines[6] + "\n" + lines[1] + "\n" + lines[3] + "\n" + lines[5] + "\n");
  const Result shard = limn(turntable(8) + Words{"--hash", "--frames", "7,2-6:2", "--shard", "2/3"});
  EXPECT_EQ(shard.out, lines[1] + "\n");
  const Result beyond = limn(turntable(8) + Words{"--hash", "--frames", "8-9"});
  EXPECT_EQ(beyond.status, 2);
  EXPECT_NE(beyond.err.find("frame 9 is beyond the end of the job, which has 8"), std::string::npos)
      << beyond.err;
}

TEST_F(Render, TurnsTheModelCounterClockwiseSeenFromAbove) {
  // Turned by a quarter, the model shows what an eye a quarter to the left saw.
  const Result turned = limn(turntable(4) + Words{"--frames", "2", "--azimuth", "30", "--hash"});
  const Result moved = limn({"render", "builtin:pawn", "--size", "64x48", "--azimuth", "-60", "--hash"});
  ASSERT_EQ(turned.status, 0) << turned.err;
  EXPECT_EQ(turned.out.substr(2), moved.out.substr(2));
}

TEST_F(Render, StandardOutputCarriesPngOrRows) {
  const Words frame = {"render", "builtin:cone-70", "--size", "31x17"};
  ASSERT_EQ(limn(frame + Words{"-o", "a.png"}).status, 0);
  EXPECT_EQ(limn(frame + Words{"-o", "-"}).out, contents("a.png"));
  const Result rows = limn(frame + Words{"-o", "-", "--format", "rgba"});
  const limn::scene::Image image = limn::scene::readPng(path("a.png"));
  EXPECT_EQ(rows.out, std::string(image.rgba.begin(), image.rgba.end()));
  const Result three = limn(frame + Words{"-o", "-", "--format", "rgba", "--turntable", "3"});
  EXPECT_EQ(three.out.size(), 3 * image.rgba.size());
  EXPECT_EQ(three.out.substr(0, rows.out.size()), rows.out);
}

TEST_F(Render, SkipsWholeFilesOfTheSameJobOnly) {
  const Words job = turntable(4) + Words{"-o", "f/%d.png", "--hash"};
  const Result first = limn(job);
  ASSERT_EQ(first.status, 0) << first.err;
  const std::string second = contents("f/2.png"), third = contents("f/3.png");
  write("f/2.png", second.substr(0, second.size() - 20));
  ASSERT_EQ(limn({"render", "builtin:pawn", "--size", "64x48", "-o", "f/3.png"}).status, 0);
  ASSERT_NE(contents("f/3.png"), third);
  std::filesystem::remove(path("f/4.png"));
  const auto written = std::filesystem::last_write_time(path("f/1.png"));

  const Result again = limn(job + Words{"--skip-existing", "--stats", "s.json"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out, first.out);
  EXPECT_EQ(contents("f/2.png"), second);
  EXPECT_EQ(contents("f/3.png"), third);
  EXPECT_EQ(std::filesystem::last_write_time(path("f/1.png")), written);
  const auto statistics = nlohmann::json::parse(contents("s.json"));
  EXPECT_EQ(statistics["frames"]["skipped"], 1);
  EXPECT_EQ(statistics["frames"]["drawn"], 3);
}

TEST_F(Render, AFileOfTheSameNameWithOtherContentsIsAnotherJob) {
  // A triangle; then the same with its last corner moved.
  const std::string start =
      R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"byteLength": 36, "uri": "t.bin"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126,
    "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [2, 2, 0]}]})";
  float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  write("t.gltf", start);
  write("t.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
  const Words frame = {"render", "t.gltf", "-o", "t.png", "--size", "20x20", "--skip-existing"};
  const Result result = limn(frame);
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string first = contents("t.png");
  EXPECT_EQ(limn(frame).status, 0);
  EXPECT_EQ(contents("t.png"), first);
  corners[7] = 2;
  write("t.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
  EXPECT_EQ(limn(frame).status, 0);
  EXPECT_NE(contents("t.png"), first);
}

TEST_F(Render, ADryRunChecksAndListsButWritesNothing) {
  const Result result =
      limn(turntable(12) + Words{"-o", "x/%03d.png", "--dry-run", "--frames", "3-9", "--shard", "2/3"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.out, "4 x/004.png\n7 x/007.png\n");
  EXPECT_TRUE(names("").empty());
  EXPECT_EQ(limn(turntable(3) + Words{"-o", "one.png", "--dry-run"}).status, 2);

  const Words hashes =
      turntable(3) + Words{"-o", "%d.png", "--hash", "--manifest", "m.json", "--stats", "s.json"};
  const Result drawn = limn(hashes + Words{"--dry-run"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_TRUE(names("").empty());
  EXPECT_EQ(limn(hashes).out, drawn.out);
}

TEST_F(Render, StatisticsAddUp) {
  ASSERT_EQ(
      limn(turntable(5) + Words{"-o", "%d.png", "--stats", "deep/stats.json", "--method", "flat"}).status, 0);
  const auto s = nlohmann::json::parse(contents("deep/stats.json"));
  EXPECT_EQ(s["frames"]["drawn"], 5);
  EXPECT_EQ(s["counts"]["refined_triangles"], 0);
  EXPECT_EQ(s["counts"]["triangles_in"], 5 * 360);
  std::size_t bytes = 0;
  for (int k = 1; k <= 5; ++k) bytes += contents(std::to_string(k) + ".png").size();
  EXPECT_EQ(s["counts"]["bytes_written"], bytes);
  EXPECT_GT(s["memory"]["peak_bytes"], 1000000);
  for (const char* stage : {"load", "pose", "refine", "raster", "encode", "write"})
    EXPECT_GE(s["milliseconds"][stage], 0.0) << stage;
}

TEST_F(Render, ALightIsADirectionHoweverLong) {
  const Words frame = {"render", "builtin:pawn", "--size", "64x48", "--hash", "--light"};
  const Result usual = limn(frame + Words{"0.5,1,0.25"});
  ASSERT_EQ(usual.status, 0) << usual.err;
  // Times powers of two, so that the direction is the same to the last bit.
  EXPECT_EQ(limn(frame + Words{"2,4,1"}).out, usual.out);
  EXPECT_EQ(limn(frame + Words{"5.357543035931337e+300,1.0715086071862673e+301,2.6787715179656683e+300"}).out,
            usual.out);
  EXPECT_EQ(limn(frame + Words{"1.0451361413042083e-199,2.0902722826084166e-199,5.225680706521042e-200"}).out,
            usual.out);
}

TEST_F(Render, OptionsChangeThePictureTheyShould) {
  const Words frame = {"render", "builtin:pawn", "--size", "64x48", "--hash"};
  const std::string plain = limn(frame).out;
  std::set<std::string> pictures = {plain};
  for (const Words& options :
       {Words{"--method", "flat"}, Words{"--azimuth", "31"}, Words{"--elevation", "21"},
        Words{"--zoom", "1.1"}, Words{"--fov", "50"}, Words{"--ortho", "fit"}, Words{"--ortho", "3"},
        Words{"--eye", "3,3,3"}, Words{"--eye", "3,3,3", "--up", "1,0,0"}, Words{"--samples", "1"},
        Words{"--samples", "8"}, Words{"--background", "white"}, Words{"--light", "headlight"},
        Words{"--light", "-1,0,0"}, Words{"--segments", "7"}, Words{"--tolerance", "0.02"},
        Words{"--features", "off"}}) {
    const Result result = limn(frame + options);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(pictures.insert(result.out).second) << options.front() << ' ' << options.back();
  }
  EXPECT_EQ(
      limn(frame + Words{"--azimuth", "30", "--zoom", "1", "--compress", "9", "--threads", "1", "--quiet"})
          .out,
      plain);
}

}  // namespace
