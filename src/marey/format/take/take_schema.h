#pragma once

#include <cstdint>

#include "marey/core/ids.h"

namespace marey::format::take {

// How a take lies in its file (docs/take.md). A change here is a new schema version.

constexpr int kTakeSchemaVersion = 2;
constexpr int kTakeApplicationId = 0x4D524559;  // "MREY"

/// Before anything is in the file.
constexpr const char* kTakePragmas = R"(
  PRAGMA page_size = 8192;
  PRAGMA auto_vacuum = INCREMENTAL;
  PRAGMA journal_mode = DELETE;
  PRAGMA synchronous = NORMAL;
  PRAGMA cache_size = -24000;
)";

constexpr const char* kTakeSchema = R"(
  PRAGMA application_id = 0x4D524559;
  PRAGMA user_version = 2;
  CREATE TABLE take (key TEXT PRIMARY KEY, value) WITHOUT ROWID;
  CREATE TABLE option (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
  CREATE TABLE input (id INTEGER PRIMARY KEY, name TEXT NOT NULL, hash TEXT NOT NULL);
  CREATE TABLE track (id INTEGER PRIMARY KEY, label TEXT NOT NULL, team TEXT NOT NULL, first_index INTEGER, last_index INTEGER,
                      measured INTEGER NOT NULL, filled INTEGER NOT NULL, predicted INTEGER NOT NULL, solved INTEGER NOT NULL,
                      kind TEXT NOT NULL DEFAULT '');
  CREATE TABLE chunk (id INTEGER PRIMARY KEY, first_index INTEGER NOT NULL, last_index INTEGER NOT NULL UNIQUE,
                      instants INTEGER NOT NULL, indices BLOB, times BLOB NOT NULL);
  CREATE TABLE samples (id INTEGER PRIMARY KEY, rows INTEGER NOT NULL, at NOT NULL, x BLOB NOT NULL, y BLOB NOT NULL, z BLOB,
                        provenance NOT NULL, cameras NOT NULL, velocity BLOB, covariance BLOB, score BLOB, box BLOB,
                        residual_px BLOB, residual_m BLOB, outline BLOB, keypoints BLOB);
  CREATE TABLE seen (id INTEGER PRIMARY KEY, rows INTEGER NOT NULL, at BLOB NOT NULL, x BLOB NOT NULL, y BLOB NOT NULL,
                     sigma BLOB, area BLOB, track NOT NULL);
  CREATE TABLE body (id INTEGER PRIMARY KEY, label TEXT NOT NULL, definition TEXT NOT NULL);
  CREATE TABLE poses (id INTEGER PRIMARY KEY, rows INTEGER NOT NULL, at NOT NULL, pose BLOB NOT NULL, residual BLOB,
                      covariance BLOB, tracked NOT NULL, other BLOB);
  CREATE TABLE edit (id INTEGER PRIMARY KEY, parent INTEGER, operation TEXT NOT NULL, payload TEXT NOT NULL);
)";
constexpr int kTakeTables = 10;

/// The id of a row of `samples`, `seen` and `poses`: whose it is (a track, a camera, a body), within which chunk.
constexpr std::int64_t row_id(std::int64_t chunk, int owner) {
  return chunk << 32 | static_cast<std::int64_t>(owner);
}
constexpr std::int64_t kMaxChunks = (std::int64_t{1} << 31) - 1;

}  // namespace marey::format::take
