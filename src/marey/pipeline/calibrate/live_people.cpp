#include "marey/pipeline/calibrate/live_people.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/calibrate/people/people_coverage.h"
#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/files/source_name.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/live/camera_videos.h"
#include "marey/pipeline/live/live_feeds.h"

namespace marey::pipeline::calibrate {
namespace {

using marey::calibrate::people::PeopleCoverage;

constexpr double kVisible = 0.5;  // by definition: more likely seen than not

/// Searches the cameras' newest images for people on a thread of its own, as fast as that goes, and counts its views.
class PeopleWatch {
 public:
  PeopleWatch(const LivePeopleOptions& options, std::size_t cameras)
      : search_(keypoint_set_named("blazepose"), cameras,
                options.find_people ? options.find_people : keypoints::people_finder(options.detector),
                options.find_bodies ? options.find_bodies : keypoints::body_finder(options.model)),
        counted_(cameras),
        given_(cameras),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}

  /// A camera's newest frame; one that was given before and not taken yet is forgotten.
  void take(const Frame& frame) {
    const std::lock_guard lock(mutex_);
    given_[static_cast<std::size_t>(number(frame.camera))] = frame;
    came_.notify_one();
  }

  struct State {
    PeopleCoverage coverage;
    Instant now;
  };
  /// The result so far. Throws what the search threw.
  State state() const {
    const std::lock_guard lock(mutex_);
    if (failed_) std::rethrow_exception(failed_);
    return {counted_, now_};
  }

 private:
  void run(const std::stop_token& stop) {
    try {
      while (!stop.stop_requested()) {
        std::vector<std::optional<Frame>> frames(given_.size());
        {
          std::unique_lock lock(mutex_);
          const auto any = [&] {
            return std::any_of(given_.begin(), given_.end(), [](const auto& frame) { return frame.has_value(); });
          };
          if (!came_.wait(lock, stop, any)) return;
          std::swap(frames, given_);
        }
        inspect(frames);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failed_ = std::current_exception();
    }
  }

  void inspect(const std::vector<std::optional<Frame>>& frames) {
    std::vector<Image> images;
    Timestamp now{};
    for (const auto& frame : frames) {
      images.push_back(frame ? frame->image : Image());
      if (frame) now = std::max(now, frame->time);
    }
    search_.step(images, now);
    std::vector<PeopleCoverage::View> seen(frames.size());
    Instant instant;
    instant.index = steps_++;
    instant.time = now;
    for (std::size_t c = 0; c < frames.size(); ++c) {
      if (!frames[c]) continue;
      const auto& people = search_[c].people();
      for (std::size_t i = 0; i < people.size(); ++i) search_[c].located(i, now);  // nothing says yet that they are not there
      seen[c] = {people, frames[c]->image.size()};
      instant.frames.push_back(*frames[c]);
      report(people, CameraId{static_cast<int>(c)}, instant);
    }
    const std::lock_guard lock(mutex_);
    counted_.add(seen);
    now_ = std::move(instant);
  }

  static void report(std::span<const Keypoints<2>> people, CameraId camera, Instant& instant) {
    for (std::size_t i = 0; i < people.size(); ++i) {
      for (const auto& point : people[i].points) {
        if (!point || point->visibility < kVisible) continue;
        ImageObservation& detected = instant.detected.emplace_back();
        detected.camera = camera;
        detected.pixel = point->position;
        detected.track = TrackId{static_cast<int>(i) + 1};
      }
    }
  }

  keypoints::ImagesWithPeople search_;  // the thread's alone
  std::int64_t steps_ = 0;              // likewise
  mutable std::mutex mutex_;            // for what follows
  std::condition_variable_any came_;
  PeopleCoverage counted_;
  std::vector<std::optional<Frame>> given_;
  Instant now_;
  std::exception_ptr failed_;
  std::jthread thread_;  // last: it uses all of them
};

bool has_phones(const Rig& rig) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(),
                     [](const RigCamera& camera) { return scheme_of(camera.source) == "phone"; });
}

/// All cameras' new frames: into the videos, and to those who watch.
std::int64_t keep_frames(std::span<corridor::Feed> feeds, const source::LivePolicy& policy, live::CameraVideos& videos,
                         PeopleWatch& watch, std::vector<std::vector<double>>& times_s) {
  std::int64_t kept = 0;
  for (std::size_t c = 0; c < feeds.size(); ++c) {
    for (CameraFrame& given : feeds[c].arrived(policy)) {
      if (given.frame.image.empty()) continue;
      const double time_s = seconds(given.frame.time);
      if (!times_s[c].empty() && time_s <= times_s[c].back()) continue;
      times_s[c].push_back(time_s);
      Instant instant;
      instant.time = given.frame.time;
      instant.frames.push_back(given.frame);
      videos.write(instant);
      watch.take(given.frame);
      ++kept;
    }
  }
  return kept;
}

