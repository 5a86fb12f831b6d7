// Based on: the shapes of the llvmpipe comparison program (icosphere, tubes along closed curves), computed
// here in double precision with limn's own sine and cosine. Differs in: the tube's tangent is the exact
// derivative of its curve.
#include "apps/scene/shapes.h"

#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <utility>

#include "raster/base/check.h"
#include "raster/base/elementary.h"

namespace limn::scene {
namespace {

void addVertex(Mesh& mesh, const glm::dvec3& position, const glm::dvec3& normal) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(normal);
}

void addTriangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

void coverWithOnePart(Mesh& mesh) {
  mesh.parts = {{.firstTriangle = 0, .triangleCount = static_cast<std::uint32_t>(mesh.indices.size() / 3)}};
}

// The new vertex in the middle of each edge, by linear probing: an edge is asked for at most twice.
class MiddleVertices {
 public:
  explicit MiddleVertices(std::size_t edges) : slots_(std::bit_ceil(2 * edges)) {}

  // The vertex of edge (a, b), made by `make` when it is asked for first.
  template <class Make>
  std::uint32_t find(std::uint32_t a, std::uint32_t b, const Make& make) {
    const std::uint64_t key = (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
    std::size_t slot = (key * 0x9E3779B97F4A7C15ULL >> 20) & (slots_.size() - 1);
    while (slots_[slot].key != key && slots_[slot].key != kEmpty) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot].key == kEmpty) slots_[slot] = {key, make()};
    return slots_[slot].vertex;
  }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kEmpty;
    std::uint32_t vertex = 0;
  };
  std::vector<Slot> slots_;
};

std::vector<std::uint32_t> icosahedronIndices() {
  return {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
          3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
}

// Point and derivative of a closed curve at s.
struct CurvePoint {
  glm::dvec3 position, derivative;
};

CurvePoint circleAt(double s) {
  const SinCos r = sinCos(s);
  return {{r.cos, r.sin, 0.0}, {-r.sin, r.cos, 0.0}};
}

CurvePoint trefoilAt(double s) {
  const SinCos one = sinCos(s), two = sinCos(2 * s), three = sinCos(3 * s);
  return {{one.sin + 2 * two.sin, one.cos - 2 * two.cos, -three.sin},
          {one.cos + 4 * two.cos, -one.sin + 4 * two.sin, -3 * three.cos}};
}

template <class Curve>
Mesh tube(int along, int around, double radius, const Curve& curve) {
  require(along >= 3 && around >= 3, "a tube has at least 3 rings and 3 sides");
  Mesh mesh;
  for (int i = 0; i < along; ++i) {
    const CurvePoint point = curve(2 * kPi * i / along);
    const glm::dvec3 p = point.position, t = glm::normalize(point.derivative);
    const glm::dvec3 b = glm::normalize(glm::cross(t, glm::dvec3(p.x, p.y, 0.0)));
    const glm::dvec3 n = glm::cross(b, t);
    for (int j = 0; j < around; ++j) {
      const SinCos a = sinCos(2 * kPi * j / around);
      const glm::dvec3 outward = n * a.cos + b * a.sin;
      addVertex(mesh, p + outward * radius, outward);
    }
  }
  const auto at = [=](int i, int j) { return static_cast<std::uint32_t>(i % along * around + j % around); };
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      // t × b = -n: the order (i, j), (i+1, j), (i+1, j+1) would face inward.
      addTriangle(mesh, at(i, j), at(i + 1, j + 1), at(i + 1, j));
      addTriangle(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1));
    }
  }
  coverWithOnePart(mesh);
  return mesh;
}

bool isSame(glm::dvec2 a, glm::dvec2 b) {
  return glm::distance(a, b) < 1e-9;
}

// The vertices of one profile point, one per sector; a smooth pole repeats its only vertex.
std::vector<std::uint32_t> addRing(Mesh& mesh, const ProfilePoint& point, int sectors) {
  std::vector<std::uint32_t> ring;
  const bool onAxis = point.position.x == 0.0;
  for (int k = 0; k < sectors; ++k) {
    const bool repeated = onAxis && point.normal.x == 0.0 && k > 0;
    if (!repeated) {
      const SinCos turn = sinCos(2 * kPi * (onAxis ? k + 0.5 : k) / sectors);
      const auto swept = [&](glm::dvec2 q) { return glm::dvec3(q.x * turn.sin, q.y, q.x * turn.cos); };
      addVertex(mesh, swept(point.position), swept(point.normal));
    }
    ring.push_back(static_cast<std::uint32_t>(mesh.positions.size() - 1));
  }
  return ring;
}

