#include "marey/format/take/take_cursor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/files/text_safety.h"
#include "marey/format/rig/rig_file.h"

namespace marey::format::take {

TakeValues::TakeValues(const Database& database) : database_(&database), value_(database, "SELECT value FROM take WHERE key = ?") {}

bool TakeValues::has(std::string_view key) {
  value_.reset();
  value_.bind(0, key);
  const bool found = value_.step();
  value_.reset();
  return found;
}
std::string TakeValues::text(std::string_view key) {
  value_.reset();
  value_.bind(0, key);
  std::string found(value_.step() ? value_.text(0) : std::string_view());
  value_.reset();
  return found;
}
double TakeValues::real(std::string_view key) {
  value_.reset();
  value_.bind(0, key);
  const double found = value_.step() ? value_.real(0) : 0;
  value_.reset();
  return found;
}
std::int64_t TakeValues::integer(std::string_view key) {
  value_.reset();
  value_.bind(0, key);
  const std::int64_t found = value_.step() ? value_.integer(0) : 0;
  value_.reset();
  return found;
}

void require_tables(const Database& database, const char* tables, int count) {
  Statement found(database, fmt::format("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ({})", tables));
  if (!found.step() || found.integer(0) != count)
    throw Error("{}: is damaged (a table is missing); restore it from a copy", database.path());
}

RecordingHeader common_header(const Database& database, TakeValues& values) {
  RecordingHeader header;
  header.name = plain_text(values.text("name"));
  header.recorded_at = plain_text(values.text("recorded_at"));
  header.rate_hz = values.real("rate_hz");
  const std::string rig = values.text("rig");
  if (!rig.empty()) header.rig = rig::parse_rig(rig, database.path() + " (its rig)");
  if (values.has("y_down")) set_y_down(header, values.integer("y_down") != 0);
  if (!(std::isfinite(header.rate_hz) && header.rate_hz > 0)) throw Error("{}: is damaged (its rate is missing)", database.path());
  return header;
}

TrackId checked_track(std::int64_t id, const Database& database) {
  if (id <= 0 || id > std::numeric_limits<int>::max()) throw Error("{}: is damaged (a track's id is {})", database.path(), id);
  return TrackId{static_cast<int>(id)};
}

void check_name(const TrackName& name, std::size_t known, const Limits& limits, const Database& database) {
  if (known >= limits.tracks) throw Error("{}: has more than {} tracks (the limit tracks)", database.path(), limits.tracks);
  const std::size_t longest = std::max(name.label.size(), name.team.size());
  if (longest <= limits.label_bytes) return;
  throw Error("{}: the label of track {} has {} bytes; they have at most {} (the limit label_bytes)", database.path(),
              number(name.id), longest, limits.label_bytes);
}

}  // namespace marey::format::take
