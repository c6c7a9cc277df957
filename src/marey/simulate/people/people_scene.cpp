// People are upright boxes on a flat ground, seen through a pinhole whose horizon is level: a person of height H at distance Z is
// f · H / Z pixels tall, and stands f · h / Z below the horizon (h the camera's height). Walkers keep a speed and drift in heading.
// Nearer people hide farther ones; what share of a person is visible is counted on a small raster.
#include "marey/simulate/people/people_scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "marey/simulate/random.h"

namespace marey::simulate::people {
namespace {

struct ScenePerson {
  int id = 0;
  Vector<2> location = Vector<2>::Zero();  // m on the ground: right of the camera's start, ahead of it
  double heading = 0, speed = 0;           // rad, m/s
  double stature = 1.75, girth = 0.65;     // m
  double stop_at = 0, stop_until = 0;      // s
};

struct Eye {
  Vector<2> location = Vector<2>::Zero();
  double yaw = 0, pitch = 0;
};

class Street {
 public:
  Street(const PeopleSceneOptions& options, std::uint64_t seed) : options_(options), random_(seed) {}

  std::vector<TrueBox> run() {
    const double dt = 1 / options_.rate_hz;
    while (static_cast<int>(walkers_.size()) < options_.people) enter(true);
    for (int frame = 0; frame < options_.frames; ++frame) {
      now_ = frame * dt;
      for (const ScenePerson& walker : walkers_) show(frame, walker);
      move(dt);
    }
    return std::move(truth_);
  }

 private:
  /// Ahead, right of the optical axis and distance along it.
  Vector<2> in_view(const Vector<2>& location) const {
    const Vector<2> d = location - eye_.location;
    const double c = std::cos(eye_.yaw);
    const double s = std::sin(eye_.yaw);
    return {c * d.x() - s * d.y(), s * d.x() + c * d.y()};
  }
  Vector<2> on_ground(const Vector<2>& view) const {
    const double c = std::cos(eye_.yaw);
    const double s = std::sin(eye_.yaw);
    return eye_.location + Vector<2>(c * view.x() + s * view.y(), -s * view.x() + c * view.y());
  }

  void enter(bool anywhere) {
    ScenePerson walker;
    walker.id = next_id_++;
    const double depth = random_.uniform(options_.nearest, options_.farthest);
    const double half = 0.5 * options_.width / options_.focal * depth;
    const bool in_group = !walkers_.empty() && random_.chance(options_.group_fraction);
    const double side = random_.chance(0.5) ? 1 : -1;
    walker.location = on_ground({anywhere ? random_.uniform(-half, half) : side * (half + 0.5), depth});
    walker.speed = std::max(0.5, random_.gaussian(1.3, 0.3));
    walker.heading = (side > 0 ? std::numbers::pi : 0) + random_.gaussian(0, 0.5);
    if (in_group && anywhere) {
      const ScenePerson& friend_of = walkers_.back();
      walker.location = friend_of.location + Vector<2>(random_.gaussian(0, 0.3), random_.uniform(0.5, 0.9));
      walker.speed = friend_of.speed;
      walker.heading = friend_of.heading;
    }
    walker.stature = random_.gaussian(1.72, 0.1);
    walker.girth = random_.gaussian(0.68, 0.07);
    if (random_.chance(options_.stop_fraction)) {
      walker.stop_at = now_ + random_.uniform(0, 8);
      walker.stop_until = walker.stop_at + random_.uniform(1, 6);
    }
    walkers_.push_back(walker);
  }

  std::optional<Box> box_of(const ScenePerson& walker) const {
    const Vector<2> view = in_view(walker.location);
    if (view.y() < 1) return std::nullopt;
    const double scale = options_.focal / view.y();
    const double horizon = 0.42 * options_.height + options_.focal * eye_.pitch;
    const double foot = horizon + scale * options_.camera_height;
    const double width = scale * walker.girth;
    const double height = scale * walker.stature;
    const Box whole{options_.width / 2 + scale * view.x() - width / 2, foot - height, width, height};
    const Box detected = geometry::intersection(whole, {0, 0, options_.width, options_.height});
    if (detected.area() < 0.3 * whole.area()) return std::nullopt;
    return detected;
  }

