#include "marey/pipeline/keypoints/body_keypoints.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <utility>

#include "marey/detect/keypoints/blazepose.h"
#include "marey/detect/keypoints/model_folder.h"

namespace marey::pipeline::keypoints {
namespace {

using detect::keypoints::Body;
using detect::keypoints::ImageRegion;
using detect::keypoints::PersonRegion;

constexpr double kNearBox = 0.5;    // of a box's longer side: how far from its centre a region may lie that was found before
constexpr double kMinSide = 0.6;    // of a region about the box, and ...
constexpr double kMaxSide = 2;      // ... the most: outside them the box gives where to search
constexpr double kSameBody = 0.06;  // of its height: two whose points lie so near each other are one
constexpr double kInBox = 0.15;     // intersection over union of points' hull and box, at least, of the person that is meant
constexpr double kMaxBridge = 1;    // s between two images in which a point was found
constexpr double kWander = 0.6;     // of a person's height a second: how far a point departs from a straight path
constexpr double kForgotten = 10;   // s

/// Whether a person found before may still be meant by the box.
bool fits(const PersonRegion& region, const Box& box) {
  const double longer = std::max(box.width, box.height);
  const double about = detect::keypoints::region_of(box).side;
  return (region.centre - box.centre()).cwiseAbs().maxCoeff() < kNearBox * longer && region.side > kMinSide * about &&
         region.side < kMaxSide * about;
}

Box hull_of(const Keypoints<2>& keypoints) {
  Vector<2> minimum = keypoints.points.front()->position, maximum = minimum;
  for (const auto& point : keypoints.points)
    minimum = minimum.cwiseMin(point->position), maximum = maximum.cwiseMax(point->position);
  return {minimum.x(), minimum.y(), maximum.x() - minimum.x(), maximum.y() - minimum.y()};
}

double height_of(const Keypoints<2>& keypoints) {
  const Box hull = hull_of(keypoints);
  return std::max({hull.width, hull.height, 1.0});
}

/// px from a point of one to the same of the other, on average.
double apart(const Keypoints<2>& a, const Keypoints<2>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) sum += (a.points[i]->position - b.points[i]->position).norm();
  return sum / static_cast<double>(a.points.size());
}

/// Points on the straight line through those of two times, at `fraction` of the distance (more than 1: beyond).
std::shared_ptr<const Keypoints<2>> en_route(const Keypoints<2>& from, const Keypoints<2>& to, double fraction,
                                             double from_nearest_s) {
  auto result = std::make_shared<Keypoints<2>>(to);
  const double wander = kWander * height_of(to) * from_nearest_s;
  for (std::size_t i = 0; i < to.points.size(); ++i) {
    const Keypoint<2>&a = *from.points[i], &b = *to.points[i];
    Keypoint<2>& point = *result->points[i];
    point.position = (1 - fraction) * a.position + fraction * b.position;
    point.covariance = (1 - fraction) * (1 - fraction) * a.covariance + fraction * fraction * b.covariance +
                       Matrix<2>::Identity() * (wander * wander);
    if (fraction > 1) continue;
    point.visibility = (1 - fraction) * a.visibility + fraction * b.visibility;
    point.presence = (1 - fraction) * a.presence + fraction * b.presence;
  }
  result->presence = std::min(from.presence, to.presence);
  return result;
}

}  // namespace

BodyKeypoints::BodyKeypoints(const KeypointOptions& options, bool live)
    : options_(options), live_(live), network_(detect::keypoints::landmark_model(options.model)) {}

BodyKeypoints::Person& BodyKeypoints::person_of(const Sample& sample, Timestamp now) {
  const auto [entry, is_new] = people_.try_emplace(sample.track, detect::keypoints::blazepose());
  Person& person = entry->second;
  if (is_new) person.first = person.last_present = now;
  person.last_sample = now;
  return person;
}

void BodyKeypoints::add(Instant instant, const Image& image) {
  const bool inspected = frames_++ % options_.every == 0 && !image.empty();
  for (const Sample& sample : instant.samples) person_of(sample, instant.time);
  if (inspected) inspect(instant, image);
  waiting_.push_back({std::move(instant), inspected});
}

