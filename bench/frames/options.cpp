#include "bench/frames/options.h"

#include <charconv>

namespace limn::bench {
namespace {

// "1280x800" into both numbers; CLI11 wants the error message, or none.
std::string parseSize(const std::string& text, int& width, int& height) {
  const char* end = text.data() + text.size();
  const auto [x, first] = std::from_chars(text.data(), end, width);
  if (first == std::errc() && x != end && *x == 'x') {
    const auto [rest, second] = std::from_chars(x + 1, end, height);
    if (second == std::errc() && rest == end && width >= 1 && height >= 1 && width <= 16384 &&
        height <= 16384)
      return {};
  }
  return "is WIDTHxHEIGHT, each 1 to 16384";
}

}  // namespace

void declare(CLI::App& app, SceneOptions& options, const std::string& threadsHelp) {
  app.add_option("--model", options.model, "a built-in model or a glTF file, fitted to the unit sphere")
      ->capture_default_str();
  app.add_option("--copies", options.copies, "on a grid that fills the window")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--size",
         [&options](const std::string& text) {
           const std::string error = parseSize(text, options.width, options.height);
           if (!error.empty()) throw CLI::ValidationError("--size", error);
         },
         "pixels")
      ->default_str("1280x800");
  CLI::Option* scale =
      app.add_option("--scale", options.scale, "radius of a copy in halves of a cell's smaller side");
  scale->check(CLI::PositiveNumber);
  app.add_option("--coverage", options.coverage, "search the scale that covers this share of view 0")
      ->check(CLI::Range(0.0, 1.0))
      ->excludes(scale)
      ->capture_default_str();
  app.add_option("--texture", options.texture, "0 none, 1 bilinear with mip maps, 2 trilinear")
      ->check(CLI::Range(0, 2))
      ->capture_default_str();
  app.add_option("--threads", options.threads, threadsHelp)
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app.add_option("--poses", options.views, "views in one turn")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "measuring time; at least two turns are drawn")
      ->capture_default_str();
  app.add_option("--dump", options.dump, "write view 0 as PNG");
}

}  // namespace limn::bench
