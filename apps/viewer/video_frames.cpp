#include "video_frames.h"

#include <utility>

#include "marey/source/open_source.h"

#include "wire.h"

namespace marey::viewer {

VideoFrames::VideoFrames(const std::string& path, std::function<void(PageId, std::string)> ready)
    : path_(path), ready_(std::move(ready)), video_(source::open_source(path)), thread_([this] { run(); }) {}

VideoFrames::~VideoFrames() {
  end();
}

void VideoFrames::end() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void VideoFrames::request(PageId page, std::int64_t frame, int width) {
  {
    const std::lock_guard lock(mutex_);
    requests_[page] = {frame, width};
  }
  changed_.notify_all();
}

void VideoFrames::forget(PageId page) {
  const std::lock_guard lock(mutex_);
  requests_.erase(page);
}

void VideoFrames::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !requests_.empty(); });
    if (ending_) return;
    const std::map<PageId, ControlRequest> wishes = std::exchange(requests_, {});
    lock.unlock();
    for (const auto& [page, request] : wishes) answer(page, request);
    lock.lock();
  }
}

void VideoFrames::answer(PageId page, const ControlRequest& request) {
  if (!read_to(request.frame)) return;
  const std::string jpeg = encoder_.encode(held_->image, request.width);
  ready_(page, wire_of({.camera = {},
                        .frame = request.frame,
                        .time = held_->time,
                        .sent_ns = 0,
                        .size = held_->image.size(),
                        .detected = {},
                        .boxes = {},
                        .jpeg = jpeg}));
}

bool VideoFrames::read_to(std::int64_t frame) {
  try {
    if (held_ && held_->index > frame) {
      video_ = source::open_source(path_);
      held_.reset();
    }
    while (!held_ || held_->index < frame) {
      {
        const std::lock_guard lock(mutex_);
        if (ending_) return false;
      }
      std::optional<Frame> next = video_->next();
      if (!next) break;
      held_ = std::move(next);
    }
  } catch (const std::exception&) {  // it was there when the program began; tracks are shown without it
    held_.reset();
  }
  return held_.has_value();
}

}  // namespace marey::viewer
