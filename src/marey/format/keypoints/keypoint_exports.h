// Keypoints as other programs read them, written as they come: COCO keypoints JSON in one file, and OpenPose's folder of a JSON
// file per frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/keypoint_sequence.h"
#include "marey/core/sink.h"
#include "marey/files/whole_file.h"

namespace marey::format::keypoints {

/// One person in one frame.
struct ExportedPerson {
  const Keypoints<2>* keypoints = nullptr;
  std::optional<Box> box;
  std::optional<int> id;
};

/// COCO annotations with images and a category that names all points: the third number of a point is its visibility × presence, 0
/// for one that is absent. The file is written atomically.
class CocoWriter {
 public:
  /// Throws Error if nothing can be written there.
  explicit CocoWriter(const std::string& path) : file_(path) {}

  void begin(const KeypointSet& set, std::optional<double> rate_hz, std::optional<cv::Size> size);
  /// Frames come in growing order; missing ones have no people.
  void add(std::int64_t frame, const std::vector<ExportedPerson>& people);
  void finish();

 private:
  WholeFile file_;
  std::optional<cv::Size> size_;
  std::int64_t frames_ = 0, annotations_ = 0;
};

/// The set that OpenPose writes, BODY_25, of a person in another set: points by their names, the neck midway between the shoulders
/// and the middle of the hips midway between them, if the set has none.
class OpenPoseBody {
 public:
  explicit OpenPoseBody(const KeypointSet& set);
  Keypoints<2> of(const Keypoints<2>& person) const;

 private:
  struct From {
    std::optional<int> point;        // itself, ...
    std::optional<int> left, right;  // ... or midway between these
  };
  std::vector<From> from_;
};

/// A folder of files NAME_000000000000_keypoints.json. Without `finish` nothing stays behind.
class OpenPoseFolder {
 public:
  /// Throws Error if the folder is there and not empty, or cannot be made.
  explicit OpenPoseFolder(const std::string& folder);
  ~OpenPoseFolder();
  OpenPoseFolder(const OpenPoseFolder&) = delete;
  OpenPoseFolder& operator=(const OpenPoseFolder&) = delete;

  /// Frames come in growing order; missing ones have no people. `people` are of BODY_25.
  void add(std::int64_t frame, const std::vector<ExportedPerson>& people);
  void finish() { finished_ = true; }

 private:
  std::string path_of(std::int64_t frame) const;

  std::string folder_, name_;
  bool made_ = false;  // it was not there before
  std::int64_t frames_ = 0;
  bool finished_ = false;
};

}  // namespace marey::format::keypoints
