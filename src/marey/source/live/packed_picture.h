#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <opencv2/core/types.hpp>

#include "marey/core/picture.h"

namespace marey::source::live {

/// How a camera lays pixels in memory.
enum class Packing { grey, yuyv };

/// A picture of its own memory out of a driver's buffer, whose rows begin every `stride` bytes. Nothing where the buffer is too
/// short for it.
std::optional<Picture> unpack(Packing packing, std::span<const std::uint8_t> bytes, cv::Size size, std::size_t stride);

}  // namespace marey::source::live
