// A fine mesh → outline weights → fewer triangles → fitted patches → guarded → stored numbers.
#include "apps/coarsen/coarsen.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <span>

#include "apps/coarsen/fit.h"
#include "apps/coarsen/outline_weight.h"
#include "apps/coarsen/same_vertices.h"
#include "apps/coarsen/simplify.h"
#include "apps/coarsen/store.h"
#include "raster/base/check.h"
#include "raster/cluster.h"

namespace limn::coarsen {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double kWeightFloor = 0.2;  // of the mean, for what no outline shows
// Shares of the time, for progress.
constexpr double kWeighed = 0.1, kSimplified = 0.3, kFitted = 0.95;

/// A fine mesh, ready to be coarsened.
struct Fine {
  std::vector<Index> indices;  ///< those of the mesh, one vertex for all that differ in nothing
  std::vector<Index> pointOf;
  Surface surface;
  std::vector<double> weights;

  Fine(const scene::Mesh& mesh, Workers& workers)
      : surface(makeSurface(mesh.positions, mesh.normals, mesh.indices, &pointOf)),
        weights(outlineWeights(surface, kWeightFloor, workers)) {
    const std::vector<Index> firsts = firstsOfTheSame(mesh, pointOf);
    indices.reserve(mesh.indices.size());
    for (const Index vertex : mesh.indices) indices.push_back(firsts[vertex]);
  }
};

void tell(const Progress& progress, double from, double to, double part) {
  if (progress) progress(from + (to - from) * part);
}

template <class T>
std::vector<T> gathered(const std::vector<T>& all, const std::vector<Index>& elements) {
  std::vector<T> result;
  if (all.empty()) return result;
  result.reserve(elements.size());
  for (const Index element : elements) result.push_back(all[element]);
  return result;
}

/// The mesh of some of its vertices.
scene::Mesh subset(const scene::Mesh& mesh, const std::vector<Index>& vertices) {
  scene::Mesh out;
  out.name = mesh.name;
  out.origin = mesh.origin;
  out.scale = mesh.scale;
  out.weights = mesh.weights;
  out.positions = gathered(mesh.positions, vertices);
  out.normals = gathered(mesh.normals, vertices);
  out.texcoords = gathered(mesh.texcoords, vertices);
  out.colors = gathered(mesh.colors, vertices);
  out.tangents = gathered(mesh.tangents, vertices);
  for (const scene::MorphTarget& target : mesh.targets)
    out.targets.push_back({gathered(target.positions, vertices), gathered(target.normals, vertices),
                           gathered(target.tangents, vertices)});
  for (const scene::SkinBinding& binding : mesh.skinning)
    out.skinning.push_back({gathered(binding.joints, vertices), gathered(binding.weights, vertices)});
  return out;
}

std::vector<Index> partOfTriangles(const scene::Mesh& mesh) {
  std::vector<Index> parts(mesh.indices.size() / 3, 0);
  for (Index part = 0; part < mesh.parts.size(); ++part)
    for (Index t = 0; t < mesh.parts[part].triangleCount; ++t)
      parts[mesh.parts[part].firstTriangle + t] = part;
  return parts;
}

/// Orders triangles so that those that follow each other make round clusters, which a renderer transforms and culls at
/// once. A simplified mesh comes in the fine one's order, of which too little is left.
void orderIntoClusters(std::span<Index> indices, const std::vector<vec3>& positions) {
  constexpr float kConeWeight = 0.0f;  // flat clusters instead of round ones measured worse
  const std::size_t most =
      meshopt_buildMeshletsBound(indices.size(), raster::kClusterVertices, raster::kClusterTriangles);
  std::vector<meshopt_Meshlet> clusters(most);
  std::vector<Index> vertices(most * raster::kClusterVertices);
  std::vector<std::uint8_t> corners(most * 3 * raster::kClusterTriangles);
  clusters.resize(meshopt_buildMeshlets(clusters.data(), vertices.data(), corners.data(), indices.data(),
                                        indices.size(), &positions[0].x, positions.size(), sizeof(vec3),
                                        raster::kClusterVertices, raster::kClusterTriangles, kConeWeight));
  auto next = indices.begin();
  for (const meshopt_Meshlet& cluster : clusters)
    for (unsigned corner = 0; corner < 3 * cluster.triangle_count; ++corner)
      *next++ = vertices[cluster.vertex_offset + corners[cluster.triangle_offset + corner]];
}

/// The coarse mesh with the source's parts, vertices in the order of their first use.
scene::Mesh assemble(const scene::Mesh& fine, const std::vector<Index>& partOf,
                     const Simplified& simplified) {
  std::vector<Index> order(simplified.triangles.size());
  for (Index t = 0; t < order.size(); ++t) order[t] = t;
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return partOf[simplified.triangles[a]] < partOf[simplified.triangles[b]];
  });
  std::vector<raster::Part> parts;
  std::vector<Index> indices;
  for (Index k = 0; k < order.size(); ++k) {
    const raster::Part& source = fine.parts[partOf[simplified.triangles[order[k]]]];
    if (parts.empty() || parts.back().material != source.material) parts.push_back({k, 0, source.material});
    ++parts.back().triangleCount;
    for (std::size_t corner = 0; corner < 3; ++corner)
      indices.push_back(simplified.indices[3 * order[k] + corner]);
  }
  for (const raster::Part& part : parts)
    orderIntoClusters(
        std::span(indices).subspan(3 * std::size_t{part.firstTriangle}, 3 * std::size_t{part.triangleCount}),
        fine.positions);
  std::vector<Index> vertices, number(fine.positions.size(), kNone);
  for (Index& vertex : indices) {
    if (number[vertex] == kNone) {
      number[vertex] = static_cast<Index>(vertices.size());
      vertices.push_back(vertex);
    }
    vertex = number[vertex];
  }
  scene::Mesh out = subset(fine, vertices);
  out.indices = std::move(indices);
  out.parts = std::move(parts);
  return out;
}

