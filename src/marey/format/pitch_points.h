#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/geometry.h"

namespace marey::format {

/// What a person clicked in one image of a pitch. Pixels: a pixel's integer coordinate is its centre.
struct PitchClicks {
  struct Point {
    Vector<2> ground;  ///< m, in the frame of the one who clicked
    Vector<2> pixel;
    std::string name;                        ///< as the file has it
    std::optional<std::int64_t> frame = {};  ///< in which it was clicked, from 0; nothing if the file does not specify
  };
  /// Pixels anywhere along the straight line between two places.
  struct Line {
    Vector<2> from, to;  ///< m
    std::vector<Vector<2>> pixels;
    std::string name;
  };
  std::vector<Point> points;
  std::vector<Line> lines;
};

/// Reads clicks from a file (docs/football.md):
///   CSV       one point a line: x, y in m, then u, v in px. A header names the columns where the order is another: x y u v;
///             a column `frame` says in which frame of a video each was clicked
///   CVAT XML  <points label="(x,y)" points="u,v">; <polyline label="(x,y)-(x,y)" points="u,v;u,v;…">. CVAT counts pixels from
///   their corner; an image's id is its frame
/// Throws Error, with the line, where the file is neither, or a number is not one.
PitchClicks read_pitch_clicks(const std::string& path);

/// The same from text; `name` is what messages call it.
PitchClicks parse_pitch_clicks(std::string_view text, const std::string& name);

}  // namespace marey::format
