#pragma once

#include <vector>

#include "marey/core/image.h"

namespace marey::experiments {

/// The images as a viewer of an H.264 file gets them: encoded by x264 at this constant rate factor (0 to 51, 4:2:0, preset
/// "veryfast", in memory), then decoded. As many as were given, in their order. All images have the first one's size, with even
/// sides. Throws Error if no H.264 encoder is installed.
std::vector<Image> codec_round_trip(const std::vector<Image>& images, int crf);

}  // namespace marey::experiments
