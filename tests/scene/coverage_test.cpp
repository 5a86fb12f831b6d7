// What is closed is drawn without a crack and without an overlap, flat and refined, on models that nobody here wrote
// and on those that are always there.
//
// Triangles are drawn one by one, so that what lies behind another is seen as well. A ray that enters a closed surface
// leaves it again: every pixel has as many front faces as back faces.
#include <gtest/gtest.h>

#include <algorithm>

#include "apps/scene/frame.h"
#include "apps/scene/load.h"
#include "model_files.h"

namespace limn::scene {
namespace {

using silhouette::Method;

constexpr std::size_t kMostTriangles = 1200;

bool isClosed(const silhouette::Topology& topology) {
  const silhouette::TopologyReport& report = topology.report();
  return report.boundaryEdges == 0 && report.nonManifoldEdges == 0 && report.degenerateTriangles == 0;
}

/// Front faces less back faces at every pixel, and how many faces there are in all.
class LayerCount {
 public:
  LayerCount(const Projection& projection, const glm::mat4& modelToView)
      : modelToView_(modelToView),
        pixels_(static_cast<std::size_t>(projection.width) * static_cast<std::size_t>(projection.height)),
        rgba_(4 * pixels_),
        ids_(pixels_),
        excess_(pixels_) {
    frame_.projection = projection;
    frame_.samples = 1;
    target_.rgba = rgba_.data(), target_.rgbaStride = 4 * static_cast<std::size_t>(projection.width);
    target_.ids = ids_.data(), target_.idStride = static_cast<std::size_t>(projection.width);
  }

  void add(const std::array<glm::vec3, 3>& corners) {
    addFace(corners, 1);
    addFace({corners[0], corners[2], corners[1]}, -1);
  }
  std::size_t uneven() const {
    return pixels_ - static_cast<std::size_t>(std::count(excess_.begin(), excess_.end(), 0));
  }
  std::size_t faces() const { return faces_; }

 private:
  void addFace(const std::array<glm::vec3, 3>& corners, int sign) {
    static constexpr std::array<std::uint32_t, 3> kIndices{0, 1, 2};
    static constexpr std::array<glm::vec3, 3> kNormals{glm::vec3(0, 0, 1), glm::vec3(0, 0, 1),
                                                       glm::vec3(0, 0, 1)};
    static constexpr raster::Part kPart{0, 1, 0};
    raster::Vertices vertices;
    vertices.positions = corners, vertices.normals = kNormals;
    const raster::Geometry geometry(vertices, kIndices, std::span(&kPart, 1));
    raster::Draw draw;
    draw.geometry = &geometry;
    draw.modelToView = modelToView_;
    frame_.draws = std::span(&draw, 1);
    frame_.materials = std::span(&material_, 1);
    renderer_.draw(frame_, target_);
    for (std::size_t i = 0; i < pixels_; ++i) {
      const int covered = ids_[i] == 0 ? 1 : 0;
      excess_[i] += sign * covered;
      faces_ += static_cast<std::size_t>(covered);
    }
  }

  glm::mat4 modelToView_;
  std::size_t pixels_, faces_ = 0;
  std::vector<std::uint8_t> rgba_;
  std::vector<std::uint32_t> ids_;
  std::vector<int> excess_;
  raster::Frame frame_;
  raster::Target target_;
  raster::Material material_;
  raster::Renderer renderer_{1};
};

class Coverage : public testing::TestWithParam<std::string> {};

TEST_P(Coverage, OfAClosedModelIsEvenFlatAndRefined) {
  const Scene scene = load(GetParam());
  if (scene.meshes.size() != 1 || scene.meshes[0].indices.size() / 3 > kMostTriangles)
    GTEST_SKIP() << "too large";
  Pose pose;
  evaluatePose(scene, -1, 0.0, pose);
  const Sphere bounds = boundingSphere(scene, pose);
  FrameDrawer drawer(scene, 1);
  for (const Method method : {Method::kFlat, Method::kPatches, Method::kCurves}) {
    const CameraView camera = makeCamera(
        frameSphere(bounds, 61, 47, 33.0 + 70.0 * static_cast<int>(method), 17, 1, 30, 0), bounds, 61, 47);
    FrameSettings settings;
    settings.refinement.method = method;
    drawer.refine(pose, camera, settings);
    const RefinedInstance instance = drawer.instance(0);
    if (!isClosed(*instance.topology)) GTEST_SKIP() << "not closed";
    const silhouette::View view =
        silhouette::makeView(camera.projection, camera.worldToView * instance.shapeToWorld);
    const auto position = [&](std::uint32_t v) {
      const std::size_t ofMesh = instance.shape.positions.size();
      return v < ofMesh ? instance.shape.positions[v] : instance.stream->positions[v - ofMesh];
    };
    LayerCount layers(camera.projection, view.modelToView);
    const auto add = [&](const std::uint32_t* i) {
      layers.add({position(i[0]), position(i[1]), position(i[2])});
    };
    for (std::size_t t = 0; t < instance.shape.triangleCount(); ++t)
      if (!instance.stream->isReplaced(t)) add(&instance.shape.indices[3 * t]);
    for (std::size_t t = 0; t < instance.stream->triangleCount(); ++t) add(&instance.stream->indices[3 * t]);
    EXPECT_GT(layers.faces(), 300U);
    EXPECT_EQ(layers.uneven(), 0U) << "method " << static_cast<int>(method);
  }
}

INSTANTIATE_TEST_SUITE_P(Models, Coverage, testing::ValuesIn(smallModels()), testNameOf);

}  // namespace
}  // namespace limn::scene
