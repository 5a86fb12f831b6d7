// PNG files: what is written is what is read, the bytes are always the same, and damage is noticed.
#include "apps/scene/image.h"

#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <stdexcept>
#include <thread>

#include "apps/scene/load.h"

namespace {

using limn::scene::Image;
using limn::scene::Image16;
using limn::scene::TextChunks;

class ImageFile : public testing::Test {
 protected:
  ImageFile()
      : directory_(std::filesystem::temp_directory_path() / ("limn-image-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(directory_);
  }
  ~ImageFile() override { std::filesystem::remove_all(directory_); }

  std::string write(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    std::string path = directory_ / name;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path;
  }

  std::filesystem::path directory_;
};

/// Smooth areas and noise, every alpha.
Image testImage(int width, int height, unsigned seed) {
  Image image{width, height,
              std::vector<std::uint8_t>(4U * static_cast<unsigned>(width) * static_cast<unsigned>(height))};
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = static_cast<std::uint8_t>(i % 7 == 0 ? random() : i / 4);
  return image;
}

/// What another reader finds.
TextChunks textsByLibpng(const std::string& path) {
  const std::unique_ptr<std::FILE, decltype(&std::fclose)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file.get());
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_textp chunks = nullptr;
  int count = 0;
  png_get_text(png, info, &chunks, &count);
  TextChunks texts;
  for (int i = 0; i < count; ++i) texts.emplace_back(chunks[i].key, chunks[i].text);
  png_destroy_read_struct(&png, &info, nullptr);
  return texts;
}

TEST_F(ImageFile, WhatIsWrittenIsRead) {
  const TextChunks texts = {{"Software", "limn"}, {"Comment", "na\xc3\xafve \xe2\x80\x93 text"}};
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 17}, {33, 1}, {640, 37}}) {
    for (const int level : {0, 1, 6, 12}) {
      const Image image = testImage(width, height, 5);
      const std::string path = write("a.png", limn::scene::encodePng(image, texts, level));
      const Image again = limn::scene::readPng(path);
      EXPECT_EQ(again.width, width);
      EXPECT_EQ(again.height, height);
      EXPECT_EQ(again.rgba, image.rgba) << width << 'x' << height << " level " << level;
      EXPECT_EQ(textsByLibpng(path), texts);
      limn::scene::PngSummary summary;
      ASSERT_TRUE(limn::scene::inspectPng(path, summary));
      EXPECT_EQ(summary.width, width);
      EXPECT_EQ(summary.height, height);
      EXPECT_EQ(summary.texts, texts);
    }
  }
}

TEST_F(ImageFile, SixteenBitsKeepEveryBit) {
  std::mt19937 random(3);
  for (const int channels : {1, 3, 4}) {
    Image16 image{31, 17, channels, std::vector<std::uint16_t>(31U * 17U * static_cast<unsigned>(channels))};
    for (std::uint16_t& sample : image.samples) sample = static_cast<std::uint16_t>(random());
    const std::string path = write("b.png", limn::scene::encodePng16(image, {{"near", "1.5"}}, 1));
    bool is16 = false;
    const Image16 read = limn::scene::readPng16(path, &is16);
    EXPECT_TRUE(is16);
    for (std::size_t pixel = 0; pixel < 31U * 17U; ++pixel)
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_EQ(read.samples[4 * pixel + c],
                  image.samples[static_cast<std::size_t>(channels) * pixel + (channels == 1 ? 0 : c)]);
    limn::scene::PngSummary summary;
    ASSERT_TRUE(limn::scene::inspectPng(path, summary));
    EXPECT_EQ(summary.texts, (TextChunks{{"near", "1.5"}}));
  }
}

TEST_F(ImageFile, EightBitsReadAsSixteenAreTimes257) {
  const Image image = testImage(9, 9, 1);
  bool is16 = true;
  const Image16 read = limn::scene::readPng16(write("c.png", limn::scene::encodePng(image, {}, 1)), &is16);
  EXPECT_FALSE(is16);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) ASSERT_EQ(read.samples[i], 257 * image.rgba[i]);
}

