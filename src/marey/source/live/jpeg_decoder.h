#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "marey/core/image.h"

namespace marey::source::live {

/// Images of a camera that sends each as a JPEG.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();

  /// Empty if it cannot be decoded.
  Image decode(std::span<const std::uint8_t> bytes);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::source::live
