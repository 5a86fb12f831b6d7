// Depth, normal, colour and visibility of every pixel against rays cast in double precision, with everything
// that perspective and clipping can do to a triangle.
//
// Where bounds are stated: a vertex moves by at most 1/512 pixel in each direction when it snaps to the grid.
// So within kMargin of an edge a pixel may show either side; elsewhere values may differ by what they change
// over kMargin / 4, and by rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/raster/oracle_rays.h"
#include "tests/raster/oracle_scene.h"

namespace limn::test {
namespace {

constexpr double kMargin = 1.0 / 64.0;        // pixels
constexpr double kDepthRounding = 1e-5;       // of the depth; orthographic: a tenth, of far - near
constexpr double kNormalRounding = 2e-4;      // length of the difference
constexpr double kColorRounding = 0.5 / 255;  // to eight bits

glm::vec3 uniformVector(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

struct Placed {
  Soup soup;
  glm::mat4 modelToView{1.0f};
  bool doubleSided = false;
};

Picture draw(raster::Renderer& renderer, std::span<const Placed> scene, const Projection& projection) {
  std::vector<raster::Geometry> geometries;
  std::vector<raster::Material> materials(2);
  for (const Placed& placed : scene) {
    const raster::Part whole{0, static_cast<std::uint32_t>(placed.soup.triangleCount()),
                             placed.doubleSided ? 1u : 0u};
    geometries.emplace_back(placed.soup.vertices(), placed.soup.indices, std::span(&whole, 1));
  }
  for (raster::Material& material : materials) {
    material.unlit = true;
    material.baseColor = glm::vec4(1.0f);
  }
  materials[1].doubleSided = true;
  std::vector<raster::Draw> draws(scene.size());
  std::uint32_t firstId = 0;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    draws[i].geometry = &geometries[i];
    draws[i].modelToView = scene[i].modelToView;
    draws[i].firstId = firstId;
    firstId += static_cast<std::uint32_t>(scene[i].soup.triangleCount());
  }
  raster::Frame frame;
  frame.projection = projection;
  frame.draws = draws;
  frame.materials = materials;
  frame.encoding = raster::Encoding::kNone;
  frame.samples = 1;
  return render(renderer, frame);
}

std::vector<ViewTriangle> viewTriangles(std::span<const Placed> scene) {
  std::vector<ViewTriangle> triangles;
  for (const Placed& placed : scene) {
    place(placed.soup, placed.modelToView, static_cast<std::uint32_t>(triangles.size()), placed.doubleSided,
          triangles);
  }
  return triangles;
}

// How much depth, normal and colour change over the margin around a pixel's centre; nothing where what is
// seen changes.
struct Neighbourhood {
  bool sameTriangle = true;
  double depth = 0.0, normal = 0.0, color = 0.0;
};

Neighbourhood lookAround(std::span<const ViewTriangle> triangles, const Projection& projection, double x,
                         double y, const std::optional<Hit>& centre) {
  Neighbourhood around;
  for (int k = 0; k < 9; ++k) {
    const double dx = kMargin * (k % 3 - 1.0), dy = kMargin * (k / 3 - 1.0);
    const std::optional<Hit> hit = castRay(triangles, projection, x + dx, y + dy);
    if (hit.has_value() != centre.has_value() || (hit && hit->id != centre->id)) return {false};
    if (!hit) continue;
    around.depth = std::max(around.depth, std::abs(hit->depth - centre->depth));
    around.normal = std::max(around.normal, glm::length(hit->normal - centre->normal));
    for (int c = 0; c < 3; ++c)
      around.color = std::max(around.color, std::abs(hit->color[c] - centre->color[c]));
  }
  return around;
}

double depthRounding(const Projection& projection, double depth) {
  if (projection.perspective) return kDepthRounding * depth;
  return 0.1 * kDepthRounding * (projection.farPlane - projection.nearPlane);
}

// The picture shows another triangle than the ray hits first: right where the two are as near within the bounds.
bool asNear(std::span<const ViewTriangle> triangles, std::uint32_t id, const Projection& projection, double x,
            double y, double depth, double tolerance) {
  if (id >= triangles.size()) return false;
  const auto own = triangles.subspan(id, 1);  // ids count the triangles
  const std::optional<Hit> hit = castRay(own, projection, x, y);
  if (!hit) return false;
  const Neighbourhood around = lookAround(own, projection, x, y, hit);
  return around.sameTriangle && hit->depth - depth <= tolerance + 0.25 * around.depth;
}

struct Tally {
  int pixels = 0, compared = 0, covered = 0;
};

// Compares every pixel that is not within the margin of an edge of what is seen there.
void compare(const Picture& picture, std::span<const ViewTriangle> triangles, const Projection& projection,
             const std::string& what, Tally& tally) {
  int reported = 0;
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width && reported < 3; ++column) {
      tally.pixels++;
      const double x = column + 0.5, y = row + 0.5;
      const std::optional<Hit> hit = castRay(triangles, projection, x, y);
      const Neighbourhood around = lookAround(triangles, projection, x, y, hit);
      if (!around.sameTriangle) continue;
      tally.compared++;
      tally.covered += hit.has_value();
      const std::size_t pixel = static_cast<std::size_t>(row) * picture.width + column;
      bool right = picture.ids[pixel] == (hit ? hit->id : raster::kNoId);
      double depthError = 0, normalError = 0, colorError = 0;
      if (!right && hit) {
        const double tolerance = 0.25 * around.depth + 2.0 * depthRounding(projection, hit->depth);
        right = asNear(triangles, picture.ids[pixel], projection, x, y, hit->depth, tolerance);
      } else if (hit) {
        depthError = std::abs(picture.depth[pixel] - hit->depth) - 0.25 * around.depth -
                     depthRounding(projection, hit->depth);
        normalError = glm::length(glm::dvec3(picture.normals[pixel]) - hit->normal) - 0.25 * around.normal -
                      kNormalRounding;
        for (int c = 0; c < 3; ++c) {
          const double error = std::abs(picture.rgba[4 * pixel + c] / 255.0 - hit->color[c]);
          colorError = std::max(colorError, error - 0.25 * around.color - 1.01 * kColorRounding);
        }
        right = depthError <= 0 && normalError <= 0 && colorError <= 0;
      }
      if (right) continue;
      reported++;
      ADD_FAILURE() << what << ": pixel (" << column << ", " << row << "): id " << picture.ids[pixel]
                    << " depth " << picture.depth[pixel] << ", the ray hits "
                    << (hit ? hit->id : raster::kNoId) << " at " << (hit ? hit->depth : INFINITY)
                    << "; beyond the bounds by: depth " << depthError << ", normal " << normalError
                    << ", colour " << colorError;
    }
  }
}

