// Marey's own model of the empty scene.
//
// Each pixel has a mean and the spread of its noise, and from them a band of levels that belong to the scene; chroma has the same
// at half size. A frame is compared with the bands, a pixel stands by the vote of its 3 × 3 round, and a connected region counts
// where parts of it lie far outside the bands (hysteresis). What is then explained by a cast shadow, or by what was seen at the
// pixel for long before, is taken out. Means follow background pixels by a recursive average, spreads by sigma-delta steps towards
// a quantile.
//
// - A change of light rescales the means at once (background_light.cpp).
// - A thing that stands still is counted, pixel by pixel, in a second mean; only after `absorb_after_s`, or at the start after half
// the
//   time that the model has existed, do the two change places. Pixels in `held` boxes are not counted and not learned.
// - A ghost, where something of the first frames has left, is a region whose border is an edge in the scene but not in the
//   frame; it is believed to be scene after a second.
// - Where most of a picture does not fit the scene for seconds (the camera was moved), the model begins anew.
//
// Cost: about five bytes read a pixel and frame; a frame teaches one eighth of the rows, in turn. All else grows with what moves.
// References: Stauffer & Grimson 1999 (modes that change places); Manzanera & Richefeu 2007 (sigma-delta); Cucchiara et al. 2003
// (ghosts and shadows); Barnich & Van Droogenbroeck, ViBe, 2011 (a pixel may look as its neighbours do).
#include "marey/detect/background_adaptive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "marey/core/picture.h"
#include "marey/detect/background_kernels.h"
#include "marey/detect/background_light.h"
#include "marey/detect/background_plane.h"
#include "marey/detect/background_shadow.h"
#include "marey/detect/runs.h"
#include "marey/detect/silhouette.h"

namespace marey {
namespace {

constexpr int kLumaFloor = 8;      // levels: the narrowest band's half width
constexpr int kChromaFloor = 6;    // levels
constexpr int kGate = 56;          // 3.5 spreads of 1.15 σ: 4 σ
constexpr int kQuorum = 4;         // of 9
constexpr int kStrongPixels = 4;   // that make a region count
constexpr int kFewestPixels = 10;  // of a region
constexpr int kTurns = 8;          // frames until each row was taught once
constexpr int kRowsATurn = 16;
constexpr int kFringe = 3;         // px round a region that are not learned: its blurred rim
constexpr int kSecondWidth = 10;   // levels: how near a pixel must be to its second mean
constexpr int kEstablished = 200;  // ticks after which a second mean is the scene's
constexpr int kAway = 1;           // the bit of a second mean that says that the scene was seen since
constexpr int kReturn = 25;        // ticks that a return to the second mean is worth: what sways, returns often
constexpr int kReturnWidens = 12;  // 1/8 levels of spread
constexpr double kGhost_s = 1;
constexpr double kStartAnew_s = 2;
constexpr double kTooMuch = 0.6;  // of the picture

int shift_of(double time_constant, double step) {
  return std::clamp(static_cast<int>(std::lround(std::log2(std::max(time_constant / step, 1.0)))), 1, 7);
}

/// One frame's foreground before it is cleaned.
struct Marked {
  std::vector<PixelRun> runs;
  std::vector<int> strong;  ///< of each run: its pixels far outside the bands
  double pixels = 0;
};

class AdaptiveBackground final : public Background {
 public:
  explicit AdaptiveBackground(const AdaptiveOptions& options) : options_(options) {}

  void prime(std::span<const Frame> samples) override {
    std::vector<cv::Mat> luma, cb, cr;
    for (const Frame& sample : samples) {
      if (sample.picture.empty() || (!luma.empty() && sample.picture.size() != luma.front().size())) continue;
      const FramePlanes planes = planes_of(sample.picture);
      if (!luma.empty() && planes.cb.empty() != cb.empty()) continue;
      luma.push_back(planes.luma);
      if (!planes.cb.empty()) {
        cb.push_back(planes.cb);
        cr.push_back(planes.cr);
      }
      black_ = black_of(sample.picture);
    }
    if (luma.empty()) return;
    luma_.begin(luma);
    if (!cb.empty()) {
      cb_.begin(cb);
      cr_.begin(cr);
    }
    make_room(luma.front().size(), !cb.empty());
    age_s_ = std::max(0.0, seconds(samples.back().time - samples.front().time));
  }

