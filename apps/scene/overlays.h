// Lines over the picture that show what the refinement saw and did.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "apps/scene/refined_instance.h"
#include "raster/raster.h"
#include "silhouette/refine.h"

namespace limn::scene {

/// In the order in which they are drawn, the last on top.
enum class Overlay {
  kWire,      ///< the edges of all drawn triangles
  kFeatures,  ///< feature edges, as they are drawn
  kEdges,     ///< edges with α > 0, as they are drawn, coloured by α
  kContour,   ///< where the shading normals turn away; silhouette curves: their bridges and segments
};
inline constexpr std::size_t kOverlays = 4;

/// Those that are wanted, by enumerator.
using OverlaySet = std::array<bool, kOverlays>;

/// What an overlay needs to know of one instance of a frame; borrowed.
struct OverlaySource {
  RefinedInstance instance;
  silhouette::View view;
  silhouette::Method method = silhouette::Method::kFlat;
  std::span<const float> alphas;  ///< of the topology's edges; looked at by kEdges only
};

/// The lines of a frame; its memory serves the next one.
class OverlayLines {
 public:
  void clear();
  /// Appends one overlay of one instance. Every line once, in the order of its ends' coordinates. kContour of
  /// Method::kCurves wants a stream with its contour listed.
  void add(Overlay overlay, const OverlaySource& source);
  /// Borrowed until the next call of another function.
  std::span<const raster::Lines> lines();

 private:
  struct Line {
    std::array<glm::vec3, 2> ends;  ///< the smaller one first
    glm::vec4 color;
  };
  struct Group {
    std::size_t first = 0, count = 0;
    glm::mat4 modelToView{1.0f};
    float width = 1.0f;
  };

  void addEdges(Overlay overlay, const OverlaySource& source);
  void addContour(const OverlaySource& source);
  void addLine(const glm::vec3& p, const glm::vec3& q, const glm::vec4& color);

  std::vector<Line> found_;  ///< of the overlay that is being added
  std::vector<glm::vec3> points_;
  std::vector<glm::vec4> colors_;
  std::vector<Group> groups_;
  std::vector<raster::Lines> lines_;
};

}  // namespace limn::scene
