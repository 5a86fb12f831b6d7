// View-dependent blended Bézier patches: flat away from the silhouette, smooth at it, continuous in the
// viewpoint.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004.
// Differs in: segment counts come from a tolerance in pixels that holds under perspective (pixel_bound.h). The inside of
// a patch is refined to the same tolerance where the paper draws a fan: a fan's chords from the corners to the midpoint
// are straight and limit the outline (pattern.h; the fan is what is left where that suffices). A triangle that stays
// within the tolerance of the flat one is passed through as flat.
//
// Every edge has one record with its α, curve and segments, from which both its triangles take the same
// points.
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <numeric>

#include "raster/base/check.h"
#include "raster/base/scratch.h"
#include "silhouette/bare_test.h"
#include "silhouette/chord_kernel.h"
#include "silhouette/edge_clusters.h"
#include "silhouette/edge_curves.h"
#include "silhouette/method.h"
#include "silhouette/patch.h"
#include "silhouette/pattern.h"
#include "silhouette/pixel_bound.h"
#include "silhouette/silhouetteness.h"
#include "silhouette/smooth_edge.h"
#include "silhouette/writer.h"

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec3;

constexpr std::size_t kClustersPerBlock = 64;
// Inside a fitted patch the grid is this many times coarser than the tolerance of its sides: 500-triangle models keep 76.4 % of
// 78.7 % of their outlines' gain with 4,000 instead of 6,300 triangles.
constexpr float kFittedInside = 3.0f;
constexpr std::size_t kEdgesPerBlock = 4096;
constexpr std::size_t kWordsPerBlock = 64;  // of 64 triangles each

// What a block of triangles adds to the stream.
struct Share {
  std::size_t curved = 0;
  StreamSize size;

  Share& operator+=(const Share& other) {
    curved += other.curved;
    size.vertices += other.size.vertices;
    size.triangles += other.size.triangles;
    return *this;
  }
};

struct Scratch {
  std::vector<std::uint32_t> blockCounts;  // smooth edges per block of clusters, then their prefix sums
  std::vector<std::uint64_t> masks;        // per cluster: the edges that bend
  std::vector<float> alphas;               // per place in the clusters' order, where an edge bends
  std::vector<float> scales;               // per cluster, where an edge bends
  std::vector<SmoothEdge> smooth;          // the first stands for all edges that do not bend
  std::vector<std::uint32_t> recordOf;     // per edge: index into smooth
  std::vector<std::uint64_t> candidates;   // bit per triangle: has a smooth edge
  std::vector<std::uint32_t> firstCut;     // per word of candidates: index into cuts, and their number
  std::vector<Pattern> cuts;               // per candidate, in order
  std::vector<Share> shares;               // per block of triangles, then prefix sums
};

// One view's refinement; all it refers to outlives it.
struct Pass {
  const Mesh& mesh;
  const Topology& topology;
  const EdgeTest& test;
  const EdgeClusters& clusters;
  const std::vector<CurveOffsets>& curves;
  const std::vector<vec3>& centers;  // of fitted patches; empty without
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
  void classify();
  void measureEdges();
  void describe(std::size_t cluster, std::uint32_t record, CurveBatch& batch);
  void setSegments(const CurveBatch& batch, std::uint32_t record);
  void listCandidates();
  Share decide(std::size_t word);
  void place();
  void emit();
  void emitEdge(const SmoothEdge& smooth);
  void emitTriangle(std::uint32_t triangle, const Pattern& pattern, std::uint32_t& vertex,
                    std::uint32_t& face);

  Records recordsOf(std::size_t triangle) const {
    const std::uint32_t* edge = &topology.sideEdges()[3 * triangle];
    const SmoothEdge* smooth = scratch.smooth.data();
    return {smooth + scratch.recordOf[edge[0]], smooth + scratch.recordOf[edge[1]],
            smooth + scratch.recordOf[edge[2]]};
  }
  Patch patchOf(std::size_t triangle, const Records& records) const;
  struct BentTriangle {
    std::array<BentSide, 3> sides;
    float scale = 0;  // pixels that a unit of the model measures at most near it
    vec3 fittedCenter{0.0f};
    bool wholeFromContour = false;
  };
  BentTriangle bentTriangleOf(std::size_t triangle, const Records& records) const;
  bool passesBare(std::size_t triangle, const BentTriangle& bent, std::uint32_t divided) const;
  bool isWithin(float limit, const vec3& apart, float scale, std::size_t triangle,
                const std::array<float, 3>& weights) const;
  float distanceAt(std::size_t triangle, const std::array<float, 3>& weights, const vec3& apart) const;
  Pattern patternOf(std::size_t triangle, const Records& records) const;
  std::uint32_t gridSteps(std::size_t triangle, const BentTriangle& bent) const;
  SidePoints sidePointsOf(std::uint32_t side, const SmoothEdge& smooth) const;
  void emitBare(std::uint32_t triangle, const Records& records, const Pattern& pattern, std::uint32_t& face);
};

