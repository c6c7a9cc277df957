#include "marey/pipeline/ground_cameras.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/core/rig.h"
#include "marey/detect/appearance.h"
#include "marey/detect/people/person_size_map.h"
#include "marey/reconstruct/person_view.h"
#include "marey/reconstruct/place_people.h"

namespace marey::pipeline {
namespace {

constexpr double kHalf = 0.505;    // of a frame
constexpr double kUsualRate = 25;  // Hz
constexpr double kSmallest = 12;   // px; a smaller body has no shape
constexpr double kBeyondArea = 5;  // m; who stands so far outside is followed until it is plain whether they come in
constexpr double kToe = 0.1;       // m; our own silhouettes end at the tip of the foot, others' boxes where they like
constexpr std::size_t kMostCameras = 64;

/// The size of people at each place of a calibrated camera's picture, where they count or nearly so.
detect::people::PersonSizeMap sizes_over(const Camera& camera, const reconstruct::GroundArea& area, const cv::Rect& part) {
  const GroundView view(camera);
  return {part.size(), [&](double x, double y) -> std::optional<detect::people::PersonSize> {
            const auto place = view.place({x + part.x, y + part.y});
            if (!place || !area.holds(place->ground, kBeyondArea)) return std::nullopt;
            const auto box = reconstruct::person_box(camera, place->ground);
            if (!box || box->height < kSmallest) return std::nullopt;
            return detect::people::PersonSize{box->height, box->width};
          }};
}

/// The part of the picture, even-sided, in which somebody who counts may be seen.
cv::Rect part_with_people(const Camera& camera, const reconstruct::GroundArea& area) {
  const cv::Size size = camera.size();
  const cv::Rect whole({}, size);
  if (!area.pitch()) return whole;
  constexpr int step = 32;
  const GroundView view(camera);
  std::optional<Box> all;
  // Feet may be below the picture while the head is in it.
  for (int y = 0; y < 3 * size.height / 2; y += step) {
    for (int x = -step; x <= size.width + step; x += step) {
      const auto place = view.place({static_cast<double>(x), static_cast<double>(y)});
      if (!place || !area.holds(place->ground, kBeyondArea)) continue;
      const auto box = reconstruct::person_box(camera, place->ground);
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

Box moved(const Box& box, const cv::Point& by) {
  return {box.left + by.x, box.top + by.y, box.width, box.height};
}

}  // namespace

struct GroundCameras::Lane {
  Lane(const RigCamera& camera, CameraId camera_id) : name(camera.name), id(camera_id), offset_s(camera.offset_s.value_or(0)) {}

  Timestamp rig_time(const Frame& frame) const { return frame.time + duration_from_seconds(offset_s); }

  /// Takes the frame nearest to `now`, less than half a `period` away and later than the last one taken.
  void take(Timestamp now, double period) {
    taken.reset();
    while (waiting && rig_time(*waiting) <= now) {
      before = std::move(waiting);
      waiting = eyes.source->next();
    }
    const auto off = [&](const std::optional<Frame>& frame) {
      return frame ? std::abs(seconds(rig_time(*frame) - now)) : std::numeric_limits<double>::infinity();
    };
    if (std::min(off(before), off(waiting)) > kHalf * period) {
      ++counts.missed;
    } else if (off(before) <= off(waiting)) {
      taken = std::exchange(before, std::nullopt);
    } else {
      taken = std::move(waiting);
      waiting = eyes.source->next();
    }
  }

  std::optional<Box> box_at(const GroundView& view, const Vector<2>& ground) const {
    if (const Camera* camera = view.camera()) return reconstruct::person_box(*camera, ground);
    const auto foot = view.pixel(ground);
    if (!foot) return std::nullopt;
    const auto size = eyes.people ? eyes.people->size_at(foot->x(), foot->y()) : learned.at(foot->x(), foot->y());
    if (!size) return std::nullopt;
    return size->box_at(foot->x(), foot->y());
  }

  void look(const GroundView& view, const reconstruct::GroundArea& area, std::span<const Track<2>> tracks) {
    ++counts.frames;
    expected.clear();
    const cv::Size size = taken->picture.size();
    const Box picture{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
    for (const Track<2>& track : tracks) {
      const auto box = box_at(view, track.position);
      if (!box) continue;
      const Box here = geometry::intersection(moved(*box, -corner), picture);
      if (!here.empty()) expected.push_back({here});
    }
    detect::Detections found = eyes.detector->detect(*taken, expected);
    if (view.camera() == nullptr && eyes.people == nullptr) learn(found, view.size());
    place(found, view, area);
  }

  void place(detect::Detections& found, const GroundView& view, const reconstruct::GroundArea& area) {
    std::vector<std::optional<Appearance>> wears;
    for (std::size_t i = 0; i < found.detections.size(); ++i) {
      wears.push_back(detect::upper_body(taken->picture, found.foreground, found.detections, i));
    }
    for (Detection& detection : found.detections) detection.box = moved(detection.box, corner);
    reconstruct::PlacePeopleOptions placing;
    if (eyes.people != nullptr) placing.toe = kToe;
    const reconstruct::PlacedPeople placed = reconstruct::place_people(found.detections, view, id, placing);
    seen.clear();
    for (std::size_t i = 0; i < placed.seen.size(); ++i) {
      if (!area.holds(placed.seen[i].value, kBeyondArea)) continue;
      seen.push_back(placed.seen[i]);
      seen.back().appearance = wears[static_cast<std::size_t>(placed.detection[i])];
    }
    counts.outside += std::ssize(found.detections) - std::ssize(seen);
    counts.detections += std::ssize(seen);
  }

  void learn(const detect::Detections& found, cv::Size size) {
    for (const Detection& detection : found.detections) learned.see(detection.box, size);
    if (learned.wants_fit()) learned.fit();
  }

  std::string name;
  CameraId id;
  double offset_s;
  DetectionStage eyes;
  cv::Point corner;                         // of the part of the picture that is looked at
  detect::people::PersonSizeModel learned;  // where neither a camera nor a detector knows how tall people are
  std::optional<Frame> before, waiting, taken;
  std::vector<Expected> expected;
  std::vector<Observation<2>> seen;
  Counts counts;
};

namespace {

/// What is wrong with a camera, in words, before anything is opened.
void check(const RigCamera& camera) {
  if (camera.source.empty() && camera.detections.empty())
    throw Error("camera \"{}\" has neither pictures nor detections; give it a source in the rig, or {}=FILE", camera.name,
                camera.name);
  if (!camera.camera_from_world && !camera.ground_from_image)
    throw Error("camera \"{}\": how it sees the ground is not known; run marey calibrate pitch, or give its ground_from_image",
                camera.name);
  if (!camera.source.empty()) return;
  if (!camera.size)
    throw Error("camera \"{}\" brings detections: the size of its pictures must be told; add size = [width, height] to the rig",
                camera.name);
}

cv::Size picture_size(const RigCamera& camera, const PeopleInput& input) {
  try {
    return open_pictures(input)->info().size;
  } catch (const Error& error) {
    throw Error("camera \"{}\": {}", camera.name, error.what());
  }
}

/// Opens the camera's pictures or detections; `corner` becomes that of the part of the picture that is looked at.
DetectionStage open(RigCamera& camera, const reconstruct::GroundArea& area, const GroundCamerasOptions& options,
                    cv::Point& corner) {
  PeopleInput input{camera.source, camera.detections, camera.rate_hz ? camera.rate_hz : options.rate_hz, camera.region};
  DetectionStageOptions eyes = options.eyes;
  if (!camera.source.empty()) {
    input.detections.clear();
    fit_to_size(camera, picture_size(camera, input));
    if (const auto whole = camera.camera()) {
      const cv::Rect part = part_with_people(*whole, area);
      eyes.people.sizes = std::make_shared<detect::people::PersonSizeMap>(sizes_over(*whole, area, part));
      corner = part.tl();
      const cv::Point origin = camera.region ? camera.region->tl() : cv::Point();
      if (part.size() != whole->size()) input.region = part + origin;
    }
  }
  try {
    return open_detection_stage(input, eyes);
  } catch (const Error& error) {
    throw Error("camera \"{}\": {}", camera.name, error.what());
  }
}

}  // namespace

GroundCameras::GroundCameras(const Rig& rig, const reconstruct::GroundArea& area, const GroundCamerasOptions& options)
    : rig_(rig), area_(area) {
  if (rig_.cameras.empty()) throw Error("the rig has no camera");
  if (rig_.cameras.size() > kMostCameras) throw Error("the rig has {} cameras; {} is the most", rig_.cameras.size(), kMostCameras);
  for (const RigCamera& camera : rig_.cameras) check(camera);
  for (std::size_t i = 0; i < rig_.cameras.size(); ++i)
    lanes_.push_back(std::make_unique<Lane>(rig_.cameras[i], CameraId{static_cast<int>(i)}));
  tbb::parallel_for(std::size_t{0}, lanes_.size(), [&](std::size_t i) {
    lanes_[i]->eyes = open(rig_.cameras[i], area_, options, lanes_[i]->corner);
    lanes_[i]->waiting = lanes_[i]->eyes.source->next();
  });
  for (const RigCamera& camera : rig_.cameras) {
    const auto view = camera.ground_view();
    if (!view) throw Error("camera \"{}\": its lens or the size of its pictures is not known; calibrate it", camera.name);
    views_.push_back(*view);
  }
}

GroundCameras::~GroundCameras() = default;

std::optional<double> GroundCameras::rate_hz() const {
  return lanes_.front()->eyes.source->info().rate_hz;
}

std::optional<std::int64_t> GroundCameras::frame_count() const {
  return lanes_.front()->eyes.source->info().frame_count;
}

bool GroundCameras::next() {
  Lane& first = *lanes_.front();
  if (!first.waiting) return false;
  first.taken = std::move(first.waiting);
  first.waiting = first.eyes.source->next();
  frame_ = static_cast<std::int32_t>(first.taken->index);
  time_ = first.rig_time(*first.taken);
  const double period = 1 / rate_hz().value_or(kUsualRate);
  for (std::size_t i = 1; i < lanes_.size(); ++i) lanes_[i]->take(time_, period);
  return true;
}

std::span<const track::ground::CameraObservations> GroundCameras::look(std::span<const Track<2>> expected) {
  tbb::parallel_for(std::size_t{0}, lanes_.size(), [&](std::size_t i) {
    if (lanes_[i]->taken) lanes_[i]->look(views_[i], area_, expected);
  });
  looks_.clear();
  for (const auto& lane : lanes_) {
    if (lane->taken) looks_.push_back({lane->id, lane->rig_time(*lane->taken), lane->seen});
  }
  return looks_;
}

std::optional<std::int32_t> GroundCameras::frame_of(std::size_t number) const {
  const std::optional<Frame>& taken = lanes_[number]->taken;
  if (!taken) return std::nullopt;
  return static_cast<std::int32_t>(taken->index);
}

std::optional<Box> GroundCameras::box_at(std::size_t number, const Vector<2>& ground) const {
  return lanes_[number]->box_at(views_[number], ground);
}

void GroundCameras::close() {
  for (const auto& lane : lanes_) {
    if (lane->eyes.people == nullptr) lane->eyes.detector.reset();
  }
}

GroundCameras::Counts GroundCameras::counts(std::size_t number) const {
  const Lane& lane = *lanes_[number];
  Counts counts = lane.counts;
  if (lane.eyes.people != nullptr) {
    counts.noise = lane.eyes.people->counts().noise;
    counts.misfits = lane.eyes.people->counts().misfits;
  }
  return counts;
}

std::vector<std::string> GroundCameras::warnings() const {
  std::vector<std::string> all;
  for (const auto& lane : lanes_) {
    for (const std::string& warning : lane->eyes.source->warnings())
      all.push_back(fmt::format("camera \"{}\": {}", lane->name, warning));
  }
  return all;
}

}  // namespace marey::pipeline
