// Protocol buffers as they lie in memory, as far as writing them goes: tag, value, tag, value.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace marey::format::mcap {

class ProtobufWriter {
 public:
  ProtobufWriter& varint(int field, std::uint64_t value) {
    tag(field, 0);
    number(value);
    return *this;
  }
  ProtobufWriter& real(int field, double value) {
    tag(field, 1);
    fixed(std::bit_cast<std::uint64_t>(value), 8);
    return *this;
  }
  ProtobufWriter& fixed32(int field, std::uint32_t value) {
    tag(field, 5);
    fixed(value, 4);
    return *this;
  }
  /// A text, bytes, or a message in it.
  ProtobufWriter& bytes(int field, std::string_view value) {
    tag(field, 2);
    number(value.size());
    text_ += value;
    return *this;
  }
  ProtobufWriter& message(int field, const ProtobufWriter& value) { return bytes(field, value.text_); }

  const std::string& str() const& { return text_; }
  std::string str() && { return std::move(text_); }

 private:
  void tag(int field, unsigned kind) { number((static_cast<std::uint64_t>(field) << 3) | kind); }
  void number(std::uint64_t value) {
    for (; value >= 128; value >>= 7) text_ += static_cast<char>((value & 127) | 128);
    text_ += static_cast<char>(value);
  }
  void fixed(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) text_ += static_cast<char>((value >> (8 * i)) & 255);
  }

  std::string text_;
};

}  // namespace marey::format::mcap
