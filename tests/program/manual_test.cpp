// Every command of the documents works, and every picture in them is there.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <regex>

#include "tests/program/run_program.h"
#include "tests/scene/gltf_writer.h"

namespace {

namespace fs = std::filesystem;
using limn::scene::test::GltfWriter;
using limn::test::ProgramTest;

const fs::path kDocuments = LIMN_DOCUMENTS;

class Manual : public ProgramTest {
 protected:
  /// The models that the commands speak of: an animated triangle for each. And a stand-in for ffmpeg where there is
  /// none, which wants whole frames of 640 x 400.
  void SetUp() override {
    GltfWriter writer;
    writer.addTriangle();
    const nlohmann::json sampler = {{"input", writer.addArray<float>({0, 0.2f}, "SCALAR")},
                                    {"output", writer.addArray<float>({0, 0, 0, 1, 0, 0}, "VEC3")}};
    const nlohmann::json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
    writer.root["animations"] = {{{"name", "Run"}, {"samplers", {sampler}}, {"channels", {channel}}}};
    const auto bytes = writer.glb();
    for (const char* name : {"model.glb", "duck.glb", "fox.glb"})
      write(name, std::string(bytes.begin(), bytes.end()));
    fs::copy(kDocuments / "models", path("models"));
    fs::create_directories(path("bin"));
    if (std::system("command -v ffmpeg >/dev/null") == 0) return;
    write("bin/ffmpeg",
          "#!/bin/sh\nbytes=$(wc -c)\n[ $bytes -gt 0 ] && [ $((bytes % (640 * 400 * 4))) = 0 ]\n");
    fs::permissions(path("bin/ffmpeg"), fs::perms::owner_all);
  }

  void expectToWork(const std::vector<std::string>& commands) const {
    const std::string programs = fs::path(LIMN_PROGRAM).parent_path();
    for (const std::string& command : commands) {
      write("command.sh", "PATH='" + programs + "':$PWD/bin:$PATH\n" + command + "\n");
      const std::string line = "cd '" + directory_.string() + "' && bash -o pipefail command.sh >/dev/null";
      EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 0) << command;
    }
  }
};

/// The lines between "```sh" and "```", joined where they go on. Those of `make` are left to whoever runs the tests.
std::vector<std::string> commandsOf(const fs::path& file) {
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

/// The lines that are commands of limn after `indent`; explanations after two spaces are cut off.
std::vector<std::string> examplesIn(std::istream& text, const std::string& indent) {
  std::vector<std::string> commands;
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with(indent + "limn ")) continue;
    line = line.substr(indent.size());
    commands.push_back(line.substr(0, line.find("  ")));
  }
  return commands;
}

TEST_F(Manual, CommandsOfThePagesWork) {
  std::size_t count = 0;
  for (const fs::path& page :
       {kDocuments / "manual.md", kDocuments / "options.md", kDocuments / "../README.md"}) {
    const std::vector<std::string> commands = commandsOf(page);
    EXPECT_FALSE(commands.empty()) << page;
    expectToWork(commands);
    count += commands.size();
  }
  EXPECT_GT(count, 70U);
  // Those of options.md are the pictures that it shows.
  for (const fs::directory_entry& shown : fs::directory_iterator(kDocuments / "pictures/options")) {
    const std::string drawn = "pictures/options" / shown.path().filename();
    EXPECT_EQ(limn({"compare", drawn, shown.path()}).status, 0) << drawn << " is old; run make pictures";
  }
}

TEST_F(Manual, ExamplesOfTheManPageAndOfHelpWork) {
  std::ifstream file(kDocuments / "limn.1");
  std::stringstream page;
  bool isExample = false;
  for (std::string line; std::getline(file, line);) {
    isExample = line == ".SH EXAMPLES" || (isExample && !line.starts_with(".SH"));
    std::erase(line, '\\');
    if (isExample) page << line << '\n';
  }
  std::vector<std::string> examples = examplesIn(page, "");
  EXPECT_GE(examples.size(), 3U);
  expectToWork(examples);
  for (const char* command : {"render", "refine"}) {
    std::istringstream help(limn({command, "--help"}).out);
    examples = examplesIn(help, "  ");
    EXPECT_FALSE(examples.empty()) << command;
    expectToWork(examples);
  }
}

TEST_F(Manual, PicturesAreThere) {
  for (const auto& entry : fs::directory_iterator(kDocuments)) {
    if (entry.path().extension() != ".md") continue;
    std::ifstream text(entry.path());
    const std::string page{std::istreambuf_iterator<char>(text), std::istreambuf_iterator<char>()};
    static const std::regex kPicture(R"(!\[[^\]]*\]\(([^)]+)\))");
    for (auto found = std::sregex_iterator(page.begin(), page.end(), kPicture);
         found != std::sregex_iterator(); ++found)
      EXPECT_TRUE(fs::exists(kDocuments / found->str(1))) << entry.path() << ": " << found->str(1);
  }
}

std::string readText(const fs::path& file) {
  std::ifstream text(file);
  return {std::istreambuf_iterator<char>(text), std::istreambuf_iterator<char>()};
}

TEST_F(Manual, AndManPageNameEveryOption) {
  const std::string manual = readText(kDocuments / "manual.md");
  std::string page = readText(kDocuments / "limn.1");
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