void Pass::run() {
  const auto start = std::chrono::steady_clock::now();
  forgetRecords();
  classify();
  report.classifyMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  measureEdges();
  listCandidates();
  place();
  emit();
}

// Those of the last refinement, which may have ended with an exception.
void Pass::forgetRecords() {
  for (const SmoothEdge& smooth : scratch.smooth)
    if (smooth.bends()) scratch.recordOf[smooth.edge] = 0;
}

// Lists the edges that bend visibly, in the order of the clusters, and marks their triangles as candidates.
void Pass::classify() {
  const std::size_t count = clusters.count(), blocks = (count + kClustersPerBlock - 1) / kClustersPerBlock;
  scratch.blockCounts.assign(blocks + 1, 0);
  scratch.blockCounts[0] = 1;
  scratch.masks.resize(count);
  scratch.alphas.resize(count * kEdgesPerCluster);
  scratch.scales.resize(count);
  const EdgeClusters::Eye eye = clusters.eyeOf(view, parameters);
  crew.forBlocks(count, kClustersPerBlock, [&](std::size_t begin, std::size_t end) {
    int bending = 0;
    for (std::size_t c = begin; c < end; ++c) {
      const std::span<float> alphas =
          std::span(scratch.alphas).subspan(c * kEdgesPerCluster, kEdgesPerCluster);
      scratch.masks[c] = clusters.classify(c, eye, test, alphas, scratch.scales[c]);
      bending += std::popcount(scratch.masks[c]);
    }
    scratch.blockCounts[begin / kClustersPerBlock + 1] = static_cast<std::uint32_t>(bending);
  });
  std::partial_sum(scratch.blockCounts.begin(), scratch.blockCounts.end(), scratch.blockCounts.begin());
  scratch.smooth.resize(scratch.blockCounts[blocks]);
  scratch.smooth[0] = {};
  report.smoothEdges = scratch.smooth.size() - 1;
}

// Their curves and segments.
void Pass::measureEdges() {
  scratch.candidates.assign(stream.replaced.size(), 0);
  crew.forBlocks(clusters.count(), kClustersPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t record = scratch.blockCounts[begin / kClustersPerBlock];
    CurveBatch batch{};
    for (std::size_t c = begin; c < end; ++c) {
      if (scratch.masks[c] == 0) continue;
      batch.count = 0;
      describe(c, record, batch);
      setSegments(batch, record);
      record += static_cast<std::uint32_t>(batch.count);
    }
  });
}

// The records of a cluster's edges, and their curves one after the other.
void Pass::describe(std::size_t cluster, std::uint32_t record, CurveBatch& batch) {
  const bool alone = crew.isAlone();
  for (std::uint64_t rest = scratch.masks[cluster]; rest != 0; rest &= rest - 1, ++record) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    const std::size_t place = cluster * kEdgesPerCluster + i;
    SmoothEdge& smooth = scratch.smooth[record];
    smooth.edge = clusters.edgeAt(place);
    smooth.alpha = scratch.alphas[place];
    smooth.inverse = 1.0f / smooth.alpha;
    smooth.scale = scratch.scales[cluster];
    smooth.seam = (clusters.seams(cluster) >> i & 1) != 0;
    const CurveOffsets& d = curves[smooth.edge];
    smooth.offsets = {smooth.alpha * d[0], smooth.alpha * d[1]};
    smooth.ends = clusters.endsAt(place);
    batch.add(mesh.positions[smooth.ends[0]], mesh.positions[smooth.ends[1]], smooth.offsets);
    scratch.recordOf[smooth.edge] = record;
    const Edge& edge = topology.edges()[smooth.edge];
    smooth.firstSide = 3 * edge.faces[0].triangle + edge.faces[0].side;
    smooth.descending = edge.descending;
    for (const Side& face : edge.faces) {
      if (face.triangle == kNone) continue;
      if (alone)
        scratch.candidates[face.triangle / 64] |= std::uint64_t{1} << (face.triangle % 64);
      else
        markTriangle(scratch.candidates, face.triangle);
    }
  }
}