TEST(EncodePng, SameBytesFromEveryThreadAndAChunkForTheColourSpace) {
  const Image image = testImage(320, 200, 8);
  const auto expected = limn::scene::encodePng(image, {{"a", "b"}}, 1);
  const auto other = limn::scene::encodePng(image, {{"a", "b"}}, 9);
  EXPECT_NE(expected, other);
  EXPECT_EQ(std::memcmp(&expected[33], "\0\0\0\1sRGB\0\xae\xce\x1c\xe9", 13), 0);
  std::vector<std::thread> threads;
  std::array<bool, 8> same{};
  for (std::size_t t = 0; t < same.size(); ++t)
    threads.emplace_back([&, t] {
      same[t] = limn::scene::encodePng(image, {{"a", "b"}}, t % 2 ? 9 : 1) == (t % 2 ? other : expected);
    });
  for (std::thread& thread : threads) thread.join();
  for (const bool s : same) EXPECT_TRUE(s);
}

TEST(EncodePng, RefusesWhatIsNoPicture) {
  EXPECT_THROW(limn::scene::encodePng({0, 1, {}}, {}, 1), std::invalid_argument);
  EXPECT_THROW(limn::scene::encodePng({1, 1, {1, 2, 3}}, {}, 1), std::invalid_argument);
  EXPECT_THROW(limn::scene::encodePng({1, 1, {1, 2, 3, 4}}, {}, 13), std::invalid_argument);
  EXPECT_THROW(limn::scene::encodePng({1, 1, {1, 2, 3, 4}}, {{"", "x"}}, 1), std::invalid_argument);
}

TEST_F(ImageFile, EveryCutAndEveryFlippedBitIsNoticed) {
  const Image image = testImage(12, 9, 4);
  const auto whole = limn::scene::encodePng(image, {{"Comment", "text"}}, 1);
  limn::scene::PngSummary summary;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string path =
        write("cut.png", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    ASSERT_FALSE(limn::scene::inspectPng(path, summary)) << size;
    if (size + 12 < whole.size()) {  // all but the end chunk
      ASSERT_THROW(limn::scene::readPng(path), limn::scene::InputError) << size;
    }
  }
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<std::uint8_t> damaged = whole;
    damaged[i] ^= static_cast<std::uint8_t>(1U << i % 8);
    ASSERT_FALSE(limn::scene::inspectPng(write("damaged.png", damaged), summary)) << i;
  }
  std::vector<std::uint8_t> longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(limn::scene::inspectPng(write("longer.png", longer), summary));
  EXPECT_FALSE(limn::scene::inspectPng(directory_ / "missing.png", summary));
}

TEST_F(ImageFile, MessagesNameTheFileAndMemoryIsNotTakenOnTrust) {
  auto huge = limn::scene::encodePng(testImage(1, 1, 1), {}, 1);
  const std::uint8_t size[8] = {0, 0, 0x40, 0, 0, 0, 0x40, 0};  // 16384 x 16384 in a hundred bytes
  std::memcpy(&huge[16], size, 8);
  const std::uint8_t crc[4] = {0xa9, 0xc8, 0x10, 0x84};
  std::memcpy(&huge[29], crc, 4);
  for (const std::string& path :
       {write("huge.png", huge), write("text.png", {'h', 'e', 'l', 'l', 'o', ' ', 'y', 'o', 'u'}),
        std::string("/nowhere/x.png")}) {
    try {
      limn::scene::readPng(path);
      FAIL() << path;
    } catch (const limn::scene::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
  }
}

TEST(PixelHash, IsTheOneOfXxh128sum) {
  // printf '' | xxh128sum; printf 'limn' | xxh128sum
  EXPECT_EQ(limn::scene::hashBytes("", 0), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(limn::scene::hashBytes("limn", 4), "03567cb5ef2f62fd3ec615ac9797141b");
}

}  // namespace
