#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/labelled_box.h"

namespace marey::format::tracks {

/// MOTChallenge text: one box a line, `frame,id,left,top,width,height[,score,...]`. In the file frames and pixels count from 1,
/// here from 0.
///
/// Read are six columns or more (what follows the seventh is skipped), commas or blanks between them, either line ending, a
/// byte order mark, blank lines, and lines in any order of frames. Rules for what is doubtful:
///   - numbers must be finite and below 1e9, frames 1 to 1e9, frames and ids whole (`3.0` is);
///   - in truth and tracks ids are 0 or more, an id stands once a frame, and width and height are positive: else Error;
///   - in detections ids are skipped, and a box without width or height is omitted with a warning.
/// In truth the seventh column, read as the score, is 0 where MOTChallenge does not evaluate a box.
enum class MotKind { truth, tracks, detections };

struct MotTable {
  std::vector<LabelledBox> boxes;     ///< by frame; within a frame in the file's order
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Reads a file, or standard input for `-`. Throws Error, `path:line: what is wrong; the expected value`.
MotTable read_mot(const std::string& path, MotKind kind);

/// The same of text already in memory; `name` stands for the path in messages.
MotTable parse_mot(std::string_view text, const std::string& name, MotKind kind);

/// Detections a piece of the file at a time, so that memory does not grow with its length. Boxes come in the order of the lines.
class MotReader {
 public:
  /// Throws Error if the file cannot be read.
  explicit MotReader(const std::string& path);
  ~MotReader();
  MotReader(MotReader&&) noexcept;
  MotReader& operator=(MotReader&&) noexcept;

  /// The boxes of the next piece, none perhaps; nothing at the end. Valid until the next call. Throws Error as `read_mot`.
  std::optional<std::span<const LabelledBox>> next();

  /// What `read_mot` would have warned of, once all is read.
  std::vector<std::string> warnings() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Adds the box's line to `text`: ten columns, the shortest digits that read back the same.
void append_mot(std::string& text, const LabelledBox& box);

}  // namespace marey::format::tracks
