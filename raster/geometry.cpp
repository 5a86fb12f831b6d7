#include "raster/base/check.h"
#include "raster/cluster.h"
#include "raster/validate.h"

namespace limn::raster {

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

}  // namespace limn::raster
