#include "marey/assign/successors.h"

#include "marey/assign/sparse_assignment.h"

namespace marey::assign {

std::vector<int> best_successors(int pieces, std::span<const GatedPair> pairs) {
  return sparse_assignment(pieces, pieces, pairs);
}

std::vector<std::vector<int>> chains_of(std::span<const int> next) {
  std::vector<char> tracks(next.size(), 0);
  for (const int successor : next) {
    if (successor != kNoIndex) tracks[successor] = 1;
  }
  std::vector<std::vector<int>> chains;
  for (int first = 0; first < static_cast<int>(next.size()); ++first) {
    if (tracks[first]) continue;
    std::vector<int>& chain = chains.emplace_back();
    for (int piece = first; piece != kNoIndex; piece = next[piece]) chain.push_back(piece);
  }
  return chains;
}

}  // namespace marey::assign
