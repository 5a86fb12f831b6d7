// The silhouette module's kernels against long double.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "bench/measure/extremes.h"
#include "bench/measure/stability.h"
#include "silhouette/contour.h"
#include "silhouette/edge_curves.h"
#include "silhouette/patch.h"
#include "silhouette/pixel_bound.h"
#include "silhouette/silhouetteness.h"
#include "silhouette/topology.h"

namespace limn::measure {
namespace {

using glm::vec3;
using silhouette::CurveOffsets;

vec3 randomPoint(Extremes& random, const glm::dvec3& center, double size) {
  return vec3(center + random.unit() * random.uniform(0.1, 1.0) * size);
}

vec3 randomNormal(Extremes& random) {
  return vec3(random.unit());
}

// A pair of triangles that share an edge, far from all other pairs or not, thin or not, beside an eye of its own.
struct EdgePair {
  std::array<vec3, 4> points;  // the edge's ends, then the two tips
  vec3 eye;
};

EdgePair randomPair(Extremes& random) {
  const double size = random.magnitude(1e-6, 1e4);
  // At most a hundred times farther from the origin than large: floats then hold the shape to 1e-5.
  const glm::dvec3 center = random.unit() * size * random.magnitude(1e-3, 100);
  EdgePair pair;
  for (vec3& point : pair.points) point = randomPoint(random, center, size);
  if (random.oneIn(3)) {  // a needle: one tip near the edge
    const vec3 on = glm::mix(pair.points[0], pair.points[1], static_cast<float>(random.uniform(0, 1)));
    pair.points[2] = glm::mix(on, pair.points[2], static_cast<float>(random.magnitude(1e-3, 1)));
  }
  pair.eye = vec3(center + random.unit() * size * random.magnitude(3, 1e3));
  return pair;
}

using silhouette::Silhouetteness;

Vec3L unitL(const Vec3L& v) {
  return (1 / length(v)) * v;
}

long double facingL(const vec3& eye, const Vec3L& point, const Vec3L& normal) {
  return dot(unitL(Vec3L(eye) - point), normal);
}

// (1) and (2) with β = 1.
long double alphaTwin(long double f) {
  return f <= 0 ? 1 : f >= 1 ? 0 : 1 - f;
}

// α of the crossing variant with β = 1; NaN where the facings that it divides by are too small to tell.
long double crossingTwin(const std::array<long double, 4>& g) {
  constexpr long double kSmall = 0.01L;
  const long double low = std::min(g[0], g[1]), high = std::max(g[0], g[1]);
  if (low <= 0 && high >= 0) return 1;
  const long double a = std::fabs(low), b = std::fabs(high), ends = 2 * a * b / (a + b);
  const long double least = std::min(g[2], g[3]), most = std::max(g[2], g[3]);
  const long double beyond = low > 0 ? -least : most, spread = std::max(high, most) - std::min(low, least);
  if (a < kSmall || spread < kSmall) return std::numeric_limits<long double>::quiet_NaN();
  const long double within = beyond > 0 ? beyond / (beyond + silhouette::kFadeShare * ends) : 0;
  return std::max(within, 1 - ends / spread);
}

// α with β = 1 of the three variants, from the same floats.
long double silhouettenessTwin(const EdgePair& pair, const std::array<vec3, 4>& normals,
                               Silhouetteness kind) {
  const auto& [a, b, s, t] = pair.points;
  if (kind == Silhouetteness::kEdge) {
    const Vec3L pa(a), pb(b), middle = 0.5L * (pa + pb);
    const Vec3L ns = unitL(cross(pb - pa, Vec3L(s) - pa)), nt = unitL(cross(pa - pb, Vec3L(t) - pb));
    return alphaTwin(facingL(pair.eye, middle, ns) * facingL(pair.eye, middle, nt));
  }
  std::array<long double, 4> g{};
  for (std::size_t i = 0; i < 4; ++i) g[i] = facingL(pair.eye, Vec3L(pair.points[i]), Vec3L(normals[i]));
  if (kind == Silhouetteness::kCrossing) return crossingTwin(g);
  const auto [low, high] = std::minmax_element(g.begin(), g.end());
  return alphaTwin(*low * *high);
}

double silhouettenessError(std::uint64_t seed, std::size_t cases, Silhouetteness kind) {
  constexpr std::size_t kBatch = 1000;  // pairs in one mesh, apart from each other
  Extremes random(seed);
  Largest largest;
  silhouette::Parameters parameters;
  parameters.silhouetteness = kind;
  parameters.features = false;
  parameters.beta = 1.0f;  // then α = 1 - f
  const silhouette::Crew crew(0);
  for (std::size_t first = 0; first < cases; first += kBatch) {
    std::vector<EdgePair> pairs;
    std::vector<vec3> positions, normals;
    std::vector<std::uint32_t> indices;
    for (std::size_t i = 0; i < std::min(kBatch, cases - first); ++i) {
      const auto base = static_cast<std::uint32_t>(positions.size());
      pairs.push_back(randomPair(random));
      for (const vec3& point : pairs.back().points) {
        positions.push_back(point);
        normals.push_back(randomNormal(random));
      }
      for (const std::uint32_t k : {0, 1, 2, 1, 0, 3}) indices.push_back(base + k);
    }
    const silhouette::Mesh mesh{positions, normals, indices};
    const silhouette::Topology topology(mesh);
    silhouette::EdgeTest test;
    test.prepare(mesh, topology, parameters, crew);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (topology.isDegenerate(2 * i) || topology.isDegenerate(2 * i + 1)) continue;
      silhouette::View view;
      view.eye = pairs[i].eye;
      const std::array<vec3, 4> own{normals[4 * i], normals[4 * i + 1], normals[4 * i + 2],
                                    normals[4 * i + 3]};
      const long double alpha = silhouettenessTwin(pairs[i], own, kind);
      if (!std::isnan(alpha)) largest.see(test.alpha(view, parameters, topology.sideEdges()[6 * i]) - alpha);
    }
  }
  return largest.value();
}

double edgeTestError(std::uint64_t seed, std::size_t cases) {
  return silhouettenessError(seed, cases, Silhouetteness::kEdge);
}

double contourTestError(std::uint64_t seed, std::size_t cases) {
  return silhouettenessError(seed, cases, Silhouetteness::kContour);
}

double crossingTestError(std::uint64_t seed, std::size_t cases) {
  return silhouettenessError(seed, cases, Silhouetteness::kCrossing);
}

double wedgeError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const vec3 s = randomNormal(random);
    const vec3 t = random.oneIn(3) ? glm::normalize(s + vec3(random.unit() * random.magnitude(1e-6, 1)))
                                   : randomNormal(random);
    const long double phi = random.uniform(0, 3.14159);
    const auto sine = static_cast<float>(std::sin(phi)), cosine = static_cast<float>(std::cos(phi));
    const long double theta = std::atan2(length(cross(Vec3L(s), Vec3L(t))), dot(Vec3L(s), Vec3L(t)));
    const long double beta = std::max(0.0L, std::sin(phi) * std::sin(phi + theta));
    largest.see(silhouette::wedgeBeta(s, t, sine, cosine) - beta);
  }
  return largest.value();
}

