// A tetrahedron's refined stream.
#include <array>
#include <cstdio>

#include "silhouette/refine.h"

int main() {
  using namespace limn;
  const std::array<glm::vec3, 4> positions = {{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}};
  std::array<glm::vec3, 4> normals;
  for (std::size_t i = 0; i < 4; ++i) normals[i] = positions[i] * 0.57735f;
  const std::array<std::uint32_t, 12> indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const silhouette::Mesh mesh{positions, normals, indices};
  Workers workers(2);
  const silhouette::Topology topology(mesh);
  silhouette::Refiner refiner(mesh, topology, workers);
  Projection projection;
  projection.pixelsX = projection.pixelsY = 500;
  projection.nearPlane = 1;
  projection.farPlane = 10;
  projection.width = projection.height = 256;
  glm::dmat4 modelToView(1.0);
  modelToView[3].z = -5;
  silhouette::Parameters parameters;
  parameters.method = silhouette::Method::kPn;
  silhouette::RefinedStream stream;
  refiner.refine(silhouette::makeView(projection, modelToView), parameters, stream);
  std::printf("%zu triangles\n", stream.triangleCount());
  return stream.isConsistent(mesh) && stream.triangleCount() > 0 ? 0 : 1;
}
