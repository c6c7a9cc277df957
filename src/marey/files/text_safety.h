#pragma once

#include <string>
#include <string_view>

namespace marey {

/// A name that came from outside, as one line that every format, parser and terminal takes: well-formed UTF-8 without control
/// characters. Blanks of any kind become a space; what is not UTF-8, and what XML does not know, becomes U+FFFD, so that it is
/// seen that something was there.
std::string plain_text(std::string_view text);

/// The same as XML and HTML hold it, in elements and in attributes.
std::string xml_escaped(std::string_view text);

}  // namespace marey