  void show(int frame, const ScenePerson& walker) {
    if (const auto box = box_of(walker)) truth_.push_back({frame, walker.id, *box});
  }

  void move(double dt) {
    eye_.yaw += turn_ * dt;
    turn_ += -turn_ * dt + options_.camera_turn * std::sqrt(2 * dt) * random_.gaussian();
    eye_.location += options_.camera_speed * dt * Vector<2>(std::sin(eye_.yaw), std::cos(eye_.yaw));
    eye_.pitch = 0.6 * eye_.pitch + 0.8 * options_.camera_shake * random_.gaussian();
    for (ScenePerson& walker : walkers_) {
      walker.heading += 0.25 * std::sqrt(dt) * random_.gaussian();
      const bool stands = now_ >= walker.stop_at && now_ < walker.stop_until;
      if (!stands) walker.location += walker.speed * dt * Vector<2>(std::cos(walker.heading), std::sin(walker.heading));
    }
    std::erase_if(walkers_, [this](const ScenePerson& walker) {
      const Vector<2> view = in_view(walker.location);
      const double half = 0.5 * options_.width / options_.focal * view.y() + 1;
      return view.y() < 2 || view.y() > 2 * options_.farthest || std::abs(view.x()) > half;
    });
    const double missing = options_.people - static_cast<double>(walkers_.size());
    if (missing > 0 && random_.chance(std::min(1.0, missing * dt))) enter(options_.camera_speed > 0 && random_.chance(0.3));
  }

  PeopleSceneOptions options_;
  Random random_;
  Eye eye_;
  double turn_ = 0;
  double now_ = 0;
  int next_id_ = 1;
  std::vector<ScenePerson> walkers_;  // in the order of ids
  std::vector<TrueBox> truth_;
};

class SimulatedDetector {
 public:
  SimulatedDetector(const DetectorModel& model, double rate_hz, std::span<const TrueBox> truth, std::uint64_t seed)
      : model_(model), dt_(1 / rate_hz), random_(seed) {
    for (const TrueBox& one : truth) scene_ = scene_.empty() ? one.box : geometry::hull(scene_, one.box);
    if (truth.empty()) return;
    for (int i = 0; i < model.haunted_positions; ++i) haunted_.push_back(like_a_person(truth));
  }

  std::vector<Observation<2>> observe(std::span<const TrueBox> people) {
    std::vector<Observation<2>> detected;
    for (const TrueBox& person : people) observe_person(person, people, detected);
    for (const Box& location : haunted_) {
      if (random_.chance(0.33)) add(detected, jittered(location, 0.03), random_.gaussian(0.6, 0.12));
    }
    if (!people.empty() && random_.chance(model_.false_alarms)) add(detected, like_a_person(people), random_.gaussian(0.5, 0.15));
    suppress(detected);
    return detected;
  }

 private:
  struct Memory {
    bool missing = false;
    double x = 0, y = 0, w = 0, h = 0;  // errors in standard deviations
  };

  Box like_a_person(std::span<const TrueBox> people) {
    const Box& model = people[random_.integer(0, static_cast<int>(people.size()) - 1)].box;
    return {random_.uniform(scene_.left, scene_.right() - model.width), random_.uniform(scene_.top, scene_.bottom() - model.height),
            model.width, model.height};
  }

  Box jittered(const Box& box, double fraction) {
    return {box.left + random_.gaussian(0, fraction * box.height), box.top + random_.gaussian(0, fraction * box.height),
            box.width * std::exp(random_.gaussian(0, fraction)), box.height * std::exp(random_.gaussian(0, fraction))};
  }

  static void add(std::vector<Observation<2>>& detected, const Box& box, double score) {
    Observation<2> observation;
    observation.box = box;
    observation.value = box.centre();
    observation.score = std::clamp(score, 0.05, 1.0);
    detected.push_back(observation);
  }

  struct Visible {
    double fraction = 1;
    Box part;
  };

