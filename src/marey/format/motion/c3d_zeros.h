#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "marey/core/instant.h"
#include "marey/format/motion/c3d_points.h"

namespace marey::format::motion {

/// Points at exactly (0, 0, 0) that a C3D file does not mark as missing, and that are missing all the same.
class C3dZeros {
 public:
  /// Reads all frames once. `tracks` are those to examine, of ids that are a point's number, counted from 1; others are never
  /// missing here.
  C3dZeros(const C3dPointWords& points, std::span<const TrackName> tracks);

  /// As `frame` and `point` count in the file, from 0.
  bool missing(std::size_t frame, std::size_t point) const;
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  using Range = std::pair<std::size_t, std::size_t>;  // of frames, without the last

  struct Run {
    Range frames;
    std::optional<std::size_t> before = {}, behind = {};  // the nearest frames that have the marker elsewhere
  };

  struct Marker {
    std::size_t point = 0;
    const std::string* label = nullptr;
    std::vector<Run> zeros = {};
    std::size_t open = 0;                       // runs from here on wait for `behind`
    std::optional<std::size_t> elsewhere = {};  // the last frame that has it there
    bool measured = false;                      // it has a residual or cameras at some zero
  };

  static void scan(const C3dPointWords& points, std::vector<Marker>& markers, bool& marks_missing);
  static bool is_position(const C3dPointWords& points, std::size_t point, const Run& run);
  void assess(const C3dPointWords& points, std::vector<Marker>& markers, bool marks_missing);
  void announce(const std::vector<const Marker*>& kept, std::size_t all_points);

  std::vector<std::vector<Range>> missing_;  // by point, by frame
  std::vector<std::string> warnings_;
};

}  // namespace marey::format::motion
