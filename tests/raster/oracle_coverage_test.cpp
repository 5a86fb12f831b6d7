// Coverage, sample by sample, against the exact rasterizer of oracle_exact.h.
//
// Vertices are placed so that they fall on the sub-pixel grid whatever the rounding on the way there: one
// unit is one pixel, a multiple of 1/256 of it is a float, and depths are powers of two. So there is nothing
// to tolerate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "raster/view.h"
#include "tests/raster/oracle_exact.h"
#include "tests/raster/oracle_scene.h"

namespace limn::test {
namespace {

std::int64_t whole(Random& random, std::int64_t low, std::int64_t high) {
  return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
}

struct Window {
  int width, height;
};

// What a kind of triangles needs to know to make one: its source of numbers, the window and the pattern in
// force.
struct Maker {
  Random& random;
  Window window;
  std::span<const raster::SamplePosition> pattern;

  GridPoint anywhere(std::int64_t marginPixels) const {
    const std::int64_t margin = marginPixels * raster::kSubpixels;
    return {whole(random, -margin, std::int64_t{window.width} * raster::kSubpixels + margin),
            whole(random, -margin, std::int64_t{window.height} * raster::kSubpixels + margin)};
  }
  GridPoint samplePoint() const {
    const raster::SamplePosition sample = pattern[whole(random, 0, std::ssize(pattern) - 1)];
    return {whole(random, -2, window.width + 2) * raster::kSubpixels + sample.x,
            whole(random, -2, window.height + 2) * raster::kSubpixels + sample.y};
  }
};

using MakeTriangle = std::array<GridPoint, 3> (*)(const Maker&);

std::array<GridPoint, 3> makeRandom(const Maker& make) {
  return {make.anywhere(20), make.anywhere(20), make.anywhere(20)};
}
std::array<GridPoint, 3> makeSliver(const Maker& make) {
  const GridPoint a = make.anywhere(20), b = make.anywhere(20);
  const std::int64_t part = whole(make.random, 0, 64);
  return {a,
          b,
          {a.x + (b.x - a.x) * part / 64 + whole(make.random, -3, 3),
           a.y + (b.y - a.y) * part / 64 + whole(make.random, -3, 3)}};
}
std::array<GridPoint, 3> makeOnSamples(const Maker& make) {
  return {make.samplePoint(), make.samplePoint(), make.samplePoint()};
}
std::array<GridPoint, 3> makeSubpixel(const Maker& make) {
  const GridPoint a = make.samplePoint();
  const auto near = [&] {
    return GridPoint{a.x + whole(make.random, -200, 200), a.y + whole(make.random, -200, 200)};
  };
  return {near(), near(), near()};
}
// Corners on, or one step beside, what may be corners of tiles and blocks: multiples of 4, 8, 16, 32 or 64
// pixels.
std::array<GridPoint, 3> makeTileCorners(const Maker& make) {
  const auto corner = [&] {
    const std::int64_t block = std::int64_t{raster::kSubpixels} << whole(make.random, 2, 6);
    const GridPoint p = make.anywhere(0);
    return GridPoint{p.x / block * block + whole(make.random, -1, 1),
                     p.y / block * block + whole(make.random, -1, 1)};
  };
  return {corner(), corner(), corner()};
}
std::array<GridPoint, 3> makeHuge(const Maker& make) {
  constexpr int kReach =
      raster::kGuardPixels - 1;  // what lies farther out is clipped, and its corners snap anew
  return {make.anywhere(kReach), make.anywhere(kReach), make.anywhere(kReach)};
}
// Horizontal and vertical sides through sample points: the fill rule decides whole rows and columns.
std::array<GridPoint, 3> makeAxisAligned(const Maker& make) {
  const GridPoint a = make.samplePoint(), b = make.samplePoint();
  return {a, {a.x, b.y}, b};
}

struct Kind {
  const char* name;
  MakeTriangle make;
};
constexpr Kind kKinds[] = {{"random", makeRandom},
                           {"sliver", makeSliver},
                           {"on samples", makeOnSamples},
                           {"sub-pixel", makeSubpixel},
                           {"tile corners", makeTileCorners},
                           {"huge", makeHuge},
                           {"axis-aligned", makeAxisAligned}};

// Places a grid point at view depth `w`, a power of two (orthographic: any).
glm::vec3 viewPosition(GridPoint p, const Projection& projection, double w) {
  const double scale = projection.perspective ? w : 1.0;
  return {static_cast<float>((static_cast<double>(p.x) / 256.0 - projection.width / 2.0) * scale),
          static_cast<float>((projection.height / 2.0 - static_cast<double>(p.y) / 256.0) * scale),
          static_cast<float>(-w)};
}

class Scene {
 public:
  Scene(Window window, bool perspective)
      : projection_(pixelProjection(window.width, window.height, perspective)) {}

