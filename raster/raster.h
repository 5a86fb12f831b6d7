// limn's rasterizer: triangles in, pixels out.
//
//   limn::raster::Geometry geometry(vertices, indices);          // once per mesh
//   limn::raster::Renderer renderer(threads);                     // once
//   limn::raster::Frame frame{...};                               // what to draw, where from, in which light
//   renderer.draw(frame, target);                                 // per frame; allocates nothing once warm
//
// Conventions are those of glTF 2.0 and OpenGL: right-handed, counter-clockwise front faces, column-major
// matrices, pixel centres at half integers, top-left fill rule. Row 0 of every image is the top one. The
// picture is the same to the last bit for any number of threads, any instruction set and any compiler.
//
// Rules are checked where that costs next to nothing next to drawing, and then broken ones throw. Where a rule below says
// "not checked", breaking it gives a picture that is wrong there and may depend on the instruction set, nothing worse. A
// triangle or a segment with an end that is not finite in view space, because its vertices are not or because they
// overflow, is not drawn.
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
  std::span<const glm::vec3> positions;  ///< model space; a geometry's are checked to be finite
  /// Model space; need not be unit, only the direction counts. Lengths are 0, for none, or from 1e-9 to 1e18: squares
  /// must be floats, and a modelToView that scales unevenly shortens some. Not checked.
  std::span<const glm::vec3> normals;
  /// First set; glTF convention, (0, 0) is the image's upper left. From -1e6 to 1e6 with the material's transform; what
  /// lies beyond is sampled at that end, NaN at the lower one.
  std::span<const glm::vec2> texcoords;
  std::span<const glm::vec4> colors;    ///< linear RGBA factor, finite; not checked
  std::span<const glm::vec4> tangents;  ///< xyz as normals, w = ±1 handedness; for normal maps; not checked
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
  /// order. At most 2^31 - 2 vertices and triangles. Throws std::invalid_argument for anything else, and for positions
  /// that are not finite.
  Geometry(const Vertices& vertices, std::span<const std::uint32_t> indices, std::span<const Part> parts,
           Keep keep = Keep::kCopies);
  ~Geometry();
  Geometry(Geometry&&) noexcept;
  Geometry& operator=(Geometry&&) noexcept;

  std::size_t triangleCount() const;
  std::size_t vertexCount() const;

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
  /// For each triangle, the one of the geometry that it replaces, in ascending order.
  std::span<const std::uint32_t> sourceTriangles;
};

/// One copy of a geometry in the scene.
struct Draw {
  const Geometry* geometry = nullptr;
  /// Bit t % 64 of word t / 64 set: triangle t of the geometry is left out (the stream replaces it). May be
  /// empty.
  std::span<const std::uint64_t> replaced;
  Stream stream;  ///< may be empty
  /// Where the geometry's vertices are this frame if not where they were (skins, morphs): empty, or one per
  /// vertex, as Vertices' are. Clusters are then not culled by their cones.
  std::span<const glm::vec3> posedPositions;
  std::span<const glm::vec3> posedNormals;
  std::span<const glm::vec4> posedTangents;
  glm::mat4 modelToView{1.0f};  ///< affine, finite; a negative determinant turns the front faces round
  std::uint32_t firstId = 0;    ///< id plane: firstId + source triangle
};

/// Anti-aliased line segments over the picture, hidden where a surface lies in front of them. They are drawn after all
/// triangles, in the order given, and leave no trace in depth, normals and ids.
struct Lines {
  std::span<const glm::vec3> points;  ///< two per segment, model space
  std::span<const glm::vec4> colors;  ///< linear RGB and straight alpha, one per segment; finite, not checked
  glm::mat4 modelToView{1.0f};        ///< affine, finite
  float width = 1.0f;                 ///< pixels, above 0, at most 64
};

/// Everything of one frame. Spans are borrowed until draw() returns.
struct Frame {
  /// pixelsX and pixelsY from 1e-33 to 1e36; nearPlane and farPlane finite, a perspective's nearPlane no denormal number.
  Projection projection;
  std::span<const Draw> draws;
  std::span<const Material> materials;
  std::span<const Light> lights;
  std::span<const Lines> lines;
  Encoding encoding = Encoding::kSrgb;
  glm::vec4 background{0.0f};  ///< linear RGB and straight alpha, in [0, 1]
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

/// Where the picture goes: rows of the projection's width. Strides are from row to row; those of optional planes are in
/// elements, >= width, and mean nothing where the pointer is null.
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

/// Holds the threads, and the memory that frames need. Draws one frame at a time: two threads that draw at once need a
/// renderer each, and may share geometries and textures.
class Renderer {
 public:
  /// `threads` >= 1 work in all, the calling one included.
  explicit Renderer(int threads, const Tuning& tuning = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// Draws the frame over every pixel of the target. Throws, before anything is written: std::invalid_argument for a
  /// frame that breaks a rule above that is checked; TooMuchEffort for one beyond its effortLimit; std::length_error for
  /// one whose tiles would have to list more than 2^28 things in all or 2^24 in one of them, things being clusters of up
  /// to 128 triangles, triangles that are blended or had to be clipped, and lines.
  void draw(const Frame& frame, const Target& target, Statistics* statistics = nullptr);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace limn::raster
