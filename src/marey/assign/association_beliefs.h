// How probable each pair of a row and a column is, over all assignments together, for graphs that are large and hang
// together: messages between rows and columns until they agree. Where the graph has loops the probabilities are approximate, and
// sharper than the exact ones of association_marginals.h, which is for many small clusters. Cost: the pairs, times the rounds.
// Reference: Williams & Lau, "Approximate evaluation of marginal association probabilities with belief propagation", IEEE Trans.
// AES 50 (2014).
#pragma once

#include <span>
#include <vector>

#include "marey/assign/gated_assignment.h"

namespace marey::assign {

/// For each pair its probability, in the order of the pairs. A pair's gain is the logarithm of its weight against that of its row
/// and its column having none, of any sign; each pair occurs once.
std::vector<double> association_beliefs(int rows, int columns, std::span<const GatedPair> pairs);

}  // namespace marey::assign
