#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace marey::experiments {

/// One scene's row: videos in which a marker loses its name, by the rule of evaluate_labels.
struct MarkerNamesRow {
  std::string scene;
  int videos = 0;
  int lost = 0;        ///< with the marker detector and the tracker of markers
  int lost_exact = 0;  ///< with the true places of visible markers, and the tracker of markers
  int peer_lost = 0;   ///< a plain threshold, constant velocity and the Hungarian method
  int peer_lost_exact = 0;
};

struct MarkerNamesOptions {
  int videos = 100;  ///< of each scene
  std::uint64_t seed = 1;
  std::string only;  ///< scenes whose names contain this; empty for all
  std::function<void(int done, int all)> progress;
};

/// Names of markers where they are hard to keep: behind bars, from one side and from two, and among false lights. Images are
/// rendered and seen as they are, without a codec.
std::vector<MarkerNamesRow> run_marker_names(const MarkerNamesOptions& options);

/// As text, a line a scene.
std::string to_text(const std::vector<MarkerNamesRow>& rows);

/// One table in Markdown, a row a scene.
std::string to_markdown(const std::vector<MarkerNamesRow>& rows);

}  // namespace marey::experiments