void Pass::setSegments(const CurveBatch& batch, std::uint32_t record) {
  CurveErrors errors;
  if (parameters.segments == 0) curveErrors(bound, batch, errors);
  std::size_t cappedEdges = 0;
  for (std::size_t i = 0; i < batch.count; ++i) {
    bool capped = false;
    const int segments =
        parameters.segments > 0 ? parameters.segments : segmentsFor(errors[i], parameters.tolerance, capped);
    scratch.smooth[record + i].segments = static_cast<std::uint32_t>(segments);
    if (capped) ++cappedEdges;
  }
  if (cappedEdges > 0)
    std::atomic_ref<std::size_t>(report.cappedEdges).fetch_add(cappedEdges, std::memory_order_relaxed);
}

Patch Pass::patchOf(std::size_t triangle, const Records& records) const {
  Patch patch;
  patch.wholeFromContour = parameters.silhouetteness == Silhouetteness::kCrossing;
  const auto side = static_cast<std::uint32_t>(3 * triangle);
  for (std::uint32_t k = 0; k < 3; ++k) {
    patch.corners[k] = mesh.positions[mesh.indices[side + k]];
    patch.alphas[k] = records[k]->alpha;
    if (!records[k]->bends()) continue;
    const bool back = records[k]->runsBack(side + k);
    const CurveOffsets& d = curves[records[k]->edge];
    patch.sides[k] = {d[back ? 1 : 0], d[back ? 0 : 1]};
  }
  if (!centers.empty()) patch.fittedCenter = centers[triangle];
  return patch;
}

Pass::BentTriangle Pass::bentTriangleOf(std::size_t triangle, const Records& records) const {
  BentTriangle bent;
  const auto first = static_cast<std::uint32_t>(3 * triangle);
  for (std::uint32_t k = 0; k < 3; ++k) {
    const SmoothEdge& smooth = *records[k];
    const std::size_t start = smooth.runsBack(first + k) ? 1 : 0;
    bent.sides[k] = {{smooth.offsets[start], smooth.offsets[1 - start]}, smooth.alpha, smooth.inverse};
    bent.scale = std::max(bent.scale, smooth.scale);
  }
  if (!centers.empty()) bent.fittedCenter = centers[triangle];
  bent.wholeFromContour = parameters.silhouetteness == Silhouetteness::kCrossing;
  return bent;
}

// Whether two points over a place of the triangle are within so many pixels. Most often a bound of them all tells.
bool Pass::isWithin(float limit, const vec3& apart, float scale, std::size_t triangle,
                    const std::array<float, 3>& weights) const {
  if (dot(apart, apart) * (scale * scale) <= limit * limit) return true;
  return distanceAt(triangle, weights, apart) <= limit;
}

float Pass::distanceAt(std::size_t triangle, const std::array<float, 3>& weights, const vec3& apart) const {
  const std::uint32_t* corner = &mesh.indices[3 * triangle];
  const vec3 place = weights[0] * mesh.positions[corner[0]] + weights[1] * mesh.positions[corner[1]] +
                     weights[2] * mesh.positions[corner[2]];
  return bound.distance(place, place + apart);
}

bool Pass::passesBare(std::size_t triangle, const BentTriangle& bent, std::uint32_t divided) const {
  const std::array<vec3, BareTest::kPlaces> apart =
      BareTest::differences(divided, bent.sides, bent.wholeFromContour, bent.fittedCenter);
  for (std::size_t i = 0; i < BareTest::kPlaces; ++i)
    if (!isWithin(parameters.tolerance, apart[i], bent.scale, triangle, BareTest::weights(divided, i)))
      return false;
  return true;
}

// The steps of the grid inside follow the largest error of the spokes from the corners to the midpoint, by its size at
// their middles: a spoke of an equilateral triangle is 1/√3 of a side, so its error is a third of what a side's would be.
std::uint32_t Pass::gridSteps(std::size_t triangle, const BentTriangle& bent) const {
  constexpr std::uint32_t kLeast = 3;
  const float tolerance = parameters.tolerance * (centers.empty() ? 1.0f : kFittedInside);
  const std::array<vec3, 3> beyond =
      BareTest::beyondSpokes(bent.sides, bent.wholeFromContour, bent.fittedCenter);
  bool suffices = true;  // most often the least number does
  float largest = 0.0f;
  for (std::size_t k = 0; k < 3; ++k)
    suffices = suffices && isWithin(kLeast * kLeast * tolerance / 3.0f, beyond[k], bent.scale, triangle,
                                    BareTest::spokeWeights(k));
  if (suffices) return kLeast;
  for (std::size_t k = 0; k < 3; ++k)
    largest = std::max(largest, distanceAt(triangle, BareTest::spokeWeights(k), beyond[k]));
  bool capped = false;  // the cap of the sides is what is reported
  return static_cast<std::uint32_t>(segmentsFor({3.0f * largest, 3.0f * largest}, tolerance, capped));
}

