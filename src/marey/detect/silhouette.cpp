// From a mask to regions: connected components over runs instead of pixels. One pass turns each row into runs; runs that
// touch runs of the row above are joined in a union-find forest whose roots are the smallest indices, so that the order of
// regions is the order of their first pixels. The gaps between runs are joined by the same means, by edges only: a gap that is
// not joined to the border is a hole, and becomes a run of the region round it before regions are joined.
// Cost: the mask is read once, eight empty pixels at a time; all else grows with the number of runs.
// Reference: He, Chao, Suzuki, "A run-based two-scan labeling algorithm", IEEE Trans. Image Processing 17(5), 2008.
//
// The outline walks the cracks between pixels with the region at its right hand. Where two pixels touch by a corner only, it
// turns left: regions are joined over corners.
#include "marey/detect/silhouette.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <utility>

#include "marey/detect/runs.h"

namespace marey::detect {
namespace {

std::vector<PixelRun> runs_of(const cv::Mat& mask) {
  std::vector<PixelRun> runs;
  for (int row = 0; row < mask.rows; ++row) append_runs(mask.ptr<std::uint8_t>(row), row, mask.cols, runs);
  return runs;
}

/// The remainder of the rows and columns of `size` without `runs`.
std::vector<PixelRun> gaps_between(std::span<const PixelRun> runs, cv::Size size) {
  std::vector<PixelRun> gaps;
  std::size_t next = 0;
  for (int row = 0; row < size.height; ++row) {
    int begin = 0;
    for (; next < runs.size() && runs[next].row == row; ++next) {
      if (runs[next].begin > begin) gaps.push_back({row, begin, runs[next].begin});
      begin = runs[next].end;
    }
    if (begin < size.width) gaps.push_back({row, begin, size.width});
  }
  return gaps;
}

std::vector<PixelRun> holes_between(std::span<const PixelRun> runs, cv::Size size, double max_hole) {
  const std::vector<PixelRun> gaps = gaps_between(runs, size);
  assign::DisjointSets sets(gaps.size());
  join_neighbours(gaps, 0, sets);
  std::vector<double> area(gaps.size(), 0);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const PixelRun& gap = gaps[i];
    const bool at_border = gap.row == 0 || gap.row == size.height - 1 || gap.begin == 0 || gap.end == size.width;
    area[sets.find(static_cast<int>(i))] += at_border ? std::numeric_limits<double>::infinity() : gap.end - gap.begin;
  }
  std::vector<PixelRun> holes;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const double hole = area[sets.find(static_cast<int>(i))];
    if (hole <= max_hole && hole < std::numeric_limits<double>::infinity()) holes.push_back(gaps[i]);
  }
  return holes;
}

bool before(const PixelRun& a, const PixelRun& b) {
  return a.row != b.row ? a.row < b.row : a.begin < b.begin;
}

/// Puts runs that overlap or touch in a row into one. `runs` are in order.
void join_in_rows(std::vector<PixelRun>& runs) {
  std::size_t kept = 0;
  for (const PixelRun& run : runs) {
    if (kept > 0 && runs[kept - 1].row == run.row && runs[kept - 1].end >= run.begin) {
      runs[kept - 1].end = std::max(runs[kept - 1].end, run.end);
    } else {
      runs[kept++] = run;
    }
  }
  runs.resize(kept);
}

void fill_holes(std::vector<PixelRun>& runs, cv::Size size, double max_hole) {
  const std::vector<PixelRun> holes = holes_between(runs, size, max_hole);
  if (holes.empty()) return;
  std::vector<PixelRun> all;
  all.reserve(runs.size() + holes.size());
  std::merge(runs.begin(), runs.end(), holes.begin(), holes.end(), std::back_inserter(all), before);
  runs = std::move(all);
  join_in_rows(runs);
}

/// The region's pixels with an empty border of one pixel all round.
class Bitmap {
 public:
  explicit Bitmap(std::span<const PixelRun> runs) {
    top_ = runs.front().row - 1;
    left_ =
        std::min_element(runs.begin(), runs.end(), [](const PixelRun& a, const PixelRun& b) { return a.begin < b.begin; })->begin -
        1;
    const int right =
        std::max_element(runs.begin(), runs.end(), [](const PixelRun& a, const PixelRun& b) { return a.end < b.end; })->end + 1;
    width_ = right - left_;
    pixels_.assign(static_cast<std::size_t>(width_) * (runs.back().row + 2 - top_), 0);
    for (const PixelRun& run : runs) {
      const auto begin = pixels_.begin() + static_cast<std::ptrdiff_t>(run.row - top_) * width_ + (run.begin - left_);
      std::fill(begin, begin + (run.end - run.begin), std::uint8_t{1});
    }
  }

