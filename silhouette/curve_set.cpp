#include "silhouette/curve_set.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "silhouette/face_normal.h"
#include "silhouette/feature_curves.h"
#include "silhouette/pixel_bound.h"
#include "silhouette/view_scale.h"

namespace limn::silhouette {
namespace {

constexpr std::size_t kItemsPerBlock = 4096;
constexpr float kFacingNone = -0.5f;  // of a face's normal and the mean of those at an edge: their product
constexpr float kFacingFull = -0.2f;

// Upper bound of CurveError::bend where a unit measures a pixel.
float bendOf(const CurveOffsets& d) {
  const float longest = std::max(glm::length(d[1] - 2.0f * d[0]), glm::length(d[0] - 2.0f * d[1]));
  return kRounding * PixelMap::kChordFactor * longest;
}

}  // namespace

void CurveSet::prepare(const Mesh& mesh, const Topology& topology, const FittedCurves& fitted,
                       const Parameters& parameters, const Crew& crew) {
  const std::size_t edges = topology.edges().size();
  if (fitted.empty()) {
    computeEdgeCurves(mesh, topology, {Tangents::kGeodesicArc, false}, crew, robust_, curves);
    if (parameters.robust) robust_.prepare(mesh, topology, crew);
    computeFeatureCurves(mesh, topology, crew, curves);
  } else {
    placeFittedCurves(mesh, topology, fitted, crew, curves, centers);
  }
  computeFaceNormals(mesh, topology, crew, faceNormals);
  vertices.resize(edges);
  links.resize(edges);
  ownTrust_.resize(edges);
  blocking.prepare(mesh, topology);  // trustAround() asks it for the sides at a point
  crew.forBlocks(edges, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) linkEdge(e, mesh, topology, parameters);
  });
  trustBridges(topology, crew);
  runs.resize((edges + EdgeRun::kEdges - 1) / EdgeRun::kEdges);
  crew.forBlocks(runs.size(), kItemsPerBlock / EdgeRun::kEdges, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) boundRun(r, mesh);
  });
  spread(mesh, crew);
}

void CurveSet::dropScaffold() {
  robust_ = {};
  ownTrust_ = {};
  pointTrust_ = {};
}

// 0 to 1: whether one of an edge's faces at least faces the way that the normals at the edge's ends say. What lies in front of
// a contour and what behind it, and whether it is concave, are questions to the normals; where all faces answer otherwise the
// mesh stays flat.
float CurveSet::facingOf(std::size_t e, const Mesh& mesh, const Edge& edge) const {
  float most = -1.0f;
  for (std::size_t face = 0; face < (edge.boundary ? 1u : 2u); ++face) {
    const glm::vec3 normals = mesh.normals[vertices[e][face][0]] + mesh.normals[vertices[e][face][1]];
    most = std::max(most, glm::dot(normals, faceNormals[edge.faces[face].triangle]));
  }
  return smoothStep(kFacingNone, kFacingFull, 0.5f * most);
}

void CurveSet::linkEdge(std::size_t e, const Mesh& mesh, const Topology& topology,
                        const Parameters& parameters) {
  const Edge& edge = topology.edges()[e];
  vertices[e] = edgeVertices(mesh, edge);
  if ((edge.isFeature() && !parameters.features) || (edge.boundary && !parameters.boundaries)) curves[e] = {};
  ownTrust_[e] = {1.0f, 1.0f};
  if (centers.empty() && parameters.robust && !edge.isFeature() && !edge.nonManifold) {
    ownTrust_[e] = robust_.factors(edge);
    const float facing = facingOf(e, mesh, edge);
    for (std::size_t k = 0; k < 2; ++k) {
      ownTrust_[e][k] *= facing;
      curves[e][k] *= ownTrust_[e][k];
    }
  }
  const bool bends = curves[e] != CurveOffsets{}, smooth = !edge.isFeature() && !edge.boundary;
  const std::uint32_t face = edge.faces[0].triangle;
  EdgeLink& link = links[e];
  link.faces = {face, edge.boundary ? face : edge.faces[1].triangle};
  link.ends = vertices[e][0];
  link.always = bends && !smooth;
  link.bend = bends && smooth ? bendOf(curves[e]) : 0.0f;
  link.seam = vertices[e][0] != vertices[e][1];
}