// c_ij - l_ij of (7), of (8), and with the tangent length of a circular arc.
Vec3L offsetTwin(const Vec3L& e, const silhouette::EdgeEnd& end, silhouette::Tangents tangents) {
  Vec3L projected;
  if (end.feature) {
    const Vec3L line = unitL(cross(Vec3L(end.normal[1]), Vec3L(end.normal[0])));
    projected = dot(e, line) * line;
  } else {
    const Vec3L n(end.normal[0]);
    projected = e - dot(e, n) * n;
  }
  if (tangents == silhouette::Tangents::kProjected) return (1 / 3.0L) * (projected - e);
  const long double cosine = std::max(0.5L, std::min(1.0L, length(projected) / length(e)));
  return (1 / 3.0L) * (2 / (cosine * (1 + cosine)) * projected - e);
}

double edgeCurveError(std::uint64_t seed, std::size_t cases, silhouette::Tangents tangents) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const EdgePair pair = randomPair(random);
    const vec3 p = pair.points[0], q = pair.points[1];
    std::array<silhouette::EdgeEnd, 2> ends;
    for (silhouette::EdgeEnd& end : ends) {
      end.feature = random.oneIn(2);
      end.normal[0] = end.normal[1] = randomNormal(random);
      // Feature normals between two degrees apart and two degrees from opposed.
      while (end.feature && glm::length(glm::cross(end.normal[0], end.normal[1])) < 0.035f) {
        end.normal[1] = randomNormal(random);
      }
    }
    const CurveOffsets offsets = silhouette::edgeCurve(p, q, ends[0], ends[1], {tangents, false});
    const Vec3L e = Vec3L(q) - Vec3L(p);
    largest.see(length(Vec3L(offsets[0]) - offsetTwin(e, ends[0], tangents)) / length(e));
    largest.see(length(Vec3L(offsets[1]) - offsetTwin(-1.0L * e, ends[1], tangents)) / length(e));
  }
  return largest.value();
}

