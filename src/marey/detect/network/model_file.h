#pragma once

#include <array>
#include <optional>
#include <string>

#include <opencv2/core/types.hpp>

#include "marey/detect/network/output_layout.h"

namespace marey::detect::network {

/// A detection network, as a file of TOML says (docs/network.md): where it lies, what image it wants, what its outputs mean. What
/// is not said there is as normal for its layout.
struct NetworkModel {
  enum class Resize { segment, letterbox, corner };  ///< corner: as letterbox, the image at the top left

  std::string path;              ///< the TOML file, for messages
  std::string network;           ///< the ONNX file
  cv::Size input;                ///< px
  std::optional<Layout> layout;  ///< else given by the outputs' shapes
  std::optional<Resize> resize;
  std::optional<bool> rgb;      ///< else blue first
  std::optional<double> scale;  ///< what reaches the network is (value · scale − mean) / deviation, values 0 to 255
  std::optional<std::array<double, 3>> mean;
  std::optional<std::array<double, 3>> deviation;
  int person = 0;      ///< the class of people
  double score = 0.4;  ///< the least
};

/// The model that the file describes; its network file stands beside it unless its path is absolute. Throws Error, with the line,
/// where something is missing, unknown or impossible.
NetworkModel read_network_model(const std::string& path);

/// The same from text; `path` as where it stood.
NetworkModel parse_network_model(const std::string& text, const std::string& path);

}  // namespace marey::detect::network
