#include "bench/measure/coherence.h"

#include <algorithm>
#include <cmath>

#include "bench/measure/views.h"
#include "raster/base/check.h"
#include "raster/base/elementary.h"

namespace limn::measure {
namespace {

class Difference {
 public:
  Difference(const Mask& before, const Mask& after) : before_(before), after_(after) {}

  std::uint64_t word(int y, std::size_t i) const { return before_.row(y)[i] ^ after_.row(y)[i]; }
  bool at(int x, int y) const {
    return y >= 0 && y < before_.rows() && (word(y, static_cast<std::size_t>(x) / 64) >> (x % 64) & 1) != 0;
  }
  // Samples above and below (x, y) that differ, this one included, counted up to `most`.
  int verticalExtent(int x, int y, int most) const {
    int extent = 1;
    for (int j = y - 1; extent < most && at(x, j); --j) ++extent;
    for (int j = y + 1; extent < most && at(x, j); ++j) ++extent;
    return extent;
  }

 private:
  const Mask& before_;
  const Mask& after_;
};

}  // namespace

MaskChange changeBetween(const Mask& before, const Mask& after) {
  require(before.columns() == after.columns() && before.rows() == after.rows(),
          "the masks must have the same size");
  const Difference difference(before, after);
  MaskChange change{differenceArea(before, after), 0.0};
  const auto measureRun = [&](int y, int begin, int end) {
    const double across = end - begin;
    if (across <= change.thickness) return;  // thickness <= across
    // Beyond ten times the horizontal extent the vertical one matters less than 1 %.
    const double down = difference.verticalExtent((begin + end) / 2, y, 10 * (end - begin) + 1);
    change.thickness = std::max(change.thickness, across * down / std::hypot(across, down));
  };
  for (int y = std::min(before.firstRow(), after.firstRow()); y < std::max(before.endRow(), after.endRow());
       ++y) {
    int begin = -1;  // of the run at hand
    for (std::size_t i = 0; i < before.row(y).size(); ++i) {
      std::uint64_t word = difference.word(y, i);
      const int base = static_cast<int>(i * 64);
      if (begin >= 0 && word == ~std::uint64_t{0}) continue;
      if (begin < 0 && word == 0) continue;
      for (int x = 0; x < 64;) {
        // The next sample of the other kind.
        const std::uint64_t rest = (begin >= 0 ? ~word : word) >> x;
        if (rest == 0) break;
        x += std::countr_zero(rest);
        if (begin >= 0) measureRun(y, begin, base + x);
        begin = begin >= 0 ? -1 : base + x;
      }
    }
    if (begin >= 0) measureRun(y, begin, before.columns());
  }
  change.thickness /= kSamplesPerPixel;
  return change;
}

std::size_t Path::steps() const {
  return static_cast<std::size_t>(std::lround(arcDegrees / stepDegrees));
}

glm::dvec3 Path::direction(std::size_t frame) const {
  const SinCos latitude = sinCosDegrees(20.0);
  const SinCos longitude = sinCosDegrees(30.0 + static_cast<double>(frame) * stepDegrees);
  return {latitude.cos * longitude.sin, latitude.sin, latitude.cos * longitude.cos};
}

namespace {

// Two masks in turn, so that each frame is compared with the one before.
class MaskPair {
 public:
  explicit MaskPair(int size) : masks_{Mask(size, size), Mask(size, size)} {}
  const Mask& draw(const Surface& surface, const scene::CameraView& camera) {
    latest_ = 1 - latest_;
    project(surface, camera, triangles_);
    masks_[latest_].clear();
    masks_[latest_].draw(triangles_);
    return masks_[latest_];
  }
  MaskChange change() const { return changeBetween(masks_[1 - latest_], masks_[latest_]); }

 private:
  std::array<Mask, 2> masks_;
  int latest_ = 0;
  std::vector<SampleTriangle> triangles_;
};

}  // namespace

std::vector<Coherence> measureCoherence(const Subject& subject, const std::vector<Variant>& variants,
                                        const Path& path, int size, Workers& workers) {
  require(path.steps() >= 1, "the arc must hold at least one step");
  const std::size_t steps = path.steps();
  std::vector<MaskChange> trueChanges(steps);
  std::vector<double> trueLengths(steps);
  std::vector<std::vector<MaskChange>> changes(variants.size(), std::vector<MaskChange>(steps));
  std::vector<std::unique_ptr<MaskPair>> pairs(static_cast<std::size_t>(workers.threads()));
  ModelRefiner refiner(subject.meshes, workers);
  const auto camera = [&](std::size_t frame) {
    return outlineCamera(subject.bounds, path.direction(frame), size);
  };

  // A batch of steps is refined, one view after the other, then measured in blocks; a block draws its first frame anew.
  constexpr std::size_t kBatch = 32, kBlock = 8;
  std::vector<std::vector<Surface>> drawn(kBatch + 1, std::vector<Surface>(variants.size()));
  for (std::size_t first = 0; first < steps; first += kBatch) {
    const std::size_t count = std::min(kBatch, steps - first);
    for (std::size_t i = 0; i <= count; ++i) {
      for (std::size_t v = 0; v < variants.size(); ++v) {
        refiner.refine(camera(first + i), variants[v].parameters, drawn[i][v]);
      }
    }
    workers.forBlocks(count, kBlock, [&](std::size_t begin, std::size_t end, int slot) {
      auto& masks = pairs[static_cast<std::size_t>(slot)];
      if (!masks) masks = std::make_unique<MaskPair>(size);
      const auto follow = [&](const auto& surfaceAt, std::vector<MaskChange>& out) {
        masks->draw(surfaceAt(begin), camera(first + begin));
        for (std::size_t i = begin; i < end; ++i) {
          masks->draw(surfaceAt(i + 1), camera(first + i + 1));
          out[first + i] = masks->change();
        }
      };
      follow([&](std::size_t) -> const Surface& { return subject.truth; }, trueChanges);
      const double trueLength = length(traceOutline(masks->draw(subject.truth, camera(first + begin))));
      std::fill_n(trueLengths.begin() + static_cast<std::ptrdiff_t>(first + begin), end - begin, trueLength);
      for (std::size_t v = 0; v < variants.size(); ++v) {
        follow([&](std::size_t i) -> const Surface& { return drawn[i][v]; }, changes[v]);
      }
    });
  }

  std::vector<Coherence> result(variants.size());
  for (std::size_t v = 0; v < variants.size(); ++v) {
    Coherence& out = result[v];
    for (std::size_t i = 0; i < steps; ++i) {
      const double change = changes[v][i].area / trueLengths[i],
                   trueChange = trueChanges[i].area / trueLengths[i];
      out.change = std::max(out.change, change);
      out.trueChange = std::max(out.trueChange, trueChange);
      out.pop = std::max(out.pop, change - trueChange);
      out.localPop = std::max(out.localPop, changes[v][i].thickness - trueChanges[i].thickness);
    }
  }
  return result;
}

}  // namespace limn::measure
