#include "apps/coarsen/simplify.h"

#include <gtest/gtest.h>

#include <map>

#include "apps/coarsen/outline_weight.h"
#include "apps/coarsen/same_vertices.h"
#include "tests/coarsen/fine_models.h"

namespace limn::coarsen::test {
namespace {

struct Case {
  scene::Mesh mesh;
  std::vector<Index> pointOf, groupOf;
  Surface surface;
  std::vector<double> weights;

  explicit Case(scene::Mesh source) : mesh(std::move(source)) {
    surface = makeSurface(mesh.positions, mesh.normals, mesh.indices, &pointOf);
    groupOf.resize(mesh.indices.size() / 3);
    for (std::size_t part = 0; part < mesh.parts.size(); ++part)
      for (std::size_t k = 0; k < mesh.parts[part].triangleCount; ++k)
        groupOf[mesh.parts[part].firstTriangle + k] = static_cast<Index>(part);
    weights.assign(surface.points.size(), 1.0);
  }
  Simplified to(std::size_t triangles) const {
    return simplify({mesh.indices, mesh.normals, mesh.texcoords, pointOf, groupOf, surface, weights},
                    triangles);
  }
  scene::Mesh meshOf(const Simplified& simplified) const {
    scene::Mesh result = mesh;
    result.indices = simplified.indices;
    return result;
  }
};

TEST(Simplify, ClosedStaysClosedAndKeepsItsHoles) {
  for (const std::string name : {"icosphere:4", "torus:64:32", "knot:80:12"}) {
    const Case model(builtinMesh(name));
    const scene::Mesh coarse = model.meshOf(model.to(300));
    const silhouette::Topology topology(shapeOf(coarse));
    EXPECT_LE(coarse.indices.size() / 3, 300u) << name;
    EXPECT_GE(coarse.indices.size() / 3, 298u) << name;
    EXPECT_EQ(topology.report().boundaryEdges, 0u) << name;
    EXPECT_EQ(topology.report().nonManifoldEdges, 0u) << name;
    EXPECT_EQ(topology.report().degenerateTriangles, 0u) << name;
    // All vertices are still there, unused: count the used points.
    std::vector<bool> used(topology.pointCount(), false);
    for (const Index vertex : coarse.indices) used[topology.points()[vertex]] = true;
    const long points = std::count(used.begin(), used.end(), true);
    const long expected = name[0] == 'i' ? 2 : 0;
    EXPECT_EQ(
        points - static_cast<long>(topology.edges().size()) + static_cast<long>(coarse.indices.size() / 3),
        expected)
        << name;
  }
}

TEST(Simplify, SeamsMaterialsAndBoundariesStayTogether) {
  const Case model(bumpyField(24));
  const Simplified simplified = model.to(200);
  const scene::Mesh coarse = model.meshOf(simplified);
  const silhouette::Topology topology(shapeOf(coarse));
  EXPECT_EQ(topology.report().nonManifoldEdges, 0u);
  double length = 0.0;
  for (const silhouette::Edge& edge : topology.edges()) {
    const silhouette::EdgeVertices v = silhouette::edgeVertices(shapeOf(coarse), edge);
    if (edge.boundary) length += glm::distance(coarse.positions[v[0][0]], coarse.positions[v[0][1]]);
    // Seam edges run along x = 0, and only they have two vertices per point.
    if (!edge.boundary && v[0][0] != v[1][0] && v[0][1] != v[1][1]) {
      EXPECT_EQ(coarse.positions[v[0][0]].x, 0.0f);
    }
  }
  double fineLength = 0.0;
  const silhouette::Topology fine(shapeOf(model.mesh));
  for (const silhouette::Edge& edge : fine.edges())
    if (edge.boundary) {
      const silhouette::EdgeVertices v = silhouette::edgeVertices(shapeOf(model.mesh), edge);
      fineLength += glm::distance(model.mesh.positions[v[0][0]], model.mesh.positions[v[0][1]]);
    }
  EXPECT_NEAR(length, fineLength, 0.02 * fineLength);
  for (std::size_t t = 0; t < simplified.triangles.size(); ++t) {
    const std::size_t group = model.groupOf[simplified.triangles[t]];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const float x = coarse.positions[simplified.indices[3 * t + corner]].x;
      EXPECT_TRUE(group == 0 ? x <= 0.0f : x >= 0.0f);
    }
  }
}

TEST(Simplify, SplitNormalsGiveWayWhereTheyMust) {
  // Every triangle has vertices and normals of its own: nothing collapses along seams alone.
  scene::Mesh faceted = builtinMesh("icosphere:3"), torn = faceted;
  torn.positions.clear();
  torn.normals.clear();
  torn.indices.clear();
  for (std::size_t side = 0; side < faceted.indices.size(); ++side) {
    const std::size_t first = side - side % 3;
    const auto at = [&](std::size_t k) { return faceted.positions[faceted.indices[first + k]]; };
    torn.positions.push_back(at(side % 3));
    torn.normals.push_back(glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0))));
    torn.indices.push_back(static_cast<Index>(side));
  }
  const Case model(torn);
  EXPECT_LE(model.to(200).triangles.size(), 200u);
}