Pattern Pass::patternOf(std::size_t triangle, const Records& records) const {
  Pattern pattern{{records[0]->segments, records[1]->segments, records[2]->segments}, 1};
  const std::uint32_t most = std::max({pattern.sides[0], pattern.sides[1], pattern.sides[2]});
  pattern.steps = most;
  if (parameters.segments > 0) return pattern;
  const std::uint32_t divided =
      (pattern.sides[0] > 1 ? 1u : 0u) | (pattern.sides[1] > 1 ? 2u : 0u) | (pattern.sides[2] > 1 ? 4u : 0u);
  const BentTriangle bent = bentTriangleOf(triangle, records);
  pattern.steps = (most <= 2 || divided != 7) && passesBare(triangle, bent, divided)
                      ? std::min(most, 2u)
                      : gridSteps(triangle, bent);
  return pattern;
}

// Numbers the candidates.
void Pass::listCandidates() {
  const std::size_t words = scratch.candidates.size();
  scratch.firstCut.resize(words + 1);
  std::uint32_t count = 0;
  for (std::size_t word = 0; word < words; ++word) {
    scratch.firstCut[word] = count;
    count += static_cast<std::uint32_t>(std::popcount(scratch.candidates[word]));
  }
  scratch.firstCut[words] = count;
  scratch.cuts.resize(count);
}

// Which of a word's candidates are curved.
Share Pass::decide(std::size_t word) {
  Share share;
  std::uint32_t next = scratch.firstCut[word];
  for (std::uint64_t rest = scratch.candidates[word]; rest != 0; rest &= rest - 1) {
    const std::size_t triangle = 64 * word + static_cast<std::size_t>(std::countr_zero(rest));
    const Pattern& pattern = scratch.cuts[next++] = patternOf(triangle, recordsOf(triangle));
    if (pattern.steps == 1) continue;
    stream.replaced[word] |= std::uint64_t{1} << (triangle % 64);
    ++share.curved;
    share.size.vertices += pattern.vertexCount();
    share.size.triangles += pattern.triangleCount();
  }
  return share;
}

// Gives every edge and every block of triangles its place in the stream.
void Pass::place() {
  const std::size_t words = stream.replaced.size(), blocks = (words + kWordsPerBlock - 1) / kWordsPerBlock;
  scratch.shares.assign(blocks + 1, {});
  for (SmoothEdge& smooth : scratch.smooth) {  // the first has no vertices
    smooth.firstVertex = static_cast<std::uint32_t>(scratch.shares[0].size.vertices);
    scratch.shares[0].size.vertices += smooth.vertexCount();
  }
  crew.forBlocks(words, kWordsPerBlock, [&](std::size_t begin, std::size_t end) {
    Share& sum = scratch.shares[begin / kWordsPerBlock + 1];
    for (std::size_t word = begin; word < end; ++word) sum += decide(word);
  });
  for (std::size_t block = 1; block <= blocks; ++block) scratch.shares[block] += scratch.shares[block - 1];
  const Share& all = scratch.shares[blocks];
  requireNumbered(mesh.positions.size(), all.size);
  report.curvedTriangles = all.curved;
  stream.setCounts(all.size.vertices, all.size.triangles);
}

void Pass::emit() {
  const std::span<const SmoothEdge> bending = std::span(scratch.smooth).subspan(1);
  crew.forBlocks(bending.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (const SmoothEdge& smooth : bending.subspan(begin, end - begin)) emitEdge(smooth);
  });
  crew.forBlocks(stream.replaced.size(), kWordsPerBlock, [&](std::size_t begin, std::size_t end) {
    const StreamSize& before = scratch.shares[begin / kWordsPerBlock].size;
    auto vertex = static_cast<std::uint32_t>(before.vertices);
    auto face = static_cast<std::uint32_t>(before.triangles);
    for (std::size_t word = begin; word < end; ++word) {
      std::uint32_t next = scratch.firstCut[word];
      for (std::uint64_t rest = scratch.candidates[word]; rest != 0; rest &= rest - 1, ++next)
        if ((stream.replaced[word] & rest & (~rest + 1)) != 0)
          emitTriangle(
              static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(rest)),
              scratch.cuts[next], vertex, face);
    }
  });
}

