#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "marey/core/image.h"

struct AVFrame;

namespace marey::source {

/// FFmpeg's libraries behind five verbs: opens the best video stream of a file and yields its images in order of display. What is
/// no file (a pipe) is waited for; where the thread that opened it is asked to end (core/stop.h), the images end.
/// What is damaged is skipped and counted; only a file that cannot be opened at all throws.
class Decoder {
 public:
  /// `threads` = 0 takes one a core, or as many as oneTBB is allowed; images are the same, and in order, for any number.
  /// Throws Error, one sentence that names `path`, where nothing can be decoded, and Stopped.
  explicit Decoder(const std::string& path, int threads = 0);
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  cv::Size size() const;  ///< of the images as they are shown: a phone's video held upright is upright
  std::optional<double> rate_hz() const;
  std::optional<std::int64_t> frame_count() const;  ///< where the container counts its frames
  std::optional<double> duration_s() const;         ///< where the container's header, or its rate and count, specify it

  /// What the file, its stream or its first decoded image (EXIF) states under a name of FFmpeg's.
  std::optional<std::string> tag(const char* name) const;

  struct Decoded {
    Image image;
    std::optional<std::int64_t> stamp_ns;  ///< the container's, from any origin
  };
  /// The next image; nothing at the end. An image of another size than size() is scaled to it, and counted.
  std::optional<Decoded> next();

  struct Trouble {
    std::int64_t undecodable = 0;  ///< packets and images skipped
    std::int64_t damaged = 0;      ///< images that were decoded in part
    std::int64_t rescaled = 0;     ///< images that were scaled to size()
    bool stopped = false;          ///< a pipe was no longer waited for
    std::string broken;            ///< why reading stopped before the file's own end, in FFmpeg's words; empty if it did not
  };
  const Trouble& trouble() const;  ///< so far

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::source