double projectedCurveError(std::uint64_t seed, std::size_t cases) {
  return edgeCurveError(seed, cases, silhouette::Tangents::kProjected);
}

double circularCurveError(std::uint64_t seed, std::size_t cases) {
  return edgeCurveError(seed, cases, silhouette::Tangents::kCircular);
}

// A geodesic-like end's offset, its tangent made as long as a circular arc's.
Vec3L arcTwin(const Vec3L& e, const Vec3L& offset) {
  const Vec3L tangent = (1 / 3.0L) * e + offset;
  const long double lengths = length(tangent) * length(e);
  const long double cosine = lengths > 0 ? std::max(0.5L, dot(tangent, e) / lengths) : 1.0L;
  return offset + (2 * (1 + 2 * cosine * cosine) / (3 * cosine * (1 + cosine)) - 1) * tangent;
}

double geodesicError(std::uint64_t seed, std::size_t cases, silhouette::Tangents tangents) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const EdgePair pair = randomPair(random);
    std::array<silhouette::EdgeEnd, 2> ends;
    for (silhouette::EdgeEnd& end : ends) end.normal[0] = end.normal[1] = randomNormal(random);
    const CurveOffsets offsets =
        silhouette::edgeCurve(pair.points[0], pair.points[1], ends[0], ends[1], {tangents, false});
    const Vec3L e = Vec3L(pair.points[1]) - Vec3L(pair.points[0]), ni(ends[0].normal[0]),
                nj(ends[1].normal[0]);
    const long double hi = dot(e, ni), hj = dot(e, nj), k = dot(ni, nj), determinant = 4 - k * k;
    const long double lambda = -(2 * hi + k * hj) / determinant, mu = -(2 * hj + k * hi) / determinant;
    Vec3L first = (1 / 3.0L) * (2 * lambda * ni - mu * nj), second = (1 / 3.0L) * (lambda * ni - 2 * mu * nj);
    if (tangents == silhouette::Tangents::kGeodesicArc)
      first = arcTwin(e, first), second = arcTwin(-1.0L * e, second);
    largest.see(length(Vec3L(offsets[0]) - first) / length(e));
    largest.see(length(Vec3L(offsets[1]) - second) / length(e));
  }
  return largest.value();
}

double geodesicCurveError(std::uint64_t seed, std::size_t cases) {
  return geodesicError(seed, cases, silhouette::Tangents::kGeodesic);
}

double arcCurveError(std::uint64_t seed, std::size_t cases) {
  return geodesicError(seed, cases, silhouette::Tangents::kGeodesicArc);
}

// A Bézier triangle by de Casteljau's rule from absolute control points.
Vec3L patchTwin(const silhouette::Patch& patch, long double u, long double v, long double w) {
  const Vec3L p(patch.corners[0]), q(patch.corners[1]), r(patch.corners[2]);
  const auto inner = [](const Vec3L& a, const Vec3L& b, const vec3& d) {
    return (1 / 3.0L) * (2.0L * a + b) + Vec3L(d);
  };
  const Vec3L b210 = inner(p, q, patch.sides[0][0]), b120 = inner(q, p, patch.sides[0][1]);
  const Vec3L b021 = inner(q, r, patch.sides[1][0]), b012 = inner(r, q, patch.sides[1][1]);
  const Vec3L b102 = inner(r, p, patch.sides[2][0]), b201 = inner(p, r, patch.sides[2][1]);
  const Vec3L b111 = 0.25L * (b210 + b120 + b021 + b012 + b102 + b201) - (1 / 6.0L) * (p + q + r);
  const auto at = [&](const Vec3L& a, const Vec3L& b, const Vec3L& c) { return u * a + v * b + w * c; };
  const Vec3L c200 = at(p, b210, b201), c020 = at(b120, q, b021), c002 = at(b102, b012, r);
  const Vec3L c110 = at(b210, b120, b111), c011 = at(b111, b021, b012), c101 = at(b201, b111, b102);
  return at(at(c200, c110, c101), at(c110, c020, c011), at(c101, c011, c002));
}

