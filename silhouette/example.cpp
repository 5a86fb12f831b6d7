// How another renderer uses silhouette/: a coarse sphere, one view, painted far to near as SVG on standard output.
//
//   limn_silhouette_example > sphere.svg
//
// Nothing of limn but this module is needed: arrays in, arrays out.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "silhouette/refine.h"

namespace {

using glm::vec3;
using namespace limn::silhouette;

struct Triangle {
  vec3 corners[3];  // in view space
  float depth() const { return -(corners[0].z + corners[1].z + corners[2].z); }
};

// A sphere of 8 by 5 quads, its poles cut off: 80 triangles with smooth normals.
void makeSphere(std::vector<vec3>& positions, std::vector<std::uint32_t>& indices) {
  constexpr int kAround = 8, kRows = 6;
  for (int row = 0; row < kRows; ++row) {
    for (int k = 0; k < kAround; ++k) {
      const double a = 6.283185307179586 * k / kAround, b = 3.141592653589793 * (row + 0.5) / kRows;
      positions.emplace_back(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
    }
  }
  const auto at = [](int row, int k) { return static_cast<std::uint32_t>(row * kAround + k % kAround); };
  for (int row = 0; row + 1 < kRows; ++row)
    for (int k = 0; k < kAround; ++k)
      for (const std::uint32_t index :
           {at(row, k), at(row, k + 1), at(row + 1, k + 1), at(row, k), at(row + 1, k + 1), at(row + 1, k)})
        indices.push_back(index);
}

}  // namespace

int main() {
  std::vector<vec3> positions;
  std::vector<std::uint32_t> indices;
  makeSphere(positions, indices);
  const Mesh mesh{positions, positions, indices};  // a unit sphere's normals are its positions

  // Once per mesh.
  limn::Workers workers(1);
  const Topology topology(mesh);
  Refiner refiner(mesh, topology, workers);

  // Per frame: where the mesh is seen from, and how a unit of it maps to pixels.
  limn::Projection projection;
  projection.width = projection.height = 400;
  projection.pixelsX = projection.pixelsY = 700.0f;
  projection.nearPlane = 0.1f;
  projection.farPlane = 10.0f;
  const View view = makeView(
      projection, glm::lookAt(glm::dvec3(1.0, 2.0, 3.5), glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0)));
  RefinedStream stream;
  refiner.refine(view, Parameters{}, stream);

  // Draw what was not replaced, and the stream.
  std::vector<Triangle> triangles;
  const auto add = [&](const vec3& a, const vec3& b, const vec3& c) {
    const glm::mat4& m = view.modelToView;
    triangles.push_back(
        {{vec3(m * glm::vec4(a, 1.0f)), vec3(m * glm::vec4(b, 1.0f)), vec3(m * glm::vec4(c, 1.0f))}});
  };
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    if (!stream.isReplaced(t))
      add(positions[indices[3 * t]], positions[indices[3 * t + 1]], positions[indices[3 * t + 2]]);
  const auto vertex = [&](std::uint32_t index) {
    return index < positions.size() ? positions[index] : stream.positions[index - positions.size()];
  };
  for (std::size_t t = 0; t < stream.triangleCount(); ++t)
    add(vertex(stream.indices[3 * t]), vertex(stream.indices[3 * t + 1]), vertex(stream.indices[3 * t + 2]));

  std::sort(triangles.begin(), triangles.end(),
            [](const Triangle& a, const Triangle& b) { return a.depth() > b.depth(); });
  std::printf("<svg xmlns='http://www.w3.org/2000/svg' width='400' height='400'>\n");
  for (const Triangle& triangle : triangles) {
    const vec3 *p = triangle.corners, normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    const int grey = static_cast<int>(90.0f + 150.0f * std::fabs(normal.z));
    std::printf("<polygon fill='rgb(%d,%d,%d)' stroke='#444' stroke-width='0.3' points='", grey, grey, grey);
    for (int k = 0; k < 3; ++k)
      std::printf("%.3f,%.3f ", 200.0 - p[k].x / p[k].z * 700.0, 200.0 + p[k].y / p[k].z * 700.0);
    std::printf("'/>\n");
  }
  std::printf("</svg>\n");
  return stream.isConsistent(mesh) ? 0 : 1;
}
