#include "marey/track/offline/tracklet_chains.h"

#include "marey/assign/no_index.h"

namespace marey::track::offline {

std::vector<std::vector<int>> chains_of(std::span<const int> next) {
  std::vector<char> tracks(next.size(), 0);
  for (const int successor : next) {
    if (successor != assign::kNoIndex) tracks[successor] = 1;
  }
  std::vector<std::vector<int>> chains;
  for (int first = 0; first < static_cast<int>(next.size()); ++first) {
    if (tracks[first]) continue;
    std::vector<int>& chain = chains.emplace_back();
    for (int piece = first; piece != assign::kNoIndex; piece = next[piece]) chain.push_back(piece);
  }
  return chains;
}

}  // namespace marey::track::offline
