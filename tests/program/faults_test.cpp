// What goes wrong ends with the right status and message, and never with a broken file.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "apps/scene/image.h"
#include "tests/program/run_program.h"
#include "tests/scene/gltf_writer.h"

namespace {

using limn::test::ProgramTest;
using limn::test::operator+;  // NOLINT(misc-unused-using-decls): it sees no use of operators
using limn::test::Result;
using limn::test::Running;
using Words = std::vector<std::string>;

class Faults : public ProgramTest {
 protected:
  void expect(const Words& arguments, int status, const std::string& message) const {
    const Result result = limn(arguments);
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
    EXPECT_TRUE(result.err.starts_with("limn: error: ")) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }

  bool isWhole(const std::string& name) const {
    limn::scene::PngSummary summary;
    return limn::scene::inspectPng(path(name), summary);
  }

  /// Waits until the folder holds so many files; false after ten seconds.
  bool waitForFiles(const std::string& folder, std::size_t count) const {
    for (int i = 0; i < 1000 && names(folder).size() < count; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return names(folder).size() >= count;
  }

  const Words longJob_ = {"render",      "builtin:pawn", "--size", "160x120",
                          "--turntable", "2000",         "-o",     "f/%04d.png"};
};

TEST_F(Faults, OfUsage) {
  const std::string frame = "a.png";
  expect({}, 2, "name a command");
  expect({"rendr"}, 2, "did you mean render?");
  expect({"render"}, 2, "name one with -o");
  expect({"render", "-o", frame, "--tolerence", "1"}, 2, "did you mean --tolerance?");
  expect({"render", "-o", frame, "--method", "patchs"}, 2, "did you mean patches?");
  expect({"render", "-o", frame, "--stats", frame}, 2, "file of a frame, a.png");
  expect({"render", "-o", frame, "--manifest", frame}, 2, "file of a frame, a.png");
  expect({"render", "-o", frame, "--size", "0x10"}, 2, "1 to 16384");
  expect({"render", "-o", frame, "--size", "99999x99999"}, 2, "1 to 16384");
  expect({"render", "-o", frame, "--size", "tall"}, 2, "WIDTHxHEIGHT");
  expect({"render", "-o", frame, "--eye", "1,2,3", "--target", "1,2,3"}, 2, "same point");
  expect({"render", "-o", frame, "--eye", "0,9,0", "--target", "0,0,0"}, 2, "line of sight");
  expect({"render", "-o", frame, "--fov", "180"}, 2, "below 180");
  expect({"render", "-o", frame, "--zoom", "0"}, 2, "above 0, at most 1e9");
  expect({"render", "-o", frame, "--zoom", "1e-60"}, 2, "above 0, at most 1e9");
  expect({"render", "-o", frame, "--tolerance", "1e10"}, 2, "from 0 to 1e9");
  expect({"render", "-o", frame, "--ortho", "-2"}, 2, "above 0");
  expect({"render", "-o", frame, "--azimuth", "nan"}, 2, "not a finite number");
  expect({"render", "-o", frame, "--turntable", "5"}, 2, "frames/%04d.png");
  expect({"render", "-o", "%d/%d.png"}, 2, "two numbers");
  expect({"render", "-o", frame, "--frames", "2"}, 2, "has one frame");
  expect({"render", "-o", "a.jpg"}, 2, "limn writes PNG");
  expect({"render", "-o", "-", "--hash"}, 2, "standard output");
  expect({"render", "-o", "-", "--aov", "depth"}, 2, "--aov need files");
  expect({"render", "--hash", "--aov", "depth"}, 2, "--aov need files");
  expect({"render", "-o", frame, "--camera", "0"}, 2, "no camera");
  expect({"render", "-o", frame, "--animation", "Run"}, 2, "no animation");
  expect({"render", "-o", frame, "--fps", "10"}, 2, "--animation");
  expect({"render", "-o", frame, "--threads", "0"}, 2, "1 to 1024");
  EXPECT_TRUE(names("").empty());
}

TEST_F(Faults, OfValuesThatAreEmpty) {
  expect({"render", "builtin:cone-70", "--stats=", "--hash"}, 2, "--stats= has no value");
  expect({"render", "builtin:cone-70", "-o=", "--quiet"}, 2, "-o= has no value");
  expect({"render", "builtin:cone-70", "--eye", "5,0,0", "--ortho", "fit", "-o", "a.png"}, 2, "--ortho fit");
  EXPECT_TRUE(names("").empty());
}

TEST_F(Faults, OfResultsThatWouldReplaceEachOther) {
  const Words frames = {"render", "builtin:cone-70", "--size", "20x20", "--turntable", "3", "-o", "%d.png"};
  expect(frames + Words{"--manifest", "./2.png"}, 2, "--manifest names the file of a frame, 2.png");
  expect(frames + Words{"--stats", path("3.png")}, 2, "--stats names the file of a frame, 3.png");
  expect(frames + Words{"--aov", "id", "--manifest", "1.id.png"}, 2, "a frame, 1.id.png");
  expect(frames + Words{"--manifest", "./a.json", "--stats", "a.json"}, 2, "the file of the manifest");
  EXPECT_TRUE(names("").empty());
  EXPECT_EQ(limn(frames + Words{"--manifest", "4.png"}).status, 0);
}

TEST_F(Faults, OfOutputInADryRun) {
  const Words frame = {"render", "builtin:cone-70", "--size", "20x20", "--dry-run", "-o"};
  write("file", "");
  std::filesystem::create_directories(path("folder"));
  expect(frame + Words{"folder"}, 4, "is a directory");
  expect(frame + Words{"file/a.png"}, 4, "files cannot lie there");
  expect(frame + Words{"a.png", "--stats", "folder"}, 4, "is a directory");
  expect(frame + Words{"a.png", "--manifest", "folder"}, 4, "is a directory");
  EXPECT_EQ(limn(frame + Words{"new/deep/a.png"}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(path("new")));
}

TEST_F(Faults, OfACameraInOneFrame) {
  limn::scene::test::GltfWriter writer;
  writer.addTriangle();
  writer.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}};
  writer.root["nodes"].push_back({{"camera", 0}, {"translation", {0, 0, 3}}});
  const int seconds = writer.addArray<float>({0, 1}, "SCALAR");
  const int scales = writer.addArray<float>({1, 1, 1, 0, 0, 0}, "VEC3");
  writer.root["animations"] = {
      {{"samplers", {{{"input", seconds}, {"output", scales}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "scale"}}}}}}}};
  const auto glb = writer.glb();
  write("a.glb", std::string(glb.begin(), glb.end()));
  const Words job = {"a.glb", "--animation", "0", "--fps", "4", "--camera", "0", "--size", "20x20", "-o"};
  expect(Words{"render"} + job + Words{"%d.png"}, 2, "the camera cannot be used in frame 5: ");
  expect(Words{"refine"} + job + Words{"r.glb", "--frame", "5"}, 2, "in frame 5: ");
  EXPECT_EQ(limn(Words{"render"} + job + Words{"%d.png", "--frames", "1-4"}).status, 0);
}

