#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "shapes.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

RefinedStream refined(const Shape& shape, const View& view, const Parameters& parameters, int threads = 1) {
  Workers workers(threads);
  const Topology topology(shape.mesh());
  Refiner refiner(shape.mesh(), topology, workers);
  RefinedStream stream;
  refiner.refine(view, parameters, stream);
  return stream;
}

bool equal(const RefinedStream& a, const RefinedStream& b) {
  if (a.positions != b.positions || a.normals != b.normals || a.indices != b.indices) return false;
  if (a.sourceTriangles != b.sourceTriangles || a.replaced != b.replaced) return false;
  for (std::size_t i = 0; i < a.origins.size(); ++i)
    if (a.origins[i].triangle != b.origins[i].triangle || a.origins[i].weights != b.origins[i].weights)
      return false;
  return true;
}

// One set of parameters for every choice there is, in a few combinations.
std::vector<Parameters> someParameters() {
  std::vector<Parameters> all(7);
  all[1].segments = 3;
  all[1].robust = false;
  all[2].silhouetteness = Silhouetteness::kEdge;
  all[2].tangents = Tangents::kProjected;
  all[2].boundaries = true;
  all[3].tangents = Tangents::kCircular;
  all[3].shadingNormals = ShadingNormals::kQuadratic;
  all[3].features = false;
  all[3].wedgeDegrees = 30.0f;
  all[4].beta = 0.0f;
  all[4].tolerance = 0.1f;
  all[5].method = Method::kPn;
  all[5].segments = 4;
  all[5].shadingNormals = ShadingNormals::kQuadratic;
  all[6].method = Method::kPn;
  all[6].tolerance = 4.0f;
  return all;
}

TEST(Stream, FlatReplacesNothing) {
  Parameters parameters;
  parameters.method = Method::kFlat;
  const Shape shape = icosphere(2);
  const RefinedStream stream = refined(shape, perspectiveFrom({0, 0, 5}), parameters);
  EXPECT_TRUE(stream.isConsistent(shape.mesh()));
  EXPECT_EQ(stream.triangleCount(), 0u);
}

TEST(Stream, IsConsistentAndWatertight) {
  for (const Shape& shape : allShapes()) {
    RefinedStream nothing;
    nothing.clear(shape.mesh().triangleCount());
    const std::size_t open = openSides(drawnTriangles(shape.mesh(), nothing));
    for (const View& view : someViews(4.0f)) {
      for (const Parameters& parameters : someParameters()) {
        const RefinedStream stream = refined(shape, view, parameters);
        EXPECT_TRUE(stream.isConsistent(shape.mesh())) << shape.name;
        // A smooth boundary has more sides than a straight one.
        const bool divided = parameters.boundaries || parameters.method == Method::kPn;
        if (open == 0 || !divided) {
          EXPECT_EQ(openSides(drawnTriangles(shape.mesh(), stream)), open) << shape.name;
        }
      }
    }
  }
}

TEST(Stream, LinearPrecision) {
  Parameters parameters;
  parameters.boundaries = true;
  for (const View& view : someViews(4.0f))
    EXPECT_EQ(refined(flatGrid(4), view, parameters).triangleCount(), 0u);
}

// The first rows of the strip between corner 0 and 1 tell that every index lies where it should: areas add up
// and no triangle turns over.
TEST(Stream, FlatPatchesAreTiledOnce) {
  Shape shape = flatGrid(2);
  for (glm::vec3& n : shape.normals) n = glm::normalize(vec3(0.01f, 0.02f, 1.0f));
  for (const int segments : {2, 3, 5}) {
    for (const Method method : {Method::kPatches, Method::kPn}) {
      Parameters parameters;
      parameters.method = method;
      parameters.segments = segments;
      parameters.boundaries = true;
      parameters.robust = false;
      parameters.silhouetteness = Silhouetteness::kEdge;
      parameters.beta = 100.0f;
      const RefinedStream stream = refined(shape, perspectiveFrom({0, 0, 5}), parameters);
      const std::vector<vec3> drawn = drawnTriangles(shape.mesh(), stream);
      EXPECT_GT(stream.triangleCount(), 0u);
      double area = 0.0;
      for (std::size_t t = 0; t < drawn.size(); t += 3) {
        const double z = glm::cross(drawn[t + 1] - drawn[t], drawn[t + 2] - drawn[t]).z;
        EXPECT_GT(z, 0.0);
        area += 0.5 * z;
      }
      EXPECT_NEAR(area, 4.0, 0.02);
    }
  }
}

TEST(Stream, SameForAnyNumberOfThreads) {
  for (const Shape& shape : {icosphere(4), shaken(torus(60, 20), 3)}) {
    const View view = perspectiveFrom({1, 2, 4});
    Parameters parameters;
    parameters.tolerance = 0.05f;
    const RefinedStream one = refined(shape, view, parameters);
    EXPECT_GT(one.triangleCount(), 0u);
    for (const int threads : {2, 3, 8, 32})
      EXPECT_TRUE(equal(one, refined(shape, view, parameters, threads))) << threads;
  }
}

TEST(Stream, ManyInstancesAreAsOne) {
  const Shape shape = icosphere(2);
  Workers workers(3);
  const Topology topology(shape.mesh());
  Refiner refiner(shape.mesh(), topology, workers);
  std::vector<View> views = someViews(4.0f);
  std::vector<RefinedStream> streams(views.size());
  std::vector<RefineTask> tasks;
  for (std::size_t k = 0; k < views.size(); ++k) tasks.push_back({&refiner, views[k], &streams[k], {}});
  refineAll(tasks, {}, workers);
  for (std::size_t k = 0; k < views.size(); ++k) {
    EXPECT_TRUE(equal(streams[k], refined(shape, views[k], {}))) << k;
    EXPECT_EQ(tasks[k].report.refinedTriangles, streams[k].triangleCount());
  }
}

}  // namespace
}  // namespace limn::silhouette::test
