// Secrets that let a client in.
#pragma once

#include <string>
#include <string_view>

namespace marey::net {

/// 48 hexadecimal digits that cannot be guessed. Throws Error if the system has none.
std::string new_token();

/// Compared in a time that does not depend on how much of it is right.
bool same_secret(std::string_view a, std::string_view b);

/// What a target of HTTP is made of. Nothing is decoded: our own paths and values need no escapes.
std::string_view path_of(std::string_view target);
/// The value of `name` in the query; empty if it is not there.
std::string_view query_value(std::string_view target, std::string_view name);

}  // namespace marey::net
