#pragma once

#include <random>
#include <span>
#include <string>

namespace marey::faults {

/// A text or any bytes with 1 to 4 faults: bytes flipped, runs omitted or doubled, lines dropped, doubled or exchanged, fields
/// exchanged, numbers made wild, words and brackets that nest, a part of another file. `others` are valid files of the same kind.
/// The same for the same state of `random`.
std::string mutated(const std::string& file, std::span<const std::string> others, std::mt19937_64& random);

}  // namespace marey::faults
