// What options mean, and what is refused.
#include "apps/limn/values.h"

#include <gtest/gtest.h>

#include <array>

#include "apps/limn/aov.h"
#include "apps/limn/pattern.h"

namespace {

using limn::program::FrameList;
using limn::program::OutputPattern;
using limn::program::UsageError;

std::vector<int> frames(std::string_view text) {
  const FrameList list = FrameList::parse(text);
  std::vector<int> all;
  for (int i = 0; i < list.count(); ++i) all.push_back(list.at(i));
  return all;
}

TEST(FrameList, NamesFramesInTheOrderGiven) {
  EXPECT_EQ(frames("7"), (std::vector{7}));
  EXPECT_EQ(frames("1-4"), (std::vector{1, 2, 3, 4}));
  EXPECT_EQ(frames("3-3"), (std::vector{3}));
  EXPECT_EQ(frames("8-10,2,20-26:3"), (std::vector{8, 9, 10, 2, 20, 23, 26}));
  EXPECT_EQ(frames("20-27:3"), (std::vector{20, 23, 26}));
  EXPECT_EQ(FrameList::parse("20-27:3,5").largest(), 26);
  EXPECT_EQ(FrameList::parse("1-10,15,20-40:2").text(), "1-10,15,20-40:2");
  EXPECT_EQ(FrameList::all(36).text(), "1-36");
}

TEST(FrameList, RefusesWhatIsNone) {
  for (const char* text : {"", ",", "1,", "0", "-3", "5-2", "1-", "1:2", "a", "1-5:0", "1-5:2:3", "1-2-3",
                           "1 2", "1,1", "1-5,3", "1-9:2,5", "99999999999"})
    EXPECT_THROW(FrameList::parse(text), UsageError) << text;
}

TEST(OutputPattern, PutsTheNumberIn) {
  EXPECT_EQ(OutputPattern("frames/%04d.png").path(7), "frames/0007.png");
  EXPECT_EQ(OutputPattern("frames/####.png").path(7), "frames/0007.png");
  EXPECT_EQ(OutputPattern("%d.png").path(12345), "12345.png");
  EXPECT_EQ(OutputPattern("##.png").path(12345), "12345.png");
  EXPECT_EQ(OutputPattern("100%%/%02d").path(3), "100%/03");
  EXPECT_FALSE(OutputPattern("plain.png").hasNumber());
  EXPECT_EQ(OutputPattern("plain.png").path(3), "plain.png");
  EXPECT_TRUE(OutputPattern("-").isStandardOutput());
  EXPECT_FALSE(OutputPattern("-.png").isStandardOutput());
}

TEST(OutputPattern, RefusesOtherConversions) {
  for (const char* text : {"", "%s.png", "%", "%5d.png", "%0999d", "%d%d", "#-#", "%d-#", "a%"})
    EXPECT_THROW(OutputPattern{text}, UsageError) << text;
}

TEST(BytesPerPixel, CountsThePlanesThatAreWanted) {
  using limn::program::Aov;
  EXPECT_EQ(limn::program::bytesPerPixel({}), 4U);
  EXPECT_EQ(limn::program::bytesPerPixel({Aov::kDepth}), 8U);
  EXPECT_EQ(limn::program::bytesPerPixel({Aov::kId, Aov::kNormal}), 20U);
  EXPECT_EQ(limn::program::bytesPerPixel({Aov::kDepth, Aov::kNormal, Aov::kId}), 24U);
}

TEST(BesidePath, GoesBeforeTheExtension) {
  EXPECT_EQ(limn::program::besidePath("a/b.png", "depth"), "a/b.depth.png");
  EXPECT_EQ(limn::program::besidePath("a.b/c", "id"), "a.b/c.id.png");
  EXPECT_EQ(limn::program::besidePath("a/.c", "id"), "a/.c.id.png");
}

TEST(Values, AreReadWholeOrRefused) {
  EXPECT_EQ(limn::program::parseNumber("-1.5e3"), -1500.0);
  EXPECT_EQ(limn::program::parseNumber("+2"), 2.0);
  for (const char* text : {"", "1x", "nan", "inf", "1e999", " 1", "0x10", "1,5"})
    EXPECT_THROW(limn::program::parseNumber(text), UsageError) << text;
  EXPECT_EQ(limn::program::parseSize("16384x1"), std::pair(16384, 1));
  for (const char* text : {"", "x", "12", "0x5", "5x0", "-1x5", "16385x1", "12X5", "1x2x3", "99999999999x1"})
    EXPECT_THROW(limn::program::parseSize(text), UsageError) << text;
  EXPECT_EQ(limn::program::parseVector("-1,.5,2e1"), glm::dvec3(-1, 0.5, 20));
  for (const char* text : {"1,2", "1,2,3,4", "1,2,", "a,b,c", "1;2;3"})
    EXPECT_THROW(limn::program::parseVector(text), UsageError) << text;
  EXPECT_EQ(limn::program::parseTimes("0:2.5"), std::pair(0.0, 2.5));
  for (const char* text : {"1", "2:1", ":", "1:2:3"})
    EXPECT_THROW(limn::program::parseTimes(text), UsageError) << text;
  EXPECT_EQ(limn::program::parseShard("2/8"), std::pair(2, 8));
  for (const char* text : {"0/8", "9/8", "1", "1/0", "-1/2"})
    EXPECT_THROW(limn::program::parseShard(text), UsageError) << text;
}

TEST(Colors, ComeBackAsTheyWere) {
  for (int value = 0; value < 256; ++value) {
    const char* digits = "0123456789abcdef";
    const std::string byte = {digits[value >> 4], digits[value & 15]};
    std::string color = "#";
    color.append(byte).append(byte).append("80").append(byte);
    EXPECT_EQ(limn::program::colorText(limn::program::parseColor(color)), color);
  }
  EXPECT_EQ(limn::program::colorText(limn::program::parseColor("#f80")), "#ff8800ff");
  EXPECT_EQ(limn::program::parseColor("transparent"), glm::vec4(0));
  EXPECT_EQ(limn::program::parseColor("white"), glm::vec4(1));
  for (const char* text : {"", "#12", "#12345", "#gggggg", "#123456789", "blu ish"})
    EXPECT_THROW(limn::program::parseColor(text), UsageError) << text;
}

TEST(Choices, SuggestTheNearest) {
  const std::vector<std::string> names = {"flat", "patches"};
  EXPECT_EQ(limn::program::parseChoice("patches", names), 1);
  try {
    limn::program::parseChoice("patchs", names);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean patches?"), std::string::npos) << error.what();
  }
}

TEST(NumberText, IsTheShortestThatReadsBack) {
  for (const double value : {0.1, 1.0 / 3.0, -1e-300, 1e22, 123456789.0})
    EXPECT_EQ(limn::program::parseNumber(limn::program::numberText(value)), value);
  EXPECT_EQ(limn::program::numberText(0.25), "0.25");
  EXPECT_EQ(limn::program::numberText(-0.0), "0");
}

}  // namespace
