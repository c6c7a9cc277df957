#include "marey/pipeline/live/camera_node.h"

#include <algorithm>
#include <mutex>
#include <random>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/draw/jpeg.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/live/camera_settings.h"
#include "marey/pipeline/live/live_feeds.h"

namespace marey::pipeline::live {
namespace {

using source::live::Control;
using source::live::NodeAnswer;
using source::live::NodeControls;
using source::live::NodeFrame;
using source::live::NodeQuestion;
using source::live::NodeServer;

/// What hosts are reported of the cameras: each as its frames are, which come with its region and by its own clock.
class AdvertisedCameras {
 public:
  explicit AdvertisedCameras(const Rig& rig, std::shared_ptr<source::LiveTime> time)
      : session_((static_cast<std::uint64_t>(std::random_device{}()) << 32) | std::random_device{}()),
        time_(std::move(time)),
        rig_(rig) {}

  std::uint64_t session() const { return session_; }

  Rig rig() const {
    const std::lock_guard lock(mutex_);
    return rig_;
  }

  void inspect_at(const std::vector<corridor::Feed>& feeds) {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < feeds.size(); ++i) {
      RigCamera& reported = rig_.cameras[i];
      const auto offset_s = reported.offset_s;
      reported = feeds[i].camera();
      reported.offset_s = offset_s;
      reported.source.clear();
      reported.region.reset();
      if (const cv::Size size = feeds[i].info().size; !size.empty()) reported.size = size;
      if (feeds[i].info().rate_hz) reported.rate_hz = feeds[i].info().rate_hz;
    }
  }

  NodeAnswer answer(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    NodeAnswer answer{.session = session_, .now = time_->now(), .size = {}, .rate_hz = {}, .cameras = {}};
    for (const RigCamera& camera : rig_.cameras) {
      answer.cameras.push_back(camera.name);
      if (camera.name != name) continue;
      answer.known = true;
      answer.size = camera.size.value_or(cv::Size());
      answer.rate_hz = camera.rate_hz;
    }
    return answer;
  }

 private:
  const std::uint64_t session_;
  const std::shared_ptr<source::LiveTime> time_;
  mutable std::mutex mutex_;
  Rig rig_;
};

/// What hosts set of the cameras.
class ControlRequests {
 public:
  ControlRequests(const Rig& rig, const NodeOptions& options, std::uint64_t session)
      : camera_settings_(rig, options.markers.threshold),
        allowed_(options.allow_control),
        finds_(!options.quality),
        session_(session) {
    for (const RigCamera& camera : rig.cameras) names_.push_back(camera.name);
  }

  CameraSettings& camera_settings() { return camera_settings_; }

  std::optional<NodeControls> listen(const NodeQuestion& question) {
    const auto at = std::find(names_.begin(), names_.end(), question.camera);
    if (at == names_.end()) return std::nullopt;
    const auto index = static_cast<std::size_t>(at - names_.begin());
    source::live::CameraControls& controls = *camera_settings_.controls(index);
    NodeControls stated{.session = session_, .allowed = allowed_, .waits = false, .has = {}, .refused = {}};
    if (question.request && allowed_) stated.refused = set(index, *question.request);
    // Of a threshold that is known at once; what was refused before it is another matter.
    const bool of_camera = !question.request || question.request->control != Control::threshold;
    if (of_camera) stated.refused = controls.refused();
    stated.waits = controls.waits();
    stated.has = controls.has();
    if (finds_) {
      const auto threshold = camera_settings_.camera(index).markers.threshold;
      stated.has.push_back({Control::threshold, 0, CameraSettings::kBrightest, threshold.value_or(0)});
    }
    return stated;
  }

 private:
  /// Why it cannot be, as far as that is known at once.
  std::string set(std::size_t index, const NodeQuestion::ControlRequest& request) {
    if (request.control != Control::threshold) {
      camera_settings_.controls(index)->request(request.control, request.value);
      return "";
    }
    try {
      camera_settings_.set_threshold(index, request.value > 0 ? std::optional(request.value) : std::nullopt);
      return "";
    } catch (const Error& error) {
      const std::string why = error.what(), begin = names_[index] + ": ";
      return why.starts_with(begin) ? why.substr(begin.size()) : why;
    }
  }

