// Silhouette curves: the outline of the smooth shape, which crosses triangles instead of following edges.
//
// Based on: L. Wang, C. Tu, W. Wang, X. Meng, B. Chan, D. Yan, "Silhouette Smoothing for Real-Time Rendering
// of Mesh Surfaces", section III. Differs in: what contour.h, crossed_edges.h, feature_curves.h, remesh.h,
// blocking.h and ring.h say, one for each of its steps.
//
// A frame: visible vertices → crossed edges and their silhouette points → silhouette triangles and their
// segments → lowered points → vertices on edges → pieces. Every stage counts, sums and fills by blocks of
// indices, so the stream is the same for any number of threads.
//
// However wrong normals are, a new vertex is within 0.9 of its triangle's longest side of where its origin is on the flat
// one: 0.3 for the bridge, 0.3 of at most 1.6 sides for the segment, 0.09 for a polyline outside its curve.
#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "raster/base/check.h"
#include "raster/base/scratch.h"
#include "silhouette/crossed_edges.h"
#include "silhouette/curve_set.h"
#include "silhouette/edge_search.h"
#include "silhouette/method.h"
#include "silhouette/patch.h"
#include "silhouette/writer.h"

namespace limn::silhouette {
namespace {

using glm::vec2;
using glm::vec3;

constexpr std::size_t kItemsPerBlock = 4096;
constexpr std::size_t kTrianglesPerBlock = 256;
constexpr std::array<float, 3> kLinear{};  // normals: what is curved here is the outline

// The curve across a silhouette triangle, from the side that leaves the lone corner to the one that comes back.
struct Segment {
  bool exists = false;
  std::uint32_t lone = 0;
  std::array<SegmentEnd, 2> ends{};  // before they became vertices near them
  std::array<vec2, 2> weights{};
  CurveOffsets offsets{};
  std::uint32_t steps = 1;
};

// Where the pieces of a triangle begin in the stream.
struct Slot {
  std::uint32_t vertex = 0, triangle = 0;
};

struct Scratch {
  EdgeSearch search;
  std::vector<std::uint32_t> blockCounts;  // then their prefix sums
  std::vector<CrossedEdge> edges;
  std::vector<std::uint32_t> recordOf;   // per edge: index into edges, or kNone
  std::vector<std::uint32_t> triangles;  // that are replaced, ascending
  std::vector<Segment> segments;         // of the triangles with crossed edges
  std::vector<std::uint32_t> segmentOf;  // per triangle: index into segments, or kNone
  std::vector<std::uint32_t> segmentTriangles;
  std::vector<BlockingPlane> planes;
  std::vector<std::uint32_t> loweredOf;  // per vertex of the mesh: its vertex in the stream, or kNone
  std::vector<std::uint32_t> lowered;    // the vertices that have one
  std::vector<Slot> slots;               // per replaced triangle, then the end
};

// A side of a triangle as the edge record sees it.
struct SideView {
  const CrossedEdge* edge = nullptr;
  std::size_t face = 0;
  bool back = false;  // the side runs against the edge

  // A position along the edge as one along the side.
  std::size_t rank() const {
    LIMN_ASSERT(edge != nullptr);
    return back ? edge->count + 1 - edge->rank[face] : edge->rank[face];
  }
  float parameter() const { return back ? 1.0f - edge->parameter[face] : edge->parameter[face]; }
  std::uint32_t vertex(std::size_t k) const {  // k-th on the side, from 0
    const auto along = static_cast<std::uint32_t>(back ? edge->count - 1 - k : k);
    return edge->firstVertex + (edge->seam && face == 1 ? edge->count : 0) + along;
  }
};

// One view's refinement; all it refers to outlives it.
struct Pass {
  const Mesh& mesh;
  const Topology& topology;
  const CurveSet& prepared;
  const View& view;
  const Parameters& parameters;
  const Crew& crew;
  Scratch& scratch;
  RefinedStream& stream;
  RefineReport& report;
  PixelBound bound;
  StreamWriter writer;

