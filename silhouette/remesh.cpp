#include "silhouette/remesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "raster/base/check.h"

namespace limn::silhouette {
namespace {

using glm::vec2;

constexpr float kCoverCost = 4096.0f;  // of an ear's cover, in lengths of its diagonal

// Where vertices are seen, in pixels.
struct Seen {
  const PixelBound& bound;
  const Places& places;

  vec2 operator[](std::uint32_t vertex) const { return bound.place(places[vertex]); }
};

// Lines of the plane of weights: bit k is side k's, and this one the segment's.
constexpr unsigned kSegmentLine = 8;

// Twice the area of a triangle.
float turn(const vec2& a, const vec2& b, const vec2& c) {
  const vec2 p = b - a, q = c - a;
  return p.x * q.y - p.y * q.x;
}

// Through two places, or the first of them where they are the same.
struct Line {
  vec2 a, b;
  float length;

  Line(const vec2& from, const vec2& to) : a(from), b(to), length(glm::length(to - from)) {}

  float distance(const vec2& p) const {
    return length > 0.0f ? std::abs(turn(a, b, p)) / length : glm::length(p - a);
  }
};

// A polygon that is convex in the plane of weights, where vertices on a common line share a bit, but may be anything as the
// viewer sees it.
class Polygon {
 public:
  void add(std::uint32_t vertex, unsigned lines, const Seen& seen) {
    vertices_[size_] = {vertex, lines, seen[vertex]};
    ++size_;
  }
  void triangulate(Pieces& pieces);

 private:
  struct Vertex {
    std::uint32_t index;
    unsigned lines;
    vec2 place;
  };

  std::size_t before(std::size_t k) const { return k == 0 ? size_ - 1 : k - 1; }
  std::size_t after(std::size_t k) const { return k + 1 == size_ ? 0 : k + 1; }
  unsigned linesWithout(std::size_t skipped) const {
    unsigned lines = ~0u;
    for (std::size_t k = 0; k < size_; ++k)
      if (k != skipped) lines &= vertices_[k].lines;
    return lines;
  }
  void fan(Pieces& pieces) const {
    for (std::size_t k = 2; k < size_; ++k)
      pieces.add(vertices_[0].index, vertices_[k - 1].index, vertices_[k].index);
  }
  bool encloses(const vec2& place) const;
  float coverOf(std::size_t k) const;
  bool isPointOfLine(std::size_t k) const {
    return (vertices_[before(k)].lines & vertices_[k].lines & vertices_[after(k)].lines) != 0;
  }
  std::size_t bestEar() const;
  std::size_t anyEar() const;

  std::array<Vertex, 3 + 3 * kMaxSideVertices + kMaxSegments> vertices_;
  std::size_t size_ = 0;
};

// Whether the polygon goes around a place, either way: its winding number.
bool Polygon::encloses(const vec2& place) const {
  int winding = 0;
  for (std::size_t k = 0; k < size_; ++k) {
    const vec2 &p = vertices_[k].place, &q = vertices_[after(k)].place;
    if ((p.y <= place.y) == (q.y <= place.y)) continue;
    const bool rises = q.y > p.y;
    if ((turn(p, q, place) > 0.0f) == rises) winding += rises ? 1 : -1;
  }
  return winding != 0;
}

// How far, in pixels, the ear reaches over what the viewer sees of the polygon: where that bends inwards, the ear would hide
// the segment or the side.
float Polygon::coverOf(std::size_t k) const {
  const std::size_t first = before(k), last = after(k);
  const vec2 &a = vertices_[first].place, &b = vertices_[k].place, &c = vertices_[last].place;
  const float area = turn(a, b, c), side = area < 0.0f ? -1.0f : 1.0f;
  float cover = 0.0f;
  if (!encloses((a + b + c) * (1.0f / 3.0f))) {
    const float longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    cover = longest > 0.0f ? std::abs(area) / longest : 0.0f;
  }
  for (std::size_t other = 0; other < size_; ++other) {
    const vec2& p = vertices_[other].place;
    if (other == first || other == k || other == last) continue;
    if (side * turn(a, b, p) > 0.0f && side * turn(b, c, p) > 0.0f && side * turn(c, a, p) > 0.0f)
      cover = std::max(cover, Line(a, c).distance(p));
  }
  return cover;
}

// The ear with a short diagonal and little cover, among those that are no points of a straight line and do not leave one
// behind.
std::size_t Polygon::bestEar() const {
  std::size_t best = size_;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < size_; ++k) {
    if (isPointOfLine(k)) continue;
    const float diagonal = glm::length(vertices_[after(k)].place - vertices_[before(k)].place);
    if (!(diagonal < least) || linesWithout(k) != 0) continue;
    const float cost = diagonal + kCoverCost * coverOf(k);
    if (!(cost < least)) continue;
    least = cost;
    best = k;
  }
  return best < size_ ? best : anyEar();
}

// For places that are not finite.
std::size_t Polygon::anyEar() const {
  std::size_t k = 0;
  while (k < size_ && (isPointOfLine(k) || linesWithout(k) != 0)) ++k;
  LIMN_ASSERT(k < size_, size_);
  return k;
}

void Polygon::triangulate(Pieces& pieces) {
  // All on one line where a segment runs along a side: what lies between the two in space is a sliver.
  if (linesWithout(size_) != 0) {
    fan(pieces);
    return;
  }
  while (size_ > 3) {
    const std::size_t ear = bestEar();
    pieces.add(vertices_[before(ear)].index, vertices_[ear].index, vertices_[after(ear)].index);
    --size_;
    for (std::size_t k = ear; k < size_; ++k) vertices_[k] = vertices_[k + 1];
  }
  fan(pieces);
}

// The sides of a cut outline, seen from the lone corner A: out to B, across to C and back.
struct CutOutline {
  const Outline& outline;
  const Cut& cut;
  std::size_t out, across, back;

