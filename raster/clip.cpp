// Based on: I. Sutherland, G. Hodgman, "Reentrant polygon clipping", 1974; J. Blinn, M. Newell, "Clipping
// using homogeneous coordinates", 1978. Differs in: every cut is computed from the inner towards the outer
// end of its edge, so two triangles that share the edge get the same point. Side planes lie kGuardPixels
// outside the window; the far plane is left to the depth test.
#include "raster/clip.h"

#include <algorithm>
#include <array>

namespace limn::raster {
namespace {

struct ClipVertex {
  glm::dvec3 view;
  glm::dvec3 weights;
};

constexpr int kMaxVertices = 3 + 5;  // each of the five planes adds one at most

struct Polygon {
  std::array<ClipVertex, kMaxVertices> v;
  int count = 0;
};

// Signed distances to the planes, in homogeneous coordinates; >= 0 is inside.
double distance(int plane, const glm::dvec3& p, const ScreenMap& map) {
  const double w = map.perspective ? -p.z : 1.0;
  const double halfX = 0.5 * map.width + kGuardPixels - 1.0, halfY = 0.5 * map.height + kGuardPixels - 1.0;
  const double scaleX = map.scaleX / kSubpixels, scaleY = map.scaleY / kSubpixels;
  switch (plane) {
    case 0:
      return -p.z - map.nearPlane;
    case 1:
      return p.x * scaleX + w * halfX;
    case 2:
      return w * halfX - p.x * scaleX;
    case 3:
      return p.y * scaleY + w * halfY;
    default:
      return w * halfY - p.y * scaleY;
  }
}

void clip(int plane, const ScreenMap& map, Polygon& polygon) {
  Polygon out;
  for (int i = 0; i < polygon.count; ++i) {
    const ClipVertex& a = polygon.v[static_cast<std::size_t>(i)];
    const ClipVertex& b = polygon.v[static_cast<std::size_t>((i + 1) % polygon.count)];
    const double da = distance(plane, a.view, map), db = distance(plane, b.view, map);
    if (da >= 0.0) out.v[static_cast<std::size_t>(out.count++)] = a;
    if ((da >= 0.0) == (db >= 0.0)) continue;
    const ClipVertex &in = da >= 0.0 ? a : b, &outside = da >= 0.0 ? b : a;
    const double din = std::max(da, db), t = din / (din - std::min(da, db));
    out.v[static_cast<std::size_t>(out.count++)] = {in.view + (outside.view - in.view) * t,
                                                    in.weights + (outside.weights - in.weights) * t};
  }
  polygon = out;
}

}  // namespace

Box boxOf(const LooseTriangle& t) {
  return {std::min({t.x[0], t.x[1], t.x[2]}), std::min({t.y[0], t.y[1], t.y[2]}),
          std::max({t.x[0], t.x[1], t.x[2]}), std::max({t.y[0], t.y[1], t.y[2]})};
}

void clipTriangle(const Batch& batch, const TriangleRef& ref, const ScreenMap& map,
                  std::vector<LooseTriangle>& out) {
  const Cluster& cluster = batch.set->clusters[ref.cluster];
  std::array<glm::vec3, 3> normals;
  Polygon polygon;
  polygon.count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t i = cluster.firstVertex + batch.set->corners[k][cluster.firstTriangle + ref.triangle];
    normals[k] = viewNormal(batch, i);
    glm::dvec3 weights(0.0);
    weights[static_cast<int>(k)] = 1.0;
    polygon.v[k] = {glm::dvec3(viewPosition(batch, i)), weights};
  }
  for (int plane = 0; plane < 5 && polygon.count > 0; ++plane) clip(plane, map, polygon);

  const auto corner = [&](LooseTriangle& t, int k, int i) {
    const ClipVertex& p = polygon.v[static_cast<std::size_t>(i)];
    glm::vec3 view(p.view);
    view.z = std::min(view.z, -map.nearPlane);
    const ScreenVertex v = map.project(view);
    t.x[k] = v.x, t.y[k] = v.y;
    t.weights[k] = glm::vec3(p.weights);
    for (int axis = 0; axis < 3; ++axis)
      t.plane[k][axis] = ((normals[0][axis] * t.weights[k].x + normals[1][axis] * t.weights[k].y) +
                          normals[2][axis] * t.weights[k].z) *
                         v.q;
    t.plane[k][3] = v.depth;
  };
  for (int i = 2; i < polygon.count; ++i) {
    LooseTriangle t;
    t.ref = ref;
    corner(t, 0, 0);
    corner(t, 1, i - 1);
    corner(t, 2, i);
    out.push_back(t);
  }
}

}  // namespace limn::raster