  void run();
  void forgetRecords();
  void findEdges();
  void listReplaced(std::vector<std::uint32_t>& triangles);
  void findSegments();
  void lowerPoints();
  void lower(std::uint32_t point, const vec3& displacement);
  void placeEdges();
  void placePieces();
  void listContour();

  CrossedEdge crossedEdge(std::uint32_t e);
  Segment segmentOf(std::uint32_t triangle);
  SegmentEnd segmentEnd(const SideView& side) const;
  void addPlanes(std::uint32_t triangle, const Segment& segment);
  void emitEdge(const CrossedEdge& edge);
  void emitPieces(std::size_t k);
  void writeCentre(std::uint32_t at, std::uint32_t triangle);
  Slot sizeOf(std::uint32_t triangle) const;
  Outline outlineOf(std::uint32_t triangle) const;
  bool cutOf(std::uint32_t triangle, const Outline& outline, Cut& cut) const;

  template <class T, class Count, class Fill>
  void collect(std::size_t items, std::vector<T>& out, const Count& count, const Fill& fill);
  std::uint32_t steps(const vec3& p, const vec3& q, const CurveOffsets& offsets);
  EdgeCurve curveOf(const CrossedEdge& record) const;
  EdgeCurve bridgeOf(const CrossedEdge& record) const;
  SideView sideOf(std::uint32_t triangle, std::size_t side) const;
  std::uint32_t drawnVertex(std::uint32_t v) const {  // of a vertex of the mesh
    return scratch.loweredOf[v] == kNone ? v : firstNew() + scratch.loweredOf[v];
  }
  std::uint32_t firstNew() const { return static_cast<std::uint32_t>(mesh.positions.size()); }
};

void Pass::run() {
  const auto start = std::chrono::steady_clock::now();
  forgetRecords();
  stream.setCounts(0, 0);
  scratch.search.run(mesh, topology, prepared, view, parameters, crew);
  findEdges();
  report.classifyMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  listReplaced(scratch.segmentTriangles);
  findSegments();
  lowerPoints();
  placeEdges();
  listReplaced(scratch.triangles);
  placePieces();
  if (parameters.listContour) listContour();
}

// Those of the last refinement, which may have ended with an exception.
void Pass::forgetRecords() {
  for (const CrossedEdge& edge : scratch.edges) scratch.recordOf[edge.edge] = kNone;
  for (const std::uint32_t triangle : scratch.segmentTriangles) scratch.segmentOf[triangle] = kNone;
  for (const std::uint32_t vertex : scratch.lowered) scratch.loweredOf[vertex] = kNone;
}

// Puts fill(item)'s results into `out`, in order: count(item) of them.
template <class T, class Count, class Fill>
void Pass::collect(std::size_t items, std::vector<T>& out, const Count& count, const Fill& fill) {
  std::vector<std::uint32_t>& starts = scratch.blockCounts;
  starts.assign((items + kItemsPerBlock - 1) / kItemsPerBlock + 1, 0);
  crew.forBlocks(items, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t sum = 0;
    for (std::size_t item = begin; item < end; ++item) sum += count(item);
    starts[begin / kItemsPerBlock + 1] = sum;
  });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  out.resize(starts.back());
  crew.forBlocks(items, kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t at = starts[begin / kItemsPerBlock];
    for (std::size_t item = begin; item < end; ++item)
      if (const std::uint32_t wanted = count(item); wanted > 0) {
        fill(item, at);
        at += wanted;
      }
  });
}

// Lists the edges that have vertices of their own and marks their triangles.
void Pass::findEdges() {
  const auto wanted = [&](std::size_t e) -> std::uint32_t { return scratch.search.isListed(e) ? 1 : 0; };
  collect(prepared.links.size(), scratch.edges, wanted, [&](std::size_t e, std::uint32_t at) {
    scratch.edges[at] = crossedEdge(static_cast<std::uint32_t>(e));
    const CrossedEdge& record = scratch.edges[at];
    if (record.segments == 1 && !record.crosses[0] && !record.crosses[1]) return;
    scratch.recordOf[e] = at;
    for (const Side& face : topology.edges()[e].faces)
      if (face.triangle != kNone) markTriangle(stream.replaced, face.triangle);
  });
  report.smoothEdges = scratch.edges.size();
}

