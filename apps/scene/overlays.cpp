#include "apps/scene/overlays.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "raster/base/check.h"
#include "silhouette/contour.h"

namespace limn::scene {
namespace {

using silhouette::kNone;

// Linear RGB and straight alpha.
constexpr glm::vec4 kWireColor{0.0f, 0.0f, 0.0f, 0.6f}, kFeatureColor{0.05f, 0.9f, 0.1f, 1.0f},
    kContourColor{1.0f, 0.05f, 0.6f, 1.0f}, kBridgeColor{1.0f, 0.55f, 0.0f, 1.0f};
constexpr std::array<float, kOverlays> kWidths = {1.0f, 2.0f, 2.0f, 2.0f};

/// From blue, hardly smooth, to red, α = 1.
glm::vec4 alphaColor(float alpha) {
  return {alpha, 0.25f * (1.0f - alpha), 1.0f - alpha, 1.0f};
}

bool before(const glm::vec3& p, const glm::vec3& q) {
  return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
}

/// Where a drawn vertex lies on the coarse mesh: at a point, on an edge, or inside a triangle.
struct Place {
  std::uint32_t point = kNone, edge = kNone;

  bool isOn(std::uint32_t e, const silhouette::Topology& topology) const {
    if (e == kNone) return false;
    const silhouette::Edge& its = topology.edges()[e];
    return edge == e || (point != kNone && (its.point[0] == point || its.point[1] == point));
  }
};

/// The vertices of an instance, those of the mesh first, then those of the stream.
class DrawnVertices {
 public:
  explicit DrawnVertices(const RefinedInstance& instance) : instance_(instance) {}

  const glm::vec3& position(std::uint32_t v) const {
    return v < ofMesh() ? instance_.shape.positions[v] : instance_.stream->positions[v - ofMesh()];
  }
  const glm::vec3& normal(std::uint32_t v) const {
    return v < ofMesh() ? instance_.shape.normals[v] : instance_.stream->normals[v - ofMesh()];
  }
  Place place(std::uint32_t v) const;

 private:
  std::size_t ofMesh() const { return instance_.shape.positions.size(); }

  const RefinedInstance& instance_;
};

Place DrawnVertices::place(std::uint32_t v) const {
  const silhouette::Topology& topology = *instance_.topology;
  if (v < ofMesh()) return {topology.points()[v], kNone};
  constexpr float kRounding = 1e-6f;  // of a weight that is 0
  const silhouette::Origin& origin = instance_.stream->origins[v - ofMesh()];
  const std::array<float, 3> weights{1.0f - origin.weights.x - origin.weights.y, origin.weights.x,
                                     origin.weights.y};
  std::array<std::uint32_t, 3> positive{};
  std::size_t count = 0;
  for (std::uint32_t k = 0; k < 3; ++k)
    if (weights[k] > kRounding) positive[count++] = k;
  const std::size_t first = 3 * std::size_t{origin.triangle};
  if (count == 1) return {topology.points()[instance_.shape.indices[first + positive[0]]], kNone};
  if (count == 3) return {};
  // Side k runs from corner k to the next: {0, 1} is side 0, {1, 2} side 1, {0, 2} side 2.
  const std::uint32_t side = positive[0] == 0 && positive[1] == 2 ? 2 : positive[0];
  return {kNone, topology.sideEdges()[first + side]};
}

/// body(corners, triangle of the coarse mesh) for every drawn triangle, coarse ones first.
template <class Body>
void forTriangles(const RefinedInstance& instance, const Body& body) {
  const silhouette::RefinedStream& stream = *instance.stream;
  for (std::uint32_t t = 0; t < instance.shape.triangleCount(); ++t)
    if (!stream.isReplaced(t)) body(&instance.shape.indices[3 * std::size_t{t}], t);
  for (std::size_t t = 0; t < stream.triangleCount(); ++t)
    body(&stream.indices[3 * t], stream.sourceTriangles[t]);
}

/// The coarse edge that a side of a drawn triangle is part of, kNone inside.
std::uint32_t coarseEdge(const RefinedInstance& instance, std::uint32_t triangle, const Place& a,
                         const Place& b) {
  for (std::size_t side = 0; side < 3; ++side) {
    const std::uint32_t e = instance.topology->sideEdges()[3 * std::size_t{triangle} + side];
    if (a.isOn(e, *instance.topology) && b.isOn(e, *instance.topology)) return e;
  }
  return kNone;
}

/// What a coarse edge is drawn in, if it is part of the overlay.
std::optional<glm::vec4> colorOf(Overlay overlay, const OverlaySource& source, std::uint32_t edge) {
  if (overlay == Overlay::kWire) return kWireColor;
  if (edge == kNone) return std::nullopt;
  if (overlay == Overlay::kEdges)
    return source.alphas[edge] > 0.0f ? std::optional(alphaColor(source.alphas[edge])) : std::nullopt;
  return source.instance.topology->edges()[edge].isFeature() ? std::optional(kFeatureColor) : std::nullopt;
}

/// Where g changes sign between two vertices: the same bits from either triangle.
glm::vec3 contourPoint(const OverlaySource& source, const DrawnVertices& vertices, std::uint32_t a,
                       std::uint32_t b) {
  if (before(vertices.position(b), vertices.position(a))) std::swap(a, b);
  const glm::vec3 &p = vertices.position(a), &q = vertices.position(b);
  const float t = silhouette::contourParameter(source.view, {p, q}, {vertices.normal(a), vertices.normal(b)},
                                               glm::vec3(0.0f));
  return (1.0f - t) * p + t * q;
}

}  // namespace

void OverlayLines::clear() {
  points_.clear();
  colors_.clear();
  groups_.clear();
}

void OverlayLines::addLine(const glm::vec3& p, const glm::vec3& q, const glm::vec4& color) {
  found_.push_back({before(q, p) ? std::array{q, p} : std::array{p, q}, color});
}

void OverlayLines::addEdges(Overlay overlay, const OverlaySource& source) {
  const RefinedInstance& instance = source.instance;
  const DrawnVertices vertices(instance);
  forTriangles(instance, [&](const std::uint32_t* corner, std::uint32_t triangle) {
    const std::array places{vertices.place(corner[0]), vertices.place(corner[1]), vertices.place(corner[2])};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const std::uint32_t edge = coarseEdge(instance, triangle, places[k], places[next]);
      if (const std::optional<glm::vec4> color = colorOf(overlay, source, edge))
        addLine(vertices.position(corner[k]), vertices.position(corner[next]), *color);
    }
  });
}

