// Based on: the definition of the Hausdorff distance, on masks. Differs in: only samples that one mask has and the other
// has not are looked at; each wants a sample of the other within reach.
#include "apps/coarsen/outline_check.h"

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "apps/coarsen/spans.h"
#include "apps/scene/camera.h"
#include "raster/base/elementary.h"
#include "silhouette/refine.h"

namespace limn::coarsen {
namespace {

using glm::dvec2;
using glm::dvec3;
using Indices = std::vector<std::uint32_t>;

constexpr double kDegrees = 30.0;

/// One byte per sample.
struct Mask {
  int width = 0, height = 0;
  std::vector<std::uint8_t> covered;

  void clear(int w, int h) {
    width = w;
    height = h;
    covered.assign(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), 0);
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  void draw(const std::vector<dvec2>& points, std::span<const std::uint32_t> indices) {
    for (std::size_t k = 0; k + 2 < indices.size(); k += 3)
      forSpans(width, height, points[indices[k]], points[indices[k + 1]], points[indices[k + 2]],
               [&](int row, int from, int to) {
                 std::fill(covered.begin() + static_cast<std::ptrdiff_t>(at(from, row)),
                           covered.begin() + static_cast<std::ptrdiff_t>(at(to, row)), std::uint8_t{1});
               });
  }
};

/// Half the width of a disc's rows, from its lowest to its highest.
std::vector<int> discOf(double radius) {
  std::vector<int> halfWidths;
  const int most = static_cast<int>(radius);
  for (int y = -most; y <= most; ++y)
    halfWidths.push_back(static_cast<int>(std::sqrt(radius * radius - y * y)));
  return halfWidths;
}

/// Whether every sample of `a` has one of `b` within the disc around it.
bool isCovered(const Mask& a, const Mask& b, const std::vector<int>& disc) {
  const auto stride = static_cast<std::size_t>(b.width) + 1;
  std::vector<int> before(stride * static_cast<std::size_t>(b.height), 0);  // samples of b's row left of x
  for (std::size_t y = 0; y < static_cast<std::size_t>(b.height); ++y)
    for (std::size_t x = 0; x + 1 < stride; ++x)
      before[y * stride + x + 1] = before[y * stride + x] + b.covered[y * (stride - 1) + x];
  const int most = static_cast<int>(disc.size() / 2);
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      if (a.covered[a.at(x, y)] <= b.covered[b.at(x, y)]) continue;
      bool near = false;
      for (int row = std::max(0, y - most); row <= std::min(b.height - 1, y + most) && !near; ++row) {
        const int half = disc[static_cast<std::size_t>(row - y + most)];
        const int* const counts = before.data() + static_cast<std::size_t>(row) * stride;
        near = counts[std::min(b.width, x + half + 1)] > counts[std::max(0, x - half)];
      }
      if (!near) return false;
    }
  return true;
}

scene::Sphere boundsOf(const std::vector<glm::vec3>& positions) {
  dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const glm::vec3& p : positions) {
    low = glm::min(low, dvec3(p));
    high = glm::max(high, dvec3(p));
  }
  scene::Sphere sphere{0.5 * (low + high), 0.0};
  for (const glm::vec3& p : positions)
    sphere.radius = std::max(sphere.radius, glm::distance(sphere.center, dvec3(p)));
  return sphere;
}

/// A window whose pixels are samples.
scene::CameraView cameraAlong(const scene::Sphere& bounds, const dvec3& direction, int width, int height) {
  scene::LookAt look = scene::frameSphere(bounds, width, height, 0.0, 0.0, 1.0, kDegrees, 0.0);
  look.eye = look.target + glm::distance(look.eye, look.target) * direction;
  if (std::abs(direction.y) > 0.9) look.up = {1.0, 0.0, 0.0};
  return scene::makeCamera(look, bounds, width, height);
}