CrossedEdge Pass::crossedEdge(std::uint32_t e) {
  const EdgeVertices& v = prepared.vertices[e];
  CrossedEdge record;
  record.edge = e;
  record.alpha = scratch.search.alphas[e];
  record.seam = prepared.links[e].seam;
  for (std::size_t face = 0; face < 2; ++face) {
    record.crosses[face] = scratch.search.visible[v[face][0]] != scratch.search.visible[v[face][1]];
    if (record.crosses[face]) record.parameter[face] = scratch.search.crossings[e][face];
  }
  if (record.alpha == 0.0f) return record;
  const EdgeCurve curve = curveOf(record);
  record.segments = steps(curve.ends[0], curve.ends[1], curve.offsets);
  return record;
}

void Pass::listReplaced(std::vector<std::uint32_t>& triangles) {
  const std::vector<std::uint64_t>& words = stream.replaced;
  collect(
      words.size(), triangles,
      [&](std::size_t word) { return static_cast<std::uint32_t>(std::popcount(words[word])); },
      [&](std::size_t word, std::uint32_t at) {
        for (std::uint64_t rest = words[word]; rest != 0; rest &= rest - 1)
          triangles[at++] =
              static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(rest));
      });
}

void Pass::findSegments() {
  const std::vector<std::uint32_t>& triangles = scratch.segmentTriangles;
  scratch.segments.resize(triangles.size());
  crew.forBlocks(triangles.size(), kTrianglesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      scratch.segments[k] = segmentOf(triangles[k]);
      scratch.segmentOf[triangles[k]] = static_cast<std::uint32_t>(k);
    }
  });
}

Segment Pass::segmentOf(std::uint32_t triangle) {
  const std::uint32_t* corner = &mesh.indices[3 * std::size_t{triangle}];
  const std::array<std::uint8_t, 3> seen{scratch.search.visible[corner[0]], scratch.search.visible[corner[1]],
                                         scratch.search.visible[corner[2]]};
  Segment segment;
  if (seen[0] == seen[1] && seen[1] == seen[2]) return segment;
  segment.lone = seen[1] == seen[2] ? 0 : seen[2] == seen[0] ? 1 : 2;
  const std::array<std::uint32_t, 2> sides{segment.lone, (segment.lone + 2) % 3};
  for (std::size_t end = 0; end < 2; ++end) {
    const SideView side = sideOf(triangle, sides[end]);
    if (side.edge == nullptr || !side.edge->crosses[side.face]) return segment;
    segment.ends[end] = segmentEnd(side);
    segment.weights[end] = sideWeights(sides[end], side.parameter());
  }
  segment.exists = true;
  segment.offsets = segmentCurve(segment.ends[0], segment.ends[1], parameters.robust);
  segment.steps = steps(segment.ends[0].place, segment.ends[1].place, segment.offsets);
  return segment;
}

SegmentEnd Pass::segmentEnd(const SideView& side) const {
  const std::uint32_t e = side.edge->edge;
  const float t = side.edge->parameter[side.face];
  const std::array<std::uint32_t, 2>& v = prepared.vertices[e][side.face];
  const vec3 normal = (1.0f - t) * mesh.normals[v[0]] + t * mesh.normals[v[1]];
  const float size2 = glm::dot(normal, normal);
  const vec3 unit = size2 > 1e-12f ? normal / std::sqrt(size2)
                                   : prepared.faceNormals[topology.edges()[e].faces[side.face].triangle];
  const std::array<float, 2>& trust = prepared.trust[e];
  return {bridgeOf(*side.edge).point(t), unit, (1.0f - t) * trust[0] + t * trust[1]};
}