/// Fits, guards and stores curves for `coarse`; moves its vertices where `settings` allow it.
void fitCurves(const Fine& fine, const FitSettings& settings, Workers& workers, scene::Mesh& coarse,
               Report* report, const Progress& progress) {
  std::vector<Index> pointOf;
  const Surface surface = makeSurface(coarse.positions, coarse.normals, coarse.indices, &pointOf);
  PatchNet net(surface.points, surface.corners, surface.lines);
  fitPatches(fine.surface, fine.weights, settings, workers, net, [&](int round) {
    tell(progress, kSimplified, kFitted, static_cast<double>(round) / settings.rounds);
  });
  const GuardReport guard = guardPatches(fine.surface, workers, net);
  if (settings.moveCorners)
    for (std::size_t v = 0; v < coarse.positions.size(); ++v)
      coarse.positions[v] = vec3(net.controls[pointOf[v]]);
  storeCurves(net, surface.triangles, coarse);
  if (report != nullptr) {
    report->guard = guard;
    report->fineTriangles = fine.surface.triangleCount();
  }
  tell(progress, 0.0, 1.0, 1.0);
}

scene::Mesh reduced(const scene::Mesh& fine, const Fine& prepared, std::size_t triangles, Workers& workers,
                    Report* report, const Progress& progress) {
  const std::vector<Index> partOf = partOfTriangles(fine);
  const SimplifyInput input{prepared.indices, fine.normals,     fine.texcoords,  prepared.pointOf,
                            partOf,           prepared.surface, prepared.weights};
  const Simplified simplified =
      simplify(input, triangles, [&](double part) { tell(progress, kWeighed, kSimplified, part); });
  scene::Mesh coarse = assemble(fine, partOf, simplified);
  fitCurves(prepared, FitSettings{}, workers, coarse, report, progress);
  return coarse;
}

}  // namespace

