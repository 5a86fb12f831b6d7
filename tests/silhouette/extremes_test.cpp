// Input that no good exporter writes: nothing is ever NaN, no triangle is lost.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>
#include <stdexcept>

#include "shapes.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::vector<Parameters> everyMethod() {
  std::vector<Parameters> all;
  for (const Method method : {Method::kPatches, Method::kPn}) {
    for (const Tangents tangents : {Tangents::kProjected, Tangents::kCircular, Tangents::kGeodesic}) {
      Parameters parameters;
      parameters.method = method;
      parameters.tangents = tangents;
      parameters.silhouetteness =
          tangents == Tangents::kProjected ? Silhouetteness::kEdge : Silhouetteness::kContour;
      parameters.robust = tangents != Tangents::kProjected;
      parameters.segments = method == Method::kPn ? 3 : 0;
      parameters.boundaries = true;
      parameters.shadingNormals =
          tangents == Tangents::kCircular ? ShadingNormals::kQuadratic : ShadingNormals::kLinear;
      parameters.tolerance = 2.0f;
      all.push_back(parameters);
    }
  }
  return all;
}

void expectSane(const Shape& shape, const View& view) {
  Workers workers(1);
  const Topology topology(shape.mesh());
  EXPECT_TRUE(topology.isConsistent(shape.mesh())) << shape.name;
  Refiner refiner(shape.mesh(), topology, workers);
  for (const Parameters& parameters : everyMethod()) {
    RefinedStream stream;
    refiner.refine(view, parameters, stream);
    EXPECT_TRUE(stream.isConsistent(shape.mesh())) << shape.name;
    EXPECT_EQ(openSides(drawnTriangles(shape.mesh(), stream)), 0u) << shape.name;
  }
}

void expectSane(const Shape& shape) {
  for (const View& view : someViews(4.0f)) expectSane(shape, view);
}

TEST(Extremes, OpposedNormals) {
  Shape shape = icosphere(1);
  for (vec3& n : shape.normals) n = -n;
  EXPECT_EQ(Topology(shape.mesh()).report().opposedTriangles, shape.mesh().triangleCount());
  expectSane(shape);
  shape = torn(icosphere(1));
  for (std::size_t i = 0; i < shape.normals.size(); i += 2) shape.normals[i] = -shape.normals[i];
  expectSane(shape);
}

TEST(Extremes, ZeroNormals) {
  Shape shape = icosphere(1);
  for (vec3& n : shape.normals) n = vec3(0.0f);
  expectSane(shape);
}

TEST(Extremes, Needles) {
  Shape shape = icosphere(1);
  for (vec3& p : shape.positions) p = {p.x, 1e-6f * p.y, 1e6f * p.z};
  expectSane(shape);
  for (vec3& p : shape.positions) p = vec3(1.0f);  // nothing but repeated points
  expectSane(shape);
}

TEST(Extremes, EyeInsideAndOnTheSurface) {
  const Shape shape = icosphere(1);
  expectSane(shape, perspectiveFrom({0.1f, 0.0f, 0.1f}));
  expectSane(shape, perspectiveFrom(shape.positions[3]));
  expectSane(shape, perspectiveFrom(0.5f * (shape.positions[0] + shape.positions[11])));
  expectSane(shape, perspectiveFrom(1.0001f * shape.positions[3], 1e-6f));
}

TEST(Extremes, FarFromTheOrigin) {
  Shape shape = icosphere(1);
  for (vec3& p : shape.positions) p += vec3(1000.0f, 0.0f, 0.0f);
  expectSane(shape, perspectiveFrom({1003.0f, 0.5f, 0.2f}));
}

TEST(Extremes, ViewsThatAreRefused) {
  const Projection projection{true, 100.0f, 100.0f, 0.1f, 10.0f, 100, 100};
  EXPECT_THROW(makeView(projection, glm::scale(glm::dmat4(1.0), glm::dvec3(1.0, 0.0, 1.0))),
               std::invalid_argument);
  glm::dmat4 bad(1.0);
  bad[3][0] = std::nan("");
  EXPECT_THROW(makeView(projection, bad), std::invalid_argument);
  // The eye of a far-away and tiny instance is where it should be.
  const View view = makeView(
      projection, glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(1e9, 0, -1e9)), glm::dvec3(1e-3)));
  EXPECT_FLOAT_EQ(view.eye.x, -1e12f);
  EXPECT_FLOAT_EQ(view.eye.z, 1e12f);
}

