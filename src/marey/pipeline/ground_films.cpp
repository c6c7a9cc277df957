#include "marey/pipeline/ground_films.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "marey/core/labelled_box.h"
#include "marey/core/source.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/overlay.h"
#include "marey/draw/pitch_view.h"
#include "marey/format/tracks/mot.h"
#include "marey/format/whole_file.h"
#include "marey/pipeline/people_eyes.h"
#include "marey/pipeline/read_ahead.h"

namespace marey::pipeline {
namespace {

constexpr double kRound = 3;  // m round the pitch that the view from above shows, beyond the margin

/// Who is there at one frame after the other; frames are asked for in order.
class FrameRows {
 public:
  explicit FrameRows(const Recording& recording) : instants_(recording.instants()), rows_(recording) {}

  std::span<const InstantRows::Row> at(std::int32_t frame) {
    while (next_ < instants_.size() && instants_[next_].index < frame) ++next_;
    if (next_ == instants_.size() || instants_[next_].index != frame) return {};
    return rows_.at(next_);
  }

 private:
  const std::vector<Recording::Moment>& instants_;
  InstantRows rows_;
  std::size_t next_ = 0;
};

/// A person in a camera's view: the number of the camera, its log, and the row.
struct InView {
  const GroundShow& show;
  std::size_t number;
  const ViewLog& log;

  const TrackColumns& track(const InstantRows::Row& row) const { return show.recording.tracks()[row.track]; }

  /// The person's box in the view, cut at the picture's border, if some of it is within.
  std::optional<Box> box(const InstantRows::Row& row, std::int32_t frame) const {
    if (const auto seen = log.box(frame, track(row).id())) return seen;
    const auto box = show.cameras.box_at(number, show.area.world(track(row).place(row.row)));
    if (!box) return std::nullopt;
    const cv::Size size = show.cameras.views()[number].size();
    const Box cut = geometry::intersection(*box, {0, 0, static_cast<double>(size.width), static_cast<double>(size.height)});
    if (cut.empty()) return std::nullopt;
    return cut;
  }
};

std::string text_of(const TrackName& person) {
  return person.label.empty() ? std::to_string(number(person.id)) : person.label;
}

/// What fits on a disc.
std::string short_text_of(const TrackName& person) {
  constexpr std::size_t most = 3;
  return person.label.empty() || person.label.size() > most ? std::to_string(number(person.id)) : person.label;
}

/// What the overlay draws of one row; nothing where it is out of the picture.
std::optional<Track<2>> track_in_view(const InView& view, const InstantRows::Row& row, std::int32_t frame) {
  const TrackColumns& person = view.track(row);
  const auto box = view.box(row, frame);
  const auto foot = view.show.cameras.views()[view.number].pixel(view.show.area.world(person.place(row.row)));
  if (!box || !foot) return std::nullopt;
  Track<2> track;
  track.id = person.id();
  track.label = text_of(person.name);
  track.position = *foot;
  track.box = box;
  const bool seen = (person.cameras()[row.row] & mask_of(CameraId{static_cast<int>(view.number)})) != 0;
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
  options.low = options.high = Vector<2>::Zero();
  bool any = false;
  for (const TrackColumns& track : show.recording.tracks()) {
    for (std::size_t row = 0; row < track.size(); ++row) {
      const Vector<2> place = track.place(row);
      options.low = any ? Vector<2>(options.low.cwiseMin(place)) : place;
      options.high = any ? Vector<2>(options.high.cwiseMax(place)) : place;
      any = true;
    }
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

void ViewLog::name(const std::function<std::optional<TrackId>(TrackId, std::int32_t)>& person_of) {
  const auto kept = std::remove_if(rows_.begin(), rows_.end(), [&](Row& row) {
    const auto person = person_of(TrackId{row.who}, row.frame);
    if (person) row.who = number(*person);
    return !person;
  });
  rows_.erase(kept, rows_.end());
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const Row& a, const Row& b) { return std::pair(a.frame, a.who) < std::pair(b.frame, b.who); });
}

std::optional<Box> ViewLog::box(std::int32_t frame, TrackId person) const {
  const auto at = std::lower_bound(rows_.begin(), rows_.end(), std::pair(frame, number(person)),
                                   [](const Row& row, const auto& wanted) { return std::pair(row.frame, row.who) < wanted; });
  if (at == rows_.end() || at->frame != frame || at->who != number(person)) return std::nullopt;
  return Box{at->left, at->top, at->width, at->height};
}

void write_view_boxes(const GroundShow& show, std::size_t number, const ViewLog& log, const std::string& path) {
  format::WholeFile file(path);
  FrameRows rows(show.recording);
  const InView view{show, number, log};
  std::string text;
  for (const ViewLog::FramePair& frame : log.frames()) {
    for (const InstantRows::Row& row : rows.at(frame.instant)) {
      if (const auto box = view.box(row, frame.instant))
        format::tracks::append_mot(text, {frame.own, marey::number(view.track(row).id()), *box, 1});
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
    options.colours[show.recording.tracks()[person].id()] = show.colours[person];
  draw::Overlay overlay(options);
  FrameRows rows(show.recording);
  const InView view{show, number, log};
  std::vector<Track<2>> tracks;
  bool stopped = false;
  const auto frames = log.frames();
  for (std::size_t at = 0; at < frames.size() && !stopped;) {
    const auto frame = source->next();
    if (!frame) break;
    if (frame->index < frames[at].own) continue;
    tracks.clear();
    for (const InstantRows::Row& row : rows.at(frames[at].instant)) {
      if (auto track = track_in_view(view, row, frames[at].instant)) tracks.push_back(std::move(*track));
    }
    movie.write(overlay.draw(frame->picture, frame->time, tracks), frame->time);
    stopped = show.hooks.tell({TrackProgress::Step::drawing, static_cast<std::int64_t>(++at), std::ssize(frames)});
  }
  movie.finish();
  return stopped;
}

bool film_ground(const GroundShow& show, const std::string& path) {
  const Recording& recording = show.recording;
  draw::PitchView view(view_of(show));
  draw::MovieWriter movie(path, view.size(), show.cameras.rate_hz());
  InstantRows rows(recording);
  std::vector<draw::PitchView::Mark> marks;
  bool stopped = false;
  const std::size_t count = recording.instants().size();
  for (std::size_t instant = 0; instant < count && !stopped; ++instant) {
    marks.clear();
    for (const auto& [index, row] : rows.at(instant)) {
      const TrackColumns& track = recording.tracks()[index];
      marks.push_back(
          {number(track.id()), short_text_of(track.name), show.colours[index], track.place(row), track.measured(row)});
    }
    const Timestamp now = recording.instants()[instant].time;
    movie.write(view.draw(now, marks), now);
    stopped =
        show.hooks.tell({TrackProgress::Step::drawing, static_cast<std::int64_t>(instant) + 1, static_cast<std::int64_t>(count)});
  }
  movie.finish();
  return stopped;
}

}  // namespace marey::pipeline
