// limn_measure: accuracy, coherence, cost and stability of the methods, as JSON on standard output and as a
// table on standard error. Exit status as limn's: 2 usage, 3 bad input, 4 output could not be written.
#include <cstdio>
#include <stdexcept>

#include "apps/scene/image.h"
#include "apps/scene/load.h"
#include "bench/measure/command.h"

namespace {

using limn::measure::Options;

int run(int argc, char** argv) {
  CLI::App app("What a smooth silhouette is worth, and what it costs.", "limn_measure");
  app.require_subcommand(1);
  Options options;
  CLI::App* const outline = app.add_subcommand("outline", "how far the outlines are from the true ones");
  limn::measure::addOptions(*outline, options);
  outline->add_flag("--per-view", options.perView, "a row for every view besides");
  outline->add_option("--dump", options.dumpFolder,
                      "folder for difference pictures: red is missing, blue too much");
  CLI::App* const coherence =
      app.add_subcommand("coherence", "how far the outlines jump while the camera moves evenly");
  limn::measure::addOptions(*coherence, options);
  coherence->add_option("--arc", options.arc, "degrees of camera path")->check(CLI::Range(0.001, 360.0));
  coherence->add_option("--step", options.steps, "degrees per frame; a list")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  CLI::App* const stability =
      app.add_subcommand("stability", "kernels against exact twins, and the extremes");
  stability->add_option("--seed", options.seed, "of the inputs")->check(CLI::NonNegativeNumber);
  stability->add_flag("--quick", options.quick, "fewer cases");
  CLI::App* const trade =
      app.add_subcommand("trade", "accuracy against cost; what no other choice beats is marked");
  limn::measure::addOptions(*trade, options);
  trade->add_option("--plot", options.plotFolder, "folder for trade-*.dat, which bench/trade.gp draws");
  CLI11_PARSE(app, argc, argv);
  if (coherence->parsed()) return runCoherence(options);
  if (stability->parsed()) return runStability(options);
  if (trade->parsed()) {
    options.tolerancesGiven = trade->count("--tolerance") > 0;
    return runTrade(options);
  }
  return runOutline(options);
}

int fail(int status, const char* what) {
  std::fprintf(stderr, "limn_measure: %s\n", what);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv) == 0 ? 0 : 2;
  } catch (const limn::scene::InputError& error) {
    return fail(3, error.what());
  } catch (const limn::scene::OutputError& error) {
    return fail(4, error.what());
  } catch (const std::invalid_argument& error) {
    return fail(2, error.what());
  } catch (const std::exception& error) {
    return fail(1, error.what());
  }
}
