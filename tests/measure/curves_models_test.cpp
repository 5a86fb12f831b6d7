// Silhouette curves on models that nobody here wrote: whole from any viewpoint, and nothing turned inside out.
//
// Twenty viewpoints for each model; with LIMN_LONG_TESTS in the environment a thousand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <random>

#include "bench/measure/model.h"
#include "tests/silhouette/shapes.h"

namespace limn::measure {
namespace {

namespace fs = std::filesystem;
using glm::dvec2;
using glm::dvec3;
using glm::vec3;
using silhouette::test::drawnTriangles;

int viewCount() {
  return std::getenv("LIMN_LONG_TESTS") != nullptr ? 1000 : 20;
}

std::vector<std::string> models() {
  std::vector<std::string> found{"builtin:sphere-200", "builtin:icosphere-320", "builtin:torus-576",
                                 "builtin:knot-480",   "builtin:cone-70",       "builtin:pawn"};
  std::vector<std::string> files;
  for (const char* name : {"coarse-and-fine", "gltf"}) {
    const fs::path folder = fs::path(LIMN_MODELS_DIR) / name;
    if (!fs::is_directory(folder)) continue;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".glb" && entry.path().stem() != "Duck-meshopt")
        files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  found.insert(found.end(), files.begin(), files.end());
  return found;
}

std::string testName(const testing::TestParamInfo<std::string>& info) {
  std::string name = fs::path(info.param).stem();
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

silhouette::Parameters curves(int k) {
  silhouette::Parameters parameters;
  parameters.method = silhouette::Method::kCurves;
  parameters.tolerance = k % 4 == 0 ? 0.02f : 0.25f;
  parameters.robust = k % 3 != 0;
  return parameters;
}

class CurvesOnModel : public testing::TestWithParam<std::string> {};

TEST_P(CurvesOnModel, IsWatertight) {
  Workers workers(2);
  std::mt19937 random(23);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> uniform;
  for (const PlacedMesh& part : loadMeshes(GetParam())) {
    const silhouette::Mesh mesh = part.shape();
    const silhouette::Topology topology(mesh);
    silhouette::Refiner refiner(mesh, topology, workers);
    silhouette::RefinedStream stream;
    stream.clear(mesh.triangleCount());
    const std::size_t open = silhouette::test::openSides(drawnTriangles(mesh, stream));
    float reach = 0.0f;
    for (const vec3& p : mesh.positions) reach = std::max(reach, glm::length(p));
    // A fine mesh is as many cases per view as a coarse one has in many.
    const int views = std::max(2, viewCount() / std::max(1, static_cast<int>(mesh.triangleCount() / 1000)));
    for (int k = 0; k < views; ++k) {
      const vec3 direction = glm::normalize(vec3(normal(random), normal(random), normal(random)));
      const silhouette::View view =
          k % 5 == 4
              ? silhouette::test::orthographicAlong(direction)
              : silhouette::test::perspectiveFrom(reach * (1.01f + 4.0f * uniform(random)) * direction);
      refiner.refine(view, curves(k), stream);
      ASSERT_TRUE(stream.isConsistent(mesh)) << "view " << k;
      ASSERT_EQ(silhouette::test::openSides(drawnTriangles(mesh, stream)),
                open + silhouette::test::verticesOnBoundaries(topology, stream))
          << "view " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, CurvesOnModel, testing::ValuesIn(models()), testName);

// Which way the nearest triangle faces along a grid of parallel lines of sight.
class FacingPicture {
 public:
  FacingPicture(const vec3& direction, double reach)
      : direction_(direction), reach_(reach), depths_(kSize * kSize, 1e30) {
    right_ = glm::normalize(glm::cross(direction_, dvec3(0.31, 0.53, 0.79)));
    up_ = glm::cross(right_, direction_);
    away_.resize(depths_.size());
  }
  void add(const std::vector<vec3>& triangles) {
    for (std::size_t t = 0; t < triangles.size(); t += 3)
      draw({triangles[t], triangles[t + 1], triangles[t + 2]});
  }
  std::size_t backFaces() const {
    return static_cast<std::size_t>(std::count(away_.begin(), away_.end(), 1));
  }
  std::size_t covered() const {
    return static_cast<std::size_t>(
        std::count_if(depths_.begin(), depths_.end(), [](double d) { return d < 1e29; }));
  }

 private:
  static constexpr int kSize = 256;

  void draw(const std::array<dvec3, 3>& p) {
    dvec2 q[3];
    for (int k = 0; k < 3; ++k)
      q[k] = (dvec2(glm::dot(p[k], right_), glm::dot(p[k], up_)) / reach_ + 1.0) * (0.5 * kSize) - 0.5;
    const auto cross = [](const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; };
    const double area = cross(q[1] - q[0], q[2] - q[0]);
    if (std::abs(area) < 1e-9) return;
    const dvec2 low = glm::min(q[0], glm::min(q[1], q[2])), high = glm::max(q[0], glm::max(q[1], q[2]));
    for (int y = std::max(0, static_cast<int>(std::ceil(low.y))); y <= std::min(kSize - 1.0, high.y); ++y)
      for (int x = std::max(0, static_cast<int>(std::ceil(low.x))); x <= std::min(kSize - 1.0, high.x); ++x) {
        const dvec2 c(x, y);
        const double b1 = cross(c - q[0], q[2] - q[0]) / area, b2 = cross(q[1] - q[0], c - q[0]) / area;
        if (b1 < 0.0 || b2 < 0.0 || b1 + b2 > 1.0) continue;
        const double depth = glm::dot((1.0 - b1 - b2) * p[0] + b1 * p[1] + b2 * p[2], direction_);
        const std::size_t at = static_cast<std::size_t>(y * kSize + x);
        if (depth >= depths_[at]) continue;
        depths_[at] = depth;
        away_[at] = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), direction_) > 0.0 ? 1 : 0;
      }
  }

  dvec3 direction_, right_, up_;
  double reach_;
  std::vector<double> depths_;
  std::vector<std::uint8_t> away_;
};

// On a closed surface the nearest triangle faces the viewer; where pieces fold over each other it does not.
TEST(CurvesOnShapes, NothingSeenIsTurnedInsideOut) {
  Workers workers(1);
  std::mt19937 random(29);
  std::normal_distribution<float> normal;
  for (const char* name :
       {"builtin:sphere-200", "builtin:icosphere-320", "builtin:torus-576", "builtin:knot-480"}) {
    const PlacedMesh part = loadMeshes(name)[0];
    const silhouette::Mesh mesh = part.shape();
    const silhouette::Topology topology(mesh);
    silhouette::Refiner refiner(mesh, topology, workers);
    silhouette::RefinedStream stream;
    double reach = 0.0;
    for (const vec3& p : mesh.positions) reach = std::max(reach, 1.1 * static_cast<double>(glm::length(p)));
    std::size_t covered = 0, backFaces = 0;
    for (int k = 0; k < viewCount(); ++k) {
      const vec3 direction = glm::normalize(vec3(normal(random), normal(random), normal(random)));
      refiner.refine(silhouette::test::orthographicAlong(direction), curves(k), stream);
      FacingPicture picture(direction, reach);
      picture.add(drawnTriangles(mesh, stream));
      covered += picture.covered();
      backFaces += picture.backFaces();
    }
    ASSERT_GT(covered, 0u);
    // Where three sheets meet at a point of the outline the nearest is a matter of the last digit.
    EXPECT_LE(static_cast<double>(backFaces), 2e-5 * static_cast<double>(covered)) << name;
  }
}

}  // namespace
}  // namespace limn::measure
