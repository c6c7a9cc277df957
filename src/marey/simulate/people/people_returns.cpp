// Each walks about in the image, then leaves it at a side, goes to some place outside that can be reached and left again in the
// time that this one shall be away, and comes back to any place in the image. The ground outside is as the ground inside; no person
// knows where the image ends, so that some come back sooner, later or elsewhere than they meant to.
#include "marey/simulate/people/people_returns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "marey/simulate/people/walker.h"

namespace marey::simulate::people {
namespace {

constexpr double kMinAway = 1.5, kMaxAway = 9;  // s, outside with the whole body
constexpr double kStaysAway = 1.0 / 6;          // of those who leave
constexpr double kLeaves = 0.75;                // of those who have reached a goal in the image
constexpr double kExitPath = 0.45;              // of the path that time and pace allow, at most

class ReturningPeople {
 public:
  ReturningPeople(const LevelCamera& camera, const PeopleVideoOptions& options, Random& random)
      : camera_(camera), options_(options), random_(random), dt_(1 / options.rate_hz), people_(*options.people) {
    motion_.frames.resize(static_cast<std::size_t>(*options.frames));
  }

  PeopleMotion move() {
    for (Person& person : people_) {
      person.walker.id = new_figure();
      begin(person.walker, inside(), inside());
    }
    for (std::size_t frame = 0; frame < motion_.frames.size(); ++frame) {
      const double now = static_cast<double>(frame) * dt_;
      for (Person& person : people_) {
        motion_.frames[frame].push_back({person.walker.id, person.walker.stance});
        step(person, now);
      }
    }
    return std::move(motion_);
  }

 private:
  enum class Errand { within, leaving, away };
  struct Person {
    Walker walker;
    Errand errand = Errand::within;
    Vector<2> left_at = Vector<2>::Zero();  // m
    double back = 0;                        // s: when this one shall be in the image again
  };

  int new_figure() {
    motion_.figures.push_back(draw_figure(random_, static_cast<int>(motion_.figures.size()) % 2));
    return static_cast<int>(motion_.figures.size());
  }

  double stature(int id) const { return motion_.figures[static_cast<std::size_t>(id - 1)].stature; }
  double pace() { return options_.pace * (random_.chance(0.6) ? random_.uniform(0.9, 1.9) : random_.uniform(2.5, 5.0)); }

  Vector<2> ground(double column, double row) const {
    for (double r = row;; r += 1) {  // above the horizon no one can stand
      if (const auto at = camera_.on_ground({column, r})) return *at;
    }
  }

  double row() { return random_.uniform(0.3, 0.98) * camera_.size.height; }
  Vector<2> inside() { return ground(random_.uniform(0.05, 0.95) * camera_.size.width, row()); }
  double column_of(const Vector<2>& location) const { return camera_(Vector<3>(location.x(), location.y(), 0))->at.x(); }

  void begin(Walker& walker, const Vector<2>& location, const Vector<2>& goal) {
    walker.stance = {};
    walker.stance.location = location;
    walker.stance.heading = std::atan2((goal - location).y(), (goal - location).x());
    walker.stance.phase = random_.uniform(0, 2 * std::numbers::pi);
    walker.requested_speed = walker.stance.speed = pace();
    walker.goal = goal;
    walker.rests_until = 0;
  }

  /// A figure's width beyond the border, where nothing of it is seen.
  bool outside(const Vector<2>& location) const {
    const double margin = 0.3 * options_.height_px;
    const double column = column_of(location);
    return column < -margin || column > camera_.size.width + margin;
  }

  void step(Person& person, double now) {
    Walker& walker = person.walker;
    const bool there = walker.walk(now, dt_, stature(walker.id), false);
    if (person.errand == Errand::leaving && outside(walker.stance.location)) {
      go_away(person, now);
    } else if (person.errand == Errand::away && now >= person.back - return_path(person)) {
      person.errand = Errand::within;
      walker.rests_until = 0;
      walker.goal = inside();
    } else if (there && person.errand == Errand::within) {
      if (random_.chance(0.3)) walker.rests_until = now + random_.uniform(0.5, 3);
      walker.requested_speed = pace();
      const bool leaves = random_.chance(kLeaves);
      walker.goal = leaves
                        ? ground(random_.chance(0.5) ? -3 * options_.height_px : camera_.size.width + 3 * options_.height_px, row())
                        : inside();
      if (leaves) person.errand = Errand::leaving;
    } else if (there && person.errand == Errand::away) {
      walker.rests_until = now + 1;
    }
  }

  /// s that this one will take to be in the image.
  double return_path(const Person& person) const {
    const Vector<2> middle =
        ground(std::clamp(column_of(person.walker.stance.location), 0.0, 1.0 * camera_.size.width), 0.6 * camera_.size.height);
    const double metres = std::abs(middle.x() - person.walker.stance.location.x());
    return metres / std::max(0.5, person.walker.requested_speed);
  }

  void go_away(Person& person, double now) {
    Walker& walker = person.walker;
    person.errand = Errand::away;
    person.left_at = walker.stance.location;
    const double away = random_.uniform(kMinAway, kMaxAway);
    person.back = now + away;
    if (random_.chance(kStaysAway)) {  // another person comes, anywhere
      walker.id = new_figure();
      const double side = random_.chance(0.5) ? -1 : camera_.size.width + 1;
      begin(walker, ground(side < 0 ? -2 * options_.height_px : side + 2 * options_.height_px, row()), inside());
      walker.goal = walker.stance.location;
      walker.rests_until = person.back;
      walker.stance.speed = 0;
      return;
    }
    walker.requested_speed = pace();
    const double reach = kExitPath * away * walker.requested_speed * random_.uniform(0.1, 1);
    const double side = walker.stance.location.x() < 0 ? -1 : 1;
    const double angle = random_.uniform(-1.4, 1.4);
    walker.goal = walker.stance.location + reach * Vector<2>(side * std::cos(angle), std::sin(angle));
  }

  LevelCamera camera_;
  PeopleVideoOptions options_;
  Random& random_;
  double dt_;
  std::vector<Person> people_;
  PeopleMotion motion_;
};

}  // namespace

PeopleMotion move_returning(const LevelCamera& camera, const PeopleVideoOptions& options, Random& random) {
  return ReturningPeople(camera, options, random).move();
}

}  // namespace marey::simulate::people
