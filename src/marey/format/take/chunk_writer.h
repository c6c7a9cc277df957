#pragma once

#include <cstdint>
#include <vector>

#include "marey/format/take/column_codec.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_chunk.h"

namespace marey::format::take {

/// Writes chunks into a take's tables, and takes them out again.
class ChunkWriter {
 public:
  explicit ChunkWriter(const Database& database);

  /// `id` is above those of all that are there.
  void write(std::int64_t id, const Chunk& chunk);
  /// From here on its instants may come in another chunk; then its rows are to be removed too.
  void remove_instants(std::int64_t id);
  void remove_rows(std::int64_t id);

 private:
  void write_instants(std::int64_t id, const Chunk& chunk);
  void write_samples(std::int64_t id, const TrackColumns& track);
  void write_observed(std::int64_t id, const ObservedColumns& detected);
  void write_poses(std::int64_t id, const BodyColumns& body);

  Statement add_instants_, add_samples_, add_observed_, add_poses_, remove_instants_, remove_samples_, remove_observed_,
      remove_poses_;
  std::vector<Bytes> blobs_;
  std::vector<std::uint64_t> integers_;
};

}  // namespace marey::format::take
