#include "marey/format/read_file.h"

#include <algorithm>

#include "marey/files/input_file.h"

namespace marey::format {

std::string read_file(const std::string& path) {
  InputFile file(path);
  std::string text;
  std::size_t filled = 0;
  for (;;) {
    if (filled == text.size()) text.resize(std::max<std::size_t>(filled + filled / 2, std::size_t{1} << 20));
    const std::size_t got = file.read(std::span(text).subspan(filled));
    if (got == 0) break;
    filled += got;
  }
  text.resize(filled);
  return text;
}

}  // namespace marey::format
