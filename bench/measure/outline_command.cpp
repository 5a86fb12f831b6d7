// limn_measure outline
#include <cstdio>
#include <filesystem>

#include "apps/scene/image.h"
#include "bench/measure/command.h"

namespace limn::measure {
namespace {

// Writes a picture per view and variant: grey where truth and method agree, red what the method leaves out,
// blue what it has too much.
class DifferenceDump : public ViewObserver {
 public:
  DifferenceDump(std::string folder, std::string model)
      : folder_(std::move(folder)), model_(std::move(model)) {
    for (char& c : model_) c = c == ':' ? '-' : c;
    std::filesystem::create_directories(folder_);
  }

  void see(const Variant& variant, std::size_t view, const Mask& truth, const Mask& drawn) override {
    scene::Image image;
    image.width = truth.columns() / kSamplesPerPixel;
    image.height = truth.rows() / kSamplesPerPixel;
    image.rgba.reserve(std::size_t(image.width) * image.height * 4);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const double both = share(x, y, truth, drawn, [](auto t, auto d) { return t & d; });
        const double missing = share(x, y, truth, drawn, [](auto t, auto d) { return t & ~d; });
        const double extra = share(x, y, truth, drawn, [](auto t, auto d) { return ~t & d; });
        const double white = 1.0 - both - missing - extra;
        for (const double channel : {white + 0.75 * both + 0.85 * missing + 0.10 * extra,
                                     white + 0.75 * both + 0.15 * missing + 0.35 * extra,
                                     white + 0.75 * both + 0.10 * missing + 0.90 * extra, 1.0}) {
          image.rgba.push_back(static_cast<std::uint8_t>(channel * 255.0 + 0.5));
        }
      }
    }
    char name[96];
    std::snprintf(name, sizeof name, "-%g-%02zu.png", double(variant.parameters.tolerance), view + 1);
    std::string method = variant.name;
    for (char& c : method) c = c == ':' ? '-' : c;
    const std::vector<std::uint8_t> png = scene::encodePng(image, {}, 6);
    scene::writeFileWhole(folder_ + "/" + model_ + "-" + method + name, png.data(), png.size());
  }

 private:
  // Share of the samples of a pixel for which `choose` of truth and drawn is set.
  template <class Choose>
  static double share(int x, int y, const Mask& truth, const Mask& drawn, const Choose& choose) {
    int count = 0;
    const std::size_t word = static_cast<std::size_t>(x) * kSamplesPerPixel / 64;
    const int shift = x * kSamplesPerPixel % 64;
    for (int j = y * kSamplesPerPixel; j < (y + 1) * kSamplesPerPixel; ++j) {
      count += std::popcount(choose(truth.row(j)[word], drawn.row(j)[word]) >> shift & 0xffffu);
    }
    return count / double(kSamplesPerPixel * kSamplesPerPixel);
  }

  std::string folder_, model_;
};

Json jsonOf(const AccuracyRow& row) {
  return {{"model", row.model},
          {"method", row.method},
          {"tolerance", rounded(row.tolerance)},
          {"views", row.views},
          {"mean_px", rounded(row.mean)},
          {"p95_px", rounded(row.p95)},
          {"max_px", rounded(row.max)},
          {"corner_deg", rounded(row.corner)},
          {"flat_mean_px", rounded(row.flatMean)},
          {"removed", rounded(row.removed())},
          {"views_worse_than_flat", row.viewsWorseThanFlat},
          {"triangles", rounded(row.triangles)},
          {"flat_p95_px", rounded(row.flatP95)},
          {"flat_max_px", rounded(row.flatMax)},
          {"flat_corner_deg", rounded(row.flatCorner)},
          {"true_corner_deg", rounded(row.trueCorner)}};
}

