// Only the path to the weights is taken apart (onnx.proto: ModelProto.graph = 7, GraphProto.initializer = 5, TensorProto.data_type
// = 2, .raw_data = 9); all else is copied.
#include "marey/detect/network/half_weights.h"

#include <cstdint>
#include <optional>
#include <string_view>

#include <opencv2/core/mat.hpp>

#include "marey/detect/network/message_fields.h"

namespace marey::detect::network {
namespace {

constexpr std::uint64_t kGraph = 7, kInitializer = 5, kDataType = 2, kRawData = 9;
constexpr std::uint64_t kFloat = 1, kFloat16 = 10;  // TensorProto.DataType

void append_number(std::string& message, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) message += static_cast<char>((value & 0x7f) | 0x80);
  message += static_cast<char>(value);
}

void append_bytes(std::string& message, std::uint64_t number, std::string_view content) {
  append_number(message, number << 3 | Field::bytes);
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
    if (field->number == kDataType && field->coding == Field::varint) {
      half = field->value == kFloat16;
      append_number(result, kDataType << 3 | Field::varint);
      append_number(result, kFloat);
    } else if (field->number == kRawData && field->coding == Field::bytes) {
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
        field->number == kInitializer && field->coding == Field::bytes ? full_tensor(field->content) : std::optional<std::string>();
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
    if (field->number == kGraph && field->coding == Field::bytes) {
      append_bytes(result, kGraph, full_graph(field->content, sound));
      if (!sound) return onnx;
    } else {
      result += field->whole;
    }
  }
  return fields.sound() ? result : onnx;
}

}  // namespace marey::detect::network
