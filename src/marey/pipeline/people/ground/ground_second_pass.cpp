#include "marey/pipeline/people/ground/ground_second_pass.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "marey/draw/canvas.h"
#include "marey/pipeline/people/ground/ball_on_ground.h"

namespace marey::pipeline::people::ground {
namespace {

using track::ground::offline::GroundRecorder;

constexpr double kConfidentLink = 0.9;  // probability of a link below which it counts as uncertain

std::array<std::uint8_t, 3> bytes_of_colour(const draw::Colour& colour) {
  return {static_cast<std::uint8_t>(colour.red), static_cast<std::uint8_t>(colour.green), static_cast<std::uint8_t>(colour.blue)};
}

/// The team's colour for its players, none for other people.
std::optional<std::array<std::uint8_t, 3>> colour_of(const analyse::Teams& teams, TrackId track) {
  const auto i = static_cast<std::size_t>(number(track)) - 1;
  if (i >= teams.members.size() || !teams.members[i].team || teams.members[i].role != analyse::Teams::Role::player)
    return std::nullopt;
  return bytes_of_colour(draw::colour_of(teams.teams[static_cast<std::size_t>(*teams.members[i].team)].colour));
}

void find_teams(const GroundRecorder::Joined& joined, const std::map<TrackId, TrackId>& now, const reconstruct::GroundArea& area,
                analyse::TeamOptions options, GroundPeople& people) {
  std::vector<std::optional<Appearance>> appearances(now.size());
  for (const auto& [before, track] : now)
    appearances[static_cast<std::size_t>(number(track)) - 1] = joined.clothing[static_cast<std::size_t>(number(before)) - 1];
  options.pitch = area.pitch();
  people.teams = analyse::find_teams(people.recording, appearances, options);
  analyse::note_teams(people.teams, people.recording);
}

/// The recording, instant by instant.
class GroundInstants final : public corridor::InstantSource {
 public:
  GroundInstants(const GroundPeople& people, const GroundScene& scene, const GroundBoxes& boxes,
                 const std::vector<Recording::TimeStep>& time_steps)
      : people_(people), scene_(scene), boxes_(boxes), time_steps_(time_steps), instants_(people.recording) {}

  std::optional<Instant> next() override {
    if (next_ == time_steps_.size()) return std::nullopt;
    const Recording::TimeStep& time_step = time_steps_[next_++];
    if (!ahead_) ahead_ = instants_.next();
    Instant instant;
    if (ahead_ && ahead_->index == time_step.index) instant = std::move(*std::exchange(ahead_, std::nullopt));
    instant.index = time_step.index;
    instant.time = time_step.time;
    for (TrackName& name : instant.named) name.colour = colour_of(people_.teams, name.id);
    name_ball(instant);
    name_unnamed(instant);
    const Timestamp rig_time = instant.time + rig_time_offset(people_.recording.header.time_base, scene_.rig);
    if (boxes_.enabled()) boxes_.add_to(instant, rig_time, scene_, people_.ball);
    return instant;
  }

 private:
  /// In the first instant, so that a sink knows that there is a ball.
  void name_ball(Instant& instant) {
    std::erase_if(instant.named, [this](const TrackName& name) { return name.id == people_.ball; });
    if (next_ == 1 && people_.ball)
      instant.named.push_back(
          {*people_.ball, std::string(kBallLabel), {}, std::array<std::uint8_t, 3>{255, 255, 255}, TrackKind::ball});
  }

  /// A person with neither label nor team still has a colour.
  void name_unnamed(Instant& instant) {
    for (const TrackName& name : instant.named) named_.insert(name.id);
    for (const Sample& sample : instant.samples) {
      if (!named_.insert(sample.track).second) continue;
      instant.named.push_back({sample.track, {}, {}, colour_of(people_.teams, sample.track)});
    }
  }

  const GroundPeople& people_;
  const GroundScene& scene_;
  const GroundBoxes& boxes_;
  const std::vector<Recording::TimeStep>& time_steps_;
  InstantsOf instants_;
  std::optional<Instant> ahead_;
  std::set<TrackId> named_;
  std::size_t next_ = 0;
};

}  // namespace

GroundPeople second_pass(GroundRecorder::Joined joined, const GroundScene& scene, const RecordingHeader& header, GroundBoxes& boxes,
                         std::vector<track::ball::BallObservations> ball_candidates, const PeopleOnGroundOptions& options,
                         const Hooks& hooks) {
  GroundPeople people;
  people.links = std::ssize(joined.joins);
  people.uncertain_links =
      std::count_if(joined.joins.begin(), joined.joins.end(), [](const auto& one) { return one.probability < kConfidentLink; });
  const std::size_t all = joined.recording.tracks().size();
  joined.recording.header.rig = scene.rig;
  joined.recording.header.time_base = {.kind = TimeBase::Kind::rig};
  reconstruct::KeptPeople kept = reconstruct::people_in(scene.area, with_time_base(std::move(joined.recording), header.time_base));
  people.recording = std::move(kept.recording);
  people.recording.header = header;
  people.outside = static_cast<std::int64_t>(all - kept.now.size());
  find_teams(joined, kept.now, scene.area, options.teams, people);
  boxes.rename([&](TrackId track, std::int32_t instant) -> std::optional<TrackId> {
    const auto person = joined.person_of(track, instant);
    const auto now = person ? kept.now.find(*person) : kept.now.end();
    if (now == kept.now.end()) return std::nullopt;
    return now->second;
  });
  if (options.ball)
    people.ball = track_ball(std::move(ball_candidates), scene.views, scene.area, *options.ball, hooks, people.recording);
  return people;
}

std::unique_ptr<corridor::InstantSource> ground_instants(const GroundPeople& people, const GroundScene& scene,
                                                         const GroundBoxes& boxes,
                                                         const std::vector<Recording::TimeStep>& time_steps) {
  return std::make_unique<GroundInstants>(people, scene, boxes, time_steps);
}

void report_people(const GroundPeople& people, bool with_ball, bool ball_searched, corridor::Summary& summary) {
  summary.dropped.off_pitch = people.outside;
  corridor::GroundFigures& figures = summary.ground.emplace();
  figures.links = people.links, figures.uncertain_links = people.uncertain_links, figures.linking_s = people.linking_s;
  if (!with_ball) return;
  const TrackColumns* ball = people.ball ? people.recording.find(*people.ball) : nullptr;
  figures.ball_samples = ball == nullptr ? 0 : static_cast<std::int64_t>(ball->size());
  if (!ball_searched)
    summary.warnings.push_back(
        "the ball was not searched for: that needs images of a static camera and is calibrated (marey calibrate pitch)");
  else if (ball == nullptr)
    summary.warnings.push_back("the ball was not found");
}

}  // namespace marey::pipeline::people::ground
