#include "silhouette/ring_curvature.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace limn::silhouette {
namespace {

using glm::dot;
using glm::vec3;

constexpr float kShortest = 1e-6f;  // in mean edges: shorter ones tell of roundings
constexpr float kSteepest = 1e-3f;  // share of its length that an edge has in the plane at least
constexpr double kFlatness = 0.02;  // how much the form is drawn to 0
constexpr std::size_t kPointsPerBlock = 4096;

}  // namespace

RingCurvature::Frame RingCurvature::frameOf(const vec3& up) {
  const vec3 across = std::fabs(up.x) < std::fabs(up.y) ? vec3(0.0f, -up.z, up.y) : vec3(up.z, 0.0f, -up.x);
  const float across2 = dot(across, across);
  if (!(across2 > 0.0f)) return {};
  const vec3 u = across / std::sqrt(across2);
  return {u, glm::cross(up, u) / std::sqrt(dot(up, up))};
}

// The unit direction of e in the plane; zero where e stands on it.
glm::vec2 RingCurvature::directionOf(const vec3& e, const Frame& frame) {
  const glm::vec2 d(dot(e, frame.u), dot(e, frame.v));
  const float length2 = dot(d, d);
  return length2 > kSteepest * kSteepest * dot(e, e) ? d / std::sqrt(length2) : glm::vec2(0.0f);
}

void RingCurvature::prepare(const Mesh& mesh, const Topology& topology, const std::vector<vec3>& ups,
                            const std::vector<std::uint8_t>& wanted, const Crew& crew) {
  const auto vectorOf = [&](const Edge& edge, const std::array<std::uint32_t, 2>& ends) {
    return edge.boundary ? vec3(0.0f) : mesh.positions[ends[1]] - mesh.positions[ends[0]];
  };
  double length = 0.0;
  for (const Edge& edge : topology.edges())
    length += glm::length(glm::dvec3(vectorOf(edge, edgeVertices(mesh, edge)[0])));
  scale_ = length > 0.0 ? static_cast<float>(static_cast<double>(topology.edges().size()) / length) : 0.0f;

  frames_.resize(topology.pointCount());
  crew.forBlocks(frames_.size(), kPointsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) frames_[p] = frameOf(ups[p]);
  });
  sums_.assign(topology.pointCount(), {});
  for (const Edge& edge : topology.edges()) {
    const std::array<std::uint32_t, 2> ends = edgeVertices(mesh, edge)[0];
    const vec3 e = scale_ * vectorOf(edge, ends), difference = mesh.normals[ends[1]] - mesh.normals[ends[0]];
    for (const std::uint32_t point : edge.point)
      if (wanted[point] != 0) add(sums_[point], frames_[point], e, difference);
  }
  crew.forBlocks(sums_.size(), kPointsPerBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) solve(sums_[p]);
  });
}

void RingCurvature::add(Sums& sums, const Frame& frame, const vec3& e, const vec3& difference) {
  const float length2 = dot(e, e);
  const glm::vec2 d = directionOf(e, frame);
  if (!(length2 > kShortest * kShortest) || d == glm::vec2(0.0f)) return;
  const float weight = 1.0f / length2, curvature = dot(difference, e) / length2;
  const float x = d.x * d.x, y = 2.0f * d.x * d.y, z = d.y * d.y;
  const Sums own = {x * x, x * y, x * z, y * z, z * z, x * curvature, y * curvature, z * curvature};
  for (std::size_t k = 0; k < own.size(); ++k) sums[k] += weight * own[k];
}

// Of the symmetric equations (xx xy xz; xy yy yz; xz yz zz) with yy = 4 xz, by cofactors.
void RingCurvature::solve(Sums& sums) {
  const double xz = sums[2];
  // The weights' sum, since (u² + v²)² = 1. |(a b; b c)|² = a² + 2 b² + c².
  const double ridge = kFlatness * (sums[0] + 2.0 * xz + sums[4]);
  const double xx = sums[0] + ridge, yy = 4.0 * xz + 2.0 * ridge, zz = sums[4] + ridge, xy = sums[1],
               yz = sums[3];
  const double p = yy * zz - yz * yz, q = xz * yz - xy * zz, r = xy * yz - xz * yy;
  const double s = xx * zz - xz * xz, t = xy * xz - xx * yz, w = xx * yy - xy * xy;
  const double determinant = xx * p + xy * q + xz * r, f = sums[5], g = sums[6], h = sums[7];
  if (!(determinant > 0.0)) {
    sums = {};
    return;
  }
  sums[0] = static_cast<float>((p * f + q * g + r * h) / determinant);
  sums[1] = static_cast<float>((q * f + s * g + t * h) / determinant);
  sums[2] = static_cast<float>((r * f + t * g + w * h) / determinant);
}

float RingCurvature::turn(std::uint32_t point, const vec3& e) const {
  const Sums& form = sums_[point];
  const vec3 scaled = scale_ * e;
  const glm::vec2 d = directionOf(scaled, frames_[point]);
  const float curvature = d.x * d.x * form[0] + 2.0f * d.x * d.y * form[1] + d.y * d.y * form[2];
  return std::fabs(curvature) * glm::length(scaled);
}

}  // namespace limn::silhouette
