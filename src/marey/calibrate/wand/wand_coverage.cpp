#include "marey/calibrate/wand/wand_coverage.h"

#include <algorithm>

#include "marey/assign/disjoint_sets.h"

namespace marey::calibrate::wand {
namespace {

constexpr int kPartsAcross = WandCoverage::kPartsAcross, kPartsDown = WandCoverage::kPartsDown;

std::optional<int> part_of(const Vector<2>& pixel, cv::Size size) {
  if (!(pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < size.width && pixel.y() < size.height)) return std::nullopt;
  const auto column = static_cast<int>(pixel.x() / size.width * kPartsAcross);
  const auto row = static_cast<int>(pixel.y() / size.height * kPartsDown);
  return row * kPartsAcross + column;
}

/// How many of `a` have one of `b` within `together_s`; both by growing time.
std::int64_t shared_views(const std::vector<MarkFrame>& a, const std::vector<MarkFrame>& b, double together_s) {
  std::int64_t shared = 0;
  auto at = b.begin();
  for (const MarkFrame& frame : a) {
    while (at != b.end() && at->time_s < frame.time_s - together_s) ++at;
    shared += at != b.end() && at->time_s <= frame.time_s + together_s ? 1 : 0;
  }
  return shared;
}

}  // namespace

void WandCoverage::add(std::span<const Detected> detected, double together_s) {
  std::vector<std::vector<MarkFrame>> marks(detected.size());
  for (std::size_t c = 0; c < detected.size(); ++c) {
    if (detected[c].size.empty()) continue;
    marks[c] = find_marks(detected[c].frames, wand_, detected[c].lens, detected[c].size);
    Camera& camera = cameras_[c];
    for (const MarkFrame& frame : marks[c]) {
      ++camera.views;
      for (const auto& mark : frame.marks) {
        const auto part = mark ? part_of(*mark, detected[c].size) : std::nullopt;
        if (part && camera.parts.insert(*part).second) camera.views_at_growth = camera.views;
      }
    }
  }
  for (std::size_t a = 0; a < marks.size(); ++a) {
    for (std::size_t b = a + 1; b < marks.size(); ++b) shared_[{a, b}] += shared_views(marks[a], marks[b], together_s);
  }
}

std::int64_t WandCoverage::shared(std::size_t a, std::size_t b) const {
  const auto found = shared_.find({std::min(a, b), std::max(a, b)});
  return found != shared_.end() ? found->second : 0;
}

double WandCoverage::coverage(std::size_t camera) const {
  return static_cast<double>(cameras_[camera].parts.size()) / (kPartsAcross * kPartsDown);
}

bool WandCoverage::is_covered(std::size_t camera) const {
  const std::int64_t same = cameras_[camera].views - cameras_[camera].views_at_growth;
  const bool no_more = same >= (lenses_known_ ? kNothingNew : kNothingNewOfLens);
  return coverage(camera) >= (no_more ? kCovered : required(lenses_known_));
}

bool WandCoverage::is_enough() const {
  assign::DisjointSets chained(cameras_.size());
  for (const auto& [pair, views] : shared_) {
    if (views >= kEnoughShared) chained.join(static_cast<int>(pair.first), static_cast<int>(pair.second));
  }
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (!is_covered(c) || chained.find(static_cast<int>(c)) != chained.find(0)) return false;
  }
  return true;
}

}  // namespace marey::calibrate::wand
