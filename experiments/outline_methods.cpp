#include "experiments/outline_methods.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/geometry.h"
#include "marey/detect/people/people.h"
#include "marey/geometry/bspline.h"
#include "marey/track/tracker.h"

#include "experiments/box_filter.h"

namespace marey::experiments {
namespace {

/// Time of this thread alone, whatever else the machine does.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds), begin_(now()) {}
  ~Stopwatch() { seconds_ += now() - begin_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  static double now() {
    std::timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double& seconds_;
  double begin_;
};

std::vector<Observation<2>> observations_of(std::span<const Detection> detections) {
  std::vector<Observation<2>> result;
  for (const Detection& detection : detections) {
    result.push_back({.value = detection.box.centre(),
                      .covariance = detection.covariance.value_or(Matrix<2>::Identity()),
                      .score = detection.score,
                      .box = detection.box,
                      .shared = detection.group.has_value()});
  }
  return result;
}

std::vector<Vector<2>> corners(const Box& box) {
  const double left = box.left - 0.5, top = box.top - 0.5;
  return {{left, top}, {left + box.width, top}, {left + box.width, top + box.height}, {left, top + box.height}};
}

/// Marey's detector and tracker, with or without ContourTracker.
class TrackedMethod final : public OutlineMethod {
 public:
  explicit TrackedMethod(const std::optional<track::contour::OutlineOptions>& options)
      : detector_(detect::background::make_background()) {
    track::TrackerOptions tracker;
    tracker.stabilised_camera = true;
    tracker.reidentify = true;  // nothing is joined afterwards
    tracker_ = track::make_tracker(tracker);
    if (options) outlines_.emplace(*options);
  }

  void prime(std::span<const Frame> samples) override { detector_.prime(samples); }

  std::vector<TrackedShape> step(const Frame& frame, std::span<const Detection> /*detections*/,
                                 std::span<const simulate::people::TrueFigure> /*truth*/) override {
    std::vector<Expected> expected;
    for (const Track<2>& track : tracker_->expected(frame.time)) {
      if (track.box) expected.push_back({*track.box});
    }
    detect::Detections detected = detector_.detect(frame, expected);
    std::vector<Observation<2>> observations = observations_of(detected.detections);
    if (outlines_) {
      const Stopwatch watch(seconds_);
      const auto hints = outlines_->observe(frame, detected.foreground, detected.detections);
      observations.insert(observations.end(), hints.begin(), hints.end());
    }
    std::span<const Track<2>> tracks = tracker_->step(frame.time, observations);
    if (outlines_) {
      const Stopwatch watch(seconds_);
      tracks = outlines_->attach(tracks, detected.detections);
    }
    detections_ = std::move(detected.detections);
    std::vector<TrackedShape> shapes;
    for (const Track<2>& track : tracks) {
      if (auto shape = track.confirmed ? shape_of(track) : std::nullopt) shapes.push_back(std::move(*shape));
    }
    return shapes;
  }

  std::span<const Detection> detections() const override { return detections_; }

 private:
  std::optional<TrackedShape> shape_of(const Track<2>& track) {
    const std::string name = std::to_string(number(track.id));
    if (track.outline) {
      ++targets_;
      const Outline& outline = *track.outline;
      TrackedShape shape{name, outline.centre, geometry::ClosedSpline(outline.order, outline.control_points).polygon(), {}};
      for (const TrackId id : outline.behind) shape.behind.push_back(std::to_string(number(id)));
      shape.is_curve = true;
      if (track.box) shape.box_width = track.box->width, shape.box_height = track.box->height;
      return shape;
    }
    const bool detected = track.observation && *track.observation < std::ssize(detections_);
    if (detected && !detections_[static_cast<std::size_t>(*track.observation)].outline.empty()) {
      const auto& polygon = detections_[static_cast<std::size_t>(*track.observation)].outline;
      return TrackedShape{name, geometry::polygon_centroid(polygon).value_or(track.position), polygon, {}};
    }
    if (!track.box) return std::nullopt;
    return TrackedShape{name, track.box->centre(), corners(*track.box), {}};
  }

  detect::people::PeopleDetector detector_;
  std::unique_ptr<track::Tracker<2>> tracker_;
  std::optional<track::contour::ContourTracker> outlines_;
  std::vector<Detection> detections_;
};

/// The detection on a person who can be seen wholly, where there is one.
const Detection* detection_of(const simulate::people::TrueFigure& person, std::span<const Detection> detections) {
  if (person.visible_fraction < 0.9) return nullptr;
  const Box box = person.visible.box();
  for (const Detection& detection : detections) {
    if (!detection.group && iou(box, detection.box) > 0.5 && detection.outline.size() > 3) return &detection;
  }
  return nullptr;
}

/// One filter a person, begun with the first two detections in a row that are on him.
template <typename Filter>
class LoneFilters : public OutlineMethod {
 public:
  std::vector<TrackedShape> step(const Frame& frame, std::span<const Detection> detections,
                                 std::span<const simulate::people::TrueFigure> truth) override {
    {
      const Stopwatch watch(seconds_);
      for (auto& [id, filter] : filters_) advance(filter, frame, detections);
    }
    targets_ += std::ssize(filters_);
    std::map<int, Detection> detected;
    for (const simulate::people::TrueFigure& person : truth) {
      if (filters_.contains(person.id)) continue;
      const Detection* now = detection_of(person, detections);
      if (now == nullptr) continue;
      if (const auto before = before_.find(person.id); before != before_.end()) begin(person.id, before->second, *now);
      detected.emplace(person.id, *now);
    }
    before_ = std::move(detected);
    std::vector<TrackedShape> shapes;
    for (const auto& [id, filter] : filters_) {
      TrackedShape shape = shape_of(filter);
      shape.name = std::to_string(id);
      const auto sane = [](const Vector<2>& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < 1e6; };
      if (std::all_of(shape.polygon.begin(), shape.polygon.end(), sane)) shapes.push_back(std::move(shape));
    }
    return shapes;
  }

 protected:
  virtual void advance(Filter& filter, const Frame& frame, std::span<const Detection> detections) = 0;
  virtual Filter make(const Detection& before, const Detection& now) const = 0;
  virtual TrackedShape shape_of(const Filter& filter) const = 0;

 private:
  void begin(int id, const Detection& before, const Detection& now) {
    try {
      filters_.emplace(id, make(before, now));
    } catch (const Error&) {
      filters_.erase(id);  // no curve fits these silhouettes: the next two may do
    }
  }

  std::map<int, Filter> filters_;
  std::map<int, Detection> before_;
};

class PublishedMethod final : public LoneFilters<PublishedOutline> {
 public:
  explicit PublishedMethod(const PublishedOptions& options) : options_(options) {}

 private:
  void advance(PublishedOutline& filter, const Frame& frame, std::span<const Detection> /*detections*/) override {
    filter.step(frame);
  }
  PublishedOutline make(const Detection& before, const Detection& now) const override {
    return {options_, before.outline, now.outline};
  }
  TrackedShape shape_of(const PublishedOutline& filter) const override {
    const Outline& outline = filter.outline();
    return {"", outline.centre, geometry::ClosedSpline(outline.order, outline.control_points).polygon(), {}};
  }

  PublishedOptions options_;
};

class BoxMethod final : public LoneFilters<BoxFilter> {
 private:
  /// The nearest detection within a box's height of the filter's centre.
  void advance(BoxFilter& filter, const Frame& /*frame*/, std::span<const Detection> detections) override {
    const Detection* nearest = nullptr;
    double reach = filter.box().height;
    for (const Detection& detection : detections) {
      const double distance = (detection.centre - filter.centre() - filter.velocity()).norm();
      if (distance > reach) continue;
      reach = distance;
      nearest = &detection;
    }
    if (nearest != nullptr) {
      filter.step(nearest->box, nearest->centre);
    } else {
      filter.step(std::nullopt, std::nullopt);
    }
  }
  BoxFilter make(const Detection& /*before*/, const Detection& now) const override { return {{}, now.box, now.centre}; }
  TrackedShape shape_of(const BoxFilter& filter) const override { return {"", filter.centre(), corners(filter.box()), {}}; }
};

}  // namespace

std::unique_ptr<OutlineMethod> silhouette_method() {
  return std::make_unique<TrackedMethod>(std::nullopt);
}

std::unique_ptr<OutlineMethod> marey_method(const track::contour::OutlineOptions& options) {
  return std::make_unique<TrackedMethod>(options);
}

std::unique_ptr<OutlineMethod> published_method(const PublishedOptions& options) {
  return std::make_unique<PublishedMethod>(options);
}

std::unique_ptr<OutlineMethod> box_method() {
  return std::make_unique<BoxMethod>();
}

}  // namespace marey::experiments
