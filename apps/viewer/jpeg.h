#pragma once

#include <string>

#include "marey/core/picture.h"

namespace marey::viewer {

/// Pictures as JPEG, no wider than they are shown. Video's planes go in as they are: no colour is converted. One a thread.
class JpegEncoder {
 public:
  JpegEncoder();
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// `most_width` in px, at least 16. Empty for an empty picture, and for one that JPEG cannot hold.
  std::string encode(const Picture& picture, int most_width);

 private:
  void* handle_;
};

}  // namespace marey::viewer
