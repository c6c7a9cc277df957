#include "marey/source/live/phone_page.h"

asm(".pushsection .rodata\n.globl marey_phone_page_begin\nmarey_phone_page_begin:\n.incbin \"" MAREY_PHONE_PAGE
    "\"\n.globl marey_phone_page_end\nmarey_phone_page_end:\n.byte 0\n.popsection\n");
extern "C" const char marey_phone_page_begin[];
extern "C" const char marey_phone_page_end[];

namespace marey::source::live {

std::string_view phone_page() {
  return {marey_phone_page_begin, static_cast<std::size_t>(marey_phone_page_end - marey_phone_page_begin)};
}

}  // namespace marey::source::live