// Every point of a concave segment's triangle feels its plane.
void Pass::addPlanes(std::uint32_t triangle, const Segment& segment) {
  const SegmentEnd &first = segment.ends[0], &last = segment.ends[1];
  const float strength =
      std::min(first.trust, last.trust) * concavity(last.place - first.place, first.normal, last.normal);
  if (!(strength > 0.0f)) return;
  const vec3 normal = glm::normalize(first.normal + last.normal);
  const vec3 middle = curvePoint(first.place, last.place, segment.offsets, 0.5f);
  const vec2 w = 0.5f * (segment.weights[0] + segment.weights[1]);
  const std::array<float, 3> nearness{1.0f - w.x - w.y, w.x, w.y};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t point = topology.points()[mesh.indices[3 * std::size_t{triangle} + k]];
    const float weight = strength * Blocking::nearnessWeight(nearness[k]);
    if (weight > 0.0f && prepared.blocking.reach(point) > 0.0f)
      scratch.planes.push_back({point, triangle, weight, middle, normal});
  }
}

void Pass::lowerPoints() {
  scratch.planes.clear();
  scratch.lowered.clear();
  for (std::size_t k = 0; k < scratch.segments.size(); ++k)
    if (scratch.segments[k].exists) addPlanes(scratch.segmentTriangles[k], scratch.segments[k]);
  std::vector<BlockingPlane>& planes = scratch.planes;
  std::sort(planes.begin(), planes.end(), [](const BlockingPlane& a, const BlockingPlane& b) {
    return a.point != b.point ? a.point < b.point : a.triangle < b.triangle;
  });
  for (std::size_t begin = 0, end = 0; begin < planes.size(); begin = end) {
    while (end < planes.size() && planes[end].point == planes[begin].point) ++end;
    const std::uint32_t point = planes[begin].point;
    const vec3 place = mesh.positions[mesh.indices[prepared.blocking.sidesFrom(point)[0]]];
    const vec3 displacement =
        prepared.blocking.displacement(place, std::span(planes).subspan(begin, end - begin));
    if (displacement != vec3(0.0f)) lower(point, displacement);
  }
}

// Gives every vertex at a point one in the stream, and replaces its triangles.
void Pass::lower(std::uint32_t point, const vec3& displacement) {
  for (const std::uint32_t side : prepared.blocking.sidesFrom(point)) {
    const std::uint32_t vertex = mesh.indices[side];
    markTriangle(stream.replaced, side / 3);
    if (scratch.loweredOf[vertex] != kNone) continue;
    const auto at = static_cast<std::uint32_t>(scratch.lowered.size());
    scratch.lowered.push_back(vertex);
    scratch.loweredOf[vertex] = at;
    stream.setCounts(at + 1, 0);
    const Origin origin{side / 3, {side % 3 == 1 ? 1.0f : 0.0f, side % 3 == 2 ? 1.0f : 0.0f}};
    writer.vertex(at, mesh.positions[vertex] + displacement, origin, kLinear);
  }
}

// Settles where the points are, gives every edge its place in the stream and writes its vertices.
void Pass::placeEdges() {
  const float snap = kSnap * parameters.tolerance;
  crew.forBlocks(scratch.edges.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::array<std::uint32_t, 2>& ends = prepared.vertices[scratch.edges[k].edge][0];
      const std::array<bool, 2> open{scratch.loweredOf[ends[0]] == kNone,
                                     scratch.loweredOf[ends[1]] == kNone};
      settle(scratch.edges[k], curveOf(scratch.edges[k]), bridgeOf(scratch.edges[k]), open, bound, snap);
    }
  });
  StreamSize size{stream.positions.size(), 0};
  for (CrossedEdge& edge : scratch.edges) {
    edge.firstVertex = static_cast<std::uint32_t>(size.vertices);
    size.vertices += edge.vertexCount();
  }
  requireNumbered(mesh.positions.size(), size);
  stream.setCounts(size.vertices, 0);
  crew.forBlocks(scratch.edges.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) emitEdge(scratch.edges[k]);
  });
}

