// What the scene is at a pixel that showed several things for long. The levels seen there, luma and chroma together, make groups.
// A group that was seen both before and after another one, which itself lasted without interruption, is behind it: a person came,
// stood and went. Counting alone takes him for the scene where he stood for longer than the place was seen empty. And it counts
// each plane by itself: of a wall before which several people stood in grey and black it takes the light's level and their colour.
// What comes back is then trusted of the pixels round it too, at the times when it was seen: of two who stood there in black one
// after the other, neither was there then.
// Cost: the samples are read once; only pixels where fewer than half of them agree with the scene are examined.
#include "marey/detect/background/background_returning.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "marey/geometry/median.h"

namespace marey::detect::background {
namespace {

constexpr int kSameLuma = 10;            // levels, as the scene's first guess has it
constexpr int kSameChroma = 8;           // levels
constexpr std::size_t kMinSamples = 6;   // samples in which a thing that comes and goes can be distinguished from noise
constexpr double kMinFraction = 0.15;    // of the samples, in which what returns was seen
constexpr double kInterrupted = 1.5;     // times as long as it was seen, from the first time to the last: one stay
constexpr std::size_t kMaxSamples = 31;  // format: a bit for each in 32
constexpr double kAgree = 0.75;          // of the samples that showed the neighbour's scene, which must agree with one another
constexpr std::size_t kDistinctly = 2;   // times as many samples as show the scene as it is
constexpr std::uint8_t kMinSpread = 8;   // 1/8 levels

struct Detected {
  int luma = 0, cb = 128, cr = 128;

  bool is_like(const Detected& other) const {
    return std::abs(luma - other.luma) <= kSameLuma && std::abs(cb - other.cb) <= kSameChroma &&
           std::abs(cr - other.cr) <= kSameChroma;
  }
};

/// Samples at one pixel that show the same thing.
struct Group {
  std::vector<int> members;  // in the order of time

  int first() const { return members.front(); }
  int last() const { return members.back(); }
  bool is_one_stay() const { return last() - first() + 1 <= kInterrupted * static_cast<double>(members.size()); }
  bool encloses(const Group& other) const { return first() < other.first() && last() > other.last(); }
};

std::vector<Group> groups_of(const std::vector<Detected>& detected) {
  std::vector<Group> groups;
  std::vector<bool> grouped(detected.size(), false);
  for (std::size_t i = 0; i < detected.size(); ++i) {
    if (grouped[i]) continue;
    Group& group = groups.emplace_back();
    for (std::size_t j = i; j < detected.size(); ++j) {
      if (grouped[j] || !detected[i].is_like(detected[j])) continue;
      grouped[j] = true;
      group.members.push_back(static_cast<int>(j));
    }
  }
  return groups;
}

/// The group that is behind the most frequent one, or that one itself where none is; nothing if the scene as it is, which
/// `agreeing` of the samples show, is as good.
struct SceneGroup {
  const Group* group = nullptr;
  bool comes_back = false;
};

SceneGroup scene_among(const std::vector<Group>& groups, std::size_t samples, std::size_t agreeing) {
  const auto fewer = [](const Group& a, const Group& b) { return a.members.size() < b.members.size(); };
  const Group* scene = &*std::max_element(groups.begin(), groups.end(), fewer);
  bool comes_back = false;
  for (bool searching = 2 * scene->members.size() <= samples; searching;) {
    const Group* behind = nullptr;
    for (const Group& group : groups) {
      if (static_cast<double>(group.members.size()) < kMinFraction * static_cast<double>(samples)) continue;
      if (!scene->is_one_stay() || !group.encloses(*scene)) continue;
      if (behind == nullptr || fewer(*behind, group)) behind = &group;
    }
    searching = behind != nullptr;
    comes_back = comes_back || searching;
    if (searching) scene = behind;
  }
  if (comes_back) return {scene, true};
  return {scene->members.size() >= kDistinctly * agreeing ? scene : nullptr, false};
}

/// The median of the group's levels, and what a quarter of them is further from it than, in 1/8 levels.
struct Level {
  std::uint8_t level = 0, spread = 0;
};

Level level_of(std::vector<int> levels) {
  const int level = geometry::median(levels);
  for (int& one : levels) one = std::abs(one - level);
  const auto upper = levels.begin() + 3 * std::ssize(levels) / 4;
  std::nth_element(levels.begin(), upper, levels.end());
  return {static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(std::clamp(8 * *upper, int{kMinSpread}, 255))};
}

/// 1 where a level is within `same` of the scene's; else 0.
void mark_like(const std::uint8_t* __restrict levels, const std::uint8_t* __restrict scene, std::size_t count, std::uint8_t same,
               std::uint8_t* __restrict like) {
  for (std::size_t x = 0; x < count; ++x) {
    const std::uint8_t more = levels[x] > scene[x] ? levels[x] : scene[x], less = levels[x] > scene[x] ? scene[x] : levels[x];
    like[x] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(more - less) <= same ? 1 : 0);
  }
}

/// Adds those of a row that are like the scene in luma, and where there is chroma, of half the size, in that too.
void add_like(const std::uint8_t* __restrict luma, const std::uint8_t* __restrict chroma, std::size_t count,
              std::uint8_t* __restrict sums) {
  if (chroma == nullptr) {
    for (std::size_t x = 0; x < count; ++x) sums[x] = static_cast<std::uint8_t>(sums[x] + luma[x]);
    return;
  }
  for (std::size_t x = 0; x < count / 2; ++x) {
    sums[2 * x] = static_cast<std::uint8_t>(sums[2 * x] + (luma[2 * x] & chroma[x]));
    sums[2 * x + 1] = static_cast<std::uint8_t>(sums[2 * x + 1] + (luma[2 * x + 1] & chroma[x]));
  }
  if (count % 2 != 0) sums[count - 1] = static_cast<std::uint8_t>(sums[count - 1] + (luma[count - 1] & chroma[count / 2]));
}

/// A row of the scene's levels.
void read_levels(const ScenePlane& plane, int row, std::vector<std::uint8_t>& levels) {
  levels.resize(static_cast<std::size_t>(plane.size().width));
  for (std::size_t x = 0; x < levels.size(); ++x) levels[x] = plane.level(row, static_cast<int>(x));
}

/// A scene's three planes while they are corrected.
class Correction {
 public:
  Correction(std::span<const FramePlanes> samples, const ScenePlanes& scene)
      : samples_(samples),
        scene_(scene),
        luma_(samples.front().luma.size()),
        cb_(samples.front().cb.size()),
        cr_(samples.front().cr.size()) {
    detected_.resize(samples.size());
    when_ = cv::Mat::zeros(size(), CV_32SC1);
  }