void CurveSet::trustBridges(const Topology& topology, const Crew& crew) {
  pointTrust_.resize(topology.pointCount());
  crew.forBlocks(pointTrust_.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) pointTrust_[p] = trustAround(p, topology);
  });
  trust.resize(links.size());
  crew.forBlocks(links.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Edge& edge = topology.edges()[e];
      trust[e] = {{pointTrust_[edge.point[0]], pointTrust_[edge.point[1]]},
                  0.5f * (ownTrust_[e][0] + ownTrust_[e][1])};
    }
  });
  crew.forBlocks(links.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      links[e].bridged = !topology.edges()[e].nonManifold && isBelievedAround(e, topology);
  });
}

// Whether a side of the triangles at an edge is believed somewhere: then their segments, which end on this edge, too, come and
// go with the contour. Where nothing is, the mesh stays as it is, to the last bit.
bool CurveSet::isBelievedAround(std::size_t e, const Topology& topology) const {
  for (const std::uint32_t face : links[e].faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t side = topology.sideEdges()[3 * std::size_t{face} + k];
      if (side != kNone && !trust[side].isNone()) return true;
    }
  return false;
}

// The mean over the edges at a point that may be doubted, boundaries counting half; 1 where none may.
float CurveSet::trustAround(std::size_t point, const Topology& topology) const {
  float sum = 0.0f;
  int count = 0;
  // Each edge comes twice, as a side that leaves the point and as one that comes back; on a boundary once.
  const auto add = [&](std::size_t side) {
    const std::uint32_t e = topology.sideEdges()[side];
    if (e == kNone) return;
    const Edge& edge = topology.edges()[e];
    if (edge.isFeature() || edge.nonManifold) return;
    sum += ownTrust_[e][edge.point[0] == point ? 0 : 1];
    ++count;
  };
  for (const std::uint32_t side : blocking.sidesFrom(static_cast<std::uint32_t>(point))) {
    add(side);
    add(side % 3 == 0 ? side + 2 : side - 1);
  }
  return count > 0 ? sum / static_cast<float>(count) : 1.0f;
}

void CurveSet::boundRun(std::size_t r, const Mesh& mesh) {
  const std::size_t first = firstOfRun(r), last = firstOfRun(r + 1);
  EdgeRun& run = runs[r] = {};
  glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low), sum(0.0f);
  const auto forEnds = [&](std::size_t e, const auto& visit) {
    for (std::size_t face = 0; face < (links[e].seam ? 2u : 1u); ++face)
      for (const std::uint32_t v : vertices[e][face]) visit(v);
  };
  for (std::size_t e = first; e < last; ++e) {
    forEnds(e, [&](std::uint32_t v) {
      low = glm::min(low, mesh.positions[v]);
      high = glm::max(high, mesh.positions[v]);
      sum += mesh.normals[v];
    });
    run.bend = std::max(run.bend, links[e].bend);
    run.always = run.always || links[e].always;
  }
  run.cone.begin(low, high, sum);
  for (std::size_t e = first; e < last; ++e) {
    forEnds(e, [&](std::uint32_t v) { run.cone.include(mesh.normals[v]); });
    for (const std::uint32_t face : links[e].faces) run.cone.include(faceNormals[face]);
  }
  run.cone.finish();
}

void CurveSet::spread(const Mesh& mesh, const Crew& crew) {
  corners.resize(mesh.positions.size());
  planes.resize(mesh.triangleCount());
  crew.forBlocks(mesh.positions.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) corners.set(v, mesh.positions[v], mesh.normals[v]);
  });
  crew.forBlocks(mesh.triangleCount(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      planes.set(t, mesh.positions[mesh.indices[3 * t]], faceNormals[t]);
  });
  glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
  for (const glm::vec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  middle = mesh.positions.empty() ? glm::vec3(0.0f) : 0.5f * (low + high);
  largestBend = 0.0f;
  for (const EdgeLink& link : links) largestBend = std::max(largestBend, link.bend);
  float farthest2 = 0.0f;
  for (const glm::vec3& p : mesh.positions) farthest2 = std::max(farthest2, glm::dot(p - middle, p - middle));
  // An offset is at most as long as the longer second difference.
  radius = kRounding * std::sqrt(farthest2) + 2.0f * largestBend;
}

}  // namespace limn::silhouette
