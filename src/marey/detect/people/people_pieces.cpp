#include "marey/detect/people/people_pieces.h"

namespace marey::detect::people {
namespace {

constexpr double kOwnGapAcross = 0.05, kOwnGapDown = 0.15;  // of the larger region's height, while that is all that is known
constexpr int kOwnRounds = 3;
constexpr double kWithin = 0.6;  // of a region's box, within that of a person expected: his, while no size is known

}  // namespace

assign::DisjointSets pieces_by_their_own_size(const std::vector<Region>& regions) {
  const auto count = static_cast<int>(regions.size());
  assign::DisjointSets pieces;
  pieces.reset(count);
  std::vector<Box> hulls;
  for (const Region& region : regions) hulls.push_back(region.box);
  for (int round = 0; round < kOwnRounds && count < kManyRegions; ++round) {
    bool joined = false;
    for (int i = 0; i < count; ++i) {
      for (int j = i + 1; j < count; ++j) {
        const int first = pieces.find(i), second = pieces.find(j);
        if (first == second) continue;
        const Box &a = hulls[static_cast<std::size_t>(first)], &b = hulls[static_cast<std::size_t>(second)];
        const double tall = std::max(a.height, b.height);
        if (gap(a.left, a.right(), b.left, b.right()) > kOwnGapAcross * tall) continue;
        if (gap(a.top, a.bottom(), b.top, b.bottom()) > kOwnGapDown * tall) continue;
        const Box hull = geometry::hull(a, b);
        pieces.join(first, second);
        hulls[static_cast<std::size_t>(pieces.find(first))] = hull;
        joined = true;
      }
    }
    if (!joined) break;
  }
  return pieces;
}

assign::DisjointSets pieces_of_those_expected(const std::vector<Region>& regions, std::span<const Expected> expected) {
  assign::DisjointSets pieces = pieces_by_their_own_size(regions);
  for (const Expected& one : expected) {
    const auto meets = [&](const Expected& other) { return &other != &one && !geometry::intersection(one.box, other.box).empty(); };
    if (std::any_of(expected.begin(), expected.end(), meets)) continue;
    int first = -1;
    for (int i = 0; i < std::ssize(regions); ++i) {
      const Box& box = regions[static_cast<std::size_t>(i)].box;
      if (geometry::intersection(one.box, box).area() < kWithin * box.area()) continue;
      if (first >= 0) pieces.join(first, i);
      first = i;
    }
  }
  return pieces;
}

void put_in_order(std::vector<PixelRun>& runs) {
  std::sort(runs.begin(), runs.end(),
            [](const PixelRun& a, const PixelRun& b) { return a.row != b.row ? a.row < b.row : a.begin < b.begin; });
}

std::vector<Body> bodies_of(const std::vector<Region>& regions, assign::DisjointSets& pieces) {
  std::vector<Body> bodies;
  std::vector<int> body_of(regions.size(), -1);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    int& index = body_of[static_cast<std::size_t>(pieces.find(static_cast<int>(i)))];
    if (index < 0) {
      index = static_cast<int>(bodies.size());
      bodies.push_back({{}, regions[i].box, 0});
    }
    Body& body = bodies[static_cast<std::size_t>(index)];
    body.box = geometry::hull(body.box, regions[i].box);
    body.area += regions[i].area;
    body.runs.insert(body.runs.end(), regions[i].runs.begin(), regions[i].runs.end());
  }
  for (Body& body : bodies) put_in_order(body.runs);
  return bodies;
}

}  // namespace marey::detect::people