  /// At the triangle's own depth.
  void add(const GridTriangle& triangle) {
    const double w = triangle.depth;
    add(triangle.corners, {w, w, w});
  }
  void add(const std::array<GridPoint, 3>& corners, const std::array<double, 3>& w) {
    for (int k = 0; k < 3; ++k) {
      soup_.indices.push_back(static_cast<std::uint32_t>(soup_.positions.size()));
      soup_.positions.push_back(viewPosition(corners[k], projection_, w[k]));
      soup_.normals.emplace_back(0.0f, 0.0f, 1.0f);
    }
  }

  Picture draw(raster::Renderer& renderer, int samples) const {
    const raster::Geometry geometry = soup_.geometry();
    raster::Draw draw;
    draw.geometry = &geometry;
    raster::Material material;
    material.unlit = true;
    raster::Frame frame;
    frame.projection = projection_;
    frame.draws = std::span(&draw, 1);
    frame.materials = std::span(&material, 1);
    frame.samples = samples;
    return render(renderer, frame);
  }

 private:
  Projection projection_;
  Soup soup_;
};

// Ids, depths and, through the alpha of a transparent background, the number of covered samples of every
// pixel.
void expectSame(const Picture& picture, const ExactImage& exact, int samples, const std::string& what) {
  int reported = 0;
  for (std::size_t pixel = 0; pixel < exact.nearest.size() && reported < 5; ++pixel) {
    const std::uint32_t id = exact.nearest[pixel];
    const double alpha = 255.0 * exact.coveredSamples[pixel] / samples;
    const bool same = picture.ids[pixel] == (id == kNoTriangle ? raster::kNoId : id) &&
                      std::abs(picture.rgba[4 * pixel + 3] - alpha) <= 0.5 &&
                      std::isinf(picture.depth[pixel]) == (id == kNoTriangle);
    if (same) continue;
    reported++;
    ADD_FAILURE() << what << ": pixel (" << pixel % exact.width << ", " << pixel / exact.width << ") of "
                  << exact.width << "x" << exact.height << ": id " << picture.ids[pixel] << " alpha "
                  << int{picture.rgba[4 * pixel + 3]} << " depth " << picture.depth[pixel] << ", exactly "
                  << id << " with " << exact.coveredSamples[pixel] << " of " << samples << " samples";
  }
}

constexpr Window kWindows[] = {{192, 144}, {65, 63}, {1, 1}, {7, 200}};

TEST(OracleCoverage, ManyTrianglesOfEveryKind) {
  raster::Renderer renderer(1);
  for (const int samples : {1, 4, 8}) {
    const auto pattern = raster::samplePattern(samples);
    for (const Window window : kWindows) {
      for (const Kind& kind : kKinds) {
        for (std::uint32_t seed = 1; seed <= 3; ++seed) {
          Random random(seed);
          const Maker maker{random, window, pattern};
          Scene scene(window, false);
          std::vector<GridTriangle> triangles;
          for (int t = 0; t < 60; ++t) {
            // Depths in no order, none twice.
            triangles.push_back({kind.make(maker), 1 + t * 37 % 61});
            scene.add(triangles.back());
          }
          const ExactImage exact = rasterizeExactly(triangles, window.width, window.height, pattern);
          expectSame(scene.draw(renderer, samples), exact, samples,
                     std::string(kind.name) + ", seed " + std::to_string(seed));
        }
      }
    }
  }
}

// Alone in the picture a triangle may have a different w at each corner; coverage must not see it.
TEST(OracleCoverage, SingleTrianglesInPerspectiveWithDepthsFromAMillionthToAMillion) {
  raster::Renderer renderer(1);
  const Window window{48, 40};
  for (const int samples : {1, 4}) {
    const auto pattern = raster::samplePattern(samples);
    for (const Kind& kind : kKinds) {
      if (kind.make == makeHuge) continue;  // x = pixels · w would leave the grid of floats
      for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        const Maker maker{random, window, pattern};
        const GridTriangle triangle{kind.make(maker)};
        std::array<double, 3> w;
        for (double& each : w) each = std::ldexp(1.0, static_cast<int>(whole(random, -20, 20)));
        Scene scene(window, true);
        scene.add(triangle.corners, w);
        const ExactImage exact =
            rasterizeExactly(std::span(&triangle, 1), window.width, window.height, pattern);
        expectSame(scene.draw(renderer, samples), exact, samples,
                   std::string(kind.name) + ", seed " + std::to_string(seed));
      }
    }
  }
}

// A triangulated grid, its inner vertices shaken, that covers the window: every sample belongs to one
// triangle, the one that the exact rasterizer says, although all are at the same depth.
TEST(OracleCoverage, SharedEdgesBelongToOneTriangle) {
  raster::Renderer renderer(1);
  const Window window{160, 96};
  constexpr int kColumns = 20, kRows = 12;
  for (const int samples : {1, 4, 8}) {
    const auto pattern = raster::samplePattern(samples);
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
      Random random(seed);
      std::vector<GridPoint> points;
      for (int row = 0; row <= kRows; ++row) {
        for (int column = 0; column <= kColumns; ++column) {
          GridPoint p{column * 8 * 256, row * 8 * 256};
          const bool inner = row > 0 && row < kRows && column > 0 && column < kColumns;
          // Half of the vertices go to the centre of a pixel, where the rule matters most.
          if (inner) p = {p.x + whole(random, -500, 500), p.y + whole(random, -500, 500)};
          if (inner && whole(random, 0, 1) == 0) p = {p.x / 256 * 256 + 128, p.y / 256 * 256 + 128};
          points.push_back(p);
        }
      }
      std::vector<GridTriangle> triangles;
      Scene scene(window, false);
      for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
          const int a = row * (kColumns + 1) + column, b = a + kColumns + 1;
          triangles.push_back({{points[a], points[b], points[b + 1]}});
          triangles.push_back({{points[a], points[b + 1], points[a + 1]}});
        }
      }
      for (const GridTriangle& triangle : triangles) scene.add(triangle);
      const ExactImage exact = rasterizeExactly(triangles, window.width, window.height, pattern);
      ASSERT_EQ(std::count(exact.coveredSamples.begin(), exact.coveredSamples.end(), samples),
                window.width * window.height);
      const Picture picture = scene.draw(renderer, samples);
      if (samples == 1) expectSame(picture, exact, samples, "seed " + std::to_string(seed));
      for (std::size_t pixel = 0; pixel < picture.ids.size(); ++pixel) {
        ASSERT_EQ(picture.rgba[4 * pixel + 3], 255) << "pixel " << pixel << ", seed " << seed;
      }
    }
  }
}

