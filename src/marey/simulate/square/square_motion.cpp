#include "marey/simulate/square/square_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace marey::simulate::square {
namespace {

constexpr double kStep = 0.04;          // s
constexpr double kFilling = 40;         // s before the beginning
constexpr double kArrived = 0.7;        // m from a goal
constexpr double kHesitation = 0.6;     // s in which people take up the velocity they want
constexpr double kMaxPush = 3;          // m/s²
constexpr double kApart = 0.45;         // m between the middles of two who pass each other
constexpr double kGroupSpacing = 0.55;  // m between those of a group

}  // namespace

SquareMotion::SquareMotion(std::uint64_t seed, const SquareOptions& options) : options_(options), random_(seed * 977 + 5) {
  for (int i = 0; i < options_.benches; ++i)
    benches_.emplace_back(random_.uniform(2, options_.length - 2), i % 2 == 0 ? 1.0 : options_.width - 1.0);
  advance(0);
}

void SquareMotion::advance(double time) {
  const double inner = time + kFilling;
  while (static_cast<double>(steps_ + 1) * kStep <= inner + 1e-9) step();
  const double rest = inner - static_cast<double>(steps_) * kStep;
  now_.clear();
  for (const Walker& walker : walkers_) {
    now_.push_back(walker.person);
    now_.back().location += rest * walker.person.velocity;
  }
}

bool SquareMotion::holds(const Vector<2>& location) const {
  return location.x() >= 0 && location.y() >= 0 && location.x() <= options_.length && location.y() <= options_.width;
}

void SquareMotion::step() {
  ++steps_;
  if (random_.chance(options_.arrivals * kStep)) arrive();
  std::vector<Vector<2>> accelerations;
  for (Walker& walker : walkers_) {
    Vector<2> a = (required(walker) - walker.person.velocity) / kHesitation + pushed(walker);
    a += random_.gaussian_pair(0.8);
    if (a.norm() > kMaxPush) a *= kMaxPush / a.norm();
    accelerations.push_back(a);
  }
  for (std::size_t i = 0; i < walkers_.size(); ++i) {
    SquarePerson& person = walkers_[i].person;
    person.location += kStep * person.velocity + kStep * kStep / 2 * accelerations[i];
    person.velocity += kStep * accelerations[i];
  }
  std::erase_if(walkers_, [&](const Walker& walker) {
    const Vector<2>& at = walker.person.location;
    const double out = std::max({-at.x(), -at.y(), at.x() - options_.length, at.y() - options_.width});
    return out > options_.around;
  });
}

Vector<2> SquareMotion::at_side(int side) {
  const double maximum = options_.around - 0.1;
  const double x = random_.uniform(0, options_.length), y = random_.uniform(0, options_.width);
  switch (side) {
    case 0:
      return {x, -maximum};
    case 1:
      return {x, options_.width + maximum};
    case 2:
      return {-maximum, y};
    default:
      return {options_.length + maximum, y};
  }
}

void SquareMotion::arrive() {
  const double draw = random_.uniform();
  const int size = draw < 0.45 ? 1 : draw < 0.8 ? 2 : draw < 0.93 ? 3 : 4;
  const bool runs = random_.chance(options_.runners);
  const double pace = runs ? random_.uniform(2.5, 4) : std::clamp(random_.gaussian(1.3, 0.25), 0.6, 2.0);
  const int from = random_.integer(0, 3), to = (from + random_.integer(1, 3)) % 4;
  Walker first;
  first.group = next_group_++;
  const Vector<2> start = at_side(from);
  const bool stops = !runs && random_.chance(options_.stopping);
  Vector<2> middle = random_.uniform_pair(1, options_.length - 1, 1, options_.width - 1);
  if (stops && !benches_.empty() && random_.chance(0.5))
    middle = benches_[static_cast<std::size_t>(random_.integer(0, static_cast<int>(benches_.size()) - 1))] +
             random_.uniform_pair(-1, 1, -0.3, 0.3);
  first.goals = {middle, at_side(to)};
  // Straight on beyond the side, so that a goal is not turned round at.
  first.goals.back() += 2 * options_.around * (first.goals.back() - middle).normalized();
  if (stops) first.stop_for = std::min(120.0, -options_.stop_s * std::log(1 - random_.uniform()));
  const Vector<2> ahead = (middle - start).normalized();
  const Vector<2> left(-ahead.y(), ahead.x());
  for (int i = 0; i < size; ++i) {
    Walker walker = first;
    walker.slot = {-random_.uniform(0, 0.4) * (i % 2), kGroupSpacing * (i % 2 == 0 ? i / 2 : -(i + 1) / 2)};
    walker.pace = pace;
    walker.person.id = next_id_++;
    walker.person.location = start + walker.slot.y() * left;
    walker.person.velocity = pace * ahead;
    walker.person.height = std::clamp(random_.gaussian(1.72, 0.09), 1.45, 1.98);
    walkers_.push_back(walker);
  }
}

const SquareMotion::Walker* SquareMotion::first_of(const Walker& walker) const {
  const auto found = std::find_if(walkers_.begin(), walkers_.end(), [&](const Walker& w) { return w.group == walker.group; });
  return &*found;
}

Vector<2> SquareMotion::required(Walker& walker) {
  const Walker& first = *first_of(walker);
  if (&first != &walker) {
    const Vector<2>& v = first.person.velocity;
    walker.goals = first.goals;
    walker.stop_for = first.stop_for;
    if (v.norm() < 0.3) return Vector<2>::Zero();
    const Vector<2> ahead = v.normalized();
    const Vector<2> slot = first.person.location + walker.slot.x() * ahead + walker.slot.y() * Vector<2>(-ahead.y(), ahead.x());
    Vector<2> velocity = v + 0.8 * (slot - walker.person.location);
    const double maximum = 1.4 * walker.pace;
    return velocity.norm() > maximum ? Vector<2>(velocity * (maximum / velocity.norm())) : velocity;
  }
  const Vector<2> to_goal = walker.goals.front() - walker.person.location;
  if (to_goal.norm() < kArrived && walker.goals.size() > 1) {
    if (walker.stop_for > 0) {
      walker.stop_for -= kStep;
      return Vector<2>::Zero();
    }
    walker.goals.erase(walker.goals.begin());
  }
  return walker.pace * to_goal.normalized();
}

/// Away from who is near, and a little to the right of who comes.
Vector<2> SquareMotion::pushed(const Walker& walker) const {
  Vector<2> push = Vector<2>::Zero();
  for (const Walker& other : walkers_) {
    if (&other == &walker) continue;
    const Vector<2> apart = walker.person.location - other.person.location;
    const double distance = std::max(apart.norm(), 0.05);
    if (distance > 1.5) continue;
    const Vector<2> away = apart / distance;
    const double strength = 2 * std::exp((kApart - distance) / 0.25);
    push += strength * (away + 0.3 * Vector<2>(-away.y(), away.x()));
  }
  return push;
}

}  // namespace marey::simulate::square
