#include "shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <random>
#include <utility>

namespace limn::silhouette::test {
namespace {

using glm::vec3;

constexpr double kTurn = 6.283185307179586;

void quad(Shape& shape, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool other) {
  if (other)
    shape.indices.insert(shape.indices.end(), {a, b, d, b, c, d});
  else
    shape.indices.insert(shape.indices.end(), {a, b, c, a, c, d});
}

std::uint32_t add(Shape& shape, const vec3& position, const vec3& normal) {
  shape.positions.push_back(position);
  shape.normals.push_back(normal);
  return static_cast<std::uint32_t>(shape.positions.size() - 1);
}

void divide(Shape& shape) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), 0);
    if (fresh) {
      const vec3 p = glm::normalize(shape.positions[a] + shape.positions[b]);
      it->second = add(shape, p, p);
    }
    return it->second;
  };
  std::vector<std::uint32_t> indices;
  for (std::size_t t = 0; t < shape.indices.size(); t += 3) {
    const std::uint32_t a = shape.indices[t], b = shape.indices[t + 1], c = shape.indices[t + 2];
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    indices.insert(indices.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
  }
  shape.indices = std::move(indices);
}

}  // namespace

Shape icosphere(int level) {
  Shape shape{"icosphere:" + std::to_string(level), {}, {}, {}};
  const float g = (1.0f + std::sqrt(5.0f)) / 2.0f;
  const std::array<vec3, 12> corners = {{{-1, g, 0},
                                         {1, g, 0},
                                         {-1, -g, 0},
                                         {1, -g, 0},
                                         {0, -1, g},
                                         {0, 1, g},
                                         {0, -1, -g},
                                         {0, 1, -g},
                                         {g, 0, -1},
                                         {g, 0, 1},
                                         {-g, 0, -1},
                                         {-g, 0, 1}}};
  for (const vec3& corner : corners) add(shape, glm::normalize(corner), glm::normalize(corner));
  shape.indices = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                   4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                   6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (int k = 0; k < level; ++k) divide(shape);
  return shape;
}

Shape torus(int around, int tube) {
  Shape shape{"torus:" + std::to_string(around) + ":" + std::to_string(tube), {}, {}, {}};
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < tube; ++j) {
      const double s = kTurn * i / around, a = kTurn * j / tube;
      const vec3 out(std::cos(s), std::sin(s), 0.0),
          n(std::cos(s) * std::cos(a), std::sin(s) * std::cos(a), std::sin(a));
      add(shape, out + 0.4f * n, n);
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * tube + j % tube); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < tube; ++j)
      quad(shape, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), (i + j) % 2 != 0);
  return shape;
}

Shape cylinder(int sides) {
  Shape shape{"cylinder:" + std::to_string(sides), {}, {}, {}};
  for (int k = 0; k < sides; ++k) {
    const double a = kTurn * k / sides;
    const vec3 n(std::cos(a), std::sin(a), 0.0);
    for (const float z : {-1.0f, 1.0f}) {
      add(shape, n + vec3(0, 0, z), n);
      add(shape, n + vec3(0, 0, z), vec3(0, 0, z));
    }
  }
  const std::uint32_t bottom = add(shape, {0, 0, -1}, {0, 0, -1}), top = add(shape, {0, 0, 1}, {0, 0, 1});
  for (int k = 0; k < sides; ++k) {
    const auto a = static_cast<std::uint32_t>(4 * k), b = static_cast<std::uint32_t>(4 * ((k + 1) % sides));
    quad(shape, a, b, b + 2, a + 2, false);
    shape.indices.insert(shape.indices.end(), {bottom, b + 1, a + 1, top, a + 3, b + 3});
  }
  return shape;
}

Shape cube() {
  Shape shape{"cube", {}, {}, {}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      vec3 n(0), u(0), v(0);
      n[axis] = sign;
      u[(axis + 1) % 3] = sign;
      v[(axis + 2) % 3] = 1.0f;
      const std::uint32_t a = add(shape, 0.5f * (n - u - v), n), b = add(shape, 0.5f * (n + u - v), n);
      const std::uint32_t c = add(shape, 0.5f * (n + u + v), n), d = add(shape, 0.5f * (n - u + v), n);
      quad(shape, a, b, c, d, false);
    }
  }
  return shape;
}

Shape flatGrid(int cells) {
  Shape shape = bumpyGrid(cells);
  shape.name = "flat grid";
  for (vec3& p : shape.positions) p.z = 0.0f;
  for (vec3& n : shape.normals) n = {0, 0, 1};
  return shape;
}

Shape bumpyGrid(int cells) {
  Shape shape{"bumpy grid", {}, {}, {}};
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = 2.0 * i / cells - 1.0, y = 2.0 * j / cells - 1.0;
      add(shape, vec3(x, y, 0.3 * std::sin(4 * x) * std::cos(3 * y)),
          glm::normalize(
              vec3(-1.2 * std::cos(4 * x) * std::cos(3 * y), 0.9 * std::sin(4 * x) * std::sin(3 * y), 1.0)));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (cells + 1) + i); };
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i)
      quad(shape, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), (i + j) % 2 != 0);
  return shape;
}