// One triangle with random colours and normals that need not be unit.
void addTriangle(Soup& soup, Random& random, const std::array<glm::vec3, 3>& corners) {
  for (const glm::vec3& corner : corners) {
    soup.indices.push_back(static_cast<std::uint32_t>(soup.positions.size()));
    soup.positions.push_back(corner);
    soup.normals.push_back(glm::vec3(0.0f, 0.0f, 1.5f) + uniformVector(random, 0.7));
    soup.colors.emplace_back(uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1), 1.0);
  }
}

using MakeCorners = std::array<glm::vec3, 3> (*)(Random&);

std::array<glm::vec3, 3> inView(Random& random) {
  const auto corner = [&] {
    const double depth = uniform(random, 1.0, 8.0);
    return glm::vec3(uniform(random, -0.6, 0.6) * depth, uniform(random, -0.6, 0.6) * depth, -depth);
  };
  return {corner(), corner(), corner()};
}
// Corners in front of, at, and behind the near plane and the eye.
std::array<glm::vec3, 3> acrossTheEye(Random& random) {
  return {uniformVector(random, 3.0), uniformVector(random, 3.0), uniformVector(random, 3.0)};
}
// Floors and walls that pass close to the eye and reach far out on all sides.
std::array<glm::vec3, 3> coveringTheScreenManyTimes(Random& random) {
  const glm::vec3 centre(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -4, -1));
  const glm::vec3 a = uniformVector(random, 2000.0), b = uniformVector(random, 2000.0);
  return {centre + a, centre + b, centre - 0.5f * (a + b)};
}
// Seen from the edge: depth changes quickly from pixel to pixel.
std::array<glm::vec3, 3> grazing(Random& random) {
  const float y = static_cast<float>(uniform(random, -0.2, 0.2));
  const auto corner = [&](double x, double z) { return glm::vec3(x, y + uniform(random, -0.02, 0.02), -z); };
  return {corner(uniform(random, -4, -1), uniform(random, 0.2, 2)),
          corner(uniform(random, 1, 4), uniform(random, 0.2, 2)),
          corner(uniform(random, -3, 3), uniform(random, 20, 200))};
}