  Foreground apply(const Frame& frame, std::span<const Box> held) override {
    const FramePlanes planes = planes_of(frame.picture);
    black_ = black_of(frame.picture);
    if (planes.luma.empty()) return {};
    if (planes.luma.size() != size_ || planes.cb.empty() == colour_) begin(planes);
    keep_time(frame.time);

    mark(planes);
    if (follow_light(planes)) mark(planes);
    choose_regions();
    find_ghosts(planes);
    draw_mask(planes);
    if (start_anew_if_lost(planes)) return {mask_};
    learn(planes, held);
    ++frames_;
    return {mask_};
  }

 private:
  static int black_of(const Picture& picture) { return picture.range() == Picture::Range::limited ? 16 : 0; }

  static FramePlanes planes_of(const Picture& picture) {
    FramePlanes planes{picture.luma(), picture.cb(), picture.cr()};
    if (planes.luma.depth() == CV_16U) {
      cv::Mat eight_bit;
      planes.luma.convertTo(eight_bit, CV_8U, 1.0 / 257.0);
      planes.luma = eight_bit;
    }
    return planes;
  }

  void begin(const FramePlanes& planes) {
    luma_.begin(planes.luma);
    if (!planes.cb.empty()) {
      cb_.begin(planes.cb);
      cr_.begin(planes.cr);
    }
    make_room(planes.luma.size(), !planes.cb.empty());
    age_s_ = 0;
  }

  void make_room(cv::Size size, bool colour) {
    size_ = size;
    colour_ = colour;
    mask_ = cv::Mat::zeros(size, CV_8UC1);
    second_ = cv::Mat::zeros(size, CV_8UC1);
    seen_ = cv::Mat::zeros(size, CV_8UC1);
    shadows_.begin(size);
    drawn_.clear();
    const std::size_t padded = static_cast<std::size_t>(size.width) + 4;
    for (auto& row : marks_) row.assign(padded, 0);
    chroma_mark_.assign(padded, 0);
    vote_.assign(padded, 0);
    frozen_.assign(padded, 0);
    held_row_.assign(padded, 0);
    half_frozen_.assign(padded, 0);
    lost_s_ = 0;
    usual_share_ = 0;
    frames_ = 0;
  }

  /// `step_s_` is the time since the last frame; odd clocks are kept within reason.
  void keep_time(Timestamp now) {
    step_s_ = last_time_ ? std::clamp(seconds(now - *last_time_), 1e-3, 2.0) : 0.04;
    last_time_ = now;
    age_s_ += step_s_;
    mean_step_s_ = mean_step_s_ > 0 ? mean_step_s_ + (step_s_ - mean_step_s_) / 16 : step_s_;
  }

  // ---- compare -----------------------------------------------------------------------------------------------------------

  void mark_row(const FramePlanes& planes, int y) {
    std::uint8_t* mark = marks_[y % 3].data() + 1;
    kernels_.classify(planes.luma.ptr<std::uint8_t>(y), luma_.low(y), luma_.high(y), size_.width, mark);
    if (!colour_) return;
    const int half = y / 2;
    if (y % 2 == 0) {
      const std::uint8_t* const pixels[2] = {planes.cb.ptr<std::uint8_t>(half), planes.cr.ptr<std::uint8_t>(half)};
      const std::uint8_t* const low[2] = {cb_.low(half), cr_.low(half)};
      const std::uint8_t* const high[2] = {cb_.high(half), cr_.high(half)};
      kernels_.classify_chroma(pixels, low, high, planes.cb.cols, chroma_mark_.data());
    }
    kernels_.unite(chroma_mark_.data(), size_.width, mark);
  }

  void mark(const FramePlanes& planes) {
    marked_.runs.clear();
    marked_.strong.clear();
    marked_.pixels = 0;
    std::fill(marks_[2].begin(), marks_[2].end(), std::uint8_t{0});
    mark_row(planes, 0);
    for (int y = 0; y < size_.height; ++y) {
      if (y + 1 < size_.height) {
        mark_row(planes, y + 1);
      } else {
        std::fill(marks_[(y + 1) % 3].begin(), marks_[(y + 1) % 3].end(), std::uint8_t{0});
      }
      const std::uint8_t* const rows[3] = {marks_[(y + 2) % 3].data() + 1, marks_[y % 3].data() + 1,
                                           marks_[(y + 1) % 3].data() + 1};
      kernels_.vote(rows, kQuorum, size_.width, vote_.data());
      append_runs(vote_.data(), y, size_.width, marked_.runs);
      for (std::size_t i = marked_.strong.size(); i < marked_.runs.size(); ++i) {
        const PixelRun& run = marked_.runs[i];
        marked_.strong.push_back(static_cast<int>(std::count(vote_.begin() + run.begin, vote_.begin() + run.end, std::uint8_t{3})));
        marked_.pixels += run.end - run.begin;
      }
    }
  }