/// Frames a second of a camera that may lose some: steps are whole numbers of the median one.
std::optional<double> rate_of(std::span<const double> times_s) {
  if (times_s.size() < 2) return std::nullopt;
  std::vector<double> steps;
  for (std::size_t k = 1; k < times_s.size(); ++k) steps.push_back(times_s[k] - times_s[k - 1]);
  const double one = geometry::median(std::vector(steps));
  double frames = 0;
  for (const double step : steps) frames += std::max(1.0, std::round(step / one));
  return frames / (times_s.back() - times_s.front());
}

/// The rig of the videos.
RecordedPeople recorded(Rig rig, const std::string& folder, std::vector<std::vector<double>> times_s) {
  std::vector<std::string> without;
  double begin = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < times_s.size(); ++c) {
    if (times_s[c].empty())
      without.push_back(rig.cameras[c].name);
    else
      begin = std::min(begin, times_s[c].front());
  }
  if (!without.empty()) throw Error("{} gave no image", fmt::join(without, ", "));
  const std::vector<std::string> files = live::CameraVideos::files_of(folder, rig);  // the rig's own first
  for (std::size_t c = 0; c < times_s.size(); ++c) {
    RigCamera& camera = rig.cameras[c];
    camera.source = files[c + 1];
    camera.region.reset();
    camera.offset_s = times_s[c].front() - begin;
    if (const auto rate_hz = rate_of(times_s[c])) camera.rate_hz = rate_hz;
  }
  return {std::move(rig), std::move(times_s), {}};
}

}  // namespace

KeypointSequence by_times(KeypointSequence sequence, std::span<const double> times_s, double rate_hz) {
  std::vector<std::vector<Keypoints<2>>> frames;
  for (std::size_t k = 0; k < std::min(sequence.frames.size(), times_s.size()); ++k) {
    const auto at = static_cast<std::size_t>(std::llround((times_s[k] - times_s.front()) * rate_hz));
    if (at >= frames.size()) frames.resize(at + 1);
    frames[at] = std::move(sequence.frames[k]);
  }
  sequence.frames = std::move(frames);
  sequence.rate_hz = rate_hz;
  return sequence;
}

RecordedPeople record_people(Rig rig, const LivePeopleOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  const source::LivePolicy policy{.time = source::steady_time()};
  live::CameraSettings as_rig_says(rig, std::nullopt);
  live::CameraSettings& camera_settings = options.camera_settings != nullptr ? *options.camera_settings : as_rig_says;
  PeopleWatch watch(options, rig.cameras.size());
  std::vector<corridor::Feed> feeds = live::open_live_feeds(rig, policy, options.patience_s, &camera_settings);
  live::CameraVideos videos(options.folder, std::make_shared<corridor::RecordSwitch>(true));
  std::vector<std::vector<double>> times_s(feeds.size());
  std::vector<std::string> names, missing;
  for (const RigCamera& camera : rig.cameras) names.push_back(camera.name);
  const double begin = seconds(policy.time->now()), wait_s = has_phones(rig) ? options.walk_s : 2 * options.patience_s;
  std::optional<double> first;
  double inspected = begin;
  std::int64_t frames = 0;
  const auto begin_videos = [&] {
    RecordingHeader header;
    enter_cameras(rig, feeds);
    header.rig = rig;
    videos.begin(header);
  };
  while (true) {
    if (!first && std::any_of(feeds.begin(), feeds.end(), [](const corridor::Feed& feed) { return feed.health().frames > 0; })) {
      begin_videos();
      first = seconds(policy.time->now());
    }
    if (first) frames += keep_frames(feeds, policy, videos, watch, times_s);
    hooks.advance({"watching people", frames, std::nullopt});
    const double now = seconds(policy.time->now());
    if (!first && now - begin > wait_s) throw Error("{}", why_nothing_came(feeds));
    if (now - inspected >= kInspectEvery) {
      inspected = now;
      PeopleWatch::State state = watch.state();
      LiveObserved observed = observed_so_far(state.coverage.images(), feeds, policy);
      observed.seconds = first ? now - *first : 0;
      observed.now = std::move(state.now);
      observed.missing = missing = state.coverage.missing(names);
      if ((options.walking && !options.walking(observed)) || observed.enough) break;
    }
    if (first && now - *first >= options.walk_s) break;
    if (std::all_of(feeds.begin(), feeds.end(), [](const corridor::Feed& feed) { return feed.has_ended(); })) break;
    policy.time->wait();
  }
  if (!first) throw Error("{}", why_nothing_came(feeds));
  enter_cameras(rig, feeds);
  videos.finish();
  if (options.walked) options.walked();
  RecordedPeople result = recorded(std::move(rig), options.folder, std::move(times_s));
  result.missing = std::move(missing);
  return result;
}

}  // namespace marey::pipeline::calibrate
