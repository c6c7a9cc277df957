// How well the ball is followed (track/ball) where nothing is rendered: matches of the simulator, of which each camera is given
// spots as the detector makes them, so that dozens of seeds take seconds. Rates and noises are those that were measured of rendered
// videos of 1280 x 720: a ball away from people is found in 97 of 100 images to 0.3 px, one before a person in 60; people show 1.7
// false spots each, some people have no box for seconds, and elsewhere there is a false spot or two, half of them of
// paint.
//   ball_spots [FIRST_SEED] [SEEDS] [CAMERAS: 2 for the football stand, 0 the same without a ball] [SECONDS]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/reconstruct/person_view.h"
#include "marey/simulate/match/match_camera.h"
#include "marey/simulate/random.h"
#include "marey/track/ball/ball_trajectory.h"

namespace marey::sweep {
namespace {

using namespace track::ball;
using simulate::Random;
using simulate::match::kMatchPeople;
using simulate::match::MatchScene;

struct Options {
  int cameras = 2;
  bool ball = true;
  double seconds = 16;
};

/// The truth of one image.
struct TrueSpot {
  Vector<2> pixel;
  double visible;
};

struct Truth {
  std::vector<std::optional<TrueSpot>> images;      // by instant and camera
  std::vector<std::optional<Vector<3>>> locations;  // m, world; nothing if it is dead
};

struct Spots {
  std::shared_ptr<GroundViews> views;
  std::vector<GroundView> cameras;
  std::vector<BallObservations> time_steps;
  Truth truth;
};

MatchScene scene_of(const Options& options, std::uint64_t seed) {
  simulate::match::MatchCamerasOptions how;
  how.size = cv::Size(1280, 720);
  how.cameras = options.cameras;
  if (options.cameras == 2) how.stand = simulate::match::MatchStand::football;
  return {how, seed};
}

/// What a person's body shows in one image: socks, shorts, shirt and head, some of them.
void add_limbs(const Box& box, bool walks, Random& random, BallView& view) {
  constexpr std::array<double, 5> kHeights{0.95, 0.85, 0.5, 0.35, 0.08};  // of the box, from above
  for (const double height : kHeights) {
    if (!random.chance(0.35)) continue;
    const double swing = walks && height > 0.8 ? 0.35 : 0.12;
    const Vector<2> at(box.centre().x() + random.gaussian(0, swing) * box.width, box.top + height * box.height);
    view.detected.push_back({at + Vector<2>(random.gaussian(0, 0.8), random.gaussian(0, 0.8)),
                             0.7,
                             random.gaussian(-0.3, 0.6),
                             random.chance(0.93) ? 0.3 : 0.02,
                             {},
                             false});
  }
}

/// One camera of one seed, image by image.
class SpotCamera {
 public:
  SpotCamera(const GroundView& view, CameraId id, std::uint64_t seed) : view_(view), id_(id), random_(seed) {
    for (Vector<2>& location : paint_)
      location = {random_.uniform(0, view.size().width), random_.uniform(0.2 * view.size().height, view.size().height)};
  }

  BallView observe_frame(int frame, const std::vector<Vector<3>>& feet, const std::optional<Vector<3>>& ball,
                         std::optional<TrueSpot>& truth) {
    constexpr int kChunk = 40;  // images for which a person is missed, and paint shows
    if (frame % kChunk == 0) {
      for (bool& missed : missed_) missed = random_.chance(0.1);
      for (bool& shows : shows_) shows = random_.chance(0.03);
    }
    BallView detected;
    detected.camera = id_;
    detected.time = timestamp_from_seconds(frame / 25.0);
    std::vector<Box> bodies;
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const auto box = reconstruct::person_box(*view_.camera(), feet[i]);
      if (!box || geometry::intersection(*box, image()).empty()) continue;
      const bool nearer = ball && (feet[i] - view_.camera()->centre()).norm() < (*ball - view_.camera()->centre()).norm();
      if (nearer) bodies.push_back(*box);
      if (!missed_[i])
        detected.people.push_back({box->left + random_.gaussian(0, 0.08) * box->width, box->top, box->width, box->height});
      add_limbs(*box, true, random_, detected);
    }
    if (ball) add_ball(*ball, bodies, detected, truth);
    for (std::size_t i = 0; i < paint_.size(); ++i) {
      if (shows_[i] && random_.chance(0.5))
        add(paint_[i] + Vector<2>(random_.gaussian(0, 0.5), random_.gaussian(0, 0.5)), -1, detected);
    }
    while (random_.chance(0.5))
      add({random_.uniform(0, view_.size().width), random_.uniform(0, view_.size().height)}, -1, detected);
    return detected;
  }

