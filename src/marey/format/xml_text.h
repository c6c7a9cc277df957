#pragma once

#include <string>
#include <string_view>

#include <pugixml.hpp>

namespace marey::format {

/// A text as XML. Throws Error, with the file's name and what is wrong where, for what is not one.
pugi::xml_document parse_xml(std::string_view text, const std::string& name);

/// A document as text, indented, its texts made plain (files/text_safety.h).
std::string to_text(const pugi::xml_document& document);

/// Adds an element that holds a text.
void add_text(pugi::xml_node& parent, const char* element, const std::string& text);

}  // namespace marey::format
