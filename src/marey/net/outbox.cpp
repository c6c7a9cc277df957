#include "marey/net/outbox.h"

#include <algorithm>
#include <utility>

namespace marey::net {

void Outbox::push(Waiting waiting) {
  waiting_.push_back(std::move(waiting));
  if (flush_) flush_();
}

void Outbox::answer(Message message) {
  if (gone_) return;
  unread_ += message.head.size();
  push({.message = std::move(message)});
}

void Outbox::frame(Message message) {
  if (gone_ || ending_) return;
  if (frames_ >= kMaxFrames) {
    const auto oldest = std::find_if(waiting_.begin(), waiting_.end(), [](const Waiting& each) { return each.is_frame; });
    if (oldest == waiting_.end()) return;
    waiting_.erase(oldest);
    --frames_;
    ++dropped_;
  }
  ++frames_;
  push({.message = std::move(message), .is_frame = true});
}

void Outbox::frame_of_topic(int topic, Message message) {
  if (gone_ || ending_) return;
  const auto same = std::find_if(waiting_.begin(), waiting_.end(), [topic](const Waiting& each) { return each.topic == topic; });
  if (same != waiting_.end()) {
    same->message = std::move(message);
    ++dropped_;
    return;
  }
  ++frames_;
  push({.message = std::move(message), .is_frame = true, .topic = topic});
}

void Outbox::end() {
  ending_ = true;
  if (flush_) flush_();
}

const Outbox::Message* Outbox::begin_next() {
  if (!sending_ && !waiting_.empty()) {
    sending_ = std::move(waiting_.front());
    waiting_.pop_front();
  }
  return sending_ ? &sending_->message : nullptr;
}

void Outbox::done() {
  if (sending_->is_frame) {
    --frames_;
    ++sent_;
  } else {
    unread_ -= sending_->message.head.size();
  }
  sending_.reset();
}

void Outbox::discard() {
  gone_ = true;
  dropped_ += static_cast<std::int64_t>(frames_);
  frames_ = unread_ = 0;
  waiting_.clear();
}

}  // namespace marey::net
