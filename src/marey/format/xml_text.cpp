#include "marey/format/xml_text.h"

#include <algorithm>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/nesting.h"

namespace marey::format {
namespace {

struct StringWriter : pugi::xml_writer {
  std::string text;
  void write(const void* data, std::size_t size) override { text.append(static_cast<const char*>(data), size); }
};

/// XML knows no control characters, however they are written.
struct PlainTexts : pugi::xml_tree_walker {
  bool for_each(pugi::xml_node& node) override {
    if (node.type() == pugi::node_pcdata) node.set_value(plain_text(node.value()).c_str());
    for (pugi::xml_attribute attribute : node.attributes()) attribute.set_value(plain_text(attribute.value()).c_str());
    return true;
  }
};

}  // namespace

pugi::xml_document parse_xml(std::string_view text, const std::string& name) {
  check_nesting(text, Notation::xml, name);
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (result) return document;
  const auto read = text.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, result.offset)));
  const auto line = std::count(read.begin(), read.end(), '\n') + 1;
  throw Error("{}:{}: is not XML from here on ({}); the file may be cut off", name, line, result.description());
}

std::string to_text(const pugi::xml_document& document) {
  StringWriter writer;
  pugi::xml_document plain;
  plain.reset(document);
  PlainTexts texts;
  plain.traverse(texts);
  plain.save(writer, "  ", pugi::format_default, pugi::encoding_utf8);
  return std::move(writer.text);
}

void add_text(pugi::xml_node& parent, const char* element, const std::string& text) {
  parent.append_child(element).text().set(text.c_str());
}

}  // namespace marey::format
