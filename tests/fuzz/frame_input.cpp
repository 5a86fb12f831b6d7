#include "tests/fuzz/frame_input.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/scene/gltf_writer.h"

namespace limn::fuzz {
namespace {

using scene::test::GltfWriter;
using scene::test::json;

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t value = rest_.front();
    rest_ = rest_.subspan(1);
    return value;
  }
  int signedByte() {
    const int value = byte();
    return value < 128 ? value : value - 256;
  }
  std::int16_t signedWord() {
    const int low = byte();
    return static_cast<std::int16_t>(low | byte() << 8);
  }

 private:
  std::span<const std::uint8_t> rest_;
};

/// What the second byte says of the mesh, beside the tangents.
struct MeshFlags {
  bool normals, colors, doubleSided, mirrored, stretched, blended;

  explicit MeshFlags(int bits)
      : normals((bits & 4) != 0),
        colors((bits & 8) != 0),
        doubleSided((bits & 16) != 0),
        mirrored((bits & 32) != 0),
        stretched((bits & 64) != 0),
        blended((bits & 128) != 0) {}
};

silhouette::Parameters readMethod(ByteReader& in, int first, int second) {
  const auto bit = [first](int n) { return (first >> n & 1) != 0; };
  silhouette::Parameters p;
  p.method = static_cast<silhouette::Method>(first & 3);
  p.robust = bit(3);
  p.features = bit(4);
  p.boundaries = bit(5);
  p.shadingNormals = bit(6) ? silhouette::ShadingNormals::kQuadratic : silhouette::ShadingNormals::kLinear;
  p.tangents = static_cast<silhouette::Tangents>((second & 3) % 3);
  const int count = in.byte(), values = silhouette::kMaxSegments + 1;
  p.segments = count % values;
  p.silhouetteness = count / values % 2 == 1 ? silhouette::Silhouetteness::kCrossing
                     : bit(2)                ? silhouette::Silhouetteness::kEdge
                                             : silhouette::Silhouetteness::kContour;
  p.tolerance = static_cast<float>(in.byte()) / 32.0f;
  p.beta = static_cast<float>(in.byte()) / 32.0f;
  return p;
}

std::vector<float> readFloats(std::size_t count, float scale, ByteReader& in) {
  std::vector<float> values(count);
  for (float& value : values) value = static_cast<float>(in.signedByte()) * scale;
  return values;
}

scene::Scene readScene(ByteReader& in, const MeshFlags& flags) {
  const int exponent = in.signedByte();
  const std::size_t vertices = 3U + in.byte(), triangles = 1U + in.byte();
  std::vector<float> positions(3 * vertices);
  for (float& p : positions) p = static_cast<float>(std::ldexp(in.signedWord(), exponent));

  GltfWriter writer;
  json attributes = {{"POSITION", writer.addArray(positions, "VEC3")}};
  if (flags.normals)
    attributes["NORMAL"] = writer.addArray(readFloats(3 * vertices, 1.0f / 127.0f, in), "VEC3");
  if (flags.colors)
    attributes["COLOR_0"] = writer.addArray(readFloats(4 * vertices, 1.0f / 64.0f, in), "VEC4");
  std::vector<std::uint16_t> indices(3 * triangles);
  for (std::uint16_t& i : indices) i = static_cast<std::uint16_t>(in.byte() % vertices);
  writer.addMesh(attributes, writer.addArray(indices, "SCALAR"))["material"] = 0;
  writer.root["materials"] = {
      {{"doubleSided", flags.doubleSided}, {"alphaMode", flags.blended ? "BLEND" : "OPAQUE"}}};
  const double stretch = flags.stretched ? 3.0 : 1.0;
  writer.root["nodes"][0]["scale"] = {flags.mirrored ? -stretch : stretch, 1.0, 1.0 / stretch};
  return writer.load();
}

}  // namespace

HostileFrame decodeFrame(std::span<const std::uint8_t> bytes) {
  constexpr int kWidth = 40, kHeight = 28;
  ByteReader in(bytes);
  HostileFrame frame;
  const int first = in.byte(), second = in.byte();
  frame.settings.refinement = readMethod(in, first, second);
  const double azimuth = in.byte() * (360.0 / 256), elevation = in.signedByte() * (90.0 / 128);
  const double zoom = std::ldexp(1.0, in.signedByte() / 16);
  frame.scene = readScene(in, MeshFlags(second));
  scene::evaluatePose(frame.scene, -1, 0.0, frame.pose);
  const scene::Sphere bounds = scene::boundingSphere(frame.scene, frame.pose);
  const double orthographic = (first & 128) != 0 ? -1.0 : 0.0;
  frame.camera = scene::makeCamera(
      scene::frameSphere(bounds, kWidth, kHeight, azimuth, elevation, zoom, 30.0, orthographic), bounds,
      kWidth, kHeight);
  return frame;
}

}  // namespace limn::fuzz
