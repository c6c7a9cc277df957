#pragma once

#include <array>

namespace marey::format::match {

/// What EPTS calls the periods of a match, from the first; before "_start" and "_end".
constexpr std::array<const char*, 4> kEptsPeriodNames = {"first_half", "second_half", "first_extra_half", "second_extra_half"};

}  // namespace marey::format::match
