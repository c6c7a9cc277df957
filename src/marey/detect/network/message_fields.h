// Protocol buffers: fields one after the other, each with its number and how it is coded before it, messages within messages with
// their length (https://protobuf.dev/programming-guides/encoding). ONNX files are that.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace marey::detect::network {

/// One field of a message. Valid as long as the message's bytes are.
struct Field {
  enum Coding : unsigned { varint = 0, eight_bytes = 1, bytes = 2, four_bytes = 5 };

  std::uint64_t number = 0;
  unsigned coding = varint;
  std::uint64_t value = 0;   ///< of a varint
  std::string_view content;  ///< of all others
  std::string_view whole;    ///< with what stands before it
};

/// The fields of one message.
class Fields {
 public:
  explicit Fields(std::string_view message) : rest_(message) {}

  /// Nothing at the end, and where the message is not one.
  std::optional<Field> next();
  /// A number as varints write it; nothing at the end, and where it is cut off.
  std::optional<std::uint64_t> number();

  bool sound() const { return sound_; }         ///< no field so far was cut off
  bool ended() const { return rest_.empty(); }  ///< all of the message is read

 private:
  std::optional<Field> broken() {
    sound_ = false;
    return std::nullopt;
  }

  std::string_view rest_;
  bool sound_ = true;
};

}  // namespace marey::detect::network
