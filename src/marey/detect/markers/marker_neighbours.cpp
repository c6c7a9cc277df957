#include "marey/detect/markers/marker_neighbours.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace marey::detect::markers {
namespace {

constexpr int kCell = 64;  // px

}  // namespace

void MarkerNeighbours::file(std::span<const MarkerBlob> blobs, std::span<const std::size_t> chosen, cv::Size size) {
  const cv::Size count((size.width + kCell - 1) / kCell, (size.height + kCell - 1) / kCell);
  if (count != cell_count_) cells_.assign(count.area(), {});
  cell_count_ = count;
  for (auto& cell : cells_) cell.clear();
  for (const std::size_t i : chosen) {
    const int column = static_cast<int>(blobs[i].mean_x) / kCell, row = static_cast<int>(blobs[i].mean_y) / kCell;
    cells_[static_cast<std::size_t>(row) * count.width + column].push_back(static_cast<std::uint32_t>(i));
  }
}

void MarkerNeighbours::find(std::span<const MarkerBlob> blobs, std::size_t index, std::vector<MarkerNeighbour>& near) const {
  near.clear();
  const MarkerBlob& own = blobs[index];
  const int extent = std::max(own.box.width, own.box.height) / 2 + 3;
  const cv::Rect reach(own.box.x - extent, own.box.y - extent, own.box.width + 2 * extent, own.box.height + 2 * extent);
  const auto cell = [](int location, int cells) { return std::clamp(location / kCell, 0, cells - 1); };
  for (int row = cell(reach.y, cell_count_.height); row <= cell(reach.br().y, cell_count_.height); ++row) {
    for (int column = cell(reach.x, cell_count_.width); column <= cell(reach.br().x, cell_count_.width); ++column) {
      for (const std::uint32_t i : cells_[static_cast<std::size_t>(row) * cell_count_.width + column]) {
        if (i == index || (blobs[i].box & reach).empty()) continue;
        near.push_back({{blobs[i].mean_x, blobs[i].mean_y}, std::sqrt(static_cast<double>(blobs[i].area) / std::numbers::pi)});
      }
    }
  }
}

}  // namespace marey::detect::markers
