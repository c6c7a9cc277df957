#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/files/limits.h"

namespace marey::evaluate {

/// One thing of one frame, under an id that stands once a frame.
template <typename T>
concept Labelled = requires(const T& item) {
  { item.frame } -> std::convertible_to<std::int32_t>;
  { item.id } -> std::convertible_to<std::int32_t>;
};

/// How alike a true thing and a reported one are.
struct Closeness {
  double distance = 0;    ///< in the measure's own unit: 1 − IoU of boxes, m of places
  double similarity = 0;  ///< in [0, 1], 1 where they are the same
};

/// Different ids, numbered from 0 in their order.
class IdNumbers {
 public:
  template <Labelled Item>
  explicit IdNumbers(std::span<const Item> items) {
    ids_.reserve(items.size());
    for (const Item& item : items) ids_.push_back(item.id);
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
    ids_.shrink_to_fit();
  }
  int count() const { return static_cast<int>(ids_.size()); }
  /// Of an id that is among the items.
  int operator()(std::int32_t id) const { return static_cast<int>(std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin()); }
  std::int32_t id(int number) const { return ids_[static_cast<std::size_t>(number)]; }

 private:
  std::vector<std::int32_t> ids_;
};

/// One frame's true things (rows) against its reported ones (columns).
class FramePairs {
 public:
  std::span<const int> objects() const { return row_objects_; }   ///< numbers of the true things: the rows
  std::span<const int> tracks() const { return column_tracks_; }  ///< numbers of the reported things: the columns
  bool has_both() const { return !row_objects_.empty() && !column_tracks_.empty(); }
  std::span<const double> distances_of(std::size_t row) const { return row_of(distances_, row); }
  std::span<const double> similarities_of(std::size_t row) const { return row_of(similarities_, row); }

 protected:
  std::vector<int> row_objects_, column_tracks_;
  std::vector<double> distances_, similarities_;  // rows × columns

 private:
  std::span<const double> row_of(const std::vector<double>& all, std::size_t row) const {
    return std::span(all).subspan(row * column_tracks_.size(), column_tracks_.size());
  }
};

/// Goes through truth and tracks together, one frame that either has at a time. Both are ordered by frame; `close` is
/// Closeness(const Item& truth, const Item& track). Throws Error if a frame is crowded beyond `Limits::pairs_a_frame`.
template <Labelled Item, typename Close>
class FrameWalk : public FramePairs {
 public:
  FrameWalk(std::span<const Item> truth, std::span<const Item> tracks, const IdNumbers& objects, const IdNumbers& track_numbers,
            Close close, const Limits& limits = Limits::in_force())
      : truth_(truth),
        tracks_(tracks),
        objects_numbers_(objects),
        track_numbers_(track_numbers),
        close_(close),
        max_pairs_(limits.pairs_a_frame) {}

  /// Steps to the next frame; false at the end. Throws Stopped.
  bool next() {
    stop_point();
    if (next_true_ == truth_.size() && next_track_ == tracks_.size()) return false;
    constexpr std::int32_t never = std::numeric_limits<std::int32_t>::max();
    const std::int32_t frame = std::min(next_true_ < truth_.size() ? truth_[next_true_].frame : never,
                                        next_track_ < tracks_.size() ? tracks_[next_track_].frame : never);
    rows_ = take_frame(truth_, next_true_, frame);
    columns_ = take_frame(tracks_, next_track_, frame);
    if (!rows_.empty() && columns_.size() > max_pairs_ / rows_.size()) refuse(frame);
    fill();
    return true;
  }
  /// The things themselves, in the order of rows and columns.
  std::span<const Item> rows() const { return rows_; }
  std::span<const Item> columns() const { return columns_; }

 private:
  /// The items from `begin` on that are of this frame; `begin` moves behind them.
  static std::span<const Item> take_frame(std::span<const Item> items, std::size_t& begin, std::int32_t frame) {
    const std::size_t first = begin;
    while (begin < items.size() && items[begin].frame == frame) ++begin;
    return items.subspan(first, begin - first);
  }

  [[noreturn]] void refuse(std::int32_t frame) const {
    throw Error(
        "frame {} holds {} of the truth and {} that were tracked; at most {} pairs of one frame are compared (the limit "
        "pairs_a_frame)",
        frame + 1, rows_.size(), columns_.size(), max_pairs_);
  }

  void fill() {
    row_objects_.clear();
    column_tracks_.clear();
    distances_.clear();
    similarities_.clear();
    for (const Item& column : columns_) column_tracks_.push_back(track_numbers_(column.id));
    for (const Item& row : rows_) {
      row_objects_.push_back(objects_numbers_(row.id));
      for (const Item& column : columns_) {
        const Closeness closeness = close_(row, column);
        distances_.push_back(closeness.distance);
        similarities_.push_back(closeness.similarity);
      }
    }
  }

  std::span<const Item> truth_, tracks_, rows_, columns_;
  const IdNumbers& objects_numbers_;
  const IdNumbers& track_numbers_;
  Close close_;
  std::size_t max_pairs_;
  std::size_t next_true_ = 0;
  std::size_t next_track_ = 0;
};

}  // namespace marey::evaluate
