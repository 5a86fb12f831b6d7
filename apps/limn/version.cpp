#include "apps/limn/version.h"

#include <libdeflate.h>
#include <oneapi/tbb/version.h>
#include <png.h>
#include <xxhash.h>

#include <hwy/targets.h>
#include <CLI/Version.hpp>
#include <cstdint>
#include <glm/detail/setup.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

namespace limn::program {
namespace {

/// 10639 -> "1.6.39".
std::string dotted(unsigned number) {
  return std::to_string(number / 10000) + "." + std::to_string(number / 100 % 100) + "." +
         std::to_string(number % 100);
}

/// The best of those that the kernels are made for.
const char* instructionSet() {
  const std::int64_t targets = hwy::SupportedTargets();
  if ((targets & HWY_AVX3) != 0) return "AVX-512";
  if ((targets & HWY_AVX2) != 0) return "AVX2";
  return (targets & HWY_SSE4) != 0 ? "SSE4" : "plain C++";
}

}  // namespace

std::string versionText() {
  std::ostringstream text;
  text << "limn " << LIMN_VERSION << "\n\nBuilt by "
#ifdef __clang__
       << "clang++ " << __clang_major__ << '.' << __clang_minor__ << '.' << __clang_patchlevel__
#else
       << "g++ " << __GNUC__ << '.' << __GNUC_MINOR__ << '.' << __GNUC_PATCHLEVEL__
#endif
       << ", draws with " << instructionSet() << "\non oneTBB " << TBB_runtime_version() << ", Highway "
       << LIMN_HIGHWAY_VERSION << ", GLM " << GLM_VERSION_MAJOR << '.' << GLM_VERSION_MINOR << '.'
       << GLM_VERSION_PATCH << '.' << GLM_VERSION_REVISION << ",\nCLI11 " << CLI11_VERSION
       << ", nlohmann-json " << NLOHMANN_JSON_VERSION_MAJOR << '.' << NLOHMANN_JSON_VERSION_MINOR << '.'
       << NLOHMANN_JSON_VERSION_PATCH << ",\nlibpng " << dotted(png_access_version_number())
       << ", libdeflate " << LIBDEFLATE_VERSION_STRING << ", xxHash " << dotted(XXH_VERSION_NUMBER)
       << ", tinygltf, stb_image_write";
  return text.str();
}

}  // namespace limn::program
