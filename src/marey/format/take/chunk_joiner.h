#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "marey/core/time.h"
#include "marey/format/take/chunk_writer.h"
#include "marey/format/take/take_chunk.h"

namespace marey::format::take {

/// Chunks of a take up to here, in the file and in memory: few enough that a track lies in few places, small enough to be gathered
/// and encoded while the processor still has them at hand.
constexpr std::size_t kLargestChunk = std::size_t{4} << 20;
constexpr Duration kMaxChunk = std::chrono::seconds(60);

/// Keeps what short chunks hold, so that they can be replaced by one of about a minute without being read again. Memory is that of
/// the largest chunk, and of those that wait for `join`.
class ChunkJoiner {
 public:
  /// A chunk that was written under this id.
  void add(std::int64_t id, const Chunk& chunk);
  /// No chunk comes any more that would be joined with the last ones.
  void seal();
  /// Whether there is something to join.
  bool ready() const { return !sealed_.empty(); }
  /// Writes one chunk in the place of several, under the id `next`. To be called while `ready`, within a transaction.
  void join(ChunkWriter& chunks, std::int64_t next);
  /// The short chunks stay.
  void forget() { sealed_.clear(); }

 private:
  struct Group {
    std::vector<std::int64_t> ids;
    Chunk chunk;
  };

  Group group_;
  std::vector<Group> sealed_;
};

}  // namespace marey::format::take
