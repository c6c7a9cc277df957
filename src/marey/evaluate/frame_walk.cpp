#include "marey/evaluate/frame_walk.h"

#include <algorithm>
#include <limits>

namespace marey {
namespace {

/// Intersection over union to the last bit as the reference implementations have it: areas from corners, which differ from
/// width × height by a rounding, and a draw with the threshold is decided by it.
double overlap(const Box& a, const Box& b) {
  const double width = std::min(a.right(), b.right()) - std::max(a.left, b.left);
  const double height = std::min(a.bottom(), b.bottom()) - std::max(a.top, b.top);
  if (!(width > 0 && height > 0)) return 0;
  const double shared = width * height;
  const double area_a = (a.right() - a.left) * (a.bottom() - a.top);
  const double area_b = (b.right() - b.left) * (b.bottom() - b.top);
  return shared / (area_a + area_b - shared);
}

/// The boxes from `begin` on that are of this frame; `begin` moves behind them.
std::span<const LabelledBox> take_frame(std::span<const LabelledBox> boxes, std::size_t& begin, std::int32_t frame) {
  const std::size_t first = begin;
  while (begin < boxes.size() && boxes[begin].frame == frame) ++begin;
  return boxes.subspan(first, begin - first);
}

}  // namespace

IdNumbers::IdNumbers(std::span<const LabelledBox> boxes) {
  ids_.reserve(boxes.size());
  for (const LabelledBox& box : boxes) ids_.push_back(box.id);
  std::sort(ids_.begin(), ids_.end());
  ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  ids_.shrink_to_fit();
}

int IdNumbers::operator()(std::int32_t id) const {
  return static_cast<int>(std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin());
}

bool FrameWalk::next() {
  if (next_true_ == truth_.size() && next_track_ == tracks_.size()) return false;
  constexpr std::int32_t never = std::numeric_limits<std::int32_t>::max();
  const std::int32_t frame = std::min(next_true_ < truth_.size() ? truth_[next_true_].frame : never,
                                      next_track_ < tracks_.size() ? tracks_[next_track_].frame : never);
  const auto rows = take_frame(truth_, next_true_, frame);
  const auto columns = take_frame(tracks_, next_track_, frame);
  row_objects_.clear();
  column_tracks_.clear();
  overlaps_.clear();
  for (const LabelledBox& column : columns) column_tracks_.push_back(track_numbers_(column.id));
  for (const LabelledBox& row : rows) {
    row_objects_.push_back(objects_(row.id));
    for (const LabelledBox& column : columns) overlaps_.push_back(overlap(row.box, column.box));
  }
  return true;
}

}  // namespace marey
