// The command line, read.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/limn/aov.h"
#include "apps/limn/job.h"

namespace limn::program {

struct RenderOptions {
  JobOptions job;
  std::optional<std::string> frames;
  std::optional<std::string> output;
  bool rgba = false;  ///< raw rows instead of PNG
  int compression = 1;
  std::vector<Aov> aovs;
  int threads = 1;
  bool hash = false;
  std::optional<std::string> statistics, manifest;
  std::pair<int, int> shard{1, 1};
  bool skipExisting = false, dryRun = false, quiet = false;
};

struct RefineOptions {
  JobOptions job;
  int frame = 1;
  std::string output;
  bool alphas = false, quiet = false;
  int threads = 1;
};

struct InfoOptions {
  std::string model = "builtin:demo";
  bool json = false;
};

struct CompareOptions {
  std::string first, second;
  std::optional<std::string> output;
};

struct VerifyOptions {
  std::vector<std::string> manifests;
  int threads = 1;
};

struct CoarsenOptions {
  std::string fine;
  std::string output;
  std::optional<std::size_t> triangles;
  std::optional<std::string> coarse;
  std::optional<double> error;            ///< pixels
  std::optional<std::pair<int, int>> at;  ///< the window in which they count
  int threads = 1;
  bool quiet = false;
};

struct CommandLine {
  enum class Command { kRender, kRefine, kInfo, kCompare, kCoarsen, kVerify, kModels, kPrinted };
  Command command = Command::kPrinted;  ///< kPrinted: help or version, already on standard output
  RenderOptions render;
  RefineOptions refine;
  InfoOptions info;
  CompareOptions compare;
  VerifyOptions verify;
  CoarsenOptions coarsen;
};

/// Throws UsageError.
CommandLine readCommandLine(int count, const char* const* arguments);

}  // namespace limn::program
