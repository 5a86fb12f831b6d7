// The models that tests run over: built-in ones, and small files of coarse and fine ones where they are at hand.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <vector>

namespace limn::scene {

inline std::vector<std::string> smallModels() {
  namespace fs = std::filesystem;
  std::vector<std::string> found{"builtin:icosphere-320", "builtin:torus-576", "builtin:knot-480",
                                 "builtin:pawn"};
  const fs::path folder = fs::path(LIMN_MODELS_DIR) / "coarse-and-fine";
  std::vector<std::string> files;
  if (fs::is_directory(folder))
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".glb" && entry.file_size() < 100'000) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  found.insert(found.end(), files.begin(), files.end());
  return found;
}

inline std::string testNameOf(const testing::TestParamInfo<std::string>& model) {
  std::string name = model.param.substr(model.param.find_last_of(":/") + 1);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

}  // namespace limn::scene
