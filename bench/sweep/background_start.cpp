// A background model's first minute, where nothing was seen ahead: a road, a room in which people stand and one was there
// from the start, leaves in the wind, a shaking camera. F-measure over the pixels of all frames; beside Marey's model, unprimed and
// primed, OpenCV's MOG2 and KNN with a median filter. Usage: background_start [SEEDS] [--no-peers]
#include <cstdlib>
#include <random>
#include <vector>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

#include "marey/detect/background/background.h"
#include "marey/detect/background/background_scene_test.h"

namespace {

using marey::Frame;
using marey::detect::background::Background;
using marey::detect::background::test::Conditions;
using marey::detect::background::test::Figure;
using marey::detect::background::test::SceneFrame;
using marey::detect::background::test::SmallScene;

constexpr int kSeconds = 60;
constexpr int kMaxFrames = kSeconds * SmallScene::kRate;

std::vector<Figure> passers(int frame) {
  const int x = 3 * frame;
  return {{x % 420 - 50, 120}, {330 - (x + 150) % 430, 180}};
}

/// One stands from the start and goes to another place after 20 s; one comes in after 15 s, and stands before the shelves.
std::vector<Figure> people_in_room(int frame) {
  const int first = frame < 200 ? 60 : std::min(130, 60 + 2 * (frame - 200));
  std::vector<Figure> people{{first, 150}};
  if (frame >= 150) people.push_back({std::max(210, 330 - 3 * (frame - 150)), 165});
  return people;
}

struct Scene {
  const char* name;
  bool shelves = false;
  bool people_stay = false;
  double shake = 0;    // px, standard deviation of each axis
  double sway = 0;     // px
  double flicker = 0;  // share of the light
};

constexpr Scene kScenes[] = {{.name = "road"},
                             {.name = "room", .shelves = true, .people_stay = true, .flicker = 0.01},
                             {.name = "leaves", .sway = 1.5},
                             {.name = "shake of 1 px", .shake = 1},
                             {.name = "shake of 2 px", .shake = 2}};

std::vector<SceneFrame> video(const Scene& scene, std::uint32_t seed) {
  SmallScene camera(seed, 2, scene.shelves);
  std::mt19937 random(seed + 100);
  std::normal_distribution<double> normal(0, 1);
  std::vector<SceneFrame> frames;
  for (int i = 0; i < kMaxFrames; ++i) {
    const std::vector<Figure> people = scene.people_stay ? people_in_room(i) : passers(i);
    frames.push_back(camera.video(people, Conditions{.light = 1 + scene.flicker * std::sin(i * 0.37),
                                                     .sway = scene.sway * std::sin(i * 0.7),
                                                     .shake_x = scene.shake * normal(random),
                                                     .shake_y = scene.shake * normal(random)}));
  }
  return frames;
}

double f_measure(Background& model, const std::vector<SceneFrame>& frames, bool median) {
  double hit = 0, marked = 0, people = 0;
  for (const SceneFrame& one : frames) {
    cv::Mat mask = model.apply(one.frame, {}).mask;
    if (median) {
      cv::Mat filtered;
      cv::medianBlur(mask, filtered, 5);
      mask = filtered;
    }
    hit += cv::countNonZero(mask & one.people);
    marked += cv::countNonZero(mask);
    people += cv::countNonZero(one.people);
  }
  return 2 * hit / (marked + people);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace marey::detect::background;
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 2;
  const bool peers = argc <= 2;
  fmt::print("{} s at {} Hz, {} x {}, {} seeds\n{:16}{:>10}{:>10}{:>10}{:>10}\n", kSeconds, SmallScene::kRate, SmallScene::kWidth,
             SmallScene::kHeight, seeds, "", "unprimed", "primed", "mog2", "knn");
  for (const Scene& scene : kScenes) {
    double sums[4] = {};
    for (int seed = 1; seed <= seeds; ++seed) {
      const std::vector<SceneFrame> frames = video(scene, static_cast<std::uint32_t>(seed));
      std::vector<Frame> samples;
      for (int i = 0; i < 32; ++i) samples.push_back(frames[i * frames.size() / 32].frame);
      const auto unprimed = make_background(), primed = make_background(), mog2 = make_background(Mog2Options{}),
                 knn = make_background(KnnOptions{});
      primed->prime(samples);
      sums[0] += f_measure(*unprimed, frames, false);
      sums[1] += f_measure(*primed, frames, false);
      if (!peers) continue;
      sums[2] += f_measure(*mog2, frames, true);
      sums[3] += f_measure(*knn, frames, true);
    }
    fmt::print("{:16}{:10.3f}{:10.3f}{:10.3f}{:10.3f}\n", scene.name, sums[0] / seeds, sums[1] / seeds, sums[2] / seeds,
               sums[3] / seeds);
  }
}
