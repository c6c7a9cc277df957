#include "marey/pipeline/corridor/live_monitor.h"

#include <algorithm>
#include <utility>

namespace marey::pipeline::corridor {
namespace {

constexpr double kReported = 0.25;  // s between two reports
constexpr double kMeasured = 1;     // s over which rates are counted
constexpr std::ptrdiff_t kNewsKept = 10;
constexpr double kWindow = 5;  // s of latencies: those of the window before are shown until the next one is full

Summary::StepTime step_of(const char* name, const StageTimes& times) {
  return {name, times.count(), times.quantile(0.5), times.quantile(0.99)};
}

}  // namespace

LiveMonitor::LiveMonitor(std::shared_ptr<source::LiveTime> time, Notify notify)
    : time_(std::move(time)), notify_(std::move(notify)), begin_(time_->now()) {}

void LiveMonitor::watch(const Clock& clock, const Sinks& sinks) {
  clock_ = &clock;
  sinks_ = &sinks;
  const std::size_t cameras = clock.feeds().size();
  rates_.assign(cameras, 0);
  frames_.assign(cameras, 0);
  detections_.assign(cameras, 0);
  states_.assign(cameras, FeedState::connecting);
}

void LiveMonitor::observed(const FrameSet& frames, std::span<const Instant> instants, Timestamp given, Timestamp done) {
  grouping_.add(seconds(given - frames.time));
  solving_.add(seconds(done - given));
  all_.add(seconds(done - frames.time));
  recent_.add(seconds(done - frames.time));
  instants_ += std::ssize(instants);
  if (!instants.empty()) targets_ = std::ssize(instants.back().samples);
  std::fill(detections_.begin(), detections_.end(), 0);
  for (std::size_t i = 0; i < frames.cameras.size(); ++i) {
    if (frames.cameras[i] && frames.cameras[i]->detections) detections_[i] = std::ssize(*frames.cameras[i]->detections);
  }
  if (!instants.empty() && std::none_of(frames.cameras.begin(), frames.cameras.end(),
                                        [](const auto& camera) { return camera && camera->detections.has_value(); })) {
    for (const ImageObservation& detected : instants.back().detected)
      ++detections_[static_cast<std::size_t>(number(detected.camera))];
  }
  tick();
}

void LiveMonitor::received(const std::vector<std::string>& news) {
  if (news.empty()) return;
  news_count_ += std::ssize(news);
  news_.insert(news_.end(), news.begin(), news.end());
  if (std::ssize(news_) > kNewsKept) news_.erase(news_.begin(), news_.end() - kNewsKept);
}

void LiveMonitor::tick() {
  const Timestamp now = time_->now();
  if (!window_ || seconds(now - *window_) >= kWindow) {
    if (window_) before_ = std::exchange(recent_, {});
    window_ = now;
  }
  if (!measured_ || seconds(now - *measured_) >= kMeasured) measure_rates(now);
  if (!notify_ || (reported_ && seconds(now - *reported_) < kReported)) return;
  reported_ = now;
  notify_(status());
}

void LiveMonitor::measure_rates(Timestamp now) {
  const double elapsed = measured_ ? seconds(now - *measured_) : 0;
  measured_ = now;
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    const std::int64_t frames = clock_->feeds()[i].health().frames;
    if (elapsed > 0) rates_[i] = static_cast<double>(frames - frames_[i]) / elapsed;
    frames_[i] = frames;
  }
}

LiveStatus LiveMonitor::status() const {
  LiveStatus status;
  status.seconds = seconds(time_->now() - begin_);
  const std::vector<FeedState> states = clock_->states();
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    CameraHealth& camera = status.cameras.emplace_back(clock_->feeds()[i].health());
    camera.state = states[i];
    camera.rate_hz = rates_[i] > 0 ? std::optional(rates_[i]) : std::nullopt;
    camera.missed = clock_->missed(i);
    camera.detections = detections_[i];
  }
  status.drops = clock_->drops().value_or(LiveDrops{});
  status.instants = instants_;
  status.targets = targets_;
  const StageTimes& latest = before_.count() > 0 ? before_ : recent_;
  if (latest.count() > 0) {
    status.latency_median_s = latest.quantile(0.5);
    status.latency_p99_s = latest.quantile(0.99);
  }
  status.recording = recording_ && recording_();
  status.troubles = sinks_->troubles();
  status.news = news_;
  status.news_count = news_count_;
  for (const Feed& feed : clock_->feeds()) {
    if (std::string warning = feed.rate_warning(); !warning.empty()) status.troubles.push_back(std::move(warning));
  }
  return status;
}

std::vector<Summary::StepTime> LiveMonitor::steps() const {
  return {step_of("capture to group", grouping_), step_of("group to instant", solving_), step_of("capture to instant", all_)};
}

}  // namespace marey::pipeline::corridor
