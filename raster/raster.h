// limn's rasterizer: triangles in, pixels out.
//
//   limn::raster::Geometry geometry(vertices, indices);          // once per mesh
//   limn::raster::Renderer renderer(threads);                     // once
//   limn::raster::Frame frame{...};                               // what to draw, where from, in which light
//   renderer.draw(frame, target);                                 // per frame; allocates nothing once warm
//
// Conventions are those of glTF 2.0 and OpenGL: right-handed, counter-clockwise front faces, column-major
// matrices, pixel centres at half integers, top-left fill rule. Row 0 of every image is the top one. The
// picture is the same to the last bit for any number of threads, any instruction set and any compiler (see
// docs of Renderer::draw).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>

#include "raster/base/projection.h"
#include "raster/material.h"

namespace limn::raster {

/// Plain arrays of vertices. `positions` and `normals` have the same length; the others that length or 0.
struct Vertices {
  std::span<const glm::vec3> positions;  ///< model space, finite
  std::span<const glm::vec3> normals;    ///< model space; need not be unit, only the direction counts
  std::span<const glm::vec2> texcoords;  ///< first set; glTF convention, (0, 0) is the image's upper left
  std::span<const glm::vec4> colors;     ///< linear RGBA factor
  std::span<const glm::vec4> tangents;   ///< xyz as normals, w = ±1 handedness; for normal maps
};

/// Consecutive triangles that share a material.
struct Part {
  std::uint32_t firstTriangle = 0;
  std::uint32_t triangleCount = 0;
  std::uint32_t material = 0;  ///< index into Frame::materials
};

/// The part of a mesh that does not change from frame to frame, prepared for drawing: cut into clusters with
/// their normal cones and bounds. Unless told to borrow the vertices, it keeps copies, and the arrays may go.
class Geometry {
 public:
  /// What becomes of the vertices' arrays: they are copied, or must outlive the geometry.
  enum class Keep { kCopies, kReferences };

  /// `indices`: three per triangle, each below vertices.positions.size(). `parts` must tile [0, triangles) in
  /// order. Throws std::invalid_argument for anything else.
  Geometry(const Vertices& vertices, std::span<const std::uint32_t> indices, std::span<const Part> parts,
           Keep keep = Keep::kCopies);
  ~Geometry();
  Geometry(Geometry&&) noexcept;
  Geometry& operator=(Geometry&&) noexcept;

  std::size_t triangleCount() const;
  std::size_t vertexCount() const;
  std::size_t memoryBytes() const;

