// View-dependent blended Bézier patches: flat away from the silhouette, smooth at it, continuous in the
// viewpoint.
//
// Based on: C. Dyken, M. Reimers, "Real-time linear silhouette enhancement", 2004.
// Differs in: where the silhouette crosses a triangle, the inside of the patch is refined too: a fan's chords
// from the corners to the midpoint are straight and limit the outline. Segment counts come from a tolerance
// in pixels that holds under perspective (pixel_bound.h); a triangle whose three edges stay straight and
// whose midpoint stays within the tolerance is passed through as flat.
//
// Every edge has one record with its α, curve and segments, from which both its triangles take the same
// points.
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <numeric>

#include "raster/base/check.h"
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

constexpr std::size_t kEdgesPerBlock = 4096;
constexpr std::size_t kWordsPerBlock = 64;  // of 64 triangles each
constexpr float kThird = 1.0f / 3.0f;

// The inside of a patch blends in over a narrower range of facing than its edges: it matters only where the
// silhouette crosses.
constexpr float kInsideShare = 0.2f;
constexpr std::uint32_t kMaxRows = 32;
constexpr float kSideOverSpoke = 1.7320508f;  // lengths, in an equilateral triangle

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
  std::vector<std::uint32_t> blockCounts;  // smooth edges per block of edges, then their prefix sums
  std::vector<float> alphas;
  std::vector<SmoothEdge> smooth;
  std::vector<std::uint32_t> recordOf;  // per edge: index into smooth, or kNone
  std::vector<Share> shares;            // per block of triangles, then prefix sums
};

// How a triangle is drawn.
struct Cut {
  Patch patch;
  Pattern pattern;
  std::array<float, 3> alphas{};  // of the sides
  float inside = 0;               // γ: the inside is the fan's at 0 and the patch's at 1
};

// One view's refinement; all it refers to outlives it.
struct Pass {
  const Mesh& mesh;
  const Topology& topology;
  const EdgeTest& test;
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
  void measure(SmoothEdge& smooth);
  void placeEdges();
  Share decide(std::size_t word);
  void placeTriangles();
  void emitEdge(const SmoothEdge& smooth);
  void emitTriangle(std::uint32_t triangle, std::uint32_t& vertex, std::uint32_t& face);

  const SmoothEdge* recordOfSide(std::size_t triangle, std::size_t side) const {
    const std::uint32_t record = scratch.recordOf[topology.sideEdges()[3 * triangle + side]];
    return record == kNone ? nullptr : &scratch.smooth[record];
  }
  Patch patchOf(std::size_t triangle) const;
  Cut cutOf(std::size_t triangle) const;
};

void mark(RefinedStream& stream, std::uint32_t triangle) {
  std::atomic_ref<std::uint64_t>(stream.replaced[triangle / 64])
      .fetch_or(std::uint64_t{1} << (triangle % 64), std::memory_order_relaxed);
}

void Pass::run() {
  const auto start = std::chrono::steady_clock::now();
  classify();
  report.classifyMs =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  placeEdges();
  placeTriangles();
  for (const SmoothEdge& smooth : scratch.smooth) scratch.recordOf[smooth.edge] = kNone;
}

