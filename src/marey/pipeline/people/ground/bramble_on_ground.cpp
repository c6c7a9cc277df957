#include "marey/pipeline/people/ground/bramble_on_ground.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/detect/blobs/foreground_evidence.h"
#include "marey/pipeline/corridor/parallel_tasks.h"
#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/pipeline/people/ground/ball_in_view.h"
#include "marey/pipeline/people/ground/ground_cameras.h"
#include "marey/pipeline/people/ground/ground_second_pass.h"
#include "marey/pipeline/people/ground/ground_stage.h"
#include "marey/pipeline/people/ground/people_in_view.h"
#include "marey/pipeline/people/view_ambiguities.h"
#include "marey/track/bramble/bramble_tracker.h"
#include "marey/track/ground/offline/ground_recorder.h"

namespace marey::pipeline::people::ground {
namespace {

/// Evidence comes from images, through calibrated cameras that are static.
void check_for_bramble(const RigCamera& camera, const GroundView& view, bool images, bool ptz) {
  if (!images) throw Error("camera \"{}\" brings detections; bramble looks at images", camera.name);
  if (ptz) throw Error("camera \"{}\" is a PTZ camera, and bramble needs static ones", camera.name);
  if (view.camera() == nullptr)
    throw Error("camera \"{}\" is known by ground_from_image alone; bramble must know how tall people are seen: calibrate it",
                camera.name);
}

/// How far apart a grid's points are, px, of which a person spans about twelve rows: most do.
int grid_step(const GroundView& view, const reconstruct::GroundArea& area) {
  constexpr int every = 24, rows = 12, minimum = 2, maximum = 8;  // px, points, px, px
  std::vector<double> heights;
  for (int y = 0; y < view.size().height; y += every) {
    for (int x = 0; x < view.size().width; x += every) {
      const auto location = view.location({static_cast<double>(x), static_cast<double>(y)});
      if (!location || !area.holds(location->ground, kBeyondArea)) continue;
      const auto box = person_at(view, location->ground);
      if (box && box->height >= kMinBodyHeight) heights.push_back(box->height);
    }
  }
  if (heights.empty()) return maximum;
  const auto quarter = heights.begin() + std::ssize(heights) / 4;
  std::nth_element(heights.begin(), quarter, heights.end());
  return std::clamp(static_cast<int>(std::lround(*quarter / rows)), minimum, maximum);
}

/// One camera: its evidence, in the part of its image where people may appear.
class BrambleCamera {
 public:
  BrambleCamera(const corridor::Feed& feed, const GroundView& view, const reconstruct::GroundArea& area,
                const PeopleOnGroundOptions& options)
      : name_(feed.camera().name),
        id_(feed.id()),
        part_(part_with_people(view, area)),
        model_({.step = grid_step(view, area)}),
        view_ambiguities_(feed.camera(), options.stabilise) {
    if (options.ball) ball_.emplace(id_, view, area, options.ball->detector);
    if (options.live) return;
    std::vector<Frame> samples = feed.sample_beginning();
    corridor::ParallelTasks parallel;
    parallel.run([this, samples] { view_ambiguities_.inspect_at_beginning(samples); });
    if (ball_) parallel.run([this, samples] { ball_->prime(samples); });
    for (Frame& frame : samples) frame.image = frame.image.part(part_);
    model_.prime(samples);
  }

  track::bramble::CameraEvidence observe(const Frame& frame) {
    ++frames_;
    corridor::ParallelTasks parallel;
    parallel.run([this, &frame] { view_ambiguities_.add(frame); });
    Frame searched = frame;
    searched.image = frame.image.part(part_);
    track::bramble::CameraEvidence observed{id_, frame.time, in_whole_image(model_.of(searched))};
    parallel.wait();
    if (ball_) ball_->search(frame, {});
    return observed;
  }

  std::optional<track::ball::BallView> ball() const { return ball_ ? ball_->candidates() : std::nullopt; }
  std::vector<std::string> news() { return view_ambiguities_.news(); }

  void report(corridor::Summary& summary) const {
    corridor::Summary::Camera& counts = summary.cameras.emplace_back();
    counts.name = name_;
    counts.frames = frames_;
    counts.missed = summary.frames - frames_;
    for (std::string& warning : view_ambiguities_.warnings()) summary.warnings.push_back(std::move(warning));
  }

 private:
  std::shared_ptr<const BlobEvidence> in_whole_image(std::shared_ptr<const BlobEvidence> evidence) const {
    if (!evidence || part_.tl() == cv::Point()) return evidence;
    auto whole = std::make_shared<BlobEvidence>(*evidence);
    whole->origin += Vector<2>(part_.x, part_.y);
    return whole;
  }