void Pass::emitEdge(const CrossedEdge& record) {
  const Edge& edge = topology.edges()[record.edge];
  const EdgeCurve curve = curveOf(record);
  EdgeVertexList list;
  const std::size_t count = listVertices(record, list);
  for (std::uint32_t k = 0; k < count; ++k) {
    const vec3 position = list[k].sample == 0 ? bridgeOf(record).point(list[k].t)
                                              : curve.sample(list[k].sample, record.segments);
    for (std::uint32_t face = 0; face < (record.seam ? 2u : 1u); ++face) {
      const Side& side = edge.faces[face];
      const float along = edge.runsBack(face) ? 1.0f - list[k].t : list[k].t;
      writer.vertex(record.firstVertex + face * record.count + k, position,
                    {side.triangle, sideWeights(side.side, along)}, kLinear);
    }
  }
}

void Pass::placePieces() {
  const std::vector<std::uint32_t>& triangles = scratch.triangles;
  scratch.slots.resize(triangles.size() + 1);
  StreamSize size{stream.positions.size(), 0};
  scratch.slots[0] = {static_cast<std::uint32_t>(size.vertices), 0};
  crew.forBlocks(triangles.size(), kTrianglesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) scratch.slots[k + 1] = sizeOf(triangles[k]);
  });
  for (Slot& slot : std::span(scratch.slots).subspan(1)) {
    size.vertices += slot.vertex;
    size.triangles += slot.triangle;
    slot = {static_cast<std::uint32_t>(size.vertices), static_cast<std::uint32_t>(size.triangles)};
  }
  requireNumbered(mesh.positions.size(), size);
  stream.setCounts(size.vertices, size.triangles);
  report.curvedTriangles = triangles.size();
  crew.forBlocks(triangles.size(), kTrianglesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) emitPieces(k);
  });
}

// Vertices and triangles that a triangle adds to the stream.
Slot Pass::sizeOf(std::uint32_t triangle) const {
  Outline outline;
  std::uint32_t onSides = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const SideView side = sideOf(triangle, k);
    outline.counts[k] = side.edge != nullptr ? side.edge->count : 0;
    onSides += static_cast<std::uint32_t>(outline.counts[k]);
  }
  Cut cut;
  if (cutOf(triangle, outline, cut)) {
    const std::uint32_t samples = scratch.segments[scratch.segmentOf[triangle]].steps - 1;
    return {samples, 1 + onSides + 2 * samples};
  }
  return outline.wantsCentre() ? Slot{1, 3 + onSides} : Slot{0, 1 + onSides};
}

// Whether the triangle has a segment, and where it ends on the sides.
bool Pass::cutOf(std::uint32_t triangle, const Outline& outline, Cut& cut) const {
  const std::uint32_t index = scratch.segmentOf[triangle];
  if (index == kNone || !scratch.segments[index].exists) return false;
  const std::size_t lone = scratch.segments[index].lone, back = (lone + 2) % 3;
  cut.lone = lone;
  cut.ends = {sideOf(triangle, lone).rank(), sideOf(triangle, back).rank()};
  return cut.ends[0] != 0 || cut.ends[1] != outline.counts[back] + 1;
}

Outline Pass::outlineOf(std::uint32_t triangle) const {
  Outline outline;
  for (std::size_t k = 0; k < 3; ++k) {
    outline.corners[k] = drawnVertex(mesh.indices[3 * std::size_t{triangle} + k]);
    const SideView side = sideOf(triangle, k);
    outline.counts[k] = side.edge != nullptr ? side.edge->count : 0;
    for (std::size_t i = 0; i < outline.counts[k]; ++i) outline.sides[k][i] = firstNew() + side.vertex(i);
  }
  return outline;
}

