// The pictures of the README and the manual, made by limn itself: limn_pictures FOLDER.
//
// Each shows a coarse mesh flat beside smooth, and below both the framed part drawn four times as large.
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <string>

#include "apps/scene/camera.h"
#include "apps/scene/frame.h"
#include "apps/scene/image.h"
#include "apps/scene/load.h"
#include "apps/scene/pose.h"
#include "raster/base/workers.h"

namespace {

using namespace limn;
using Color = std::array<std::uint8_t, 4>;

constexpr int kPanel = 480;  // pixels, width and height of each of the four panels
constexpr int kGap = 8;
constexpr int kZoom = 4;
constexpr int kFraming = 2;  // width of the frame around the part that is enlarged

struct Picture {
  const char* file;
  const char* model;
  double azimuth, elevation, zoom;
  double partX, partY;  // upper left corner of the enlarged part, as fractions of the panel
};

constexpr Picture kPictures[] = {
    {"demo.png", "builtin:demo", 30, 20, 1.0, 0.40, 0.10},
    {"knot.png", "builtin:knot-480", 20, 10, 1.0, 0.10, 0.05},
};

void fill(scene::Image& image, int x0, int y0, int x1, int y1, Color color) {
  for (int y = std::max(0, y0); y < std::min(image.height, y1); ++y)
    for (int x = std::max(0, x0); x < std::min(image.width, x1); ++x)
      std::copy(color.begin(), color.end(), &image.rgba[4 * (std::size_t(y) * image.width + x)]);
}

void outline(scene::Image& image, int x, int y, int size, Color color) {
  fill(image, x - kFraming, y - kFraming, x + size + kFraming, y, color);
  fill(image, x - kFraming, y + size, x + size + kFraming, y + size + kFraming, color);
  fill(image, x - kFraming, y, x, y + size, color);
  fill(image, x + size, y, x + size + kFraming, y + size, color);
}

void paste(const scene::Image& from, int fromX, int fromY, scene::Image& to, int toX, int toY) {
  for (int y = 0; y < kPanel; ++y) {
    const std::uint8_t* row = &from.rgba[4 * (std::size_t(fromY + y) * from.width + fromX)];
    std::copy(row, row + 4 * kPanel, &to.rgba[4 * (std::size_t(toY + y) * to.width + toX)]);
  }
}

scene::Image compose(const Picture& picture, int threads) {
  const scene::Scene scene = scene::load(picture.model);
  scene::Pose pose;
  scene::evaluatePose(scene, -1, 0.0, pose);
  const scene::Sphere bounds = scene::boundingSphere(scene, pose);
  scene::FrameDrawer drawer(scene, threads);

  scene::Image out;
  out.width = out.height = 2 * kPanel + kGap;
  out.rgba.assign(4 * std::size_t(out.width) * out.height, 255);
  const int part = kPanel / kZoom;
  const int partX = int(picture.partX * kPanel), partY = int(picture.partY * kPanel);
  for (const silhouette::Method method : {silhouette::Method::kFlat, silhouette::Method::kPatches}) {
    scene::FrameSettings settings;
    settings.refinement.method = method;
    settings.background = {1.0f, 1.0f, 1.0f, 1.0f};
    const int left = method == silhouette::Method::kFlat ? 0 : kPanel + kGap;
    scene::Image image;
    for (const int scale : {1, kZoom}) {
      const int size = kPanel * scale;
      const scene::LookAt lookAt =
          scene::frameSphere(bounds, size, size, picture.azimuth, picture.elevation, picture.zoom, 30.0, 0.0);
      drawer.draw(pose, scene::makeCamera(lookAt, bounds, size, size), settings, image);
      if (scale == 1)
        paste(image, 0, 0, out, left, 0);
      else
        paste(image, partX * kZoom, partY * kZoom, out, left, kPanel + kGap);
    }
    outline(out, left + partX, partY, part, {200, 40, 40, 255});
    outline(out, left + kFraming, kPanel + kGap + kFraming, kPanel - 2 * kFraming, {200, 40, 40, 255});
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fputs("usage: limn_pictures FOLDER\n", stderr);
    return 2;
  }
  for (const Picture& picture : kPictures) {
    const scene::Image image = compose(picture, availableThreads());
    const std::string path = std::string(argv[1]) + "/" + picture.file;
    const std::vector<std::uint8_t> png = scene::encodePng(image, {}, 9);
    scene::writeFileWhole(path, png.data(), png.size());
    std::printf("%s\n", path.c_str());
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "limn_pictures: %s\n", error.what());
  return 1;
}
