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
      for (const int segments : {0, 3}) {
        Parameters parameters;
        parameters.segments = segments;
        const RefinedStream stream = refined(shape, view, parameters);
        EXPECT_TRUE(stream.isConsistent(shape.mesh())) << shape.name;
        EXPECT_EQ(openSides(drawnTriangles(shape.mesh(), stream)), open) << shape.name;
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

TEST(Stream, SameForAnyNumberOfThreads) {
  for (const Shape& shape : {icosphere(5), shaken(torus(60, 40), 3)}) {
    const View view = perspectiveFrom({1, 2, 4});
    Parameters parameters;
    parameters.tolerance = 0.01f;
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
