// What a text recogniser says of a shirt, as probabilities of the strings that a number can be: nothing, one digit, two.
#pragma once

#include <array>
#include <span>
#include <string>

namespace marey::detect::shirts {

inline constexpr int kDigits = 10;                                // by definition
inline constexpr int kStrings = 1 + kDigits + kDigits * kDigits;  // by definition: "", "0" … "9", "00" … "99"
inline constexpr int kColumnClasses = 1 + kDigits;                // by definition: blank, then the digits

using StringProbabilities = std::array<double, kStrings>;

/// Index of "" (no digit), "7" (`tens` < 0) or "17".
constexpr int string_index(int tens, int units) {
  return tens < 0 ? 1 + units : 1 + kDigits + kDigits * tens + units;
}
std::string string_at(int index);

/// Each string's likelihood, summed over all alignments (CTC: a digit may take several columns, "blank" lies between equal ones).
/// `columns`: for each column of the image the probabilities of blank and of each digit, which need not sum to 1: the rest
/// is other characters', so that the sum over all strings is the probability that there is nothing else.
StringProbabilities string_likelihoods(std::span<const std::array<double, kColumnClasses>> columns);

}  // namespace marey::detect::shirts
