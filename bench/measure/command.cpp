#include "bench/measure/command.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

#include "apps/scene/load.h"
#include "bench/measure/views.h"

namespace limn::measure {
namespace {

using silhouette::Method;
using silhouette::Silhouetteness;
using silhouette::Tangents;

const std::map<std::string, Method> kMethods{
    {"flat", Method::kFlat}, {"patches", Method::kPatches}, {"curves", Method::kCurves}, {"pn", Method::kPn}};
const std::map<std::string, Tangents> kTangents{{"projected", Tangents::kProjected},
                                                {"circular", Tangents::kCircular},
                                                {"geodesic", Tangents::kGeodesic}};
const std::map<std::string, Silhouetteness> kSilhouetteness{{"edge", Silhouetteness::kEdge},
                                                            {"contour", Silhouetteness::kContour},
                                                            {"crossing", Silhouetteness::kCrossing}};
const std::map<std::string, bool> kSwitch{{"on", true}, {"off", false}};

template <class Value>
CLI::CheckedTransformer oneOf(const std::map<std::string, Value>& choices) {
  return CLI::CheckedTransformer(choices, CLI::ignore_case);
}

}  // namespace

void addOptions(CLI::App& command, Options& options) {
  silhouette::Parameters& p = options.parameters;
  command.add_option("--model", options.models,
                     "file or builtin:NAME; may be repeated (default: all there are)");
  command.add_option("--truth", options.truth,
                     "the model that it stands for, or `analytic` (default: looked up)");
  command.add_option("--models-folder", options.modelsFolder, "where coarse-and-fine/ lies");
  command
      .add_option("--method", options.methods,
                  "flat, patches, patches:TANGENTS, curves, pn, METHOD:SEGMENTS; a list")
      ->delimiter(',');
  command.add_option("--tolerance", options.tolerances, "pixels; a list")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber);
  command.add_option("--views", options.views, "26 = the standard ones; another number needs --seed");
  command.add_option("--seed", options.seed, "directions by chance")->check(CLI::NonNegativeNumber);
  command.add_option("--size", options.size, "of the square window in pixels")->check(CLI::Range(16, 2048));
  command.add_option("--threads", options.threads, "in all (default: what the machine has)")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--quick", options.quick, "fewer views and models: within a minute");
  command.add_option("--segments", p.segments, "fixed count per edge instead of the tolerance")
      ->check(CLI::Range(0, silhouette::kMaxSegments));
  command.add_option("--beta", p.beta, "width of the transition")->check(CLI::NonNegativeNumber);
  command.add_option("--wedge", p.wedgeDegrees, "wedge angle in degrees instead of beta")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--silhouetteness", p.silhouetteness, "edge, contour or crossing")
      ->transform(oneOf(kSilhouetteness));
  command.add_option("--tangents", p.tangents, "projected, circular or geodesic")
      ->transform(oneOf(kTangents));
  command.add_option("--robust", p.robust, "on or off")->transform(oneOf(kSwitch));
  command.add_option("--features", p.features, "on or off")->transform(oneOf(kSwitch));
  command.add_option("--boundaries", p.boundaries, "on or off")->transform(oneOf(kSwitch));
}

namespace {

// Reads "METHOD" or "METHOD:REST" into parameters.
silhouette::Parameters parseMethod(const std::string& text, silhouette::Parameters parameters) {
  const std::size_t colon = text.find(':');
  const auto method = kMethods.find(text.substr(0, colon));
  if (method == kMethods.end()) throw std::invalid_argument("--method: no method is called " + text);
  parameters.method = method->second;
  if (colon == std::string::npos) return parameters;
  const std::string rest = text.substr(colon + 1);
  if (const auto tangents = kTangents.find(rest); tangents != kTangents.end()) {
    parameters.tangents = tangents->second;
    return parameters;
  }
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), parameters.segments);
  const bool whole = error == std::errc() && end == rest.data() + rest.size();
  if (!whole || parameters.segments < 1 || parameters.segments > silhouette::kMaxSegments) {
    throw std::invalid_argument("--method: after the colon of " + text +
                                " stands a kind of tangents or 1 to 64 segments");
  }
  return parameters;
}

}  // namespace

std::vector<Variant> makeVariants(const Options& options, const std::vector<std::string>& methods) {
  std::vector<Variant> variants;
  for (const std::string& name : methods) {
    Variant variant{name, parseMethod(name, options.parameters)};
    const bool toleranceCounts =
        variant.parameters.segments == 0 && variant.parameters.method != Method::kFlat;
    for (const double tolerance : options.tolerances) {
      variant.parameters.tolerance = static_cast<float>(tolerance);
      variants.push_back(variant);
      if (!toleranceCounts) break;
    }
  }
  return variants;
}

void forSubjects(const Options& options, const std::function<void(const Subject&)>& body) {
  for (const std::string& model : options.models) body(loadSubject(makePair(model, options.truth)));
  if (!options.models.empty()) return;
  for (const Pair& pair : standardPairs(options.modelsFolder)) {
    try {
      body(loadSubject(pair));
    } catch (const scene::InputError& error) {
      std::fprintf(stderr, "limn_measure: left out: %s\n", error.what());
    }
  }
}

std::vector<glm::dvec3> makeDirections(const Options& options) {
  constexpr int kStandard = 26;
  if (options.seed >= 0) {
    return randomDirections(static_cast<std::uint64_t>(options.seed),
                            options.views > 0 ? options.views : kStandard);
  }
  if (options.views != 0 && options.views != kStandard) {
    throw std::invalid_argument("--views: without --seed there are the 26 standard views");
  }
  std::vector<glm::dvec3> directions = standardDirections();
  if (!options.quick) return directions;
  std::vector<glm::dvec3> some;
  for (std::size_t i = 0; i < directions.size(); i += 5) some.push_back(directions[i]);
  return some;
}

int threadsOf(const Options& options) {
  return options.threads > 0 ? options.threads : availableThreads();
}

double rounded(double value) {
  return std::round(value * 1e5) / 1e5;
}

void print(const std::vector<Json>& rows) {
  std::fputs("[", stdout);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::printf("%s\n  %s", i == 0 ? "" : ",", rows[i].dump().c_str());
  }
  std::fputs("\n]\n", stdout);
}

}  // namespace limn::measure
