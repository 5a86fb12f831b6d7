// Based on: I. Sutherland, G. Hodgman, "Reentrant polygon clipping", 1974; J. Blinn, M. Newell, "Clipping
// using homogeneous coordinates", 1978; M. Olano, T. Greer, "Triangle scan conversion using 2D homogeneous
// coordinates", 1997 (planes). Differs in: every cut is computed from the inner towards the outer end of its
// edge, so two triangles that share the edge get the same point. Side planes lie kGuardPixels outside the
// window. A part interpolates by the planes of the whole triangle, which its own corners, snapped and cut far
// outside the window, would give badly.
#include "raster/clip.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "raster/numbers.h"

namespace limn::raster {
namespace {

struct ClipVertex {
  glm::dvec3 view;
  glm::dvec3 weights;
};

constexpr int kPlanes = 6, kMaxVertices = 3 + kPlanes;  // each plane adds one at most

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
      return map.farPlane + p.z;
    case 2:
      return p.x * scaleX + w * halfX;
    case 3:
      return w * halfX - p.x * scaleX;
    case 4:
      return p.y * scaleY + w * halfY;
    default:
      return w * halfY - p.y * scaleY;
  }
}

// Whether anything was cut off.
bool clip(int plane, const ScreenMap& map, Polygon& polygon) {
  Polygon out;
  bool cut = false;
  for (int i = 0; i < polygon.count; ++i) {
    const ClipVertex& a = polygon.v[static_cast<std::size_t>(i)];
    const ClipVertex& b = polygon.v[static_cast<std::size_t>((i + 1) % polygon.count)];
    const double da = distance(plane, a.view, map), db = distance(plane, b.view, map);
    if (da >= 0.0)
      out.v[static_cast<std::size_t>(out.count++)] = a;
    else
      cut = true;
    if ((da >= 0.0) == (db >= 0.0)) continue;
    const ClipVertex &in = da >= 0.0 ? a : b, &outside = da >= 0.0 ? b : a;
    const double din = std::max(da, db), t = din / (din - std::min(da, db));
    out.v[static_cast<std::size_t>(out.count++)] = {in.view + (outside.view - in.view) * t,
                                                    in.weights + (outside.weights - in.weights) * t};
  }
  polygon = out;
  return cut;
}

// The triangle that is cut.
struct Whole {
  std::array<glm::dvec3, 3> view, normals;
};

// q times the weights of the whole triangle's corners as planes over the window: with (x, y, w) of the corners as
// columns of M, they are M^-1 (x, y, 1), x and y being the window's view-space coordinates at w = 1.
class WeightPlanes {
 public:
  WeightPlanes(const Whole& whole, const ScreenMap& map) : map_(map) {
    std::array<glm::dvec3, 3> column;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3& p = whole.view[k];
      column[k] = {p.x, p.y, map.perspective ? -p.z : 1.0};
    }
    for (std::size_t k = 0; k < 3; ++k) rows_[k] = glm::cross(column[(k + 1) % 3], column[(k + 2) % 3]);
    determinant_ = glm::dot(column[0], rows_[0]);
  }
  bool exist() const { return determinant_ != 0.0; }
  glm::dvec3 at(std::int32_t x, std::int32_t y) const {
    const glm::dvec3 ray((x - 0.5 * kSubpixels * map_.width) / map_.scaleX,
                         (y - 0.5 * kSubpixels * map_.height) / map_.scaleY, 1.0);
    return glm::dvec3(glm::dot(rows_[0], ray), glm::dot(rows_[1], ray), glm::dot(rows_[2], ray)) /
           determinant_;
  }

 private:
  const ScreenMap& map_;
  std::array<glm::dvec3, 3> rows_;
  double determinant_;
};

// What the k-th anchor holds, from the weights of the corners times q there.
void setAnchorValues(const Whole& whole, const ScreenMap& map, const glm::dvec3& weights, std::size_t k,
                     LooseTriangle& t) {
  t.weights[k] = glm::vec3(weights);
  const glm::dvec3 normal =
      whole.normals[0] * weights.x + whole.normals[1] * weights.y + whole.normals[2] * weights.z;
  for (int axis = 0; axis < 3; ++axis) t.plane[k][axis] = static_cast<float>(normal[axis]);
  const double z = whole.view[0].z * weights.x + whole.view[1].z * weights.y + whole.view[2].z * weights.z;
  t.plane[k][3] = static_cast<float>(map.perspective ? weights.x + weights.y + weights.z
                                                     : z * map.depthScale + map.depthOffset);
}