TEST_F(Faults, OfInput) {
  expect({"render", "builtin:spher-200", "-o", "a.png"}, 3, "did you mean builtin:sphere-200?");
  expect({"render", "nothing.glb", "-o", "a.png"}, 3, "nothing.glb");
  expect({"info", "nothing.glb"}, 3, "nothing.glb");
  expect({"compare", "no.png", "no.png"}, 3, "no.png");
  expect({"compare", ".", "."}, 3, "cannot be read");
  EXPECT_TRUE(names("").empty());
}

TEST_F(Faults, OfWishesBeyondIndices) {
  expect({"render", "builtin:torus:440:420", "--method", "pn", "--segments", "64", "-o", "a.png"}, 3,
         "torus:440:420: /meshes: one of them would become 1513881600 triangles, more than 32-bit indices "
         "can number; "
         "draw it with fewer --segments or a larger --tolerance");
}

TEST_F(Faults, OfOutput) {
  const Words frame = {"render", "builtin:cone-70", "--size", "20x20"};
  expect(frame + Words{"-o", "/dev/full"}, 4, "/dev/full: could not be written: No space left");
  expect(frame + Words{"-o", "/proc/nowhere/a.png"}, 4, "/proc/nowhere");
  expect(frame + Words{"-o", "a.png", "--stats", "/dev/full"}, 4, "/dev/full");
  write("file", "");
  expect(frame + Words{"-o", "file/a.png"}, 4, "file");
  std::filesystem::create_directories(path("folder"));
  expect(frame + Words{"-o", "folder"}, 4, "is a directory");
  write("kept.png", "old");
  std::filesystem::permissions(path("kept.png"), std::filesystem::perms::owner_read);
  expect(frame + Words{"-o", "kept.png"}, 4, "read-only");
  EXPECT_EQ(contents("kept.png"), "old");
  if (::geteuid() != 0) {
    std::filesystem::permissions(path("folder"),
                                 std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    expect(frame + Words{"-o", "folder/a.png"}, 4, "folder/a.png");
  }
}

TEST_F(Faults, AFrameThatCannotBeWrittenEndsTheRun) {
  for (const Words& more : {Words{}, Words{"--aov", "id"}}) {
    const std::string blocked = more.empty() ? "f/0002.png" : "f/0002.id.png";
    std::filesystem::remove_all(path("f"));
    std::filesystem::create_directories(path(blocked));
    const Result result = limn(Words{"render", "builtin:cone-70", "--turntable", "8", "--hash", "--compress",
                                     "12", "--threads", "4", "--size", "300x200", "-o", "f/%04d.png"} +
                               more);
    EXPECT_EQ(result.status, 4) << result.err;
    EXPECT_NE(result.err.find(blocked + ": is a directory"), std::string::npos) << result.err;
    EXPECT_LE(std::count(result.out.begin(), result.out.end(), '\n'), 1) << result.out;
  }
}

TEST_F(Faults, AFileThatBecomesTooLargeLeavesNothing) {
  Running program(directory_,
                  {"render", "builtin:pawn", "-o", "f/a.png", "--size", "640x480", "--compress", "0"}, "",
                  100000);
  const Result result = program.wait();
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_NE(result.err.find("f/a.png"), std::string::npos) << result.err;
  EXPECT_TRUE(names("f").empty());
}

TEST_F(Faults, SignalsEndTheRunAtOnceWithWholeFilesOnly) {
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) {
    std::filesystem::remove_all(path("f"));
    Running program(directory_, longJob_, "");
    ASSERT_TRUE(waitForFiles("f", 3));
    program.signal(number);
    const Result result = program.wait();
    EXPECT_EQ(result.status, 128 + number);
    const Words files = names("f");
    EXPECT_LT(files.size(), 2000U);
    for (const std::string& name : files) EXPECT_TRUE(isWhole("f/" + name)) << name;
  }
}

