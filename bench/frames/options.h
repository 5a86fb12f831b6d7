// What the frame benchmarks can be asked: the options that limn's program and its peer share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bench/frames/grid_scene.h"

namespace limn::bench {

struct SceneOptions {
  std::string model = "icosphere-320";
  int copies = 60;
  int width = 1280, height = 800;
  double scale = 0.0;  ///< 0: search
  double coverage = 0.5;
  int texture = 0;  ///< 0 none, 1 bilinear in the nearest mip level, 2 trilinear
  int threads = 2;
  int views = 24;
  double seconds = 1.0;
  std::string dump;
};

/// Declares the shared options; `threads` has the program's own words.
void declare(CLI::App& app, SceneOptions& options, const std::string& threadsHelp);

/// The scale at which `options.coverage` of view 0 is covered; `covered(scale)` draws it and says how much is.
template <class Covered>
double findScale(const SceneOptions& options, const Covered& covered) {
  double low = 0.0, high = 2.0;
  for (int step = 0; step < 12; ++step) {
    const double middle = (low + high) / 2.0;
    (covered(middle) < options.coverage ? low : high) = middle;
  }
  return (low + high) / 2.0;
}

}  // namespace limn::bench
