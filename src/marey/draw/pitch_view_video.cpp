#include "marey/draw/pitch_view_video.h"

#include <algorithm>
#include <utility>

#include "marey/draw/overlay.h"

namespace marey::draw {
namespace {

constexpr double kRound = 3;  // m round the pitch that the view from above shows, beyond the margin

/// What fits on a disc.
std::string short_text_of(const TrackName& name, TrackId id) {
  constexpr std::size_t maximum = 3;
  return name.label.empty() || name.label.size() > maximum ? std::to_string(number(id)) : name.label;
}

}  // namespace

PitchViewVideo::PitchViewVideo(const std::string& path, const ShownGround& ground, std::optional<double> rate_hz)
    : path_(path), ground_(ground), rate_hz_(rate_hz) {
  if (!ground.pitch) return;
  const double round = std::clamp(ground.margin, 0.0, 10.0) + kRound;
  open({-round, -round}, {ground.pitch->length + round, ground.pitch->width + round});
}

Sink::SinkRequirements PitchViewVideo::begin(const RecordingHeader& /*header*/) {
  return {};
}

void PitchViewVideo::open(const Vector<2>& low, const Vector<2>& high) {
  view_.emplace(PitchViewOptions{.pitch = ground_.pitch, .low = low, .high = high, .y_down = ground_.mirrored});
  movie_.emplace(path_, view_->size(), rate_hz_);
}

std::vector<PitchView::Mark> PitchViewVideo::marks_of(const Instant& instant) const {
  std::vector<PitchView::Mark> marks;
  for (const Sample& sample : instant.samples) {
    const TrackName& name = names_.of(sample.track);
    marks.push_back({number(sample.track), short_text_of(name, sample.track), colour_of(name, sample.track),
                     sample.position.head<2>(), sample.measured()});
  }
  return marks;
}

void PitchViewVideo::write(const Instant& instant) {
  names_.add(instant.named);
  TimeStep time_step{instant.time, marks_of(instant)};
  if (movie_) {
    show(time_step);
  } else {
    waiting_.push_back(std::move(time_step));
  }
}

void PitchViewVideo::show(const TimeStep& time_step) {
  movie_->write(view_->draw(time_step.time, time_step.marks), time_step.time);
}

void PitchViewVideo::finish() {
  if (!movie_) {
    std::optional<Box> around;
    for (const TimeStep& time_step : waiting_) {
      for (const PitchView::Mark& mark : time_step.marks) {
        const Box here{mark.location.x(), mark.location.y(), 0, 0};
        around = around ? geometry::hull(*around, here) : here;
      }
    }
    const Box shown = around.value_or(Box{});
    open({shown.left - kRound, shown.top - kRound}, {shown.right() + kRound, shown.bottom() + kRound});
    for (const TimeStep& time_step : std::exchange(waiting_, {})) show(time_step);
  }
  movie_->finish();
}

}  // namespace marey::draw
