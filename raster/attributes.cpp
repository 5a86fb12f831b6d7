// Interpolation planes of texture coordinates, colours and tangents: only for triangles that are seen.
#include <algorithm>
#include <array>
#include <cmath>

#include "raster/tile.h"

namespace limn::raster {
namespace {

struct VertexAttributes {
  glm::vec2 texcoord{0.0F};
  glm::vec4 color{1.0F};
  glm::vec4 tangent{0.0F};
};

// Of a vertex of the draw: the geometry's, or the stream's beyond them.
VertexAttributes rawAttributes(const Draw& draw, std::uint32_t vertex) {
  const Vertices& g = draw.geometry->data().vertices;
  VertexAttributes a;
  if (vertex < g.positions.size()) {
    if (!g.texcoords.empty()) a.texcoord = g.texcoords[vertex];
    if (!g.colors.empty()) a.color = g.colors[vertex];
    if (!g.tangents.empty())
      a.tangent = draw.posedTangents.empty() ? g.tangents[vertex] : draw.posedTangents[vertex];
    return a;
  }
  const Vertices& v = draw.stream.vertices;
  const std::size_t i = vertex - g.positions.size();
  if (!v.texcoords.empty()) a.texcoord = v.texcoords[i];
  if (!v.colors.empty()) a.color = v.colors[i];
  if (!v.tangents.empty()) a.tangent = v.tangents[i];
  return a;
}

VertexAttributes attributesOfVertex(const Draw& draw, std::uint32_t vertex, const Material& m) {
  VertexAttributes a = rawAttributes(draw, vertex);
  const glm::vec2 t = a.texcoord;
  const glm::vec3 &r = m.texcoordRow0, &s = m.texcoordRow1;
  a.texcoord = {(r.x * t.x + r.y * t.y) + r.z, (s.x * t.x + s.y * t.y) + s.z};
  return a;
}

// For a triangle without tangents: the direction in which u grows on it, and the handedness that lets the bitangent
// run against v, as glTF's normal maps expect (their green axis points up, v points down).
void makeTangents(const Batch& batch, const Cluster& cluster, const TriangleRef& ref,
                  std::array<VertexAttributes, 3>& vertex) {
  std::array<glm::vec3, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = cluster.firstVertex + batch.set->corners[k][cluster.firstTriangle + ref.triangle];
    p[k] = {batch.points->x[i], batch.points->y[i], batch.points->z[i]};
  }
  const float u1 = vertex[1].texcoord.x - vertex[0].texcoord.x,
              v1 = vertex[1].texcoord.y - vertex[0].texcoord.y;
  const float u2 = vertex[2].texcoord.x - vertex[0].texcoord.x,
              v2 = vertex[2].texcoord.y - vertex[0].texcoord.y;
  const float area = u1 * v2 - u2 * v1, sign = area < 0.0F ? -1.0F : 1.0F;
  glm::vec3 t;
  for (int i = 0; i < 3; ++i) t[i] = ((p[1][i] - p[0][i]) * v2 - (p[2][i] - p[0][i]) * v1) * sign;
  const float square = (t.x * t.x + t.y * t.y) + t.z * t.z;
  const float scale = 1.0F / std::sqrt(std::max(square, 1e-37F));
  for (VertexAttributes& a : vertex) a.tangent = {t.x * scale, t.y * scale, t.z * scale, -sign};
}

using Values = std::array<float, Attributes::kCount>;

Values valuesOf(const VertexAttributes& a, const Affine& toView) {
  const auto turned = [&](int i) {
    return (toView.m[i][0] * a.tangent.x + toView.m[i][1] * a.tangent.y) + toView.m[i][2] * a.tangent.z;
  };
  return {a.texcoord.x, a.texcoord.y, a.color.x, a.color.y, a.color.z,
          a.color.w,    turned(0),    turned(1), turned(2)};
}

}  // namespace

void setTexcoords(const Batch& batch, const Cluster& cluster, const Material& material, bool perspective,
                  VertexBlock& block) {
  for (std::size_t i = 0; i < cluster.vertexCount; ++i) {
    const std::uint32_t vertex = batch.set->vertices[cluster.firstVertex + i];
    const glm::vec2 texcoord = attributesOfVertex(*batch.draw, vertex, material).texcoord;
    const float q = perspective ? block.plane[i][3] : 1.0F;
    block.texcoord[i][0] = texcoord.x * q, block.texcoord[i][1] = texcoord.y * q;
  }
}

const Attributes& attributesOf(Tile& tile, Record& record) {
  if (record.attributes != kNoRecord) return tile.attributes[record.attributes];
  const FrameContext& context = *tile.context;
  const TriangleRef ref = tile.refOf(record);
  const Batch& batch = context.batches[ref.batch];
  const ClusterSet& set = *batch.set;
  const Cluster& cluster = set.clusters[ref.cluster];
  const bool isLoose = (record.source & Record::kLoose) != 0;
  const LooseTriangle* loose = isLoose ? &context.front.loose(record.source & ~Record::kLoose) : nullptr;
  const VertexBlock* block = isLoose ? nullptr : &tile.blocks[record.source / kClusterTriangles];

  const Material& material = context.frame.materials[cluster.material];
  std::array<VertexAttributes, 3> vertex;
  std::array<Values, 3> corner;
  std::array<float, 3> q;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint8_t local = set.corners[k][cluster.firstTriangle + ref.triangle];
    vertex[k] = attributesOfVertex(*batch.draw, set.vertices[cluster.firstVertex + local], material);
    q[k] =
        isLoose || !context.map.perspective ? 1.0F : block->plane[local][3];  // a loose one's weights hold it
  }
  if (material.normalTexture != nullptr && vertex[0].tangent.w == 0.0F)
    makeTangents(batch, cluster, ref, vertex);
  for (std::size_t k = 0; k < 3; ++k) corner[k] = valuesOf(vertex[k], batch.toView);
  if (isLoose) {
    const std::array<Values, 3> whole = corner;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < Attributes::kCount; ++i)
        corner[k][i] = (whole[0][i] * loose->weights[k].x + whole[1][i] * loose->weights[k].y) +
                       whole[2][i] * loose->weights[k].z;
  }

  std::array<int, 3> order;
  const Corners corners = tile.cornersOf(record, order);
  Attributes result{};
  result.handedness = batch.mirrored ? -vertex[0].tangent.w : vertex[0].tangent.w;
  result.isBackFace = (order[1] == 1) != batch.mirrored;
  const bool cut = isLoose && loose->cut;
  if (cut) order = {0, 1, 2};
  const PlaneBasis basis(cut ? loose->anchors : corners);
  const auto a = static_cast<std::size_t>(order[0]), b = static_cast<std::size_t>(order[1]),
             c = static_cast<std::size_t>(order[2]);
  // Texture coordinates first; colours and tangents where anything reads them.
  const std::size_t count = material.normalTexture != nullptr                  ? Attributes::kCount
                            : tile.surfaceOf(ref.batch, ref.cluster).hasColors ? Attributes::kTangentX
                                                                               : Attributes::kRed;
  for (std::size_t i = 0; i < count; ++i) {
    const float va = corner[a][i] * q[a], vb = corner[b][i] * q[b], vc = corner[c][i] * q[c];
    const Slopes s = basis.slopes(va, vb, vc);
    result.origin[i] = va, result.slopeX[i] = s.x, result.slopeY[i] = s.y;
  }
  record.attributes = static_cast<std::uint32_t>(tile.attributes.size());
  tile.attributes.push_back(result);
  return tile.attributes.back();
}

}  // namespace limn::raster
