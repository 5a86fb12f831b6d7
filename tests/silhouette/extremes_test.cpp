// Input that no good exporter writes: nothing is ever NaN, no triangle is lost.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <stdexcept>

#include "shapes.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

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
  const std::vector<float> betas(3, 0.25f);
  refuses([&](Parameters& p) { p.edgeBetas = betas; });
}

}  // namespace
}  // namespace limn::silhouette::test
