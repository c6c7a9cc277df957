#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/labelled_box.h"

namespace marey {

/// Different ids, numbered from 0 in their order.
class IdNumbers {
 public:
  explicit IdNumbers(std::span<const LabelledBox> boxes);
  int count() const { return static_cast<int>(ids_.size()); }
  int operator()(std::int32_t id) const;  ///< of an id that is among the boxes

 private:
  std::vector<std::int32_t> ids_;
};

/// Goes through truth and tracks together, one frame that either has at a time.
class FrameWalk {
 public:
  FrameWalk(std::span<const LabelledBox> truth, std::span<const LabelledBox> tracks, const IdNumbers& objects,
            const IdNumbers& track_numbers)
      : truth_(truth), tracks_(tracks), objects_(objects), track_numbers_(track_numbers) {}

  /// Steps to the next frame; false at the end.
  bool next();

  std::span<const int> objects() const { return row_objects_; }   ///< numbers of the true boxes of this frame: the rows
  std::span<const int> tracks() const { return column_tracks_; }  ///< numbers of the reported boxes: the columns
  std::span<const double> overlaps() const { return overlaps_; }  ///< IoU, rows × columns
  std::span<const double> overlaps_of(std::size_t row) const { return overlaps().subspan(row * tracks().size(), tracks().size()); }

 private:
  std::span<const LabelledBox> truth_, tracks_;
  const IdNumbers& objects_;
  const IdNumbers& track_numbers_;
  std::size_t next_true_ = 0;
  std::size_t next_track_ = 0;
  std::vector<int> row_objects_, column_tracks_;
  std::vector<double> overlaps_;
};

}  // namespace marey