void Pass::emitPieces(std::size_t k) {
  const std::uint32_t triangle = scratch.triangles[k];
  const Slot& slot = scratch.slots[k];
  Outline outline = outlineOf(triangle);
  Pieces pieces;
  Cut cut;
  if (cutOf(triangle, outline, cut)) {
    const Segment& segment = scratch.segments[scratch.segmentOf[triangle]];
    std::array<std::uint32_t, kMaxSegments> samples;
    for (std::uint32_t i = 1; i < segment.steps; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(segment.steps);
      const std::uint32_t at = slot.vertex + i - 1;
      samples[i - 1] = firstNew() + at;
      writer.vertex(at,
                    polylineVertex(segment.ends[0].place, segment.ends[1].place, segment.offsets,
                                   static_cast<int>(i), static_cast<int>(segment.steps)),
                    {triangle, (1.0f - t) * segment.weights[0] + t * segment.weights[1]}, kLinear);
    }
    cut.samples = std::span(samples).first(segment.steps - 1);
    remesh(outline, cut, bound, {mesh.positions, stream.positions}, pieces);
  } else {
    if (outline.wantsCentre()) {
      outline.centre = firstNew() + slot.vertex;
      writeCentre(slot.vertex, triangle);
    }
    remesh(outline, pieces);
  }
  LIMN_ASSERT(slot.triangle + pieces.count == scratch.slots[k + 1].triangle, triangle, pieces.count);
  for (std::size_t i = 0; i < pieces.count; ++i) {
    const std::size_t at = slot.triangle + i;
    std::copy(pieces.triangles[i].begin(), pieces.triangles[i].end(),
              stream.indices.begin() + static_cast<std::ptrdiff_t>(3 * at));
    stream.sourceTriangles[at] = triangle;
  }
}

// The middle of the patch that the curves of the sides make.
void Pass::writeCentre(std::uint32_t at, std::uint32_t triangle) {
  constexpr float third = 1.0f / 3.0f;
  Patch patch;
  for (std::size_t k = 0; k < 3; ++k) {
    patch.corners[k] = mesh.positions[mesh.indices[3 * std::size_t{triangle} + k]];
    const SideView side = sideOf(triangle, k);
    if (side.edge == nullptr || side.edge->segments == 1) continue;
    const CurveOffsets offsets = curveOf(*side.edge).offsets;
    patch.sides[k] = {offsets[side.back ? 1 : 0], offsets[side.back ? 0 : 1]};
  }
  writer.vertex(at, patch.point(third, third, third), {triangle, {third, third}}, kLinear);
}

// Bridges in the order of their edges, then segments in that of their triangles.
void Pass::listContour() {
  std::uint32_t last = 0;
  const auto lineTo = [&](std::uint32_t vertex, bool crossesTriangle) {
    if (vertex != last) stream.contour.push_back({last, vertex, crossesTriangle});
    last = vertex;
  };
  for (const CrossedEdge& edge : scratch.edges) {
    if (!edge.crosses[0] && !edge.crosses[1]) continue;
    const std::array<std::uint32_t, 2>& ends = prepared.vertices[edge.edge][0];
    last = drawnVertex(ends[0]);
    for (std::uint32_t k = 0; k < edge.count; ++k) lineTo(firstNew() + edge.firstVertex + k, false);
    lineTo(drawnVertex(ends[1]), false);
  }
  for (std::size_t k = 0; k < scratch.triangles.size(); ++k) {
    const Outline outline = outlineOf(scratch.triangles[k]);
    Cut cut;
    if (!cutOf(scratch.triangles[k], outline, cut)) continue;
    last = outline.onSide(cut.lone, cut.ends[0]);
    for (std::uint32_t v = scratch.slots[k].vertex; v < scratch.slots[k + 1].vertex; ++v)
      lineTo(firstNew() + v, true);
    lineTo(outline.onSide((cut.lone + 2) % 3, cut.ends[1]), true);
  }
}

// Steps of a polyline with its inner vertices outside the curve (contour.h) that stays within the tolerance.
std::uint32_t Pass::steps(const vec3& p, const vec3& q, const CurveOffsets& offsets) {
  if (parameters.segments > 0) return static_cast<std::uint32_t>(parameters.segments);
  bool capped = false;
  const auto count = static_cast<std::uint32_t>(
      polylineSteps(bound.curveError(p, q, offsets).bend, parameters.tolerance, capped));
  if (capped) std::atomic_ref<std::size_t>(report.cappedEdges).fetch_add(1, std::memory_order_relaxed);
  return count;
}

