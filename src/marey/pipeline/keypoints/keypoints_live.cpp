#include "marey/pipeline/keypoints/keypoints_live.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/core/stage_times.h"
#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/pipeline/keypoints/keypoint_frames.h"
#include "marey/pipeline/keypoints/keypoint_misfit.h"
#include "marey/pipeline/keypoints/live_noise.h"
#include "marey/reconstruct/keypoints/people_in_views.h"

namespace marey::pipeline::keypoints {
namespace {

namespace rk = reconstruct::keypoints;
using detect::keypoints::PersonRegion;

constexpr double kMinLocated = 0.75;     // fraction of people in images below which the reasons are searched: as for recordings
constexpr double kWorstLiveNoise = 2.5;  // factor of the stated deviations, numerical: just below where learning begins and ends
constexpr std::size_t kMaxKept = 120;    // numerical: instants that are kept for that

/// Which points of a set say how a body lies in an image.
struct Trunk {
  explicit Trunk(const KeypointSet& set) {
    const char* names[] = {"left_hip", "right_hip", "left_shoulder", "right_shoulder"};
    for (std::size_t i = 0; i < 4; ++i) points[i] = point_named(set, names[i]);
  }
  std::array<std::optional<int>, 4> points;
};

class KeypointsLive final : public corridor::Stage {
 public:
  KeypointsLive(const Rig& rig, double rate_hz, const KeypointsLiveOptions& options)
      : rig_(rig),
        rate_hz_(rate_hz),
        set_(options.set),
        trunk_(set_),
        in_images_(set_, rig.cameras.size(), options.find_people ? options.find_people : people_finder(options.detector),
                   options.find_bodies ? options.find_bodies : body_finder(options.model), options.cameras),
        views_(set_, static_cast<int>(rig.cameras.size())),
        people_(set_, options.people),
        options_(options) {
    for (const RigCamera& camera : rig.cameras) {
      cameras_.push_back(camera.camera());
      counts_.emplace_back().name = camera.name;
      auto& kept = kept_.emplace_back();
      if (!cameras_.back()) continue;
      kept.emplace().rate_hz = rate_hz;
      kept->sequence.set = set_;
    }
    if (std::count_if(cameras_.begin(), cameras_.end(), [](const auto& camera) { return camera.has_value(); }) < 2)
      throw Error("keypoints in space need two calibrated cameras");
  }

  RecordingHeader header() const override;
  std::span<const Instant> step(const FrameSet& frames) override;
  std::vector<std::string> news() override;
  void report(corridor::Summary& summary) const override;

 private:
  void inspect(const FrameSet& frames);
  void location(const FrameSet& frames, double step_s);
  void expect_in_other_cameras(const FrameSet& frames);
  std::optional<PersonRegion> region_in(const Camera& camera, std::span<const std::optional<Vector<3>>> points) const;
  void report_observed(Instant& instant) const;
  void keep();
  bool is_full(std::size_t camera) const;
  bool fits(const rk::LocatedPerson& person, std::size_t camera) const;

  Rig rig_;
  double rate_hz_;
  KeypointSet set_;
  Trunk trunk_;
  ImagesWithPeople in_images_;
  std::vector<std::optional<Camera>> cameras_;
  rk::PeopleInViews views_;
  LiveNoise noise_;
  LocatedPeople people_;
  KeypointsLiveOptions options_;
  std::vector<rk::LocatedPerson> located_;
  std::vector<char> has_frame_;
  std::optional<Timestamp> before_;
  Instant instant_;
  std::vector<corridor::Summary::Camera> counts_;
  std::vector<std::optional<KeypointCamera>> kept_;  // of the first instants in which two cameras saw people
  StageTimes locating_;
  std::int64_t with_people_ = 0;
  bool reported_misfit_ = false;
};

RecordingHeader KeypointsLive::header() const {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::space;
  header.time_base.kind = TimeBase::Kind::rig;
  header.track_kind = TrackKind::keypoint;
  header.rate_hz = rate_hz_;
  header.rig = rig_;
  header.made_by.program = "marey live";
  header.made_by.options["keypoint set"] = set_.name;
  return header;
}

/// Whether a camera's view of a person is of who the other cameras see.
bool KeypointsLive::fits(const rk::LocatedPerson& person, std::size_t camera) const {
  const Keypoints<2>& body = in_images_[camera].people()[static_cast<std::size_t>(person.views[camera])];
  Vector<2> low = Vector<2>::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& point : body.points) {
    if (point) low = low.cwiseMin(point->position), high = high.cwiseMax(point->position);
  }
  std::vector<double> residuals;
  for (const auto& point : person.points) {
    if (point) residuals.push_back(point->residual_px);
  }
  if (residuals.empty()) return false;
  const auto middle = residuals.begin() + std::ssize(residuals) / 2;
  std::nth_element(residuals.begin(), middle, residuals.end());
  return *middle < options_.max_residual * (high - low).maxCoeff();
}

/// All people that are wanted are known in this camera: no detector is needed, and no search for others.
bool KeypointsLive::is_full(std::size_t camera) const {
  if (options_.people.maximum == 0) return false;
  std::int64_t here = 0;
  for (const rk::LocatedPerson& person : located_)
    here += person.views[camera] >= 0 && people_.track_of(person.id, 0) && fits(person, camera) ? 1 : 0;
  return here >= options_.people.maximum;
}

void KeypointsLive::inspect(const FrameSet& frames) {
  std::vector<Image> images(cameras_.size());
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (has_frame_[c]) images[c] = frames.cameras[c]->frame.image;
  }
  in_images_.step(images, frames.time, [this](std::size_t c) { return is_full(c); });
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (has_frame_[c]) counts_[c].detections += std::ssize(in_images_[c].people());
  }
}

