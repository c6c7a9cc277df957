#include "marey/pipeline/keypoints/keypoints_live.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/core/stage_times.h"
#include "marey/detect/keypoints/model_folder.h"
#include "marey/detect/network/halved_image.h"
#include "marey/detect/network/run_network.h"
#include "marey/pipeline/keypoints/keypoint_frames.h"
#include "marey/pipeline/keypoints/keypoint_misfit.h"
#include "marey/pipeline/keypoints/live_noise.h"
#include "marey/reconstruct/keypoints/people_in_views.h"

namespace marey::pipeline::keypoints {
namespace {

namespace rk = reconstruct::keypoints;
using detect::keypoints::Body;
using detect::keypoints::ImageRegion;
using detect::keypoints::PersonRegion;

constexpr double kMinLocated = 0.75;     // fraction of people in images below which the reasons are searched: as for recordings
constexpr double kWorstLiveNoise = 2.5;  // factor of the stated deviations, numerical: just below where learning begins and ends
constexpr std::size_t kMaxKept = 120;    // numerical: instants that are kept for that

class Stopwatch {
 public:
  explicit Stopwatch(StageTimes& times) : times_(times) {}
  ~Stopwatch() { times_.add(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count()); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  StageTimes& times_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

FindPeople detector_of(const std::string& file) {
  const auto network = std::make_shared<detect::network::LoadedNetwork>(
      detect::network::read_network_model(file.empty() ? detect::keypoints::model_file("person.toml") : file));
  return [network](const Image& image) {
    // Not more pixels are converted than the network receives.
    const cv::Size input = network->model().input;
    Image small = image;
    double scale = 1;
    for (; small.size().width >= 2 * input.width && small.size().height >= 2 * input.height; scale *= 2)
      small = detect::network::halved(small);
    std::vector<Box> boxes;
    for (const detect::network::Candidate& one : network->find(small.bgr()))
      boxes.push_back({scale * one.left, scale * one.top, scale * (one.right - one.left), scale * (one.bottom - one.top)});
    return boxes;
  };
}

FindBodies network_of(const std::string& model) {
  const auto network = std::make_shared<detect::keypoints::LandmarkNetwork>(detect::keypoints::landmark_model(model));
  return [network](std::span<const ImageRegion> searched) { return network->find(searched); };
}

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
        find_people_(options.find_people ? options.find_people : detector_of(options.detector)),
        find_bodies_(options.find_bodies ? options.find_bodies : network_of(options.model)),
        views_(set_, static_cast<int>(rig.cameras.size())),
        people_(set_, options.people),
        options_(options) {
    for (const RigCamera& camera : rig.cameras) {
      cameras_.push_back(camera.camera());
      counts_.emplace_back().name = camera.name;
      in_images_.emplace_back(set_, options.cameras);
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
  void search(const FrameSet& frames);
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
  FindPeople find_people_;
  FindBodies find_bodies_;
  std::vector<std::optional<Camera>> cameras_;
  std::vector<CameraPeople> in_images_;
  rk::PeopleInViews views_;
  LiveNoise noise_;
  LocatedPeople people_;
  KeypointsLiveOptions options_;
  std::vector<rk::LocatedPerson> located_;
  std::vector<ImageRegion> searched_;
  std::vector<std::size_t> detected_in_;  // camera of each frame given to the network
  std::vector<char> has_frame_;
  std::optional<Timestamp> before_;
  Instant instant_;
  std::vector<corridor::Summary::Camera> counts_;
  std::vector<std::optional<KeypointCamera>> kept_;  // of the first instants in which two cameras saw people
  StageTimes searching_, detecting_, locating_;
  std::int64_t searches_ = 0, detector_runs_ = 0, with_people_ = 0;
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

/// The person detector, in the image that has waited for it longest.
void KeypointsLive::search(const FrameSet& frames) {
  std::optional<std::size_t> chosen;
  double longest = 0;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (!has_frame_[c]) continue;
    const auto due = in_images_[c].search_due(frames.time, is_full(c));
    if (due && (!chosen || *due > longest)) chosen = c, longest = *due;
  }
  if (!chosen) return;
  const Stopwatch watch(searching_);
  ++searches_;
  in_images_[*chosen].searched(find_people_(frames.cameras[*chosen]->frame.image), frames.time);
}

void KeypointsLive::inspect(const FrameSet& frames) {
  searched_.clear();
  detected_in_.clear();
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (!has_frame_[c]) continue;
    for (const PersonRegion& region : in_images_[c].regions()) {
      searched_.push_back({frames.cameras[c]->frame.image, region});
      detected_in_.push_back(c);
    }
  }
  std::vector<Body> bodies;
  if (!searched_.empty()) {
    const Stopwatch watch(detecting_);
    bodies = find_bodies_(searched_);
  }
  detector_runs_ += std::ssize(searched_);
  std::size_t begin = 0;
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    if (!has_frame_[c]) continue;
    const std::size_t count = in_images_[c].size();
    in_images_[c].take(std::span(bodies).subspan(begin, count), frames.time, is_full(c));
    begin += count;
    counts_[c].detections += std::ssize(in_images_[c].people());
  }
  searched_.clear();  // the images are not kept
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
  search(frames);
  inspect(frames);
  keep();
  instant_ = {};
  instant_.index = frames.index;
  instant_.time = frames.time;
  {
    const Stopwatch watch(locating_);
    location(frames, step_s);
    people_.step(located_, step_s, instant_);
    expect_in_other_cameras(frames);
    report_observed(instant_);
  }
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
  for (const auto& [name, times] : {std::pair<const char*, const StageTimes*>{"person detector", &searching_},
                                    {"keypoints", &detecting_},
                                    {"placing", &locating_}}) {
    if (times->count() > 0) summary.steps.push_back({name, times->count(), times->quantile(0.5), times->quantile(0.99)});
  }
  summary.body_points = {.people = static_cast<std::int64_t>(people_.numbers()),
                         .person_searches = static_cast<std::int64_t>(searches_),
                         .regions = static_cast<std::int64_t>(detector_runs_),
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
