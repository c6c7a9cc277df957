#include "marey/draw/svg_text.h"

#include "marey/core/text_safety.h"

namespace marey::draw {

std::string escaped(const std::string& text) {
  return xml_escaped(text);
}

}  // namespace marey::draw
