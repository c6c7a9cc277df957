#pragma once

#include <span>
#include <string>
#include <string_view>

namespace marey::cli {

/// How many letters have to be put in, omitted, exchanged or swapped with their neighbour to make `b` of `a`.
int letters_apart(std::string_view a, std::string_view b);

/// " Did you mean X?" where a word of `known` is near; else empty.
std::string suggestion(std::string_view word, std::span<const std::string> known);

}  // namespace marey::cli