  /// Rescales the scene where the light has changed. True where it did.
  bool follow_light(const FramePlanes& planes) {
    const double share = marked_.pixels / static_cast<double>(size_.area());
    const bool jumped = share > usual_share_ + 0.03;
    usual_share_ += (share - usual_share_) * 0.1;
    if (!jumped && frames_ % kTurns != 0) return false;
    const std::optional<LightChange> change = meter_.measure(planes.luma, luma_, black_);
    if (!change || !change->explained) return false;
    luma_.scale(change->gains, black_);
    if (colour_) {
      cb_.shift(median_difference(planes.cb, cb_));
      cr_.shift(median_difference(planes.cr, cr_));
    }
    return true;
  }

  // ---- clean -------------------------------------------------------------------------------------------------------------

  /// Keeps the runs of regions that are large and sure enough, in order, with the number of the region of each.
  void choose_regions() {
    const std::size_t count = marked_.runs.size();
    forest_.reset(count);
    join_neighbours(marked_.runs, 1, forest_);
    areas_.assign(count, 0);
    strongs_.assign(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      const int root = forest_.root(static_cast<int>(i));
      areas_[root] += marked_.runs[i].end - marked_.runs[i].begin;
      strongs_[root] += marked_.strong[i];
    }
    runs_.clear();
    region_.clear();
    borders_.clear();
    numbers_.assign(count, -1);
    for (std::size_t i = 0; i < count; ++i) {
      const int root = forest_.root(static_cast<int>(i));
      if (areas_[root] < kFewestPixels || strongs_[root] < kStrongPixels) continue;
      if (numbers_[root] < 0) {
        numbers_[root] = static_cast<int>(borders_.size());
        borders_.push_back({});
      }
      runs_.push_back(marked_.runs[i]);
      region_.push_back(numbers_[root]);
    }
    row_begin_.assign(static_cast<std::size_t>(size_.height) + 1, 0);
    for (const PixelRun& run : runs_) ++row_begin_[run.row + 1];
    for (int y = 0; y < size_.height; ++y) row_begin_[y + 1] += row_begin_[y];
  }

  /// Adds up, over the left and right borders of each region, how sharp the frame is there and how sharp the scene.
  void find_ghosts(const FramePlanes& planes) {
    constexpr int kAcross = 3;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      const PixelRun& run = runs_[i];
      if (run.end - run.begin < 2 * kAcross) continue;
      const auto* pixels = planes.luma.ptr<std::uint8_t>(run.row);
      const std::int16_t* means = luma_.mean(run.row);
      Border& ghost = borders_[region_[i]];
      const auto add = [&](int inside, int outside) {
        if (outside < 0 || outside >= size_.width) return;
        ghost.frame += std::abs(pixels[inside] - pixels[outside]);
        ghost.scene += std::abs(means[inside] - means[outside]) / 128.0;
        ++ghost.count;
      };
      add(run.begin + kAcross - 1, run.begin - kAcross);
      add(run.end - kAcross, run.end - 1 + kAcross);
    }
  }

  struct Border {
    double frame = 0, scene = 0;
    int count = 0;
    bool is_ghost() const { return count >= 8 && scene > 2 * frame + 4 * count; }
    bool is_thing() const { return frame > 1.3 * scene; }
  };

  bool is_known(int row, int column, std::uint8_t pixel) const {
    return seen_.at<std::uint8_t>(row, column) >= kEstablished &&
           std::abs(pixel - second_.at<std::uint8_t>(row, column)) <= kSecondWidth;
  }

  void draw_mask(const FramePlanes& planes) {
    for (const PixelRun& run : drawn_)
      std::fill_n(mask_.ptr<std::uint8_t>(run.row) + run.begin, run.end - run.begin, std::uint8_t{0});
    if (options_.suppress_shadows) shadows_.judge(runs_, planes, {luma_, cb_, cr_, black_});
    for (const PixelRun& run : runs_) {
      const auto* pixels = planes.luma.ptr<std::uint8_t>(run.row);
      const std::int16_t* means = luma_.mean(run.row);
      auto* mask = mask_.ptr<std::uint8_t>(run.row);
      for (int x = run.begin; x < run.end; ++x) {
        const int scene = ((means[x] + 64) >> 7) - black_;
        const bool shadow = options_.suppress_shadows && shadows_.is_shadow(run.row, x, pixels[x] - black_, scene);
        mask[x] = shadow || is_known(run.row, x, pixels[x]) ? 0 : 255;
      }
    }
    drawn_ = runs_;
  }

