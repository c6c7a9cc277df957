#include "marey/detect/background/background.h"

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "marey/core/error.h"
#include "marey/detect/background/background_kernels.h"
#include "marey/detect/background/background_scene_test.h"
#include "marey/detect/background/background_shadow.h"
#include "marey/detect/kernel_targets.h"

namespace marey::detect::background {
namespace {

using test::Figure;
using test::SceneFrame;
using test::SmallScene;

constexpr int kSecond = SmallScene::kRate;

TEST(BackgroundRegister, KnowsItsModelsByName) {
  EXPECT_EQ(background_names(), "marey, mog2, knn");
  EXPECT_TRUE(std::holds_alternative<KnnOptions>(parse_background("knn")));
  try {
    parse_background("magic");
    FAIL() << "an unknown name must be refused";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "there is no background model \"magic\"; choose one of: marey, mog2, knn");
  }
}

/// How a mask compares with the truth, summed over frames.
struct Score {
  double hit = 0, people = 0, marked = 0, shadow_hit = 0, shadow = 0, frames = 0;
  double recall() const { return hit / people; }
  double precision() const { return hit / marked; }
  double shadow_fraction() const { return shadow_hit / shadow; }
  double false_fraction() const { return (marked - hit) / (frames * SmallScene::kWidth * SmallScene::kHeight); }

