#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "marey/format/take/column_codec.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_chunk.h"

namespace marey::format::take {

/// Reads chunks from a take's tables.
class ChunkReader {
 public:
  struct Row {
    std::int64_t id = 0, first_index = 0, last_index = 0, instants = 0;
  };

  ChunkReader(const Database& database, int dimensions);

  /// All chunks by growing index, without what is in them.
  std::vector<Row> rows();
  /// The first chunk that ends at this index or later.
  std::optional<Row> find(std::int64_t index);
  /// These append to the existing data; `at` continues counting from the instants that are there.
  void read(const Row& row, bool with_seen, Chunk& chunk);
  void read_time_steps(const Row& row, std::vector<Recording::TimeStep>& time_steps);
  /// False where the track has nothing there. `offset` is that of the chunk's first instant.
  bool read_track(const Row& row, std::int64_t offset, TrackColumns& track);

 private:
  Row checked_row(const Statement& statement) const;
  void decode_samples(const Statement& row, const Row& chunk, std::int64_t offset, TrackColumns& track);
  void decode_observed(const Statement& row, const Row& chunk, std::int64_t offset, ObservedColumns& detected);
  void read_poses(const Row& chunk, std::int64_t offset, std::map<BodyId, BodyColumns>& bodies);
  void decode_poses(const Row& chunk, std::int64_t offset, BodyColumns& body);
  std::size_t checked_count(std::int64_t rows) const;
  void decode_positions(const Statement& row, int column, const Row& chunk, std::int64_t offset, ColumnDecoder& decoder);

  const Database* database_;
  int dimensions_;
  Statement find_, time_steps_, samples_, detected_, one_track_;
  std::optional<Statement> poses_;  // nothing in takes from before bodies were solved
  std::vector<std::int32_t> at_;
  std::vector<double> x_, y_, z_;
  std::vector<Provenance> provenance_;
  std::vector<std::uint64_t> integers_;
};

}  // namespace marey::format::take
