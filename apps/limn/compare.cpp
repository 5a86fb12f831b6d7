// limn compare: two images, sample by sample.
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "apps/limn/commands.h"
#include "apps/scene/image.h"

namespace limn::program {
namespace {

struct Comparison {
  std::size_t differentPixels = 0;
  int largest = 0;   ///< of 65535
  int x = 0, y = 0;  ///< where the largest is
};

/// Largest difference of the four samples of a pixel; all of the range where one image has no such pixel.
int differenceAt(const scene::Image16& a, const scene::Image16& b, int x, int y) {
  if (x >= std::min(a.width, b.width) || y >= std::min(a.height, b.height)) return 65535;
  const auto pixel = [&](const scene::Image16& image) {
    return &image.samples[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                               static_cast<std::size_t>(x))];
  };
  int largest = 0;
  for (int c = 0; c < 4; ++c) largest = std::max(largest, std::abs(int{pixel(a)[c]} - int{pixel(b)[c]}));
  return largest;
}

/// Calls visit(x, y, difference) for every pixel of either image.
template <class Visit>
void forEachPixel(const scene::Image16& a, const scene::Image16& b, const Visit& visit) {
  const int width = std::max(a.width, b.width), height = std::max(a.height, b.height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) visit(x, y, differenceAt(a, b, x, y));
}

Comparison compareSamples(const scene::Image16& a, const scene::Image16& b) {
  Comparison result;
  forEachPixel(a, b, [&](int x, int y, int difference) {
    if (difference == 0) return;
    ++result.differentPixels;
    if (difference > result.largest) result.largest = difference, result.x = x, result.y = y;
  });
  return result;
}

/// A faint grey copy of the first image, and from red to yellow what differs: even the smallest difference shows.
scene::Image differencePicture(const scene::Image16& a, const scene::Image16& b) {
  scene::Image picture;
  picture.width = std::max(a.width, b.width);
  picture.height = std::max(a.height, b.height);
  picture.rgba.reserve(4 * static_cast<std::size_t>(picture.width) *
                       static_cast<std::size_t>(picture.height));
  forEachPixel(a, b, [&](int x, int y, int difference) {
    std::uint8_t red = 255, green = 0, blue = 0;
    if (difference > 0) {
      green = static_cast<std::uint8_t>(difference >> 8);
    } else {
      const std::uint16_t* p =
          &a.samples[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(a.width) +
                          static_cast<std::size_t>(x))];
      const unsigned grey = (2U * p[0] + 5U * p[1] + p[2]) / 8U * p[3] / 65535U;
      red = green = blue = static_cast<std::uint8_t>(grey >> 10);
    }
    picture.rgba.insert(picture.rgba.end(), {red, green, blue, 255});
  });
  return picture;
}

}  // namespace

int compare(const CompareOptions& options) {
  bool deepA = false, deepB = false;
  const scene::Image16 a = scene::readPng16(options.first, &deepA);
  const scene::Image16 b = scene::readPng16(options.second, &deepB);
  const Comparison found = compareSamples(a, b);
  if (options.output) {
    const auto bytes = scene::encodePng(differencePicture(a, b), {}, 6);
    scene::makeDirectoriesOf(*options.output);
    scene::writeFileWhole(*options.output, bytes.data(), bytes.size());
  }
  if (found.differentPixels == 0) {
    std::cout << "identical: " << a.width << 'x' << a.height << " pixels" << std::endl;
    return kDone;
  }
  if (a.width != b.width || a.height != b.height)
    std::cout << "sizes differ: " << a.width << 'x' << a.height << " and " << b.width << 'x' << b.height
              << '\n';
  // 16-bit samples count in their own steps; where both images have 8 bits, in those of 8.
  const int scale = deepA || deepB ? 1 : 257;
  const std::size_t pixels = static_cast<std::size_t>(std::max(a.width, b.width)) *
                             static_cast<std::size_t>(std::max(a.height, b.height));
  std::cout << found.differentPixels << " of " << pixels << " pixels differ, the largest difference is "
            << found.largest / scale << " of " << 65535 / scale << " at " << found.x << ',' << found.y
            << std::endl;
  return kDifferent;
}

}  // namespace limn::program