// As files without indices have it: a vertex for each corner.
scene::Mesh tornField() {
  const scene::Mesh field = bumpyField(24);
  scene::Mesh torn;
  for (const Index vertex : field.indices) {
    torn.indices.push_back(static_cast<Index>(torn.positions.size()));
    torn.positions.push_back(field.positions[vertex]);
    torn.normals.push_back(field.normals[vertex]);
    torn.texcoords.push_back(field.texcoords[vertex]);
  }
  torn.parts.push_back({0, static_cast<Index>(torn.indices.size() / 3), 0});
  return torn;
}

TEST(Simplify, VerticesThatDifferInNothingAreNoSeam) {
  Case model(tornField());
  const std::vector<Index> firsts = firstsOfTheSame(model.mesh, model.pointOf);
  for (std::size_t v = 0; v < firsts.size(); ++v) {
    ASSERT_EQ(firsts[firsts[v]], firsts[v]);
    ASSERT_EQ(model.mesh.positions[firsts[v]], model.mesh.positions[v]);
    ASSERT_EQ(model.mesh.texcoords[firsts[v]], model.mesh.texcoords[v]);
  }
  for (Index& vertex : model.mesh.indices) vertex = firsts[vertex];
  const Simplified simplified = model.to(200);
  EXPECT_LE(simplified.triangles.size(), 200u);
  // The texture begins anew at x = 0, and no triangle reaches from one side to the other.
  for (std::size_t t = 0; t < simplified.triangles.size(); ++t) {
    float centre = 0.0f;
    for (std::size_t k = 0; k < 3; ++k)
      centre += model.mesh.positions[simplified.indices[3 * t + k]].x / 3.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index vertex = simplified.indices[3 * t + k];
      EXPECT_NEAR(model.mesh.texcoords[vertex].x,
                  model.mesh.positions[vertex].x + (centre < 0.0f ? 0.0f : -1.0f), 1e-6f);
    }
  }
}

// Marching through a volume leaves clusters of near points with needles between them: here around each vertex of a fair
// mesh, one point a hundredth along each of its edges.
scene::Mesh sphereWithNeedles() {
  scene::Mesh mesh = builtinMesh("icosphere:4");
  const std::vector<Index> fair = std::move(mesh.indices);
  mesh.indices.clear();
  std::map<std::array<Index, 2>, Index> points;
  const auto near = [&](Index from, Index to) {
    const auto [found, isNew] = points.try_emplace({from, to}, static_cast<Index>(mesh.positions.size()));
    if (isNew) {
      mesh.positions.push_back(glm::normalize(glm::mix(mesh.positions[from], mesh.positions[to], 0.01f)));
      mesh.normals.push_back(mesh.positions.back());
    }
    return found->second;
  };
  for (std::size_t first = 0; first < fair.size(); first += 3) {
    const std::array<Index, 3> corners = {fair[first], fair[first + 1], fair[first + 2]};
    std::array<Index, 6> around;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
      around[2 * k] = near(a, b);
      around[2 * k + 1] = near(b, a);
      mesh.indices.insert(mesh.indices.end(), {a, near(a, b), near(a, c)});
    }
    for (std::size_t k = 2; k < around.size(); ++k)
      mesh.indices.insert(mesh.indices.end(), {around[0], around[k - 1], around[k]});
  }
  return mesh;
}

TEST(Simplify, NeedlesDoNotStandInTheWay) {
  const Case model(sphereWithNeedles());
  const Simplified simplified = model.to(300);
  EXPECT_LE(simplified.triangles.size(), 300u);
  // Corners lie on the unit sphere. Of 300 even triangles the centre is 0.019 below it.
  for (std::size_t first = 0; first < simplified.indices.size(); first += 3) {
    glm::vec3 centre(0.0f);
    for (std::size_t k = 0; k < 3; ++k) centre += model.mesh.positions[simplified.indices[first + k]] / 3.0f;
    EXPECT_GT(glm::length(centre), 0.93f);
  }
}

TEST(Simplify, NeverGrowsAndStopsWhereTopologyDoes) {
  const Case model(builtinMesh("icosphere:1"));
  EXPECT_EQ(model.to(1000).triangles.size(), model.surface.triangleCount());
  EXPECT_GE(model.to(1).triangles.size(), 4u);
}

TEST(OutlineWeights, AreTheSameForAnyNumberOfThreads) {
  const Case model(builtinMesh("knot:80:12"));
  Workers one(1), three(3);
  EXPECT_EQ(outlineWeights(model.surface, 0.2, one), outlineWeights(model.surface, 0.2, three));
}

TEST(OutlineWeights, HiddenPartsWeighNothing) {
  // A sphere within a sphere: the inner one is never on an outline.
  scene::Mesh mesh = builtinMesh("icosphere:3");
  const std::size_t outer = mesh.positions.size(), outerIndices = mesh.indices.size();
  for (std::size_t v = 0; v < outer; ++v) {
    mesh.positions.push_back(0.5f * mesh.positions[v]);
    mesh.normals.push_back(mesh.normals[v]);
  }
  for (std::size_t k = 0; k < outerIndices; ++k)
    mesh.indices.push_back(mesh.indices[k] + static_cast<Index>(outer));
  const Case model(mesh);
  Workers workers(2);
  const std::vector<double> weights = outlineWeights(model.surface, 0.0, workers);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const double weight = weights[model.pointOf[v]];
    if (v < outer)
      EXPECT_NEAR(weight, 1.25, 0.5);  // the inner quarter of the area takes no part
    else
      EXPECT_EQ(weight, 0.0);
  }
}

}  // namespace
}  // namespace limn::coarsen::test
