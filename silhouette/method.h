// The one signature behind which every method lives. A method is one file that defines its make… function,
// and one row in the table of refine.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "raster/base/workers.h"
#include "silhouette/fitted_curves.h"
#include "silhouette/refine.h"

namespace limn::silhouette {

/// Who does the work of one refinement: all threads, or one thread among others that refine other instances.
class Crew {
 public:
  /// All threads of `workers`.
  explicit Crew(Workers& workers) : workers_(&workers) {}
  /// The calling thread alone, which holds `slot`.
  explicit Crew(int slot) : slot_(slot) {}

  /// Whether no other thread works on this refinement.
  bool isAlone() const { return workers_ == nullptr || workers_->threads() == 1; }
  /// Names the scratch memory of this refinement; no other refinement uses it at the time.
  std::size_t slot() const { return static_cast<std::size_t>(slot_); }

  /// As Workers::forBlocks: body(begin, end) for blocks of `grain` indices.
  template <class Body>
  void forBlocks(std::size_t count, std::size_t grain, const Body& body) const {
    if (workers_ != nullptr) {
      workers_->forBlocks(count, grain, [&](std::size_t begin, std::size_t end, int) { body(begin, end); });
      return;
    }
    for (std::size_t begin = 0; begin < count; begin += grain) body(begin, std::min(begin + grain, count));
  }

 private:
  Workers* workers_ = nullptr;
  int slot_ = 0;
};

/// What is to be added to a stream. In 64 bits, which no sum over a mesh passes.
struct StreamSize {
  std::uint64_t vertices = 0, triangles = 0;
};
/// Throws TooManyTriangles where 32 bits cannot number the vertices, those of the mesh among them, or the indices.
void requireNumbered(std::size_t meshVertices, const StreamSize& size);

/// What a method needs to know of a mesh; borrowed.
struct Source {
  Mesh mesh;
  const Topology* topology = nullptr;
  int threads = 1;  ///< slots of scratch memory
  FittedCurves fitted;
};

class MethodState {
 public:
  virtual ~MethodState() = default;

  /// Positions and normals are new.
  virtual void deform(const Mesh& mesh) = 0;
  /// Computes what does not depend on the view, where it is not there already.
  virtual void prepare(const Parameters& parameters, const Crew& crew) = 0;
  /// Fills a restarted stream, whose counts it sets, and the counts of the report. May run for several views at a
  /// time, each with a slot of its own.
  virtual void refine(const View& view, const Parameters& parameters, const Crew& crew, RefinedStream& stream,
                      RefineReport& report) = 0;
  /// Between frames: gives the scratch memory of all slots the size of the largest.
  virtual void levelScratch() {}
  /// α of every edge; `alphas` has their number and holds zeros.
  virtual void silhouetteness(const View&, const Parameters&, std::vector<float>&) {}
};

std::unique_ptr<MethodState> makeFlat(const Source& source);
std::unique_ptr<MethodState> makeBlendedPatches(const Source& source);
std::unique_ptr<MethodState> makeSilhouetteCurves(const Source& source);
std::unique_ptr<MethodState> makePnTriangles(const Source& source);

}  // namespace limn::silhouette
