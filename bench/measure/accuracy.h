// methods/5-measures.md, 5.1: how far a method's outline is from the true one.
#pragma once

#include <string>
#include <vector>

#include "bench/measure/model.h"
#include "bench/measure/outline.h"

namespace limn::measure {

/// A method with its parameters, and what a row calls it.
struct Variant {
  std::string name;
  silhouette::Parameters parameters;
};

/// One method in one view.
struct ViewFigures {
  double mean = 0.0;    ///< area between the outlines / length of the true one, pixels
  double p95 = 0.0;     ///< 95 % Hausdorff distance, pixels
  double max = 0.0;     ///< Hausdorff distance, pixels
  double corner = 0.0;  ///< largest turn, degrees
  std::size_t triangles = 0;
};

/// All methods in all views, through one camera per view.
struct Accuracy {
  std::vector<ViewFigures> truth;                 ///< [view]; only `corner` and `triangles` say something
  std::vector<ViewFigures> flat;                  ///< [view]
  std::vector<std::vector<ViewFigures>> methods;  ///< [variant][view]
};

/// What a dump wants to see of each view and variant: both masks.
class ViewObserver {
 public:
  virtual ~ViewObserver() = default;
  /// Called from several threads, each for another view.
  virtual void see(const Variant& variant, std::size_t view, const Mask& truth, const Mask& drawn) = 0;
};

/// Measures in windows of size × size pixels (at most 2048). The same figures for any number of threads.
Accuracy measureAccuracy(const Subject& subject, const std::vector<Variant>& variants,
                         const std::vector<glm::dvec3>& directions, int size, Workers& workers,
                         ViewObserver* observer = nullptr);

/// A row of `limn_measure outline`: one method over all views.
struct AccuracyRow {
  std::string model, method;
  double tolerance = 0.0;
  std::size_t views = 0;
  double mean = 0.0, p95 = 0.0;    ///< averages over the views
  double max = 0.0, corner = 0.0;  ///< the largest of all views
  double flatMean = 0.0, flatP95 = 0.0, flatMax = 0.0, flatCorner = 0.0, trueCorner = 0.0;
  std::size_t viewsWorseThanFlat = 0;  ///< by the mean offset
  double triangles = 0.0;              ///< drawn, average over the views

  double removed() const { return flatMean > 0.0 ? 1.0 - mean / flatMean : 0.0; }
};
AccuracyRow summarize(const Subject& subject, const Variant& variant, const Accuracy& accuracy,
                      std::size_t index);

}  // namespace limn::measure