  /// After most of the picture did not fit the scene for a while.
  bool start_anew_if_lost(const FramePlanes& planes) {
    lost_s_ = marked_.pixels > kTooMuch * size_.area() ? lost_s_ + step_s_ : 0;
    if (lost_s_ < kStartAnew_s) return false;
    begin(planes);
    return true;
  }

  // ---- learn -------------------------------------------------------------------------------------------------------------

  void learn(const FramePlanes& planes, std::span<const Box> held) {
    const double turn_s = mean_step_s_ * kTurns;
    const int shift = shift_of(std::min(options_.memory_s, std::max(age_s_, 1.0)), turn_s);
    const double tick_s = options_.absorb_after_s / kEstablished;
    const int ticks = static_cast<int>(age_s_ / tick_s) - static_cast<int>(std::max(0.0, age_s_ - turn_s) / tick_s);
    const int turn = static_cast<int>(frames_ % kTurns);
    for (int first = turn * kRowsATurn; first < size_.height; first += kTurns * kRowsATurn) {
      const int last = std::min(first + kRowsATurn, size_.height);
      for (int y = first; y < last; ++y) count_still(planes, held, y, ticks);
      luma_.learn(planes.luma, first, last, shift, [&](int y) { return freeze(held, y, y, frozen_); });
      if (!colour_) continue;
      const int half_last = std::min(last / 2 + (last == size_.height ? last % 2 : 0), planes.cb.rows);
      const auto half_frozen = [&](int y) {
        const std::uint8_t* full = freeze(held, 2 * y, std::min(2 * y + 1, size_.height - 1), frozen_);
        for (int x = 0; x < planes.cb.cols; ++x) half_frozen_[x] = full[2 * x] | full[2 * x + 1];
        return half_frozen_.data();
      };
      cb_.learn(planes.cb, first / 2, half_last, shift, half_frozen);
      cr_.learn(planes.cr, first / 2, half_last, shift, half_frozen);
    }
  }

  /// Marks the pixels of rows [top, bottom] that must not be learned: regions with their rims, and held boxes.
  const std::uint8_t* freeze(std::span<const Box> held, int top, int bottom, std::vector<std::uint8_t>& row) const {
    std::fill(row.begin(), row.end(), std::uint8_t{0});
    const int above = std::max(0, top - kFringe);
    const int below = std::min(size_.height, bottom + kFringe + 1);
    for (std::size_t i = row_begin_[above]; i < row_begin_[below]; ++i) {
      const int begin = std::max(0, runs_[i].begin - kFringe);
      const int end = std::min(size_.width, runs_[i].end + kFringe);
      std::fill(row.begin() + begin, row.begin() + end, std::uint8_t{1});
    }
    mark_held(held, top, bottom, row);
    return row.data();
  }

  void mark_held(std::span<const Box> held, int top, int bottom, std::vector<std::uint8_t>& row) const {
    for (const Box& box : held) {
      if (box.top > bottom || box.bottom() <= top) continue;
      const int begin = static_cast<int>(std::clamp(std::floor(box.left), 0.0, static_cast<double>(size_.width)));
      const int end = static_cast<int>(std::clamp(std::ceil(box.right()), 0.0, static_cast<double>(size_.width)));
      if (begin < end) std::fill(row.begin() + begin, row.begin() + end, std::uint8_t{1});
    }
  }