 private:
  Box image() const { return {0, 0, static_cast<double>(view_.size().width), static_cast<double>(view_.size().height)}; }

  void add(const Vector<2>& pixel, double score, BallView& detected) {
    detected.detected.push_back({pixel, 0.6, random_.gaussian(score, 0.8), random_.chance(0.2) ? 0.2 : 0.0, {}, false});
  }

  void add_ball(const Vector<3>& ball, const std::vector<Box>& bodies, BallView& detected, std::optional<TrueSpot>& truth) {
    const auto at = view_.camera()->project(ball);
    if (!at || !view_.camera()->in_image(*at)) return;
    const auto within = [&](const Box& box, double margin) {
      return std::abs(at->x() - box.centre().x()) < (0.25 + margin) * box.width && at->y() > box.top && at->y() < box.bottom();
    };
    const bool hidden = std::any_of(bodies.begin(), bodies.end(), [&](const Box& box) { return within(box, 0); });
    truth = TrueSpot{*at, hidden ? 0.0 : 1.0};
    const bool close =
        std::any_of(detected.people.begin(), detected.people.end(), [&](const Box& box) { return within(box, 0.5); });
    if (hidden || !random_.chance(close ? 0.6 : 0.97)) return;
    detected.detected.push_back({*at + Vector<2>(random_.gaussian(0, 0.3), random_.gaussian(0, 0.3)),
                                 0.55,
                                 random_.gaussian(0.6, 0.1),
                                 close ? 0.2 : 0.0,
                                 {},
                                 false});
  }

  const GroundView& view_;
  CameraId id_;
  Random random_;
  std::array<Vector<2>, 60> paint_;
  std::array<bool, 60> shows_{};
  std::array<bool, kMatchPeople> missed_{};
};

Spots spots_of(const Options& options, std::uint64_t seed) {
  const MatchScene scene = scene_of(options, seed);
  Spots spots;
  for (const RigCamera& camera : scene.rig.cameras) spots.cameras.push_back(*camera.ground_view(scene.rig.ground));
  spots.views = ground_views(spots.cameras);
  std::vector<SpotCamera> cameras;
  for (std::size_t c = 0; c < spots.cameras.size(); ++c)
    cameras.emplace_back(spots.cameras[c], CameraId{static_cast<int>(c)}, 100 * seed + c);
  simulate::match::MatchMotion motion(seed, scene.options.pitch);
  const auto world = [&](const Vector<2>& pitch, double up) {
    const Vector<3> at = scene.world_from_pitch * Vector<3>(pitch.x(), pitch.y(), 1);
    return Vector<3>(at.x(), at.y(), up);
  };
  const int frames = static_cast<int>(std::lround(25 * options.seconds));
  for (int frame = 0; frame < frames; ++frame) {
    motion.advance(scene.match_time(frame / 25.0));
    BallObservations& time_step = spots.time_steps.emplace_back();
    time_step.index = frame;
    time_step.time = timestamp_from_seconds(frame / 25.0);
    std::vector<Vector<3>> feet;
    for (std::size_t i = 0; i < motion.people().size(); ++i) {
      const auto& person = motion.people()[i];
      feet.push_back(world(person.location, 0));
      const Vector<3> later = world(person.location + person.velocity, 0);
      time_step.people.push_back({TrackId{static_cast<int>(i) + 1}, feet.back().head<2>(), (later - feet.back()).head<2>()});
    }
    const simulate::match::BallPosition ball = motion.ball_position();
    const bool is = options.ball && ball.there;
    const Vector<3> location = world(ball.location.head<2>(), ball.location.z());
    const bool dead = ball.state == simulate::match::BallState::dead;
    spots.truth.locations.push_back(is && !dead ? std::optional(location) : std::nullopt);
    for (SpotCamera& camera : cameras)
      time_step.views.push_back(
          camera.observe_frame(frame, feet, is ? std::optional(location) : std::nullopt, spots.truth.images.emplace_back()));
  }
  return spots;
}

/// As bench/ball.py counts.
struct Score {
  int hits = 0, wrong = 0, missed = 0, playing = 0, reported = 0;
  std::vector<double> off;  // m

