// The numbers of fields are those of onnx.proto (https://github.com/onnx/onnx/blob/main/onnx/onnx.proto).
#include "marey/detect/network/onnx_graph.h"

#include <bit>
#include <cstddef>
#include <cstring>
#include <utility>

#include "marey/detect/network/message_fields.h"

namespace marey::detect::network {
namespace {

constexpr std::uint64_t kOfFloats = 1, kOfIntegers = 7;   // format: TensorProto.DataType
constexpr std::size_t kMaxValues = std::size_t{1} << 28;  // numerical: of one tensor

float float_of(std::string_view four_bytes) {
  float value = 0;
  if (four_bytes.size() == sizeof value) std::memcpy(&value, four_bytes.data(), sizeof value);
  return value;
}

template <typename Value>
void append_raw(std::vector<Value>& values, std::string_view content) {
  const std::size_t before = values.size(), count = content.size() / sizeof(Value);
  values.resize(before + count);
  if (count > 0) std::memcpy(values.data() + before, content.data(), count * sizeof(Value));
}

/// A field of integers: one, or many packed.
bool append_integers(std::vector<std::int64_t>& values, const Field& field) {
  if (field.coding == Field::varint) {
    values.push_back(std::bit_cast<std::int64_t>(field.value));
    return true;
  }
  if (field.coding != Field::bytes) return false;
  Fields packed(field.content);
  while (const auto number = packed.number()) values.push_back(std::bit_cast<std::int64_t>(*number));
  return packed.ended();
}

/// Name and tensor.
std::optional<std::pair<std::string, OnnxTensor>> tensor_in(std::string_view message) {
  std::pair<std::string, OnnxTensor> result;
  OnnxTensor& tensor = result.second;
  std::vector<std::int64_t> shape;
  std::uint64_t type = 0;
  std::string_view raw;
  Fields fields(message);
  while (const auto field = fields.next()) {
    if (field->number == 1 && !append_integers(shape, *field)) return std::nullopt;
    if (field->number == 2) type = field->value;
    if (field->number == 4) append_raw(tensor.floats, field->content);
    if (field->number == 7 && !append_integers(tensor.integers, *field)) return std::nullopt;
    if (field->number == 8) result.first = field->content;
    if (field->number == 9) raw = field->content;
  }
  if (type == kOfFloats) append_raw(tensor.floats, raw);
  if (type == kOfIntegers) append_raw(tensor.integers, raw);
  std::size_t count = 1;
  for (const std::int64_t size : shape) {
    if (size < 0 || static_cast<std::uint64_t>(size) > kMaxValues) return std::nullopt;
    count *= static_cast<std::size_t>(size);
    if (count > kMaxValues) return std::nullopt;
    tensor.shape.push_back(static_cast<int>(size));
  }
  const std::size_t present = type == kOfFloats ? tensor.floats.size() : tensor.integers.size();
  if (!fields.sound() || (type != kOfFloats && type != kOfIntegers) || present != count) return std::nullopt;
  return result;
}

bool read_attribute(OnnxNode& node, std::string_view message) {
  std::string name, text;
  std::vector<double> numbers;
  std::vector<std::int64_t> integers;
  Fields fields(message);
  while (const auto field = fields.next()) {
    if (field->number == 1) name = field->content;
    if (field->number == 2) numbers.push_back(float_of(field->content));
    if ((field->number == 3 || field->number == 8) && !append_integers(integers, *field)) return false;
    if (field->number == 4) text = field->content;
    if (field->number == 7) {
      for (std::size_t i = 0; i + 4 <= field->content.size(); i += 4) numbers.push_back(float_of(field->content.substr(i, 4)));
    }
  }
  for (const std::int64_t integer : integers) numbers.push_back(static_cast<double>(integer));
  if (text.empty()) {
    node.numbers[name] = std::move(numbers);
  } else {
    node.texts[name] = std::move(text);
  }
  return fields.sound();
}

std::optional<OnnxNode> node_in(std::string_view message) {
  OnnxNode node;
  Fields fields(message);
  while (const auto field = fields.next()) {
    if (field->number == 1) node.inputs.emplace_back(field->content);
    if (field->number == 2) node.outputs.emplace_back(field->content);
    if (field->number == 4) node.kind = field->content;
    if (field->number == 5 && !read_attribute(node, field->content)) return std::nullopt;
  }
  if (!fields.sound() || node.outputs.empty()) return std::nullopt;
  return node;
}

std::string name_in(std::string_view message) {
  Fields fields(message);
  while (const auto field = fields.next()) {
    if (field->number == 1) return std::string(field->content);
  }
  return {};
}

bool read_graph(OnnxGraph& graph, std::string_view message) {
  Fields fields(message);
  while (const auto field = fields.next()) {
    if (field->number == 1) {
      auto node = node_in(field->content);
      if (!node) return false;
      graph.nodes.push_back(std::move(*node));
    } else if (field->number == 5) {
      auto tensor = tensor_in(field->content);
      if (!tensor) return false;
      graph.weights.insert(std::move(*tensor));
    } else if (field->number == 11) {
      graph.inputs.push_back(name_in(field->content));
    } else if (field->number == 12) {
      graph.outputs.push_back(name_in(field->content));
    }
  }
  return fields.sound();
}

}  // namespace

std::optional<OnnxGraph> onnx_graph(std::string_view file) {
  OnnxGraph graph;
  bool found = false;
  Fields fields(file);
  while (const auto field = fields.next()) {
    if (field->number != 7 || field->coding != Field::bytes) continue;
    found = true;
    if (!read_graph(graph, field->content)) return std::nullopt;
  }
  if (!found || !fields.sound()) return std::nullopt;
  // Exporters list weights as inputs too.
  std::erase_if(graph.inputs, [&](const std::string& name) { return graph.weights.contains(name); });
  return graph;
}

}  // namespace marey::detect::network