void addViewRows(const AccuracyRow& row, const Accuracy& accuracy, std::size_t variant,
                 const std::vector<glm::dvec3>& directions, std::vector<Json>& rows) {
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const ViewFigures& view = accuracy.methods[variant][i];
    const glm::dvec3& d = directions[i];
    rows.push_back({{"model", row.model},
                    {"method", row.method},
                    {"tolerance", rounded(row.tolerance)},
                    {"view", i + 1},
                    {"direction", {rounded(d.x), rounded(d.y), rounded(d.z)}},
                    {"mean_px", rounded(view.mean)},
                    {"p95_px", rounded(view.p95)},
                    {"max_px", rounded(view.max)},
                    {"corner_deg", rounded(view.corner)},
                    {"flat_mean_px", rounded(accuracy.flat[i].mean)},
                    {"triangles", view.triangles}});
  }
}

void tell(const AccuracyRow& row) {
  std::fprintf(stderr, "%-22s %-18s %6g %8.3f %8.3f %8.3f %8.3f %7.1f%% %3zu/%-3zu %8.1f\n",
               row.model.c_str(), row.method.c_str(), row.tolerance, row.mean, row.p95, row.max, row.corner,
               100 * row.removed(), row.viewsWorseThanFlat, row.views, row.triangles);
}

// Sum of offsets over the models of a group.
void tellPooled(const char* group, const std::vector<AccuracyRow>& rows) {
  AccuracyRow sum;
  sum.model = group;
  double least = 1.0;
  for (const AccuracyRow& row : rows) {
    sum.method = row.method;
    sum.tolerance = row.tolerance;
    sum.mean += row.mean;
    sum.flatMean += row.flatMean;
    sum.viewsWorseThanFlat += row.viewsWorseThanFlat;
    sum.views += row.views;
    sum.triangles += row.triangles / static_cast<double>(rows.size());
    least = std::min(least, row.removed());
  }
  std::fprintf(
      stderr,
      "%-22s %-18s %6g %8.3f px of %.3f: %.1f %% removed, least %.1f %%; %zu of %zu views (%.1f %%) worse "
      "than flat; %.0f triangles\n",
      sum.model.c_str(), sum.method.c_str(), sum.tolerance, sum.mean, sum.flatMean, 100 * sum.removed(),
      100 * least, sum.viewsWorseThanFlat, sum.views,
      100.0 * double(sum.viewsWorseThanFlat) / double(sum.views), sum.triangles);
}

}  // namespace

int runOutline(const Options& options) {
  std::vector<std::string> methods = options.methods;
  if (methods.empty()) {
    methods = {"flat",
               "patches",
               "patches:projected",
               "patches:circular",
               "patches:geodesic",
               "curves",
               "pn:2",
               "pn:4",
               "pn:8",
               "pn:16"};
    if (options.quick) methods = {"flat", "patches", "curves", "pn"};
  }
  const std::vector<Variant> variants = makeVariants(options, methods);
  const std::vector<glm::dvec3> directions = makeDirections(options);
  Workers workers(threadsOf(options));
  std::vector<Json> rows;
  std::vector<std::vector<AccuracyRow>> analytic(variants.size()), modelled(variants.size());
  std::fprintf(stderr, "%-22s %-18s %6s %8s %8s %8s %8s %8s %7s %8s\n", "model", "method", "tol", "mean_px",
               "p95_px", "max_px", "corner", "removed", "worse", "tris");
  forSubjects(options, [&](const Subject& subject) {
    const Pair& pair = subject.pair;
    std::unique_ptr<DifferenceDump> dump;
    if (!options.dumpFolder.empty()) dump = std::make_unique<DifferenceDump>(options.dumpFolder, pair.name);
    const Accuracy accuracy =
        measureAccuracy(subject, variants, directions, options.size, workers, dump.get());
    for (std::size_t v = 0; v < variants.size(); ++v) {
      const AccuracyRow row = summarize(subject, variants[v], accuracy, v);
      tell(row);
      rows.push_back(jsonOf(row));
      if (options.perView) addViewRows(row, accuracy, v, directions, rows);
      (pair.analytic ? analytic : modelled)[v].push_back(row);
    }
  });
  for (std::size_t v = 0; v < variants.size(); ++v) {
    if (analytic[v].size() > 1) tellPooled("pooled, analytic", analytic[v]);
    if (modelled[v].size() > 1) tellPooled("pooled, modelled", modelled[v]);
  }
  print(rows);
  return 0;
}

}  // namespace limn::measure
