#include "marey/source/read_ahead.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <tbb/concurrent_queue.h>

namespace marey::source {
namespace {

class ReadAhead final : public Source {
 public:
  ReadAhead(std::unique_ptr<Source> source, int depth) : source_(std::move(source)), info_(source_->info()) {
    waiting_.set_capacity(depth);
    reader_ = std::thread([this] { read(); });
  }

  ~ReadAhead() override {
    stop_ = true;
    for (Item item; waiting_.try_pop(item);) continue;  // the reader, if it waits for room, gets some, and then sees `stop_`
    reader_.join();
  }

  const SourceInfo& info() const override { return info_; }

  std::optional<Frame> next() override {
    if (ended_) return std::nullopt;
    Item item;
    waiting_.pop(item);
    ended_ = !item.frame;
    if (item.failure) std::rethrow_exception(item.failure);
    return std::move(item.frame);
  }

  std::vector<std::string> warnings() const override {
    const std::lock_guard lock(reading_);
    return source_->warnings();
  }

 private:
  struct Item {
    std::optional<Frame> frame;  // nothing at the end
    std::exception_ptr failure;
  };

  void read() {
    for (bool more = true; more && !stop_;) {
      Item item;
      try {
        const std::lock_guard lock(reading_);
        item.frame = source_->next();
      } catch (...) {
        item.failure = std::current_exception();
      }
      more = item.frame.has_value();
      waiting_.push(std::move(item));
    }
  }

  std::unique_ptr<Source> source_;
  SourceInfo info_;
  mutable std::mutex reading_;  // guards source_
  tbb::concurrent_bounded_queue<Item> waiting_;
  std::atomic<bool> stop_ = false;
  bool ended_ = false;
  std::thread reader_;
};

}  // namespace

std::unique_ptr<Source> read_ahead(std::unique_ptr<Source> source, int depth) {
  return std::make_unique<ReadAhead>(std::move(source), depth);
}

}  // namespace marey::source