// The curve that silhouette points lie on.
EdgeCurve Pass::bridgeOf(const CrossedEdge& record) const {
  const std::array<std::uint32_t, 2>& ends = prepared.vertices[record.edge][0];
  return {{mesh.positions[ends[0]], mesh.positions[ends[1]]}, prepared.curves[record.edge]};
}

// The curve that is sampled.
EdgeCurve Pass::curveOf(const CrossedEdge& record) const {
  const std::array<std::uint32_t, 2>& ends = prepared.vertices[record.edge][0];
  const CurveOffsets& offsets = prepared.curves[record.edge];
  return {{mesh.positions[ends[0]], mesh.positions[ends[1]]},
          {record.alpha * offsets[0], record.alpha * offsets[1]}};
}

SideView Pass::sideOf(std::uint32_t triangle, std::size_t side) const {
  const std::uint32_t e = topology.sideEdges()[3 * std::size_t{triangle} + side];
  const std::uint32_t record = e == kNone ? kNone : scratch.recordOf[e];
  if (record == kNone) return {};
  const Edge& edge = topology.edges()[e];
  const std::size_t face = edge.faces[1].triangle == triangle && edge.faces[1].side == side ? 1 : 0;
  return {&scratch.edges[record], face, edge.runsBack(face)};
}

class SilhouetteCurves final : public MethodState {
 public:
  explicit SilhouetteCurves(const Source& source)
      : mesh_(source.mesh), topology_(*source.topology), scratch_(static_cast<std::size_t>(source.threads)) {}

  void deform(const Mesh& mesh) override {
    mesh_ = mesh;
    isPrepared_ = false;
  }

  void prepare(const Parameters& parameters, const Crew& crew) override {
    const Style style{parameters.robust, parameters.features, parameters.boundaries};
    if (isPrepared_ && style == style_) return;
    prepared_.prepare(mesh_, topology_, parameters, crew);
    style_ = style;
    isPrepared_ = true;
  }

  void refine(const View& view, const Parameters& parameters, const Crew& crew, RefinedStream& stream,
              RefineReport& report) override {
    Scratch& scratch = scratch_[crew.slot()];
    if (scratch.recordOf.empty()) {
      scratch.recordOf.assign(topology_.edges().size(), kNone);
      scratch.segmentOf.assign(mesh_.triangleCount(), kNone);
      scratch.loweredOf.assign(mesh_.positions.size(), kNone);
    }
    Pass pass{mesh_,
              topology_,
              prepared_,
              view,
              parameters,
              crew,
              scratch,
              stream,
              report,
              PixelBound(view),
              StreamWriter(mesh_, parameters.shadingNormals, stream)};
    pass.run();
  }

  void levelScratch() override {
    levelCapacity(scratch_, &Scratch::blockCounts, &Scratch::edges, &Scratch::recordOf, &Scratch::triangles,
                  &Scratch::segments, &Scratch::segmentOf, &Scratch::segmentTriangles, &Scratch::planes,
                  &Scratch::loweredOf, &Scratch::lowered, &Scratch::slots);
    const auto searched = [](auto EdgeSearch::*vector) {
      return [vector](Scratch & slot) -> auto& {
        return slot.search.*vector;
      };
    };
    levelCapacity(scratch_, searched(&EdgeSearch::heights), searched(&EdgeSearch::visible),
                  searched(&EdgeSearch::planeHeights), searched(&EdgeSearch::states),
                  searched(&EdgeSearch::crossings), searched(&EdgeSearch::alphas));
  }

 private:
  struct Style {
    bool robust = false, features = false, boundaries = false;
    bool operator==(const Style&) const = default;
  };

  Mesh mesh_;
  const Topology& topology_;
  std::vector<Scratch> scratch_;
  CurveSet prepared_;
  Style style_;
  bool isPrepared_ = false;
};

}  // namespace

std::unique_ptr<MethodState> makeSilhouetteCurves(const Source& source) {
  return std::make_unique<SilhouetteCurves>(source);
}

}  // namespace limn::silhouette
