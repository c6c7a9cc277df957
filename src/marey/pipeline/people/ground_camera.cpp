#include "marey/pipeline/people/ground_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/error.h"
#include "marey/detect/appearance.h"
#include "marey/detect/people/person_size_map.h"
#include "marey/pipeline/people/turned_views.h"
#include "marey/reconstruct/person_view.h"
#include "marey/reconstruct/place_people.h"
#include "marey/track/ball/ball_motion.h"

namespace marey::pipeline::people {
namespace {

constexpr double kSmallest = 12;   // px; a smaller body has no shape
constexpr double kBeyondArea = 5;  // m; who stands so far outside is followed until it is plain whether they come in

/// Somebody who stands there, in the view of a whole camera.
std::optional<Box> person_at(const GroundView& view, const Vector<2>& place) {
  return reconstruct::person_box(*view.camera(), {place.x(), place.y(), view.surface().height(place)});
}

/// The size of people at each place of a calibrated camera's picture, where they count or nearly so.
detect::people::PersonSizeMap sizes_over(const GroundView& view, const reconstruct::GroundArea& area, const cv::Rect& part) {
  return {part.size(), [&](double x, double y) -> std::optional<detect::people::PersonSize> {
            const auto place = view.place({x + part.x, y + part.y});
            if (!place || !area.holds(place->ground, kBeyondArea)) return std::nullopt;
            const auto box = person_at(view, place->ground);
            if (!box || box->height < kSmallest) return std::nullopt;
            return detect::people::PersonSize{box->height, box->width};
          }};
}

/// The part of the picture, even-sided, in which somebody who counts may be seen.
cv::Rect part_with_people(const GroundView& view, const reconstruct::GroundArea& area) {
  const cv::Size size = view.size();
  const cv::Rect whole({}, size);
  if (!area.bounded()) return whole;
  constexpr int step = 32;
  std::optional<Box> all;
  // Feet may be below the picture while the head is in it.
  for (int y = 0; y < 3 * size.height / 2; y += step) {
    for (int x = -step; x <= size.width + step; x += step) {
      const auto place = view.place({static_cast<double>(x), static_cast<double>(y)});
      if (!place || !area.holds(place->ground, kBeyondArea)) continue;
      const auto box = person_at(view, place->ground);
      if (!box || box->height < kSmallest) continue;
      all = all ? geometry::hull(*all, *box) : *box;
    }
  }
  if (!all) return whole;
  const auto down = [](double value) { return static_cast<int>(std::floor(value / step)) * step; };
  const cv::Rect found(cv::Point(down(all->left), down(all->top)),
                       cv::Point(down(all->right()) + step, down(all->bottom()) + step));
  const cv::Rect part = found & whole;
  return part.area() > 0 ? part : whole;
}

/// The radius in px of a ball on the ground that is seen at a pixel; behind the area that of one at its far end, for whatever is
/// seen there flies before it.
detect::ball::BallSize ball_sizes(const GroundView& view, const reconstruct::GroundArea& area) {
  const auto radius_at = [view](const Vector<2>& pixel) -> std::optional<double> {
    const auto place = view.place(pixel);
    if (!place) return std::nullopt;
    const auto seen = view.camera()->project_with_jacobian(
        {place->ground.x(), place->ground.y(), view.surface().height(place->ground) + track::ball::kBallRadius});
    if (!seen) return std::nullopt;
    return track::ball::kBallRadius * std::pow((seen->by_world * seen->by_world.transpose()).determinant(), 0.25);
  };
  double least = 1e9;
  constexpr int kGrid = 16;
  for (int y = 0; y < view.size().height; y += kGrid) {
    for (int x = 0; x < view.size().width; x += kGrid) {
      const auto place = view.place({static_cast<double>(x), static_cast<double>(y)});
      if (!place || !area.holds(place->ground)) continue;
      least = std::min(least, radius_at({static_cast<double>(x), static_cast<double>(y)}).value_or(least));
    }
  }
  return [radius_at, least](const Vector<2>& pixel) -> std::optional<double> {
    const auto radius = radius_at(pixel);
    if (!radius) return std::nullopt;
    return std::max(*radius, least);
  };
}

Box moved(const Box& box, const cv::Point& by) {
  return {box.left + by.x, box.top + by.y, box.width, box.height};
}

/// The same evidence in the whole picture.
std::shared_ptr<const BlobEvidence> moved(const std::shared_ptr<const BlobEvidence>& evidence, const cv::Point& by) {
  if (!evidence || by == cv::Point()) return evidence;
  auto whole = std::make_shared<BlobEvidence>(*evidence);
  whole->origin += Vector<2>(by.x, by.y);
  return whole;
}

/// How far apart a grid's points are, px, of which a person spans about twelve rows: most do.
int grid_step(const GroundView& view, const reconstruct::GroundArea& area) {
  constexpr int every = 24, rows = 12, least = 2, most = 8;  // px, points, px, px
  std::vector<double> heights;
  for (int y = 0; y < view.size().height; y += every) {
    for (int x = 0; x < view.size().width; x += every) {
      const auto place = view.place({static_cast<double>(x), static_cast<double>(y)});
      if (!place || !area.holds(place->ground, kBeyondArea)) continue;
      const auto box = person_at(view, place->ground);
      if (box && box->height >= kSmallest) heights.push_back(box->height);
    }
  }
  if (heights.empty()) return most;
  const auto quarter = heights.begin() + std::ssize(heights) / 4;
  std::nth_element(heights.begin(), quarter, heights.end());
  return std::clamp(static_cast<int>(std::lround(*quarter / rows)), least, most);
}

/// Evidence is of pictures, through whole cameras that stand.
void check_for_blobs(const RigCamera& camera, const GroundView& view, bool pictures, bool turns) {
  if (!pictures) throw Error("camera \"{}\" brings detections; bramble looks at pictures", camera.name);
  if (turns) throw Error("camera \"{}\" turns, and bramble needs cameras that stand", camera.name);
  if (view.camera() == nullptr)
    throw Error("camera \"{}\" is known by ground_from_image alone; bramble must know how tall people are seen: calibrate it",
                camera.name);
}

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
  const auto* asked = std::get_if<detect::blobs::BlobDetectorOptions>(&options.detector);
  if (asked != nullptr) check_for_blobs(camera_, view, feed.has_pictures(), turning_ != nullptr);
  if (feed.has_pictures()) {
    detect::DetectorOptions detector = turning_ ? for_turning(options.detector, camera_.name) : options.detector;
    if (whole != nullptr && !turning_) {
      const cv::Rect part = part_with_people(view, area);
      if (part.size() != whole->size()) part_ = part;
      if (detect::people::PeopleOptions* people = detect::people_options_of(detector))
        people->sizes = std::make_shared<detect::people::PersonSizeMap>(sizes_over(view, area, part));
    }
    if (auto* blobs = std::get_if<detect::blobs::BlobDetectorOptions>(&detector); blobs != nullptr && !blobs->step)
      blobs->step = grid_step(view, area);
    detector_ = detect::make_detector(detector);
  }
  const bool sizes_known = whole != nullptr || (detector_ != nullptr && detector_->traits().knows_body_size);
  if (!sizes_known) learned_.emplace();
  if (options.ball && whole != nullptr && !turning_ && feed.has_pictures()) ball_.emplace(ball_sizes(view, area), *options.ball);
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
  if (ball_) look_for_ball(given.frame, found.detections);
  return {id_, given.frame.time, seen_, moved(found.evidence, corner())};
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

void GroundCamera::look_for_ball(const Frame& frame, const std::vector<Detection>& people) {
  track::ball::BallView& view = ball_view_.emplace();
  view.camera = id_;
  view.time = frame.time;
  for (const Detection& person : people) view.people.push_back(person.box);
  for (const detect::ball::BallCandidate& candidate : ball_->detect(frame))
    view.seen.push_back({candidate.centre, candidate.sigma, candidate.score, candidate.company, {}, false});
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
