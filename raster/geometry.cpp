#include <cmath>

#include "raster/base/check.h"
#include "raster/cluster.h"

namespace limn::raster {
namespace {

template <class T>
bool matches(std::span<const T> optional, std::size_t count) {
  return optional.empty() || optional.size() == count;
}

void requireValid(const Vertices& v, std::span<const std::uint32_t> indices, std::span<const Part> parts) {
  const std::size_t vertices = v.positions.size();
  require(v.normals.size() == vertices, "normals must be as many as positions");
  require(matches(v.texcoords, vertices), "texcoords must be as many as positions, or none");
  require(matches(v.colors, vertices), "colors must be as many as positions, or none");
  require(matches(v.tangents, vertices), "tangents must be as many as positions, or none");
  require(indices.size() % 3 == 0, "indices must be three per triangle");
  require(vertices < 0x7fffffffU && indices.size() / 3 < 0x7fffffffU,
          "at most 2^31 - 1 vertices and triangles");
  for (const std::uint32_t i : indices) require(i < vertices, "index beyond the vertices");
  for (const glm::vec3& p : v.positions)
    require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z), "positions must be finite");
  std::size_t next = 0;
  for (const Part& part : parts) {
    require(part.firstTriangle == next, "parts must tile the triangles in order");
    next += part.triangleCount;
  }
  require(next == indices.size() / 3, "parts must cover all triangles");
}

}  // namespace

Geometry::Geometry(const Vertices& vertices, std::span<const std::uint32_t> indices,
                   std::span<const Part> parts, Keep keep) {
  requireValid(vertices, indices, parts);
  data_ = std::make_unique<Data>();
  Data& d = *data_;
  d.vertices = vertices;
  if (keep == Keep::kCopies) {
    const auto copy = [](auto& span, auto& vector) {
      vector.assign(span.begin(), span.end());
      span = vector;
    };
    copy(d.vertices.positions, d.copies.positions);
    copy(d.vertices.normals, d.copies.normals);
    copy(d.vertices.texcoords, d.copies.texcoords);
    copy(d.vertices.colors, d.copies.colors);
    copy(d.vertices.tangents, d.copies.tangents);
  }
  d.parts.assign(parts.begin(), parts.end());
  d.triangleCount = indices.size() / 3;
  if (parts.size() > 1)
    for (std::uint32_t i = 0; i < parts.size(); ++i)
      d.partOfTriangle.insert(d.partOfTriangle.end(), parts[i].triangleCount, i);

  VertexNumbers numbers;
  numbers.reserve(vertices.positions.size());
  ClusterCutter cutter(d.set, d.triangleCount,
                       numbers);  // in the order of submission, as Batch::isReplaced wants it
  for (const Part& part : parts)
    cutter.add(indices.subspan(3UL * part.firstTriangle, 3UL * part.triangleCount), part.material);
  cutter.finish();
  d.set.vertices.shrink_to_fit();
  d.set.clusters.shrink_to_fit();
  d.set.points.resize(d.set.vertices.size());
  for (std::size_t i = 0; i < d.set.vertices.size(); ++i)
    d.set.points.set(i, vertices.positions[d.set.vertices[i]], vertices.normals[d.set.vertices[i]]);
  d.set.bounds.reserve(d.set.clusters.size());
  for (const Cluster& cluster : d.set.clusters) d.set.bounds.push_back(boundTriangles(d.set, cluster));
  LIMN_ASSERT(d.set.isConsistent(), d.set.clusters.size());
}

Geometry::~Geometry() = default;
Geometry::Geometry(Geometry&&) noexcept = default;
Geometry& Geometry::operator=(Geometry&&) noexcept = default;

std::size_t Geometry::triangleCount() const {
  return data_->triangleCount;
}
std::size_t Geometry::vertexCount() const {
  return data_->vertices.positions.size();
}
std::size_t Geometry::memoryBytes() const {
  const Data& d = *data_;
  const auto& c = d.copies;
  return c.positions.capacity() * sizeof(glm::vec3) + c.normals.capacity() * sizeof(glm::vec3) +
         c.texcoords.capacity() * sizeof(glm::vec2) + c.colors.capacity() * sizeof(glm::vec4) +
         c.tangents.capacity() * sizeof(glm::vec4) + d.partOfTriangle.capacity() * sizeof(std::uint32_t) +
         d.set.memoryBytes();
}

}  // namespace limn::raster
