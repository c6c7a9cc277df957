#include "marey/pipeline/ground_films.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "marey/core/labelled_box.h"
#include "marey/core/source.h"
#include "marey/core/whole_file.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/overlay.h"
#include "marey/draw/pitch_view.h"
#include "marey/format/tracks/mot.h"
#include "marey/pipeline/people_eyes.h"
#include "marey/pipeline/read_ahead.h"

namespace marey::pipeline {
namespace {

constexpr double kRound = 3;  // m round the pitch that the view from above shows, beyond the margin

/// Samples of one instant after the other; instants are asked for in order.
class Instant {
 public:
  explicit Instant(const GroundRecording& recording) : samples_(recording.samples) {}

  std::span<const GroundRecording::Sample> at(std::int32_t frame) {
    while (next_ < samples_.size() && samples_[next_].frame < frame) ++next_;
    const std::size_t first = next_;
    while (next_ < samples_.size() && samples_[next_].frame == frame) ++next_;
    return samples_.subspan(first, next_ - first);
  }

 private:
  std::span<const GroundRecording::Sample> samples_;
  std::size_t next_ = 0;
};

/// The person's box in the view, cut at the picture's border, if some of it is within.
std::optional<Box> box_in_view(const GroundShow& show, std::size_t number, const ViewLog& log,
                               const GroundRecording::Sample& sample) {
  if (const auto seen = log.box(sample.frame, sample.person)) return seen;
  const auto box = show.cameras.box_at(number, show.area.world(sample.place));
  if (!box) return std::nullopt;
  const cv::Size size = show.cameras.views()[number].size();
  const Box cut = geometry::intersection(*box, {0, 0, static_cast<double>(size.width), static_cast<double>(size.height)});
  if (cut.empty()) return std::nullopt;
  return cut;
}

std::string text_of(const GroundRecording::Person& person) {
  return person.label.empty() ? std::to_string(person.id) : person.label;
}

/// What fits on a disc.
std::string short_text_of(const GroundRecording::Person& person) {
  constexpr std::size_t most = 3;
  return person.label.empty() || person.label.size() > most ? std::to_string(person.id) : person.label;
}

/// What the overlay draws of one sample; nothing where it is out of the picture.
std::optional<Track<2>> track_in_view(const GroundShow& show, std::size_t number, const ViewLog& log,
                                      const GroundRecording::Sample& sample) {
  const auto box = box_in_view(show, number, log, sample);
  const auto foot = show.cameras.views()[number].pixel(show.area.world(sample.place));
  if (!box || !foot) return std::nullopt;
  const GroundRecording::Person& person = show.recording.people[static_cast<std::size_t>(sample.person)];
  Track<2> track;
  track.id = TrackId{person.id};
  track.label = text_of(person);
  track.position = *foot;
  track.box = box;
  const bool seen = (sample.cameras & mask_of(CameraId{static_cast<int>(number)})) != 0;
  track.state = seen ? Track<2>::State::observed : Track<2>::State::predicted;
  return track;
}

/// The part of the ground to be shown: the pitch, or else where people were.
draw::PitchViewOptions view_of(const GroundShow& show) {
  draw::PitchViewOptions options;
  options.y_down = show.area.mirrored();
  if (const auto& pitch = show.area.pitch()) {
    options.pitch = pitch;
    const double round = std::clamp(show.area.margin(), 0.0, 10.0) + kRound;
    options.low = {-round, -round};
    options.high = {pitch->length + round, pitch->width + round};
    return options;
  }
  options.low = options.high = show.recording.samples.empty() ? Vector<2>(0, 0) : show.recording.samples.front().place;
  for (const GroundRecording::Sample& sample : show.recording.samples) {
    options.low = options.low.cwiseMin(sample.place);
    options.high = options.high.cwiseMax(sample.place);
  }
  options.low -= Vector<2>(kRound, kRound);
  options.high += Vector<2>(kRound, kRound);
  return options;
}

}  // namespace

void ViewLog::add_box(std::int32_t frame, TrackId track, const Box& box) {
  rows_.push_back({frame, number(track), static_cast<float>(box.left), static_cast<float>(box.top), static_cast<float>(box.width),
                   static_cast<float>(box.height)});
}

void ViewLog::name(const std::function<std::optional<int>(TrackId, std::int32_t)>& person_of) {
  const auto kept = std::remove_if(rows_.begin(), rows_.end(), [&](Row& row) {
    const auto person = person_of(TrackId{row.who}, row.frame);
    if (person) row.who = *person;
    return !person;
  });
  rows_.erase(kept, rows_.end());
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const Row& a, const Row& b) { return std::pair(a.frame, a.who) < std::pair(b.frame, b.who); });
}

