#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "marey/core/picture.h"

struct AVFrame;

namespace marey::source {

/// FFmpeg's libraries behind five verbs: opens the best video stream of a file and yields its pictures in order of display. What is
/// no file (a pipe) is waited for; where the thread that opened it is asked to end (core/stop.h), the pictures end.
/// What is damaged is passed over and counted; only a file that cannot be opened at all throws.
class Decoder {
 public:
  /// `threads` = 0 takes one a core, or as many as oneTBB is allowed; pictures are the same, and in order, for any number.
  /// Throws Error, one sentence that names `path`, where nothing can be decoded, and Stopped.
  explicit Decoder(const std::string& path, int threads = 0);
  ~Decoder();
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  cv::Size size() const;  ///< of the pictures as they are shown: a phone's film held upright is upright
  std::optional<double> rate_hz() const;
  std::optional<std::int64_t> frame_count() const;  ///< where the container counts its frames
  std::optional<double> duration_s() const;         ///< where the container's header, or its rate and count, tell it

  struct Decoded {
    Picture picture;
    std::optional<std::int64_t> stamp_ns;  ///< the container's, from any origin
  };
  /// The next picture; nothing at the end. A picture of another size than size() is scaled to it, and counted.
  std::optional<Decoded> next();

  struct Trouble {
    std::int64_t undecodable = 0;  ///< packets and pictures passed over
    std::int64_t damaged = 0;      ///< pictures that were decoded in part
    std::int64_t rescaled = 0;     ///< pictures that were scaled to size()
    bool stopped = false;          ///< a pipe was no longer waited for
    std::string broken;            ///< why reading stopped before the file's own end, in FFmpeg's words; empty where it did not
  };
  const Trouble& trouble() const;  ///< so far

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::source
