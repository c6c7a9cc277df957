#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/run_mask.h"
#include "marey/core/sink.h"
#include "marey/files/whole_file.h"

namespace marey::format::tracks {

/// How contours are written as masks:
///   mots  MOTS text (mots.h), class 2: the visible part of each contour. Masks of a frame do not overlap: of two, the one that the
///         other's contour lists as hiding it has the pixels, else the one whose box ends lower.
///   coco  COCO instances (coco_instances.h), a polygon each: the whole contour, hidden parts included; `frame_id` from 0,
///   `track_id`
enum class MaskText { mots, coco };

/// Writes the contours of tracks as they come; samples without a contour are omitted. The file appears atomically.
class MaskFile final : public Sink {
 public:
  /// Throws Error if nothing can be written there.
  MaskFile(const std::string& path, MaskText format);

  std::string name() const override { return path_; }
  /// Throws Error for positions that are not in an image.
  SinkRequirements begin(const RecordingHeader& header) override;
  /// Throws Error if the size of the image is neither in the header nor in the instant's frames.
  void write(const Instant& instant) override;
  void finish() override;

 private:
  void append_mots_lines(const Instant& instant);
  void append_coco(const Instant& instant);

  std::string path_;
  WholeFile file_;
  MaskText text_;
  int width_ = 0, height_ = 0;  // px; 0 until known
  std::vector<std::int64_t> frames_;
  std::int64_t annotations_ = 0;
  std::string lines_;
};

/// The contours of an instant as masks of an image of this size, none of which overlap, by track: see MaskText::mots.
std::vector<LabelledMask> visible_masks(const Instant& instant, int width, int height);

}  // namespace marey::format::tracks
