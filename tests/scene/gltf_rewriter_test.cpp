// What is copied from one file into another.
#include "apps/scene/gltf_rewriter.h"

#include <gtest/gtest.h>

namespace limn::scene {
namespace {

int highest(const char* material) {
  return highestTexcoordSet({{"materials", {nlohmann::ordered_json::parse(material)}}});
}

TEST(HighestTexcoordSet, IsThatOfAnyTextureEvenOfUnknownExtensions) {
  EXPECT_EQ(highestTexcoordSet({{"asset", {{"version", "2.0"}}}}), 0);
  EXPECT_EQ(highest(R"({})"), 0);
  EXPECT_EQ(highest(R"({"normalTexture": {"index": 0, "texCoord": 3}, "emissiveTexture": {"texCoord": 1}})"),
            3);
  EXPECT_EQ(highest(R"({"extensions": {"VENDOR_coat": {"coatTexture": {"texCoord": 2.0}}}})"), 2);
  EXPECT_EQ(highest(R"({"normalTexture": {"extensions": {"KHR_texture_transform": {"texCoord": 255}}}})"),
            255);
}

TEST(HighestTexcoordSet, IsNoneThatTheLoaderWouldRefuse) {
  EXPECT_EQ(highest(R"({"extras": {"texCoord": 4}})"), 0);
  for (const char* number : {"2000000000", "256", "-1", "1e300", "\"x\"", "null", "[7]", "{\"texCoord\": 7}"})
    EXPECT_EQ(highest((R"({"extensions": {"X": {"texCoord": )" + std::string(number) + "}}}").c_str()), 0)
        << number;
}

}  // namespace
}  // namespace limn::scene
