#pragma once

#include <string>
#include <string_view>

#include "marey/core/body.h"

namespace marey::format::take {

/// What table `body` holds of a body beside its id and label, as JSON: {"skeleton", "parent", "offset", "end", "markers":
/// [{"label", "position"}]}; what is empty or not known is omitted. Lengths in m.
std::string body_definition(const Body& body);

/// Puts what a definition says into `body`. Throws Error, "where: is damaged (…)", for what is not one.
void read_body_definition(std::string_view text, const std::string& where, Body& body);

}  // namespace marey::format::take
