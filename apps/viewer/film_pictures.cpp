#include "film_pictures.h"

#include <utility>

#include "marey/source/open_source.h"

#include "wire.h"

namespace marey::viewer {

FilmPictures::FilmPictures(const std::string& path, std::function<void(PageId, std::string)> ready)
    : path_(path), ready_(std::move(ready)), film_(source::open_source(path)), thread_([this] { run(); }) {}

FilmPictures::~FilmPictures() {
  end();
}

void FilmPictures::end() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void FilmPictures::ask(PageId page, std::int64_t frame, int width) {
  {
    const std::lock_guard lock(mutex_);
    wishes_[page] = {frame, width};
  }
  changed_.notify_all();
}

void FilmPictures::forget(PageId page) {
  const std::lock_guard lock(mutex_);
  wishes_.erase(page);
}

void FilmPictures::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !wishes_.empty(); });
    if (ending_) return;
    const std::map<PageId, Wish> wishes = std::exchange(wishes_, {});
    lock.unlock();
    for (const auto& [page, wish] : wishes) answer(page, wish);
    lock.lock();
  }
}

void FilmPictures::answer(PageId page, const Wish& wish) {
  if (!read_to(wish.frame)) return;
  const std::string jpeg = encoder_.encode(held_->picture, wish.width);
  ready_(page, wire_of({.camera = {},
                        .frame = wish.frame,
                        .time = held_->time,
                        .sent_ns = 0,
                        .size = held_->picture.size(),
                        .seen = {},
                        .boxes = {},
                        .jpeg = jpeg}));
}

bool FilmPictures::read_to(std::int64_t frame) {
  try {
    if (held_ && held_->index > frame) {
      film_ = source::open_source(path_);
      held_.reset();
    }
    while (!held_ || held_->index < frame) {
      {
        const std::lock_guard lock(mutex_);
        if (ending_) return false;
      }
      std::optional<Frame> next = film_->next();
      if (!next) break;
      held_ = std::move(next);
    }
  } catch (const std::exception&) {  // it was there when the program began; tracks are shown without it
    held_.reset();
  }
  return held_.has_value();
}

}  // namespace marey::viewer
