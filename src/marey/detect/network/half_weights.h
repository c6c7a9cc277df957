#pragma once

#include <string>

namespace marey::detect::network {

/// An ONNX file with its weights of 16 bits as 32-bit floats, which OpenCV 4.6 wants; Cast nodes that make them so then change
/// nothing. What is not an ONNX file comes back as it is.
std::string with_full_weights(std::string onnx);

}  // namespace marey::detect::network