  CutOutline(const Outline& o, const Cut& c)
      : outline(o), cut(c), out(c.lone), across((c.lone + 1) % 3), back((c.lone + 2) % 3) {}

  static unsigned sideLine(std::size_t side) { return 1u << side; }
  // The sides that vertex k of a side lies on.
  unsigned linesOf(std::size_t side, std::size_t k) const {
    if (k == 0) return sideLine(side) | sideLine((side + 2) % 3);
    if (k > outline.counts[side]) return sideLine(side) | sideLine((side + 1) % 3);
    return sideLine(side);
  }
  std::uint32_t first() const { return outline.onSide(out, cut.ends[0]); }
  std::uint32_t last() const { return outline.onSide(back, cut.ends[1]); }

  // Nothing on the sides but the segment's ends.
  bool isPlain() const {
    const auto own = [](std::size_t end, std::size_t count) { return end > 0 && end <= count ? 1u : 0u; };
    return outline.counts[out] == own(cut.ends[0], outline.counts[out]) && outline.counts[across] == 0 &&
           outline.counts[back] == own(cut.ends[1], outline.counts[back]);
  }
};

// The fan (A; s_0 … s_n) and the strip between s_0 … s_n and BC.
void fanAndStrip(const CutOutline& o, const Seen& seen, Pieces& pieces) {
  const std::uint32_t a = o.outline.corners[o.out], b = o.outline.corners[o.across];
  const std::uint32_t c = o.outline.corners[o.back];
  const auto samples = o.cut.samples;
  const std::size_t steps = samples.size() + 1;
  const auto sample = [&](std::size_t k) {
    return k == 0 ? o.first() : k == steps ? o.last() : samples[k - 1];
  };
  // The strip turns at the sample that is seen nearest to BC.
  const Line far(seen[b], seen[c]);
  std::size_t turning = 0;
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k <= steps; ++k) {
    const float distance = far.distance(seen[sample(k)]);
    if (distance < nearest) nearest = distance, turning = k;
  }
  for (std::size_t k = 0; k < steps; ++k) pieces.add(a, sample(k), sample(k + 1));
  for (std::size_t k = 0; k < turning; ++k) pieces.add(b, sample(k + 1), sample(k));
  pieces.add(b, c, sample(turning));
  for (std::size_t k = turning; k < steps; ++k) pieces.add(c, sample(k + 1), sample(k));
}

}  // namespace

void remesh(const Outline& outline, Pieces& pieces) {
  std::array<std::uint32_t, 3 + 3 * kMaxSideVertices> around;
  std::size_t size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    around[size++] = outline.corners[k];
    for (std::size_t i = 0; i < outline.counts[k]; ++i) around[size++] = outline.sides[k][i];
  }
  if (wantsCentre(outline.counts)) {
    for (std::size_t k = 0; k < size; ++k)
      pieces.add(outline.centre, around[k], around[k + 1 == size ? 0 : k + 1]);
    return;
  }
  // At most one side has vertices: a fan around the corner opposite to it.
  const std::size_t apex = outline.counts[0] > 0 ? size - 1 : outline.counts[2] > 0 ? 1 : 0;
  for (std::size_t k = 1; k + 1 < size; ++k)
    pieces.add(around[apex], around[(apex + k) % size], around[(apex + k + 1) % size]);
}

void remesh(const Outline& outline, const Cut& cut, const PixelBound& bound, const Places& places,
            Pieces& pieces) {
  const CutOutline o(outline, cut);
  const Seen seen{bound, places};
  if (o.isPlain()) {
    fanAndStrip(o, seen, pieces);
    return;
  }
  const unsigned inner = kSegmentLine | (o.linesOf(o.out, cut.ends[0]) & o.linesOf(o.back, cut.ends[1]));
  const bool backToLone = cut.ends[1] > outline.counts[o.back], outToB = cut.ends[0] > outline.counts[o.out];
  const auto add = [&](Polygon& polygon, std::size_t side, std::size_t k, bool onSegment) {
    polygon.add(outline.onSide(side, k), o.linesOf(side, k) | (onSegment ? kSegmentLine : 0u), seen);
  };

  // From A to the first end, along the segment, and from its last end back.
  Polygon lone;
  for (std::size_t k = 0; k <= cut.ends[0]; ++k)
    add(lone, o.out, k, k == cut.ends[0] || (k == 0 && backToLone));
  for (const std::uint32_t sample : cut.samples) lone.add(sample, inner, seen);
  for (std::size_t k = cut.ends[1]; k <= outline.counts[o.back]; ++k) add(lone, o.back, k, k == cut.ends[1]);
  lone.triangulate(pieces);

  // From the first end over B and C to the last, and back along the segment.
  Polygon far;
  for (std::size_t k = cut.ends[0]; k <= outline.counts[o.out]; ++k) add(far, o.out, k, k == cut.ends[0]);
  for (std::size_t k = 0; k <= outline.counts[o.across]; ++k) add(far, o.across, k, k == 0 && outToB);
  for (std::size_t k = 0; k <= cut.ends[1]; ++k) add(far, o.back, k, k == cut.ends[1]);
  for (std::size_t k = cut.samples.size(); k-- > 0;) far.add(cut.samples[k], inner, seen);
  far.triangulate(pieces);
}

}  // namespace limn::silhouette
