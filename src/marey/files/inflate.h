#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace marey {

/// What a zlib stream (RFC 1950) holds. Throws Error, with `name` for the file, if it is damaged, or holds more than `max_bytes`.
std::string inflated(std::string_view stream, std::size_t max_bytes, const std::string& name);

}  // namespace marey