  bool at(int x, int y) const { return pixels_[static_cast<std::size_t>(y - top_) * width_ + (x - left_)] != 0; }

 private:
  int left_ = 0, top_ = 0, width_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace

Region region_of(std::vector<PixelRun> runs) {
  Region region;
  join_in_rows(runs);
  int left = std::numeric_limits<int>::max();
  int right = std::numeric_limits<int>::min();
  Vector<2> sum = Vector<2>::Zero();
  for (const PixelRun& run : runs) {
    const double length = run.end - run.begin;
    region.area += length;
    sum += length * Vector<2>((run.begin + run.end - 1) / 2.0, run.row);
    left = std::min(left, run.begin);
    right = std::max(right, run.end);
  }
  region.centre = sum / region.area;
  region.box = {static_cast<double>(left), static_cast<double>(runs.front().row), static_cast<double>(right - left),
                static_cast<double>(runs.back().row + 1 - runs.front().row)};
  region.runs = std::move(runs);
  return region;
}

std::vector<Region> find_regions(const cv::Mat& mask, const RegionOptions& options) {
  CV_Assert(mask.empty() || mask.type() == CV_8UC1);
  std::vector<PixelRun> runs = runs_of(mask);
  if (options.max_hole > 0) fill_holes(runs, mask.size(), options.max_hole);
  assign::DisjointSets sets(runs.size());
  join_neighbours(runs, 1, sets);

  std::vector<double> area(runs.size(), 0);
  for (std::size_t i = 0; i < runs.size(); ++i) area[sets.find(static_cast<int>(i))] += runs[i].end - runs[i].begin;
  constexpr int kNone = -1;
  std::vector<int> part_of(runs.size(), kNone);
  std::vector<std::vector<PixelRun>> parts;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const int root = sets.find(static_cast<int>(i));
    if (area[root] < options.min_area) continue;
    if (part_of[root] == kNone) {
      part_of[root] = static_cast<int>(parts.size());
      parts.emplace_back();
    }
    parts[part_of[root]].push_back(runs[i]);
  }
  std::vector<Region> regions;
  regions.reserve(parts.size());
  for (std::vector<PixelRun>& part : parts) regions.push_back(region_of(std::move(part)));
  return regions;
}

std::vector<PixelRun> largest_part(std::span<const PixelRun> runs) {
  assign::DisjointSets sets(runs.size());
  join_neighbours(runs, 1, sets);
  std::vector<int> area(runs.size(), 0);
  for (std::size_t i = 0; i < runs.size(); ++i) area[sets.find(static_cast<int>(i))] += runs[i].end - runs[i].begin;
  const auto largest = std::max_element(area.begin(), area.end()) - area.begin();
  std::vector<PixelRun> part;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (sets.find(static_cast<int>(i)) == largest) part.push_back(runs[i]);
  }
  return part;
}

std::vector<Vector<2>> outline_of(std::span<const PixelRun> runs) {
  if (runs.empty()) return {};
  struct Step {
    int x, y;
  };
  constexpr std::array<Step, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};  // right, down, left, up: each a right turn
  const Bitmap bitmap(runs);
  const Step start{runs.front().begin, runs.front().row};  // a corner (x, y) lies at pixel coordinates (x − ½, y − ½)
  Step corner = start;
  int heading = 0;
  std::vector<Vector<2>> outline = {Vector<2>(start.x - 0.5, start.y - 0.5)};
  do {
    // The two pixels ahead of the corner, at the left and at the right hand.
    const Step step = kSteps[heading];
    const int ahead_x = corner.x + (step.x + step.y - 1) / 2;
    const int ahead_y = corner.y + (step.y - step.x - 1) / 2;
    const bool left = bitmap.at(ahead_x, ahead_y);
    const bool right = bitmap.at(ahead_x - step.y, ahead_y + step.x);
    const int turn = left ? 3 : right ? 0 : 1;
    if (turn != 0) outline.emplace_back(corner.x - 0.5, corner.y - 0.5);
    heading = (heading + turn) % 4;
    corner = {corner.x + kSteps[heading].x, corner.y + kSteps[heading].y};
  } while (corner.x != start.x || corner.y != start.y);
  return outline;
}

}  // namespace marey::detect
