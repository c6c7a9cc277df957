// An ONNX file taken apart: its nodes in their order, and its weights.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace marey::detect::network {

struct OnnxTensor {
  std::vector<int> shape;
  std::vector<float> floats;  ///< one of the two has its values
  std::vector<std::int64_t> integers;
};

struct OnnxNode {
  std::string kind;  ///< "Conv", "Add", …
  std::vector<std::string> inputs, outputs;
  std::map<std::string, std::vector<double>> numbers;  ///< attributes of numbers
  std::map<std::string, std::string> texts;            ///< attributes of text
};

struct OnnxGraph {
  std::vector<OnnxNode> nodes;
  std::map<std::string, OnnxTensor> weights;
  std::vector<std::string> inputs, outputs;
};

/// `file`: the whole content, with weights of 32 bits (half_weights.h). Nothing if it is another file, is cut off, or has weights
/// of other types than 32-bit floats and 64-bit integers.
std::optional<OnnxGraph> onnx_graph(std::string_view file);

}  // namespace marey::detect::network