void Pass::emitEdge(const SmoothEdge& smooth) {
  const Edge& edge = topology.edges()[smooth.edge];
  const vec3 &p = mesh.positions[smooth.ends[0]], &q = mesh.positions[smooth.ends[1]];
  for (std::uint32_t k = 1; k < smooth.segments; ++k) {
    const float t = static_cast<float>(k) / static_cast<float>(smooth.segments);
    const vec3 position = curvePoint(p, q, smooth.offsets, t);
    const std::uint32_t at = smooth.firstVertex + k - 1;
    for (std::uint32_t face = 0; face < (smooth.seam ? 2u : 1u); ++face) {
      const Side& side = edge.faces[face];
      const float along = edge.runsBack(face) ? 1.0f - t : t;
      std::array<float, 3> alphas{};
      alphas[side.side] = smooth.alpha;
      writer.vertex(at + face * smooth.inner(), position, {side.triangle, sideWeights(side.side, along)},
                    alphas);
    }
  }
}

SidePoints Pass::sidePointsOf(std::uint32_t side, const SmoothEdge& smooth) const {
  const std::uint32_t before = smooth.seam && smooth.isSecond(side) ? smooth.inner() : 0;
  return {mesh.indices[side], mesh.indices[nextInTriangle(side)],
          static_cast<std::uint32_t>(mesh.positions.size()) + smooth.firstVertex + before, smooth.segments,
          smooth.runsBack(side)};
}

// From the list: with few segments, which loop runs how often cannot be predicted.
void Pass::emitBare(std::uint32_t triangle, const Records& records, const Pattern& pattern,
                    std::uint32_t& face) {
  std::array<std::uint32_t, 3 * BareTriangles::kMaxSegments> points;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const SidePoints side = sidePointsOf(3 * triangle + k, *records[k]);
    const std::uint32_t first = side.backwards ? side.first + side.segments - 2 : side.first;
    const std::uint32_t step = side.backwards ? ~0u : 1u;  // -1, modulo 2^32
    points[4 * k] = side.from;
    for (std::uint32_t i = 0; i < 3; ++i) points[4 * k + 1 + i] = first + i * step;  // more than there are
  }
  const BareTriangles& list = BareTriangles::of(pattern);
  for (std::uint32_t i = 0; i < list.count; ++i) {
    const std::array<std::uint8_t, 3>& corner = list.corners[i];
    writer.triangle(face++, triangle, points[corner[0]], points[corner[1]], points[corner[2]]);
  }
}

