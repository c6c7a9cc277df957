// People go from goal to goal: they gain and lose speed by 3 m/s² and turn by a few rad/s, as people do, unless a situation wants
// it abrupt. Where they shall keep apart, the image is cut into lanes one above the other, with room for a person and its arms; a
// goal is a place in one's own lane. Meetings (crossing, post) are laid out backwards from the instant of the meeting.
#include "marey/simulate/people/people_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "marey/simulate/people/people_returns.h"
#include "marey/simulate/people/walker.h"

namespace marey::simulate::people {
namespace {

constexpr double kWide = 0.36;        // of a person from the side in mid stride, in heights
constexpr double kPassing = 0.7;      // m between two who meet behind a board
constexpr double kLaneHeights = 1.9;  // a lane, in heights of the people in it

class Director {
 public:
  Director(const LevelCamera& camera, const PeopleVideoOptions& options, Random& random)
      : camera_(camera), options_(options), random_(random), dt_(1 / options.rate_hz) {
    motion_.frames.resize(static_cast<std::size_t>(*options.frames));
  }

  void in_lanes(bool abrupt, bool over_border);
  void crossing();
  void overlap();
  void behind_posts();
  void crowd();
  void standing();
  PeopleMotion take() { return std::move(motion_); }

 private:
  int new_figure(int team) {
    motion_.figures.push_back(draw_figure(random_, team));
    return static_cast<int>(motion_.figures.size());
  }
  double stature(int id) const { return motion_.figures[static_cast<std::size_t>(id - 1)].stature; }
  double speed() { return options_.pace * (random_.chance(0.6) ? random_.uniform(0.9, 1.9) : random_.uniform(2.5, 5.0)); }
  /// Height in the image, px, of a person whose feet are at a row.
  double height_at(double row) const {
    const auto at = camera_.on_ground({camera_.size.width / 2.0, row});
    return at ? 1.78 * std::cos(camera_.pitch) * camera_(Vector<3>(at->x(), at->y(), 0))->scale : 1;
  }
  Vector<2> ground(double column, double row) const {
    // Above the horizon no one can stand: as far away as the image's top row that shows ground.
    for (double r = row;; r += 1) {
      if (const auto at = camera_.on_ground({column, r})) return *at;
    }
  }
  struct Lane {
    double top = 0, bottom = 0;  // rows between which the feet go
  };
  std::vector<Lane> lanes(int required) const;
  void begin(Walker& walker, const Vector<2>& location, const Vector<2>& goal);
  Vector<2> anywhere(bool outside);
  void walk_anywhere(Walker& walker, double now, int& team);
  void walk_straight(int id, const Vector<2>& at, double when, const Vector<2>& velocity, double wander);
  void change_shape(Walker& walker, bool abrupt);

