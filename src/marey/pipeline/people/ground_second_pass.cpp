#include "marey/pipeline/people/ground_second_pass.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>

#include "marey/draw/canvas.h"
#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/pipeline/people/ball_on_ground.h"

namespace marey::pipeline::people {
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
    appearances[static_cast<std::size_t>(number(track)) - 1] = joined.wears[static_cast<std::size_t>(number(before)) - 1];
  options.pitch = area.pitch();
  people.teams = analyse::find_teams(people.recording, appearances, options);
  analyse::note_teams(people.teams, people.recording);
}

/// The recording, instant by instant.
class GroundInstants final : public corridor::InstantSource {
 public:
  GroundInstants(const GroundPeople& people, const GroundTracked& tracked, const GroundBoxes& boxes,
                 const std::vector<Recording::Moment>& moments)
      : people_(people), tracked_(tracked), boxes_(boxes), moments_(moments), instants_(people.recording) {}

  std::optional<Instant> next() override {
    if (next_ == moments_.size()) return std::nullopt;
    const Recording::Moment& moment = moments_[next_++];
    if (!ahead_) ahead_ = instants_.next();
    Instant instant;
    if (ahead_ && ahead_->index == moment.index) instant = std::move(*std::exchange(ahead_, std::nullopt));
    instant.index = moment.index;
    instant.time = moment.time;
    for (TrackName& name : instant.named) name.colour = colour_of(people_.teams, name.id);
    name_ball(instant);
    name_unnamed(instant);
    const Timestamp rig_time = instant.time + rig_time_offset(tracked_.header.time_base, tracked_.cameras.rig());
    if (boxes_.wanted()) boxes_.add_to(instant, rig_time, tracked_.cameras, tracked_.area, people_.ball);
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
  GroundTracked tracked_;
  const GroundBoxes& boxes_;
  const std::vector<Recording::Moment>& moments_;
  InstantsOf instants_;
  std::optional<Instant> ahead_;
  std::set<TrackId> named_;
  std::size_t next_ = 0;
};

}  // namespace

GroundPeople second_pass(track::ground::GroundRun& tracking, const GroundTracked& tracked, GroundBoxes& boxes,
                         std::vector<track::ball::BallMoment> ball_candidates, const PeopleOnGroundOptions& options,
                         const Hooks& hooks) {
  const corridor::Stopwatch taken;
  GroundPeople people;
  auto joined = tracking.finish(
      [&](const Vector<2>& position, Timestamp time) { return tracked.cameras.in_view(position, time, tracked.area); });
  people.links = std::ssize(joined.joins);
  people.uncertain_links =
      std::count_if(joined.joins.begin(), joined.joins.end(), [](const auto& one) { return one.probability < kConfidentLink; });
  const std::size_t all = joined.recording.tracks().size();
  joined.recording.header.rig = tracked.cameras.rig();
  joined.recording.header.time_base = {.kind = TimeBase::Kind::rig};
  reconstruct::KeptPeople kept =
      reconstruct::people_in(tracked.area, with_time_base(std::move(joined.recording), tracked.header.time_base));
  people.recording = std::move(kept.recording);
  people.recording.header = tracked.header;
  people.outside = static_cast<std::int64_t>(all - kept.now.size());
  find_teams(joined, kept.now, tracked.area, options.teams, people);
  boxes.rename([&](TrackId track, std::int32_t instant) -> std::optional<TrackId> {
    const auto person = joined.person_of(track, instant);
    const auto now = person ? kept.now.find(*person) : kept.now.end();
    if (now == kept.now.end()) return std::nullopt;
    return now->second;
  });
  if (options.ball)
    people.ball =
        follow_ball(std::move(ball_candidates), tracked.cameras.views(), tracked.area, *options.ball, hooks, people.recording);
  people.seconds = taken.seconds();
  return people;
}

std::unique_ptr<corridor::InstantSource> ground_instants(const GroundPeople& people, const GroundTracked& tracked,
                                                         const GroundBoxes& boxes, const std::vector<Recording::Moment>& moments) {
  return std::make_unique<GroundInstants>(people, tracked, boxes, moments);
}

}  // namespace marey::pipeline::people
