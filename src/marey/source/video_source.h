#pragma once

#include <memory>
#include <optional>
#include <string>

#include "marey/core/source.h"

namespace marey::source {

/// Opens a video file that FFmpeg reads. Frames keep the decoder's own planes: nothing is copied or converted where the file
/// stores 4:2:0 or grey. Times come from the container; where `rate_hz` is given they are index / rate instead.
/// Throws Error if the file is missing, empty, no video, or has no video stream.
std::unique_ptr<Source> open_video(const std::string& path, std::optional<double> rate_hz = std::nullopt);

}  // namespace marey::source
