// Paths of markers that make trackers fail, after Queiroz, Gomide, de Albuquerque Araujo, "Evaluation of Real Time Tracking
// Methods for an Open Source Motion Capture System", §IV-A. A path is a chain of straight legs (zigzag, acceleration), a line
// with at most one bend (occlusion), or two lines that meet (crossing). All speeds are px a frame, as in the paper, whose
// trackers count time in frames: a scene at another rate shows the same places.
#include "marey/simulate/markers/marker_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "marey/core/error.h"
#include "marey/simulate/markers/discs.h"
#include "marey/simulate/random.h"

namespace marey::simulate::markers {
namespace {

using Path = std::vector<Vector<2>>;

constexpr double kMargin = 30;  // px that a marker keeps from the border
constexpr double kPi = std::numbers::pi;

Vector<2> direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

struct Range {
  double low, high;
  double draw(Random& random) const { return random.uniform(low, high); }
};

bool inside(const Vector<2>& location, const cv::Size& size) {
  return location.x() > kMargin && location.y() > kMargin && location.x() < size.width - kMargin &&
         location.y() < size.height - kMargin;
}

Vector<2> middle(const cv::Size& size) {
  return {size.width / 2.0, size.height / 2.0};
}

double heading_inwards(const Vector<2>& location, const cv::Size& size, Random& random) {
  const Vector<2> to_middle = middle(size) - location;
  return std::atan2(to_middle.y(), to_middle.x()) + random.uniform(-0.5, 0.5);
}

struct ZigzagMotion {
  Range speed;                    ///< px a frame, one draw a video
  int shortest_leg, longest_leg;  ///< frames
  Range turn;                     ///< rad, at each corner
};
constexpr ZigzagMotion kSlowZigzag{{11, 22}, 3, 7, {1.6, 2.4}};
constexpr ZigzagMotion kRapidZigzag{{16, 28}, 3, 5, {1.2, 2.2}};

Path zigzag(const ZigzagMotion& motion, int frames, const cv::Size& size, Random& random) {
  const double speed = motion.speed.draw(random);
  Vector<2> location = random.uniform_pair(0.19 * size.width, 0.81 * size.width, 0.25 * size.height, 0.75 * size.height);
  double heading = random.uniform(0, 2 * kPi);
  double side = 1;
  double course = 0;
  int left = 0;
  Path path{location};
  while (std::ssize(path) < frames) {
    if (left-- <= 0) {
      side = -side;
      course = heading + side * motion.turn.draw(random) / 2;
      left = random.integer(motion.shortest_leg, motion.longest_leg) - 1;
    }
    if (!inside(location + speed * direction(course), size)) {
      heading = heading_inwards(location, size, random);
      course = heading + side * motion.turn.draw(random) / 4;
      left = random.integer(motion.shortest_leg, motion.longest_leg) - 1;
    }
    location += speed * direction(course);
    path.push_back(location);
  }
  return path;
}

/// From near rest each leg speeds up steadily; then the marker turns and begins slowly again.
Path accelerating(int frames, const cv::Size& size, Random& random) {
  constexpr Range kStart{2, 5};             // px a frame
  constexpr Range kAcceleration{0.6, 2.4};  // px a frame²
  constexpr Range kTurn{1.2, 2.8};          // rad
  constexpr int kShortestLeg = 12, kLongestLeg = 20;
  const double acceleration = kAcceleration.draw(random);
  Vector<2> location = random.uniform_pair(0.25 * size.width, 0.75 * size.width, 0.29 * size.height, 0.71 * size.height);
  double course = random.uniform(0, 2 * kPi);
  double speed = kStart.draw(random);
  int left = random.integer(kShortestLeg, kLongestLeg);
  Path path{location};
  const auto new_leg = [&](double new_course) {
    course = new_course;
    speed = kStart.draw(random);
    left = random.integer(kShortestLeg, kLongestLeg);
  };
  while (std::ssize(path) < frames) {
    if (left-- <= 0) new_leg(course + (random.chance(0.5) ? 1 : -1) * kTurn.draw(random));
    if (!inside(location + speed * direction(course), size)) new_leg(heading_inwards(location, size, random));
    location += speed * direction(course);
    speed += acceleration;
    path.push_back(location);
  }
  return path;
}

/// A path through `meeting` at the middle of the video, which bends there by `bend` rad over `bend_frames` frames.
Path through(const Vector<2>& crossing, double course, double speed, double bend, int bend_frames, int frames) {
  Path path(static_cast<std::size_t>(frames));
  const int half = frames / 2;
  path[half] = crossing;
  const auto course_at = [&](double frame) {
    const double fraction = bend_frames > 0 ? std::clamp((frame - half) / bend_frames + 0.5, 0.0, 1.0) : (frame > half ? 1.0 : 0.0);
    return course + (fraction - 0.5) * bend;
  };
  for (int i = half + 1; i < frames; ++i) path[i] = path[i - 1] + speed * direction(course_at(i - 0.5));
  for (int i = half - 1; i >= 0; --i) path[i] = path[i + 1] - speed * direction(course_at(i + 0.5));
  return path;
}

/// The longest segment of frames around the encounter in which the whole path keeps inside the image.
bool stays_inside(const Path& path, const cv::Size& size) {
  for (const Vector<2>& location : path) {
    if (!inside(location, size)) return false;
  }
  return true;
}

/// How often a motion is drawn again until it fits, which for some lengths and sizes it never does: at most this many places are
/// computed.
int max_draws(int frames) {
  constexpr int kPositions = 5'000'000;
  return std::clamp(kPositions / std::max(1, frames), 10, 100'000);
}

struct OcclusionMotion {
  Path path;
  Box barrier;
};

OcclusionMotion behind_barrier(int frames, const cv::Size& size, Random& random) {
  constexpr Range kBarrier{30, 150};  // px across
  constexpr Range kSpeed{3, 9};       // px a frame
  constexpr Range kBend{0.6, 1.6};    // rad
  const bool bent = random.chance(0.5);
  const double width = kBarrier.draw(random);
  const double height = kBarrier.draw(random) + width / 2;
  for (int draw = max_draws(frames); draw > 0; --draw) {
    const double speed = kSpeed.draw(random) * size.width / 640;
    const double bend = bent ? (random.chance(0.5) ? 1 : -1) * kBend.draw(random) : 0;
    const Vector<2> centre = middle(size) + random.uniform_pair(-60, 60, -40, 40);
    const int bend_frames = static_cast<int>(width / speed);
    Path path = through(centre, random.uniform(0, 2 * kPi), speed, bend, bend_frames, frames);
    if (stays_inside(path, size)) return {std::move(path), Box::from_centre(centre, width, height)};
  }
  throw Error("no path of {} frames past a barrier stays within {} x {} px; ask for fewer frames or a larger image", frames,
              size.width, size.height);
}

struct BarMotion {
  std::vector<Path> paths;
  std::vector<Box> bars;
  double level;
};

/// Upright bars of `width` px that share the image out evenly.
std::vector<Box> bars_across(int count, double width, const cv::Size& size) {
  std::vector<Box> bars;
  for (int i = 0; i < count; ++i) {
    bars.push_back(Box::from_centre({size.width * (i + 1.0) / (count + 1), size.height / 2.0}, width, 2.0 * size.height));
  }
  return bars;
}

/// Markers that pass behind upright bars, every second one from the other side, each hidden for 12 to 32 frames (at a pace of 1)
/// by each; by one bar, around the middle of the video, so that the times overlap.
BarMotion behind_bars(int markers, int frames, const MarkerSceneOptions& options, Random& random) {
  const cv::Size& size = options.size;
  constexpr Range kBar{60, 210};        // px across, of 640
  constexpr Range kGrey{14, 110};       // level
  constexpr Range kHidden{12, 32};      // frames
  constexpr Range kSlope{-0.12, 0.12};  // rad
  constexpr Range kBend{-0.08, 0.08};   // rad over the whole path
  constexpr Range kLane{-15, 15};       // px beside the common lane
  constexpr Range kDelay{-4, 4};        // frames
  for (int draw = max_draws(frames); draw > 0; --draw) {
    const double width = kBar.draw(random) * size.width / 640 / options.bars;
    BarMotion motion{{}, bars_across(options.bars, width, size), kGrey.draw(random)};
    const double lane = random.uniform(-0.3, 0.3) * size.height;
    bool fits = true;
    for (int i = 0; i < markers; ++i) {
      const double speed = width * options.pace / kHidden.draw(random);
      const double course = (i % 2 == 0 ? 0 : kPi) + kSlope.draw(random);
      const Vector<2> late = kDelay.draw(random) / options.pace * speed * direction(course);
      const Vector<2> centre = middle(size) + Vector<2>(0, lane + kLane.draw(random)) - late;
      motion.paths.push_back(through(centre, course, speed, kBend.draw(random), frames, frames));
      const double clear = middle(size).x() - motion.bars.front().left + kMargin;  // the whole disc shows at both ends
      const Path& path = motion.paths.back();
      fits = fits && stays_inside(path, size) && std::abs(path.front().x() - middle(size).x()) > clear &&
             std::abs(path.back().x() - middle(size).x()) > clear;
    }
    if (fits) return motion;
  }
  throw Error("no path of {} frames past a bar stays within {} x {} px; ask for fewer frames or a larger image", frames, size.width,
              size.height);
}

std::array<Path, 2> crossing_pair(int frames, double radius, const cv::Size& size, Random& random) {
  constexpr Range kSpeed{2, 6};       // px a frame, drawn for each marker
  constexpr Range kAngle{0.35, 2.8};  // rad, between the two courses
  constexpr Range kBend{-0.5, 0.5};   // rad
  for (int draw = max_draws(frames); draw > 0; --draw) {
    const Vector<2> crossing = middle(size) + random.uniform_pair(-60, 60, -40, 40);
    const double course = random.uniform(0, 2 * kPi);
    const Vector<2> miss = random.uniform(0, radius) * direction(random.uniform(0, 2 * kPi));
    const double first_bend = kBend.draw(random), first_speed = kSpeed.draw(random);
    Path first = through(crossing, course, first_speed, first_bend, frames / 2, frames);
    const double second_bend = kBend.draw(random), second_speed = kSpeed.draw(random), angle = kAngle.draw(random);
    Path second = through(crossing + miss, course + angle, second_speed, second_bend, frames / 2, frames);
    const bool apart_at_first = (first.front() - second.front()).norm() > 8 * radius;
    const bool apart_at_last = (first.back() - second.back()).norm() > 8 * radius;
    if (apart_at_first && apart_at_last && stays_inside(first, size) && stays_inside(second, size)) {
      return {std::move(first), std::move(second)};
    }
  }
  throw Error(
      "no two markers cross in {} frames within {} x {} px, {:g} px apart at the beginning and at the end; ask for about 80 "
      "frames, smaller "
      "markers or a larger image",
      frames, size.width, size.height, 8 * radius);
}

/// A Lissajous curve: smooth, bounded, and another one for every draw.
Path plain(int frames, const cv::Size& size, Random& random) {
  const Vector<2> reach = random.uniform_pair(0.1 * size.width, 0.4 * size.width, 0.1 * size.height, 0.4 * size.height);
  const Vector<2> rate = random.uniform_pair(0.02, 0.06, 0.02, 0.06);  // rad a frame
  const Vector<2> phase = random.uniform_pair(0, 2 * kPi, 0, 2 * kPi);
  Path path;
  for (int i = 0; i < frames; ++i) {
    path.push_back(middle(size) +
                   Vector<2>(reach.x() * std::sin(rate.x() * i + phase.x()), reach.y() * std::sin(rate.y() * i + phase.y())));
  }
  return path;
}

int paper_length(MarkerSituation situation) {
  switch (situation) {
    case MarkerSituation::slow_zigzag:
    case MarkerSituation::acceleration:
      return 86;  // 85 predictions a video: 1445 / 17 = 1700 / 20
    case MarkerSituation::rapid_zigzag:
      return 55;  // 54 predictions: 594 / 11
    case MarkerSituation::occlusion:
    case MarkerSituation::crossing:
    case MarkerSituation::bar:
    case MarkerSituation::opposite:
      return 80;  // "about 80 frames"
    case MarkerSituation::plain:
      return 200;  // §IV-B
  }
  return 80;
}

bool hidden(const Vector<2>& location, const std::vector<Box>& barriers) {
  for (const Box& box : barriers) {
    if (location.x() >= box.left - 0.5 && location.x() < box.right() - 0.5 && location.y() >= box.top - 0.5 &&
        location.y() < box.bottom() - 0.5)
      return true;
  }
  return false;
}

/// Where each marker is in each frame, whether it is seen there, and false lights.
void put_in_frames(const std::vector<Path>& paths, int frames, Random& random, MarkerScene& scene) {
  const cv::Rect2d image(-0.5, -0.5, scene.options.size.width, scene.options.size.height);
  scene.frames.resize(frames);
  scene.clutter.resize(frames);
  for (int i = 0; i < frames; ++i) {
    for (int marker = 0; marker < std::ssize(paths); ++marker) {
      const Vector<2>& location = paths[marker][i];
      const bool in_image = image.contains(cv::Point2d(location.x(), location.y()));
      scene.frames[i].push_back({marker, location, in_image && !hidden(location, scene.barriers)});
    }
    for (int light = 0; light < scene.options.clutter; ++light) {
      scene.clutter[i].emplace_back(random.uniform(0, scene.options.size.width - 1),
                                    random.uniform(0, scene.options.size.height - 1));
    }
  }
}

}  // namespace

std::span<const NamedSituation> marker_situations() {
  static constexpr std::array<NamedSituation, 8> kSituations{{{"slow", MarkerSituation::slow_zigzag},
                                                              {"rapid", MarkerSituation::rapid_zigzag},
                                                              {"acceleration", MarkerSituation::acceleration},
                                                              {"occlusion", MarkerSituation::occlusion},
                                                              {"crossing", MarkerSituation::crossing},
                                                              {"bar", MarkerSituation::bar},
                                                              {"opposite", MarkerSituation::opposite},
                                                              {"plain", MarkerSituation::plain}}};
  return kSituations;
}

MarkerScene simulate_markers(MarkerSituation situation, std::uint64_t seed, const MarkerSceneOptions& options) {
  MarkerScene scene;
  scene.situation = situation;
  scene.options = options;
  scene.seed = seed;
  Random random(seed * 16 + static_cast<std::uint64_t>(situation));
  const int frames = options.frames.value_or(static_cast<int>(std::lround(paper_length(situation) * options.bars / options.pace)));

  std::vector<Path> paths;
  switch (situation) {
    case MarkerSituation::slow_zigzag:
      paths.push_back(zigzag(kSlowZigzag, frames, options.size, random));
      break;
    case MarkerSituation::rapid_zigzag:
      paths.push_back(zigzag(kRapidZigzag, frames, options.size, random));
      break;
    case MarkerSituation::acceleration:
      paths.push_back(accelerating(frames, options.size, random));
      break;
    case MarkerSituation::occlusion: {
      OcclusionMotion motion = behind_barrier(frames, options.size, random);
      paths.push_back(std::move(motion.path));
      scene.barriers.push_back(motion.barrier);
      break;
    }
    case MarkerSituation::crossing:
      for (Path& path : crossing_pair(frames, options.radius_px, options.size, random)) paths.push_back(std::move(path));
      break;
    case MarkerSituation::bar:
    case MarkerSituation::opposite: {
      BarMotion motion = behind_bars(situation == MarkerSituation::bar ? 1 : 2, frames, options, random);
      for (Path& path : motion.paths) paths.push_back(std::move(path));
      scene.barriers = std::move(motion.bars);
      scene.barrier_level = motion.level;
      break;
    }
    case MarkerSituation::plain:
      paths.push_back(plain(frames, options.size, random));
      break;
  }
  while (std::ssize(paths) < options.markers.value_or(0)) paths.push_back(plain(frames, options.size, random));
  put_in_frames(paths, frames, random, scene);
  return scene;
}

cv::Mat render_frame(const MarkerScene& scene, int index) {
  constexpr double kGround = 12, kMarker = 202;
  const MarkerSceneOptions& options = scene.options;
  std::vector<Disc> discs;
  for (const MarkerTruth& marker : scene.frames[index])
    discs.push_back({marker.position, options.radius_px, kMarker, options.blur_px});
  for (const Vector<2>& light : scene.clutter[index]) discs.push_back({light, options.radius_px, kMarker, options.blur_px});
  cv::Mat image(options.size, CV_32FC1, cv::Scalar(kGround));
  draw_discs(image, discs);
  for (const Box& barrier : scene.barriers) draw_barrier(image, barrier, scene.barrier_level);
  return expose(image, options.noise, scene.seed * 100'003 + static_cast<std::uint64_t>(index));
}

namespace {

class SceneSource final : public Source {
 public:
  explicit SceneSource(MarkerScene scene) : scene_(std::move(scene)) {
    info_ = {"simulated markers", scene_.options.size, scene_.options.rate_hz, std::ssize(scene_.frames)};
  }

  const SourceInfo& info() const override { return info_; }

  std::optional<Frame> next() override {
    if (next_ >= std::ssize(scene_.frames)) return std::nullopt;
    const int index = next_++;
    return Frame{CameraId{}, index, timestamp_from_seconds(index / scene_.options.rate_hz), Image(render_frame(scene_, index))};
  }

 private:
  MarkerScene scene_;
  SourceInfo info_;
  int next_ = 0;
};

}  // namespace

std::unique_ptr<Source> make_source(MarkerScene scene) {
  return std::make_unique<SceneSource>(std::move(scene));
}

}  // namespace marey::simulate::markers