  CameraSettings camera_settings_;
  std::vector<std::string> names_;
  bool allowed_, finds_;
  std::uint64_t session_;
};

/// One camera's messages.
class Outgoing {
 public:
  explicit Outgoing(std::uint64_t session) : session_(session) {}

  /// Of what has come since the last call.
  void take(corridor::Feed& feed, const source::LivePolicy& policy, std::optional<int> quality) {
    messages_.clear();
    for (CameraFrame& given : feed.arrived(policy)) {
      const Frame& frame = given.frame;
      NodeFrame sent{.session = session_, .sequence = sent_++, .taken = frame.time, .size = frame.image.size(), .detections = {}};
      std::string jpeg;
      if (given.detections) {
        sent.detections = std::move(given.detections);
      } else {
        jpeg = encoder_.encode(frame.image, frame.image.size().width, quality.value_or(draw::JpegEncoder::kToBeObserved));
        sent.jpeg = {reinterpret_cast<const std::uint8_t*>(jpeg.data()), jpeg.size()};
      }
      messages_.push_back(message_of(sent));
    }
  }

  const std::vector<std::string>& messages() const { return messages_; }
  std::int64_t sent() const { return sent_; }

 private:
  std::uint64_t session_;
  std::int64_t sent_ = 0;
  draw::JpegEncoder encoder_;
  std::vector<std::string> messages_;
};

/// Times go out by the cameras' own clocks: what the rig adds to them is for the host to add.
Rig without_offsets(Rig rig) {
  for (RigCamera& camera : rig.cameras) camera.offset_s.reset();
  return rig;
}

std::vector<NodeSummary::Camera> cameras_of(const std::vector<corridor::Feed>& feeds,
                                            const std::vector<std::unique_ptr<Outgoing>>& outgoing,
                                            const source::LivePolicy& policy) {
  std::vector<NodeSummary::Camera> cameras;
  for (std::size_t i = 0; i < feeds.size(); ++i)
    cameras.push_back({.health = feeds[i].health(Timestamp{}, policy), .sent = outgoing[i]->sent()});
  return cameras;
}

}  // namespace

NodeSummary serve_cameras(const Rig& rig, const NodeOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  const source::LivePolicy policy{.time = source::steady_time()};
  AdvertisedCameras advertised(rig, policy.time);
  ControlRequests wishes(rig, options, advertised.session());
  std::vector<corridor::Feed> feeds = open_live_feeds(without_offsets(rig), policy, options.patience_s, &wishes.camera_settings());
  advertised.inspect_at(feeds);
  std::vector<std::unique_ptr<Outgoing>> outgoing;
  for (std::size_t i = 0; i < feeds.size(); ++i) {
    if (!options.quality)
      feeds[i].find(std::make_unique<corridor::TunedMarkers>(options.markers, wishes.camera_settings().tuning(i)));
    outgoing.push_back(std::make_unique<Outgoing>(advertised.session()));
  }
  NodeServer server(
      options.address, options.port, [&](const std::string& camera) { return advertised.answer(camera); },
      [&] { return format::rig::rig_text(advertised.rig()); },
      [&](const NodeQuestion& question) { return wishes.listen(question); });
  if (options.begun) options.begun(advertised.rig());
  NodeSummary summary;
  std::int64_t frames = 0;
  const auto ended = [&] {
    return std::all_of(feeds.begin(), feeds.end(), [](const corridor::Feed& feed) { return feed.has_ended(); });
  };
  const auto over = [&] { return options.for_s && seconds(policy.time->now()) >= *options.for_s; };
  while (hooks.report({"sending", frames, {}}) == Continue::yes && !ended() && !over()) {
    tbb::parallel_for(std::size_t{0}, feeds.size(), [&](std::size_t i) { outgoing[i]->take(feeds[i], policy, options.quality); });
    bool any = false;
    for (std::size_t i = 0; i < feeds.size(); ++i) {
      for (const std::string& message : outgoing[i]->messages()) {
        server.send(feeds[i].camera().name, message);
        summary.bytes += std::ssize(message);
        ++frames;
        any = true;
      }
    }
    advertised.inspect_at(feeds);
    if (!any) policy.time->wait();
  }
  summary.seconds = seconds(policy.time->now());
  summary.cameras = cameras_of(feeds, outgoing, policy);
  return summary;
}

}  // namespace marey::pipeline::live
