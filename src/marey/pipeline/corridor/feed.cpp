#include "marey/pipeline/corridor/feed.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/core/rig_sources.h"
#include "marey/files/source_name.h"
#include "marey/pipeline/corridor/feed_input.h"
#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/source/open_source.h"
#include "marey/source/region_source.h"

namespace marey::pipeline::corridor {
namespace {

constexpr double kJitter = 0.25;  // of a frame, by which times of files are rounded

}  // namespace

void check_region(const cv::Rect& region, cv::Size size, const std::string& source) {
  if ((region & cv::Rect({}, size)) == region && region.area() > 0) return;
  throw Error("its region {}x{} at ({}, {}) is not within the images of {}x{} px of {}", region.width, region.height, region.x,
              region.y, size.width, size.height, source);
}

std::string stated_of(const RigCamera& camera, const std::string& message_text) {
  return camera.name.empty() || message_text.starts_with("camera \"") ? message_text
                                                                      : fmt::format("camera \"{}\": {}", camera.name, message_text);
}

/// Ends the waiting for a silent camera when the one who opened the feed is asked to stop, or lets it go.
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

namespace {

std::unique_ptr<Source> open_images(const RigCamera& camera, const FeedOptions& options) {
  if (!options.open && !scheme_of(camera.source).empty())
    throw Error("its source {} is live; run marey live, or name a recording in its place", shown_source(camera.source));
  auto source =
      options.open ? options.open() : source::open_source(camera.source, camera.rate_hz ? camera.rate_hz : options.rate_hz);
  if (!camera.region) return source;
  check_region(*camera.region, source->info().size, camera.source);
  return source::crop(std::move(source), *camera.region);
}

}  // namespace

Feed::Feed(const RigCamera& camera, CameraId id, const FeedOptions& options) : camera_(camera), id_(id), options_(options) {
  if (camera.source.empty() && camera.detections.empty()) {
    throw Error("camera \"{}\" has neither images nor detections; give it a source in the rig, or {}=FILE", camera.name,
                camera.name);
  }
  life_ = std::make_unique<Life>(options.stop);
  const StopScope scope(life_->token());
  try {
    if (camera.source.empty()) {
      input_ = detection_input(camera.detections, camera.rate_hz ? camera.rate_hz : options.rate_hz);
      return;
    }
    auto source = open_images(camera, options);
    fit_to_size(camera_, source->info().size);
    input_ = image_input(std::move(source), options.ahead);
  } catch (const Error& error) {
    throw Error("{}", stated_of(camera, error.what()));
  }
}

Feed::Feed(const RigCamera& camera, CameraId id, const FeedOptions& options, std::unique_ptr<FeedInput> input)
    : camera_(camera), id_(id), options_(options), input_(std::move(input)) {}

Feed::~Feed() {
  if (life_ != nullptr) life_->end();
}

Feed::Feed(Feed&&) noexcept = default;
Feed& Feed::operator=(Feed&&) noexcept = default;

const SourceInfo& Feed::info() const {
  return input_->info();
}

double Feed::rate_hz() const {
  return info().rate_hz.value_or(kDefaultRate);
}

std::string Feed::sound_source() const {
  const bool own_rate = !camera_.rate_hz && !options_.rate_hz;
  std::error_code error;
  return own_rate && std::filesystem::is_regular_file(camera_.source, error) ? camera_.source : std::string();
}

bool Feed::has_images() const {
  return input_->has_images();
}

Feed Feed::absent(const RigCamera& camera, CameraId id) {
  return {camera, id, {}, empty_input()};
}

Feed Feed::live(const RigCamera& camera, CameraId id, std::unique_ptr<LiveSource> source) {
  Feed feed(camera, id, {}, nullptr);
  try {
    feed.input_ = live_input(feed.camera_, std::move(source));
  } catch (const Error& error) {
    throw Error("{}", stated_of(camera, error.what()));
  }
  return feed;
}

bool Feed::is_live() const {
  return input_->is_live();
}

bool Feed::is_connected() const {
  return input_->is_connected();
}

bool Feed::has_ended() const {
  return state_ == FeedState::ended || input_->has_ended();
}

CameraHealth Feed::health() const {
  CameraHealth health = input_->health();
  health.name = camera_.name;
  return health;
}

CameraHealth Feed::health(Timestamp begin, const source::LivePolicy& policy) const {
  CameraHealth health = this->health();
  health.state = state(begin, policy);
  return health;
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
  if (options_.steady_times) result->frame.time = timestamp_from_seconds(stabilise(seconds(result->frame.time)));
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
  if (given.detections && tuning_ != nullptr) exclude_masked(*given.detections, tuning_->values().masks);
  if (detector_ == nullptr || given.detections) return;
  const Stopwatch detecting;
  detect::Detections found = detector_->detect(given.frame, {});
  if (found.searched) given.detections = std::move(found.detections);
  given.detect_s = detecting.seconds();
}

std::vector<CameraFrame> Feed::arrived(const source::LivePolicy& policy, bool all) {
  std::vector<CameraFrame> frames;
  for (CameraFrame& given : input_->arrived(policy)) frames.push_back(by_rig_clock(std::move(given)));
  for (CameraFrame& given : frames) {
    if (all) search(given);
  }
  return frames;
}

FeedState Feed::state(Timestamp begin, const source::LivePolicy& policy) const {
  return input_->live_state(begin, policy).value_or(state_);
}

/// A file rounds its times, to milliseconds often: a camera that keeps its rate is trusted more.
double Feed::stabilise(double time) {
  if (!first_s_) first_s_ = time;
  const double frames = (time - *first_s_) * rate_hz();
  return std::abs(frames - std::round(frames)) < kJitter ? *first_s_ + std::round(frames) / rate_hz() : time;
}

bool Feed::can_rewind() const {
  if (is_live()) return false;
  if (options_.open) return options_.opens_again;
  const std::string& path = camera_.source.empty() ? camera_.detections : camera_.source;
  std::error_code ignored;
  // A pattern of names is not a file of that name, and can be read again like a folder.
  return std::filesystem::is_regular_file(path, ignored) || std::filesystem::is_directory(path, ignored) ||
         !std::filesystem::exists(path, ignored);
}

Feed Feed::again() const {
  if (can_rewind()) return {camera_, id_, options_};
  throw Error("{}", stated_of(camera_, fmt::format("{} cannot be read a second time; record it to a file first", camera_.source)));
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
  const std::string warning = input_->rate_warning();
  return warning.empty() ? warning : stated_of(camera_, warning);
}

std::vector<std::string> Feed::warnings() const {
  std::vector<std::string> all;
  for (const std::string& warning : input_->warnings()) all.push_back(stated_of(camera_, warning));
  if (std::string warning = rate_warning(); !warning.empty()) all.push_back(std::move(warning));
  if (detector_ == nullptr) return all;
  for (const std::string& warning : detector_->warnings()) all.push_back(stated_of(camera_, info().name + ": " + warning));
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

Rig rig_as_fed(const Rig& rig, const std::vector<Feed>& feeds) {
  Rig fed = rig;
  for (std::size_t i = 0; i < feeds.size(); ++i) fed.cameras[i] = feeds[i].camera();
  return fed;
}

std::vector<Feed> open_observations(const std::string& path, const Rig& rig, std::optional<double> rate_hz) {
  std::vector<std::unique_ptr<FeedInput>> inputs = observation_inputs(path, rig, rate_hz);
  std::vector<Feed> feeds;
  for (std::size_t c = 0; c < inputs.size(); ++c)
    feeds.push_back(Feed(rig.cameras[c], CameraId{static_cast<int>(c)}, {}, std::move(inputs[c])));
  return feeds;
}

}  // namespace marey::pipeline::corridor