  struct Data;
  const Data& data() const { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// Triangles that are new this frame, over the geometry's vertices and some of their own: an index below the
/// geometry's vertexCount() names a vertex of the geometry, index vertexCount() + i names vertex i of
/// `vertices`.
struct Stream {
  Vertices vertices;
  std::span<const std::uint32_t> indices;  ///< three per triangle
  std::span<const std::uint32_t>
      sourceTriangles;  ///< for each triangle, the one of the geometry that it replaces
};

/// One copy of a geometry in the scene.
struct Draw {
  const Geometry* geometry = nullptr;
  /// Bit t % 64 of word t / 64 set: triangle t of the geometry is left out (the stream replaces it). May be
  /// empty.
  std::span<const std::uint64_t> replaced;
  Stream stream;  ///< may be empty; its triangles are ordered by source triangle
  /// Where the geometry's vertices are this frame if not where they were (skins, morphs): empty, or one per
  /// vertex. Clusters are then not culled by their cones.
  std::span<const glm::vec3> posedPositions;
  std::span<const glm::vec3> posedNormals;
  std::span<const glm::vec4> posedTangents;
  glm::mat4 modelToView{1.0f};  ///< affine; a negative determinant turns the front faces round
  std::uint32_t firstId = 0;    ///< id plane: firstId + source triangle
};

/// Anti-aliased line segments over the picture, hidden where a surface lies in front of them. They are drawn after all
/// triangles, in the order given, and leave no trace in depth, normals and ids.
struct Lines {
  std::span<const glm::vec3> points;  ///< two per segment, model space, finite
  std::span<const glm::vec4> colors;  ///< linear RGB and straight alpha, one per segment
  glm::mat4 modelToView{1.0f};        ///< affine
  float width = 1.0f;                 ///< pixels, above 0, at most 64
};

/// Everything of one frame. Spans are borrowed until draw() returns.
struct Frame {
  Projection projection;
  std::span<const Draw> draws;
  std::span<const Material> materials;
  std::span<const Light> lights;
  std::span<const Lines> lines;
  Shading shading = Shading::kBlinnPhong;
  Encoding encoding = Encoding::kSrgb;
  glm::vec4 background{0.0f};  ///< linear RGB and straight alpha
  int samples = 4;             ///< per pixel: 1, 4 or 8
  /// Above this the frame is refused instead of drawn: nanoseconds that one thread would take, roughly. For scenes of
  /// strangers; the estimate is the same everywhere.
  double effortLimit = std::numeric_limits<double>::infinity();
};

/// Thrown by Renderer::draw() for a frame beyond its effortLimit, before anything is written.
class TooMuchEffort : public std::runtime_error {
 public:
  TooMuchEffort(double nanoseconds, std::uint32_t mostInDraw)
      : std::runtime_error("the frame takes more than its effortLimit"),
        effort(nanoseconds),
        heaviestDraw(mostInDraw) {}

  double effort;               ///< in the units of Frame::effortLimit
  std::uint32_t heaviestDraw;  ///< the index of the draw that takes the most
};

/// Where the picture goes. Strides are in elements from row to row. Optional planes have a null pointer.
struct Target {
  std::uint8_t* rgba = nullptr;  ///< RGBA8, straight alpha
  std::size_t rgbaStride = 0;    ///< in bytes, >= 4 · width
  float* depth =
      nullptr;  ///< view depth (distance along -z) of the nearest sample; +infinity where nothing was drawn
  std::size_t depthStride = 0;
  glm::vec3* normals = nullptr;  ///< unit, view space; 0 where nothing was drawn
  std::size_t normalStride = 0;
  std::uint32_t* ids = nullptr;  ///< Draw::firstId + source triangle; kNoId where nothing was drawn
  std::size_t idStride = 0;
};
inline constexpr std::uint32_t kNoId = 0xffffffffu;

/// What a frame took. Times are those of all threads together, waiting included:
///   transform   vertices, of whole draws that are posed or streamed and of clusters in tiles
///   binning     culling of clusters, their tiles and those of lines
///   setup       culling of triangles, their sizes (with Tuning::scalar a part of visibility)
///   visibility  clearing, edge functions, planes, depth
///   shading     textures, light, blending, lines, encoding, writing
///   resolve     sums of the parts of pixels whose samples show several things (with Tuning::scalar a part of shading)
struct Statistics {
  std::uint64_t trianglesIn = 0;     ///< submitted, after replacing
  std::uint64_t trianglesDrawn = 0;  ///< set up for at least one tile
  std::uint64_t pixelsShaded = 0;
  std::uint64_t pixelsCovered = 0;
  double transformMs = 0, setupMs = 0, binningMs = 0, visibilityMs = 0, shadingMs = 0, resolveMs = 0;
  std::size_t scratchBytes = 0;  ///< held by the renderer between frames
};

/// What may differ between renderers without changing a pixel.
struct Tuning {
  int tileWidth = 128;  ///< multiple of 16, at most 128
  int tileHeight = 64;  ///< at most 64
  bool scalar = false;  ///< no vector kernels: slow, the definition of what they must give
};

class Renderer {
 public:
  /// `threads` >= 1 work in all, the calling one included.
  explicit Renderer(int threads, const Tuning& tuning = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws the frame over every pixel of the target. Throws std::invalid_argument for a frame that breaks the
  /// rules above, and TooMuchEffort for one beyond its effortLimit (checked before anything is written).
  void draw(const Frame& frame, const Target& target, Statistics* statistics = nullptr);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace limn::raster