  /// Counts, for the foreground pixels of a row, how long they have looked the same; what has for long enough becomes scene.
  void count_still(const FramePlanes& planes, std::span<const Box> held, int y, int ticks) {
    forget(y, ticks);
    if (row_begin_[y] == row_begin_[y + 1]) return;
    std::fill(held_row_.begin(), held_row_.end(), std::uint8_t{0});
    mark_held(held, y, y, held_row_);
    const double tick_s = options_.absorb_after_s / kEstablished;
    const int enough = std::min(kEstablished, static_cast<int>(std::ceil(std::max(2.0, age_s_ / 2) / tick_s)));
    const int ghost_enough = std::max(2, static_cast<int>(std::lround(kGhost_s / tick_s)));
    const auto* pixels = planes.luma.ptr<std::uint8_t>(y);
    auto* second = second_.ptr<std::uint8_t>(y);
    auto* seen = seen_.ptr<std::uint8_t>(y);
    for (std::size_t i = row_begin_[y]; i < row_begin_[y + 1]; ++i) {
      const bool ghost = borders_[region_[i]].is_ghost();
      const bool thing = borders_[region_[i]].is_thing();
      for (int x = runs_[i].begin; x < runs_[i].end; ++x) {
        if (held_row_[x] != 0 && !ghost) continue;
        const int distance = pixels[x] - second[x];
        if (seen[x] == 0 || (std::abs(distance) > kSecondWidth && seen[x] <= 2 * ticks)) {
          second[x] = static_cast<std::uint8_t>(pixels[x] & ~kAway);
          seen[x] = 1;
          continue;
        }
        if (std::abs(distance) > kSecondWidth) {
          seen[x] = static_cast<std::uint8_t>(seen[x] - 2 * ticks);
          continue;
        }
        const bool returns = (second[x] & kAway) != 0;
        if (returns) luma_.widen(y, x, kReturnWidens);
        const int gained = returns ? std::max(ticks, kReturn) : ticks;
        second[x] = static_cast<std::uint8_t>((second[x] + (distance > 1 ? 2 : distance < -1 ? -2 : 0)) & ~kAway);
        seen[x] = static_cast<std::uint8_t>(std::min(254, seen[x] + gained));
        if (ghost && seen[x] >= ghost_enough) {
          take_for_scene(planes, y, x);
          seen[x] = 0;
        } else if (seen[x] >= (thing ? kEstablished : enough)) {
          take_for_scene(planes, y, x);
        }
      }
    }
  }

  /// Where a row shows the scene, what was seen in front of it fades, and is noted (in the level's last bit) to be away.
  void forget(int y, int ticks) {
    auto* second = second_.ptr<std::uint8_t>(y);
    auto* seen = seen_.ptr<std::uint8_t>(y);
    const int fading = (ticks + 1) / 2;
    int x = 0;
    const auto fade_to = [&](int end) {
      for (; x < end; ++x) {
        second[x] = static_cast<std::uint8_t>(second[x] | kAway);
        seen[x] = static_cast<std::uint8_t>(seen[x] > fading ? seen[x] - fading : 0);
      }
    };
    for (std::size_t i = row_begin_[y]; i < row_begin_[y + 1]; ++i) {
      fade_to(runs_[i].begin);
      x = runs_[i].end;
    }
    fade_to(size_.width);
  }

  /// Changes the pixel's two means; its chroma is taken from the frame.
  void take_for_scene(const FramePlanes& planes, int y, int x) {
    const std::uint8_t old = luma_.level(y, x);
    luma_.believe(y, x, planes.luma.at<std::uint8_t>(y, x));
    second_.at<std::uint8_t>(y, x) = old;
    if (!colour_) return;
    cb_.believe(y / 2, x / 2, planes.cb.at<std::uint8_t>(y / 2, x / 2));
    cr_.believe(y / 2, x / 2, planes.cr.at<std::uint8_t>(y / 2, x / 2));
  }

  AdaptiveOptions options_;
  const BackgroundKernels& kernels_ = background_kernels();
  int black_ = 0;
  cv::Size size_;
  bool colour_ = false;

  ScenePlane luma_{scaled(kLumaFloor), scaled(kGate)};
  ScenePlane cb_{scaled(kChromaFloor), scaled(kGate)};
  ScenePlane cr_{scaled(kChromaFloor), scaled(kGate)};
  cv::Mat second_;  ///< CV_8UC1: the level seen at a pixel while it was foreground, or scene before
  cv::Mat seen_;    ///< CV_8UC1: for how long, in ticks of absorb_after_s / kEstablished
  LightMeter meter_;
  ShadowFinder shadows_;

  std::optional<Timestamp> last_time_;
  double step_s_ = 0, mean_step_s_ = 0, age_s_ = 0, lost_s_ = 0;
  double usual_share_ = 0;
  std::int64_t frames_ = 0;

  // Room for one frame's work.
  std::array<std::vector<std::uint8_t>, 3> marks_;
  std::vector<std::uint8_t> chroma_mark_, vote_, frozen_, half_frozen_, held_row_;
  Marked marked_;
  Forest forest_;
  std::vector<int> areas_, strongs_, numbers_;
  std::vector<PixelRun> runs_, drawn_;  ///< of the regions chosen, in order; of the frame before
  std::vector<int> region_;             ///< of each run
  std::vector<Border> borders_;         ///< of each region
  std::vector<std::size_t> row_begin_;  ///< the first run of each row
  cv::Mat mask_;

  int scaled(int threshold) const { return std::clamp(static_cast<int>(std::lround(threshold / options_.sensitivity)), 1, 64); }
};

}  // namespace

std::unique_ptr<Background> make_adaptive(const AdaptiveOptions& options) {
  return std::make_unique<AdaptiveBackground>(options);
}

}  // namespace marey
