#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "marey/core/frame_numbers.h"
#include "marey/core/keypoint_sequence.h"

namespace marey::format::keypoints {

/// A point as files have it: absent where its confidence is 0.
struct FilePoint {
  double x = 0, y = 0, confidence = 0;
  std::optional<double> sigma = {};  ///< px, of each coordinate, where the file says it
};

/// Gathers people as a file brings them, in any order of frames, and finds the keypoint set.
class SequenceBuilder {
 public:
  explicit SequenceBuilder(std::string path) { sequence_.from = std::move(path); }

  KeypointSequence& sequence() { return sequence_; }
  /// A frame that is there, with or without people. Throws Error for a negative number.
  void add_frame(std::int64_t frame, std::optional<double> time_s = {});
  /// A person. `score` is in [0, 1]; `where` names the place for messages. Throws Error if points are as many as another person
  /// does not have, or are not places in an image.
  void add(std::int64_t frame, const std::vector<FilePoint>& points, double score, const std::string& where);
  /// The set, where the file names the points.
  void name_points(const std::vector<std::string>& names);
  /// `set` as `read_keypoints` takes it.
  KeypointSequence finish(std::string_view set);

 private:
  void choose_set(std::string_view set);
  double mean_bone(const KeypointSet& set) const;

  KeypointSequence sequence_;
  FrameNumbers numbers_;
  std::size_t points_ = 0;  // of a person; 0 before the first
  struct Person {
    std::int64_t frame;
    Keypoints<2> keypoints;
  };
  std::vector<Person> people_;
  std::int64_t last_frame_ = -1;
};

/// The number of a frame in its file's name: its longest run of digits, of several the last; −1 if it has no digits.
std::int64_t frame_number_in(std::string_view name);

KeypointSequence read_openpose_folder(const std::string& path, std::string_view set);
KeypointSequence read_keypoint_json(std::string_view text, const std::string& path, std::string_view set);
KeypointSequence read_keypoint_lines(std::string_view text, const std::string& path, std::string_view set);
KeypointSequence read_keypoint_rows(std::string_view text, const std::string& path, std::string_view set);
KeypointSequence read_keypoint_csv(std::string_view text, const std::string& path, std::string_view set);

}  // namespace marey::format::keypoints
