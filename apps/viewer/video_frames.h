#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "marey/core/source.h"
#include "marey/draw/jpeg.h"

#include "web_server.h"

namespace marey::viewer {

/// The images of a video behind its tracks, on a thread of its own. Each page has one request at a time, the newest. Forwards it
/// reads on; backwards it begins again, since not every video can be entered in its middle.
class VideoFrames {
 public:
  /// `ready` gets a message of kind 3 (wire.h), on the video's thread. Throws Error if the video cannot be opened.
  VideoFrames(const std::string& path, std::function<void(PageId, std::string)> ready);
  ~VideoFrames();
  VideoFrames(const VideoFrames&) = delete;
  VideoFrames& operator=(const VideoFrames&) = delete;

  /// `frame` counts from 0; `width` in px.
  void request(PageId page, std::int64_t frame, int width);
  void forget(PageId page);
  /// Calls `ready` no more.
  void end();

 private:
  struct ControlRequest {
    std::int64_t frame = 0;
    int width = 0;
  };

  void run();
  void answer(PageId page, const ControlRequest& request);
  /// Whether `held_` is the frame, or the last one before it.
  bool read_to(std::int64_t frame);

  std::string path_;
  std::function<void(PageId, std::string)> ready_;
  std::unique_ptr<Source> video_;
  std::optional<Frame> held_;
  draw::JpegEncoder encoder_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<PageId, ControlRequest> requests_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace marey::viewer
