// Connected components by runs (He, Chao & Suzuki, A run-based two-scan labeling algorithm, IEEE Trans. Image Processing 17, 2008).
// Only the first scan touches pixels: words of 64 with a bit set (marker_kernel) become runs by counting trailing zeros, and runs
// of neighbouring rows that touch are joined in a union-find whose roots are their first runs. The second scan goes over the runs
// and sums area and instants in closed form. Assumes a mostly dark image for its speed, not for its result. Cost: one comparison of
// 64 pixels a word, and O(runs · α). Where an image has more runs than allowed (noise, glare) the search ends there and says so.
#include "marey/detect/markers/marker_runs.h"

#include <algorithm>
#include <bit>

#include "marey/assign/disjoint_sets.h"

namespace marey::detect::markers {

MarkerMask::MarkerMask(const cv::Mat& excluded) : size_(excluded.size()), words_((excluded.cols + 63) / 64) {
  CV_Assert(excluded.type() == CV_8UC1);
  bits_.assign(static_cast<std::size_t>(words_) * excluded.rows, 0);
  for (int y = 0; y < excluded.rows; ++y) {
    const auto* row = excluded.ptr<std::uint8_t>(y);
    for (int x = 0; x < excluded.cols; ++x) {
      if (row[x] != 0) bits_[static_cast<std::size_t>(y) * words_ + x / 64] |= std::uint64_t{1} << (x % 64);
    }
  }
}

void MarkerMask::add(const MarkerMask& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  CV_Assert(size_ == other.size_);
  for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] |= other.bits_[i];
}

MarkerRunFinder::MarkerRunFinder(std::size_t most_runs, const MarkerKernels& kernels) : max_runs_(most_runs), kernels_(kernels) {}

std::span<const MarkerBlob> MarkerRunFinder::find(const cv::Mat& image, const MarkerThresholds& thresholds,
                                                  const MarkerMask& mask) {
  CV_Assert((image.type() == CV_8UC1 || image.type() == CV_16UC1) && (mask.empty() || mask.size() == image.size()));
  runs_.clear();
  blobs_.clear();
  cut_at_.reset();
  scan(image, thresholds, mask);
  sum_up();
  return blobs_;
}

void MarkerRunFinder::scan(const cv::Mat& image, const MarkerThresholds& thresholds, const MarkerMask& mask) {
  constexpr int kTile = MarkerThresholds::kTile;
  const int words = (image.cols + 63) / 64;
  hits_.resize(static_cast<std::size_t>(words) * kTile);
  std::size_t above = 0;  // the first run of the row above, and of this row
  std::size_t here = 0;
  int last_row = -2;
  for (int top = 0; top < image.rows; top += kTile) {
    const MarkerBand band{image.ptr(top),
                          image.step[0],
                          std::min(kTile, image.rows - top),
                          image.cols,
                          thresholds.of_tile.data() + static_cast<std::ptrdiff_t>(top / kTile) * words,
                          thresholds.dark};
    const int count = (image.depth() == CV_8U ? kernels_.scan_8 : kernels_.scan_16)(band, hits_.data());
    for (int i = 0; i < count; ++i) {
      const MarkerHit& hit = hits_[i];
      const int row = top + hit.row;
      if (row != last_row) {
        join_rows(above, here);
        above = row == last_row + 1 ? here : runs_.size();
        here = runs_.size();
        last_row = row;
        if (runs_.size() + image.cols / 2 + 1 > max_runs_) {
          cut_at_ = row;
          return;
        }
      }
      const std::uint64_t bits = mask.empty() ? hit.bits : hit.bits & ~mask.word(row, hit.word);
      add_word(row, hit.word, bits);
    }
  }
  join_rows(above, here);
}

void MarkerRunFinder::add_word(int row, int word, std::uint64_t bits) {
  const int first = 64 * word;
  while (bits != 0) {
    const int begin = std::countr_zero(bits);
    const int length = std::countr_one(bits >> begin);
    const bool goes_on = begin == 0 && !runs_.empty() && runs_.back().row == row && runs_.back().end == first;
    if (goes_on) {
      runs_.back().end += length;
    } else {
      runs_.push_back({row, first + begin, first + begin + length, static_cast<std::int32_t>(runs_.size())});
    }
    if (begin + length == 64) return;
    bits &= ~std::uint64_t{0} << (begin + length);
  }
}

std::int32_t MarkerRunFinder::root(std::int32_t run) {
  return assign::find_root(run, [this](std::int32_t i) -> std::int32_t& { return runs_[i].parent; });
}

/// Joins the runs [above, here) of one row with the runs from `here` on of the next; both in order of columns.
void MarkerRunFinder::join_rows(std::size_t above, std::size_t here) {
  std::size_t a = above;
  for (std::size_t b = here; a < here && b < runs_.size();) {
    if (runs_[a].end < runs_[b].begin) {
      ++a;
    } else if (runs_[b].end < runs_[a].begin) {
      ++b;
    } else {
      const std::int32_t first = root(static_cast<std::int32_t>(a));
      const std::int32_t second = root(static_cast<std::int32_t>(b));
      assign::join_roots(first, second, [this](std::int32_t i) -> std::int32_t& { return runs_[i].parent; });
      runs_[a].end < runs_[b].end ? ++a : ++b;
    }
  }
}

void MarkerRunFinder::sum_up() {
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    MarkerRun& run = runs_[i];
    const double n = run.end - run.begin;
    const double x = (run.begin + run.end - 1) / 2.0;
    const bool first = run.parent == static_cast<std::int32_t>(i);
    // A parent comes before its child, so it already holds its component's number.
    run.parent = first ? static_cast<std::int32_t>(blobs_.size()) : runs_[run.parent].parent;
    if (first) blobs_.emplace_back();
    MarkerBlob& blob = blobs_[run.parent];
    const cv::Rect box(run.begin, run.row, run.end - run.begin, 1);
    blob.box = first ? box : blob.box | box;
    // Sums about the first pixel of the box would move with it; about the image's corner they stay exact in doubles.
    blob.area += run.end - run.begin;
    blob.mean_x += n * x;
    blob.mean_y += n * run.row;
    blob.var_x += n * (x * x + n * n / 12);  // a run is a bar of length n: variance n²/12
    blob.var_y += n * (static_cast<double>(run.row) * run.row + 1.0 / 12);
    blob.cov_xy += n * x * run.row;
  }
  for (MarkerBlob& blob : blobs_) {
    const auto n = static_cast<double>(blob.area);
    blob.mean_x /= n;
    blob.mean_y /= n;
    blob.var_x = blob.var_x / n - blob.mean_x * blob.mean_x;
    blob.var_y = blob.var_y / n - blob.mean_y * blob.mean_y;
    blob.cov_xy = blob.cov_xy / n - blob.mean_x * blob.mean_y;
  }
}

}  // namespace marey::detect::markers
