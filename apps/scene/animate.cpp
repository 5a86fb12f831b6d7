// Based on: glTF 2.0 specification, appendix C, "Animation Sampler Interpolation Modes".
// Differs in: slerp of nearly equal quaternions is linear; sines and cosines are limn's own.
#include "apps/scene/animate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "raster/base/elementary.h"

namespace limn::scene {
namespace {

/// The keys around a moment: t in [0, 1] from key `from` to key `to`, `duration` seconds apart.
struct Segment {
  std::size_t from = 0, to = 0;
  double t = 0.0, duration = 0.0;
};

Segment segmentAt(const std::vector<float>& times, double seconds) {
  const auto after = std::upper_bound(times.begin(), times.end(), seconds,
                                      [](double s, float time) { return s < static_cast<double>(time); });
  if (after == times.begin()) return {};
  const std::size_t from = static_cast<std::size_t>(after - times.begin()) - 1;
  if (after == times.end()) return {from, from, 0.0, 0.0};
  const double duration =
      static_cast<double>(*after) - static_cast<double>(times[from]);  // > 0: the next is later
  return {from, from + 1, (seconds - static_cast<double>(times[from])) / duration, duration};
}

/// Spherical interpolation between two quaternions (x, y, z, w), the shorter way.
void slerp(const float* a, const float* b, double t, std::span<double> value) {
  double dot = 0.0;
  for (std::size_t c = 0; c < 4; ++c) dot += static_cast<double>(a[c]) * static_cast<double>(b[c]);
  const double sign = dot < 0.0 ? -1.0 : 1.0;
  constexpr double kNearlyEqual = 1.0 - 1e-9;  // then sin(angle) has few digits, and the difference no matter
  double weightA = 1.0 - t, weightB = t;
  if (sign * dot < kNearlyEqual) {
    const double angle = arcCosine(sign * dot);
    const double sine = sinCos(angle).sin;
    weightA = sinCos(angle * (1.0 - t)).sin / sine;
    weightB = sinCos(angle * t).sin / sine;
  }
  for (std::size_t c = 0; c < 4; ++c) {
    value[c] = weightA * static_cast<double>(a[c]) + sign * weightB * static_cast<double>(b[c]);
  }
}

/// Cubic Hermite curve; a key holds in-tangent, value, out-tangent.
void cubicSpline(const AnimationChannel& channel, const Segment& s, std::span<double> value) {
  const std::size_t n = channel.components;
  const float* from = &channel.values[3 * n * s.from];
  const float* to = &channel.values[3 * n * s.to];
  const double t = s.t, t2 = t * t, t3 = t2 * t;
  for (std::size_t c = 0; c < n; ++c) {
    const double v0 = from[n + c], b0 = s.duration * static_cast<double>(from[2 * n + c]);
    const double v1 = to[n + c], a1 = s.duration * static_cast<double>(to[c]);
    value[c] = (2 * t3 - 3 * t2 + 1) * v0 + (t3 - 2 * t2 + t) * b0 + (3 * t2 - 2 * t3) * v1 + (t3 - t2) * a1;
  }
}

}  // namespace

void sampleChannel(const AnimationChannel& channel, double seconds, std::span<double> value) {
  const std::size_t n = channel.components;
  const Segment s = segmentAt(channel.times, seconds);
  if (channel.interpolation == Interpolation::kCubicSpline) return cubicSpline(channel, s, value);
  const float* from = &channel.values[n * s.from];
  const float* to = &channel.values[n * s.to];
  if (channel.interpolation == Interpolation::kStep || s.from == s.to) {
    std::copy(from, from + n, value.begin());
  } else if (channel.path == ChannelPath::kRotation) {
    slerp(from, to, s.t, value);
  } else {
    for (std::size_t c = 0; c < n; ++c) {
      value[c] = static_cast<double>(from[c]) * (1.0 - s.t) + static_cast<double>(to[c]) * s.t;
    }
  }
}

}  // namespace limn::scene