  void add(const cv::Mat& mask, const SceneFrame& truth) {
    hit += cv::countNonZero(mask & truth.people);
    people += cv::countNonZero(truth.people);
    marked += cv::countNonZero(mask);
    shadow_hit += cv::countNonZero(mask & truth.shadows);
    shadow += cv::countNonZero(truth.shadows);
    frames += 1;
  }
};

/// Shows a model `frames` images of a scene of its own, and scores from frame `from` on.
using Play = std::function<SceneFrame(SmallScene&, int frame)>;
Score play(const BackgroundOptions& options, int frames, int from, const Play& next, std::vector<Box> held = {}) {
  const auto model = make_background(options);
  SmallScene scene(7);
  Score score;
  for (int i = 0; i < frames; ++i) {
    const SceneFrame shown = next(scene, i);
    const Foreground detected = model->apply(shown.frame, held);
    if (i >= from) score.add(detected.mask, shown);
  }
  return score;
}

std::vector<Figure> walkers(int frame) {
  if (frame < 4 * kSecond) return {};
  const int x = 3 * (frame - 4 * kSecond);
  return {{x % 360 - 30, 120}, {300 - x % 360, 180}};
}

SceneFrame walking(SmallScene& scene, int frame) {
  return scene.video(walkers(frame));
}

TEST(Background, FindsPeopleAndNotTheirShadows) {
  const Score ours = play(AdaptiveOptions{}, 20 * kSecond, 4 * kSecond, walking);
  const Score unaware = play(AdaptiveOptions{.suppress_shadows = false}, 20 * kSecond, 4 * kSecond, walking);
  EXPECT_GT(ours.recall(), 0.93);
  EXPECT_GT(ours.precision(), 0.93);
  EXPECT_LT(ours.shadow_fraction(), 0.1);
  EXPECT_GT(unaware.shadow_fraction(), 0.8) << "the shadows are there to be found";
}

TEST(Background, FollowsLightThatFallsSlowly) {
  const Play dusk = [](SmallScene& scene, int frame) {
    return scene.video(walkers(frame), 1 - 0.4 * std::min(1.0, frame / (20.0 * kSecond)));
  };
  const Score ours = play(AdaptiveOptions{}, 25 * kSecond, 4 * kSecond, dusk);
  const Score mog2 = play(Mog2Options{}, 25 * kSecond, 4 * kSecond, dusk);
  EXPECT_GT(ours.recall(), 0.97);
  EXPECT_GT(ours.precision(), 0.92);
  EXPECT_GT(ours.recall(), mog2.recall());
  EXPECT_GT(ours.precision(), mog2.precision());
}

TEST(Background, FollowsALampAtOnce) {
  const Play lamp = [](SmallScene& scene, int frame) { return scene.video(walkers(frame), frame < 10 * kSecond ? 1 : 1.35); };
  const Score ours = play(AdaptiveOptions{}, 12 * kSecond, 10 * kSecond, lamp);
  const Score mog2 = play(Mog2Options{}, 12 * kSecond, 10 * kSecond, lamp);
  EXPECT_GT(ours.recall(), 0.9);
  EXPECT_LT(ours.false_fraction(), 0.005);
  EXPECT_GT(mog2.false_fraction(), 0.1) << "a lamp that a plain model notices";
}

TEST(Background, LearnsATreeThatSways) {
  const Play wind = [](SmallScene& scene, int frame) { return scene.video({}, 1, 1.5 * std::sin(frame * 0.7)); };
  const Score early = play(AdaptiveOptions{}, 2 * kSecond, 0, wind);
  const Score ours = play(AdaptiveOptions{}, 60 * kSecond, 40 * kSecond, wind);
  EXPECT_LT(ours.false_fraction(), 0.008);
  EXPECT_LT(ours.false_fraction(), early.false_fraction() / 2);
}

TEST(Background, KeepsAPersonWhoStandsStill) {
  const Figure still{150, 150};
  const Play standing = [&](SmallScene& scene, int frame) {
    return scene.video(frame < 5 * kSecond ? std::span<const Figure>{} : std::span(&still, 1));
  };
  const Score alone = play(AdaptiveOptions{}, 65 * kSecond, 64 * kSecond, standing);
  const Score mog2 = play(Mog2Options{}, 65 * kSecond, 64 * kSecond, standing);
  const Score held = play(AdaptiveOptions{.absorb_after_s = 20}, 65 * kSecond, 64 * kSecond, standing, {Box{148, 93, 24, 59}});
  const Score absorbed = play(AdaptiveOptions{.absorb_after_s = 20}, 65 * kSecond, 64 * kSecond, standing);
  EXPECT_GT(alone.recall(), 0.9);
  EXPECT_GT(held.recall(), 0.9);
  EXPECT_LT(absorbed.recall(), 0.1);
  EXPECT_LT(mog2.recall(), 0.5);
}

TEST(Background, LearnedAheadIsWhatComesBackBeforeWhomItWasHiddenFor) {
  // 30 images, a second apart: 7 of the empty place, 13 of a person who stands there, 3 empty, 7 of another.
  SmallScene scene(11);
  std::vector<Frame> samples;
  const Figure long_there{150, 150}, later{152, 151};
  for (int i = 0; i < 30; ++i) {
    const bool first = i >= 7 && i < 20, second = i >= 23;
    samples.push_back(scene.video(first    ? std::span(&long_there, 1)
                                  : second ? std::span(&later, 1)
                                           : std::span<const Figure>{})
                          .frame);
  }
  const auto model = make_background(AdaptiveOptions{});
  model->prime(samples);
  const SceneFrame empty = scene.video({});
  EXPECT_LT(cv::countNonZero(model->apply(empty.frame, {}).mask), 20);
  const SceneFrame there = scene.video(std::span(&long_there, 1));
  Score score;
  score.add(model->apply(there.frame, {}).mask, there);
  EXPECT_GT(score.recall(), 0.9);
}

TEST(Background, HealsTheGhostOfOneWhoWasThereFirst) {
  const Play leaving = [](SmallScene& scene, int frame) {
    const Figure figure{100 + std::max(0, frame - 12 * kSecond) * 4, 150};
    return scene.video(std::span(&figure, 1));
  };
  // From three seconds after the figure has walked off the place where it stood for twelve.
  const Score ours = play(AdaptiveOptions{}, 17 * kSecond, 16 * kSecond, leaving);
  EXPECT_GT(ours.recall(), 0.97);
  EXPECT_LT(ours.false_fraction(), 0.003);
}

TEST(Background, BeginsWithoutThePeopleOfItsSamples) {
  SmallScene scene(3);
  std::vector<Frame> samples;
  for (int i = 0; i < 32; ++i) samples.push_back(scene.video(std::vector<Figure>{{i * 9, 120}, {280 - i * 9, 190}}).frame);
  const auto model = make_background();
  model->prime(samples);
  const SceneFrame shown = scene.video(std::vector<Figure>{{100, 120}});
  Score score;
  score.add(model->apply(shown.frame, {}).mask, shown);
  EXPECT_GT(score.recall(), 0.93);
  EXPECT_GT(score.precision(), 0.9);
}

TEST(Background, BeginsAnewWhenTheCameraWasMoved) {
  const auto model = make_background();
  SmallScene here(1), there(2);
  for (int i = 0; i < 3 * kSecond; ++i) model->apply(here.video({}).frame, {});
  double first = 0, last = 0;
  for (int i = 0; i < 5 * kSecond; ++i) {
    Frame frame = there.video({}).frame;
    frame.time += duration_from_seconds(3);
    cv::Mat moved;
    cv::flip(frame.image.luma(), moved, -1);
    for (int x = 0; x < moved.cols; x += 16) moved.colRange(x, x + 8) /= 2;
    for (int x = 8; x < moved.cols; x += 16) moved.colRange(x, x + 8) += 80;
    frame.image = Image(moved, frame.image.cb(), frame.image.cr(), Image::Range::limited);
    last = cv::countNonZero(model->apply(frame, {}).mask);
    if (i == 0) first = last;
  }
  EXPECT_GT(first, 0.7 * SmallScene::kWidth * SmallScene::kHeight);
  EXPECT_LT(last, 0.01 * SmallScene::kWidth * SmallScene::kHeight);
}

TEST(Background, IsTheSameFromRunToRun) {
  const auto run = [] {
    const auto model = make_background();
    SmallScene scene(5);
    cv::Mat all;
    for (int i = 0; i < 6 * kSecond; ++i) all.push_back(model->apply(scene.video(walkers(i)).frame, {}).mask.clone());
    return all;
  };
  EXPECT_EQ(cv::countNonZero(run() != run()), 0);
}

TEST(Background, TakesPicturesOfAnySizeAndKind) {
  std::mt19937 random(11);
  for (const char* name : {"marey", "mog2", "knn"}) {
    const auto model = make_background(parse_background(name));
    int number = 0;
    for (const cv::Size size :
         {cv::Size(1, 1), cv::Size(1, 1), cv::Size(33, 17), cv::Size(33, 17), cv::Size(2, 40), cv::Size(40, 2), cv::Size(64, 48)}) {
      for (const int kind : {CV_8UC1, CV_16UC1, CV_8UC3}) {
        cv::Mat pixels(size, kind);
        cv::theRNG().state = random();
        cv::randu(pixels, 0, kind == CV_16UC1 ? 65535 : 255);
        Frame frame;
        frame.time = timestamp_from_seconds(0.04 * number++);
        frame.image = kind == CV_8UC3 ? Image::from_bgr(pixels) : Image(pixels);
        const Foreground detected = model->apply(frame, std::vector<Box>{{-5, -5, 8, 8}, {0.5, 0.5, 1e6, 1e6}});
        EXPECT_EQ(detected.mask.size(), size) << name;
        EXPECT_EQ(detected.mask.type(), CV_8UC1) << name;
      }
    }
  }
}

TEST(Background, SixteenBitsTellTheSameAsEight) {
  const auto eight = make_background();
  const auto sixteen = make_background();
  SmallScene scene(9);
  for (int i = 0; i < 6 * kSecond; ++i) {
    Frame frame = scene.video(walkers(i)).frame;
    const cv::Mat luma = frame.image.luma();
    frame.image = Image(luma);
    const cv::Mat mask = eight->apply(frame, {}).mask.clone();
    cv::Mat deep;
    luma.convertTo(deep, CV_16U, 257);
    frame.image = Image(deep);
    ASSERT_EQ(cv::countNonZero(sixteen->apply(frame, {}).mask != mask), 0) << "frame " << i;
  }
}

TEST(BackgroundKernels, AreTheSameForEveryMachine) {
  const auto targets = kernels_of_every_target(background_kernels);
  std::mt19937 random(21);
  const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
  for (const int width : {1, 2, 31, 32, 33, 100}) {
    std::vector<std::vector<std::uint8_t>> first;
    std::vector<std::int16_t> first_mean;
    std::vector<std::uint8_t> pixels(width), low(width), high(width), frozen(width), spread(width);
    std::vector<std::int16_t> mean(width), above(width), below(width);
    for (int x = 0; x < width; ++x) {
      pixels[x] = byte(), spread[x] = byte(), frozen[x] = byte() & 1;
      low[x] = byte(), high[x] = std::max(low[x], byte());
      mean[x] = static_cast<std::int16_t>(random() % 32641), above[x] = static_cast<std::int16_t>(random() % 32641);
      below[x] = static_cast<std::int16_t>(random() % 32641);
    }
    std::vector<std::uint8_t> unsorted(static_cast<std::size_t>(16) * 128);
    for (std::uint8_t& value : unsorted) value = byte();
    for (const auto& [target, table] : targets) {
      SCOPED_TRACE(testing::Message() << target << ", width " << width);
      const BackgroundKernels& kernels = *table;
      std::vector<std::uint8_t> mark(width), voted(width), padded(width + 2, 0), spread_now = spread, low_now(width),
                                                                                 high_now(width);
      std::vector<std::int16_t> mean_now = mean;
      kernels.classify(pixels.data(), low.data(), high.data(), width, mark.data());
      std::copy(mark.begin(), mark.end(), padded.begin() + 1);
      const std::uint8_t* const rows[3] = {padded.data() + 1, padded.data() + 1, padded.data() + 1};
      kernels.vote(rows, 4, width, voted.data());
      kernels.learn(pixels.data(), frozen.data(), width, 3, mean_now.data(), spread_now.data());
      const std::int16_t* const means[3] = {above.data(), mean_now.data(), below.data()};
      kernels.band(means, spread_now.data(), width, 56, 8, low_now.data(), high_now.data());
      std::vector<std::uint8_t> sorted = unsorted, middle(128), length(128);
      kernels.sort(sorted.data(), 4, 128, 128);
      for (int x = 0; x < 128; ++x) {
        for (int i = 1; i < 16; ++i) ASSERT_LE(sorted[(i - 1) * 128 + x], sorted[i * 128 + x]);
      }
      kernels.shortest_half(sorted.data(), 16, 128, 128, middle.data(), length.data());
      const std::vector<std::vector<std::uint8_t>> results{mark, voted, spread_now, low_now, high_now, sorted, middle, length};
      if (first.empty()) first = results, first_mean = mean_now;
      EXPECT_EQ(results, first);
      EXPECT_EQ(mean_now, first_mean);
      for (int x = 0; x < width; ++x) {
        EXPECT_EQ(mark[x] != 0, pixels[x] < low[x] || pixels[x] > high[x]);
        EXPECT_LE(low_now[x], (mean_now[x] + 127) / 128);
        EXPECT_GE(high_now[x], mean_now[x] / 128);
        EXPECT_TRUE(frozen[x] == 0 || mean_now[x] == mean[x]) << "what is frozen learns nothing";
      }
    }
  }
}

TEST(ShadowFinder, AShadowOnColouredGroundKeepsItsColour) {
  // A lawn of luma 90 over black, chroma −20 and −12 from grey.
  const auto is_shadow = [](int luma, int cb, int cr) { return ShadowFinder::is_coloured_shadow(luma, 90, cb, cr, -20, -12); };
  EXPECT_TRUE(is_shadow(50, -11, -7));
  EXPECT_TRUE(is_shadow(50, -17, -10)) << "its edge, where chroma still has light in it";
  EXPECT_FALSE(is_shadow(50, 0, 0)) << "a grey thing";
  EXPECT_FALSE(is_shadow(50, -7, 14)) << "skin";
  EXPECT_FALSE(is_shadow(20, -5, -3)) << "too dark";
  EXPECT_FALSE(is_shadow(110, -22, -13)) << "lighter";
  EXPECT_FALSE(ShadowFinder::is_coloured_shadow(50, 90, 0, 0, -3, 2)) << "grey ground tells nothing";
}

}  // namespace
}  // namespace marey::detect::background
