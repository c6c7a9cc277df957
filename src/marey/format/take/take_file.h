#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/limits.h"
#include "marey/core/take.h"

namespace marey::format::take {

/// Writes a take while it is recorded, into one SQLite file under its own name (docs/take.md has the schema). What was written
/// reaches the file within half a second of the next `write`, so that a killed program loses less than a second; memory does not
/// grow with the take. Others may read the file meanwhile.
class TakeWriter {
 public:
  /// Begins a new take. One that bears the name already is replaced. Throws Error where the place cannot be written, where the name
  /// is another kind of file's, where another TakeWriter has it open, and where the header is not valid.
  TakeWriter(const std::string& path, const TakeHeader& header);
  /// Keeps what was written. Without `finish` before, the take is marked as cut off.
  ~TakeWriter();
  TakeWriter(const TakeWriter&) = delete;
  TakeWriter& operator=(const TakeWriter&) = delete;

  /// A track's label, new or another than before. A track without label need not be told.
  void set_label(TrackId track, std::string_view label);
  /// Frames come in growing order of their indices; some may be left out. Each track has at most one point. Throws Error where the
  /// disk is full; all frames but those of the last second are then in the file, and this writer takes no more.
  void write(const TakeFrame& frame);
  void add_edit(const TakeEdit& edit);
  /// Brings everything into the file now.
  void flush();
  /// The take is whole: brings everything into the file and closes it.
  void finish();

 private:
  class Recorder;
  std::unique_ptr<Recorder> recorder_;
};

struct TakeReaderOptions {
  bool observations = true;  ///< false: frames come without them, and several times sooner
  Limits limits = {};        ///< `label_bytes` and `tracks` count
};

/// Reads a take frame by frame, also while it is being written, and after its writer was killed.
class TakeReader {
 public:
  /// Throws Error where `path` is no take, a damaged one, or one by a later version of Marey.
  explicit TakeReader(const std::string& path, TakeReaderOptions options = {});
  ~TakeReader();
  TakeReader(TakeReader&&) noexcept;
  TakeReader& operator=(TakeReader&&) noexcept;

  const TakeHeader& header() const;
  /// As the file has them now, for it may still grow.
  TakeSummary summary() const;
  std::vector<TakeTrack> tracks() const;
  std::vector<TakeEdit> edits() const;

  /// The next frame; nothing behind the last one. Where the take is still being written, a later call may give more.
  std::optional<TakeFrame> next();
  /// `next` gives the first frame with this index or a later one.
  void seek(std::int64_t index);

 private:
  class Cursor;
  std::unique_ptr<Cursor> cursor_;
};

/// True where the file begins as a take does. False where it cannot be read.
bool is_take(const std::string& path);

/// A whole take, in memory.
Take read_take(const std::string& path);
void write_take(const std::string& path, const Take& take);

}  // namespace marey::format::take
