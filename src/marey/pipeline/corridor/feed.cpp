#include "marey/pipeline/corridor/feed.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/core/rig_sources.h"
#include "marey/core/source_name.h"
#include "marey/format/observations.h"
#include "marey/format/tracks/blob_file.h"
#include "marey/format/tracks/detections.h"
#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/source/open_source.h"
#include "marey/source/rates.h"
#include "marey/source/read_ahead.h"
#include "marey/source/region_source.h"

namespace marey::pipeline::corridor {
namespace {

constexpr double kObservationRate = 100;  // Hz; of observations of which nobody says it
constexpr double kJitter = 0.25;          // of a frame, by which times of files are rounded

cv::Rect within(const cv::Rect& region, cv::Size picture, const std::string& source) {
  if ((region & cv::Rect({}, picture)) == region && region.area() > 0) return region;
  throw Error("its region {}x{} at ({}, {}) is not within the pictures of {}x{} px of {}", region.width, region.height, region.x,
              region.y, picture.width, picture.height, source);
}

}  // namespace

std::string said_of(const RigCamera& camera, const std::string& sentence) {
  return camera.name.empty() ? sentence : fmt::format("camera \"{}\": {}", camera.name, sentence);
}

/// Ends the waiting for a silent camera when whoever opened the feed is asked to stop, or lets it go.
class Feed::Life {
 public:
  explicit Life(const std::stop_token& outer) : forward_(outer, [this] { end(); }) {}
  ~Life() { end(); }
  Life(const Life&) = delete;
  Life& operator=(const Life&) = delete;

  std::stop_token token() const { return ends_.get_token(); }
  void end() { ends_.request_stop(); }

 private:
  std::stop_source ends_;
  std::stop_callback<std::function<void()>> forward_;
};

class Feed::Input {
 public:
  virtual ~Input() = default;
  virtual const SourceInfo& info() const = 0;
  virtual std::optional<CameraFrame> next() = 0;
  virtual std::vector<std::string> warnings() const { return {}; }
};

class Feed::Pictures final : public Input {
 public:
  Pictures(std::unique_ptr<Source> source, int ahead) : source_(std::move(source)), ahead_(ahead) {}

  const SourceInfo& info() const override { return source_->info(); }
  std::vector<std::string> warnings() const override { return source_->warnings(); }
  std::optional<CameraFrame> next() override {
    if (ahead_ > 0) source_ = source::read_ahead(std::move(source_), std::exchange(ahead_, 0));
    auto frame = source_->next();
    if (!frame) return std::nullopt;
    return CameraFrame{.frame = std::move(*frame), .detections = {}};
  }

 private:
  std::unique_ptr<Source> source_;
  int ahead_;  // frames, once reading has begun; 0: done, or not wanted
};

class Feed::Nothing final : public Input {
 public:
  const SourceInfo& info() const override { return info_; }
  std::optional<CameraFrame> next() override { return std::nullopt; }

 private:
  SourceInfo info_;
};

/// What another program detected: boxes, or blobs.
template <typename Reader>
class Feed::Detected final : public Input {
 public:
  explicit Detected(Reader reader) : reader_(std::move(reader)) {}

  const SourceInfo& info() const override { return reader_.info(); }
  std::vector<std::string> warnings() const override { return reader_.warnings(); }
  std::optional<CameraFrame> next() override { return reader_.next(); }

 private:
  Reader reader_;
};

/// One file of observations, dealt out to the cameras' feeds.
class ObservationDeal {
 public:
  ObservationDeal(const std::string& path, const Rig& rig) : reader_(path, rig), waiting_(rig.cameras.size()) {}

  std::optional<double> rate_hz() const { return reader_.rate_hz(); }

  /// Cameras ask side by side, each for its own.
  std::optional<format::SeenFrame> next(std::size_t camera) {
    const std::lock_guard lock(dealing_);
    while (waiting_[camera].empty()) {
      if (stop_.stop_requested()) throw Stopped();
      const auto frame = reader_.next();
      if (!frame) return std::nullopt;
      for (std::size_t c = 0; c < waiting_.size(); ++c) {
        const auto part = frame->of(CameraId{static_cast<int>(c)});
        waiting_[c].push_back({.frame = frame->frame, .points = {part.begin(), part.end()}, .time = frame->time});
      }
    }
    format::SeenFrame first = std::move(waiting_[camera].front());
    waiting_[camera].pop_front();
    return first;
  }

