#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/outline.h"
#include "marey/core/track.h"

namespace marey::track::offline {

/// The outlines of a recording, frame by frame, kept for a second pass: on disk, in a file without a name that is gone with the
/// program, because an outline takes ten times the room of all else that is known of a target in a frame. Lengths are kept as
/// single-precision numbers.
class OutlineLog {
 public:
  /// The outlines of a frame by the ids of their tracks.
  using Frame = std::map<std::int32_t, std::shared_ptr<const Outline>>;

  /// Keeps its file in the folder of `beside`, or where that takes none (a device) in the one for temporary files. Measurement
  /// lines, which double its size, are kept on demand. Throws Error if no file can be made.
  OutlineLog(const std::string& spill_path, bool with_lines);
  ~OutlineLog();
  OutlineLog(const OutlineLog&) = delete;
  OutlineLog& operator=(const OutlineLog&) = delete;

  /// The tracks of one frame; frames grow from call to call. All are added before the first is read. Throws Error if the disk
  /// is full.
  void add(std::int64_t frame, std::span<const Track<2>> tracks);

  /// The outlines of `frame`, which grows from call to call, or begins again at a lower one; valid until the next call.
  const Frame& at(std::int64_t frame);

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void append(const void* data, std::size_t size);
  void take(void* data, std::size_t size);
  void read_frame();

  std::string spill_path_;
  bool with_lines_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::vector<float> numbers_;  // of one outline
  bool reading_ = false;
  std::optional<std::int64_t> last_requested_;
  std::optional<std::int64_t> read_;  // the frame in `frame_`; past the last frame, the greatest number
  Frame frame_;
};

}  // namespace marey::track::offline