Shape torn(const Shape& shape) {
  Shape result{shape.name + ", torn", {}, {}, {}};
  for (const std::uint32_t index : shape.indices)
    result.indices.push_back(add(result, shape.positions[index], shape.normals[index]));
  return result;
}

Shape shaken(const Shape& shape, std::uint32_t seed) {
  Shape result = shape;
  result.name += ", shaken " + std::to_string(seed);
  std::mt19937 random(seed);
  const auto next = [&] { return static_cast<float>(random() % 20001) / 10000.0f - 1.0f; };
  for (vec3& p : result.positions) p += 0.1f * vec3(next(), next(), next());
  for (vec3& n : result.normals) n = glm::normalize(vec3(next(), next(), next()) + vec3(0.0f, 0.0f, 1e-3f));
  return result;
}

std::vector<Shape> allShapes() {
  std::vector<Shape> shapes = {icosphere(0), icosphere(2), torus(12, 7), cylinder(9),
                               cube(),       flatGrid(4),  bumpyGrid(6)};
  shapes.push_back(torn(shapes[1]));
  shapes.push_back(shaken(shapes[1], 1));
  shapes.push_back(torn(shaken(shapes[2], 2)));
  return shapes;
}

View perspectiveFrom(const vec3& eye, float nearPlane) {
  const float pixels = 400.0f / 0.26794919f;  // half the height over tan 15 degrees
  const Projection projection{true, pixels, pixels, nearPlane, 1000.0f, 1000, 800};
  const glm::dvec3 up = std::abs(eye.y) > 0.9f * glm::length(eye) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return makeView(projection, glm::lookAt(glm::dvec3(eye), glm::dvec3(0), up));
}

View orthographicAlong(const vec3& direction) {
  const Projection projection{false, 300.0f, 300.0f, -100.0f, 100.0f, 1000, 800};
  const glm::dvec3 up =
      std::abs(direction.y) > 0.9f * glm::length(direction) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return makeView(projection, glm::lookAt(glm::dvec3(0), glm::dvec3(direction), up));
}

std::vector<View> someViews(float distance) {
  std::vector<View> views;
  for (const vec3& direction :
       {vec3(0.1f, 0.2f, 1.0f), vec3(-0.9f, 0.3f, 0.2f), vec3(0.4f, -0.8f, 0.3f), vec3(0.6f, 0.5f, -0.7f)}) {
    views.push_back(perspectiveFrom(distance * glm::normalize(direction)));
    views.push_back(orthographicAlong(direction));
  }
  return views;
}

std::vector<vec3> drawnTriangles(const Mesh& mesh, const RefinedStream& stream) {
  std::vector<vec3> triangles;
  for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
    for (std::size_t k = 0; k < 3 && !stream.isReplaced(t); ++k)
      triangles.push_back(mesh.positions[mesh.indices[3 * t + k]]);
  for (const std::uint32_t index : stream.indices)
    triangles.push_back(index < mesh.positions.size() ? mesh.positions[index]
                                                      : stream.positions[index - mesh.positions.size()]);
  return triangles;
}

std::size_t openSides(const std::vector<vec3>& triangles) {
  // A side and its opposite get the same key, with +1 and -1.
  using Key = std::array<float, 6>;
  std::vector<std::pair<Key, int>> sides;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const vec3 &a = triangles[t + k], &b = triangles[t + (k + 1) % 3];
      const Key there{a.x, a.y, a.z, b.x, b.y, b.z}, back{b.x, b.y, b.z, a.x, a.y, a.z};
      if (a != b) sides.emplace_back(std::min(there, back), there < back ? 1 : -1);
    }
  }
  std::sort(sides.begin(), sides.end());
  std::size_t open = 0;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    int balance = 0;
    for (; end < sides.size() && sides[end].first == sides[begin].first; ++end) balance += sides[end].second;
    open += static_cast<std::size_t>(std::abs(balance));
  }
  return open;
}

std::size_t verticesOnBoundaries(const Topology& topology, const RefinedStream& stream) {
  std::size_t count = 0;
  for (const Origin& origin : stream.origins) {
    const std::array<float, 3> weights{1.0f - origin.weights.x - origin.weights.y, origin.weights.x,
                                       origin.weights.y};
    for (std::size_t side = 0; side < 3; ++side) {
      const bool inside = weights[side] > 1e-6f && weights[(side + 1) % 3] > 1e-6f;
      const std::uint32_t edge = topology.sideEdges()[3 * std::size_t{origin.triangle} + side];
      if (inside && edge != kNone && weights[(side + 2) % 3] <= 1e-6f && topology.edges()[edge].boundary)
        ++count;
    }
  }
  return count;
}

}  // namespace limn::silhouette::test