double patchError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double size = random.magnitude(1e-6, 1e6);
    const glm::dvec3 center = random.unit() * size * random.magnitude(1e-3, 1e3);
    silhouette::Patch patch;
    double reach = 0.0;
    for (vec3& corner : patch.corners) {
      corner = randomPoint(random, center, size);
      reach = std::max(reach, double(glm::length(corner)));
    }
    for (CurveOffsets& side : patch.sides) side = {vec3(random.unit() * size), vec3(random.unit() * size)};
    const auto u = static_cast<float>(random.uniform(0, 1)),
               v = static_cast<float>(random.uniform(0, 1.0 - u));
    const float w = 1.0f - u - v;
    const Vec3L twin = patchTwin(patch, u, v, 1.0L - u - v);
    largest.see(length(Vec3L(patch.point(u, v, w)) - twin) / ((reach + size) * 0x1p-24));
  }
  return largest.value();
}

// Pixels of a projected point in a window of 16384 pixels, points no farther from the model's origin than their depth.
double projectionError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double size = random.magnitude(1e-6, 1e6);
    Projection projection;
    projection.pixelsX = projection.pixelsY = 16384.0f;
    projection.width = projection.height = 16384;
    projection.nearPlane = static_cast<float>(size * 1e-3);
    projection.farPlane = static_cast<float>(size * 1e4);
    glm::dmat4 modelToView(1.0);
    modelToView[3] = glm::dvec4(0, 0, -2.0 * size, 1);
    const silhouette::View view = silhouette::makeView(projection, modelToView);
    const vec3 p(random.unit() * size * 0.45), q(random.unit() * size * 0.45);
    const auto pixel = [&](const vec3& point, int axis) {
      const long double depth = -(static_cast<long double>(point.z) + view.modelToView[3][2]);
      return static_cast<long double>(point[axis]) / depth * projection.pixelsX;
    };
    const long double distance = std::hypot(pixel(p, 0) - pixel(q, 0), pixel(p, 1) - pixel(q, 1));
    largest.see(silhouette::PixelBound(view).distance(p, q) - distance);
  }
  return largest.value();
}

// Where the contour crosses an edge: the root against the same formula in long double.
double rootError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const double sign = random.sign();
    const double a = sign * random.magnitude(1e-12, 1e12), c = -sign * random.magnitude(1e-12, 1e12);
    const double b = random.oneIn(5) ? 0.0 : random.sign() * random.magnitude(1e-14, 1e14);
    const long double root = std::sqrt(static_cast<long double>(b) * b - 4.0L * a * c);
    const long double q = -0.5L * (b < 0 ? b - root : b + root);
    const bool first = (b < 0) == (c > 0);
    const long double tau = first ? q / c : a / q, u = tau / (1 + tau), rest = 1 / (1 + tau);
    const double found = silhouette::contourRoot(a, b, c);
    largest.see((found - u) / (std::max(u, 1e-3L) * 0x1p-53L));
    if (rest < 1e-3L) continue;
    largest.see(((1 - found) - rest) / 0x1p-53L);
  }
  return largest.value();
}

