// limn_peer: the grid scene drawn by OpenGL on Mesa's CPU rasterizer, llvmpipe, as users without a GPU draw today. It
// prints the same key=value lines as limn_bench_frames. Not part of the usual build: cmake -D LIMN_BUILD_PEER=ON.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

#include "apps/scene/image.h"
#include "bench/frames/grid_scene.h"
#include "bench/frames/options.h"
#include "bench/frames/timing.h"
#include "bench/peer/gl.h"
#include "bench/peer/shaders.h"
#include "silhouette/refine.h"

namespace limn::peer {
namespace {

struct Options {
  bench::SceneOptions scene;
  int level = 1;  ///< > 1: every triangle as level² triangles of its PN triangle, refined once beforehand
  std::string against;  ///< picture to compare view 0 with
  int raw = 0;          ///< > 0: so many frames as rows of RGBA on standard output, and nothing else
};

Options parse(int argc, char** argv) {
  CLI::App app("Times frames of copies of a mesh on a grid, drawn by llvmpipe, and prints key=value lines.");
  Options options;
  bench::declare(app, options.scene, "raster threads beside the calling one; 0: the calling one does all");
  app.add_option("--level", options.level, "draw PN triangles, each refined beforehand to the square of this")
      ->check(CLI::Range(1, silhouette::kMaxSegments))
      ->capture_default_str();
  app.add_option("--against", options.against, "compare view 0 with this PNG of limn_bench_frames");
  app.add_option("--raw", options.raw,
                 "write so many frames as raw RGBA to standard output, and time nothing");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  return options;
}

/// Replaces the mesh by its PN triangles. Normals are quadratic, as Vlachos et al. 2001 have them.
void refine(scene::Mesh& mesh, const Projection& projection, int level) {
  const silhouette::Mesh coarse{mesh.positions, mesh.normals, mesh.indices};
  const silhouette::Topology topology(coarse);
  Workers workers(1);
  silhouette::Parameters parameters;
  parameters.method = silhouette::Method::kPn;
  parameters.segments = level;
  parameters.shadingNormals = silhouette::ShadingNormals::kQuadratic;
  silhouette::RefinedStream stream;
  glm::dmat4 away(1.0);
  away[3] = glm::dvec4(0.0, 0.0, -4.0, 1.0);
  silhouette::Refiner(coarse, topology, workers)
      .refine(silhouette::makeView(projection, away), parameters, stream);
  if (stream.triangleCount() != mesh.indices.size() / 3 * static_cast<std::size_t>(level * level)) {
    throw std::runtime_error("the mesh has triangles that are not refined");
  }
  mesh.positions.insert(mesh.positions.end(), stream.positions.begin(), stream.positions.end());
  mesh.normals.insert(mesh.normals.end(), stream.normals.begin(), stream.normals.end());
  mesh.texcoords.clear();
  for (const glm::vec3& p : mesh.positions) mesh.texcoords.emplace_back(2.0f * p.x, 2.0f * p.y);
  mesh.indices = stream.indices;
}

class Peer {
 public:
  explicit Peer(const Options& options)
      : options_(options),
        grid_(options.scene.copies, options.scene.width, options.scene.height),
        gl_(options.scene.width, options.scene.height, options.scene.threads, pixels_) {
    scene::Mesh mesh = bench::loadFitted(options.scene.model);
    trianglesIn_ = mesh.indices.size() / 3;
    if (options.level > 1) refine(mesh, grid_.projection(), options.level);
    indexCount_ = static_cast<GLsizei>(mesh.indices.size());
    upload(mesh);
    buildProgram();
    if (options.scene.texture != 0) uploadTexture();
    gl_.Enable(GL_DEPTH_TEST);
    gl_.Enable(GL_CULL_FACE);
    gl_.Viewport(0, 0, options.scene.width, options.scene.height);
    gl_.ClearColor(bench::kBackground.r, bench::kBackground.g, bench::kBackground.b, 0.0f);
    scale_ =
        options.scene.scale > 0.0 ? options.scene.scale : bench::findScale(options.scene, [&](double scale) {
          scale_ = scale;
          draw(0);
          return coverage();
        });
  }

  void run();

 private:
  Options options_;
  bench::Grid grid_;
  std::vector<std::uint8_t> pixels_;
  Gl gl_;
  std::size_t trianglesIn_ = 0;
  GLsizei indexCount_ = 0;
  std::vector<glm::mat4> places_;
  double scale_ = 1.0;

