// ONNX is protocol buffers: fields one after the other, each with its number and how it is coded before it, messages within
// messages with their length (https://protobuf.dev/programming-guides/encoding). Only the path to the weights is taken apart
// (onnx.proto: ModelProto.graph = 7, GraphProto.initializer = 5, TensorProto.data_type = 2, .raw_data = 9); all else is copied.
#include "marey/detect/network/half_weights.h"

#include <cstdint>
#include <optional>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace marey::detect::network {
namespace {

constexpr std::uint64_t kGraph = 7, kInitializer = 5, kDataType = 2, kRawData = 9;
constexpr std::uint64_t kFloat = 1, kFloat16 = 10;  // TensorProto.DataType
enum Coding : unsigned { varint = 0, eight_bytes = 1, bytes = 2, four_bytes = 5 };

struct Field {
  std::uint64_t number = 0;
  unsigned coding = varint;
  std::uint64_t value = 0;   ///< of a varint
  std::string_view content;  ///< of bytes
  std::string_view whole;    ///< with what stands before it
};

/// The fields of one message.
class Fields {
 public:
  explicit Fields(std::string_view message) : rest_(message) {}

  /// Nothing at the end, and where the message is not one.
  std::optional<Field> next() {
    if (rest_.empty()) return std::nullopt;
    const std::string_view from_here = rest_;
    Field field;
    const auto tag = number();
    if (!tag) return broken();
    field.number = *tag >> 3;
    field.coding = static_cast<unsigned>(*tag & 7);
    if (field.coding == varint) {
      const auto value = number();
      if (!value) return broken();
      field.value = *value;
    } else {
      const auto length = field.coding == bytes         ? number()
                          : field.coding == eight_bytes ? std::optional<std::uint64_t>(8)
                          : field.coding == four_bytes  ? std::optional<std::uint64_t>(4)
                                                        : std::nullopt;
      if (!length || *length > rest_.size()) return broken();
      field.content = rest_.substr(0, *length);
      rest_.remove_prefix(*length);
    }
    field.whole = from_here.substr(0, from_here.size() - rest_.size());
    return field;
  }

  bool sound() const { return sound_; }

 private:
  std::optional<Field> broken() {
    sound_ = false;
    return std::nullopt;
  }

  std::optional<std::uint64_t> number() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && !rest_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(rest_.front());
      rest_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    return std::nullopt;
  }

  std::string_view rest_;
  bool sound_ = true;
};

void append_number(std::string& message, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) message += static_cast<char>((value & 0x7f) | 0x80);
  message += static_cast<char>(value);
}

void append_bytes(std::string& message, std::uint64_t number, std::string_view content) {
  append_number(message, number << 3 | bytes);
  append_number(message, content.size());
  message += content;
}

std::string floats_of(std::string_view halves) {
  const cv::Mat from(1, static_cast<int>(halves.size() / 2), CV_16F, const_cast<char*>(halves.data()));
  cv::Mat floats;
  from.convertTo(floats, CV_32F);
  return {reinterpret_cast<const char*>(floats.data), floats.total() * floats.elemSize()};
}

/// A tensor's message; nothing if it is not of 16-bit floats.
std::optional<std::string> full_tensor(std::string_view message) {
  std::string result;
  bool half = false, raw = false;
  Fields fields(message);
  while (const auto field = fields.next()) {
    if (field->number == kDataType && field->coding == varint) {
      half = field->value == kFloat16;
      append_number(result, kDataType << 3 | varint);
      append_number(result, kFloat);
    } else if (field->number == kRawData && field->coding == bytes) {
      raw = field->content.size() % 2 == 0;
      append_bytes(result, kRawData, raw ? floats_of(field->content) : field->content);
    } else {
      result += field->whole;
    }
  }
  if (!half || !raw || !fields.sound()) return std::nullopt;
  return result;
}

std::string full_graph(std::string_view message, bool& sound) {
  std::string result;
  result.reserve(2 * message.size());
  Fields fields(message);
  while (const auto field = fields.next()) {
    const auto tensor =
        field->number == kInitializer && field->coding == bytes ? full_tensor(field->content) : std::optional<std::string>();
    if (tensor) {
      append_bytes(result, kInitializer, *tensor);
    } else {
      result += field->whole;
    }
  }
  sound = fields.sound();
  return result;
}

}  // namespace

std::string with_full_weights(std::string onnx) {
  std::string result;
  Fields fields(onnx);
  bool sound = true;
  while (const auto field = fields.next()) {
    if (field->number == kGraph && field->coding == bytes) {
      append_bytes(result, kGraph, full_graph(field->content, sound));
      if (!sound) return onnx;
    } else {
      result += field->whole;
    }
  }
  return fields.sound() ? result : onnx;
}

}  // namespace marey::detect::network
