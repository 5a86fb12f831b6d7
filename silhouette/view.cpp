#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "raster/base/check.h"
#include "silhouette/mesh.h"

namespace limn::silhouette {
namespace {

bool isFinite(const glm::dmat4& matrix) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(matrix[column][row])) return false;
  return true;
}

}  // namespace

View makeView(const Projection& projection, const glm::dmat4& modelToView) {
  require(isFinite(modelToView), "the matrix must be finite");
  const glm::dmat3 linear(modelToView);
  const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  require(std::abs(glm::determinant(linear)) > 1e-12 * volume, "the matrix must not be singular");

  // The eye is the view space's origin, the direction its -z axis.
  const glm::dmat3 inverse = glm::inverse(linear);
  View view;
  view.projection = projection;
  view.modelToView = glm::mat4(modelToView);
  view.eye = glm::vec3(-(inverse * glm::dvec3(modelToView[3])));
  view.direction = glm::vec3(glm::normalize(-inverse[2]));
  return view;
}

}  // namespace limn::silhouette