TEST_F(Faults, AKilledRunIsResumedToTheSameBytes) {
  const Words job = {"render", "builtin:pawn", "--size", "160x120", "--turntable", "40", "-o"};
  ASSERT_EQ(limn(job + Words{"whole/%04d.png"}).status, 0);
  for (const std::size_t after : {1U, 5U, 17U}) {
    Running program(directory_, job + Words{"killed/%04d.png", "--skip-existing"}, "");
    ASSERT_TRUE(waitForFiles("killed", after));
    program.signal(SIGKILL);
    program.wait();
    for (const std::string& name : names("killed")) EXPECT_TRUE(isWhole("killed/" + name)) << name;
  }
  ASSERT_EQ(limn(job + Words{"killed/%04d.png", "--skip-existing"}).status, 0);
  ASSERT_EQ(names("killed"), names("whole"));
  for (const std::string& name : names("whole"))
    EXPECT_EQ(contents("killed/" + name), contents("whole/" + name)) << name;
}

TEST_F(Faults, ALostDirectoryIsReported) {
  Running program(directory_, longJob_, "");
  ASSERT_TRUE(waitForFiles("f", 2));
  std::filesystem::rename(path("f"), path("elsewhere"));
  const Result result = program.wait();
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_NE(result.err.find("is its directory still there?"), std::string::npos) << result.err;
  for (const std::string& name : names("elsewhere")) EXPECT_TRUE(isWhole("elsewhere/" + name)) << name;
}

}  // namespace
