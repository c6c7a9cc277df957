#include "marey/detect/background/background_marks.h"

#include <algorithm>

#include "marey/detect/runs.h"

namespace marey::detect::background {
namespace {

constexpr int kQuorum = 4;  // of 9

}  // namespace

void BandMarks::begin(cv::Size size) {
  size_ = size;
  const std::size_t padded = static_cast<std::size_t>(size.width) + 4;
  for (auto& row : marks_) row.assign(padded, 0);
  chroma_mark_.assign(padded, 0);
  vote_.assign(padded, 0);
}

void BandMarks::mark_row(const FramePlanes& frame, const SceneView& scene, int y) {
  std::uint8_t* mark = marks_[y % 3].data() + 1;
  kernels_.classify(frame.luma.ptr<std::uint8_t>(y), scene.luma.low(y), scene.luma.high(y), size_.width, mark);
  if (frame.cb.empty()) return;
  const int half = y / 2;
  if (y % 2 == 0) {
    const std::uint8_t* const pixels[2] = {frame.cb.ptr<std::uint8_t>(half), frame.cr.ptr<std::uint8_t>(half)};
    const std::uint8_t* const low[2] = {scene.cb.low(half), scene.cr.low(half)};
    const std::uint8_t* const high[2] = {scene.cb.high(half), scene.cr.high(half)};
    kernels_.classify_chroma(pixels, low, high, frame.cb.cols, chroma_mark_.data());
  }
  kernels_.unite(chroma_mark_.data(), size_.width, mark);
}

void BandMarks::find(const FramePlanes& frame, const SceneView& scene, MarkedRuns& marked) {
  marked.runs.clear();
  marked.strong.clear();
  marked.solid.clear();
  marked.pixels = 0;
  std::fill(marks_[2].begin(), marks_[2].end(), std::uint8_t{0});
  mark_row(frame, scene, 0);
  for (int y = 0; y < size_.height; ++y) {
    if (y + 1 < size_.height) {
      mark_row(frame, scene, y + 1);
    } else {
      std::fill(marks_[(y + 1) % 3].begin(), marks_[(y + 1) % 3].end(), std::uint8_t{0});
    }
    const std::uint8_t* const rows[3] = {marks_[(y + 2) % 3].data() + 1, marks_[y % 3].data() + 1, marks_[(y + 1) % 3].data() + 1};
    kernels_.vote(rows, kQuorum, size_.width, vote_.data());
    append_runs(vote_.data(), y, size_.width, marked.runs);
    for (std::size_t i = marked.strong.size(); i < marked.runs.size(); ++i) {
      const PixelRun& run = marked.runs[i];
      int strong = 0, solid = 0;
      for (int x = run.begin; x < run.end; ++x) {
        strong += (vote_[x] >> 1) & 1;
        solid += vote_[x] >> 2;
      }
      marked.strong.push_back(strong);
      marked.solid.push_back(solid);
      marked.pixels += run.end - run.begin;
    }
  }
}

}  // namespace marey::detect::background