  void fill(GLenum target, const void* data, std::size_t bytes, GLenum usage);
  template <class T>
  void attribute(GLuint location, const std::vector<T>& values);
  void upload(const scene::Mesh& mesh);
  GLuint compile(GLenum kind, const char* source);
  void buildProgram();
  void uploadTexture();
  void draw(int view);
  double coverage() const;
  scene::Image picture() const;
  void writeRaw();
  void compare(const scene::Image& own, const scene::Image& other) const;
};

void Peer::fill(GLenum target, const void* data, std::size_t bytes, GLenum usage) {
  GLuint buffer = 0;
  gl_.GenBuffers(1, &buffer);
  gl_.BindBuffer(target, buffer);
  gl_.BufferData(target, static_cast<GLsizeiptr>(bytes), data, usage);
}

template <class T>
void Peer::attribute(GLuint location, const std::vector<T>& values) {
  fill(GL_ARRAY_BUFFER, values.data(), values.size() * sizeof(T), GL_STATIC_DRAW);
  gl_.EnableVertexAttribArray(location);
  gl_.VertexAttribPointer(location, T::length(), GL_FLOAT, GL_FALSE, 0, nullptr);
}

// One mesh, and a buffer of the copies' matrices that is written anew every frame.
void Peer::upload(const scene::Mesh& mesh) {
  GLuint array = 0;
  gl_.GenVertexArrays(1, &array);
  gl_.BindVertexArray(array);
  attribute(0, mesh.positions);
  attribute(1, mesh.normals);
  attribute(2, mesh.texcoords);
  fill(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.data(), mesh.indices.size() * sizeof(mesh.indices[0]),
       GL_STATIC_DRAW);
  places_.resize(static_cast<std::size_t>(grid_.copies()));
  fill(GL_ARRAY_BUFFER, nullptr, places_.size() * sizeof(places_[0]), GL_DYNAMIC_DRAW);
  for (GLuint column = 0; column < 4; ++column) {
    gl_.EnableVertexAttribArray(3 + column);
    gl_.VertexAttribPointer(
        3 + column, 4, GL_FLOAT, GL_FALSE, sizeof(glm::mat4),
        reinterpret_cast<const void*>(column * sizeof(glm::vec4)));  // NOLINT: GL's offsets
    gl_.VertexAttribDivisor(3 + column, 1);
  }
}

GLuint Peer::compile(GLenum kind, const char* source) {
  const GLuint shader = gl_.CreateShader(kind);
  const char* const parts[] = {kVersion, options_.scene.texture != 0 ? "#define TEXTURED\n" : "", source};
  gl_.ShaderSource(shader, 3, parts, nullptr);
  gl_.CompileShader(shader);
  GLint compiled = 0;
  gl_.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != 0) return shader;
  std::string log(2048, '\0');
  gl_.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  throw std::runtime_error("shader: " + log);
}

void Peer::buildProgram() {
  const GLuint program = gl_.CreateProgram();
  gl_.AttachShader(program, compile(GL_VERTEX_SHADER, kVertexShader));
  gl_.AttachShader(program, compile(GL_FRAGMENT_SHADER, kFragmentShader));
  gl_.LinkProgram(program);
  GLint linked = 0;
  gl_.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == 0) throw std::runtime_error("the shaders do not link");
  gl_.UseProgram(program);
  const Projection& p = grid_.projection();
  const float depth = p.farPlane - p.nearPlane;
  glm::mat4 matrix(0.0f);
  matrix[0][0] = 2.0f * p.pixelsX / static_cast<float>(p.width);
  matrix[1][1] = 2.0f * p.pixelsY / static_cast<float>(p.height);
  matrix[2] = {0.0f, 0.0f, -(p.farPlane + p.nearPlane) / depth, -1.0f};
  matrix[3][2] = -2.0f * p.farPlane * p.nearPlane / depth;
  gl_.UniformMatrix4fv(gl_.GetUniformLocation(program, "projection"), 1, GL_FALSE, &matrix[0][0]);
}

void Peer::uploadTexture() {
  GLuint texture = 0;
  gl_.GenTextures(1, &texture);
  gl_.BindTexture(GL_TEXTURE_2D, texture);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, bench::kTextureSize, bench::kTextureSize, 0, GL_RGBA,
                 GL_UNSIGNED_BYTE, bench::checkerTexture().data());
  gl_.GenerateMipmap(GL_TEXTURE_2D);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                    options_.scene.texture == 1 ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
}