  cv::Size size() const { return samples_.front().luma.size(); }

  /// By the observations at each pixel of a row alone.
  void inspect_at_row(int y) {
    count_agreeing(y);
    for (int x = 0; x < size().width; ++x) {
      if (2 * static_cast<std::size_t>(agreeing_[static_cast<std::size_t>(x)]) <= samples_.size()) inspect_at(y, x);
    }
  }

  /// When the place beside a pixel was seen empty, the pixel was too: from pixels where something came back to those round them.
  void spread() {
    while (!sure_.empty()) {
      const cv::Point from = sure_.back();
      sure_.pop_back();
      const int when = when_.at<int>(from);
      for (const cv::Point& by : {cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
        const cv::Point to = from + by;
        if (!cv::Rect({}, size()).contains(to) || when_.at<int>(to) != 0) continue;
        read(to.y, to.x);
        std::vector<int> members;
        for (int i = 0; i < static_cast<int>(detected_.size()); ++i) {
          if ((when >> i & 1) != 0) members.push_back(i);
        }
        const Detected then{median(members, &Detected::luma), median(members, &Detected::cb), median(members, &Detected::cr)};
        std::erase_if(members, [&](int i) { return !detected_[static_cast<std::size_t>(i)].is_like(then); });
        if (then.is_like(scene_at(to.y, to.x)) ||
            static_cast<double>(members.size()) < kAgree * std::popcount(static_cast<unsigned>(when)))
          continue;
        set(to.y, to.x, members);
        keep(to.y, to.x, members);
      }
    }
  }

  void apply() const {
    luma_.apply_to(*scene_.luma);
    if (scene_.cb == nullptr) return;
    cb_.apply_to(*scene_.cb);
    cr_.apply_to(*scene_.cr);
  }

 private:
  struct Plane {
    explicit Plane(cv::Size size)
        : levels(cv::Mat::zeros(size, CV_8UC1)), spreads(cv::Mat::zeros(size, CV_8UC1)), where(cv::Mat::zeros(size, CV_8UC1)) {}
    void set(int y, int x, const Level& level) {
      levels.at<std::uint8_t>(y, x) = level.level;
      spreads.at<std::uint8_t>(y, x) = level.spread;
      where.at<std::uint8_t>(y, x) = 255;
    }
    void apply_to(ScenePlane& plane) const { plane.replace(levels, spreads, where); }
    cv::Mat levels, spreads, where;
  };

  /// How many samples show the scene as it is, at each pixel of a row.
  void count_agreeing(int y) {
    const auto width = static_cast<std::size_t>(size().width);
    const bool colour = scene_.cb != nullptr;
    agreeing_.assign(width, 0);
    like_.resize(width);
    read_levels(*scene_.luma, y, luma_row_);
    if (colour) {
      read_levels(*scene_.cb, y / 2, cb_row_);
      read_levels(*scene_.cr, y / 2, cr_row_);
      cb_like_.resize(cb_row_.size());
      cr_like_.resize(cr_row_.size());
    }
    for (const FramePlanes& sample : samples_) {
      mark_like(sample.luma.ptr<std::uint8_t>(y), luma_row_.data(), width, kSameLuma, like_.data());
      if (colour) {
        mark_like(sample.cb.ptr<std::uint8_t>(y / 2), cb_row_.data(), cb_row_.size(), kSameChroma, cb_like_.data());
        mark_like(sample.cr.ptr<std::uint8_t>(y / 2), cr_row_.data(), cr_row_.size(), kSameChroma, cr_like_.data());
        for (std::size_t x = 0; x < cb_like_.size(); ++x) cb_like_[x] &= cr_like_[x];
      }
      add_like(like_.data(), colour ? cb_like_.data() : nullptr, width, agreeing_.data());
    }
  }

  void inspect_at(int y, int x) {
    read(y, x);
    const std::vector<Group> groups = groups_of(detected_);
    const auto [group, comes_back] = scene_among(groups, samples_.size(), agreeing_[static_cast<std::size_t>(x)]);
    if (group == nullptr) return;
    set(y, x, group->members);
    if (comes_back) keep(y, x, group->members);
  }

  void read(int y, int x) {
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      detected_[i].luma = samples_[i].luma.at<std::uint8_t>(y, x);
      if (scene_.cb == nullptr) continue;
      detected_[i].cb = samples_[i].cb.at<std::uint8_t>(y / 2, x / 2);
      detected_[i].cr = samples_[i].cr.at<std::uint8_t>(y / 2, x / 2);
    }
  }
  Detected scene_at(int y, int x) const {
    if (scene_.cb == nullptr) return {scene_.luma->level(y, x)};
    return {scene_.luma->level(y, x), scene_.cb->level(y / 2, x / 2), scene_.cr->level(y / 2, x / 2)};
  }
  std::vector<int> levels_of(const std::vector<int>& members, int Detected::* plane) const {
    std::vector<int> levels;
    for (const int member : members) levels.push_back(detected_[static_cast<std::size_t>(member)].*plane);
    return levels;
  }
  int median(const std::vector<int>& members, int Detected::* plane) const { return level_of(levels_of(members, plane)).level; }
  void set(int y, int x, const std::vector<int>& members) {
    luma_.set(y, x, level_of(levels_of(members, &Detected::luma)));
    if (scene_.cb == nullptr) return;
    cb_.set(y / 2, x / 2, level_of(levels_of(members, &Detected::cb)));
    cr_.set(y / 2, x / 2, level_of(levels_of(members, &Detected::cr)));
  }
  void keep(int y, int x, const std::vector<int>& members) {
    unsigned when = 0;
    for (const int member : members) when |= 1U << member;
    when_.at<int>(y, x) = static_cast<int>(when);
    sure_.emplace_back(x, y);
  }

  std::span<const FramePlanes> samples_;
  ScenePlanes scene_;
  Plane luma_, cb_, cr_;
  std::vector<Detected> detected_;  // at the pixel in question
  // Of a row: how many samples agree with the scene, its levels, and where one sample does.
  std::vector<std::uint8_t> agreeing_, luma_row_, cb_row_, cr_row_, like_, cb_like_, cr_like_;
  cv::Mat when_;                 // CV_32SC1: a bit for each sample in which what comes back was seen
  std::vector<cv::Point> sure_;  // pixels of which the others may learn
};

}  // namespace

void trust_what_returns(std::span<const FramePlanes> samples, const ScenePlanes& scene) {
  if (samples.size() < kMinSamples) return;
  if (samples.size() > kMaxSamples) samples = samples.first(kMaxSamples);
  Correction correction(samples, scene);
  for (int y = 0; y < correction.size().height; ++y) correction.inspect_at_row(y);
  correction.spread();
  correction.apply();
}

}  // namespace marey::detect::background