std::optional<Box> ViewLog::box(std::int32_t frame, std::int32_t person) const {
  const auto at = std::lower_bound(rows_.begin(), rows_.end(), std::pair(frame, person),
                                   [](const Row& row, const auto& wanted) { return std::pair(row.frame, row.who) < wanted; });
  if (at == rows_.end() || at->frame != frame || at->who != person) return std::nullopt;
  return Box{at->left, at->top, at->width, at->height};
}

void write_view_boxes(const GroundShow& show, std::size_t number, const ViewLog& log, const std::string& path) {
  WholeFile file(path);
  Instant instant(show.recording);
  std::string text;
  for (const ViewLog::FramePair& frame : log.frames()) {
    for (const GroundRecording::Sample& sample : instant.at(frame.instant)) {
      const auto box = box_in_view(show, number, log, sample);
      if (!box) continue;
      format::tracks::append_mot(text, {frame.own, show.recording.people[static_cast<std::size_t>(sample.person)].id, *box, 1});
    }
    file.write(text);
    text.clear();
  }
  file.finish();
}

bool film_view(const GroundShow& show, std::size_t number, const ViewLog& log, const std::string& path) {
  const RigCamera& camera = show.cameras.rig().cameras[number];
  const auto source = read_ahead(open_pictures({.pictures = camera.source, .rate_hz = camera.rate_hz, .region = camera.region}));
  draw::MovieWriter movie(path, source->info().size, source->info().rate_hz);
  draw::OverlayOptions options{.trail_of_centres = true};
  for (std::size_t person = 0; person < show.colours.size(); ++person)
    options.colours[TrackId{show.recording.people[person].id}] = show.colours[person];
  draw::Overlay overlay(options);
  Instant instant(show.recording);
  std::vector<Track<2>> tracks;
  bool stopped = false;
  const auto frames = log.frames();
  for (std::size_t at = 0; at < frames.size() && !stopped;) {
    const auto frame = source->next();
    if (!frame) break;
    if (frame->index < frames[at].own) continue;
    tracks.clear();
    for (const GroundRecording::Sample& sample : instant.at(frames[at].instant)) {
      if (auto track = track_in_view(show, number, log, sample)) tracks.push_back(std::move(*track));
    }
    movie.write(overlay.draw(frame->picture, frame->time, tracks), frame->time);
    stopped = show.hooks.tell({TrackProgress::Step::drawing, static_cast<std::int64_t>(++at), std::ssize(frames)});
  }
  movie.finish();
  return stopped;
}

bool film_ground(const GroundShow& show, std::span<const double> times, const std::string& path) {
  draw::PitchView view(view_of(show));
  draw::MovieWriter movie(path, view.size(), show.cameras.rate_hz());
  Instant instant(show.recording);
  std::vector<draw::PitchView::Mark> marks;
  bool stopped = false;
  for (std::int32_t frame = 0; frame < std::ssize(times) && !stopped; ++frame) {
    marks.clear();
    for (const GroundRecording::Sample& sample : instant.at(frame)) {
      const auto person = static_cast<std::size_t>(sample.person);
      marks.push_back({show.recording.people[person].id, short_text_of(show.recording.people[person]), show.colours[person],
                       sample.place, sample.observed});
    }
    const Timestamp now = timestamp_from_seconds(times[static_cast<std::size_t>(frame)]);
    movie.write(view.draw(now, marks), now);
    stopped = show.hooks.tell({TrackProgress::Step::drawing, frame + 1, std::ssize(times)});
  }
  movie.finish();
  return stopped;
}

}  // namespace marey::pipeline
