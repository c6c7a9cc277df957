#include "marey/pipeline/people/ground_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/error.h"
#include "marey/detect/appearance.h"
#include "marey/pipeline/people/people_in_view.h"
#include "marey/pipeline/people/turned_views.h"
#include "marey/reconstruct/place_people.h"

namespace marey::pipeline::people {
namespace {

/// A camera that turns has no empty scene to learn: a network looks at every frame.
detect::DetectorOptions for_turning(detect::DetectorOptions options, const std::string& name) {
  auto* network = std::get_if<detect::network::NetworkDetectorOptions>(&options);
  if (network == nullptr)
    throw Error(
        "camera \"{0}\" turns, and background subtraction needs a camera that stands; give a network with --detector MODEL.toml "
        "(docs/network.md), or what another program detected: {0}=boxes.txt",
        name);
  network->background = false;
  network->every = 1;
  return options;
}

}  // namespace

GroundView ground_view_of(const RigCamera& camera, const geometry::GroundSurface& ground) {
  if (!camera.camera_from_world && !camera.ground_from_image)
    throw Error("camera \"{}\": how it sees the ground is not known; run marey calibrate pitch, or give its ground_from_image",
                camera.name);
  if (camera.source.empty() && !camera.size)
    throw Error("camera \"{}\" brings detections: the size of its pictures must be told; add size = [width, height] to the rig",
                camera.name);
  if (const auto view = camera.ground_view(ground)) return *view;
  throw Error("camera \"{}\": its lens or the size of its pictures is not known; calibrate it", camera.name);
}

GroundCamera::GroundCamera(const corridor::Feed& feed, std::shared_ptr<const GroundViews> views,
                           const reconstruct::GroundArea& area, const GroundCameraOptions& options)
    : camera_(feed.camera()), id_(feed.id()), area_(area), views_(std::move(views)), turning_(options.turning) {
  const GroundView& view = view_at(Timestamp{});
  const Camera* whole = view.camera();
  if (feed.has_pictures()) {
    detect::DetectorOptions detector = turning_ ? for_turning(options.detector, camera_.name) : options.detector;
    if (whole != nullptr && !turning_) {
      const cv::Rect part = part_with_people(view, area);
      if (part.size() != whole->size()) part_ = part;
      if (detect::people::PeopleOptions* people = detect::people_options_of(detector))
        people->sizes = std::make_shared<detect::people::PersonSizeMap>(sizes_over(view, area, part));
    }
    detector_ = detect::make_detector(detector);
  }
  const bool sizes_known = whole != nullptr || (detector_ != nullptr && detector_->traits().knows_body_size);
  if (!sizes_known) learned_.emplace();
  if (options.ball && whole != nullptr && !turning_ && feed.has_pictures()) ball_.emplace(id_, view, area, *options.ball);
  if (detector_ != nullptr && !turning_) view_.emplace(camera_, options.steadied);
  if (detector_ != nullptr && !turning_) standing_ = std::make_shared<StandingPeople>(Picture());
  if (detector_ == nullptr || !options.prime) return;
  std::vector<Frame> samples = feed.sample_beginning();
  corridor::Beside beside;
  if (view_) beside.run([this, samples] { view_->look_at_beginning(samples); });
  if (ball_) beside.run([this, samples] { ball_->prime(samples); });
  for (Frame& frame : samples) {
    frame.picture = looked_at(frame.picture);
    if (options.without) frame.picture = options.without->without_them(frame.picture);
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
  if (!frame.picture.empty()) frame.picture = looked_at(frame.picture);
  corridor::Beside beside;
  if (view_) beside.run([&] { view_->add(given.frame); });
  if (standing_) beside.run([&] { standing_->look(frame); });
  detect::Detections found;
  if (detector_) {
    found = detect(frame, expected, beside);
  } else {
    found.detections = *given.detections;
  }
  if (learned_) learn_sizes(found.detections, detector_ ? frame.picture.size() : view_at(frame.time).size());
  place(frame, found);
  if (ball_) ball_->search(given.frame, found.detections);
  return {id_, given.frame.time, seen_};
}

/// Who is expected is where the detector need not learn the background.
detect::Detections GroundCamera::detect(const Frame& frame, std::span<const Track<2>> expected, corridor::Beside& beside) {
  expected_.clear();
  in_picture_.clear();
  const cv::Size size = frame.picture.size();
  const Box picture{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
  for (const Track<2>& track : expected) {
    const auto box = box_at(track.position, frame.time);
    if (!box) continue;
    const Box here = geometry::intersection(moved(*box, -corner()), picture);
    if (here.empty()) continue;
    expected_.push_back({here});
    in_picture_.push_back(track);
    in_picture_.back().box = here;
  }
  detect::Detections found = detector_->detect(frame, expected_);
  beside.wait();
  if (standing_) standing_->see(frame, in_picture_, *detector_);
  return found;
}

void GroundCamera::learn_sizes(const std::vector<Detection>& detections, const cv::Size& size) {
  for (const Detection& detection : detections) learned_->see(detection.box, size);
  if (learned_->wants_fit()) learned_->fit();
}

void GroundCamera::place(const Frame& frame, detect::Detections& found) {
  std::vector<std::optional<Appearance>> appearances;
  for (std::size_t i = 0; i < found.detections.size(); ++i) {
    appearances.push_back(detect::upper_body(frame.picture, found.foreground, found.detections, i));
  }
  for (Detection& detection : found.detections) detection.box = moved(detection.box, corner());
  reconstruct::PlacePeopleOptions placing;
  if (detector_) placing.toe = detector_->traits().toe_m;
  const reconstruct::PlacedPeople placed = reconstruct::place_people(found.detections, view_at(frame.time), id_, placing);
  seen_.clear();
  for (std::size_t i = 0; i < placed.seen.size(); ++i) {
    if (!area_.holds(placed.seen[i].value, kBeyondArea)) continue;
    seen_.push_back(placed.seen[i]);
    if (turning_ && seen_.back().box)
      *seen_.back().covariance += aim_covariance(camera_, *turning_, frame.time, seen_.back().box->foot());
    seen_.back().appearance = appearances[static_cast<std::size_t>(placed.detection[i])];
  }
  outside_ += std::ssize(found.detections) - std::ssize(seen_);
  detections_ += std::ssize(seen_);
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

}  // namespace marey::pipeline::people
