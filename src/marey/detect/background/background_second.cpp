#include "marey/detect/background/background_second.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace marey::detect::background {
namespace {

constexpr int kWidth = 10;         // levels: how near a pixel must be to its second mean
constexpr int kEstablished = 200;  // ticks after which a second mean is the scene's
constexpr int kAway = 1;           // the bit of a second mean that says that the scene was seen since
constexpr int kReturn = 25;        // ticks that a return to the second mean is worth: what sways, returns often
constexpr int kReturnWidens = 12;  // 1/8 levels of spread
constexpr double kGhost_s = 1;
constexpr double kMinStay_s = 2;
constexpr int kOutlasts =
    2;  // what stands before a scene that was not learned ahead must stay this many times as long as that was seen

}  // namespace

SecondScene::SecondScene(double absorb_after_s) : tick_s_(absorb_after_s / kEstablished) {}

void SecondScene::begin(cv::Size size, bool learned_ahead) {
  learned_ahead_ = learned_ahead;
  scene_ = learned_ahead ? cv::Mat() : cv::Mat::zeros(size, CV_8UC1);
  level_ = cv::Mat::zeros(size, CV_8UC1);
  detected_ = cv::Mat::zeros(size, CV_8UC1);
}

int SecondScene::ticks_between(double earlier_s, double later_s) const {
  return static_cast<int>(later_s / tick_s_) - static_cast<int>(std::max(0.0, earlier_s) / tick_s_);
}

bool SecondScene::knows(int row, int column, std::uint8_t level) const {
  return detected_.at<std::uint8_t>(row, column) >= kEstablished &&
         std::abs(level - level_.at<std::uint8_t>(row, column)) <= kWidth;
}

/// For how long something must stand before it is the scene.
int SecondScene::ticks_to_stay(double age_s, int seen_as_scene) const {
  const int minimum = static_cast<int>(std::ceil(kMinStay_s / tick_s_));
  const int required = learned_ahead_ ? static_cast<int>(std::ceil(age_s / 2 / tick_s_)) : kOutlasts * seen_as_scene;
  return std::min(kEstablished, std::max(minimum, required));
}

void SecondScene::forget(int row, int ticks, const ForegroundRegions& regions) {
  auto* level = level_.ptr<std::uint8_t>(row);
  auto* detected = detected_.ptr<std::uint8_t>(row);
  auto* scene = scene_.empty() || ticks == 0 ? nullptr : scene_.ptr<std::uint8_t>(row);
  const int fading = (ticks + 1) / 2;
  int x = 0;
  const auto fade_to = [&](int end) {
    for (int i = x; scene != nullptr && i < end; ++i) scene[i] = static_cast<std::uint8_t>(std::min(254, scene[i] + ticks));
    for (; x < end; ++x) {
      level[x] = static_cast<std::uint8_t>(level[x] | kAway);
      detected[x] = static_cast<std::uint8_t>(detected[x] > fading ? detected[x] - fading : 0);
    }
  };
  for (std::size_t i = regions.begin_of(row); i < regions.begin_of(row + 1); ++i) {
    fade_to(regions.runs()[i].begin);
    x = regions.runs()[i].end;
  }
  fade_to(level_.cols);
}

void SecondScene::count(int row, const std::uint8_t* pixels, const std::uint8_t* held, const ForegroundRegions& regions, int ticks,
                        double age_s, ScenePlane& scene, std::vector<int>& taken) {
  const auto* scene_seen = scene_.empty() ? nullptr : scene_.ptr<std::uint8_t>(row);
  const int ghost_enough = std::max(2, static_cast<int>(std::lround(kGhost_s / tick_s_)));
  auto* level = level_.ptr<std::uint8_t>(row);
  auto* detected = detected_.ptr<std::uint8_t>(row);
  taken.clear();
  for (std::size_t i = regions.begin_of(row); i < regions.begin_of(row + 1); ++i) {
    const bool ghost = regions.is_ghost(i);
    const bool thing = regions.is_thing(i);
    for (int x = regions.runs()[i].begin; x < regions.runs()[i].end; ++x) {
      if (held[x] != 0 && !ghost) continue;
      const int distance = pixels[x] - level[x];
      if (detected[x] == 0 || (std::abs(distance) > kWidth && detected[x] <= 2 * ticks)) {
        level[x] = static_cast<std::uint8_t>(pixels[x] & ~kAway);
        detected[x] = 1;
        continue;
      }
      if (std::abs(distance) > kWidth) {
        detected[x] = static_cast<std::uint8_t>(detected[x] - 2 * ticks);
        continue;
      }
      const bool returns = (level[x] & kAway) != 0;
      if (returns) scene.widen(row, x, kReturnWidens);
      const int gained = returns ? std::max(ticks, kReturn) : ticks;
      level[x] = static_cast<std::uint8_t>((level[x] + (distance > 1 ? 2 : distance < -1 ? -2 : 0)) & ~kAway);
      detected[x] = static_cast<std::uint8_t>(std::min(254, detected[x] + gained));
      const int stays = ghost   ? ghost_enough
                        : thing ? kEstablished
                                : ticks_to_stay(age_s, scene_seen == nullptr ? 0 : scene_seen[x]);
      if (detected[x] < stays) continue;
      level[x] = scene.level(row, x);
      if (ghost) detected[x] = 0;
      taken.push_back(x);
    }
  }
}

}  // namespace marey::detect::background