scene::Mesh coarsenMesh(const scene::Mesh& fine, const Settings& settings, Workers& workers, Report* report,
                        const Progress& progress) {
  require(settings.triangles >= 4, "at least 4 triangles");
  require(fine.indices.size() >= 3, "a mesh with triangles");
  const Fine prepared(fine, workers);
  tell(progress, 0.0, kWeighed, 1.0);
  return reduced(fine, prepared, settings.triangles, workers, report, progress);
}

std::optional<scene::Mesh> coarsenWithin(const scene::Mesh& fine, const OutlinePromise& promise,
                                         Workers& workers, Report* report, const Progress& progress) {
  require(fine.indices.size() >= 3, "a mesh with triangles");
  require(promise.pixels > 0.0 && promise.width > 0 && promise.height > 0, "a promise in pixels");
  constexpr int kSpread = 60, kByChance = 1000;
  constexpr std::uint64_t kSeed = 1;
  constexpr double kStep = 1.05;
  const Fine prepared(fine, workers);
  const std::vector<dvec3> spread = viewDirections(kSpread), byChance = viewDirections(kByChance, kSeed);
  const double most = static_cast<double>(prepared.surface.triangleCount());
  const auto keeps = [&](const scene::Mesh& small, const std::vector<dvec3>& views) {
    return brokenViews(fine, small, promise, views, workers) == 0;
  };
  const auto at = [&](double triangles) {
    return reduced(fine, prepared, std::max<std::size_t>(4, static_cast<std::size_t>(triangles)), workers,
                   report, {});
  };

  // Bracket by doubling, halve the bracket (of logarithms), then walk up until a thousand views agree.
  double low = 4.0, high = 250.0;
  while (high < most && !keeps(at(high), spread)) {
    low = high;
    high *= 2.0;
    tell(progress, 0.0, 0.5, 1.0 - 250.0 / high);
  }
  while (high > low * kStep * kStep) {
    const double middle = std::sqrt(low * high);
    (keeps(at(middle), spread) ? high : low) = middle;
    tell(progress, 0.5, 0.9, 1.0 / (1.0 + std::log(high / low)));
  }
  while (high < most) {
    scene::Mesh small = at(high);
    if (keeps(small, spread) && keeps(small, byChance)) return small;
    high *= kStep;
  }
  return std::nullopt;
}

std::vector<std::size_t> shareTriangles(const std::vector<scene::Mesh>& meshes, std::size_t triangles) {
  double all = 0.0;
  for (const scene::Mesh& mesh : meshes) all += static_cast<double>(mesh.indices.size() / 3);
  std::vector<std::size_t> shares;
  for (const scene::Mesh& mesh : meshes) {
    const std::size_t own = mesh.indices.size() / 3;
    const double share = all > 0.0 ? static_cast<double>(triangles) * static_cast<double>(own) / all : 0.0;
    shares.push_back(own == 0 ? 0 : std::max<std::size_t>(4, static_cast<std::size_t>(share)));
  }
  return shares;
}

void fitMesh(const scene::Mesh& fine, scene::Mesh& coarse, Workers& workers, Report* report,
             const Progress& progress) {
  require(fine.indices.size() >= 3 && coarse.indices.size() >= 3, "meshes with triangles");
  scene::Mesh placed;
  placed.normals = fine.normals;
  placed.indices = fine.indices;
  for (const vec3& p : fine.positions)
    placed.positions.emplace_back((fine.origin + fine.scale * dvec3(p) - coarse.origin) / coarse.scale);
  const Fine prepared(placed, workers);
  tell(progress, 0.0, kSimplified, 1.0);
  FitSettings settings;
  settings.moveCorners = false;
  fitCurves(prepared, settings, workers, coarse, report, progress);
}

}  // namespace limn::coarsen