void BodyKeypoints::inspect(const Instant& instant, const Image& image) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<const Sample*> samples;
  std::vector<ImageRegion> searched;
  std::vector<std::size_t> new_ones;  // whose region a box gives, and not earlier points
  for (const Sample& sample : instant.samples) {
    if (!sample.box || sample.box->empty()) continue;
    const Person& person = people_.at(sample.track);
    PersonRegion region = detect::keypoints::region_of(*sample.box);
    bool known = false;
    if (person.region) {
      PersonRegion moved = *person.region;
      moved.centre += sample.box->centre() - person.box.centre();
      known = fits(moved, *sample.box);
      if (known) region = moved;
    }
    if (!known) new_ones.push_back(samples.size());
    samples.push_back(&sample);
    searched.push_back({image, region});
  }
  if (samples.empty()) return;
  std::vector<Body> bodies = network_.find(searched);
  // Seen in a region that fits, points are surer by far: once more, where the first was only a box.
  std::erase_if(new_ones, [&](std::size_t i) {
    return bodies[i].keypoints.presence < options_.sure || !fits(bodies[i].next, *samples[i]->box);
  });
  std::vector<ImageRegion> closer;
  for (const std::size_t i : new_ones) closer.push_back({image, bodies[i].next});
  std::vector<Body> again = network_.find(closer);
  for (std::size_t i = 0; i < new_ones.size(); ++i) {
    if (again[i].keypoints.presence >= options_.sure) bodies[new_ones[i]] = std::move(again[i]);
  }
  take_in(samples, bodies, instant.time);
  times_.add(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

/// No person is found twice: of two who have the same points, one keeps them, whose box they fill better.
void BodyKeypoints::take_in(std::span<const Sample* const> samples, std::span<const Body> bodies, Timestamp now) {
  std::vector<double> fit(samples.size(), 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (bodies[i].keypoints.presence >= options_.sure) fit[i] = geometry::iou(hull_of(bodies[i].keypoints), *samples[i]->box);
    if (fit[i] < kInBox) fit[i] = 0;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (fit[i] == 0 || fit[k] == 0) continue;
      if (apart(bodies[i].keypoints, bodies[k].keypoints) > kSameBody * height_of(bodies[i].keypoints)) continue;
      fit[fit[i] < fit[k] ? i : k] = 0;
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Person& person = people_.at(samples[i]->track);
    if (fit[i] == 0) {
      person.region.reset();
      continue;
    }
    const Timestamp before = !person.waiting.empty()    ? person.waiting.back()
                             : !person.detected.empty() ? person.detected.back().time
                                                        : now;
    person.swaps.add(bodies[i].keypoints, seconds(now - before));
    person.waiting.push_back(now);
    person.region = bodies[i].next;
    person.box = *samples[i]->box;
    person.last_present = now;
  }
}

/// The estimate of a person's points at a time, which grows from call to call.
std::shared_ptr<const Keypoints<2>> BodyKeypoints::at(Person& person, Timestamp time, bool inspected) const {
  while (!person.waiting.empty() && (person.detected.empty() || person.detected.back().time < time)) {
    person.detected.push_back({person.waiting.front(), std::make_shared<Keypoints<2>>(person.swaps.take())});
    person.waiting.pop_front();
  }
  const auto after =
      std::find_if(person.detected.begin(), person.detected.end(), [&](const Detected& detected) { return detected.time >= time; });
  const auto known = static_cast<std::size_t>(after - person.detected.begin());  // before `time`
  std::shared_ptr<const Keypoints<2>> result;
  if (after != person.detected.end() && after->time == time) {
    result = after->keypoints;
  } else if (!inspected && known > 0 && after != person.detected.end()) {
    const Detected& from = person.detected[known - 1];
    const double whole = seconds(after->time - from.time), part = seconds(time - from.time);
    if (whole <= kMaxBridge) result = en_route(*from.keypoints, *after->keypoints, part / whole, std::min(part, whole - part));
  } else if (!inspected && known > 0) {
    const Detected& last = person.detected[known - 1];
    const Detected& earlier = person.detected[known > 1 ? known - 2 : 0];
    const double step = seconds(last.time - earlier.time), part = seconds(time - last.time);
    if (part <= kMaxBridge)
      result = en_route(*earlier.keypoints, *last.keypoints, step > 0 && step <= kMaxBridge ? 1 + part / step : 1, part);
  }
  while (known > 2 && person.detected.size() > 2 && person.detected[1].time < time) person.detected.pop_front();
  return result;
}

std::optional<Instant> BodyKeypoints::next(bool ended) {
  if (waiting_.empty()) return std::nullopt;
  const Timestamp time = waiting_.front().instant.time;
  if (!live_ && !ended) {
    if (seconds(waiting_.back().instant.time - time) < options_.lag_s) return std::nullopt;
    const bool later_look = std::any_of(waiting_.begin(), waiting_.end(), [](const Waiting& one) { return one.inspected; });
    if (!later_look) return std::nullopt;  // what lies between two inferences is known after the second
  }
  Instant instant = std::move(waiting_.front().instant);
  const bool inspected = waiting_.front().inspected;
  waiting_.pop_front();
  std::erase_if(instant.samples, [&](Sample& sample) {
    Person& person = people_.at(sample.track);
    const bool no_person = seconds(time - person.last_present) > options_.patience_s;
    if (!no_person) sample.keypoints = at(person, time, inspected);
    excluded_ += no_person;
    return no_person;
  });
  const Timestamp newest = waiting_.empty() ? time : waiting_.back().instant.time;
  std::erase_if(people_, [&](const auto& entry) { return seconds(newest - entry.second.last_sample) > kForgotten; });
  return instant;
}

}  // namespace marey::pipeline::keypoints
