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
#include "silhouette/edge_clusters.h"
#include "silhouette/edge_curves.h"
#include "silhouette/method.h"
#include "silhouette/patch.h"
#include "silhouette/pattern.h"
#include "silhouette/pixel_bound.h"
#include "silhouette/silhouetteness.h"
#include "silhouette/writer.h"

namespace limn::silhouette {
namespace {

using glm::vec3;

constexpr std::size_t kClustersPerBlock = 64;
constexpr std::size_t kEdgesPerBlock = 4096;
constexpr std::size_t kWordsPerBlock = 64;  // of 64 triangles each
constexpr float kThird = 1.0f / 3.0f;

// An edge that bends in this view.
struct SmoothEdge {
  std::uint32_t edge = 0;
  float alpha = 0;
  CurveOffsets offsets{};  // α d
  std::uint32_t segments = 1;
  std::uint32_t firstVertex = 0;  // of segments - 1, or twice that, in the stream
  bool seam = false;              // the faces have vertices of their own, those of faces[1] come second

  std::uint32_t inner() const { return segments - 1; }
  std::uint32_t vertexCount() const { return seam ? 2 * inner() : inner(); }
};

// What a block of triangles adds to the stream.
struct Share {
  std::uint32_t curved = 0, vertices = 0, triangles = 0;
};

struct Scratch {
  std::vector<std::uint32_t> blockCounts;  // smooth edges per block of clusters, then their prefix sums
  std::vector<std::uint64_t> masks;        // per cluster: the edges that bend
  std::vector<float> alphas;               // per place in the clusters' order, where an edge bends
  std::vector<SmoothEdge> smooth;
  std::vector<std::uint32_t> recordOf;    // per edge: index into smooth, or kNone
  std::vector<std::uint64_t> candidates;  // bit per triangle: has a smooth edge
  std::vector<std::uint32_t> firstCut;    // per word of candidates: index into cuts, and their number
  std::vector<Pattern> cuts;              // per candidate, in order
  std::vector<Share> shares;              // per block of triangles, then prefix sums
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
  void classify();
  void measureEdges();
  void measure(SmoothEdge& smooth);
  void placeEdges();
  void listCandidates();
  Share decide(std::size_t word);
  void placeTriangles();
  void emitEdge(const SmoothEdge& smooth);
  void emitTriangle(std::uint32_t triangle, const Pattern& pattern, std::uint32_t& vertex,
                    std::uint32_t& face);

  const SmoothEdge* recordOfSide(std::size_t triangle, std::size_t side) const {
    const std::uint32_t record = scratch.recordOf[topology.sideEdges()[3 * triangle + side]];
    return record == kNone ? nullptr : &scratch.smooth[record];
  }
  Patch patchOf(std::size_t triangle) const;
  bool passesMidpoint(const Patch& patch, const Pattern& pattern) const;
  Pattern patternOf(std::size_t triangle, const Patch& patch) const;
};

void Pass::run() {
  const auto start = std::chrono::steady_clock::now();
  classify();
  report.classifyMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  measureEdges();
  placeEdges();
  listCandidates();
  placeTriangles();
  for (const SmoothEdge& smooth : scratch.smooth) scratch.recordOf[smooth.edge] = kNone;
}

// Lists the edges that bend visibly, in the order of the clusters, and marks their triangles as candidates.
void Pass::classify() {
  const std::size_t count = clusters.count(), blocks = (count + kClustersPerBlock - 1) / kClustersPerBlock;
  scratch.blockCounts.assign(blocks + 1, 0);
  scratch.masks.resize(count);
  scratch.alphas.resize(count * kEdgesPerCluster);
  const EdgeClusters::Eye eye = clusters.eyeOf(view, parameters);
  crew.forBlocks(count, kClustersPerBlock, [&](std::size_t begin, std::size_t end) {
    int bending = 0;
    for (std::size_t c = begin; c < end; ++c) {
      const std::span<float> alphas =
          std::span(scratch.alphas).subspan(c * kEdgesPerCluster, kEdgesPerCluster);
      scratch.masks[c] = clusters.classify(c, eye, test, parameters, alphas);
      bending += std::popcount(scratch.masks[c]);
    }
    scratch.blockCounts[begin / kClustersPerBlock + 1] = static_cast<std::uint32_t>(bending);
  });
  std::partial_sum(scratch.blockCounts.begin(), scratch.blockCounts.end(), scratch.blockCounts.begin());
  scratch.smooth.resize(scratch.blockCounts[blocks]);
  report.smoothEdges = scratch.smooth.size();
}

// Their curves and segments.
void Pass::measureEdges() {
  scratch.candidates.assign(stream.replaced.size(), 0);
  crew.forBlocks(clusters.count(), kClustersPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t record = scratch.blockCounts[begin / kClustersPerBlock];
    for (std::size_t c = begin; c < end; ++c) {
      for (std::uint64_t rest = scratch.masks[c]; rest != 0; rest &= rest - 1) {
        const std::size_t place = c * kEdgesPerCluster + static_cast<std::size_t>(std::countr_zero(rest));
        SmoothEdge& smooth = scratch.smooth[record];
        smooth = {};
        smooth.edge = clusters.edgeAt(place);
        smooth.alpha = scratch.alphas[place];
        measure(smooth);
        scratch.recordOf[smooth.edge] = record++;
        for (const Side& face : topology.edges()[smooth.edge].faces)
          if (face.triangle != kNone) markTriangle(scratch.candidates, face.triangle);
      }
    }
  });
}

void Pass::measure(SmoothEdge& smooth) {
  const EdgeVertices v = edgeVertices(mesh, topology.edges()[smooth.edge]);
  smooth.offsets = {smooth.alpha * curves[smooth.edge][0], smooth.alpha * curves[smooth.edge][1]};
  smooth.seam = v[0] != v[1];
  if (parameters.segments > 0) {
    smooth.segments = static_cast<std::uint32_t>(parameters.segments);
    return;
  }
  bool capped = false;
  const float error = bound.chordError(mesh.positions[v[0][0]], mesh.positions[v[0][1]], smooth.offsets);
  smooth.segments = static_cast<std::uint32_t>(segmentsFor(error, parameters.tolerance, capped));
  if (capped) std::atomic_ref<std::size_t>(report.cappedEdges).fetch_add(1, std::memory_order_relaxed);
}

// Gives every edge its place in the stream and writes its vertices.
void Pass::placeEdges() {
  std::uint32_t vertices = 0;
  for (SmoothEdge& smooth : scratch.smooth) {
    smooth.firstVertex = vertices;
    vertices += smooth.vertexCount();
  }
  stream.positions.resize(vertices);
  stream.normals.resize(vertices);
  stream.origins.resize(vertices);
  crew.forBlocks(scratch.smooth.size(), kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) emitEdge(scratch.smooth[k]);
  });
}

