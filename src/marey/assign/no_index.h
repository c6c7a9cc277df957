#pragma once

namespace marey::assign {

/// In columns of indices, which are too hot for std::optional: no row, column or record at all.
inline constexpr int kNoIndex = -1;

}  // namespace marey::assign