void Pass::emitTriangle(std::uint32_t triangle, const Pattern& pattern, std::uint32_t& vertex,
                        std::uint32_t& face) {
  const Records records = recordsOf(triangle);
  if (BareTriangles::has(pattern)) return emitBare(triangle, records, pattern, face);
  const std::uint32_t firstInner = static_cast<std::uint32_t>(mesh.positions.size()) + vertex;
  if (pattern.vertexCount() > 0) {
    const Patch patch = patchOf(triangle, records);
    forVertices(pattern, [&](float v, float w) {
      writer.vertex(vertex++, patch.point(1.0f - v - w, v, w), {triangle, {v, w}}, patch.alphas);
    });
  }
  const std::array<SidePoints, 3> sides{sidePointsOf(3 * triangle, *records[0]),
                                        sidePointsOf(3 * triangle + 1, *records[1]),
                                        sidePointsOf(3 * triangle + 2, *records[2])};
  forTriangles(
      pattern, [&](std::uint32_t k, std::uint32_t i) { return sides[k](i); },
      [&](std::uint32_t i) { return firstInner + i; },
      [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { writer.triangle(face++, triangle, a, b, c); });
}

class BlendedPatches final : public MethodState {
 public:
  explicit BlendedPatches(const Source& source)
      : mesh_(source.mesh),
        topology_(*source.topology),
        fitted_(source.fitted),
        scratch_(static_cast<std::size_t>(source.threads)) {}

  void deform(const Mesh& mesh) override {
    mesh_ = mesh;
    isRigid_ = false;
    prepared_ = false;
  }

  void prepare(const Parameters& parameters, const Crew& crew) override {
    const CurveStyle style{parameters.tangents, parameters.robust};
    const std::array<bool, 2> always{parameters.features, parameters.boundaries};
    if (prepared_ && style == style_ && parameters.wedgeDegrees == wedgeDegrees_ &&
        parameters.beta == beta_ && always == always_ && parameters.edgeBetas.empty())
      return;
    test_.prepare(mesh_, topology_, parameters, crew);
    if (fitted_.empty())
      computeEdgeCurves(mesh_, topology_, style, crew, robust_, curves_);
    else
      placeFittedCurves(crew);
    if (isRigid_) robust_ = {};  // not asked again
    if (clusters_.count() == 0) clusters_.build(mesh_, topology_);
    clusters_.update(mesh_, topology_, test_, curves_, centers_, whereFitted(parameters), crew);
    style_ = style;
    wedgeDegrees_ = parameters.wedgeDegrees;
    beta_ = parameters.beta;
    always_ = {parameters.features, parameters.boundaries};
    prepared_ = parameters.edgeBetas.empty();
  }

  void refine(const View& view, const Parameters& parameters, const Crew& crew, RefinedStream& stream,
              RefineReport& report) override {
    Scratch& scratch = scratch_[crew.slot()];
    const Parameters wanted = whereFitted(parameters);
    if (scratch.recordOf.empty()) scratch.recordOf.assign(topology_.edges().size(), 0);
    Pass pass{mesh_,
              topology_,
              test_,
              clusters_,
              curves_,
              centers_,
              view,
              wanted,
              crew,
              scratch,
              stream,
              report,
              PixelBound(view),
              StreamWriter(mesh_, parameters.shadingNormals, stream)};
    pass.run();
  }

  void levelScratch() override {
    levelCapacity(scratch_, &Scratch::blockCounts, &Scratch::masks, &Scratch::alphas, &Scratch::scales,
                  &Scratch::smooth, &Scratch::recordOf, &Scratch::candidates, &Scratch::firstCut,
                  &Scratch::cuts, &Scratch::shares);
  }

  void silhouetteness(const View& view, const Parameters& parameters, std::vector<float>& alphas) override {
    const Parameters wanted = whereFitted(parameters);
    for (std::size_t e = 0; e < alphas.size(); ++e) alphas[e] = test_.alpha(view, wanted, e);
  }

 private:
  // Fitted curves are known, not guessed: boundaries are always smooth, and edges wherever the contour may come near,
  // since the fitted outline need not run where the shading normals have it.
  Parameters whereFitted(const Parameters& parameters) const {
    Parameters wanted = parameters;
    if (fitted_.empty()) return wanted;
    wanted.boundaries = true;
    if (wanted.silhouetteness == Silhouetteness::kCrossing) wanted.silhouetteness = Silhouetteness::kContour;
    return wanted;
  }

  void placeFittedCurves(const Crew& crew) {
    curves_.resize(topology_.edges().size());
    centers_.resize(mesh_.triangleCount());
    crew.forBlocks(curves_.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        const Edge& edge = topology_.edges()[e];
        const std::array<std::uint32_t, 2> ends = edgeVertices(mesh_, edge)[0];
        const std::array<vec3, 2> normals = endNormals(mesh_, edge);
        curves_[e] = edge.nonManifold ? CurveOffsets{}
                                      : fittedOffsets(mesh_.positions[ends[0]], mesh_.positions[ends[1]],
                                                      normals[0], normals[1], fitted_.edges[e]);
      }
    });
    crew.forBlocks(centers_.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const std::uint32_t* corner = &mesh_.indices[3 * t];
        centers_[t] = fittedCenter(mesh_.positions[corner[0]], mesh_.positions[corner[1]],
                                   mesh_.positions[corner[2]], fitted_.centers[t]);
      }
    });
  }

  Mesh mesh_;
  const Topology& topology_;
  FittedCurves fitted_;
  std::vector<Scratch> scratch_;
  EdgeTest test_;
  RobustEnds robust_;
  EdgeClusters clusters_;
  std::vector<CurveOffsets> curves_;
  std::vector<vec3> centers_;  // what a fitted patch adds to b111; empty without fitted curves
  CurveStyle style_;
  float wedgeDegrees_ = 0, beta_ = 0;
  std::array<bool, 2> always_{};  // features, boundaries
  bool prepared_ = false, isRigid_ = true;
};

}  // namespace

std::unique_ptr<MethodState> makeBlendedPatches(const Source& source) {
  return std::make_unique<BlendedPatches>(source);
}

}  // namespace limn::silhouette