// What is left of the bounded quadratic (contour.h) where the silhouette point is said to be, over the distance from the eye.
double bridgeError(std::uint64_t seed, std::size_t cases) {
  Extremes random(seed);
  Largest largest;
  for (std::size_t i = 0; i < cases; ++i) {
    const EdgePair pair = randomPair(random);
    const std::array<vec3, 2> p{pair.points[0], pair.points[1]},
        n{randomNormal(random), randomNormal(random)};
    silhouette::View view;
    view.eye = pair.eye;
    if ((silhouette::facing(view, p[0], n[0]) >= 0) == (silhouette::facing(view, p[1], n[1]) >= 0)) continue;
    const CurveOffsets d = silhouette::edgeCurve(p[0], p[1], {{n[0], n[0]}, false}, {{n[1], n[1]}, false},
                                                 {silhouette::Tangents::kGeodesicArc, false});
    const vec3 turn = silhouette::normalTurn(p, n, d);
    const long double u = silhouette::contourParameter(view, p, n, turn), rest = 1 - u;
    const std::array<Vec3L, 2> v{Vec3L(pair.eye) - Vec3L(p[0]), Vec3L(pair.eye) - Vec3L(p[1])};
    const long double a = dot(v[0], Vec3L(n[0])), c = dot(v[1], Vec3L(n[1]));
    const long double free =
        dot(v[0], Vec3L(n[1])) + dot(v[1], Vec3L(n[0])) - 2 * dot(v[0] + v[1], Vec3L(turn));
    const long double least = silhouette::kSteepest * std::min(a, c),
                      most = silhouette::kSteepest * std::max(a, c);
    const long double b = std::clamp(free, least, most);
    largest.see((rest * rest * a + rest * u * b + u * u * c) / std::max(length(v[0]), length(v[1])));
  }
  return largest.value();
}

constexpr const char* kPairDomain =
    "sizes 1e-6 to 1e4, up to 100 sizes from the origin, needles of 1:1000, eye 3 sizes away or more";
constexpr const char* kCurveDomain = "as for silhouetteness; feature normals 2 to 178 degrees apart";
constexpr const char* kFarOrigin =
    "farther from the origin floats lose the shape itself, in proportion; never NaN";
constexpr const char* kFeatureOutside =
    "between 1 and 1/4 degree a feature end turns into a smooth or a straight one, continuously";

constexpr std::array kChecks{
    KernelCheck{"silhouetteness by edge", "alpha at beta = 1", 1e-5, kPairDomain, kFarOrigin, edgeTestError},
    KernelCheck{"silhouetteness by contour", "alpha at beta = 1", 1e-6, kPairDomain, kFarOrigin,
                contourTestError},
    KernelCheck{
        "silhouetteness by crossing", "alpha at beta = 1", 1e-5,
        "as for silhouetteness; an edge's facings of 0.01 or more where the contour does not cross it",
        "smaller facings lose digits in proportion; where they are 0, alpha is 1", crossingTestError},
    KernelCheck{"beta of a wedge", "beta", 1e-6, "0 to 180 degrees, any two unit normals", "clamped at 0",
                wedgeError},
    KernelCheck{"edge curve, projected", "edge lengths", 1e-6, kCurveDomain, kFeatureOutside,
                projectedCurveError},
    KernelCheck{"edge curve, circular", "edge lengths", 2e-6, kCurveDomain, kFeatureOutside,
                circularCurveError},
    KernelCheck{"edge curve, geodesic", "edge lengths", 1e-6, kPairDomain, kFarOrigin, geodesicCurveError},
    KernelCheck{"edge curve, geodesic arc", "edge lengths", 2e-6, kPairDomain, kFarOrigin, arcCurveError},
    KernelCheck{"patch point", "ulp of the largest coordinate", 5.0,
                "sizes 1e-6 to 1e6, up to 1000 from the origin", "the same, to overflow", patchError},
    KernelCheck{"contour crossing of an edge", "2^-53 of u, of 0.001 at least", 6.0,
                "values of 1e-12 to 1e12 at the ends",
                "at an end that is exactly on the contour the root is that end", rootError},
    KernelCheck{"silhouette point on a bridge", "residual of the quadratic over the distance", 1e-6,
                kPairDomain, kFarOrigin, bridgeError},
    KernelCheck{"projection for segment counts", "pixels", 0.005,
                "window of 16384 pixels, points no farther from the origin than half their depth",
                "grows with the ratio; depths before the near plane count as there", projectionError},
};

}  // namespace

std::span<const KernelCheck> silhouetteChecks() {
  return kChecks;
}

}  // namespace limn::measure