  std::string name_;
  CameraId id_;
  cv::Rect part_;  // px, that is searched
  detect::blobs::ForegroundEvidence model_;
  ViewAmbiguities view_ambiguities_;
  std::optional<BallInView> ball_;
  std::int64_t frames_ = 0;
};

GroundScene scene_for(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options) {
  Rig fed = ground_rig(rig, feeds);
  auto views = views_of(fed, options.ptz);
  for (const corridor::Feed& feed : feeds)
    check_for_bramble(feed.camera(), views->view_at(feed.id(), {}), feed.has_images(), ptz_of(options.ptz, feed.id()) != nullptr);
  GroundScene scene{.rig = std::move(fed), .views = views, .area = area_of(rig, options), .box_at = {}};
  scene.box_at = [views](CameraId camera, const Vector<2>& position, Timestamp time) {
    return person_at(views->view_at(camera, time), position);
  };
  return scene;
}

class BrambleOnGround final : public GroundStage {
 public:
  BrambleOnGround(const std::vector<corridor::Feed>& feeds, const Rig& rig, const PeopleOnGroundOptions& options)
      : GroundStage(feeds, options, scene_for(feeds, rig, options)), tracker_(*options.bramble, scene_.views) {
    std::vector<std::optional<BrambleCamera>> opened(feeds.size());
    tbb::parallel_for(std::size_t{0}, feeds.size(), [&](std::size_t i) {
      opened[i].emplace(feeds[i], scene_.views->view_at(feeds[i].id(), {}), scene_.area, options);
    });
    for (auto& camera : opened) cameras_.push_back(std::move(*camera));
  }

  const std::vector<analyse::Teams::Team>& teams() const override { return people_.teams.teams; }
  std::vector<std::shared_ptr<StandingPeople>> standing() const override {
    return std::vector<std::shared_ptr<StandingPeople>>(cameras_.size());
  }

  std::vector<std::string> news() override {
    std::vector<std::string> all;
    for (BrambleCamera& camera : cameras_) {
      for (std::string& message_text : camera.news()) all.push_back(std::move(message_text));
    }
    return all;
  }

  std::span<const Instant> step(const FrameSet& frames) override {
    const std::vector<track::bramble::CameraEvidence> evidence = observe(frames);
    const auto tracks = tracker_.step(frames.time, evidence);
    if (options_.live) {
      instant_ = live_instant(frames, tracks);
      add_live_boxes(frames, {}, {}, instant_);
      return {&instant_, 1};
    }
    boxes_.add_frames(frames);
    time_steps_.push_back({frames.index, own_time(frames.time)});
    if (options_.ball) ball_candidates_.push_back(ball_candidates(frames));
    const track::ground::GroundInstant instant(static_cast<std::int32_t>(frames.index), frames.time, tracker_.observations());
    recorder_.add(instant.frame, frames.time, tracks, instant.cameras, tracker_.matches());
    note(instant, tracker_.matches());
    return {};
  }

  std::unique_ptr<corridor::InstantSource> finish(const Hooks& hooks) override {
    if (options_.live) return nullptr;
    const corridor::Stopwatch taken;
    auto joined = std::move(recorder_).join(
        options_.join, [this](const Vector<2>& position, Timestamp time) { return scene_.in_view(position, time); });
    people_ = second_pass(std::move(joined), scene_, header_, boxes_, std::move(ball_candidates_), options_, hooks);
    people_.linking_s = taken.seconds();
    return ground_instants(people_, scene_, boxes_, time_steps_);
  }

  void report(corridor::Summary& summary) const override {
    if (!options_.live) {
      const bool searched =
          std::any_of(cameras_.begin(), cameras_.end(), [](const BrambleCamera& camera) { return camera.ball().has_value(); });
      report_people(people_, options_.ball.has_value(), searched, summary);
    }
    for (const BrambleCamera& camera : cameras_) camera.report(summary);
    explain_empty_result(summary);
    report_times(summary);
  }

 private:
  /// Of the cameras that have a frame.
  std::vector<track::bramble::CameraEvidence> observe(const FrameSet& frames) {
    std::vector<track::bramble::CameraEvidence> all(cameras_.size());
    tbb::parallel_for(std::size_t{0}, cameras_.size(), [&](std::size_t i) {
      if (frames.cameras[i]) all[i] = cameras_[i].observe(frames.cameras[i]->frame);
    });
    std::vector<track::bramble::CameraEvidence> evidence;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      if (frames.cameras[i]) evidence.push_back(std::move(all[i]));
    }
    return evidence;
  }

  track::ball::BallObservations ball_candidates(const FrameSet& frames) const {
    track::ball::BallObservations candidates;
    candidates.index = frames.index;
    candidates.time = frames.time;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      if (!frames.cameras[i]) continue;
      if (auto view = cameras_[i].ball()) candidates.views.push_back(std::move(*view));
    }
    return candidates;
  }

  track::bramble::BrambleTracker tracker_;
  std::vector<BrambleCamera> cameras_;
  track::ground::offline::GroundRecorder recorder_;
  std::vector<Recording::TimeStep> time_steps_;  // by the header's clock
  std::vector<track::ball::BallObservations> ball_candidates_;
  GroundPeople people_;
  Instant instant_;
};

}  // namespace

std::unique_ptr<PeopleOnGround> bramble_on_ground(const std::vector<corridor::Feed>& feeds, const Rig& rig,
                                                  const PeopleOnGroundOptions& options) {
  return std::make_unique<BrambleOnGround>(feeds, rig, options);
}

}  // namespace marey::pipeline::people::ground
