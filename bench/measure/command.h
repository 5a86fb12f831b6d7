// What the subcommands of limn_measure share: options, method lists, rows.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/measure/accuracy.h"

namespace limn::measure {

using Json = nlohmann::ordered_json;

/// The options of every subcommand.
struct Options {
  std::vector<std::string> models;  ///< empty: the standard ones
  std::string truth;
  std::string modelsFolder = "../shared/models";
  std::vector<std::string> methods;
  std::vector<double> tolerances{0.25};
  bool tolerancesGiven = false;
  int views = 0;  ///< 0: the standard 26, or --seed with 26
  std::int64_t seed = -1;
  int size = 1024;
  int threads = 0;  ///< 0: all
  bool quick = false;
  bool perView = false;
  std::string dumpFolder;
  std::string plotFolder;               ///< trade: tables for gnuplot
  double arc = 6.0;                     ///< coherence: degrees of camera path
  std::vector<double> steps{0.4, 0.1};  ///< coherence: degrees per frame
  silhouette::Parameters parameters;    ///< but for method and tolerance
};

void addOptions(CLI::App& command, Options& options);

/// METHOD, patches:TANGENTS, curves, METHOD:SEGMENTS; each with each tolerance (once where the segments are
/// fixed, and once for flat). Throws std::invalid_argument.
std::vector<Variant> makeVariants(const Options& options, const std::vector<std::string>& methods);

/// Calls body(subject) for every model asked for. A file of the standard pairs that cannot be read is left out with a
/// note on standard error; one that was named is an InputError.
void forSubjects(const Options& options, const std::function<void(const Subject&)>& body);
std::vector<glm::dvec3> makeDirections(const Options& options);
int threadsOf(const Options& options);

/// Rounded for reading: five decimals.
double rounded(double value);

/// The rows on standard output as a JSON array, one per line.
void print(const std::vector<Json>& rows);

int runOutline(const Options& options);
int runCoherence(const Options& options);
int runStability(const Options& options);
int runTrade(const Options& options);

}  // namespace limn::measure
