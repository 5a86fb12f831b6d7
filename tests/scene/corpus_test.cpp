// Real files, good and broken, that nobody here wrote: every one is drawn or refused with its name and a place, and what
// is loaded has nothing in it that drawing could trip over.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/scene/camera.h"
#include "apps/scene/frame.h"
#include "apps/scene/load.h"
#include "apps/scene/pose.h"

namespace limn::scene {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> modelsBelow(const fs::path& folder) {
  std::vector<fs::path> models;
  if (!fs::is_directory(folder)) return models;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".gltf" || extension == ".glb") models.push_back(entry.path());
  }
  std::sort(models.begin(), models.end());
  return models;
}

bool isFinite(const std::vector<glm::vec3>& vectors) {
  return std::all_of(vectors.begin(), vectors.end(),
                     [](const glm::vec3& v) { return std::isfinite(v.x + v.y + v.z); });
}

void expectSound(const Scene& scene) {
  ASSERT_FALSE(scene.materials.empty());
  ASSERT_EQ(scene.inScene.size(), scene.nodes.size());
  for (const Mesh& mesh : scene.meshes) {
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_TRUE(isFinite(mesh.positions) && isFinite(mesh.normals));
    for (const glm::vec3& n : mesh.normals)
      EXPECT_NEAR(std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z), 1.0f, 1e-4f);
    for (const std::uint32_t i : mesh.indices) ASSERT_LT(i, mesh.positions.size());
    std::uint32_t triangles = 0;
    for (const raster::Part& part : mesh.parts) {
      EXPECT_EQ(part.firstTriangle, triangles);
      EXPECT_LT(part.material, scene.materials.size());
      triangles += part.triangleCount;
    }
    EXPECT_EQ(triangles, mesh.indices.size() / 3);
  }
  Pose pose;
  for (int animation = -1; animation < static_cast<int>(scene.animations.size()); ++animation) {
    const double end = animation < 0 ? 0.0 : scene.animations[static_cast<std::size_t>(animation)].duration;
    for (const double seconds : {0.0, 0.37 * end, end}) {
      evaluatePose(scene, animation, seconds, pose);
      for (const Instance& instance : pose.instances)
        EXPECT_TRUE(isFinite(instance.positions) && isFinite(instance.normals));
      EXPECT_TRUE(std::isfinite(boundingSphere(scene, pose).radius));
    }
  }
}

/// A small frame in the middle of the first animation, or at rest: whole streams, and the scalar definition's pixels.
void expectDrawn(const Scene& scene, silhouette::Method method) {
  constexpr int kWidth = 96, kHeight = 64;
  Pose pose;
  if (scene.animations.empty())
    evaluatePose(scene, -1, 0.0, pose);
  else
    evaluatePose(scene, 0, 0.5 * scene.animations[0].duration, pose);
  const Sphere bounds = boundingSphere(scene, pose);
  const CameraView camera =
      makeCamera(frameSphere(bounds, kWidth, kHeight, 30, 20, 1, 30, 0), bounds, kWidth, kHeight);
  FrameSettings settings;
  settings.refinement.method = method;
  FrameDrawer drawer(scene, 2), definition(scene, 1, {.tileWidth = 16, .tileHeight = 8, .scalar = true});
  Image image, expected;
  drawer.draw(pose, camera, settings, image);
  definition.draw(pose, camera, settings, expected);
  EXPECT_TRUE(image.rgba == expected.rgba);
  for (std::size_t i = 0; i < pose.instances.size(); ++i)
    if (pose.instances[i].visible) {
      const RefinedInstance instance = drawer.instance(i);
      EXPECT_TRUE(instance.stream->isConsistent(instance.shape)) << "instance " << i;
    }
}

class Corpus : public testing::TestWithParam<fs::path> {};

TEST_P(Corpus, IsDrawnOrRefused) {
  const std::string file = GetParam().string();
  try {
    const Scene scene = load(file);
    expectSound(scene);
    for (const silhouette::Method method : {silhouette::Method::kFlat, silhouette::Method::kPatches})
      expectDrawn(scene, method);
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(file + ": /") || message.starts_with(file + ": byte ")) << message;
  }
}

std::string testName(const testing::TestParamInfo<fs::path>& info) {
  std::string name = std::to_string(info.index) + "_" + info.param.stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Corpus);
INSTANTIATE_TEST_SUITE_P(Broken, Corpus,
                         testing::ValuesIn(modelsBelow(fs::path(LIMN_MODELS_DIR) / "invalid")), testName);
INSTANTIATE_TEST_SUITE_P(Samples, Corpus, testing::ValuesIn(modelsBelow(fs::path(LIMN_MODELS_DIR) / "gltf")),
                         testName);
INSTANTIATE_TEST_SUITE_P(Assimp, Corpus, testing::ValuesIn(modelsBelow("/usr/share/assimp/models/glTF2")),
                         testName);

// Those that hold something to draw are not merely refused politely.
TEST(CorpusVerdicts, GoodSamplesAreDrawn) {
  const fs::path samples = fs::path(LIMN_MODELS_DIR) / "gltf";
  for (const fs::path& file : modelsBelow(samples)) {
    if (file.stem() == "Duck-meshopt") continue;  // requires an extension
    EXPECT_NO_THROW(load(file.string())) << file;
  }
}

}  // namespace
}  // namespace limn::scene
