#include "marey/calibrate/wand/wand_coverage.h"

namespace marey::calibrate::wand {
namespace {

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
    for (const MarkFrame& frame : marks[c]) {
      std::vector<Vector<2>> pixels;
      for (const auto& mark : frame.marks) {
        if (mark) pixels.push_back(*mark);
      }
      images_.add_view(c, pixels, detected[c].size);
    }
  }
  for (std::size_t a = 0; a < marks.size(); ++a) {
    for (std::size_t b = a + 1; b < marks.size(); ++b) images_.add_shared(a, b, shared_views(marks[a], marks[b], together_s));
  }
}

}  // namespace marey::calibrate::wand
