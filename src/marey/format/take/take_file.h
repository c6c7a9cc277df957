#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/recording.h"
#include "marey/core/recording_reader.h"
#include "marey/core/sink.h"
#include "marey/files/file_lock.h"
#include "marey/files/limits.h"

namespace marey::format::take {

/// Writes a take while it is recorded, into one SQLite file under its own name (docs/take.md has the schema). Written data
/// reaches the file within half a second of the next `write`, so that a killed program loses less than a second; memory does not
/// grow with the take. Others may read the file in the meantime. Positions and boxes come back as they were written, the rest with
/// the precision of a float32; an outline's measurement lines are not kept.
class TakeWriter : public Sink {
 public:
  explicit TakeWriter(std::string path);
  /// Keeps the output. Without `finish` before, the take is marked as cut off; where nothing was written at all none is made,
  /// and one that has the name already stays.
  ~TakeWriter() override;

  std::string name() const override { return path_; }
  /// Begins a new take, which is in its place from the first thing that is written on, or `flush`; one that has the name already
  /// is replaced then. Throws Error if the place cannot be written, where the name is another kind of file's, where another
  /// TakeWriter has it open, and where the header is not valid.
  SinkRequirements begin(const RecordingHeader& header) override;
  /// Instants come in growing order of their indices; some may be omitted. Each track has at most one sample. Throws Error if
  /// the disk is full; all instants but those of the last second are then in the file, and this writer takes no more.
  void write(const Instant& instant) override;
  /// The take is whole: brings everything into the file, joins the short chunks it was recorded in, and closes it.
  void finish() override;

  /// A track's label and team, beside those that instants name; it need not have samples.
  void set_name(const TrackName& name);
  void add_edit(const Edit& edit);
  void set_head(std::optional<std::int64_t> head);
  /// Brings everything into the file now.
  void flush();

 private:
  class Recorder;
  Recorder& recorder();

  std::string path_;
  RecordingHeader header_;          // of what was begun
  std::unique_ptr<FileLock> lock_;  // from `begin` to `finish`
  std::unique_ptr<Recorder> recorder_;
};

struct TakeReaderOptions {
  bool detected = true;                ///< false: instants come without what the cameras saw, and several times sooner
  Limits limits = Limits::in_force();  ///< `label_bytes` and `tracks` count
};

class TakeCursor;

/// Reads a take instant by instant, or track by track, also while it is being written, and after its writer was killed.
class TakeReader : public RecordingReader {
 public:
  /// Throws Error if `path` is not a take, a damaged one, or one by a later version of Marey.
  explicit TakeReader(const std::string& path, TakeReaderOptions options = {});
  ~TakeReader() override;
  TakeReader(TakeReader&&) noexcept;
  TakeReader& operator=(TakeReader&&) noexcept;

  const RecordingHeader& header() const override;
  /// These as the file has them now, for it may still grow.
  RecordingSummary summary() const;
  std::vector<TrackName> tracks() const override;
  std::vector<Edit> edits() const override;
  std::optional<std::int64_t> head() const override;
  std::optional<std::int64_t> instant_count() const override;
  std::vector<std::string> warnings() const override;

  /// The next instant; nothing behind the last one. Where the take is still being written, a later call may give more. What was
  /// seen comes by camera.
  std::optional<Instant> next() override;
  /// `next` gives the first instant with this index or a later one.
  void seek(std::int64_t index);

  /// When there were instants: what `TrackColumns::at` counts.
  std::vector<Recording::TimeStep> time_steps() const;
  /// One track over the whole take, read without the others. Without rows if that id does not exist.
  TrackColumns read_track(TrackId track) const;

 private:
  std::string path_;
  std::unique_ptr<TakeCursor> cursor_;
};

/// True where the file begins as a take does. False where it cannot be read.
bool is_take(const std::string& path);

/// A whole take, in memory.
Recording read_recording(const std::string& path);
void write_recording(const std::string& path, const Recording& recording);

}  // namespace marey::format::take
