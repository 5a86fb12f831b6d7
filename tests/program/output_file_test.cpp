// Files appear whole or not at all, whatever stands in their way.
#include "apps/scene/output_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace {

namespace fs = std::filesystem;
using limn::scene::OutputError;
using limn::scene::writeFileWhole;

class OutputFile : public testing::Test {
 protected:
  OutputFile() : directory_(fs::temp_directory_path() / ("limn-output-" + std::to_string(::getpid()))) {
    fs::create_directories(directory_);
  }
  ~OutputFile() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return directory_ / name; }
  static std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream all;
    all << file.rdbuf();
    return all.str();
  }
  std::size_t fileCount() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }
  static std::string messageOf(const std::string& path) {
    try {
      writeFileWhole(path, "new", 3);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path directory_;
};

TEST_F(OutputFile, IsWrittenAndReplacedWithNothingLeftBeside) {
  writeFileWhole(path("a"), "first", 5);
  EXPECT_EQ(contents(path("a")), "first");
  writeFileWhole(path("a"), "2nd", 3);
  EXPECT_EQ(contents(path("a")), "2nd");
  writeFileWhole(path("empty"), "", 0);
  EXPECT_EQ(fs::file_size(path("empty")), 0U);
  EXPECT_EQ(fileCount(), 2U);
}

TEST_F(OutputFile, HasTheModeOfAnyNewFile) {
  const mode_t mask = ::umask(027);
  writeFileWhole(path("a"), "x", 1);
  writeFileWhole(path("a"), "y", 1);
  ::umask(mask);
  struct stat status {};
  ASSERT_EQ(::stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640U);
}

TEST_F(OutputFile, FollowsLinks) {
  writeFileWhole(path("file"), "old", 3);
  fs::create_symlink("file", directory_ / "link");
  writeFileWhole(path("link"), "new", 3);
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(contents(path("file")), "new");
  EXPECT_EQ(fileCount(), 2U);
}

TEST_F(OutputFile, RefusesDirectoriesReadOnlyFilesAndLostDirectories) {
  fs::create_directories(directory_ / "sub");
  EXPECT_NE(messageOf(path("sub")).find("is a directory"), std::string::npos);
  writeFileWhole(path("kept"), "old", 3);
  fs::permissions(path("kept"), fs::perms::owner_read);
  EXPECT_NE(messageOf(path("kept")).find("read-only"), std::string::npos);
  EXPECT_EQ(contents(path("kept")), "old");
  const std::string lost = messageOf(path("gone/frame.png"));
  EXPECT_NE(lost.find(path("gone/frame.png")), std::string::npos) << lost;
  EXPECT_NE(lost.find("directory"), std::string::npos) << lost;
  EXPECT_EQ(fileCount(), 2U);
}

TEST_F(OutputFile, AFullDeviceIsNamedAndNotReplaced) {
  const std::string message = messageOf("/dev/full");
  EXPECT_NE(message.find("/dev/full"), std::string::npos);
  EXPECT_NE(message.find("No space left"), std::string::npos) << message;
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(OutputFile, NoTemporaryNameIsMadeOnceWritesAreAbandoned) {
  writeFileWhole(path("a"), "old", 3);
  const pid_t child = ::fork();
  if (child == 0) {  // writes are held back for good, in a process of its own
    limn::scene::abandonWrites();
    std::thread([this] { writeFileWhole(path("a"), "new", 3); }).detach();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(contents(path("a")), "old");
  EXPECT_EQ(fileCount(), 1U);
}

TEST_F(OutputFile, MakesDirectories) {
  limn::scene::makeDirectoriesOf(path("x/y/z.png"));
  EXPECT_TRUE(fs::is_directory(path("x/y")));
  limn::scene::makeDirectoriesOf("z.png");
  writeFileWhole(path("file"), "", 0);
  EXPECT_THROW(limn::scene::makeDirectoriesOf(path("file/z.png")), OutputError);
}

}  // namespace
