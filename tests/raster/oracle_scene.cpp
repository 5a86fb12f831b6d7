#include "tests/raster/oracle_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "raster/base/elementary.h"

namespace limn::test {
namespace {

template <class T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

}  // namespace

double uniform(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

raster::Geometry Soup::geometry() const {
  const raster::Part whole{0, static_cast<std::uint32_t>(triangleCount()), 0};
  return raster::Geometry(vertices(), indices, std::span(&whole, 1));
}

Soup sphere(int rings, int sides) {
  Soup soup;
  const auto add = [&](double polar, double azimuth) {
    const SinCos p = sinCos(polar);
    const SinCos a = sinCos(azimuth);
    soup.positions.emplace_back(p.sin * a.cos, p.sin * a.sin, p.cos);
  };
  add(0.0, 0.0);
  for (int ring = 1; ring < rings; ++ring) {
    for (int side = 0; side < sides; ++side) add(kPi * ring / rings, 2.0 * kPi * side / sides);
  }
  add(kPi, 0.0);
  soup.normals = soup.positions;
  const auto at = [&](int ring, int side) -> std::uint32_t {
    if (ring == 0) return 0;
    if (ring == rings) return static_cast<std::uint32_t>(soup.positions.size() - 1);
    return static_cast<std::uint32_t>(1 + (ring - 1) * sides + side % sides);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int side = 0; side < sides; ++side) {
      const std::uint32_t a = at(ring, side), b = at(ring + 1, side);
      const std::uint32_t c = at(ring + 1, side + 1), d = at(ring, side + 1);
      if (ring + 1 < rings) soup.indices.insert(soup.indices.end(), {a, b, c});
      if (ring > 0) soup.indices.insert(soup.indices.end(), {a, c, d});
    }
  }
  return soup;
}

Soup torus(int along, int around, float tube) {
  Soup soup;
  for (int i = 0; i < along; ++i) {
    const SinCos s = sinCos(2.0 * kPi * i / along);
    for (int j = 0; j < around; ++j) {
      const SinCos a = sinCos(2.0 * kPi * j / around);
      const glm::vec3 normal(s.cos * a.cos, s.sin * a.cos, a.sin);
      soup.normals.push_back(normal);
      soup.positions.push_back(glm::vec3(s.cos, s.sin, 0.0) + tube * normal);
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i % along * around + j % around); };
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < around; ++j) {
      soup.indices.insert(soup.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      soup.indices.insert(soup.indices.end(), {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return soup;
}

Soup insideOut(Soup soup) {
  for (std::size_t t = 0; t < soup.triangleCount(); ++t) {
    std::swap(soup.indices[3 * t + 1], soup.indices[3 * t + 2]);
  }
  for (glm::vec3& normal : soup.normals) normal = -normal;
  return soup;
}

bool Picture::operator==(const Picture& other) const {
  return width == other.width && height == other.height && sameBytes(rgba, other.rgba) &&
         sameBytes(depth, other.depth) && sameBytes(normals, other.normals) && sameBytes(ids, other.ids);
}

Picture render(raster::Renderer& renderer, const raster::Frame& frame) {
  const int width = frame.projection.width;
  const int height = frame.projection.height;
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  Picture picture{width, height, {}, {}, {}, {}};
  picture.rgba.resize(4 * pixels);
  picture.depth.resize(pixels);
  picture.normals.resize(pixels);
  picture.ids.resize(pixels);
  raster::Target target;
  target.rgba = picture.rgba.data();
  target.rgbaStride = 4 * static_cast<std::size_t>(width);
  target.depth = picture.depth.data();
  target.normals = picture.normals.data();
  target.ids = picture.ids.data();
  target.depthStride = target.normalStride = target.idStride = static_cast<std::size_t>(width);
  renderer.draw(frame, target);
  return picture;
}

Projection pixelProjection(int width, int height, bool perspective) {
  Projection projection;
  projection.perspective = perspective;
  projection.pixelsX = projection.pixelsY = 1.0f;
  projection.nearPlane = perspective ? 1.0f / 4194304.0f : 0.5f;
  projection.farPlane = perspective ? 4194304.0f : 4096.0f;
  projection.width = width;
  projection.height = height;
  return projection;
}

Projection perspectiveProjection(int width, int height, double degrees, float nearPlane, float farPlane) {
  Projection projection;
  projection.perspective = true;
  projection.pixelsX = projection.pixelsY = static_cast<float>(height / 2.0 / tangent(degrees * kPi / 360.0));
  projection.nearPlane = nearPlane;
  projection.farPlane = farPlane;
  projection.width = width;
  projection.height = height;
  return projection;
}

}  // namespace limn::test
