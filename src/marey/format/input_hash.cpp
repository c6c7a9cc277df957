#include "marey/format/input_hash.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

namespace marey::format {
namespace {

constexpr std::uint64_t kPart = std::uint64_t{1} << 20;

/// Fowler, Noll, Vo: FNV-1a (RFC 9923), 64 bits.
class Fnv1a {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  }
  std::uint64_t hash() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

}  // namespace

MadeBy::Input input_of(const std::string& path) {
  namespace fs = std::filesystem;
  MadeBy::Input input{.name = fs::path(path).filename().string(), .hash = {}};
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return input;
  const std::uint64_t size = fs::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  Fnv1a sum;
  for (int i = 0; i < 8; ++i) sum.add(std::string(1, static_cast<char>(size >> (8 * i) & 0xff)));
  std::string part(std::min(size, kPart), '\0');
  const auto add = [&](std::uint64_t begin) {
    in.seekg(static_cast<std::streamoff>(begin));
    if (!in.read(part.data(), static_cast<std::streamsize>(part.size()))) return false;
    sum.add(part);
    return true;
  };
  if (!add(0) || (size > kPart && !add(size - kPart))) return input;
  input.hash = fmt::format("{:016x}", sum.hash());
  return input;
}

}  // namespace marey::format
