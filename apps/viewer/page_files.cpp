// The built page, taken into the program by the assembler: a list of half a million numbers would cost the compiler seconds.
#include "page_files.h"

#include <string>

#define MAREY_PAGE_FILE(name, file)                                                                                          \
  extern "C" const char marey_page_##name##_begin[];                                                                         \
  extern "C" const char marey_page_##name##_end[];                                                                           \
  asm(".pushsection .rodata\n.globl marey_page_" #name "_begin\nmarey_page_" #name "_begin:\n.incbin \"" MAREY_PAGE "/" file \
      "\"\n.globl marey_page_" #name "_end\nmarey_page_" #name "_end:\n.byte 0\n.popsection\n")

MAREY_PAGE_FILE(html, "index.html");
MAREY_PAGE_FILE(script, "page.js");
MAREY_PAGE_FILE(style, "page.css");

namespace marey::viewer {
namespace {

WebAnswer answer_with(const char* begin, const char* end, const char* type) {
  return {.status = 200, .type = type, .body = bytes_of({begin, end})};
}

}  // namespace

std::optional<WebAnswer> page_file(std::string_view path) {
  if (path == "/" || path == "/index.html")
    return answer_with(marey_page_html_begin, marey_page_html_end, "text/html; charset=utf-8");
  if (path == "/page.js") return answer_with(marey_page_script_begin, marey_page_script_end, "text/javascript; charset=utf-8");
  if (path == "/page.css") return answer_with(marey_page_style_begin, marey_page_style_end, "text/css; charset=utf-8");
  return std::nullopt;
}

}  // namespace marey::viewer