Patch Pass::patchOf(std::size_t triangle) const {
  Patch patch;
  float alphas = 0.0f;
  for (std::size_t k = 0; k < 3; ++k) {
    patch.corners[k] = mesh.positions[mesh.indices[3 * triangle + k]];
    const SmoothEdge* smooth = recordOfSide(triangle, k);
    if (smooth == nullptr) continue;
    alphas += smooth->alpha;
    const bool ascends =
        topology.points()[mesh.indices[3 * triangle + k]] == topology.edges()[smooth->edge].point[0];
    patch.sides[k] = {smooth->offsets[ascends ? 0 : 1], smooth->offsets[ascends ? 1 : 0]};
  }
  // The centre follows its sides: there where all three are smooth, gone where all are straight.
  if (!centers.empty()) patch.fittedCenter = (alphas / 3.0f) * centers[triangle];
  return patch;
}

// Whether a triangle whose sides have at most two segments can do without its midpoint: the joined halves pass
// within the tolerance of it.
bool Pass::passesMidpoint(const Patch& patch, const Pattern& pattern) const {
  const std::uint32_t k = pattern.firstHalved(), halved = pattern.halvedSides();
  const auto middle = [&](std::uint32_t side) { return curveOffset(patch.sides[side % 3], 0.5f); };
  vec3 joined(0.0f);  // what the joined halves add to the centroid
  if (halved == 1) joined = (2.0f / 3.0f) * middle(k);
  if (halved == 2) joined = (2.0f / 3.0f) * middle(k + 1);
  if (halved == 3) joined = (middle(0) + middle(1) + middle(2)) / 3.0f;
  const vec3 flat = patch.flatPoint(kThird, kThird, kThird);
  return bound.distance(flat + joined, flat + patch.offset(kThird, kThird, kThird)) <= parameters.tolerance;
}

// The steps of the grid inside follow the largest error of the spokes from the corners to the midpoint, by its size at
// their middles: a spoke of an equilateral triangle is 1/√3 of a side, so its error is a third of what a side's would be.
Pattern Pass::patternOf(std::size_t triangle, const Patch& patch) const {
  Pattern pattern;
  std::uint32_t most = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const SmoothEdge* smooth = recordOfSide(triangle, k);
    if (smooth == nullptr) continue;
    pattern.sides[k] = smooth->segments;
    most = std::max(most, smooth->segments);
  }
  pattern.steps = most;
  if (parameters.segments > 0 || (most <= 2 && passesMidpoint(patch, pattern))) return pattern;

  const vec3 middle = patch.point(kThird, kThird, kThird);
  float largest = 0.0f;
  for (int k = 0; k < 3; ++k) {
    vec3 weights(kThird / 2.0f);
    weights[k] = 2.0f * kThird;
    const vec3 chord = 0.5f * (patch.corners[static_cast<std::size_t>(k)] + middle);
    largest = std::max(largest, bound.distance(chord, patch.point(weights.x, weights.y, weights.z)));
  }
  bool capped = false;  // the cap of the sides is what is reported
  pattern.steps =
      std::max(3u, static_cast<std::uint32_t>(segmentsFor(3.0f * largest, parameters.tolerance, capped)));
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
    const Patch patch = patchOf(triangle);
    const Pattern& pattern = scratch.cuts[next++] = patternOf(triangle, patch);
    if (pattern.steps == 1) continue;
    stream.replaced[word] |= std::uint64_t{1} << (triangle % 64);
    ++share.curved;
    share.vertices += pattern.vertexCount();
    share.triangles += pattern.triangleCount();
  }
  return share;
}