 private:
  std::stop_token stop_ = StopScope::current();
  std::mutex dealing_;
  format::ObservationReader reader_;
  std::vector<std::deque<format::SeenFrame>> waiting_;
};

Detection blob_of(const format::SeenPoint& point) {
  Detection blob;
  blob.centre = point.pixel;
  if (point.sigma) blob.covariance = *point.sigma * *point.sigma * Matrix<2>::Identity();
  if (!point.area) return blob;
  const double side = std::sqrt(*point.area);  // of what had a shape once, the area was kept
  blob.area = *point.area;
  blob.box = {point.pixel.x() - side / 2, point.pixel.y() - side / 2, side, side};
  return blob;
}

class Feed::Observations final : public Input {
 public:
  /// `offset` is what is added to this camera's times afterwards.
  Observations(std::shared_ptr<ObservationDeal> deal, std::size_t camera, const std::string& name, double rate_hz, Duration offset)
      : deal_(std::move(deal)), camera_(camera), rate_hz_(rate_hz), offset_(offset) {
    info_.name = name;
    info_.rate_hz = rate_hz;
  }

  const SourceInfo& info() const override { return info_; }
  std::optional<CameraFrame> next() override {
    const auto seen = deal_->next(camera_);
    if (!seen) return std::nullopt;
    CameraFrame result;
    result.frame.index = seen->frame;
    result.frame.time = seen->time ? *seen->time - offset_ : timestamp_from_seconds(static_cast<double>(seen->frame) / rate_hz_);
    auto& detections = result.detections.emplace();
    for (const format::SeenPoint& point : seen->points) detections.push_back(blob_of(point));
    return result;
  }

