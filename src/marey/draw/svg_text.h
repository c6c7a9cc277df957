#pragma once

#include <string>

namespace marey::draw {

/// Text as XML holds it.
std::string escaped(const std::string& text);

}  // namespace marey::draw
