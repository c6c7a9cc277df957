#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "marey/format/motion/c3d_parameters.h"

namespace marey::format::motion {

constexpr std::size_t kC3dMatrixFloats = 17;
/// What a body's matrix is called behind its name, as Theia and Visual3D have it.
constexpr std::string_view kC3dMatrixEnding = "_4X4";

/// Where the frames are and what they hold.
struct C3dLayout {
  bool real = true;
  double scale = 1;       ///< file's units a step, of integer coordinates and of residuals
  double unit_m = 0.001;  ///< a file's unit
  std::size_t begin = 0;  ///< bytes
  std::size_t points = 0;
  std::size_t analog_words = 0;
  std::size_t analog_channels = 0;  ///< 0 also where words and channels do not fit each other
  std::size_t analog_samples = 0;   ///< of a channel in a frame
  std::size_t frames = 0;
  std::int64_t first_index = 0;       ///< of the first frame; the file counts from 1
  std::vector<std::string> warnings;  ///< what disagreed, one sentence each

  // Matrices of bodies behind the frames: 16 floats, column by column, and one that is negative if it is absent.
  std::size_t bodies = 0;
  std::size_t bodies_begin = 0;  ///< bytes
  std::size_t bodies_ratio = 1;  ///< matrices of a body in a frame

  std::size_t word() const { return real ? 4 : 2; }
  std::size_t frame_bytes() const { return word() * (4 * points + analog_words); }
  std::size_t body_bytes() const { return kC3dMatrixFloats * 4; }
  std::size_t bodies_bytes() const { return body_bytes() * bodies * bodies_ratio; }  ///< of a frame
};

/// Found from the head and from how long the file is; of one that is cut off, the frames that are there. Throws Error, with `name`
/// for the file, if it is absent.
C3dLayout c3d_layout(const C3dHead& head, std::size_t size, const std::string& name);

}  // namespace marey::format::motion
