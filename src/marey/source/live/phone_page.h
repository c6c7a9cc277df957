// The page that makes a phone a camera (phone_page.html), taken into the library by the assembler.
#pragma once

#include <string_view>

namespace marey::source::live {

std::string_view phone_page();

}  // namespace marey::source::live
