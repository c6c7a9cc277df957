#include "marey/format/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "marey/core/error.h"

namespace marey::format {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const {
    if (file != stdin) std::fclose(file);
  }
};

}  // namespace

std::string read_file(const std::string& path) {
  const std::unique_ptr<std::FILE, CloseFile> file(path == "-" ? stdin : std::fopen(path.c_str(), "rb"));
  if (!file) throw Error("{}: cannot be read ({})", path, std::generic_category().message(errno));
  std::string text;
  std::size_t filled = 0;
  for (;;) {
    text.resize(std::max<std::size_t>(filled + filled / 2, std::size_t{1} << 20));
    filled += std::fread(text.data() + filled, 1, text.size() - filled, file.get());
    if (filled < text.size()) break;
  }
  if (std::ferror(file.get()) != 0) throw Error("{}: cannot be read ({})", path, std::generic_category().message(errno));
  text.resize(filled);
  return text;
}

}  // namespace marey::format
