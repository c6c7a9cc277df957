#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/markers/marker_fit.h"

namespace marey::detect::markers {

/// The blobs of a frame, filed by cells, so that those near another are found without a search through all.
class MarkerNeighbours {
 public:
  /// Files blobs[i] for each i of `chosen`. They lie within an image of `size`.
  void file(std::span<const MarkerBlob> blobs, std::span<const std::size_t> chosen, cv::Size size);

  /// Other filed blobs whose light may reach into the window of blobs[index], in `near`.
  void find(std::span<const MarkerBlob> blobs, std::size_t index, std::vector<MarkerNeighbour>& near) const;

 private:
  std::vector<std::vector<std::uint32_t>> cells_;
  cv::Size cell_count_;
};

}  // namespace marey::detect::markers