// Lists the edges with α > 0, in order, and marks their triangles as candidates.
void Pass::classify() {
  const std::size_t edges = topology.edges().size(), blocks = (edges + kEdgesPerBlock - 1) / kEdgesPerBlock;
  scratch.blockCounts.assign(blocks + 1, 0);
  scratch.alphas.resize(edges);
  crew.forBlocks(edges, kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t count = 0;
    for (std::size_t e = begin; e < end; ++e) {
      const bool bends = curves[e][0] != vec3(0.0f) || curves[e][1] != vec3(0.0f);
      scratch.alphas[e] = bends ? test.alpha(view, parameters, e) : 0.0f;
      if (scratch.alphas[e] > 0.0f) ++count;
    }
    scratch.blockCounts[begin / kEdgesPerBlock + 1] = count;
  });
  std::partial_sum(scratch.blockCounts.begin(), scratch.blockCounts.end(), scratch.blockCounts.begin());
  scratch.smooth.resize(scratch.blockCounts[blocks]);
  report.smoothEdges = scratch.smooth.size();
  crew.forBlocks(edges, kEdgesPerBlock, [&](std::size_t begin, std::size_t end) {
    std::uint32_t record = scratch.blockCounts[begin / kEdgesPerBlock];
    for (std::size_t e = begin; e < end; ++e) {
      if (scratch.alphas[e] <= 0.0f) continue;
      SmoothEdge& smooth = scratch.smooth[record];
      smooth = {};
      smooth.edge = static_cast<std::uint32_t>(e);
      smooth.alpha = scratch.alphas[e];
      measure(smooth);
      scratch.recordOf[e] = record++;
      for (const Side& face : topology.edges()[e].faces)
        if (face.triangle != kNone) mark(stream, face.triangle);
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

// The fan's inside blends into that of the patch as the silhouette comes to cross the triangle. Its rows keep
// what that adds within the tolerance, by its size at the middles of the spokes, so that rows come in where
// they change little.
Cut Pass::cutOf(std::size_t triangle) const {
  Cut cut;
  cut.patch = patchOf(triangle);
  for (std::size_t k = 0; k < 3; ++k) {
    const SmoothEdge* smooth = recordOfSide(triangle, k);
    if (smooth == nullptr) continue;
    cut.pattern.sides[k] = smooth->segments;
    cut.alphas[k] = smooth->alpha;
  }
  if (parameters.segments > 0) return cut;
  const float beta = kInsideShare * parameters.beta;
  cut.inside = silhouettenessOf(test.facingProduct(view, triangle), beta);
  if (cut.inside <= 0.0f) return cut;
  const Patch& patch = cut.patch;
  const vec3 middle = patch.point(kThird, kThird, kThird);
  float largest = 0.0f;
  for (std::size_t k = 0; k < 3; ++k) {
    vec3 weights(kThird / 2.0f);
    weights[static_cast<int>(k)] = 2.0f * kThird;
    const vec3 chord = 0.5f * (patch.corners[k] + middle);
    largest = std::max(largest, bound.distance(chord, patch.point(weights.x, weights.y, weights.z)));
  }
  const float rows = std::sqrt(cut.inside * largest / parameters.tolerance);
  if (rows <= 1.0f) return cut;
  const float most = static_cast<float>(kMaxRows);
  cut.pattern.rows = rows < most ? static_cast<std::uint32_t>(std::ceil(rows)) : kMaxRows;
  cut.pattern.density = kSideOverSpoke * std::min(rows, most);
  return cut;
}

// Which of a word's candidates are curved: the others lose their bit.
Share Pass::decide(std::size_t word) {
  Share share;
  for (std::uint64_t rest = stream.replaced[word]; rest != 0; rest &= rest - 1) {
    const std::size_t triangle = 64 * word + static_cast<std::size_t>(std::countr_zero(rest));
    const Cut cut = cutOf(triangle);
    const Pattern& pattern = cut.pattern;
    const bool plain = pattern.sides == std::array<std::uint32_t, 3>{1, 1, 1} && pattern.rows == 1;
    const vec3 flat = cut.patch.flatPoint(kThird, kThird, kThird);
    const vec3 middle = cut.patch.point(kThird, kThird, kThird);
    if (plain && bound.distance(flat, middle) <= parameters.tolerance) {
      stream.replaced[word] &= ~(std::uint64_t{1} << (triangle % 64));
      continue;
    }
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
    for (std::size_t word = begin; word < end; ++word)
      for (std::uint64_t rest = stream.replaced[word]; rest != 0; rest &= rest - 1)
        emitTriangle(
            static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(rest)),
            vertex, face);
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

void Pass::emitTriangle(std::uint32_t triangle, std::uint32_t& vertex, std::uint32_t& face) {
  const Cut cut = cutOf(triangle);
  const std::uint32_t firstInner = vertex;
  const vec3 middle = cut.patch.offset(kThird, kThird, kThird);
  forVertices(cut.pattern, [&](std::uint32_t k, float s, float t) {
    vec3 weights(s * kThird);
    weights[static_cast<int>(k)] += (1.0f - s) * (1.0f - t);
    weights[static_cast<int>(k == 2 ? 0 : k + 1)] += (1.0f - s) * t;
    const vec3 fan = (1.0f - s) * curveOffset(cut.patch.sides[k], t) + s * middle;
    const vec3 offset = fan + cut.inside * (cut.patch.offset(weights.x, weights.y, weights.z) - fan);
    writer.vertex(vertex++, cut.patch.flatPoint(weights.x, weights.y, weights.z) + offset,
                  {triangle, {weights.y, weights.z}}, cut.alphas);
  });

  const auto firstNew = static_cast<std::uint32_t>(mesh.positions.size());
  const auto sidePoint = [&](std::uint32_t k, std::uint32_t i) {
    const std::uint32_t side = 3 * triangle + k;
    if (i == 0) return mesh.indices[side];
    if (i == cut.pattern.sides[k]) return mesh.indices[nextInTriangle(side)];
    const SmoothEdge& smooth = *recordOfSide(triangle, k);
    const Edge& edge = topology.edges()[smooth.edge];
    const std::uint32_t own = edge.faces[1].triangle == triangle && edge.faces[1].side == k ? 1 : 0;
    const std::uint32_t first = firstNew + smooth.firstVertex + (smooth.seam ? own * smooth.inner() : 0);
    return first + (edge.runsBack(own) ? smooth.inner() - i : i - 1);
  };
  const auto inner = [&](std::uint32_t i) { return firstNew + firstInner + i; };
  forTriangles(cut.pattern, sidePoint, inner, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
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
    if (prepared_ && style == style_ && parameters.wedgeDegrees == wedgeDegrees_ &&
        parameters.edgeBetas.empty())
      return;
    test_.prepare(mesh_, topology_, parameters, crew);
    if (fitted_.empty())
      computeEdgeCurves(mesh_, topology_, style, crew, robust_, curves_);
    else
      placeFittedCurves(crew);
    style_ = style;
    wedgeDegrees_ = parameters.wedgeDegrees;
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
  std::vector<CurveOffsets> curves_;
  std::vector<vec3> centers_;  // what a fitted patch adds to b111; empty without fitted curves
  CurveStyle style_;
  float wedgeDegrees_ = 0;
  bool prepared_ = false;
};

}  // namespace

std::unique_ptr<MethodState> makeBlendedPatches(const Source& source) {
  return std::make_unique<BlendedPatches>(source);
}

}  // namespace limn::silhouette