// Far beyond any guard band the rasterizer has to clip, and a clipped corner is a new one: what is farther
// than a sixteenth of a pixel from every edge must be as without clipping.
TEST(OracleCoverage, TrianglesAMillionPixelsLarge) {
  raster::Renderer renderer(1);
  const Window window{64, 48};
  int decided = 0;
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    const Maker maker{random, window, raster::samplePattern(1)};
    // A line through the window, and two corners far out on it or beside it.
    const GridPoint through = maker.anywhere(0);
    const auto far = [&] {
      return GridPoint{through.x + whole(random, -1000000, 1000000) * 256,
                       through.y + whole(random, -1000000, 1000000) * 256};
    };
    const GridPoint a = far();
    GridTriangle triangle{{a, {2 * through.x - a.x, 2 * through.y - a.y}, far()}};
    // Floats hold multiples of 1/8 pixel out there.
    for (GridPoint& p : triangle.corners) p = {p.x / 32 * 32, p.y / 32 * 32};
    Scene scene(window, false);
    scene.add(triangle);
    const Picture picture = scene.draw(renderer, 1);
    for (int y = 0; y < window.height; ++y) {
      for (int x = 0; x < window.width; ++x) {
        int inside = 0;
        for (const int dx : {-16, 16}) {
          for (const int dy : {-16, 16}) inside += covers(triangle, {x * 256 + 128 + dx, y * 256 + 128 + dy});
        }
        if (inside != 0 && inside != 4) continue;
        decided++;
        ASSERT_EQ(picture.ids[y * window.width + x] == 0u, inside == 4)
            << "pixel (" << x << ", " << y << "), seed " << seed;
      }
    }
  }
  EXPECT_GT(decided, 300 * 64 * 48 * 9 / 10);
}

}  // namespace
}  // namespace limn::test
