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

constexpr double kSettles = 4;                          // s: a scene that nothing was learned of ahead is put right by then
constexpr double kLookedAt = 20;                        // s after somebody began to move, in which their place is looked at
constexpr double kNext = 1;                             // s in which somebody who is lost at once is found again, and
constexpr double kNextWithin = 2.5;                     // of the body's height, how far away
constexpr double kLookAgain = 0.2;                      // s between two looks
constexpr double kStays = 0.4;                          // s for which what has left must be the same
constexpr double kSameRegion = 0.8;                     // overlap of two masks that are the same
constexpr double kRoundAcross = 0.8, kRoundDown = 0.3;  // of the body's height, that are looked at beside, above and below it

/// Even-sided, within the picture.
cv::Rect place_round(const Box& body, cv::Size picture) {
  const double across = kRoundAcross * body.height, down = kRoundDown * body.height;
  const auto even = [](double value) { return 2 * static_cast<int>(std::floor(value / 2)); };
  const cv::Rect wanted(cv::Point(even(body.left - across), even(body.top - down)),
                        cv::Point(even(body.right() + across) + 2, even(body.bottom() + down) + 2));
  return wanted & cv::Rect(0, 0, picture.width & ~1, picture.height & ~1);
}

double shared_part(const cv::Mat& a, const cv::Mat& b) {
  const int both = cv::countNonZero(a & b), any = cv::countNonZero(a | b);
  return any > 0 ? static_cast<double>(both) / any : 0;
}

Box in_place(const Box& box, const cv::Rect& place) {
  return {box.left - place.x, box.top - place.y, box.width, box.height};
}

/// Pixels of its own.
Picture kept(const Picture& picture) {
  if (!picture.is_colour()) return Picture(picture.luma().clone());
  return {picture.luma().clone(), picture.cb().clone(), picture.cr().clone(), picture.range()};
}

}  // namespace

void StandingPeople::note_starters(const Frame& frame, std::span<const Track<2>> tracks, const detect::Detector& detector) {
  Picture scene;
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
    starter.at = starter.looked = frame.time;
    starter.place = place_round(*track.box, frame.picture.size());
    starter.body = in_place(*track.box, starter.place);
    starter.scene = kept(scene.part(starter.place));
  }
}

/// Who runs off may be followed in pieces: the next one begins a little farther.
void StandingPeople::note_next(TrackId id, const Box& body, Timestamp now) {
  for (Starter& starter : starters_) {
    const Box next = in_place(body, starter.place);
    const double way = (next.centre() - starter.body.centre()).norm();
    if (seconds(now - starter.at) <= kNext && way < kNextWithin * starter.body.height &&
        geometry::intersection(next, starter.body).empty())
      starter.left = id;
  }
}

bool StandingPeople::is_known(const Starter& starter) const {
  return std::any_of(risers_.begin(), risers_.end(), [&](const Riser& riser) {
    const cv::Rect both = riser.place & starter.place;
    if (both.empty()) return false;
    const cv::Mat a = riser.mask(both - riser.place.tl()), b = starter.gone(both - starter.place.tl());
    return 2 * cv::countNonZero(a & b) > cv::countNonZero(starter.gone);
  });
}

bool StandingPeople::is_due(const Starter& starter, const Frame& frame) {
  const cv::Rect picture({}, frame.picture.size());
  return starter.left && seconds(frame.time - starter.at) <= kLookedAt && seconds(frame.time - starter.looked) >= kLookAgain &&
         (starter.place & picture) == starter.place;
}

void StandingPeople::look(const Frame& frame) {
  if (frame.picture.empty()) return;
  tbb::parallel_for_each(starters_.begin(), starters_.end(), [&](Starter& starter) {
    starter.seen.reset();
    if (!is_due(starter, frame)) return;
    starter.seen = frame.index;
    starter.now = uncovered(starter.scene, frame.picture.part(starter.place), starter.body);
  });
}

/// Whether something has left where somebody began to move, and that for long enough.
bool StandingPeople::has_gone(Starter& starter, const Frame& frame) const {
  starter.looked = frame.time;
  const auto gone = std::exchange(starter.seen, std::nullopt) == frame.index
                        ? std::exchange(starter.now, std::nullopt)
                        : uncovered(starter.scene, frame.picture.part(starter.place), starter.body);
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

bool StandingPeople::see(const Frame& frame, std::span<const Track<2>> tracks, detect::Detector& detector) {
  if (!first_) first_ = frame.time;
  note_starters(frame, tracks, detector);
  bool found = false;
  std::erase_if(starters_, [&](Starter& starter) {
    const auto track = std::find_if(tracks.begin(), tracks.end(), [&](const Track<2>& one) { return one.id == starter.id; });
    const bool followed = track != tracks.end();
    if (followed && track->confirmed && track->box &&
        geometry::intersection(in_place(*track->box, starter.place), starter.body).empty())
      starter.left = starter.id;
    if (!followed && !starter.left && seconds(frame.time - starter.at) > kNext) return true;
    const cv::Rect picture({}, frame.picture.size());
    if (seconds(frame.time - starter.at) > kLookedAt || (starter.place & picture) != starter.place) return true;
    if (!starter.left || seconds(frame.time - starter.looked) < kLookAgain) return false;
    if (!has_gone(starter, frame)) return false;
    if (is_known(starter)) return true;
    Riser& riser = risers_.emplace_back();
    riser.id = *starter.left;
    riser.at = starter.at;
    riser.place = starter.place;
    riser.mask = starter.gone;
    riser.picture = kept(frame.picture.part(starter.place));
    riser.since_beginning =
        !beginning_.empty() && detect::background::same_within(beginning_.part(riser.place), starter.scene, riser.mask);
    detector.believe(frame.picture, riser.mask, riser.place.tl());
    found = found || riser.since_beginning;
    return true;
  });
  return found;
}

Picture StandingPeople::without_them(const Picture& picture) const {
  Picture result = picture;
  // Where one stood before another, what the first to leave uncovered is nearer to the beginning.
  for (auto riser = risers_.rbegin(); riser != risers_.rend(); ++riser) {
    if (riser->since_beginning) result = detect::background::patched(result, riser->picture, riser->mask, riser->place.tl());
  }
  return result;
}

int StandingPeople::since_beginning() const {
  return static_cast<int>(std::count_if(risers_.begin(), risers_.end(), [](const Riser& riser) { return riser.since_beginning; }));
}

std::vector<std::string> StandingPeople::said(std::size_t from) const {
  std::vector<std::string> sentences;
  for (std::size_t i = from; i < risers_.size(); ++i) {
    const Riser& riser = risers_[i];
    sentences.push_back(fmt::format("{:.1f} s: person {} came out of the background, of which they had been taken for a part",
                                    seconds(riser.at - *first_), number(riser.id)));
  }
  return sentences;
}

}  // namespace marey::pipeline::people