// What the k-th corner holds; at a corner of the whole triangle the same, bit for bit, as in its cluster.
void setCornerValues(const Whole& whole, const glm::dvec3& weights, const ScreenVertex& corner, std::size_t k,
                     LooseTriangle& t) {
  const glm::vec3 w(weights);
  t.weights[k] = w * corner.q;
  for (int axis = 0; axis < 3; ++axis) {
    const std::array<glm::dvec3, 3>& n = whole.normals;
    const float value = (static_cast<float>(n[0][axis]) * w.x + static_cast<float>(n[1][axis]) * w.y) +
                        static_cast<float>(n[2][axis]) * w.z;
    t.plane[k][axis] = value * corner.q;
  }
  t.plane[k][3] = corner.depth;
}

// The corners of what is left of a triangle on the grid.
struct Outline {
  std::array<ScreenVertex, kMaxVertices> v;
  int count = 0;

  Outline(const Polygon& polygon, const ScreenMap& map) : count(polygon.count) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      glm::vec3 view(polygon.v[i].view);
      view.z = std::min(view.z, -map.nearPlane);
      v[i] = map.project(view);
    }
  }
  // Lower than half a pixel: the whole triangle's planes, steep across it, mean nothing on its snapped outline.
  bool isSliver() const {
    double area = 0.0, longest = 0.0;
    for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i) {
      const double ex = v[i].x - v[0].x, ey = v[i].y - v[0].y;
      longest = std::max(longest, ex * ex + ey * ey);
      if (i > 1) area += ex * (v[i - 1].y - v[0].y) - ey * (v[i - 1].x - v[0].x);
    }
    return area * area < longest * (kSubpixels * kSubpixels / 4.0);
  }
  // Three points about the part within the window, for planes to be given at; false if there is no such part.
  bool findAnchors(const ScreenMap& map, Corners& anchors) const {
    std::int32_t x0 = v[0].x, y0 = v[0].y, x1 = x0, y1 = y0;
    for (std::size_t i = 1; i < static_cast<std::size_t>(count); ++i) {
      x0 = std::min(x0, v[i].x), x1 = std::max(x1, v[i].x);
      y0 = std::min(y0, v[i].y), y1 = std::max(y1, v[i].y);
    }
    x0 = std::max(x0, 0), x1 = std::min(x1, map.width * kSubpixels);
    y0 = std::max(y0, 0), y1 = std::min(y1, map.height * kSubpixels);
    if (x0 > x1 || y0 > y1) return false;
    x1 = std::max(x1, x0 + kSubpixels), y1 = std::max(y1, y0 + kSubpixels);
    anchors = {{x0, x1, x0}, {y0, y0, y1}};
    return true;
  }
};

}  // namespace

void clipTriangle(const Batch& batch, const TriangleRef& ref, const ScreenMap& map,
                  std::vector<LooseTriangle>& out) {
  const Cluster& cluster = batch.set->clusters[ref.cluster];
  Whole whole;
  Polygon polygon;
  polygon.count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t i = cluster.firstVertex + batch.set->corners[k][cluster.firstTriangle + ref.triangle];
    const glm::vec3 view = viewPosition(batch, i);
    if (!isFinite(view)) return;
    whole.view[k] = glm::dvec3(view);
    whole.normals[k] = glm::dvec3(viewNormal(batch, i));
    glm::dvec3 weights(0.0);
    weights[static_cast<int>(k)] = 1.0;
    polygon.v[k] = {whole.view[k], weights};
  }
  bool cut = false;
  for (int plane = 0; plane < kPlanes && polygon.count > 0; ++plane) cut |= clip(plane, map, polygon);
  if (polygon.count == 0) return;
  const Outline outline(polygon, map);
  const WeightPlanes planes(whole, map);
  LooseTriangle t;
  t.ref = ref;
  if (!outline.findAnchors(map, t.anchors)) return;
  t.cut = cut && planes.exist() && !outline.isSliver();
  if (t.cut) {
    for (std::size_t k = 0; k < 3; ++k)
      setAnchorValues(whole, map, planes.at(t.anchors.x[k], t.anchors.y[k]), k, t);
  }
  for (int i = 2; i < outline.count; ++i) {
    const std::array<int, 3> part{0, i - 1, i};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto c = static_cast<std::size_t>(part[k]);
      const ScreenVertex& corner = outline.v[c];
      t.corners.x[k] = corner.x, t.corners.y[k] = corner.y;
      if (!t.cut) setCornerValues(whole, polygon.v[c].weights, corner, k, t);
    }
    out.push_back(t);
  }
}

}  // namespace limn::raster