void trianglesAgainstRays(MakeCorners make, bool perspective, int scenes, double leastCompared) {
  raster::Renderer renderer(1);
  Tally tally;
  for (int seed = 1; seed <= scenes; ++seed) {
    Random random(static_cast<std::uint32_t>(seed));
    Placed placed;
    for (int t = 0; t < 1 + seed % 4; ++t) addTriangle(placed.soup, random, make(random));
    placed.doubleSided = seed % 3 != 0;
    Projection projection = perspectiveProjection(60, 44, uniform(random, 20, 100), 0.05f, 1e5f);
    if (!perspective) {
      projection.perspective = false;
      projection.pixelsX = projection.pixelsY = static_cast<float>(uniform(random, 4, 12));
      projection.nearPlane = -4000.0f;
      projection.farPlane = 4000.0f;
    }
    const Picture picture = draw(renderer, std::span(&placed, 1), projection);
    compare(picture, viewTriangles(std::span(&placed, 1)), projection, "seed " + std::to_string(seed), tally);
  }
  EXPECT_GT(tally.compared, leastCompared * tally.pixels);
  EXPECT_GT(tally.covered, tally.pixels / 20);
}

TEST(OracleRays, TrianglesInView) {
  trianglesAgainstRays(inView, true, 150, 0.9);
}
TEST(OracleRays, TrianglesInOrthographicView) {
  trianglesAgainstRays(inView, false, 100, 0.9);
}
TEST(OracleRays, TrianglesAcrossTheNearPlaneAndBehindTheEye) {
  trianglesAgainstRays(acrossTheEye, true, 200, 0.9);
}
TEST(OracleRays, TrianglesCoveringTheScreenManyTimes) {
  trianglesAgainstRays(coveringTheScreenManyTimes, true, 200, 0.9);
  trianglesAgainstRays(coveringTheScreenManyTimes, false, 100, 0.9);
}
TEST(OracleRays, GrazingTriangles) {
  trianglesAgainstRays(grazing, true, 100, 0.7);
}

// Rotated, sheared, unevenly scaled and reflected copies of closed meshes.
TEST(OracleRays, PlacedMeshes) {
  raster::Renderer renderer(1);
  Tally tally;
  for (int seed = 1; seed <= 24; ++seed) {
    Random random(static_cast<std::uint32_t>(seed));
    std::vector<Placed> scene(2);
    scene[0].soup = sphere(8, 12);
    scene[1].soup = torus(16, 8, 0.4f);
    for (Placed& placed : scene) {
      placed.doubleSided = seed % 2 == 0;
      glm::mat4 m =
          glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, -5.0f) + uniformVector(random, 0.7));
      m = glm::rotate(m, static_cast<float>(uniform(random, 0, 6)),
                      glm::normalize(uniformVector(random, 1.0)));
      m = glm::scale(m, glm::vec3(1.0f) + uniformVector(random, 0.5));
      m[1] += static_cast<float>(uniform(random, -0.4, 0.4)) * m[0];
      if (seed % 3 == 0) m[0] = -m[0];
      placed.modelToView = m;
    }
    const Projection projection = perspectiveProjection(72, 54, 30.0, 1.0f, 20.0f);
    const Picture picture = draw(renderer, scene, projection);
    compare(picture, viewTriangles(scene), projection, "seed " + std::to_string(seed), tally);
  }
  EXPECT_GT(tally.compared, tally.pixels * 85 / 100);
  EXPECT_GT(tally.covered, tally.pixels / 5);
}

// Hand-made cases, so that the oracle is judged too.
TEST(OracleRays, TheOracleItself) {
  Soup soup;
  soup.positions = {{-2, -2, -2}, {2, -2, -2}, {0, 6, -6}};
  soup.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  soup.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  soup.indices = {0, 1, 2};
  std::vector<ViewTriangle> triangles;
  place(soup, glm::mat4(1.0f), 7, false, triangles);
  const Projection projection = perspectiveProjection(100, 100, 90.0, 0.1f, 100.0f);
  const std::optional<Hit> hit = castRay(triangles, projection, 50.0, 50.0);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->id, 7u);
  EXPECT_NEAR(hit->depth, 3.0, 1e-12);  // a quarter of the way from y = -2 to y = 6
  EXPECT_NEAR(hit->color.b, 0.25, 1e-12);
  EXPECT_NEAR(hit->color.r, 0.375, 1e-12);
  EXPECT_FALSE(castRay(triangles, projection, 2.0, 2.0));
  std::swap(triangles[0].corners[0], triangles[0].corners[1]);
  EXPECT_FALSE(castRay(triangles, projection, 50.0, 50.0)) << "back faces are not seen";
  triangles[0].reflected = true;
  EXPECT_TRUE(castRay(triangles, projection, 50.0, 50.0));
}

}  // namespace
}  // namespace limn::test
