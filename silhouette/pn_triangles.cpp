// Curved PN triangles: every triangle becomes its whole Bézier patch, uniformly refined, from any viewpoint.
// The baseline that the view-dependent methods are compared with.
//
// Based on: A. Vlachos, J. Peters, C. Boyd, J. Mitchell, "Curved PN triangles", 2001.
// Differs in: an edge whose faces have different normals gets one curve, that of a feature edge (Dyken &
// Reimers 2004, (8)), so that the surface does not tear there; non-manifold edges stay straight. With a
// tolerance instead of a number of segments, all sides get what the worst of them needs in this view.
#include <algorithm>
#include <array>
#include <atomic>

#include "silhouette/edge_curves.h"
#include "silhouette/method.h"
#include "silhouette/patch.h"
#include "silhouette/pixel_bound.h"
#include "silhouette/writer.h"

namespace limn::silhouette {
namespace {

using glm::vec3;

constexpr std::size_t kItemsPerBlock = 1024;
constexpr std::array<float, 3> kWholly{1.0f, 1.0f, 1.0f};  // α of a triangle's sides

// Inner points of a side and of a triangle of L segments.
std::uint32_t onSide(std::uint32_t L) {
  return L - 1;
}
std::uint32_t inTriangle(std::uint32_t L) {
  return (L - 1) * (L - 2) / 2;
}

class PnTriangles final : public MethodState {
 public:
  explicit PnTriangles(const Source& source) : mesh_(source.mesh), topology_(*source.topology) {
    std::uint32_t places = 0, triangles = 0;
    for (const Edge& edge : topology_.edges()) {
      placeOfEdge_.push_back(places);
      places += isSeam(edge) ? 2 : 1;
    }
    placeOfEdge_.push_back(places);
    for (std::size_t t = 0; t < mesh_.triangleCount(); ++t) {
      placeOfTriangle_.push_back(triangles);
      if (!topology_.isDegenerate(t)) ++triangles;
    }
    placeOfTriangle_.push_back(triangles);
  }

  void deform(const Mesh& mesh) override {
    mesh_ = mesh;
    prepared_ = false;
  }

  void prepare(const Parameters&, const Crew& crew) override {
    if (prepared_) return;
    RobustEnds unused;
    computeEdgeCurves(mesh_, topology_, CurveStyle{}, crew, unused, curves_);
    prepared_ = true;
  }

  void refine(const View& view, const Parameters& parameters, const Crew& crew, RefinedStream& stream,
              RefineReport& report) override;

 private:
  bool isSeam(const Edge& edge) const {
    const EdgeVertices v = edgeVertices(mesh_, edge);
    return v[0] != v[1];
  }
  std::uint32_t segmentsFromTolerance(const View& view, float tolerance, const Crew& crew,
                                      RefineReport& report) const;
  void emitEdge(std::size_t e, std::uint32_t L, StreamWriter& writer) const;
  void emitTriangle(std::uint32_t triangle, std::uint32_t L, StreamWriter& writer) const;
  Patch patchOf(std::size_t triangle) const;

  Mesh mesh_;
  const Topology& topology_;
  std::vector<CurveOffsets> curves_;
  std::vector<std::uint32_t> placeOfEdge_,
      placeOfTriangle_;  // ranks; a seam takes two places; sums at the end
  bool prepared_ = false;
};

std::uint32_t PnTriangles::segmentsFromTolerance(const View& view, float tolerance, const Crew& crew,
                                                 RefineReport& report) const {
  const PixelBound bound(view);
  std::atomic<int> most{1};
  std::atomic<std::size_t> cappedEdges{0};
  crew.forBlocks(curves_.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    int largest = 1;
    for (std::size_t e = begin; e < end; ++e) {
      const std::array<std::uint32_t, 2> ends = edgeVertices(mesh_, topology_.edges()[e])[0];
      bool capped = false;
      const CurveError error =
          bound.curveError(mesh_.positions[ends[0]], mesh_.positions[ends[1]], curves_[e]);
      largest = std::max(largest, segmentsFor(error, tolerance, capped));
      if (capped) cappedEdges.fetch_add(1, std::memory_order_relaxed);
    }
    for (int seen = most.load(); seen < largest && !most.compare_exchange_weak(seen, largest);) {
    }
  });
  report.cappedEdges = cappedEdges;
  return static_cast<std::uint32_t>(most.load());
}

void PnTriangles::refine(const View& view, const Parameters& parameters, const Crew& crew,
                         RefinedStream& stream, RefineReport& report) {
  const auto L = parameters.segments > 0 ? static_cast<std::uint32_t>(parameters.segments)
                                         : segmentsFromTolerance(view, parameters.tolerance, crew, report);
  report.smoothEdges = topology_.edges().size();
  if (L == 1) return stream.setCounts(0, 0);
  if (parameters.segments == 0 && std::size_t{L} * L > parameters.mostPerTriangle)
    throw TooManyTriangles(TooManyTriangles::Limit::kPerTriangle, std::size_t{L} * L);
  const std::uint64_t triangles = placeOfTriangle_.back();
  const StreamSize size{std::uint64_t{placeOfEdge_.back()} * onSide(L) + triangles * inTriangle(L),
                        triangles * L * L};
  requireNumbered(mesh_.positions.size(), size);
  report.curvedTriangles = triangles;
  stream.setCounts(size.vertices, size.triangles);
  StreamWriter writer(mesh_, parameters.shadingNormals, stream);
  crew.forBlocks(curves_.size(), kItemsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) emitEdge(e, L, writer);
  });
  crew.forBlocks(mesh_.triangleCount(), 64 * (kItemsPerBlock / 64), [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (topology_.isDegenerate(t)) continue;
      stream.replaced[t / 64] |= std::uint64_t{1} << (t % 64);
      emitTriangle(static_cast<std::uint32_t>(t), L, writer);
    }
  });
}

