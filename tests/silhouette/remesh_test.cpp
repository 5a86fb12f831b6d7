#include "silhouette/remesh.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <map>
#include <random>

#include "shapes.h"

namespace limn::silhouette::test {
namespace {

using glm::vec3;

// An outline over a triangle in the plane z = 0, each vertex where its weights say: vertices on sides lie on straight
// lines, exactly the case that ear clipping must not mistake.
struct Flat {
  Outline outline;
  Cut cut;
  std::vector<std::uint32_t> samples;
  std::vector<vec3> places{{0, 0, 0}, {8, 0, 0}, {2, 7, 0}};

  std::uint32_t add(const vec3& place) {
    places.push_back(place);
    return static_cast<std::uint32_t>(places.size() - 1);
  }
  void addSides(const std::array<std::size_t, 3>& counts) {
    outline.corners = {0, 1, 2};
    outline.counts = counts;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < counts[k]; ++i) {
        const float t = static_cast<float>(i + 1) / static_cast<float>(counts[k] + 1);
        outline.sides[k][i] = add((1.0f - t) * places[k] + t * places[(k + 1) % 3]);
      }
    if (wantsCentre(outline.counts)) outline.centre = add((places[0] + places[1] + places[2]) / 3.0f);
  }
  std::uint32_t onSide(std::size_t side, std::size_t k) const {
    if (k == 0) return outline.corners[side];
    return k > outline.counts[side] ? outline.corners[(side + 1) % 3] : outline.sides[side][k - 1];
  }
  // A straight segment, slightly bent off the line so that slivers along a side have an area.
  void addCut(std::size_t lone, const std::array<std::size_t, 2>& ends, std::size_t count) {
    cut.lone = lone;
    cut.ends = ends;
    const vec3 a = places[onSide(lone, ends[0])], b = places[onSide((lone + 2) % 3, ends[1])];
    for (std::size_t i = 1; i <= count; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(count + 1);
      samples.push_back(add((1.0f - t) * a + t * b));
    }
    cut.samples = samples;
  }
};

// Every inner side has its opposite, and what is left is the outline's boundary, once and in its sense.
void expectWhole(const Flat& flat, const Pieces& pieces, const std::string& name) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (std::size_t k = 0; k < pieces.count; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &a = pieces.triangles[k][i], &b = pieces.triangles[k][(i + 1) % 3];
      EXPECT_EQ(++sides[std::make_pair(a, b)], 1) << name;
    }
  for (std::size_t side = 0; side < 3; ++side)
    for (std::size_t k = 0; k <= flat.outline.counts[side]; ++k) {
      const auto edge = std::make_pair(flat.onSide(side, k), flat.onSide(side, k + 1));
      EXPECT_EQ(sides.erase(edge), 1u) << name;
    }
  for (const auto& [side, count] : sides)
    EXPECT_TRUE(sides.contains(std::make_pair(side.second, side.first))) << name;
}

float area(const Flat& flat, const Pieces& pieces, bool& negative) {
  float sum = 0.0f;
  for (std::size_t k = 0; k < pieces.count; ++k) {
    const auto& t = pieces.triangles[k];
    const float twice =
        glm::cross(flat.places[t[1]] - flat.places[t[0]], flat.places[t[2]] - flat.places[t[0]]).z;
    negative = negative || twice < -1e-4f;
    sum += 0.5f * twice;
  }
  return sum;
}

TEST(Remesh, SidesWithoutASegment) {
  for (std::size_t code = 0; code < 64; ++code) {
    Flat flat;
    flat.addSides({code % 4, code / 4 % 4, code / 16});
    Pieces pieces;
    remesh(flat.outline, pieces);
    const std::string name = "counts " + std::to_string(code);
    const std::size_t onSides = code % 4 + code / 4 % 4 + code / 16;
    EXPECT_EQ(pieces.count, onSides + (wantsCentre(flat.outline.counts) ? 3 : 1)) << name;
    expectWhole(flat, pieces, name);
    bool negative = false;
    EXPECT_NEAR(area(flat, pieces, negative), 28.0f, 1e-3f) << name;
    EXPECT_FALSE(negative) << name;
  }
}