  void add(const Score& other) {
    hits += other.hits, wrong += other.wrong, missed += other.missed, playing += other.playing, reported += other.reported;
    off.insert(off.end(), other.off.begin(), other.off.end());
  }
};

Score score_of(const Spots& spots, const std::vector<std::optional<BallState>>& states) {
  Score score;
  const std::size_t cameras = spots.cameras.size();
  for (std::size_t i = 0; i < states.size(); ++i) {
    score.reported += states[i] ? 1 : 0;
    const auto& location = spots.truth.locations[i];
    score.playing += location ? 1 : 0;
    if (location && states[i]) score.off.push_back((states[i]->belief.location() - *location).norm());
    for (std::size_t c = 0; c < cameras; ++c) {
      const auto& truth = spots.truth.images[i * cameras + c];
      const bool reported = states[i] && (states[i]->cameras & mask_of(CameraId{static_cast<int>(c)})) != 0;
      const auto at = reported ? spots.cameras[c].camera()->project(states[i]->belief.location()) : std::nullopt;
      constexpr double kNear = 4;  // px
      const bool hit = at && truth && truth->visible > 0 && (*at - truth->pixel).norm() <= kNear;
      score.hits += hit ? 1 : 0;
      score.wrong += reported && !hit ? 1 : 0;
      score.missed += truth && truth->visible > 0 && !hit ? 1 : 0;
    }
  }
  return score;
}

void print(const std::string& name, Score score) {
  std::sort(score.off.begin(), score.off.end());
  const auto at = [&](double fraction) {
    return score.off.empty() ? 0 : score.off[static_cast<std::size_t>(fraction * static_cast<double>(score.off.size() - 1))];
  };
  const auto ratio = [](double a, double b) { return b > 0 ? a / b : 0; };
  const auto right = std::count_if(score.off.begin(), score.off.end(), [](double off) { return off < 1; });
  fmt::print("{:>6} {:6.3f} {:9.3f} {:6.3f} {:9.2f} {:7.2f} {:8.2f} {:5.2f} {:5}\n", name,
             ratio(2.0 * score.hits, 2.0 * score.hits + score.wrong + score.missed), ratio(score.hits, score.hits + score.wrong),
             ratio(score.hits, score.hits + score.missed), at(0.5), at(0.9),
             ratio(static_cast<double>(right), static_cast<double>(score.off.size())),
             ratio(static_cast<double>(score.off.size()), score.playing), score.reported);
}

void run(std::uint64_t first, int seeds, const Options& options) {
  fmt::print("{:>6} {:>6} {:>9} {:>6} {:>9} {:>7} {:>8} {:>5} {:>5}\n", "seed", "F1", "precision", "recall", "place p50", "p90, m",
             "to 1 m", "told", "count");
  Score all;
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
    Spots spots = spots_of(options, seed);
    const Score score = score_of(spots, ball_trajectory(spots.time_steps, spots.views, {}, {}));
    print(std::to_string(seed), score);
    all.add(score);
  }
  print("all", all);
}

}  // namespace
}  // namespace marey::sweep

int main(int argc, char** argv) {
  const auto number = [&](int index, double otherwise) { return argc > index ? std::atof(argv[index]) : otherwise; };
  marey::sweep::Options options;
  options.ball = number(3, 2) > 0;
  options.cameras = options.ball ? static_cast<int>(number(3, 2)) : 2;
  options.seconds = number(4, 16);
  marey::sweep::run(static_cast<std::uint64_t>(number(1, 101)), static_cast<int>(number(2, 20)), options);
}
