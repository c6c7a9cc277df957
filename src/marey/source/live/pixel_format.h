#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <opencv2/core/types.hpp>

#include "marey/core/image.h"

namespace marey::source::live {

/// How a camera lays pixels in memory.
enum class Packing { grey, yuyv };

/// An image of its own memory out of a driver's buffer, whose rows begin every `stride` bytes. Nothing if the buffer is too
/// short for it.
std::optional<Image> unpack(Packing packing, std::span<const std::uint8_t> bytes, cv::Size size, std::size_t stride);

}  // namespace marey::source::live