// Every number of vertices on the sides, every pair of ends, corners included, every lone corner.
TEST(Remesh, EverySegment) {
  const PixelBound bound(orthographicAlong({0, 0, -1}));
  for (std::size_t code = 0; code < 64; ++code)
    for (std::size_t lone = 0; lone < 3; ++lone) {
      const std::array<std::size_t, 3> counts{code % 4, code / 4 % 4, code / 16};
      const std::size_t out = counts[lone], back = counts[(lone + 2) % 3];
      for (std::size_t first = 0; first <= out + 1; ++first)
        for (std::size_t last = 0; last <= back + 1; ++last)
          for (const std::size_t samples : {0u, 1u, 5u}) {
            if (first == 0 && last == back + 1) continue;  // both ends at the lone corner: no segment
            Flat flat;
            flat.addSides(counts);
            flat.addCut(lone, {first, last}, samples);
            Pieces pieces;
            remesh(flat.outline, flat.cut, bound, {flat.places, {}}, pieces);
            const std::string name = "counts " + std::to_string(code) + " lone " + std::to_string(lone) +
                                     " ends " + std::to_string(first) + " " + std::to_string(last);
            EXPECT_EQ(pieces.count, 1 + counts[0] + counts[1] + counts[2] + 2 * samples) << name;
            expectWhole(flat, pieces, name);
            bool negative = false;
            EXPECT_NEAR(area(flat, pieces, negative), 28.0f, 1e-2f) << name;
            EXPECT_FALSE(negative) << name;
          }
    }
}

// A segment that bulges towards the far side, and one that bulges away from it, as far as it stays inside the
// triangle (beyond it starts at more than the 49 degrees of the corner): no piece faces the other way.
TEST(Remesh, StripDoesNotFold) {
  const PixelBound bound(orthographicAlong({0, 0, -1}));
  for (int bulge = -9; bulge <= 9; ++bulge) {
    Flat flat;
    flat.addSides({1, 0, 1});
    const vec3 p = flat.places[3], q = flat.places[4];
    flat.addCut(0, {1, 1}, 9);
    const vec3 outwards = glm::normalize(glm::cross(q - p, vec3(0, 0, 1)));
    for (std::size_t i = 0; i < 9; ++i) {
      const float t = static_cast<float>(i + 1) / 10.0f;
      flat.places[flat.samples[i]] +=
          0.4f * static_cast<float>(bulge) / 3.0f * t * (1.0f - t) * 4.0f * outwards;
    }
    Pieces pieces;
    remesh(flat.outline, flat.cut, bound, {flat.places, {}}, pieces);
    bool negative = false;
    EXPECT_NEAR(area(flat, pieces, negative), 28.0f, 1e-3f) << bulge;
    EXPECT_FALSE(negative) << bulge;
  }
}

// A side that bends inwards, and a segment that cuts off a corner at its end: a diagonal from the segment to the middle of
// the side would hide it.
TEST(Remesh, NoDiagonalHidesASideThatBendsInwards) {
  const PixelBound bound(orthographicAlong({0, 0, -1}));
  for (int depth = 0; depth <= 10; ++depth) {
    Flat flat;
    flat.addSides({4, 0, 1});
    const std::array<float, 4> x{0.4f, 2.0f, 4.0f, 6.0f};
    float removed = 0.0f;  // between the side and the line that it was
    vec3 before(0.0f);
    for (std::size_t k = 0; k < 4; ++k) {
      const vec3 place(x[k], 0.1f * static_cast<float>(depth) * x[k] * (8.0f - x[k]) / 16.0f, 0.0f);
      flat.places[flat.outline.sides[0][k]] = place;
      removed += 0.5f * (before.y + place.y) * (place.x - before.x);
      before = place;
    }
    removed += 0.5f * before.y * (8.0f - before.x);
    flat.places[flat.outline.sides[2][0]] = {0.1f, 0.35f, 0.0f};
    flat.addCut(0, {1, 1}, 0);
    Pieces pieces;
    remesh(flat.outline, flat.cut, bound, {flat.places, {}}, pieces);
    bool negative = false;
    EXPECT_NEAR(area(flat, pieces, negative), 28.0f - removed, 1e-3f) << depth;
    EXPECT_FALSE(negative) << depth;
  }
}

}  // namespace
}  // namespace limn::silhouette::test
