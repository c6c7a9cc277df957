#include "marey/pipeline/people/standing_people.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for_each.h>

#include "marey/detect/background/background_uncovered.h"

namespace marey::pipeline::people {
namespace {

using detect::background::uncovered;

constexpr double kSettles = 4;                          // s: a scene that nothing was learned of ahead is corrected by then
constexpr double kInspectedAt = 20;                     // s after a person began to move, in which their place is inspected
constexpr double kNext = 1;                             // s in which a person who is lost at once is found again, and
constexpr double kNextWithin = 2.5;                     // of the body's height, how far away
constexpr double kInspectAgain = 0.2;                   // s between two inspections
constexpr double kStays = 0.4;                          // s for which what has left must be the same
constexpr double kSameRegion = 0.8;                     // overlap of two masks that are the same
constexpr double kRoundAcross = 0.8, kRoundDown = 0.3;  // of the body's height, that are inspected beside, above and below it

/// Even-sided, within the image.
cv::Rect position_round(const Box& body, cv::Size image) {
  const double across = kRoundAcross * body.height, down = kRoundDown * body.height;
  const auto even = [](double value) { return 2 * static_cast<int>(std::floor(value / 2)); };
  const cv::Rect required(cv::Point(even(body.left - across), even(body.top - down)),
                          cv::Point(even(body.right() + across) + 2, even(body.bottom() + down) + 2));
  return required & cv::Rect(0, 0, image.width & ~1, image.height & ~1);
}

double shared_part(const cv::Mat& a, const cv::Mat& b) {
  const int both = cv::countNonZero(a & b), any = cv::countNonZero(a | b);
  return any > 0 ? static_cast<double>(both) / any : 0;
}

Box at_position(const Box& box, const cv::Rect& location) {
  return {box.left - location.x, box.top - location.y, box.width, box.height};
}

/// Pixels of its own.
Image kept(const Image& image) {
  if (!image.is_colour()) return Image(image.luma().clone());
  return {image.luma().clone(), image.cb().clone(), image.cr().clone(), image.range()};
}

}  // namespace

void StandingPeople::note_starters(const Frame& frame, std::span<const Track<2>> tracks, const detect::Detector& detector) {
  Image scene;
  const bool settled = !beginning_.empty() || seconds(frame.time - *first_) >= kSettles;
  for (const Track<2>& track : tracks) {
    if (number(track.id) <= last_id_) continue;
    last_id_ = number(track.id);
    if (!track.box || !settled) continue;
    if (scene.empty()) scene = detector.scene();
    if (scene.empty()) return;
    note_next(track.id, *track.box, frame.time);
    Starter& starter = starters_.emplace_back();
    starter.id = track.id;
    starter.at = starter.inspected = frame.time;
    starter.location = position_round(*track.box, frame.image.size());
    starter.body = at_position(*track.box, starter.location);
    starter.scene = kept(scene.part(starter.location));
  }
}

/// Who runs off may be followed in pieces: the next one begins a little farther.
void StandingPeople::note_next(TrackId id, const Box& body, Timestamp now) {
  for (Starter& starter : starters_) {
    const Box next = at_position(body, starter.location);
    const double distance = (next.centre() - starter.body.centre()).norm();
    if (seconds(now - starter.at) <= kNext && distance < kNextWithin * starter.body.height &&
        geometry::intersection(next, starter.body).empty())
      starter.left = id;
  }
}

bool StandingPeople::is_known(const Starter& starter) const {
  return std::any_of(risers_.begin(), risers_.end(), [&](const Riser& riser) {
    const cv::Rect both = riser.location & starter.location;
    if (both.empty()) return false;
    const cv::Mat a = riser.mask(both - riser.location.tl()), b = starter.gone(both - starter.location.tl());
    return 2 * cv::countNonZero(a & b) > cv::countNonZero(starter.gone);
  });
}

bool StandingPeople::is_due(const Starter& starter, const Frame& frame) {
  const cv::Rect image({}, frame.image.size());
  return starter.left && seconds(frame.time - starter.at) <= kInspectedAt &&
         seconds(frame.time - starter.inspected) >= kInspectAgain && (starter.location & image) == starter.location;
}

void StandingPeople::inspect(const Frame& frame) {
  if (frame.image.empty()) return;
  tbb::parallel_for_each(starters_.begin(), starters_.end(), [&](Starter& starter) {
    starter.detected.reset();
    if (!is_due(starter, frame)) return;
    starter.detected = frame.index;
    starter.now = uncovered(starter.scene, frame.image.part(starter.location), starter.body);
  });
}

/// Whether something has left where a person began to move, and that for long enough.
bool StandingPeople::has_gone(Starter& starter, const Frame& frame) const {
  starter.inspected = frame.time;
  const auto gone = std::exchange(starter.detected, std::nullopt) == frame.index
                        ? std::exchange(starter.now, std::nullopt)
                        : uncovered(starter.scene, frame.image.part(starter.location), starter.body);
  if (!gone) {
    starter.gone.release();
    return false;
  }
  if (starter.gone.empty() || shared_part(starter.gone, *gone) < kSameRegion) {
    starter.gone = *gone;
    starter.gone_at = frame.time;
    return false;
  }
  return seconds(frame.time - starter.gone_at) >= kStays;
}

bool StandingPeople::observe_frame(const Frame& frame, std::span<const Track<2>> tracks, detect::Detector& detector) {
  if (!first_) first_ = frame.time;
  note_starters(frame, tracks, detector);
  bool found = false;
  std::erase_if(starters_, [&](Starter& starter) {
    const auto track = std::find_if(tracks.begin(), tracks.end(), [&](const Track<2>& one) { return one.id == starter.id; });
    const bool tracked = track != tracks.end();
    if (tracked && track->confirmed && track->box &&
        geometry::intersection(at_position(*track->box, starter.location), starter.body).empty())
      starter.left = starter.id;
    if (!tracked && !starter.left && seconds(frame.time - starter.at) > kNext) return true;
    const cv::Rect image({}, frame.image.size());
    if (seconds(frame.time - starter.at) > kInspectedAt || (starter.location & image) != starter.location) return true;
    if (!starter.left || seconds(frame.time - starter.inspected) < kInspectAgain) return false;
    if (!has_gone(starter, frame)) return false;
    if (is_known(starter)) return true;
    Riser& riser = risers_.emplace_back();
    riser.id = *starter.left;
    riser.at = starter.at;
    riser.location = starter.location;
    riser.mask = starter.gone;
    riser.image = kept(frame.image.part(starter.location));
    riser.since_beginning =
        !beginning_.empty() && detect::background::same_within(beginning_.part(riser.location), starter.scene, riser.mask);
    detector.trust(frame.image, riser.mask, riser.location.tl());
    found = found || riser.since_beginning;
    return true;
  });
  return found;
}

Image StandingPeople::without_them(const Image& image) const {
  Image result = image;
  // Where one stood before another, what the first to leave uncovered is nearer to the beginning.
  for (auto riser = risers_.rbegin(); riser != risers_.rend(); ++riser) {
    if (riser->since_beginning) result = detect::background::patched(result, riser->image, riser->mask, riser->location.tl());
  }
  return result;
}

int StandingPeople::since_beginning() const {
  return static_cast<int>(std::count_if(risers_.begin(), risers_.end(), [](const Riser& riser) { return riser.since_beginning; }));
}

std::vector<std::string> StandingPeople::stated(std::size_t from) const {
  std::vector<std::string> sentences;
  for (std::size_t i = from; i < risers_.size(); ++i) {
    const Riser& riser = risers_[i];
    sentences.push_back(fmt::format("{:.1f} s: person {} came out of the background, of which they had been taken for a part",
                                    seconds(riser.at - *first_), number(riser.id)));
  }
  return sentences;
}

}  // namespace marey::pipeline::people