TEST(Extremes, ParametersThatAreRefused) {
  const Shape shape = cube();
  Workers workers(1);
  const Topology topology(shape.mesh());
  Refiner refiner(shape.mesh(), topology, workers);
  RefinedStream stream;
  const View view = perspectiveFrom({0, 0, 5});
  const auto refuses = [&](auto change) {
    Parameters parameters;
    change(parameters);
    EXPECT_THROW(refiner.refine(view, parameters, stream), std::invalid_argument);
  };
  refuses([](Parameters& p) { p.tolerance = -1.0f; });
  refuses([](Parameters& p) { p.tolerance = std::nanf(""); });
  refuses([](Parameters& p) { p.segments = kMaxSegments + 1; });
  refuses([](Parameters& p) { p.beta = -0.1f; });
  refuses([](Parameters& p) { p.wedgeDegrees = 181.0f; });
  std::vector<float> betas(3, 0.25f);
  refuses([&](Parameters& p) { p.edgeBetas = betas; });
  betas.assign(topology.edges().size(), 0.25f);
  for (const float beta : {-0.1f, std::nanf(""), kInfinity}) {
    betas.back() = beta;
    refuses([&](Parameters& p) { p.edgeBetas = betas; });
  }
}

TEST(Extremes, MeshesThatDoNotGoTogetherAreRefused) {
  const Shape shape = cube(), other = icosphere(0);
  Workers workers(1), others(1);
  const Topology topology(shape.mesh());
  EXPECT_THROW(Refiner(other.mesh(), topology, workers), std::invalid_argument);
  const std::vector<FittedEnds> tooFew(3);
  EXPECT_THROW(Refiner(shape.mesh(), topology, workers, {tooFew, {}}), std::invalid_argument);
  Refiner refiner(shape.mesh(), topology, workers);
  EXPECT_THROW(refiner.deform(other.mesh()), std::invalid_argument);
  RefinedStream stream;
  RefineTask task{&refiner, perspectiveFrom({0, 0, 5}), nullptr, {}};
  EXPECT_THROW(refineAll({&task, 1}, {}, workers), std::invalid_argument);
  task.stream = &stream;
  EXPECT_THROW(refineAll({&task, 1}, {}, others), std::invalid_argument);
  refineAll({&task, 1}, {}, workers);
}

std::vector<Parameters> everyPathOfIndices() {
  std::vector<Parameters> all(6);
  all[1].silhouetteness = Silhouetteness::kEdge;
  all[2].segments = 5;
  all[3].method = all[4].method = Method::kCurves;
  all[3].tolerance = 0.02f;
  all[4].segments = 3;
  all[4].robust = false;
  all[5].method = Method::kPn;
  all[5].tolerance = 20.0f;
  return all;
}

void expectIndicesInRange(const Shape& shape, const RefinedStream& stream, std::uint32_t seed) {
  for (const std::uint32_t index : stream.indices)
    ASSERT_LT(index, shape.positions.size() + stream.positions.size()) << "seed " << seed;
  for (std::size_t t = 0; t < stream.triangleCount(); ++t)
    ASSERT_TRUE(stream.isReplaced(stream.sourceTriangles[t])) << "seed " << seed;
}

// The contract excludes such numbers; a caller's mistake must not become a fault of memory.
TEST(Extremes, NumbersThatAreNoneBreakNothing) {
  const Shape shape = icosphere(2);
  const Topology topology(shape.mesh());
  Workers workers(1);
  constexpr std::array kBad{
      std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 3e38f, -3e38f, 1e30f};
  for (std::uint32_t seed = 1; seed <= 24; ++seed) {
    std::mt19937 random(seed);
    Shape bad = shape;
    for (auto* array : {&bad.positions, &bad.normals})
      for (vec3& v : *array)
        if (random() % 8 < seed % 4) v[static_cast<int>(random() % 3)] = kBad[random() % kBad.size()];
    View view = perspectiveFrom({1, 2, 4});
    if (seed % 4 == 0) view.eye = vec3(kBad[random() % kBad.size()]);
    const Topology own(bad.mesh());
    Refiner deformed(shape.mesh(), topology, workers), from(bad.mesh(), own, workers);
    deformed.deform(bad.mesh());
    for (const Parameters& parameters : everyPathOfIndices()) {
      RefinedStream stream;
      deformed.refine(view, parameters, stream);
      expectIndicesInRange(bad, stream, seed);
      from.refine(view, parameters, stream);
      expectIndicesInRange(bad, stream, seed);
    }
  }
}

}  // namespace
}  // namespace limn::silhouette::test
