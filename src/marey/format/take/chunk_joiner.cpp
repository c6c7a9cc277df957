#include "marey/format/take/chunk_joiner.h"

#include <utility>

namespace marey::format::take {
namespace {

constexpr std::size_t kMaxWaiting = 4;  // groups that a reader who holds on to the file keeps from being joined

}  // namespace

void ChunkJoiner::add(std::int64_t id, const Chunk& chunk) {
  Chunk& whole = group_.chunk;
  const auto length = [](const Recording::TimeStep& first, const Recording::TimeStep& last) { return last.time - first.time; };
  const bool fits = whole.empty() || (whole.bytes + chunk.bytes <= kLargestChunk &&
                                      length(whole.time_steps.front(), chunk.time_steps.back()) <= kMaxChunk);
  if (!fits) seal();
  // One that is long by itself is left as it is.
  const bool long_enough =
      2 * chunk.bytes > kLargestChunk || 2 * length(chunk.time_steps.front(), chunk.time_steps.back()) > kMaxChunk;
  if (group_.ids.empty() && long_enough) return;
  group_.ids.push_back(id);
  whole.append(chunk);
}

void ChunkJoiner::seal() {
  if (group_.ids.size() > 1) sealed_.push_back(std::exchange(group_, {}));
  if (sealed_.size() > kMaxWaiting) sealed_.erase(sealed_.begin());
  group_.ids.clear();
  group_.chunk.clear();
}

/// The new rows come before the old ones go, so that they take the pages that the group before has left.
void ChunkJoiner::join(ChunkWriter& chunks, std::int64_t next) {
  const Group group = std::move(sealed_.front());
  sealed_.erase(sealed_.begin());
  for (const std::int64_t id : group.ids) chunks.remove_instants(id);
  chunks.write(next, group.chunk);
  for (const std::int64_t id : group.ids) chunks.remove_rows(id);
}

}  // namespace marey::format::take