void OverlayLines::addContour(const OverlaySource& source) {
  const DrawnVertices vertices(source.instance);
  if (source.method == silhouette::Method::kCurves) {
    for (const silhouette::ContourLine& line : source.instance.stream->contour)
      addLine(vertices.position(line.from), vertices.position(line.to),
              line.crossesTriangle ? kContourColor : kBridgeColor);
    return;
  }
  forTriangles(source.instance, [&](const std::uint32_t* corner, std::uint32_t) {
    std::array<bool, 3> seen{};
    for (std::size_t k = 0; k < 3; ++k)
      seen[k] =
          silhouette::facing(source.view, vertices.position(corner[k]), vertices.normal(corner[k])) >= 0.0f;
    if (seen[0] == seen[1] && seen[1] == seen[2]) return;
    const std::size_t lone = seen[1] == seen[2] ? 0 : seen[2] == seen[0] ? 1 : 2;
    addLine(contourPoint(source, vertices, corner[lone], corner[(lone + 1) % 3]),
            contourPoint(source, vertices, corner[lone], corner[(lone + 2) % 3]), kContourColor);
  });
}

void OverlayLines::add(Overlay overlay, const OverlaySource& source) {
  require(overlay != Overlay::kEdges || source.alphas.size() == source.instance.topology->edges().size(),
          "edges are coloured by the α of each");
  found_.clear();
  if (overlay == Overlay::kContour)
    addContour(source);
  else
    addEdges(overlay, source);
  // Two triangles share an edge, and lines that are drawn twice are darker. Colours decide ties so that the picture does
  // not depend on the order of triangles.
  const auto key = [](const Line& l) {
    return std::tie(l.ends[0].x, l.ends[0].y, l.ends[0].z, l.ends[1].x, l.ends[1].y, l.ends[1].z, l.color.x);
  };
  std::sort(found_.begin(), found_.end(), [&](const Line& a, const Line& b) { return key(a) < key(b); });
  const auto end = std::unique(found_.begin(), found_.end(),
                               [](const Line& a, const Line& b) { return a.ends == b.ends; });
  const Group group{colors_.size(), static_cast<std::size_t>(end - found_.begin()), source.view.modelToView,
                    kWidths[static_cast<std::size_t>(overlay)]};
  for (std::size_t i = 0; i < group.count; ++i) {
    points_.insert(points_.end(), found_[i].ends.begin(), found_[i].ends.end());
    colors_.push_back(found_[i].color);
  }
  if (group.count > 0) groups_.push_back(group);
}

std::span<const raster::Lines> OverlayLines::lines() {
  lines_.clear();
  for (const Group& group : groups_)
    lines_.push_back({std::span(points_).subspan(2 * group.first, 2 * group.count),
                      std::span(colors_).subspan(group.first, group.count), group.modelToView, group.width});
  return lines_;
}

}  // namespace limn::scene