void KeypointsLive::location(const FrameSet& frames, double step_s) {
  std::vector<rk::PersonView> views;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (!has_frame_[c]) continue;
    const std::vector<Keypoints<2>>& people = in_images_[c].people();
    for (std::size_t i = 0; i < people.size(); ++i)
      views.push_back(rk::view_of(*cameras_[c], static_cast<int>(c), static_cast<int>(i), people[i],
                                  options_.gate_slack * noise_.times_stated()));
  }
  located_ = views_.step(step_s, views);
  noise_.learn(located_, options_.gate_slack);
  for (const rk::LocatedPerson& person : located_) {
    const bool numbered = people_.track_of(person.id, 0).has_value();
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      if (person.views[c] >= 0 && (numbered || !is_full(c)))
        in_images_[c].located(static_cast<std::size_t>(person.views[c]), frames.time);
    }
  }
}

/// Where a person whose points are known in space is in a camera's image, with enough of the body in it.
std::optional<PersonRegion> KeypointsLive::region_in(const Camera& camera, std::span<const std::optional<Vector<3>>> points) const {
  std::vector<std::optional<Vector<2>>> pixels(points.size());
  std::size_t inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i]) pixels[i] = camera.project(*points[i]);
    if (!pixels[i]) continue;
    const Vector<2>& at = *pixels[i];
    inside += at.x() >= 0 && at.y() >= 0 && at.x() < camera.size().width && at.y() < camera.size().height ? 1 : 0;
  }
  std::array<std::optional<Vector<2>>, 4> trunk;
  for (std::size_t i = 0; i < trunk.size(); ++i) {
    if (trunk_.points[i]) trunk[i] = pixels[static_cast<std::size_t>(*trunk_.points[i])];
    if (!trunk[i]) return std::nullopt;
  }
  if (inside < std::min(options_.min_points_in_image, points.size() / 2)) return std::nullopt;
  const Vector<2> hips = (*trunk[0] + *trunk[1]) / 2, shoulders = (*trunk[2] + *trunk[3]) / 2;
  double reach = 0;
  for (const auto& pixel : pixels) {
    if (pixel) reach = std::max(reach, (*pixel - hips).norm());
  }
  const Vector<2> up = shoulders - hips;
  if (!(up.norm() > 1e-3)) return std::nullopt;
  return detect::keypoints::region_of(hips, Vector<2>(hips + reach * up.normalized()));
}

void KeypointsLive::expect_in_other_cameras(const FrameSet& frames) {
  for (const rk::LocatedPerson& person : located_) {
    const auto points = people_.points_of(person.id);
    if (points.empty()) continue;
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      if (!has_frame_[c] || person.views[c] >= 0) continue;
      const auto region = region_in(*cameras_[c], points);
      if (region) in_images_[c].expect(*region, frames.time);
    }
  }
}

void KeypointsLive::report_observed(Instant& instant) const {
  for (const rk::LocatedPerson& person : located_) {
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      if (person.views[c] < 0) continue;
      const Keypoints<2>& body = in_images_[c].people()[static_cast<std::size_t>(person.views[c])];
      for (std::size_t i = 0; i < body.points.size(); ++i) {
        if (!body.points[i] || body.points[i]->visibility < options_.min_visibility) continue;
        ImageObservation& detected = instant.detected.emplace_back();
        detected.camera = CameraId{static_cast<int>(c)};
        detected.pixel = body.points[i]->position;
        detected.sigma = std::sqrt(std::sqrt(body.points[i]->covariance.determinant()));
        detected.track = people_.track_of(person.id, i);
      }
    }
  }
}

