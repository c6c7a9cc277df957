#include "marey/pipeline/people/ground/ground_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/error.h"
#include "marey/detect/appearance.h"
#include "marey/pipeline/people/ground/mosaic_detector.h"
#include "marey/pipeline/people/ground/people_in_view.h"
#include "marey/pipeline/people/ground/ptz_views.h"
#include "marey/reconstruct/place_people.h"

namespace marey::pipeline::people::ground {
namespace {

/// People before a PTZ camera: by a network in every frame, or before the mosaic of its empty scene.
std::unique_ptr<detect::Detector> ptz_detector(const corridor::Feed& feed, const std::shared_ptr<const GroundViews>& views,
                                               const reconstruct::GroundArea& area, const GroundCameraOptions& options) {
  detect::DetectorOptions detector = options.detector;
  auto* network = std::get_if<detect::network::NetworkDetectorOptions>(&detector);
  if (network == nullptr) return mosaic_detector(feed, options.ptz, views, area);
  network->background = false;
  network->every = 1;
  return detect::make_detector(detector);
}

}  // namespace

GroundView ground_view_of(const RigCamera& camera, const geometry::GroundSurface& ground) {
  if (!camera.camera_from_world && !camera.ground_from_image)
    throw Error("camera \"{}\": how it sees the ground is not known; run marey calibrate pitch, or give its ground_from_image",
                camera.name);
  if (camera.source.empty() && !camera.size)
    throw Error("camera \"{}\" brings detections: the size of its images must be reported; add size = [width, height] to the rig",
                camera.name);
  if (const auto view = camera.ground_view(ground)) return *view;
  throw Error("camera \"{}\": its lens or the size of its images is not known; calibrate it", camera.name);
}

GroundCamera::GroundCamera(const corridor::Feed& feed, std::shared_ptr<const GroundViews> views,
                           const reconstruct::GroundArea& area, const GroundCameraOptions& options)
    : camera_(feed.camera()), id_(feed.id()), area_(area), views_(std::move(views)), ptz_(options.ptz) {
  const GroundView& view = view_at(Timestamp{});
  const Camera* whole = view.camera();
  if (feed.has_images() && ptz_) {
    detector_ = ptz_detector(feed, views_, area, options);
  } else if (feed.has_images()) {
    detect::DetectorOptions detector = options.detector;
    if (whole != nullptr) {
      const cv::Rect part = part_with_people(view, area);
      if (part.size() != whole->size()) part_ = part;
      if (detect::people::PeopleOptions* people = detect::people_options_of(detector))
        people->sizes = std::make_shared<detect::people::PersonSizeMap>(sizes_over(view, area, part));
    }
    detector_ = detect::make_detector(detector);
  }
  const bool sizes_known = whole != nullptr || (detector_ != nullptr && detector_->traits().knows_body_size);
  if (!sizes_known) learned_.emplace();
  if (options.ball && whole != nullptr && !ptz_ && feed.has_images()) ball_.emplace(id_, view, area, *options.ball);
  if (detector_ != nullptr && !ptz_) view_.emplace(camera_, options.stabilised);
  if (detector_ != nullptr && !ptz_) standing_ = std::make_shared<StandingPeople>(Image());
  if (detector_ == nullptr || !options.prime) return;
  std::vector<Frame> samples = feed.sample_beginning();
  corridor::ParallelTasks parallel;
  if (view_) parallel.run([this, samples] { view_->inspect_at_beginning(samples); });
  if (ball_) parallel.run([this, samples] { ball_->prime(samples); });
  for (Frame& frame : samples) {
    frame.image = observed_part(frame.image);
    if (options.without) frame.image = options.without->without_them(frame.image);
  }
  detector_->prime(samples);
  if (standing_) standing_ = std::make_shared<StandingPeople>(detector_->scene());
}

GroundCamera::~GroundCamera() = default;
GroundCamera::GroundCamera(GroundCamera&&) noexcept = default;

std::optional<Box> GroundCamera::box_at(const Vector<2>& ground, Timestamp time) const {
  const GroundView& view = view_at(time);
  if (view.camera() != nullptr) return person_at(view, ground);
  const auto foot = view.pixel(ground);
  if (!foot) return std::nullopt;
  if (!learned_) return detector_->body_at(*foot);
  const auto size = learned_->at(foot->x(), foot->y());
  if (!size) return std::nullopt;
  return size->box_at(foot->x(), foot->y());
}

track::ground::CameraObservations GroundCamera::observe(const CameraFrame& given, std::span<const Track<2>> expected) {
  ++frames_;
  Frame frame = given.frame;
  if (!frame.image.empty()) frame.image = observed_part(frame.image);
  corridor::ParallelTasks parallel;
  if (view_) parallel.run([&] { view_->add(given.frame); });
  if (standing_) parallel.run([&] { standing_->inspect(frame); });
  detect::Detections found;
  if (detector_) {
    found = detect(frame, expected, parallel);
  } else {
    found.detections = *given.detections;
  }
  if (learned_) learn_sizes(found.detections, detector_ ? frame.image.size() : view_at(frame.time).size());
  location(frame, found);
  if (ball_) ball_->search(given.frame, found.detections);
  return {id_, given.frame.time, detected_};
}

/// Who is expected is where the detector need not learn the background.
detect::Detections GroundCamera::detect(const Frame& frame, std::span<const Track<2>> expected, corridor::ParallelTasks& parallel) {
  expected_.clear();
  in_image_.clear();
  const cv::Size size = frame.image.size();
  const Box image{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
  for (const Track<2>& track : expected) {
    const auto box = box_at(track.position, frame.time);
    if (!box) continue;
    const Box here = geometry::intersection(moved(*box, -corner()), image);
    if (here.empty()) continue;
    expected_.push_back({here});
    in_image_.push_back(track);
    in_image_.back().box = here;
  }
  detect::Detections found = detector_->detect(frame, expected_);
  parallel.wait();
  if (standing_) standing_->observe_frame(frame, in_image_, *detector_);
  return found;
}

void GroundCamera::learn_sizes(const std::vector<Detection>& detections, const cv::Size& size) {
  for (const Detection& detection : detections) learned_->observe_frame(detection.box, size);
  if (learned_->needs_fit()) learned_->fit();
}

void GroundCamera::location(const Frame& frame, detect::Detections& found) {
  std::vector<std::optional<Appearance>> appearances;
  for (std::size_t i = 0; i < found.detections.size(); ++i) {
    appearances.push_back(detect::upper_body(frame.image, found.foreground, found.detections, i));
  }
  for (Detection& detection : found.detections) detection.box = moved(detection.box, corner());
  reconstruct::LocalisePeopleOptions locating;
  if (detector_) locating.toe = detector_->traits().toe_m;
  const reconstruct::LocatedPeople located = reconstruct::localise_people(found.detections, view_at(frame.time), id_, locating);
  detected_.clear();
  for (std::size_t i = 0; i < located.detected.size(); ++i) {
    if (!area_.holds(located.detected[i].value, kBeyondArea)) continue;
    detected_.push_back(located.detected[i]);
    if (ptz_ && detected_.back().box)
      *detected_.back().covariance += aim_covariance(camera_, *ptz_, frame.time, detected_.back().box->foot());
    detected_.back().appearance = appearances[static_cast<std::size_t>(located.detection[i])];
  }
  outside_ += std::ssize(found.detections) - std::ssize(detected_);
  detections_ += std::ssize(detected_);
}

std::vector<std::string> GroundCamera::news() {
  return view_ ? view_->news() : std::vector<std::string>{};
}

void GroundCamera::report(corridor::Summary& summary) const {
  corridor::Summary::Camera& counts = summary.cameras.emplace_back();
  counts.name = camera_.name;
  counts.frames = frames_;
  counts.missed = summary.frames - frames_;
  counts.detections = detections_;
  if (view_) {
    for (std::string& warning : view_->warnings()) summary.warnings.push_back(std::move(warning));
  }
  counts.outside = outside_;
  summary.detections += detections_;
  if (!detector_) return;
  counts.noise = detector_->detection_counts().noise.value_or(0);
  counts.misfits = detector_->detection_counts().misfits.value_or(0);
}

}  // namespace marey::pipeline::people::ground
