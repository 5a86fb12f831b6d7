// The same bytes in every plane for any number of threads; and for the same triangles however they are handed
// over.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/raster/oracle_scene.h"

namespace limn::test {
namespace {

// Overlapping spheres and tori, lit, some of them reflected, one around the eye.
struct Crowd {
  raster::Geometry ball = sphere(14, 20).geometry();
  raster::Geometry ring = torus(24, 12, 0.4f).geometry();
  std::vector<raster::Draw> draws;
  raster::Material material;
  raster::Light light;

  Crowd() {
    material.doubleSided = true;
    std::uint32_t firstId = 0;
    for (int i = 0; i < 24; ++i) {
      raster::Draw draw;
      draw.geometry = i % 2 == 0 ? &ball : &ring;
      const glm::vec3 place(0.5f * static_cast<float>(i % 6) - 1.25f,
                            0.5f * static_cast<float>(i / 6) - 0.75f,
                            -4.0f - 0.2f * static_cast<float>(i * 7 % 5));
      glm::mat4 m = glm::translate(glm::mat4(1.0f), i == 5 ? glm::vec3(0.2f, 0.1f, -0.9f) : place);
      m = glm::rotate(m, 0.7f * static_cast<float>(i), glm::vec3(0.6f, 0.8f, 0.0f));
      m = glm::scale(m, glm::vec3(0.4f, 0.45f, i % 4 == 0 ? -0.4f : 0.5f));
      draw.modelToView = m;
      draw.firstId = firstId;
      firstId += static_cast<std::uint32_t>(draw.geometry->triangleCount());
      draws.push_back(draw);
    }
  }

  raster::Frame frame(int samples) const {
    raster::Frame frame;
    frame.projection = perspectiveProjection(301, 203, 40.0, 0.1f, 50.0f);
    frame.draws = draws;
    frame.materials = std::span(&material, 1);
    frame.lights = std::span(&light, 1);
    frame.background = glm::vec4(0.10f, 0.12f, 0.18f, 0.5f);
    frame.samples = samples;
    return frame;
  }
};

TEST(OracleThreads, AnyNumberOfThreadsDrawsTheSameBytes) {
  const Crowd crowd;
  for (const int samples : {1, 4, 8}) {
    raster::Renderer one(1);
    const Picture expected = render(one, crowd.frame(samples));
    for (const int threads : {2, 3, 8, 32}) {
      raster::Renderer renderer(threads);
      for (int repeat = 0; repeat < 3; ++repeat) {
        EXPECT_TRUE(render(renderer, crowd.frame(samples)) == expected)
            << threads << " threads, " << samples << " samples, repeat " << repeat;
      }
    }
  }
}

// A stream that replaces some triangles by themselves changes nothing.
TEST(OracleThreads, AStreamOfTheSameTrianglesDrawsTheSameBytes) {
  Crowd crowd;
  raster::Renderer renderer(2);
  const Picture expected = render(renderer, crowd.frame(4));
  const Soup ball = sphere(14, 20);
  const std::size_t words = (ball.triangleCount() + 63) / 64;
  std::vector<std::uint64_t> replaced(words, 0);
  raster::Stream stream;
  std::vector<std::uint32_t> indices, sources;
  const auto vertexCount = static_cast<std::uint32_t>(ball.positions.size());
  for (std::uint32_t t = 0; t < ball.triangleCount(); t += 3) {
    replaced[t / 64] |= std::uint64_t{1} << t % 64;
    sources.push_back(t);
    // Every other one with vertices of the stream's own.
    for (int k = 0; k < 3; ++k) indices.push_back(ball.indices[3 * t + k] + (t % 2 == 0 ? 0 : vertexCount));
  }
  stream.vertices = ball.vertices();
  stream.indices = indices;
  stream.sourceTriangles = sources;
  for (raster::Draw& draw : crowd.draws) {
    if (draw.geometry != &crowd.ball) continue;
    draw.replaced = replaced;
    draw.stream = stream;
  }
  EXPECT_TRUE(render(renderer, crowd.frame(4)) == expected);
}

// Positions given anew, equal to the old ones, change nothing either, although culling takes another way.
TEST(OracleThreads, PosedPositionsEqualToTheOwnDrawTheSameBytes) {
  Crowd crowd;
  raster::Renderer renderer(2);
  const Picture expected = render(renderer, crowd.frame(1));
  const Soup ring = torus(24, 12, 0.4f);
  for (raster::Draw& draw : crowd.draws) {
    if (draw.geometry != &crowd.ring) continue;
    draw.posedPositions = ring.positions;
    draw.posedNormals = ring.normals;
  }
  EXPECT_TRUE(render(renderer, crowd.frame(1)) == expected);
}

}  // namespace
}  // namespace limn::test
