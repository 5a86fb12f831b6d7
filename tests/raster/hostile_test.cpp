// What no caller should hand over is refused, or left out of a picture that is right otherwise.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "raster/front_end.h"
#include "raster/kernels.h"
#include "tests/raster/fixture.h"

namespace limn::raster::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kHuge = std::numeric_limits<float>::max();

// Two triangles side by side, in one cluster.
class TwoTriangles {
 public:
  TwoTriangles() {
    soup.triangle({-20, -10, -5}, {-2, -10, -5}, {-10, 10, -5});
    soup.triangle({2, -10, -5}, {20, -10, -5}, {10, 10, -5});
    geometry = std::make_unique<Geometry>(soup.geometry());
    scene.draws[0].geometry = geometry.get();
    scene.frame.samples = 1;
  }
  Picture draw(bool scalar) {
    Renderer renderer(2, Tuning{.scalar = scalar});
    return scene.draw(renderer);
  }
  // With its second triangle taken out.
  Picture drawFirst(bool scalar) {
    const std::uint64_t second = 2;
    scene.draws[0].replaced = std::span(&second, 1);
    Picture picture = draw(scalar);
    scene.draws[0].replaced = {};
    return picture;
  }

  Soup soup;
  std::unique_ptr<Geometry> geometry;
  Scene scene{pixelProjection(50, 30)};
};

const glm::vec3 kNowhere[] = {{kNan, 0, -5},       {0, kNan, -5},      {0, 0, kNan},      {kInfinity, 0, -5},
                              {0, -kInfinity, -5}, {0, 0, -kInfinity}, {kNan, kNan, kNan}};

TEST(Hostile, PosedVerticesThatAreNotFiniteTakeOnlyTheirTrianglesAway) {
  for (const bool scalar : {false, true})
    for (const glm::vec3& nowhere : kNowhere)
      for (const std::size_t corner : {3, 4, 5}) {
        TwoTriangles two;
        const Picture expected = two.drawFirst(scalar);
        std::vector<glm::vec3> posed = two.soup.positions;
        posed[corner] = nowhere;
        two.scene.draws[0].posedPositions = posed;
        EXPECT_TRUE(two.draw(scalar) == expected) << nowhere.x << ' ' << nowhere.y << ' ' << nowhere.z;
      }
}

TEST(Hostile, StreamedVerticesThatAreNotFiniteTakeOnlyTheirTrianglesAway) {
  for (const bool scalar : {false, true})
    for (const glm::vec3& nowhere : kNowhere) {
      TwoTriangles two;
      const Picture expected = two.drawFirst(scalar);
      const std::vector<std::uint32_t> indices{0, 1, 2, 3, 4, 6}, sources{0, 1};
      const std::uint64_t both = 3;
      const glm::vec3 normal(0.0F, 0.0F, 1.0F);
      Draw& draw = two.scene.draws[0];
      draw.replaced = std::span(&both, 1);
      draw.stream.indices = indices;
      draw.stream.sourceTriangles = sources;
      draw.stream.vertices.positions = std::span(&nowhere, 1);
      draw.stream.vertices.normals = std::span(&normal, 1);
      EXPECT_TRUE(two.draw(scalar) == expected) << nowhere.x << ' ' << nowhere.y << ' ' << nowhere.z;
    }
}

TEST(Hostile, TrianglesThatOverflowOnTheirWayToViewSpaceAreLeftOut) {
  for (const bool scalar : {false, true})
    for (const bool perspective : {false, true}) {
      TwoTriangles two;
      two.scene.frame.projection.perspective = perspective;
      two.scene.frame.projection.nearPlane = 1.0F;
      const Picture expected = two.drawFirst(scalar);
      Soup far;
      far.triangle({kHuge, 0, -5}, {0, kHuge, -5}, {0, 0, -kHuge});
      far.triangle({-kHuge, -kHuge, -kHuge}, {kHuge, -kHuge, -kHuge}, {0, kHuge, -kHuge});
      const Geometry beyond = far.geometry();
      Draw draw = two.scene.draws[0];
      draw.geometry = &beyond;
      draw.modelToView = glm::scale(glm::mat4(1.0F), glm::vec3(1e30F));
      const std::uint64_t second = 2;
      two.scene.draws[0].replaced = std::span(&second, 1);
      two.scene.draws.push_back(draw);
      EXPECT_TRUE(two.draw(scalar) == expected);
    }
}

TEST(Hostile, LinesThatAreNotFiniteAreLeftOut) {
  for (const bool scalar : {false, true}) {
    TwoTriangles two;
    const Picture expected = two.draw(scalar);
    std::vector<glm::vec3> points;
    for (const glm::vec3& nowhere : kNowhere)
      for (const bool first : {false, true}) {
        points.push_back(first ? nowhere : glm::vec3(0.0F, 0.0F, -2.0F));
        points.push_back(first ? glm::vec3(0.0F, 0.0F, -2.0F) : nowhere);
      }
    points.insert(points.end(), {{kHuge, kHuge, -2}, {-kHuge, kHuge, -kHuge}});  // overflows
    const std::vector<glm::vec4> colors(points.size() / 2, glm::vec4(1.0F));
    Lines lines;
    lines.points = points;
    lines.colors = colors;
    lines.modelToView = glm::rotate(glm::mat4(1.0F), 0.7F, glm::vec3(0.6F, 0.8F, 0.0F)) * 3.0F;
    two.scene.frame.lines = std::span(&lines, 1);
    EXPECT_TRUE(two.draw(scalar) == expected);
  }
}

