// Background models as a live run uses them, from the first frame of a video to its last, nothing learned ahead: ten scenes with
// the truth pixel by pixel (simulate/people/restless_video.h), evaluated by the pixels at least half of which a person covers.
// Beside Marey's model OpenCV's MOG2 and KNN on BGR with their defaults, what they call shadow omitted, as they are and after a
// median of 5 × 5.
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

#include "marey/core/frame.h"
#include "marey/detect/background/background.h"
#include "marey/simulate/people/restless_video.h"

namespace {

using marey::Frame;
using marey::simulate::people::PeopleSituation;
using marey::simulate::people::RestlessFrame;
using marey::simulate::people::RestlessVideo;
using marey::simulate::people::RestlessVideoOptions;
using marey::simulate::people::Unrest;

struct Scene {
  const char* name;
  Unrest unrest;
  PeopleSituation situation = PeopleSituation::crowd;
  double slower = 1;  ///< fewer frames a second, so that the video is this many times as long
};

const Scene kScenes[] = {{"still", {}},
                         {"leaves", {.leaves_px = 3}},
                         {"wind after a minute", {.leaves_px = 3, .calm = 0.6}, PeopleSituation::crowd, 8},
                         {"jitter of 1 px", {.jitter_px = 1}},
                         {"jitter of 3 px", {.jitter_px = 3}},
                         {"exposure steps", {.exposure_step = 0.3}},
                         {"lamp", {.lamp = 0.6}},
                         {"clouds", {.clouds = 0.4}},
                         {"rain", {.rain = 80}},
                         {"standing", {}, PeopleSituation::standing}};

struct Score {
  double hit = 0, marked = 0, people = 0;
  void add(const cv::Mat& mask, const cv::Mat& truth) {
    hit += cv::countNonZero(mask & truth);
    marked += cv::countNonZero(mask);
    people += cv::countNonZero(truth);
  }
  double precision() const { return marked > 0 ? hit / marked : 0; }
  double recall() const { return hit / people; }
  double f() const { return 2 * hit / (marked + people); }
};

enum Model { marey_live, marey_primed, mog2, mog2_median, knn, knn_median, kModels };
const char* const kNames[kModels] = {"Marey, live", "Marey, primed", "MOG2", "MOG2, median", "KNN", "KNN, median"};

struct Options {
  int frames = 300, seeds = 1, first_seed = 1;
  double rate_hz = 25;
  bool lawn = false, peers = true;
  std::string only, images;
};

cv::Mat peer_mask(cv::BackgroundSubtractor& model, const cv::Mat& bgr) {
  cv::Mat mask;
  model.apply(bgr, mask);
  return mask > 200;
}

/// For eyes: each tenth image, its truth and Marey's mask side by side.
void keep(const Options& options, const Scene& scene, int seed, int index, const cv::Mat& bgr, const cv::Mat& truth,
          const cv::Mat& mask) {
  cv::Mat all, one;
  cv::hconcat(truth, mask, one);
  cv::cvtColor(one, one, cv::COLOR_GRAY2BGR);
  cv::hconcat(bgr, one, all);
  cv::imwrite(fmt::format("{}/{} {} {:04}.png", options.images, scene.name, seed, index), all);
}

void assess(const Options& options, const Scene& scene, int seed, std::vector<Score>& scores) {
  RestlessVideoOptions required;
  required.frames = options.frames;
  required.rate_hz = options.rate_hz / scene.slower;
  required.lawn = options.lawn;
  required.situation = scene.situation;
  required.unrest = scene.unrest;
  const RestlessVideo video(static_cast<std::uint64_t>(seed), required);
  std::vector<Frame> frames;
  std::vector<cv::Mat> truths;
  for (int i = 0; i < video.frames(); ++i) {
    RestlessFrame shown = video.render(i);
    Frame& frame = frames.emplace_back();
    frame.index = i;
    frame.time = marey::timestamp_from_seconds(i / video.rate_hz());
    frame.image = shown.image;
    truths.push_back(shown.people);
  }
  std::vector<Frame> samples;
  for (int i = 0; i < 32; ++i) samples.push_back(frames[i * frames.size() / 32]);
  const auto live = marey::detect::background::make_background(), primed = marey::detect::background::make_background();
  primed->prime(samples);
  const auto first = cv::createBackgroundSubtractorMOG2();
  const auto second = cv::createBackgroundSubtractorKNN();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const cv::Mat mask = live->apply(frames[i], {}).covered, bgr = frames[i].image.bgr();
    scores[marey_live].add(mask, truths[i]);
    if (!options.images.empty() && i % 10 == 0) keep(options, scene, seed, static_cast<int>(i), bgr, truths[i], mask);
    scores[marey_primed].add(primed->apply(frames[i], {}).covered, truths[i]);
    if (!options.peers) continue;
    cv::Mat smooth;
    const cv::Mat a = peer_mask(*first, bgr), b = peer_mask(*second, bgr);
    scores[mog2].add(a, truths[i]);
    cv::medianBlur(a, smooth, 5);
    scores[mog2_median].add(smooth, truths[i]);
    scores[knn].add(b, truths[i]);
    cv::medianBlur(b, smooth, 5);
    scores[knn_median].add(smooth, truths[i]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Background models, live, on videos with truth");
  app.add_option("--frames", options.frames);
  app.add_option("--rate", options.rate_hz, "frames a second");
  app.add_option("--seeds", options.seeds, "videos of each scene");
  app.add_option("--first-seed", options.first_seed);
  app.add_option("--only", options.only, "scenes whose name holds this");
  app.add_option("--pictures", options.images, "a folder for every tenth image, its truth and Marey's mask");
  app.add_flag("--lawn", options.lawn, "a lawn instead of a street");
  app.add_flag("!--no-peers", options.peers);
  CLI11_PARSE(app, argc, argv);
  if (!options.images.empty()) std::filesystem::create_directories(options.images);
  fmt::print("| scene: precision, recall, F |");
  for (const char* name : kNames) fmt::print(" {} |", name);
  fmt::print("\n| --- |{}\n", std::string(" --- |") + " --- | --- | --- | --- | --- |");
  for (const Scene& scene : kScenes) {
    if (std::string(scene.name).find(options.only) == std::string::npos) continue;
    std::vector<Score> scores(kModels);
    for (int seed = 0; seed < options.seeds; ++seed) assess(options, scene, options.first_seed + seed, scores);
    fmt::print("| {} |", scene.name);
    for (const Score& score : scores) {
      if (score.people > 0) fmt::print(" {:.3f} {:.3f} {:.3f} |", score.precision(), score.recall(), score.f());
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
}
