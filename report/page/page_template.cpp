#include "report/page/page_template.h"

// A megabyte as an array in C++ would take the compiler half a minute.
__asm__(
    ".section .rodata\n"
    ".global meniscus_page_begin\n"
    ".global meniscus_page_end\n"
    "meniscus_page_begin:\n"
    ".incbin \"" MENISCUS_PAGE_FILE
    "\"\n"
    "meniscus_page_end:\n"
    ".byte 0\n"
    ".previous\n");

extern "C" {
extern const char meniscus_page_begin[];
extern const char meniscus_page_end[];
}

namespace meniscus::page {

std::string_view page_template() {
  return {meniscus_page_begin, meniscus_page_end};
}

}  // namespace meniscus::page