// Far from the model's origin the terms of a view-space coordinate cancel, and what is left of them is rounded: by more
// than a cluster's own size here.
TEST(Hostile, ClustersThatAreDrawnWholeLieBetweenThePlanesWhateverRoundingDoes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  const ScreenMap map({true, 300.0F, 300.0F, 0.01F, 100.0F, 320, 200});
  const Tiling tiling(320, 200, 128, 64);
  const std::vector<Material> materials(1);
  Workers workers(1);
  BatchBuilder builder;
  FrontEnd front;
  int whole = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::vec3 place{unit(random) * 2e6F, unit(random) * 2e6F, unit(random) * 2e6F};
    Soup soup;
    for (int t = 0; t < 8; ++t)
      soup.triangle(place + glm::vec3{unit(random), unit(random), unit(random)},
                    place + glm::vec3{unit(random), unit(random), unit(random)},
                    place + glm::vec3{unit(random), unit(random), unit(random)});
    const Geometry geometry = soup.geometry();
    const glm::mat4 turn = glm::rotate(glm::mat4(1.0F), 3.0F * unit(random),
                                       glm::normalize(glm::vec3{unit(random), unit(random), 1.0F}));
    const glm::vec3 turned(glm::dmat4(turn) * glm::dvec4(place, 1.0));
    Draw draw;
    draw.geometry = &geometry;
    draw.modelToView = turn;
    draw.modelToView[3] = glm::vec4(glm::vec3(0.0F, 0.0F, -2.0F - unit(random)) - turned, 1.0F);
    Frame frame;
    frame.draws = std::span(&draw, 1);
    frame.materials = materials;
    const std::span<const Batch> batches = builder.build(frame, map, workers);
    front.cull(frame, batches, builder.clusterCount(), map, tiling, scalarKernels(), workers);
    for (std::size_t r = 0; r < kRanges; ++r)
      for (const VisibleCluster& v : front.visibleOf(r)) {
        const Batch& batch = batches[v.batch];
        const Cluster& cluster = batch.set->clusters[v.cluster];
        ++whole;
        for (std::uint32_t k = 0; k < cluster.vertexCount; ++k)
          ASSERT_LE(viewPosition(batch, cluster.firstVertex + k).z, -map.nearPlane) << i;
      }
  }
  EXPECT_GT(whole, 100);
}

TEST(Hostile, FramesThatBreakCheckedRulesAreRefused) {
  const auto refused = [](const auto& spoil) {
    TwoTriangles two;
    spoil(two.scene);
    EXPECT_THROW(two.draw(false), std::invalid_argument);
  };
  const std::vector<std::uint32_t> indices{0, 1, 2, 3, 4, 5}, descending{1, 0}, unknown{0, 2};
  refused(
      [&](Scene& s) { s.draws[0].stream.indices = indices, s.draws[0].stream.sourceTriangles = descending; });
  refused(
      [&](Scene& s) { s.draws[0].stream.indices = indices, s.draws[0].stream.sourceTriangles = unknown; });
  refused([](Scene& s) { s.draws[0].modelToView[2][1] = kNan; });
  refused([](Scene& s) { s.frame.projection.pixelsX = kHuge; });
  refused([](Scene& s) { s.frame.projection.pixelsY = std::numeric_limits<float>::denorm_min(); });
  refused([](Scene& s) {
    s.frame.projection.perspective = true;
    s.frame.projection.nearPlane = std::numeric_limits<float>::denorm_min();
  });
  Lines lines;
  lines.modelToView[0][0] = kInfinity;
  refused([&](Scene& s) { s.frame.lines = std::span(&lines, 1); });
}

TEST(Hostile, TargetsWhoseRowsOverlapAreRefused) {
  TwoTriangles two;
  Picture picture = two.draw(false);  // leaves the frame complete
  Renderer renderer(2);
  for (std::size_t Target::*stride :
       {&Target::rgbaStride, &Target::depthStride, &Target::normalStride, &Target::idStride})
    for (const bool zero : {true, false}) {
      Target target = picture.target();
      target.*stride = zero ? 0 : target.*stride - 1;
      EXPECT_THROW(renderer.draw(two.scene.frame, target), std::invalid_argument);
    }
  Target bare;
  bare.rgba = picture.rgba.data(), bare.rgbaStride = 4UL * 50;
  EXPECT_NO_THROW(renderer.draw(two.scene.frame, bare));  // strides of planes that are not there mean nothing
}

}  // namespace
}  // namespace limn::raster::test
