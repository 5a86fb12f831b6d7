// Every command of the manual works.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "tests/program/run_program.h"

namespace {

using limn::test::ProgramTest;

class Manual : public ProgramTest {};

/// The lines between "```sh" and "```", joined where they go on.
std::vector<std::string> commandsOf(const std::string& file) {
  std::ifstream text(file);
  std::vector<std::string> commands;
  bool inside = false, continues = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) {
      inside = line == "```sh";
    } else if (inside) {
      if (continues)
        commands.back() += line;
      else
        commands.push_back(line);
      continues = line.ends_with("|");
    }
  }
  return commands;
}

TEST_F(Manual, EveryCommandWorks) {
  const std::vector<std::string> commands = commandsOf(LIMN_MANUAL);
  ASSERT_GE(commands.size(), 15U);
  const bool hasFfmpeg = std::system("command -v ffmpeg >/dev/null") == 0;
  const std::string programs = std::filesystem::path(LIMN_PROGRAM).parent_path();
  for (const std::string& command : commands) {
    if (!hasFfmpeg && command.find("ffmpeg") != std::string::npos) continue;
    const std::string line = "cd '" + directory_.string() + "' && PATH='" + programs + "':$PATH && { " +
                             command + "; } >/dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 0) << command;
  }
}

std::string readText(const std::filesystem::path& file) {
  std::ifstream text(file);
  return {std::istreambuf_iterator<char>(text), std::istreambuf_iterator<char>()};
}

TEST_F(Manual, AndManPageNameEveryOption) {
  const std::filesystem::path file = LIMN_MANUAL;
  const std::string manual = readText(file);
  std::string page = readText(file.parent_path() / "limn.1");
  std::erase(page, '\\');
  std::istringstream help(limn({"render", "--help"}).out);
  std::size_t options = 0;
  for (std::string word; help >> word;) {
    if (!word.starts_with("--") || word.find_first_not_of("-abcdefghijklmnopqrstuvwxyz") != std::string::npos)
      continue;
    ++options;
    EXPECT_NE(manual.find(word), std::string::npos) << word;
    EXPECT_NE(page.find(word), std::string::npos) << word;
  }
  EXPECT_GT(options, 30U);
}

}  // namespace
