// Numbers by chance for the stability checks: the same for the same seed everywhere.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <random>

namespace limn::measure {

class Extremes {
 public:
  explicit Extremes(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  /// Any order of magnitude alike.
  double magnitude(double low, double high) { return std::exp2(uniform(std::log2(low), std::log2(high))); }
  double sign() { return random_() % 2 == 0 ? 1.0 : -1.0; }
  bool oneIn(unsigned n) { return random_() % n == 0; }
  glm::dvec3 unit() {
    for (;;) {
      const glm::dvec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      const double square = glm::dot(v, v);
      if (square > 0.01 && square <= 1.0) return v / std::sqrt(square);
    }
  }

 private:
  std::mt19937_64 random_;
};

/// Keeps the largest error; what is not a number counts as infinite.
class Largest {
 public:
  void see(double error) {
    if (!std::isfinite(error)) error = std::numeric_limits<double>::infinity();
    largest_ = std::max(largest_, std::abs(error));
  }
  void see(long double error) { see(static_cast<double>(error)); }
  double value() const { return largest_; }

 private:
  double largest_ = 0.0;
};

/// Three numbers in extended precision.
struct Vec3L {
  long double x = 0, y = 0, z = 0;

  Vec3L() = default;
  Vec3L(long double a, long double b, long double c) : x(a), y(b), z(c) {}
  explicit Vec3L(const glm::vec3& v) : x(v.x), y(v.y), z(v.z) {}

  friend Vec3L operator+(const Vec3L& a, const Vec3L& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3L operator-(const Vec3L& a, const Vec3L& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3L operator*(long double s, const Vec3L& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend long double dot(const Vec3L& a, const Vec3L& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Vec3L cross(const Vec3L& a, const Vec3L& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend long double length(const Vec3L& a) { return std::sqrt(dot(a, a)); }
};

}  // namespace limn::measure
