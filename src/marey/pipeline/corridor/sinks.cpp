#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core.hpp>
#include <tbb/concurrent_queue.h>

#include "marey/core/error.h"
#include "marey/pipeline/corridor/run.h"

namespace marey::pipeline::corridor {
namespace {

constexpr int kWaiting = 8;        // instants, with their images
constexpr int kWaitingLive = 256;  // without them: what is live is not held up by a disk that is busy for a second

}  // namespace

/// A sink, written on a thread of its own.
class Sinks::Lane {
 public:
  /// One of both.
  struct Work {
    std::shared_ptr<const Instant> instant = {};
    std::shared_ptr<const FrameForeground> foreground = {};
  };

  explicit Lane(std::unique_ptr<Sink> sink)
      : sink_(std::move(sink)), foregrounds_(dynamic_cast<ForegroundSink*>(sink_.get())), name_(sink_->name()) {
    queue_.set_capacity(kWaiting);
  }

  ~Lane() {
    if (!writer_.joinable()) return;
    given_up_ = true;
    queue_.push({});
    writer_.join();
  }

  Sink::SinkRequirements begin(const RecordingHeader& header, Slow slow) {
    needs_ = sink_->begin(header);
    if (slow == Slow::skipped && !needs_.images) queue_.set_capacity(kWaitingLive);
    writer_ = std::thread([this] { write_all(); });
    return needs_;
  }

  const Sink::SinkRequirements& needs() const { return needs_; }
  const std::string& name() const { return name_; }
  bool failed() const { return failed_; }
  /// Called where the run ends because it failed.
  void end_run() { ended_run_ = true; }
  bool ended_run() const { return ended_run_; }
  bool needs_foregrounds() const { return foregrounds_ != nullptr && !failed_; }
  void give(const Work& work) { queue_.push(work); }
  /// Only where there is room.
  void offer(const Work& work) { skipped_ += failed_ || queue_.try_push(work) ? 0 : 1; }

  /// Nothing if it does not exist.
  std::string trouble() const {
    if (failed_) return message_of_failure();
    return skipped_ > 0 ? fmt::format("{}: too slow for {} instants, which it does not have", name_, skipped_) : "";
  }

  /// Waits until all that was given is written.
  void drain() {
    queue_.push({});
    writer_.join();
    if (!failed_) commit();
  }

  /// Throws what the sink threw.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void write_all() {
    for (;;) {
      Work work;
      queue_.pop(work);
      if (work.instant == nullptr && work.foreground == nullptr) return;
      if (failed_ || given_up_) continue;
      if (work.instant != nullptr) attempt([&] { sink_->write(*work.instant); });
      if (work.foreground != nullptr) attempt([&] { foregrounds_->write_foreground(*work.foreground); });
    }
  }

  void commit() {
    attempt([&] { sink_->finish(); });
  }

  std::string message_of_failure() const {
    try {
      std::rethrow_exception(failure_);
    } catch (const std::bad_alloc&) {
      return name_ + ": there is not enough memory for it";
    } catch (const std::exception& error) {
      return error.what();
    }
  }

  /// A sink that fails is closed at once: nothing half-written stays.
  template <typename Do>
  void attempt(const Do& what) {
    try {
      what();
    } catch (...) {
      failure_ = std::current_exception();
      failed_ = true;
      sink_.reset();
    }
  }

  std::unique_ptr<Sink> sink_;
  ForegroundSink* foregrounds_;  // the sink, if it is one for foregrounds
  std::string name_;
  Sink::SinkRequirements needs_;
  tbb::concurrent_bounded_queue<Work> queue_;  // without either: the end
  std::atomic<bool> failed_ = false, given_up_ = false;
  std::exception_ptr failure_;  // before failed_
  bool ended_run_ = false;
  std::int64_t skipped_ = 0;
  std::thread writer_;
};

Sinks::Sinks(Slow slow) : slow_(slow) {}
Sinks::~Sinks() = default;
Sinks::Sinks(Sinks&&) noexcept = default;
Sinks& Sinks::operator=(Sinks&&) noexcept = default;

void Sinks::add(std::unique_ptr<Sink> sink) {
  lanes_.push_back(std::make_unique<Lane>(std::move(sink)));
}

void Sinks::begin(const RecordingHeader& header) {
  for (const auto& lane : lanes_) lane->begin(header, slow_);
}

bool Sinks::need_images() const {
  return std::any_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->needs().images && !lane->failed(); });
}

bool Sinks::need_boxes() const {
  return std::any_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->needs().boxes && !lane->failed(); });
}

bool Sinks::need_foregrounds() const {
  return std::any_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->needs_foregrounds(); });
}

bool Sinks::write(Instant instant) {
  const Lane::Work work{.instant = std::make_shared<const Instant>(std::move(instant))};
  bool all = true;
  for (const auto& lane : lanes_) all = hand_to(*lane, work) && all;
  return all;
}

bool Sinks::write(FrameForeground foreground) {
  const Lane::Work work{.foreground = std::make_shared<const FrameForeground>(std::move(foreground))};
  bool all = true;
  for (const auto& lane : lanes_) all = (!lane->needs_foregrounds() || hand_to(*lane, work)) && all;
  return all;
}

template <typename Work>
bool Sinks::hand_to(Lane& lane, const Work& work) const {
  if (slow_ == Slow::skipped) {
    lane.offer(work);
    return true;
  }
  lane.give(work);
  if (!lane.failed()) return true;
  lane.end_run();
  return false;
}

std::vector<std::string> Sinks::troubles() const {
  std::vector<std::string> all;
  for (const auto& lane : lanes_) {
    if (std::string trouble = lane->trouble(); slow_ == Slow::skipped && !trouble.empty()) all.push_back(std::move(trouble));
  }
  return all;
}

bool Sinks::failed() const {
  return std::any_of(lanes_.begin(), lanes_.end(), [](const auto& lane) { return lane->failed(); });
}

std::vector<std::string> Sinks::drop_images() {
  std::vector<std::string> names;
  std::erase_if(lanes_, [&](const auto& lane) {
    const bool dropped = lane->needs().images && !lane->failed();
    if (dropped) names.push_back(lane->name());
    return dropped;
  });
  return names;
}

void Sinks::finish() {
  for (const auto& lane : lanes_) lane->drain();
  if (slow_ == Slow::skipped) return;
  std::vector<std::string> whole;
  for (const auto& lane : lanes_) {
    if (!lane->failed()) whole.push_back(lane->name());
  }
  const auto add_what_is_whole = [&](const auto& lane) {
    if (!lane->ended_run() || whole.empty()) throw;
    throw Error("{}; the run ended there, and what was known until then is in {}", lane->trouble(), fmt::join(whole, ", "));
  };
  for (const auto& lane : lanes_) {
    try {
      lane->rethrow();
    } catch (const Error&) {  // what a program's own sink throws reaches it as it is
      add_what_is_whole(lane);
    } catch (const cv::Exception&) {  // memory that OpenCV did not get
      add_what_is_whole(lane);
    } catch (const std::bad_alloc&) {
      add_what_is_whole(lane);
    }
  }
}

}  // namespace marey::pipeline::corridor
