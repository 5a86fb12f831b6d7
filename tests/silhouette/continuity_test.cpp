// The surface moves continuously with the viewpoint: over ever smaller steps its change falls to the tolerance's share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "shapes.h"

namespace limn::silhouette::test {
namespace {

using glm::dvec3;
using glm::vec3;

// Points of the drawn surface above fixed places of the coarse mesh: the midpoints of edges and triangles. Found by
// origin, so that different subdivisions can be compared.
std::vector<dvec3> samples(const Mesh& mesh, const RefinedStream& stream) {
  std::vector<dvec3> result(4 * mesh.triangleCount());
  struct Corner {
    dvec3 position;
    glm::dvec2 weights;
  };
  const glm::dvec2 places[4] = {{0.5, 0.0}, {0.5, 0.5}, {0.0, 0.5}, {1.0 / 3.0, 1.0 / 3.0}};
  const auto take = [&](std::uint32_t triangle, const Corner(&c)[3]) {
    const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    const double area = cross(c[1].weights - c[0].weights, c[2].weights - c[0].weights);
    for (std::size_t k = 0; k < 4; ++k) {
      const double v = cross(places[k] - c[0].weights, c[2].weights - c[0].weights) / area;
      const double w = cross(c[1].weights - c[0].weights, places[k] - c[0].weights) / area;
      if (v < -1e-5 || w < -1e-5 || v + w > 1.0 + 1e-5) continue;
      result[4 * triangle + k] = (1.0 - v - w) * c[0].position + v * c[1].position + w * c[2].position;
    }
  };
  for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
    if (stream.isReplaced(t)) continue;
    const std::uint32_t* corner = &mesh.indices[3 * std::size_t{t}];
    take(t, {{dvec3(mesh.positions[corner[0]]), {0, 0}},
             {dvec3(mesh.positions[corner[1]]), {1, 0}},
             {dvec3(mesh.positions[corner[2]]), {0, 1}}});
  }
  for (std::size_t t = 0; t < stream.triangleCount(); ++t) {
    const std::uint32_t source = stream.sourceTriangles[t];
    Corner corners[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t index = stream.indices[3 * t + k];
      if (index < mesh.positions.size()) {
        corners[k].position = dvec3(mesh.positions[index]);
        for (std::size_t i = 0; i < 3; ++i)
          if (mesh.indices[3 * source + i] == index)
            corners[k].weights = {i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
        continue;
      }
      const Origin& origin = stream.origins[index - mesh.positions.size()];
      corners[k].position = dvec3(stream.positions[index - mesh.positions.size()]);
      corners[k].weights = glm::dvec2(origin.weights);
      if (origin.triangle == source) continue;
      // A shared vertex named by the neighbour: its weights by corners that both have.
      const std::uint32_t* other = &mesh.indices[3 * std::size_t{origin.triangle}];
      const double share[3] = {1.0 - origin.weights.x - origin.weights.y, origin.weights.x, origin.weights.y};
      corners[k].weights = {0, 0};
      for (std::size_t i = 0; i < 3; ++i) {
        if (other[i] == mesh.indices[3 * source + 1]) corners[k].weights.x = share[i];
        if (other[i] == mesh.indices[3 * source + 2]) corners[k].weights.y = share[i];
      }
    }
    take(source, corners);
  }
  return result;
}

TEST(Continuity, ChangeShrinksWithTheStep) {
  for (const Shape& shape : {icosphere(1), cylinder(9)}) {
    const Mesh mesh = shape.mesh();
    Workers workers(1);
    const Topology topology(mesh);
    Refiner refiner(mesh, topology, workers);
    Parameters parameters;
    parameters.tolerance = 0.25f;
    constexpr double kDistance = 5.0;
    for (const double step : {1e-2, 1e-3, 1e-4}) {
      double largest = 0.0;  // pixels
      std::vector<dvec3> before;
      for (int k = 0; k < 80; ++k) {
        const double a = 0.3 + (k / 2 * 0.031) + (k % 2 != 0 ? step : 0.0);
        const View view = perspectiveFrom(vec3(kDistance * std::cos(a), 1.1, kDistance * std::sin(a)));
        RefinedStream stream;
        refiner.refine(view, parameters, stream);
        const std::vector<dvec3> now = samples(mesh, stream);
        for (std::size_t i = 0; i < now.size() && k % 2 != 0; ++i)
          largest = std::max(largest,
                             glm::length(now[i] - before[i]) * view.projection.pixelsX / (kDistance - 1.5));
        before = now;
      }
      // What the blend moves in a step (β = 0.05 and bulges of up to 60 pixels), and what a change of segments may.
      EXPECT_LT(largest, 4e3 * step + 4.0 * parameters.tolerance) << shape.name << ", step " << step;
    }
  }
}

// Wherever a step along the path moves the surface, its halves are followed down to steps of 1e-7: what is left there is a
// jump. On edges it is within the tolerance; in the middle of triangles, where grids of other steps follow each other, within
// three: what the spokes tell of a grid's error is an estimate, about 4/3 too small there on either side.
TEST(Continuity, JumpsAreWithinTheTolerance) {
  for (const Shape& shape : {icosphere(1), icosphere(2), cylinder(9), shaken(torus(12, 8), 5)}) {
    const Mesh mesh = shape.mesh();
    Workers workers(1);
    const Topology topology(mesh);
    Refiner refiner(mesh, topology, workers);
    const Parameters parameters;
    RefinedStream stream;
    using Surface = std::vector<dvec3>;
    const auto viewAt = [](double a) {
      return perspectiveFrom(vec3(5.0 * std::cos(a), 1.1, 5.0 * std::sin(a)));
    };
    const auto surfaceAt = [&](double a) -> Surface {
      refiner.refine(viewAt(a), parameters, stream);
      return samples(mesh, stream);
    };
    struct Change {
      double onEdges = 0.0, inside = 0.0;  // largest, in tolerances
      double largest() const { return std::max(onEdges, inside); }
    };
    const auto change = [&](double at, const Surface& a, const Surface& b) {
      const View view = viewAt(at);
      const auto project = [&](const dvec3& p) {
        const dvec3 v(glm::dmat4(view.modelToView) * glm::dvec4(p, 1.0));
        return static_cast<double>(view.projection.pixelsX) / -v.z * glm::dvec2(v);
      };
      Change result;
      for (std::size_t i = 0; i < a.size(); ++i) {
        double& largest = i % 4 == 3 ? result.inside : result.onEdges;
        largest = std::max(largest, glm::length(project(a[i]) - project(b[i])) / parameters.tolerance);
      }
      return result;
    };
    for (int k = 0; k < 150; ++k) {
      double from = 0.3 + 0.01 * k, to = from + 0.01;
      Surface first = surfaceAt(from), last = surfaceAt(to);
      while (to - from > 1e-7 && change(from, first, last).largest() > 0.5) {
        const double half = 0.5 * (from + to);
        const Surface middle = surfaceAt(half);
        const bool left = change(from, first, middle).largest() > change(from, middle, last).largest();
        (left ? to : from) = half;
        (left ? last : first) = middle;
      }
      if (to - from <= 1e-7) {
        const Change jump = change(from, first, last);
        EXPECT_LT(jump.onEdges, 1.05) << shape.name << " at " << from;
        EXPECT_LT(jump.inside, 3.0) << shape.name << " at " << from;
      }
    }
  }
}

}  // namespace
}  // namespace limn::silhouette::test
