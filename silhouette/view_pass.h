// What the refinement of one view by any method with edges works on.
#pragma once

#include "silhouette/method.h"
#include "silhouette/pixel_bound.h"
#include "silhouette/writer.h"

namespace limn::silhouette {

/// All that it refers to outlives it.
struct ViewPass {
  const Mesh& mesh;
  const Topology& topology;
  const View& view;
  const Parameters& parameters;
  const Crew& crew;
  RefinedStream& stream;
  RefineReport& report;
  PixelBound bound{view};
  StreamWriter writer{mesh, parameters.shadingNormals, stream};
};

}  // namespace limn::silhouette