void Pass::placeTriangles() {
  const std::size_t words = stream.replaced.size(), blocks = (words + kWordsPerBlock - 1) / kWordsPerBlock;
  scratch.shares.assign(blocks + 1, {});
  crew.forBlocks(words, kWordsPerBlock, [&](std::size_t begin, std::size_t end) {
    Share& sum = scratch.shares[begin / kWordsPerBlock + 1];
    for (std::size_t word = begin; word < end; ++word) {
      const Share share = decide(word);
      sum = {sum.curved + share.curved, sum.vertices + share.vertices, sum.triangles + share.triangles};
    }
  });
  const auto edgeVertexCount = static_cast<std::uint32_t>(stream.positions.size());
  scratch.shares[0].vertices = edgeVertexCount;
  for (std::size_t block = 1; block <= blocks; ++block) {
    const Share &before = scratch.shares[block - 1], &own = scratch.shares[block];
    scratch.shares[block] = {before.curved + own.curved, before.vertices + own.vertices,
                             before.triangles + own.triangles};
  }
  const Share all = scratch.shares[blocks];
  report.curvedTriangles = all.curved;
  stream.positions.resize(all.vertices);
  stream.normals.resize(all.vertices);
  stream.origins.resize(all.vertices);
  stream.indices.resize(3 * std::size_t{all.triangles});
  stream.sourceTriangles.resize(all.triangles);
  crew.forBlocks(words, kWordsPerBlock, [&](std::size_t begin, std::size_t end) {
    const Share& before = scratch.shares[begin / kWordsPerBlock];
    std::uint32_t vertex = before.vertices, face = before.triangles;
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
  const std::array<std::uint32_t, 2> ends = edgeVertices(mesh, edge)[0];
  const vec3 &p = mesh.positions[ends[0]], &q = mesh.positions[ends[1]];
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

void Pass::emitTriangle(std::uint32_t triangle, const Pattern& pattern, std::uint32_t& vertex,
                        std::uint32_t& face) {
  const Patch patch = patchOf(triangle);
  std::array<float, 3> alphas{};
  for (std::size_t k = 0; k < 3; ++k)
    if (const SmoothEdge* smooth = recordOfSide(triangle, k); smooth != nullptr) alphas[k] = smooth->alpha;
  const std::uint32_t firstInner = vertex;
  forVertices(pattern, [&](float v, float w) {
    writer.vertex(vertex++, patch.point(1.0f - v - w, v, w), {triangle, {v, w}}, alphas);
  });

  const auto firstNew = static_cast<std::uint32_t>(mesh.positions.size());
  const auto sidePoint = [&](std::uint32_t k, std::uint32_t i) {
    const std::uint32_t side = 3 * triangle + k;
    if (i == 0) return mesh.indices[side];
    if (i == pattern.sides[k]) return mesh.indices[nextInTriangle(side)];
    const SmoothEdge& smooth = *recordOfSide(triangle, k);
    const Edge& edge = topology.edges()[smooth.edge];
    const std::uint32_t own = edge.faces[1].triangle == triangle && edge.faces[1].side == k ? 1 : 0;
    const std::uint32_t first = firstNew + smooth.firstVertex + (smooth.seam ? own * smooth.inner() : 0);
    return first + (edge.runsBack(own) ? smooth.inner() - i : i - 1);
  };
  const auto inner = [&](std::uint32_t i) { return firstNew + firstInner + i; };
  forTriangles(pattern, sidePoint, inner, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    writer.triangle(face++, triangle, a, b, c);
  });
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
    if (scratch.recordOf.empty()) scratch.recordOf.assign(topology_.edges().size(), kNone);
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
    levelCapacity(scratch_, &Scratch::blockCounts, &Scratch::masks, &Scratch::alphas, &Scratch::smooth,
                  &Scratch::recordOf, &Scratch::candidates, &Scratch::firstCut, &Scratch::cuts,
                  &Scratch::shares);
  }

  void silhouetteness(const View& view, const Parameters& parameters, std::vector<float>& alphas) override {
    const Parameters wanted = whereFitted(parameters);
    for (std::size_t e = 0; e < alphas.size(); ++e) alphas[e] = test_.alpha(view, wanted, e);
  }

 private:
  // A fitted boundary is known, not guessed: always smooth.
  Parameters whereFitted(const Parameters& parameters) const {
    Parameters wanted = parameters;
    wanted.boundaries = wanted.boundaries || !fitted_.empty();
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
  bool prepared_ = false;
};

}  // namespace

std::unique_ptr<MethodState> makeBlendedPatches(const Source& source) {
  return std::make_unique<BlendedPatches>(source);
}

}  // namespace limn::silhouette