void Peer::draw(int view) {
  for (int copy = 0; copy < grid_.copies(); ++copy) {
    places_[static_cast<std::size_t>(copy)] =
        glm::mat4(grid_.place(copy, view, options_.scene.views, scale_));
  }
  gl_.BufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(places_.size() * sizeof(places_[0])),
                    places_.data());
  gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl_.DrawElementsInstanced(GL_TRIANGLES, indexCount_, GL_UNSIGNED_INT, nullptr, grid_.copies());
  gl_.Finish();  // with OSMesa the picture is then in `pixels_`
}

double Peer::coverage() const {
  std::size_t covered = 0;
  for (std::size_t i = 3; i < pixels_.size(); i += 4) covered += pixels_[i] != 0;
  return 4.0 * static_cast<double>(covered) / static_cast<double>(pixels_.size());
}

// The frame drawn last, top row first.
scene::Image Peer::picture() const {
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(options_.scene.width);
  scene::Image image{options_.scene.width, options_.scene.height, {}};
  for (std::size_t end = pixels_.size(); end > 0; end -= row) {
    image.rgba.insert(image.rgba.end(), pixels_.begin() + static_cast<std::ptrdiff_t>(end - row),
                      pixels_.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return image;
}

// Colours are compared where both pictures are covered.
void Peer::compare(const scene::Image& own, const scene::Image& other) const {
  if (own.width != other.width || own.height != other.height)
    throw std::runtime_error("pictures of unequal size");
  std::size_t both = 0, one = 0, apart = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < own.rgba.size(); i += 4) {
    const bool here = own.rgba[i + 3] != 0, there = other.rgba[i + 3] != 0;
    one += here != there;
    if (!here || !there) continue;
    int largest = 0;
    for (std::size_t c = i; c < i + 3; ++c) {
      const int difference = std::abs(own.rgba[c] - other.rgba[c]);
      sum += difference / 3.0;
      largest = std::max(largest, difference);
    }
    both++;
    apart += largest > 2;
  }
  // Of 255; pixels that only one program covers; pixels with a channel more than 2 apart.
  std::printf("mean_difference=%.4f covered_by_one=%zu apart=%zu covered_by_both=%zu\n",
              sum / static_cast<double>(std::max<std::size_t>(both, 1)), one, apart, both);
}

void Peer::writeRaw() {
  for (int frame = 0; frame < options_.raw; ++frame) {
    draw(frame % options_.scene.views);
    const scene::Image image = picture();
    if (std::fwrite(image.rgba.data(), 1, image.rgba.size(), stdout) != image.rgba.size())
      throw std::runtime_error("standard output is closed");
  }
}

void Peer::run() {
  const bench::SceneOptions& o = options_.scene;
  if (options_.raw > 0) return writeRaw();
  double covered = 0.0;
  for (int view = 0; view < o.views; ++view) {
    draw(view);
    covered += coverage() / o.views;
  }
  draw(0);
  const scene::Image own = picture();
  if (!o.dump.empty()) {
    const std::vector<std::uint8_t> png = scene::encodePng(own, {}, 1);
    scene::writeFileWhole(o.dump, png.data(), png.size());
  }
  if (!options_.against.empty()) compare(own, scene::readPng(options_.against));
  const bench::FrameTimes times = bench::FrameClock(o.views).run(o.seconds, [&](int view) { draw(view); });
  if (gl_.GetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL error");
  const double drawn = indexCount_ / 3.0 * o.copies;
  std::printf("renderer=\"%s\" version=\"%s\"\n", reinterpret_cast<const char*>(gl_.GetString(GL_RENDERER)),
              reinterpret_cast<const char*>(gl_.GetString(GL_VERSION)));
  std::printf("model=%s level=%d copies=%d size=%dx%d texture=%d threads=%d\n", o.model.c_str(),
              options_.level, o.copies, o.width, o.height, o.texture, o.threads);
  std::printf("scale=%.5f tris_in=%.0f tris_drawn=%.0f coverage=%.4f frames=%d\n", scale_,
              static_cast<double>(trianglesIn_) * o.copies, drawn, covered, times.frames);
  std::printf("min_ms=%.4f median_ms=%.4f cpu_ms=%.4f mtri_s=%.3f\n", times.minMs, times.medianMs,
              times.cpuMs, 1e-3 * drawn / times.minMs);
}

}  // namespace
}  // namespace limn::peer

int main(int argc, char** argv) {
  const limn::peer::Options options = limn::peer::parse(argc, argv);
  try {
    limn::peer::Peer(options).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "limn_peer: %s\n", error.what());
    return 1;
  }
  return 0;
}
