// Feature edges as smooth curves, from every viewpoint.
//
// Based on: L. Wang et al., "Silhouette Smoothing for Real-Time Rendering of Mesh Surfaces", section III.A.
// Differs in: where the normals of the two sides differ by more than a few degrees the tangent is the line in which
// their planes meet, as in C. Dyken, M. Reimers, 2004, (8): it needs no neighbours, and is the true one where normals are
// those of a finer surface. Else it is the circle's, with squares where the paper prints first powers; a polyline is
// then cut where it turns sharply, and at cuts and open ends the tangent is the chord's: where a line meets
// an arc, the circle takes the short chord's direction and bends the long one. And the ends of an edge limit
// each other, so that a circle's arcs stay and a straight edge beside an arc stays straight.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "silhouette/edge_curves.h"

namespace limn::silhouette {

/// The direction at V_i of the circle through V_{i-1}, V_i, V_{i+1}, where w0 and w1 lead to V_i and on from it.
/// Not unit.
glm::vec3 circleTangent(const glm::vec3& w0, const glm::vec3& w1);

/// Replaces the curves of feature edges, leaves the others. A tangent needs the edges beside it only, so
/// polylines are not walked: a point where exactly two feature edges meet at an angle is inside one.
void computeFeatureCurves(const Mesh& mesh, const Topology& topology, const Crew& crew,
                          std::vector<CurveOffsets>& curves);

}  // namespace limn::silhouette
