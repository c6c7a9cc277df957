// Possession goes to the nearest within reach and stays, with hysteresis, until the ball is well away or another has it: the rule
// of Link and Hoernig (2017, "Individual ball possession in soccer") without its model of touches. A pass is a change of who has
// it.
#include "marey/analyse/possession.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace marey::analyse {
namespace {

struct BallNow {
  Vector<3> location;
  double time = 0;
  bool dead = false;
};

class Possession {
 public:
  Possession(const Recording& recording, const PossessionOptions& options) : recording_(recording), options_(options) {}

  void step(const BallNow& ball, std::span<const InstantRows::Row> rows) {
    if (ball.dead || ball.location.z() > options_.reach_m) {
      end_spell();
      was_dead_ |= ball.dead;
      return;
    }
    const TrackColumns* holder = holder_of(ball, rows);
    if (holder == nullptr) return end_spell();
    if (!open_ || open_->person != number(holder->id())) {
      end_spell();
      open_ = BallSpell{number(holder->id()),    holder->name.team,      ball.time, ball.time,
                        ball.location.head<2>(), ball.location.head<2>()};
    }
    open_->end_s = ball.time;
    open_->to = ball.location.head<2>();
  }

  void finish(BallMeasure& result) {
    end_spell();
    result.spells = std::move(spells_);
    result.passes = std::move(passes_);
  }

 private:
  /// Who is within reach: the one who has it, unless another is nearer and near.
  const TrackColumns* holder_of(const BallNow& ball, std::span<const InstantRows::Row> rows) const {
    const TrackColumns* holder = nullptr;
    double minimum = options_.keep_m;
    for (const auto& [index, row] : rows) {
      const TrackColumns& track = recording_.tracks()[index];
      if (track.name.kind == TrackKind::ball || track.name.team.empty() || track.name.team == "referee") continue;
      const double away = (track.location(row) - ball.location.head<2>()).norm();
      const bool has_it = open_ && open_->person == number(track.id());
      if (away >= minimum || (!has_it && away >= options_.take_m)) continue;
      minimum = away;
      holder = &track;
    }
    return holder;
  }

  void end_spell() {
    if (!open_) return;
    const BallSpell spell = *std::exchange(open_, std::nullopt);
    if (spell.end_s - spell.begin_s < options_.min_s) return;
    if (!spells_.empty() && !was_dead_ && spells_.back().person == spell.person) {
      spells_.back().end_s = spell.end_s;
      spells_.back().to = spell.to;
      return;
    }
    if (!spells_.empty() && !was_dead_) add_pass(spells_.back(), spell);
    was_dead_ = false;
    spells_.push_back(spell);
  }

  void add_pass(const BallSpell& from, const BallSpell& to) {
    const double length = (to.from - from.to).norm();
    if (length < options_.pass_m) return;
    passes_.push_back({from.person, to.person, from.team, from.end_s, to.begin_s, length, from.team == to.team});
  }

  const Recording& recording_;
  const PossessionOptions& options_;
  std::optional<BallSpell> open_;
  bool was_dead_ = false;  // since the last spell
  std::vector<BallSpell> spells_;
  std::vector<BallPass> passes_;
};

std::vector<TeamBall> by_team(const BallMeasure& ball) {
  std::map<std::string, TeamBall> teams;
  for (std::size_t i = 0; i < ball.spells.size(); ++i) {
    const BallSpell& spell = ball.spells[i];
    TeamBall& team = teams[spell.team];
    const bool passed =
        std::any_of(ball.passes.begin(), ball.passes.end(), [&](const BallPass& pass) { return pass.begin_s == spell.end_s; });
    const double end = passed && i + 1 < ball.spells.size() ? ball.spells[i + 1].begin_s : spell.end_s;
    team.possession_s += end - spell.begin_s;
  }
  for (const BallPass& pass : ball.passes) {
    ++teams[pass.team].passes;
    teams[pass.team].completed += pass.completed ? 1 : 0;
  }
  std::vector<TeamBall> result;
  for (auto& [name, team] : teams) {
    team.team = name;
    result.push_back(team);
  }
  return result;
}

}  // namespace

std::optional<BallMeasure> measure_ball(const Recording& recording, const PossessionOptions& options) {
  require_ground(recording, "measuring");
  const auto found = std::find_if(recording.tracks().begin(), recording.tracks().end(),
                                  [](const TrackColumns& track) { return track.name.kind == TrackKind::ball && !track.empty(); });
  if (found == recording.tracks().end()) return std::nullopt;
  const TrackColumns& track = *found;
  BallMeasure result;
  Possession possession(recording, options);
  InstantRows rows(recording);
  std::optional<BallNow> last;
  for (std::size_t row = 0; row < track.size(); ++row) {
    const auto instant = static_cast<std::size_t>(track.at()[row]);
    const BallNow now{
        track.position(row), recording.seconds_at(instant),
        track.x()[row] < 0 || track.y()[row] < 0 || track.x()[row] > options.pitch.length || track.y()[row] > options.pitch.width};
    constexpr double kGap = 0.5;  // s; across a longer one nothing is counted
    const double step = last ? now.time - last->time : 0;
    if (step > 0 && step < kGap) {
      result.seconds += step;
      result.dead_s += now.dead ? step : 0;
      const double metres = (now.location - last->location).norm();
      result.distance_m += metres;
      const auto velocity = track.velocity(row);
      result.top_mps = std::max(result.top_mps, velocity ? velocity->norm() : metres / step);
    }
    possession.step(now, rows.at(instant));
    last = now;
  }
  possession.finish(result);
  result.teams = by_team(result);
  return result;
}

}  // namespace marey::analyse
