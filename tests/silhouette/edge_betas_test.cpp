// Parameters::edgeBetas: how early each edge begins to bend, said edge by edge.
#include <gtest/gtest.h>

#include "shapes.h"

namespace limn::silhouette::test {
namespace {

class EdgeBetas : public testing::Test {
 protected:
  std::vector<float> alphas(const Parameters& parameters) {
    std::vector<float> result;
    refiner_.silhouetteness(view_, parameters, result);
    return result;
  }
  RefinedStream refined(const Parameters& parameters) {
    RefinedStream stream;
    refiner_.refine(view_, parameters, stream);
    return stream;
  }

  const Shape shape_ = icosphere(1);
  const Topology topology_{shape_.mesh()};
  const View view_ = perspectiveFrom({1, 2, 4});
  Workers workers_{1};
  Refiner refiner_{shape_.mesh(), topology_, workers_};
};

TEST_F(EdgeBetas, OneForAllIsBeta) {
  for (const Silhouetteness silhouetteness :
       {Silhouetteness::kEdge, Silhouetteness::kContour, Silhouetteness::kCrossing}) {
    Parameters constant, perEdge;
    constant.silhouetteness = perEdge.silhouetteness = silhouetteness;
    constant.beta = 0.3f;
    const std::vector<float> betas(topology_.edges().size(), 0.3f);
    perEdge.edgeBetas = betas;
    EXPECT_EQ(alphas(perEdge), alphas(constant));
    EXPECT_EQ(refined(perEdge).positions, refined(constant).positions);
    perEdge.wedgeDegrees = 60.0f;  // does not count beside them
    EXPECT_EQ(alphas(perEdge), alphas(constant));
  }
}

// With β = 0 for all others, one edge alone bends beside the silhouette, and only its two triangles are replaced for it.
TEST_F(EdgeBetas, AreInTheOrderOfTheTopologysEdges) {
  Parameters sharp;
  sharp.silhouetteness = Silhouetteness::kEdge;
  sharp.beta = 0.0f;
  const std::vector<float> sharpAlphas = alphas(sharp);
  const RefinedStream sharpStream = refined(sharp);
  std::size_t looked = 0;
  for (std::size_t e = 0; e < topology_.edges().size(); ++e) {
    if (sharpAlphas[e] > 0.0f) continue;
    std::vector<float> betas(topology_.edges().size(), 0.0f);
    betas[e] = 1e6f;
    Parameters one = sharp;
    one.edgeBetas = betas;
    std::vector<float> oneAlphas = alphas(one);
    EXPECT_GT(oneAlphas[e], 0.99f) << e;
    oneAlphas[e] = 0.0f;
    EXPECT_EQ(oneAlphas, sharpAlphas) << e;
    const RefinedStream stream = refined(one);
    for (std::uint32_t t = 0; t < shape_.mesh().triangleCount(); ++t) {
      const std::array<Side, 2>& faces = topology_.edges()[e].faces;
      const bool beside = t == faces[0].triangle || t == faces[1].triangle;
      EXPECT_EQ(stream.isReplaced(t), beside || sharpStream.isReplaced(t)) << e;
    }
    ++looked;
  }
  EXPECT_GT(looked, 20u);
}

TEST_F(EdgeBetas, AreForgottenWithTheRefinementTheyWereFor) {
  const RefinedStream before = refined({});
  const std::vector<float> betas(topology_.edges().size(), 1e6f);
  Parameters parameters;
  parameters.edgeBetas = betas;
  EXPECT_GT(refined(parameters).triangleCount(), before.triangleCount());
  EXPECT_EQ(refined({}).positions, before.positions);
}

}  // namespace
}  // namespace limn::silhouette::test
