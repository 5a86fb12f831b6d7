// A scene in memory: what a glTF file says, validated, in the form that drawing wants.
#pragma once

#include <array>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/scene/stored_curves.h"
#include "raster/material.h"
#include "raster/raster.h"
#include "raster/texture.h"

namespace limn::scene {

/// One morph target: offsets per vertex, or empty.
struct MorphTarget {
  std::vector<glm::vec3> positions, normals, tangents;
};

/// Up to four (or, with a second set, eight) bones per vertex; weights sum to 1.
struct SkinBinding {
  std::vector<std::array<std::uint16_t, 4>> joints;
  std::vector<glm::vec4> weights;
};

/// All primitives of one glTF mesh: triangles only, one vertex array, parts by material.
struct Mesh {
  std::string name;
  /// The file's positions are origin + scale · positions. 0 and 1, unless the mesh lies far from its own origin for its
  /// size (then the centre of its bounds, so that floats keep their digits) or is huge or tiny (then a power of two).
  glm::dvec3 origin{0.0};
  double scale = 1.0;
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> texcoords;
  std::vector<glm::vec4> colors, tangents;
  std::vector<std::uint32_t> indices;
  std::vector<raster::Part> parts;
  std::vector<MorphTarget> targets;
  std::vector<float> weights;         ///< default weights of the targets
  std::vector<SkinBinding> skinning;  ///< 0, 1 or 2 sets
  StoredCurves curves;                ///< fitted beforehand to a finer mesh, or empty
};

struct Node {
  std::string name;
  std::int32_t parent = -1;
  /// Local transform: translation · rotation · scale, or `matrix` where the file gives one.
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
  std::optional<glm::dmat4> matrix;
  std::int32_t mesh = -1, skin = -1, camera = -1, light = -1;
  std::vector<float> weights;  ///< overrides the mesh's
};

struct Skin {
  std::vector<std::uint32_t> joints;  ///< nodes
  std::vector<glm::dmat4> inverseBind;
};

struct Camera {
  std::string name;
  bool perspective = true;
  double yfov = 0.5235987755982988;                                            ///< radians
  double aspect = 0.0;                                                         ///< 0 = the window's
  double xmag = 1.0, ymag = 1.0;                                               ///< orthographic half extents
  double nearPlane = 0.0, farPlane = std::numeric_limits<double>::infinity();  ///< 0 = automatic
};

struct Light {
  std::string name;
  raster::Light::Kind kind = raster::Light::Kind::kDirectional;
  glm::dvec3 color{1.0};  ///< intensity included
  double range = 0.0, innerCone = 0.0, outerCone = 0.7853981633974483;
};

enum class Interpolation { kStep, kLinear, kCubicSpline };
enum class ChannelPath { kTranslation, kRotation, kScale, kWeights };

struct AnimationChannel {
  std::uint32_t node = 0;
  ChannelPath path = ChannelPath::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times;   ///< ascending
  std::vector<float> values;  ///< components per key (times three for cubic splines), keys in order
  std::uint32_t components = 3;
};

struct Animation {
  std::string name;
  double duration = 0.0;
  std::vector<AnimationChannel> channels;
};

struct Scene {
  std::string name;
  /// XXH3-128 of the file (as xxh128sum prints it), or of the hashes of it and all files that it refers to; empty for
  /// built-in models.
  std::string contentHash;
  std::vector<Mesh> meshes;
  std::vector<Node> nodes;    ///< parents before children; only those of the drawn scene have effect
  std::vector<bool> inScene;  ///< per node
  std::vector<Skin> skins;
  std::vector<Camera> cameras;
  std::vector<Light> lights;
  std::vector<Animation> animations;
  std::vector<raster::Material> materials;  ///< at least one, the default, last
  std::vector<std::unique_ptr<raster::Texture>> textures;
  /// Of a frame of 1280x800 (raster::Frame::effortLimit); larger ones may take more in proportion.
  double effortLimit = std::numeric_limits<double>::infinity();
  /// So many triangles may those that are drawn become where all of them are refined (silhouette::TooManyTriangles).
  double refinedLimit = std::numeric_limits<double>::infinity();
  std::vector<std::string> notices;  ///< what was left out or mended, one sentence each, for the user
};

}  // namespace limn::scene
