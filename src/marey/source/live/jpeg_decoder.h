#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "marey/core/picture.h"

namespace marey::source::live {

/// Pictures of a camera that sends each as a JPEG.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();

  /// Empty where it cannot be decoded.
  Picture decode(std::span<const std::uint8_t> bytes);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::source::live