/// The first instants with people, so that at the end it can be said why they are not placed.
void KeypointsLive::keep() {
  std::size_t cameras = 0;
  for (std::size_t c = 0; c < cameras_.size(); ++c) cameras += has_frame_[c] && !in_images_[c].people().empty() ? 1 : 0;
  if (cameras < 2 || with_people_++ >= static_cast<std::int64_t>(kMaxKept)) return;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (kept_[c]) kept_[c]->sequence.frames.push_back(has_frame_[c] ? in_images_[c].people() : std::vector<Keypoints<2>>{});
  }
}

std::span<const Instant> KeypointsLive::step(const FrameSet& frames) {
  const double step_s = before_ ? seconds(frames.time - *before_) : 0;
  before_ = frames.time;
  has_frame_.assign(cameras_.size(), 0);
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    has_frame_[c] = cameras_[c] && frames.cameras[c] && !frames.cameras[c]->frame.image.empty() ? 1 : 0;
    counts_[c].frames += has_frame_[c];
    counts_[c].missed += has_frame_[c] ? 0 : 1;
  }
  inspect(frames);
  keep();
  instant_ = {};
  instant_.index = frames.index;
  instant_.time = frames.time;
  const corridor::Stopwatch watch;
  location(frames, step_s);
  people_.step(located_, step_s, instant_);
  expect_in_other_cameras(frames);
  report_observed(instant_);
  locating_.add(watch.seconds());
  return {&instant_, 1};
}

std::vector<std::string> KeypointsLive::news() {
  std::vector<std::string> news = people_.take_news();
  if (!reported_misfit_ && with_people_ >= static_cast<std::int64_t>(kMaxKept)) {
    reported_misfit_ = true;
    if (static_cast<double>(views_.views_located()) < kMinLocated / 2 * static_cast<double>(views_.views_observed()))
      news.push_back(
          fmt::format("only {} of {} people in images are placed: two cameras must see the same person, and stand where "
                      "they were calibrated",
                      views_.views_located(), views_.views_observed()));
  }
  return news;
}

void KeypointsLive::report(corridor::Summary& summary) const {
  summary.cameras = counts_;
  for (const corridor::Summary::Camera& camera : counts_) summary.detections += camera.detections;
  for (const auto& [name, times] : {std::pair<const char*, const StageTimes*>{"person detector", &in_images_.searching()},
                                    {"keypoints", &in_images_.detecting()},
                                    {"placing", &locating_}}) {
    if (times->count() > 0) summary.steps.push_back({name, times->count(), times->quantile(0.5), times->quantile(0.99)});
  }
  summary.body_points = {.people = static_cast<std::int64_t>(people_.numbers()),
                         .person_searches = in_images_.searches(),
                         .regions = in_images_.regions(),
                         .people_in_images = static_cast<std::int64_t>(views_.views_observed()),
                         .people_located = static_cast<std::int64_t>(views_.views_located()),
                         .noise = noise_.times_stated()};
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (!cameras_[c])
      summary.warnings.push_back(fmt::format("camera \"{}\" is not calibrated: its images are not used", rig_.cameras[c].name));
  }
  const double detected = static_cast<double>(views_.views_observed()), located = static_cast<double>(views_.views_located());
  if (detected == 0) {
    summary.warnings.push_back("no person was seen in any image");
    return;
  }
  const bool few = located < kMinLocated * detected, noisy = noise_.is_learned() && noise_.times_stated() > kWorstLiveNoise;
  if (few) summary.warnings.push_back(fmt::format("only {:.0f} of {:.0f} people in images are placed", located, detected));
  if (noisy)
    summary.warnings.push_back(
        fmt::format("the rig does not fit these keypoints: they are off {:.1f} times as far as keypoints of their confidence",
                    noise_.times_stated()));
  if ((!few && !noisy) || with_people_ == 0) return;
  const KeypointFrames frames(kept_);
  for (std::string& message_text : reasons_of_misfit(rig_, frames, set_)) summary.warnings.push_back(std::move(message_text));
}

}  // namespace

std::unique_ptr<corridor::Stage> keypoints_live(const Rig& rig, double rate_hz, const KeypointsLiveOptions& options) {
  return std::make_unique<KeypointsLive>(rig, rate_hz, options);
}

}  // namespace marey::pipeline::keypoints
