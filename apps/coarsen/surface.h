// The fine surface: welded triangles, and the point of them that is closest to a given one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace limn::coarsen {

using Index = std::uint32_t;
inline constexpr Index kNone = 0xffffffffu;

/// Triangles over welded points. Triangles that repeat a point are left out.
struct Surface {
  std::vector<glm::dvec3> points;
  std::vector<Index> corners;       ///< three points per triangle
  std::vector<Index> triangles;     ///< where each came from in the source mesh
  std::vector<glm::dvec3> normals;  ///< unit, per triangle; zero for one without area
  std::vector<double> areas;
  std::vector<std::array<Index, 2>> lines;  ///< boundaries and creases: pairs of points

  std::size_t triangleCount() const { return corners.size() / 3; }
  glm::dvec3 point(std::size_t triangle, int corner) const {
    return points[corners[3 * triangle + static_cast<std::size_t>(corner)]];
  }
};

/// Welds by position, bit for bit; creases are where the vertex normals of two faces differ by more than a degree.
/// `pointOf` (optional) gets the point of every vertex.
Surface makeSurface(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                    std::span<const Index> indices, std::vector<Index>* pointOf = nullptr);

/// Where a query touched a surface.
struct Touch {
  std::size_t triangle = 0;
  std::array<double, 3> weights{};  ///< of the triangle's corners
  glm::dvec3 point{0.0};
  double distance2 = std::numeric_limits<double>::infinity();
};

/// A bounding-volume hierarchy over triangles (or over line segments, as triangles whose last two corners agree).
class ClosestPoint {
 public:
  ClosestPoint(std::span<const glm::dvec3> points, std::span<const Index> corners);

  /// The closest point of all triangles whose normal is on the side of `facing` (zero: all). Equal distances: whichever
  /// the hierarchy meets first, the same on every machine.
  std::optional<Touch> find(const glm::dvec3& query, const glm::dvec3& facing = glm::dvec3(0.0)) const;

 private:
  struct Node {
    glm::dvec3 low{0.0}, high{0.0};
    Index first = 0, second = 0;  ///< children, or the range of a leaf
    bool leaf = false;
  };
  Index build(std::span<const glm::dvec3> centers, Index begin, Index end);

  std::span<const glm::dvec3> points_;
  std::span<const Index> corners_;
  std::vector<glm::dvec3> normals_;  // not unit
  std::vector<Node> nodes_;
  std::vector<Index> order_;
};

}  // namespace limn::coarsen
