#pragma once

#include <string>

#include "marey/core/picture.h"

namespace marey::draw {

/// Pictures as JPEG, no wider than they are wanted. Video's planes go in as they are: no colour is converted. One a thread.
class JpegEncoder {
 public:
  JpegEncoder();
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  static constexpr int kToBeSeen = 75;  ///< a quality for eyes; what is measured in wants 90 and more

  /// `most_width` in px, at least 16; `quality` from 1 to 100. Empty for an empty picture, and for one that JPEG cannot hold.
  std::string encode(const Picture& picture, int most_width, int quality = kToBeSeen);

 private:
  void* handle_;
};

}  // namespace marey::draw