template <class Positions>
void project(const Positions& positions, const scene::CameraView& camera, std::vector<dvec2>& out) {
  const Projection& p = camera.projection;
  for (const glm::vec3& position : positions) {
    const glm::dvec4 v = camera.worldToView * glm::dvec4(dvec3(position), 1.0);
    out.emplace_back(0.5 * p.width + v.x / -v.z * p.pixelsX, 0.5 * p.height - v.y / -v.z * p.pixelsY);
  }
}

/// Draws both models from one direction after the other.
class Checker {
 public:
  Checker(const scene::Mesh& fine, const scene::Mesh& small, const OutlinePromise& promise)
      : fine_(fine),
        small_(small),
        shape_{small.positions, small.normals, small.indices},
        topology_(shape_),
        curves_(decode(small.curves, shape_, topology_)),
        refiner_(shape_, topology_, alone_, curves_.view()),
        samples_(promise.pixels >= 1.0 ? 2 : 4),
        promise_(promise),
        disc_(discOf(std::max(1.0, promise.pixels * samples_ - 0.5))),
        bounds_(boundsOf(fine.positions)) {}

  bool keeps(const dvec3& direction) {
    const int width = samples_ * promise_.width, height = samples_ * promise_.height;
    const scene::CameraView camera = cameraAlong(bounds_, direction, width, height);
    points_.clear();
    project(fine_.positions, camera, points_);
    first_.clear(width, height);
    first_.draw(points_, fine_.indices);

    // The window's pixels are samples; the tolerance counts pixels.
    silhouette::Parameters parameters;
    parameters.tolerance *= static_cast<float>(samples_);
    refiner_.refine(silhouette::makeView(camera.projection, camera.worldToView), parameters, stream_);
    points_.clear();
    project(small_.positions, camera, points_);
    project(stream_.positions, camera, points_);
    second_.clear(width, height);
    second_.draw(points_, stream_.indices);
    for (std::size_t t = 0; t < shape_.triangleCount(); ++t)
      if (!stream_.isReplaced(t)) second_.draw(points_, std::span(small_.indices).subspan(3 * t, 3));
    return isCovered(first_, second_, disc_) && isCovered(second_, first_, disc_);
  }

 private:
  const scene::Mesh &fine_, &small_;
  Workers alone_{1};
  silhouette::Mesh shape_;
  silhouette::Topology topology_;
  scene::DecodedCurves curves_;
  silhouette::Refiner refiner_;
  int samples_;
  OutlinePromise promise_;
  std::vector<int> disc_;  // what counts as near
  scene::Sphere bounds_;
  std::vector<dvec2> points_;
  Mask first_, second_;
  silhouette::RefinedStream stream_;
};

/// splitmix64 (Steele, Lea, Flood 2014), to [0, 1).
double nextUniform(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

std::vector<dvec3> viewDirections(int count, std::uint64_t seed) {
  std::vector<dvec3> directions;
  std::uint64_t state = seed;
  for (int k = 0; k < count; ++k) {
    const double height = seed == 0 ? (k + 0.5) / count : nextUniform(state);
    const double around = seed == 0 ? 2.399963229728653 * k : 2.0 * kPi * nextUniform(state);
    const double z = 1.0 - 2.0 * height, radius = std::sqrt(1.0 - z * z);
    const SinCos turn = sinCos(around);
    directions.emplace_back(radius * turn.cos, radius * turn.sin, z);
  }
  return directions;
}

int brokenViews(const scene::Mesh& fine, const scene::Mesh& small, const OutlinePromise& promise,
                const std::vector<dvec3>& directions, Workers& workers) {
  std::vector<std::unique_ptr<Checker>> checkers(static_cast<std::size_t>(workers.threads()));
  std::atomic<int> broken = 0;  // a count: the order does not matter
  workers.forBlocks(directions.size(), 1, [&](std::size_t k, std::size_t, int slot) {
    std::unique_ptr<Checker>& checker = checkers[static_cast<std::size_t>(slot)];
    if (!checker) checker = std::make_unique<Checker>(fine, small, promise);
    if (!checker->keeps(directions[k])) broken.fetch_add(1, std::memory_order_relaxed);
  });
  return broken;
}

}  // namespace limn::coarsen
