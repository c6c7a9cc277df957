#pragma once

#include <string>

namespace marey {

/// Text as XML holds it.
std::string escaped(const std::string& text);

}  // namespace marey
