// Overlays against what they stand for: edges counted, contours closed and where the normals say.
#include "apps/scene/overlays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "apps/scene/frame.h"
#include "apps/scene/load.h"

namespace limn::scene {
namespace {

using silhouette::Method;
using Point = std::array<float, 3>;

Point keyOf(const glm::vec3& p) {
  return {p.x, p.y, p.z};
}

/// One model, refined for one view.
class Refined {
 public:
  Refined(const std::string& model, Method method) : scene_(load("builtin:" + model)), drawer_(scene_, 2) {
    settings_.refinement.method = method;
    settings_.overlays.fill(true);
    Pose pose;
    evaluatePose(scene_, -1, 0.0, pose);
    const Sphere bounds = boundingSphere(scene_, pose);
    const CameraView camera = makeCamera(frameSphere(bounds, 400, 300, 30, 20, 1, 30, 0), bounds, 400, 300);
    drawer_.refine(pose, camera, settings_);
    source_.instance = drawer_.instance(0);
    source_.view =
        silhouette::makeView(camera.projection, camera.worldToView * source_.instance.shapeToWorld);
    source_.method = method;
    drawer_.silhouetteness(0, alphas_);
  }

  raster::Lines overlay(Overlay overlay) {
    source_.alphas = alphas_;
    lines_.clear();
    lines_.add(overlay, source_);
    return lines_.lines().empty() ? raster::Lines() : lines_.lines()[0];
  }

  std::vector<float>& alphas() { return alphas_; }
  const silhouette::View& view() const { return source_.view; }
  const silhouette::Topology& topology() const { return *source_.instance.topology; }
  const silhouette::Mesh& shape() const { return source_.instance.shape; }
  const silhouette::RefinedStream& stream() const { return *source_.instance.stream; }
  std::size_t drawnTriangles() const {
    std::size_t drawn = stream().triangleCount();
    for (std::size_t t = 0; t < shape().triangleCount(); ++t) drawn += stream().isReplaced(t) ? 0 : 1;
    return drawn;
  }

