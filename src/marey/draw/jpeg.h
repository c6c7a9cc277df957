#pragma once

#include <string>

#include "marey/core/image.h"

namespace marey::draw {

/// Images as JPEG, no wider than they are wanted. Video's planes go in as they are: no colour is converted. One a thread.
class JpegEncoder {
 public:
  JpegEncoder();
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  static constexpr int kToBeObserved = 75;  ///< a quality for eyes; measurement requires 90 and more

  /// `most_width` in px, at least 16; `quality` from 1 to 100. Empty for an empty image, and for one that JPEG cannot hold.
  std::string encode(const Image& image, int most_width, int quality = kToBeObserved);

 private:
  void* handle_;
};

}  // namespace marey::draw