  /// What nearer people, whose feet are lower in the image, leave of a person.
  static Visible visible_part(const TrueBox& person, std::span<const TrueBox> people) {
    constexpr int columns = 6;
    constexpr int rows = 12;
    int detected = 0;
    std::optional<Box> part;
    for (int cell = 0; cell < columns * rows; ++cell) {
      const double w = person.box.width / columns;
      const double h = person.box.height / rows;
      const int column = cell % columns, row = cell / columns;
      const Box raster{person.box.left + column * w, person.box.top + row * h, w, h};
      const Vector<2> at = raster.centre();
      const bool covered = std::any_of(people.begin(), people.end(), [&](const TrueBox& other) {
        const Box& b = other.box;
        // A body fills the middle of its box.
        return other.id != person.id && b.bottom() > person.box.bottom() && std::abs(at.x() - b.centre().x()) < 0.4 * b.width &&
               at.y() > b.top && at.y() < b.bottom();
      });
      if (covered) continue;
      ++detected;
      part = part ? geometry::hull(*part, raster) : raster;
    }
    return {static_cast<double>(detected) / (columns * rows), part.value_or(person.box)};
  }

  void observe_person(const TrueBox& person, std::span<const TrueBox> people, std::vector<Observation<2>>& detected) {
    Memory& memory = memories_[person.id];
    const double leave = std::min(1.0, dt_ / model_.miss_duration);
    memory.missing =
        memory.missing ? !random_.chance(leave) : random_.chance(leave * model_.miss / std::max(1e-9, 1 - model_.miss));
    const double keep = std::exp(-dt_ / model_.noise_memory);
    for (double* error : {&memory.x, &memory.y, &memory.w, &memory.h})
      *error = keep * *error + std::sqrt(1 - keep * keep) * random_.gaussian();
    const Visible visible = visible_part(person, people);
    const bool clipped = visible.fraction < 0.9 && random_.chance(model_.clip_chance);
    if (visible.fraction < model_.hidden_from || memory.missing) return;
    const Box base = clipped ? visible.part : person.box;
    const double worse = 2 - visible.fraction;
    const double location = worse * model_.position_noise * base.height;
    const double size = worse * model_.size_noise;
    const Vector<2> centre = base.centre() + location * Vector<2>(memory.x, memory.y);
    const double score = 0.55 + 0.4 * visible.fraction + random_.gaussian(0, 0.12);
    add(detected, Box::from_centre(centre, base.width * std::exp(size * memory.w), base.height * std::exp(size * memory.h)), score);
  }

  /// Of boxes that overlap much the surest is kept, as detectors do.
  static void suppress(std::vector<Observation<2>>& detected) {
    std::sort(detected.begin(), detected.end(), [](const auto& a, const auto& b) {
      return std::tuple(-a.score, a.box->left, a.box->top) < std::tuple(-b.score, b.box->left, b.box->top);
    });
    std::vector<Observation<2>> kept;
    for (const auto& one : detected) {
      if (std::none_of(kept.begin(), kept.end(), [&](const auto& other) { return geometry::iou(*one.box, *other.box) > 0.6; }))
        kept.push_back(one);
    }
    detected = std::move(kept);
  }

  DetectorModel model_;
  double dt_;
  Random random_;
  Box scene_;
  std::vector<Box> haunted_;
  std::map<int, Memory> memories_;
};

}  // namespace

std::vector<TrueBox> simulate_people(const PeopleSceneOptions& options, std::uint64_t seed) {
  return Street(options, seed).run();
}

std::vector<std::vector<Observation<2>>> simulate_detector(std::span<const TrueBox> truth, int frames, double rate_hz,
                                                           const DetectorModel& model, std::uint64_t seed) {
  SimulatedDetector detector(model, rate_hz, truth, seed);
  std::vector<std::vector<Observation<2>>> detected;
  std::size_t next = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const std::size_t begin = next;
    while (next < truth.size() && truth[next].frame == frame) ++next;
    detected.push_back(detector.observe(truth.subspan(begin, next - begin)));
  }
  return detected;
}

}  // namespace marey::simulate::people
