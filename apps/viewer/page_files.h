#pragma once

#include <optional>
#include <string_view>

#include "web_server.h"

namespace marey::viewer {

/// A file of the page, which is part of the program; nothing if no file has that path ("/", "/page.js", "/page.css").
std::optional<WebAnswer> page_file(std::string_view path);

}  // namespace marey::viewer