void addBand(Mesh& mesh, const std::vector<std::uint32_t>& low, const std::vector<std::uint32_t>& high,
             bool lowPole, bool highPole) {
  const std::size_t sectors = low.size();
  for (std::size_t k = 0; k < sectors; ++k) {
    const std::size_t next = (k + 1) % sectors;
    if (!lowPole) addTriangle(mesh, low[k], low[next], highPole ? high[k] : high[next]);
    if (!highPole) addTriangle(mesh, low[k], high[next], high[k]);
  }
}

}  // namespace

Mesh icosphere(int level) {
  require(level >= 0 && level <= kMaximumLevel, "an icosphere has level 0 to 9");
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<glm::dvec3> points = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                    {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                    {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (glm::dvec3& p : points) p = glm::normalize(p);
  std::vector<std::uint32_t> indices = icosahedronIndices();
  for (int l = 0; l < level; ++l) {
    MiddleVertices middles(indices.size() / 2);
    points.reserve(points.size() + indices.size() / 2);
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      return middles.find(a, b, [&] {
        points.push_back(glm::normalize(points[a] + points[b]));
        return static_cast<std::uint32_t>(points.size() - 1);
      });
    };
    std::vector<std::uint32_t> divided;
    divided.reserve(indices.size() * 4);
    for (std::size_t t = 0; t < indices.size(); t += 3) {
      const std::uint32_t a = indices[t], b = indices[t + 1], c = indices[t + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      divided.insert(divided.end(), {a, ab, ca, ab, b, bc, ab, bc, ca, ca, bc, c});
    }
    indices = std::move(divided);
  }
  Mesh mesh;
  mesh.positions.assign(points.begin(), points.end());
  mesh.normals = mesh.positions;
  mesh.indices = std::move(indices);
  coverWithOnePart(mesh);
  return mesh;
}

Mesh torus(int along, int around) {
  return tube(along, around, 0.4, circleAt);
}

Mesh knot(int along, int around) {
  return tube(along, around, 0.55, trefoilAt);
}

ProfilePiece straightPiece(glm::dvec2 from, glm::dvec2 to) {
  const glm::dvec2 t = glm::normalize(to - from);
  const glm::dvec2 normal(t.y, -t.x);
  return {{from, normal}, {to, normal}};
}

ProfilePiece arcPiece(glm::dvec2 center, double radius, double fromDegrees, double toDegrees, int segments) {
  ProfilePiece piece;
  for (int k = 0; k <= segments; ++k) {
    const SinCos a = sinCosDegrees(fromDegrees + (toDegrees - fromDegrees) * k / segments);
    piece.push_back({center + radius * glm::dvec2(a.cos, a.sin), {a.cos, a.sin}});
  }
  return piece;
}

ProfilePiece curvePiece(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, int segments) {
  ProfilePiece piece;
  for (int k = 0; k <= segments; ++k) {
    const double u = static_cast<double>(k) / segments, w = 1 - u;
    const glm::dvec2 t = glm::normalize(w * (b - a) + u * (c - b));
    piece.push_back({w * w * a + 2 * u * w * b + u * u * c, {t.y, -t.x}});
  }
  return piece;
}

Mesh revolve(std::span<const ProfilePiece> profile, int sectors) {
  require(sectors >= 3, "a surface of revolution has at least 3 sectors");
  Mesh mesh;
  ProfilePoint previous{};
  std::vector<std::uint32_t> low;
  for (const ProfilePiece& piece : profile) {
    for (std::size_t k = 0; k < piece.size(); ++k) {
      ProfilePoint point = piece[k];
      if (k == 0 && !low.empty() && isSame(point.position, previous.position)) {
        if (isSame(point.normal, previous.normal)) continue;
        point.position = previous.position;  // both rings of a crease at the same bits
      }
      std::vector<std::uint32_t> high = addRing(mesh, point, sectors);
      if (k > 0) addBand(mesh, low, high, previous.position.x == 0.0, point.position.x == 0.0);
      low = std::move(high);
      previous = point;
    }
  }
  coverWithOnePart(mesh);
  return mesh;
}

}  // namespace limn::scene
