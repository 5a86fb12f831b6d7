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
                   std::span<const Part> parts) {
  requireValid(vertices, indices, parts);
  data_ = std::make_unique<Data>();
  Data& d = *data_;
  d.positions.assign(vertices.positions.begin(), vertices.positions.end());
  d.normals.assign(vertices.normals.begin(), vertices.normals.end());
  d.texcoords.assign(vertices.texcoords.begin(), vertices.texcoords.end());
  d.colors.assign(vertices.colors.begin(), vertices.colors.end());
  d.tangents.assign(vertices.tangents.begin(), vertices.tangents.end());
  d.parts.assign(parts.begin(), parts.end());
  d.triangleCount = indices.size() / 3;
  if (parts.size() > 1)
    for (std::uint32_t i = 0; i < parts.size(); ++i)
      d.partOfTriangle.insert(d.partOfTriangle.end(), parts[i].triangleCount, i);

  VertexNumbers numbers;
  numbers.reserve(d.positions.size());
  ClusterCutter cutter(d.set, d.triangleCount,
                       numbers);  // in the order of submission, as Batch::isReplaced wants it
  for (const Part& part : parts)
    cutter.add(indices.subspan(3UL * part.firstTriangle, 3UL * part.triangleCount), part.firstTriangle,
               part.material);
  cutter.finish();
  d.set.points.resize(d.set.vertices.size());
  for (std::size_t i = 0; i < d.set.vertices.size(); ++i)
    d.set.points.set(i, d.positions[d.set.vertices[i]], d.normals[d.set.vertices[i]]);
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
  return data_->positions.size();
}
std::size_t Geometry::memoryBytes() const {
  const Data& d = *data_;
  return d.positions.capacity() * sizeof(glm::vec3) + d.normals.capacity() * sizeof(glm::vec3) +
         d.texcoords.capacity() * sizeof(glm::vec2) + d.colors.capacity() * sizeof(glm::vec4) +
         d.tangents.capacity() * sizeof(glm::vec4) + d.partOfTriangle.capacity() * sizeof(std::uint32_t) +
         d.set.memoryBytes();
}

}  // namespace limn::raster
