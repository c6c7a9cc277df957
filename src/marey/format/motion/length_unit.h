#pragma once

#include <optional>
#include <string_view>

namespace marey::format::motion {

/// Metres in a unit of length, by its name or sign in any case: mm, cm, m, in, ft, Meters, …; nothing for what is not one.
std::optional<double> metres_of_unit(std::string_view name);

}  // namespace marey::format::motion