  LevelCamera camera_;
  PeopleVideoOptions options_;
  Random& random_;
  double dt_;
  PeopleMotion motion_;
};

std::vector<Director::Lane> Director::lanes(int required) const {
  // As many as wanted and as fit, about the middle of the image.
  const double middle = camera_.size.height / 2.0;
  const double room = required * kLaneHeights * height_at(middle);
  std::vector<Lane> found;
  for (double row = std::min(camera_.size.height - 6.0, middle + room / 2 - 0.4 * height_at(middle));
       static_cast<int>(found.size()) < required;) {
    const double height = height_at(row);
    const double top = row - kLaneHeights * height;
    if (top < 4 && !found.empty()) break;
    found.push_back({row - 0.55 * height, row});
    row = top;
  }
  return found;
}

void Director::begin(Walker& walker, const Vector<2>& location, const Vector<2>& goal) {
  walker.goal = goal;
  walker.stance.location = location;
  walker.stance.heading = std::atan2((goal - location).y(), (goal - location).x());
  walker.stance.phase = random_.uniform(0, 2 * std::numbers::pi);
  walker.requested_speed = speed();
  walker.stance.speed = walker.requested_speed;
}

void Director::change_shape(Walker& walker, bool abrupt) {
  if (!abrupt || !random_.chance(0.9 * dt_)) return;
  walker.requested_crouch = random_.chance(0.5) ? random_.uniform(0.4, 1) : 0;
  walker.requested_reach = random_.chance(0.5) ? random_.uniform(0.5, 1) : 0;
}

void Director::in_lanes(bool abrupt, bool over_border) {
  const double width = camera_.size.width;
  int team = 0;
  for (const Lane& lane : lanes(*options_.people)) {
    const double height = height_at(lane.bottom);
    const double low = over_border ? -0.6 * height : 0.7 * height;
    const double high = over_border ? width + 0.6 * height : width - 0.7 * height;
    const auto location = [&](double column) { return ground(column, random_.uniform(lane.top, lane.bottom)); };
    const auto side = [&](bool right) { return location(right ? high : low); };
    Walker walker;
    walker.id = new_figure(team++ % 2);
    bool right = random_.chance(0.5);
    begin(walker, location(random_.uniform(std::max(low, 0.1 * width), std::min(high, 0.9 * width))),
          over_border ? side(right) : location(random_.uniform(low, high)));
    for (std::size_t frame = 0; frame < motion_.frames.size(); ++frame) {
      const double now = static_cast<double>(frame) * dt_;
      motion_.frames[frame].push_back({walker.id, walker.stance});
      change_shape(walker, abrupt);
      const bool bored = abrupt && random_.chance(0.7 * dt_);
      if (!walker.walk(now, dt_, stature(walker.id), abrupt) && !bored) continue;
      if (random_.chance(0.3)) walker.rests_until = now + random_.uniform(0.3, 1.5);
      walker.requested_speed = speed();
      if (over_border) {
        const double column = camera_(Vector<3>(walker.stance.location.x(), walker.stance.location.y(), 0))->at.x();
        const bool gone = column < -0.3 * height || column > width - 1 + 0.3 * height;
        if (gone) {
          walker.id = new_figure(team++ % 2);
          walker.stance.location = side(right);
        }
        // Some turn back at the very border, half of them outside.
        right = !right;
        if (random_.chance(0.35)) {
          walker.goal = location(right ? width - 1 : 0);
          continue;
        }
      }
      walker.goal = over_border ? side(right) : location(random_.uniform(low, high));
    }
  }
}

/// On a path that passes a place at an instant; its heading swings by up to `wander` rad, for no person walks like a machine.
void Director::walk_straight(int id, const Vector<2>& at, double when, const Vector<2>& velocity, double wander) {
  Walker walker;
  walker.id = id;
  walker.stance.speed = velocity.norm();
  walker.stance.heading = std::atan2(velocity.y(), velocity.x());
  walker.stance.location = at - when * velocity;
  walker.stance.phase = random_.uniform(0, 2 * std::numbers::pi);
  const double beat = random_.uniform(0.15, 0.4);  // Hz
  const double heading = walker.stance.heading;
  for (std::size_t frame = 0; frame < motion_.frames.size(); ++frame) {
    motion_.frames[frame].push_back({walker.id, walker.stance});
    const double since = static_cast<double>(frame) * dt_ - when;
    walker.stance.heading = heading + wander * std::sin(2 * std::numbers::pi * beat * since);
    walker.step(dt_, stature(walker.id));
  }
}

void Director::crossing() {
  const double middle = 0.45 * static_cast<double>(motion_.frames.size()) * dt_;
  const int team = random_.integer(0, 1);
  const int far = new_figure(team);
  const int near = new_figure(random_.chance(0.5) ? team : 1 - team);
  const double row = camera_.size.height * random_.uniform(0.5, 0.7);
  const double column = camera_.size.width * random_.uniform(0.4, 0.6);
  const double height = height_at(row);
  const Vector<2> far_at = ground(column, row);
  const double nearer = random_.uniform(0.15, 0.5) * height, aside = random_.gaussian(0, 0.08 * height);
  const Vector<2> near_at = ground(column + aside, row + nearer);
  // Both widths are passed in the time of the overlap.
  const double px_per_m = camera_(Vector<3>(far_at.x(), far_at.y(), 0))->scale;
  const double apart = 2 * kWide * height / px_per_m / (options_.overlap_frames * dt_);
  const Vector<2> common = options_.pace * random_.uniform_pair(-1.6, 1.6, -0.6, 0.6);
  const double side = random_.chance(0.5) ? 0.5 : -0.5;
  const double drift = random_.uniform(-0.2, 0.2);
  walk_straight(far, far_at, middle, common + Vector<2>(side * apart, drift), random_.uniform(0.05, 0.2));
  walk_straight(near, near_at, middle, common - Vector<2>(side * apart, drift), random_.uniform(0.05, 0.2));
}

/// One comes up to the other from the side, stays in part before or behind it, and continues or turns back.
void Director::overlap() {
  const int team = random_.integer(0, 1);
  const std::array<int, 2> ids{new_figure(team), new_figure(options_.same_shirts ? team : 1 - team)};
  const double row = camera_.size.height * random_.uniform(0.5, 0.7);
  const double height = height_at(row);
  const double column = camera_.size.width * random_.uniform(0.4, 0.6);
  const Vector<2> far_at = ground(column, row), near_at = ground(column, row + random_.uniform(0.04, 0.45) * height);
  const double width = kWide * height / camera_(Vector<3>(far_at.x(), far_at.y(), 0))->scale;  // m
  const double side = random_.chance(0.5) ? 1 : -1, offset = random_.uniform(0.1, 0.75) * width;
  const double pace = options_.pace * random_.uniform(0.8, 2.5);
  const double after = random_.chance(0.5) ? side * pace : -side * pace;  // back again, or on past the other
  const Vector<2> common = options_.pace * random_.uniform_pair(-1.2, 1.2, -0.5, 0.5);
  const double length = static_cast<double>(motion_.frames.size()) * dt_;
  const double begin = 0.35 * length, end = begin + std::min(2.0, 0.3 * length);
  const int comes = random_.integer(0, 1);  // the farther or the nearer one
  std::array<Walker, 2> walkers;
  for (int identity = 0; identity < 2; ++identity) {
    walkers[identity].id = ids[identity];
    walkers[identity].stance.phase = random_.uniform(0, 2 * std::numbers::pi);
  }
  for (std::size_t frame = 0; frame < motion_.frames.size(); ++frame) {
    const double now = static_cast<double>(frame) * dt_;
    const double apart = side * offset + (now < begin ? side * pace * (begin - now) : now > end ? after * (now - end) : 0);
    const double relative = now < begin ? -side * pace : now > end ? after : 0;
    for (int identity = 0; identity < 2; ++identity) {
      Stance& stance = walkers[identity].stance;
      const Vector<2> velocity = common + Vector<2>(identity == comes ? relative : 0, 0);
      stance.location =
          (identity == 0 ? far_at : near_at) + (now - (begin + end) / 2) * common + Vector<2>(identity == comes ? apart : 0, 0);
      stance.speed += std::clamp(velocity.norm() - stance.speed, -kAbruptGain * dt_, kAbruptGain * dt_);
      const double turn = wrapped(std::atan2(velocity.y(), velocity.x()) - stance.heading);
      stance.heading += frame == 0 ? turn : std::clamp(turn, -kAbruptTurn * dt_, kAbruptTurn * dt_);
      stance.phase =
          wrapped(stance.phase + 2 * std::numbers::pi * stance.speed * dt_ / stride_length(stance.speed, stature(ids[identity])));
      motion_.frames[frame].push_back({ids[identity], stance});
    }
  }
}

void Director::behind_posts() {
  int team = 0;
  for (const Lane& lane : lanes(*options_.people)) {
    const double row = 0.5 * (lane.top + lane.bottom);
    const double height = height_at(row);
    const int id = new_figure(team++ % 2);
    const double least = options_.min_hidden_s ? *options_.min_hidden_s / options_.hidden_s : 0.2;
    const double hidden = random_.uniform(least, 1) * options_.hidden_s;
    const Vector<2> at = ground(camera_.size.width * random_.uniform(0.4, 0.6), row);
    const double px_per_m = camera_(Vector<3>(at.x(), at.y(), 0))->scale;
    // The board hides the whole width of a person for that long; the path ends within the image.
    const double length = static_cast<double>(motion_.frames.size()) * dt_;
    const double person = kWide * height / px_per_m;
    const double half = 0.36 * camera_.size.width / px_per_m;
    const double pace = std::min(options_.pace * random_.uniform(0.9, 2.4), half / (0.6 * length));
    const double wide = person + pace * hidden;
    const double side = random_.chance(0.5) ? 1 : -1;
    const double middle = random_.uniform(0.4, 0.55) * length;
    walk_straight(id, at, middle, {side * pace, random_.uniform(-0.03, 0.03) * pace}, 0.05);
    if (options_.in_pairs) {
      const int other = new_figure(options_.same_shirts ? (team + 1) % 2 : team % 2);
      walk_straight(other, at + Vector<2>(0, kPassing), middle, {-side * pace, random_.uniform(-0.03, 0.03) * pace}, 0.05);
    }
    const Vector<2> front = at - Vector<2>(0, 0.9);
    motion_.posts.push_back({front - Vector<2>(wide / 2, 0), front + Vector<2>(wide / 2, 0), 2.7, {74, 82, 96}});
  }
}

/// A place on the ground in the lower part of the image, or at its side without.
Vector<2> Director::anywhere(bool outside) {
  const double width = camera_.size.width;
  const double low_row = camera_.size.height - 4;
  const double high_row = std::max(0.3 * camera_.size.height, 4 + height_at(0.3 * camera_.size.height));
  const double row = random_.uniform(high_row, low_row);
  if (!outside) return ground(random_.uniform(0.05, 0.95) * width, row);
  return ground(random_.chance(0.5) ? -height_at(row) : width + height_at(row), row);
}

/// A step of a person who goes from goal to goal; a person who leaves the image is replaced by another person.
void Director::walk_anywhere(Walker& walker, double now, int& team) {
  if (!walker.walk(now, dt_, stature(walker.id), false)) return;
  const double column = camera_(Vector<3>(walker.stance.location.x(), walker.stance.location.y(), 0))->at.x();
  if (column < -10 || column > camera_.size.width + 10) {
    walker.id = new_figure(team++ % 2);
    const Vector<2> goal = anywhere(false);
    begin(walker, anywhere(true), goal);
    return;
  }
  if (random_.chance(0.3)) walker.rests_until = now + random_.uniform(0.5, 4);
  walker.requested_speed = speed();
  walker.goal = anywhere(random_.chance(0.25));
}

void Director::crowd() {
  std::vector<Walker> walkers(static_cast<std::size_t>(*options_.people));
  int team = 0;
  for (Walker& walker : walkers) {
    walker.id = new_figure(team++ % 2);
    const Vector<2> goal = anywhere(false);
    begin(walker, anywhere(false), goal);
  }
  for (std::size_t frame = 0; frame < motion_.frames.size(); ++frame) {
    const double now = static_cast<double>(frame) * dt_;
    for (Walker& walker : walkers) {
      motion_.frames[frame].push_back({walker.id, walker.stance});
      walk_anywhere(walker, now, team);
    }
  }
}

/// Half of them stand from the first frame on, shifting their weight, and walk off in the second half of the video, each at a
/// instant of their own; the others walk about between them.
void Director::standing() {
  constexpr double kApart = 1.5, kSway = 0.02, kBeat = 0.3;  // m, m, Hz
  constexpr double kMinLength = 0.55, kLongest = 0.8;        // of the video, that they stand
  const double length = static_cast<double>(motion_.frames.size()) * dt_;
  std::vector<Walker> people(static_cast<std::size_t>(*options_.people));
  const std::size_t standing = (people.size() + 1) / 2;
  std::vector<Vector<2>> home(standing);
  std::vector<double> leaves(standing);
  int team = 0;
  for (std::size_t i = 0; i < people.size(); ++i) {
    people[i].id = new_figure(team++ % 2);
    Vector<2> location = anywhere(false);
    const auto crowded = [&](const Vector<2>& other) { return (other - location).norm() < kApart; };
    for (int tries = 0;
         i < standing && tries < 100 && std::any_of(home.begin(), home.begin() + static_cast<std::ptrdiff_t>(i), crowded); ++tries)
      location = anywhere(false);
    begin(people[i], location, anywhere(i < standing));
    if (i >= standing) continue;
    people[i].stance.speed = 0;
    people[i].stance.heading = random_.uniform(0, 2 * std::numbers::pi);
    home[i] = location;
    leaves[i] = random_.uniform(kMinLength, kLongest) * length;
  }
  for (std::size_t frame = 0; frame < motion_.frames.size(); ++frame) {
    const double now = static_cast<double>(frame) * dt_;
    for (std::size_t i = 0; i < people.size(); ++i) {
      motion_.frames[frame].push_back({people[i].id, people[i].stance});
      if (i < standing && now < leaves[i]) {
        const double phase = 2 * std::numbers::pi * kBeat * now + static_cast<double>(i);
        people[i].stance.location = home[i] + kSway * Vector<2>(std::sin(phase), std::cos(0.7 * phase));
      } else {
        walk_anywhere(people[i], now, team);
      }
    }
  }
}

}  // namespace

PeopleMotion move_people(PeopleSituation situation, const LevelCamera& camera, const PeopleVideoOptions& options, Random& random) {
  Director director(camera, options, random);
  switch (situation) {
    case PeopleSituation::apart:
      director.in_lanes(false, false);
      break;
    case PeopleSituation::abrupt:
      director.in_lanes(true, false);
      break;
    case PeopleSituation::border:
      director.in_lanes(false, true);
      break;
    case PeopleSituation::crossing:
      director.crossing();
      break;
    case PeopleSituation::overlap:
      director.overlap();
      break;
    case PeopleSituation::post:
      director.behind_posts();
      break;
    case PeopleSituation::crowd:
      director.crowd();
      break;
    case PeopleSituation::standing:
      director.standing();
      break;
    case PeopleSituation::returns:
      return move_returning(camera, options, random);
  }
  return director.take();
}

}  // namespace marey::simulate::people