 private:
  Scene scene_;
  FrameDrawer drawer_;
  FrameSettings settings_;
  OverlaySource source_;
  OverlayLines lines_;
  std::vector<float> alphas_;
};

/// How many lines end at each point, of those that `counts` picks.
template <class Counts>
std::map<Point, int> degrees(const raster::Lines& lines, const Counts& counts) {
  std::map<Point, int> found;
  for (std::size_t i = 0; i < lines.points.size(); ++i)
    if (counts(lines.colors[i / 2])) ++found[keyOf(lines.points[i])];
  return found;
}

const auto all = [](const glm::vec4&) { return true; };

TEST(Overlays, WireIsEveryEdgeOfAClosedMeshOnce) {
  for (const char* model : {"icosphere-320", "pawn", "torus-576"})
    for (const Method method : {Method::kFlat, Method::kPatches, Method::kCurves, Method::kPn}) {
      Refined refined(model, method);
      const raster::Lines wire = refined.overlay(Overlay::kWire);
      std::set<std::pair<Point, Point>> distinct;
      for (std::size_t i = 0; i < wire.points.size(); i += 2)
        distinct.insert({keyOf(wire.points[i]), keyOf(wire.points[i + 1])});
      EXPECT_EQ(distinct.size(), wire.colors.size());
      EXPECT_EQ(2 * wire.colors.size(), 3 * refined.drawnTriangles())
          << model << " method " << static_cast<int>(method);
    }
}

TEST(Overlays, EdgesAreThoseThatPatchesBendAndFollowThem) {
  Refined refined("icosphere-320", Method::kPatches);
  std::size_t bent = 0, onEdges = 0;
  for (const float alpha : refined.alphas()) bent += alpha > 0.0f ? 1 : 0;
  for (const silhouette::Origin& o : refined.stream().origins) {
    const float least = std::min({o.weights.x, o.weights.y, 1.0f - o.weights.x - o.weights.y});
    onEdges += least < 1e-6f ? 1 : 0;
  }
  ASSERT_GT(bent, 10U);
  ASSERT_GT(onEdges, bent / 2);
  const raster::Lines edges = refined.overlay(Overlay::kEdges);
  EXPECT_EQ(edges.colors.size(), bent + onEdges);  // n vertices on an edge make n + 1 lines of it
}

TEST(Overlays, EdgesTurnFromBlueToRedWithTheirAlpha) {
  Refined refined("icosphere-320", Method::kFlat);
  const std::size_t count = refined.topology().edges().size();
  refined.alphas().assign(count, 0.0f);
  EXPECT_TRUE(refined.overlay(Overlay::kEdges).colors.empty());
  glm::vec4 last{-1.0f, 0.0f, 2.0f, 1.0f};
  for (const float alpha : {0.01f, 0.3f, 0.7f, 1.0f}) {
    refined.alphas().assign(count, alpha);
    const raster::Lines edges = refined.overlay(Overlay::kEdges);
    ASSERT_EQ(edges.colors.size(), count);
    EXPECT_GT(edges.colors[0].r, last.r);
    EXPECT_LT(edges.colors[0].b, last.b);
    last = edges.colors[0];
  }
}

TEST(Overlays, FeaturesAreTheCreasesBentOrNot) {
  Refined flat("pawn", Method::kFlat), smooth("pawn", Method::kPatches), curves("pawn", Method::kCurves);
  const std::size_t edges = flat.topology().report().featureEdges;
  ASSERT_GT(edges, 0U);
  EXPECT_EQ(flat.overlay(Overlay::kFeatures).colors.size(), edges);
  for (Refined* refined : {&smooth, &curves}) {
    const raster::Lines lines = refined->overlay(Overlay::kFeatures);
    EXPECT_GT(lines.colors.size(), edges);
    for (const auto& [point, degree] : degrees(lines, all)) EXPECT_EQ(degree, 2);  // rings
  }
  EXPECT_TRUE(Refined("icosphere-320", Method::kPatches).overlay(Overlay::kFeatures).colors.empty());
}

TEST(Overlays, TheContourOfASphereIsAClosedLineWhereItsNormalsTurnAway) {
  Refined refined("icosphere-320", Method::kFlat);
  const raster::Lines contour = refined.overlay(Overlay::kContour);
  ASSERT_GT(contour.colors.size(), 20U);
  // The normal at a point x of the unit icosphere's chords is x itself: <x, o - x> = 0.
  for (const glm::vec3& x : contour.points) EXPECT_NEAR(glm::dot(x, refined.view().eye - x), 0.0f, 2e-6f);
  for (const auto& [point, degree] : degrees(contour, all)) EXPECT_EQ(degree, 2);
}

TEST(Overlays, TheContourOfCurvesIsTheirBridgesAndSegments) {
  Refined refined("icosphere-320", Method::kCurves);
  const raster::Lines contour = refined.overlay(Overlay::kContour);
  std::size_t crossed = 0;
  for (const silhouette::Edge& edge : refined.topology().edges()) {
    const auto v = silhouette::edgeVertices(refined.shape(), edge)[0];
    const auto isSeen = [&](std::uint32_t i) {
      const glm::vec3& p = refined.shape().positions[i];
      return glm::dot(refined.shape().normals[i], refined.view().eye - p) >= 0.0f;
    };
    crossed += isSeen(v[0]) != isSeen(v[1]) ? 1 : 0;
  }
  ASSERT_GT(crossed, 20U);

  std::set<float> blues;
  for (const glm::vec4& color : contour.colors) blues.insert(color.b);
  ASSERT_EQ(blues.size(), 2U);
  const float bridge = *blues.begin();
  std::size_t bridges = 0;
  for (const glm::vec4& color : contour.colors) bridges += color.b == bridge ? 1 : 0;
  EXPECT_GE(bridges, crossed);      // one line where the silhouette point became an end of its edge
  EXPECT_LE(bridges, 2 * crossed);  // else two
  const auto segments = degrees(contour, [&](const glm::vec4& color) { return color.b != bridge; });
  ASSERT_FALSE(segments.empty());
  std::set<Point> drawn;
  for (const glm::vec3& p : refined.stream().positions) drawn.insert(keyOf(p));
  for (const glm::vec3& p : refined.shape().positions) drawn.insert(keyOf(p));
  for (const auto& [point, degree] : segments) {
    EXPECT_EQ(degree, 2);
    EXPECT_TRUE(drawn.contains(point));
  }
}

TEST(Overlays, CostTheStreamNothingWhenNotAskedFor) {
  const Scene scene = load("builtin:icosphere-320");
  FrameDrawer drawer(scene, 1);
  FrameSettings settings;
  settings.refinement.method = Method::kCurves;
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  const Sphere bounds = boundingSphere(scene, pose);
  drawer.refine(pose, makeCamera(frameSphere(bounds, 64, 64, 0, 0, 1, 30, 0), bounds, 64, 64), settings);
  EXPECT_GT(drawer.instance(0).stream->triangleCount(), 0U);
  EXPECT_TRUE(drawer.instance(0).stream->contour.empty());
}

}  // namespace
}  // namespace limn::scene