 private:
  std::shared_ptr<ObservationDeal> deal_;
  std::size_t camera_;
  double rate_hz_;
  Duration offset_;
  SourceInfo info_;
};

namespace {

std::unique_ptr<Source> open_pictures(const RigCamera& camera, const FeedOptions& options) {
  if (!options.open && !scheme_of(camera.source).empty())
    throw Error("its source {} is live; run marey live, or name a recording in its place", shown_source(camera.source));
  auto source =
      options.open ? options.open() : source::open_source(camera.source, camera.rate_hz ? camera.rate_hz : options.rate_hz);
  if (!camera.region) return source;
  const cv::Rect region = within(*camera.region, source->info().size, camera.source);
  return source::crop(std::move(source), region);
}

}  // namespace

std::unique_ptr<Feed::Input> Feed::open_detections(const std::string& path, std::optional<double> rate_hz) {
  using namespace format::tracks;
  if (std::filesystem::is_regular_file(path) && is_blob_file(path))
    return std::make_unique<Detected<BlobReader>>(BlobReader(path, rate_hz));
  return std::make_unique<Detected<DetectionReader>>(DetectionReader(path, rate_hz));
}

Feed::Feed(const RigCamera& camera, CameraId id, const FeedOptions& options) : camera_(camera), id_(id), options_(options) {
  if (camera.source.empty() && camera.detections.empty()) {
    throw Error("camera \"{}\" has neither pictures nor detections; give it a source in the rig, or {}=FILE", camera.name,
                camera.name);
  }
  life_ = std::make_unique<Life>(options.stop);
  const StopScope scope(life_->token());
  try {
    if (camera.source.empty()) {
      input_ = open_detections(camera.detections, camera.rate_hz ? camera.rate_hz : options.rate_hz);
      return;
    }
    auto source = open_pictures(camera, options);
    fit_to_size(camera_, source->info().size);
    input_ = std::make_unique<Pictures>(std::move(source), options.ahead);
  } catch (const Error& error) {
    throw Error("{}", said_of(camera, error.what()));
  }
}

Feed::Feed(const RigCamera& camera, CameraId id, const FeedOptions& options, std::unique_ptr<Input> input)
    : camera_(camera), id_(id), options_(options), input_(std::move(input)) {}

Feed::~Feed() {
  if (life_ != nullptr) life_->end();
}

Feed::Feed(Feed&&) noexcept = default;
Feed& Feed::operator=(Feed&&) noexcept = default;

const SourceInfo& Feed::info() const {
  return live_ != nullptr ? live_info_ : input_->info();
}

double Feed::rate_hz() const {
  return info().rate_hz.value_or(kUsualRate);
}

std::string Feed::sound_source() const {
  const bool own_rate = !camera_.rate_hz && !options_.rate_hz;
  std::error_code error;
  return own_rate && std::filesystem::is_regular_file(camera_.source, error) ? camera_.source : std::string();
}

bool Feed::has_pictures() const {
  return is_live() || (!camera_.source.empty() && dynamic_cast<const Pictures*>(input_.get()) != nullptr);
}

Feed Feed::absent(const RigCamera& camera, CameraId id) {
  return {camera, id, {}, std::make_unique<Nothing>()};
}

Feed Feed::live(const RigCamera& camera, CameraId id, std::unique_ptr<LiveSource> source) {
  Feed feed(camera, id, {}, nullptr);
  feed.live_info_ = source->info();
  cv::Size& size = feed.live_info_.size;
  if (size.empty() && camera.size && !camera.region) source->take_only(*camera.size);
  try {
    if (camera.region && !size.empty()) within(*camera.region, size, feed.live_info_.name);
    if (camera.region) size = camera.region->size();
    if (!size.empty()) fit_to_size(feed.camera_, size);
  } catch (const Error& error) {
    throw Error("{}", said_of(camera, error.what()));
  }
  if (size.empty() && camera.size) size = *camera.size;
  if (camera.rate_hz) feed.live_info_.rate_hz = camera.rate_hz;
  feed.live_ = std::move(source);
  return feed;
}

void Feed::find(std::unique_ptr<detect::Detector> detector) {
  detector_ = std::move(detector);
}

std::optional<CameraFrame> Feed::next() {
  const Stopwatch decoding;
  auto result = input_->next();
  state_ = result ? FeedState::live : FeedState::ended;
  if (!result) return std::nullopt;
  result->decode_s = decoding.seconds();
  if (options_.steady_times) result->frame.time = timestamp_from_seconds(steady(seconds(result->frame.time)));
  CameraFrame given = by_rig_clock(std::move(*result));
  search(given);
  return given;
}

CameraFrame Feed::by_rig_clock(CameraFrame given) const {
  given.frame.camera = id_;
  given.frame.time += duration_from_seconds(camera_.offset_s.value_or(0));
  return given;
}

void Feed::search(CameraFrame& given) {
  if (given.detections && tuning_ != nullptr) leave_out_masked(*given.detections, tuning_->values().masks);
  if (detector_ == nullptr || given.detections) return;
  const Stopwatch detecting;
  detect::Detections found = detector_->detect(given.frame, {});
  if (found.searched) given.detections = std::move(found.detections);
  given.detect_s = detecting.seconds();
}

std::vector<CameraFrame> Feed::arrived(const source::LivePolicy& policy, bool all) {
  std::vector<CameraFrame> frames;
  for (CameraFrame& given : live_->arrived()) {
    Picture& picture = given.frame.picture;
    if (camera_.region && !picture.empty()) {
      if ((*camera_.region & cv::Rect({}, picture.size())) != *camera_.region) continue;
      picture = picture.part(*camera_.region);
    }
    frames.push_back(by_rig_clock(std::move(given)));
  }
  for (CameraFrame& given : frames) {
    if (all) search(given);
  }
  if (!frames.empty()) health_.saw_frame(policy.time->now(), policy);
  return frames;
}

/// Who says itself that it is gone is believed at once.
FeedState Feed::state(Timestamp begin, const source::LivePolicy& policy) const {
  if (live_->ended()) return FeedState::ended;
  const FeedState state = health_.at(policy.time->now(), begin, policy);
  const bool gives = state == FeedState::live || state == FeedState::back;
  return gives && !live_->connected() ? FeedState::stalled : state;
}

/// A file rounds its times, to milliseconds often: a camera that keeps its rate is believed more.
double Feed::steady(double time) {
  if (!first_s_) first_s_ = time;
  const double frames = (time - *first_s_) * rate_hz();
  return std::abs(frames - std::round(frames)) < kJitter ? *first_s_ + std::round(frames) / rate_hz() : time;
}

bool Feed::can_rewind() const {
  if (is_live()) return false;
  if (options_.open) return options_.opens_again;
  const std::string& path = camera_.source.empty() ? camera_.detections : camera_.source;
  std::error_code ignored;
  // A pattern of names is no file of that name, and can be read again like a folder.
  return std::filesystem::is_regular_file(path, ignored) || std::filesystem::is_directory(path, ignored) ||
         !std::filesystem::exists(path, ignored);
}

Feed Feed::again() const {
  if (can_rewind()) return {camera_, id_, options_};
  throw Error("{}", said_of(camera_, fmt::format("{} cannot be read a second time; record it to a file first", camera_.source)));
}

std::function<Feed()> Feed::opener() const {
  if (!can_rewind()) return {};
  return [camera = camera_, id = id_, options = options_] { return Feed(camera, id, options); };
}

std::vector<Frame> Feed::sample(int count, double seconds, int most_frames) const {
  if (!can_rewind()) return {};
  FeedOptions options = options_;
  options.ahead = 0;
  Feed feed(camera_, id_, options);
  const double span = std::min<double>(seconds * feed.rate_hz(), most_frames);
  const auto step = std::max<std::int64_t>(1, static_cast<std::int64_t>(span / count));
  std::vector<Frame> samples;
  while (std::ssize(samples) < count) {
    auto next = feed.next();
    if (options_.stop.stop_requested()) throw Stopped();
    if (!next) break;
    if (next->frame.index % step == 0) samples.push_back(std::move(next->frame));
  }
  return samples;
}

std::string Feed::rate_warning() const {
  if (!is_live() || !camera_.rate_hz) return {};
  const auto own = live_->info().rate_hz;
  if (!own || !source::differ(*own, *camera_.rate_hz)) return {};
  return said_of(camera_, fmt::format("the rig says rate = {0:g}, the camera {1:g} frames per second: {2}; set rate = {1:g} in the "
                                      "rig, or remove it",
                                      *camera_.rate_hz, *own,
                                      *own < *camera_.rate_hz ? "instants between its frames have none" : "frames are dropped"));
}

std::vector<std::string> Feed::warnings() const {
  std::vector<std::string> all;
  for (const std::string& warning : is_live() ? live_->warnings() : input_->warnings()) all.push_back(said_of(camera_, warning));
  if (std::string warning = rate_warning(); !warning.empty()) all.push_back(std::move(warning));
  if (detector_ == nullptr) return all;
  for (const std::string& warning : detector_->warnings()) all.push_back(said_of(camera_, info().name + ": " + warning));
  return all;
}

std::vector<Feed> open_feeds(const Rig& rig, const FeedOptions& options, bool allow_absent) {
  const auto gives = [](const RigCamera& camera) { return !camera.source.empty() || !camera.detections.empty(); };
  if (allow_absent && std::none_of(rig.cameras.begin(), rig.cameras.end(), gives)) {
    throw Error("{}", "no camera of the rig has a source; name them in the rig, or give CAMERA=VIDEO or --observations");
  }
  std::vector<std::optional<Feed>> opened(rig.cameras.size());
  tbb::parallel_for(std::size_t{0}, opened.size(), [&](std::size_t i) {
    const RigCamera& camera = rig.cameras[i];
    const CameraId id{static_cast<int>(i)};
    opened[i] = allow_absent && !gives(camera) ? Feed::absent(camera, id) : Feed(camera, id, options);
  });
  std::vector<Feed> feeds;
  for (auto& feed : opened) feeds.push_back(std::move(*feed));
  return feeds;
}

std::vector<Feed> open_observations(const std::string& path, const Rig& rig, std::optional<double> rate_hz) {
  const auto deal = std::make_shared<ObservationDeal>(path, rig);
  std::vector<Feed> feeds;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const RigCamera& camera = rig.cameras[c];
    const double rate = deal->rate_hz().value_or(camera.rate_hz.value_or(rate_hz.value_or(kObservationRate)));
    const Duration offset = duration_from_seconds(camera.offset_s.value_or(0));
    feeds.push_back(
        Feed(camera, CameraId{static_cast<int>(c)}, {}, std::make_unique<Feed::Observations>(deal, c, path, rate, offset)));
  }
  return feeds;
}

}  // namespace marey::pipeline::corridor