void PnTriangles::emitEdge(std::size_t e, std::uint32_t L, StreamWriter& writer) const {
  const Edge& edge = topology_.edges()[e];
  const std::array<std::uint32_t, 2> ends = edgeVertices(mesh_, edge)[0];
  const std::uint32_t copies = placeOfEdge_[e + 1] - placeOfEdge_[e];
  for (std::uint32_t k = 1; k < L; ++k) {
    const float t = static_cast<float>(k) / static_cast<float>(L);
    const vec3 position = curvePoint(mesh_.positions[ends[0]], mesh_.positions[ends[1]], curves_[e], t);
    for (std::uint32_t face = 0; face < copies; ++face) {
      const Side& side = edge.faces[face];
      const float along = edge.runsBack(face) ? 1.0f - t : t;
      writer.vertex((placeOfEdge_[e] + face) * onSide(L) + k - 1, position,
                    {side.triangle, sideWeights(side.side, along)}, kWholly);
    }
  }
}

Patch PnTriangles::patchOf(std::size_t triangle) const {
  Patch patch;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t side = 3 * triangle + k;
    const std::uint32_t e = topology_.sideEdges()[side];
    patch.corners[k] = mesh_.positions[mesh_.indices[side]];
    const bool ascends = topology_.points()[mesh_.indices[side]] == topology_.edges()[e].point[0];
    patch.sides[k] = {curves_[e][ascends ? 0 : 1], curves_[e][ascends ? 1 : 0]};
  }
  return patch;
}

// Rows parallel to side 0: point i of row r lies r/L of the way to corner 2 and has i/L of corner 1.
void PnTriangles::emitTriangle(std::uint32_t triangle, std::uint32_t L, StreamWriter& writer) const {
  const Patch patch = patchOf(triangle);
  const std::uint32_t place = placeOfTriangle_[triangle];
  const std::uint32_t firstInner = placeOfEdge_.back() * onSide(L) + place * inTriangle(L);
  const auto firstNew = static_cast<std::uint32_t>(mesh_.positions.size());

  const float step = 1.0f / static_cast<float>(L);
  std::uint32_t at = firstInner;
  for (std::uint32_t r = 1; r + 1 < L; ++r) {
    for (std::uint32_t i = 1; i + r < L; ++i, ++at) {
      const float v = static_cast<float>(i) * step, w = static_cast<float>(r) * step;
      writer.vertex(at, patch.point(1.0f - v - w, v, w), {triangle, {v, w}}, kWholly);
    }
  }

  const auto sidePoint = [&](std::uint32_t k, std::uint32_t i) {  // 0 < i < L along side k
    const std::uint32_t e = topology_.sideEdges()[3 * std::size_t{triangle} + k];
    const Edge& edge = topology_.edges()[e];
    const std::uint32_t face = edge.faces[1].triangle == triangle && edge.faces[1].side == k ? 1 : 0;
    const std::uint32_t copy = placeOfEdge_[e + 1] - placeOfEdge_[e] == 2 ? face : 0;
    return firstNew + (placeOfEdge_[e] + copy) * onSide(L) + (edge.runsBack(face) ? L - i : i) - 1;
  };
  const auto point = [&](std::uint32_t r, std::uint32_t i) {
    const std::uint32_t* corner = &mesh_.indices[3 * std::size_t{triangle}];
    if (r == L) return corner[2];
    if (r == 0) return i == 0 ? corner[0] : i == L ? corner[1] : sidePoint(0, i);
    if (i == 0) return sidePoint(2, L - r);
    if (i + r == L) return sidePoint(1, r);
    // Rows 1 … r - 1 hold L - 2, L - 3, … inner points.
    return firstNew + firstInner + (r - 1) * (L - 1) - r * (r - 1) / 2 + i - 1;
  };
  std::uint32_t face = place * L * L;
  for (std::uint32_t r = 0; r < L; ++r) {
    for (std::uint32_t i = 0; i + r < L; ++i) {
      writer.triangle(face++, triangle, point(r, i), point(r, i + 1), point(r + 1, i));
      if (i + r + 1 < L)
        writer.triangle(face++, triangle, point(r, i + 1), point(r + 1, i + 1), point(r + 1, i));
    }
  }
}

}  // namespace

std::unique_ptr<MethodState> makePnTriangles(const Source& source) {
  return std::make_unique<PnTriangles>(source);
}

}  // namespace limn::silhouette
