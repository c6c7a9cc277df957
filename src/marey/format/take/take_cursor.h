#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/recording_reader.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_file.h"

namespace marey::format::take {

/// A take, open to be read: the implementation of `TakeReader`.
class TakeCursor {
 public:
  virtual ~TakeCursor() = default;
  virtual const RecordingHeader& header() const = 0;
  virtual RecordingSummary summary() = 0;
  virtual std::vector<Edit> edits() = 0;
  virtual std::optional<std::int64_t> head() = 0;
  virtual std::optional<Instant> next() = 0;
  virtual void seek(std::int64_t index) = 0;
  virtual std::vector<Recording::TimeStep> time_steps() = 0;
  virtual TrackColumns read_track(const TrackName& name) = 0;
};

/// Throws Error if the file lacks what its schema demands. The database is a take's.
std::unique_ptr<TakeCursor> open_schema_2(std::unique_ptr<Database> database, TakeReaderOptions options);

/// Values by key, of table `take`.
class TakeValues {
 public:
  explicit TakeValues(const Database& database);

  /// Empty and 0 where the key is not there.
  std::string text(std::string_view key);
  double real(std::string_view key);
  std::int64_t integer(std::string_view key);
  bool has(std::string_view key);

 private:
  const Database* database_;
  Statement value_;
};

/// Throws Error if one of `tables` (in quotes, commas between them) is missing.
void require_tables(const Database& database, const char* tables, int count);
/// A name, a rate, a rig.
RecordingHeader common_header(const Database& database, TakeValues& values);
/// Throws Error if the take has `known` tracks already that are as many as there may be, or where a name is too long.
void check_name(const TrackName& name, std::size_t known, const Limits& limits, const Database& database);
/// A track's id as the file has it.
TrackId checked_track(std::int64_t id, const Database& database);

}  // namespace marey::format::take
