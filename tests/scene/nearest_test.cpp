#include "apps/scene/nearest.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace limn::scene {
namespace {

TEST(NearestName, FindsTheFewestEditsFirstOneOnTies) {
  const std::vector<std::string> known = {"render", "refine", "info", "compare"};
  EXPECT_EQ(nearestName("rendr", known), "render");
  EXPECT_EQ(nearestName("redner", known), "render");  // a swap is one edit
  EXPECT_EQ(nearestName("inof", known), "info");
  EXPECT_EQ(nearestName("comp", known), "compare");
  EXPECT_EQ(nearestName("zebra", known), "");
  EXPECT_EQ(nearestName("", known), "");
  EXPECT_EQ(nearestName(std::string(1000, 'a'), known), "");
}

}  // namespace
}  // namespace limn::scene
