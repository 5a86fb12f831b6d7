#include "apps/limn/aov.h"

#include <algorithm>
#include <array>

#include "apps/limn/values.h"

namespace limn::program {
namespace {

const std::vector<std::string>& names() {
  static const std::vector<std::string> all = {"depth", "normal", "id"};
  return all;
}

std::uint16_t to16(double share) {
  return static_cast<std::uint16_t>(std::clamp(share, 0.0, 1.0) * 65535.0 + 0.5);
}

void fillDepth(const scene::Planes& planes, double nearPlane, double farPlane, scene::Image16& out) {
  const double scale = 1.0 / (farPlane - nearPlane);
  for (std::size_t i = 0; i < out.samples.size(); ++i)
    out.samples[i] = to16((static_cast<double>(planes.depth[i]) - nearPlane) * scale);
}

void fillNormals(const scene::Planes& planes, scene::Image16& out) {
  for (std::size_t i = 0; i < planes.normals.size(); ++i)
    for (int c = 0; c < 3; ++c)
      out.samples[3 * i + static_cast<std::size_t>(c)] =
          to16(0.5 * static_cast<double>(planes.normals[i][c]) + 0.5);
}

void fillIds(const scene::Planes& planes, scene::Image16& out) {
  for (std::size_t i = 0; i < planes.ids.size(); ++i) {
    const std::uint32_t id = planes.ids[i];
    const auto low = static_cast<std::uint16_t>(id), high = static_cast<std::uint16_t>(id >> 16);
    if (out.channels == 1) {
      out.samples[i] = low;
    } else {
      out.samples[3 * i] = low;
      out.samples[3 * i + 1] = high;
      out.samples[3 * i + 2] = id == raster::kNoId ? std::uint16_t{65535} : std::uint16_t{0};
    }
  }
}

}  // namespace

const std::string& aovName(Aov aov) {
  return names()[static_cast<std::size_t>(aov)];
}

std::vector<Aov> parseAovs(std::string_view text) {
  std::vector<Aov> aovs;
  for (const int choice : parseChoices(text, names())) aovs.push_back(static_cast<Aov>(choice));
  return aovs;
}

void wantPlanes(const std::vector<Aov>& aovs, scene::Planes& planes) {
  for (const Aov aov : aovs) {
    planes.wantsDepth |= aov == Aov::kDepth;
    planes.wantsNormals |= aov == Aov::kNormal;
    planes.wantsIds |= aov == Aov::kId;
  }
}

std::size_t bytesPerPixel(const std::vector<Aov>& aovs) {
  scene::Planes planes;
  wantPlanes(aovs, planes);
  constexpr std::size_t kRgba = 4;
  return kRgba + (planes.wantsDepth ? sizeof(planes.depth[0]) : 0) +
         (planes.wantsNormals ? sizeof(planes.normals[0]) : 0) +
         (planes.wantsIds ? sizeof(planes.ids[0]) : 0);
}

scene::Image16 aovImage(Aov aov, const scene::Planes& planes, const scene::Image& picture,
                        const Projection& projection, std::size_t triangles, scene::TextChunks& texts) {
  const std::size_t pixels =
      static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
  const bool isGrey = aov == Aov::kDepth || (aov == Aov::kId && triangles <= 65535);
  scene::Image16 out{picture.width, picture.height, isGrey ? 1 : 3, {}};
  out.samples.resize(pixels * static_cast<std::size_t>(out.channels));
  switch (aov) {
    case Aov::kDepth:
      fillDepth(planes, static_cast<double>(projection.nearPlane), static_cast<double>(projection.farPlane),
                out);
      texts.emplace_back("limn-near", numberText(static_cast<double>(projection.nearPlane)));
      texts.emplace_back("limn-far", numberText(static_cast<double>(projection.farPlane)));
      break;
    case Aov::kNormal:
      fillNormals(planes, out);
      texts.emplace_back("limn-normal", "view space, (n + 1) / 2");
      break;
    case Aov::kId:
      fillIds(planes, out);
      texts.emplace_back("limn-id",
                         isGrey ? "triangle, 65535: none" : "triangle = red + 65536 green, white: none");
      break;
  }
  return out;
}

}  // namespace limn::program
