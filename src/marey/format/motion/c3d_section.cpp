#include "marey/format/motion/c3d_section.h"

#include <algorithm>
#include <array>
#include <bit>

#include <fmt/format.h>

#include "marey/core/error.h"

namespace marey::format::motion {

void put_byte(std::string& bytes, std::size_t value) {
  bytes += static_cast<char>(static_cast<std::uint8_t>(value));
}

void put_word(std::string& bytes, std::int64_t value) {
  put_byte(bytes, static_cast<std::uint64_t>(value) & 0xff);
  put_byte(bytes, static_cast<std::uint64_t>(value) >> 8 & 0xff);
}

void put_real(std::string& bytes, double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  put_word(bytes, bits & 0xffff);
  put_word(bytes, bits >> 16);
}

void C3dSection::group(const std::string& name) {
  ++group_;
  put_byte(bytes_, name.size());
  put_byte(bytes_, static_cast<std::size_t>(-group_));
  bytes_ += name;
  put_word(bytes_, 3);
  put_byte(bytes_, 0);
}

void C3dSection::word(const std::string& name, std::int64_t value) {
  std::string data;
  put_word(data, value);
  parameter(name, 2, {}, data);
}

void C3dSection::words(const std::string& name, std::span<const std::int64_t> values) {
  std::string data;
  for (const std::int64_t value : values) put_word(data, value);
  parameter(name, 2, std::array{values.size()}, data);
}

void C3dSection::real(const std::string& name, double value) {
  std::string data;
  put_real(data, value);
  parameter(name, 4, {}, data);
}

void C3dSection::reals(const std::string& name, std::span<const double> values, const std::vector<std::size_t>& dimensions) {
  std::string data;
  for (const double value : values) put_real(data, value);
  parameter(name, 4, dimensions, data);
}

void C3dSection::text(const std::string& name, const std::string& text) {
  parameter(name, -1, std::array{text.size()}, text);
}

void C3dSection::texts(const std::string& name, std::span<const std::string> texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, std::min<std::size_t>(text.size(), 255));
  for (std::size_t begin = 0, part = 1; begin < texts.size() || part == 1; begin += kC3dMaxNames, ++part) {
    const auto here = texts.subspan(begin, std::min(kC3dMaxNames, texts.size() - begin));
    std::string data;
    for (const std::string& text : here) data += text.substr(0, width) + std::string(width - std::min(width, text.size()), ' ');
    parameter(part == 1 ? name : fmt::format("{}{}", name, part), -1, std::array{width, here.size()}, data);
  }
}

void C3dSection::copy(const C3dParameter& read) {
  std::string data;
  const std::size_t width = read.dimensions.empty() ? 1 : read.dimensions.front();
  for (const std::string& text : read.texts) data += text.substr(0, width) + std::string(width - std::min(width, text.size()), ' ');
  for (const double number : read.numbers) {
    if (read.type == 4) {
      put_real(data, number);
    } else if (read.type == 2) {
      put_word(data, static_cast<std::int64_t>(number));
    } else {
      put_byte(data, static_cast<std::size_t>(static_cast<std::int64_t>(number)));
    }
  }
  parameter(read.name, read.type, read.dimensions, data);
}

std::string C3dSection::blocks(const std::string& path) const {
  std::string section("\x01\x50", 2);
  const std::size_t count = (4 + bytes_.size() + 2 + kC3dBlock - 1) / kC3dBlock;
  if (count > 255) throw Error("{}: its names take {} blocks, and a C3D file has room for 255; use shorter or fewer", path, count);
  put_byte(section, count);
  put_byte(section, 84);
  section += bytes_;
  section.resize(count * kC3dBlock, '\0');
  return section;
}

void C3dSection::parameter(const std::string& name, int type, std::span<const std::size_t> dimensions, const std::string& data) {
  put_byte(bytes_, name.size());
  put_byte(bytes_, static_cast<std::size_t>(group_));
  bytes_ += name;
  put_word(bytes_, static_cast<std::int64_t>(2 + 2 + dimensions.size() + data.size() + 1));
  put_byte(bytes_, static_cast<std::size_t>(type));
  put_byte(bytes_, dimensions.size());
  for (const std::size_t dimension : dimensions) put_byte(bytes_, dimension);
  bytes_ += data;
  put_byte(bytes_, 0);
}

}  // namespace marey::format::motion
