#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/detection.h"
#include "marey/core/frame.h"
#include "marey/core/frame_set.h"
#include "marey/core/source.h"
#include "marey/files/whole_file.h"

namespace marey::format::tracks {

/// How blobs are written, one line each; frames and pixels count from 0, s, px:
///   csv    with a header: camera,frame,time,x,y,var_x,cov_xy,var_y,area,score,left,top,width,height. A file of observations
///          (format/observations.h) at the same time
///   jsonl  one JSON object a line with the same names
enum class BlobText { csv, jsonl };

/// By the ending of `path`: JSON lines where that is .jsonl.
BlobText blob_text_of(const std::string& path);

/// Writes the detections in the images of one camera, as they come; the file is there atomically.
class BlobWriter {
 public:
  /// Throws Error if nothing can be written there.
  BlobWriter(const std::string& path, BlobText text, const std::string& camera);
  void write(const Frame& frame, std::span<const Detection> blobs);
  void finish() { file_.finish(); }

 private:
  WholeFile file_;
  BlobText text_;
  std::string camera_;
  std::string lines_;
};

/// Whether a file holds blobs: either form of BlobWriter's, or a CSV with columns frame, x and y and without an id.
bool is_blob_file(const std::string& path);

/// Blobs of one camera, frame by frame, in the place of its images and a detector. `frame`, `x` and `y` must be there; what else
/// BlobWriter writes is read where it is, in any order of the columns. Lines are in the order of frames, which are read one by one.
class BlobReader {
 public:
  /// `rate_hz` counts before the file's own times; 25, with a warning, where neither is there. Throws Error if the file cannot
  /// be read, a line is malformed, frames are not in order, or it holds several cameras' blobs.
  BlobReader(const std::string& path, std::optional<double> rate_hz);
  ~BlobReader();
  BlobReader(BlobReader&&) noexcept;

  const SourceInfo& info() const;
  const std::vector<std::string>& warnings() const;
  /// Frames without images, from 0 to the last that has a blob; nothing at the end.
  std::optional<CameraFrame> next();

 private:
  class Lines;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::format::tracks
