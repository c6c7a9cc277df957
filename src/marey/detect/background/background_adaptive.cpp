// Marey's own model of the empty scene.
//
// Each pixel has a mean and the spread of its noise, and from them a band of levels that belong to the scene; chroma has the same
// at half size. A frame is compared with the bands, a pixel stands by the vote of its 3 × 3 round, and a connected region counts
// where parts of it lie far outside the bands (hysteresis). What is then explained by a cast shadow, or by the observations at the
// pixel for long before, is taken out. Means follow background pixels by a recursive average, spreads by sigma-delta steps towards
// a quantile.
//
// - A shaking camera is followed by whole pixels: the frame is brought back to the scene's places, and its mask carried over
//   (background_sway.cpp).
// - Images that it learns ahead from are brought into one light and to one place first (background_even.cpp).
// - A change of light rescales the means at once, all together or part by part (background_light.cpp, background_patches.cpp).
// - A thing that stands still is counted, pixel by pixel, in a second mean; only after `absorb_after_s`, or at the start after
//   half the time that the model knows, or twice the time that the scene was seen there (where nothing was seen ahead), do the two
//   change places (background_second.cpp). Pixels in `held` boxes are not counted and not learned.
// - A model that saw nothing ahead keeps images of its first minute and corrects by them, after 0.4 s and each time that has
//   doubled (background_samples.h): what moves about where a scene was taken for still, and what has left since the first image.
// - A ghost, where something of the first frames has left, is a region whose border is an edge in the scene but not in the
//   frame (background_regions.h); it is trusted to be scene after a second.
// - Where most of an image does not fit the scene for seconds (the camera was moved), the model begins again.
//
// Cost: about five bytes read a pixel and frame; a frame teaches one eighth of the rows, in phase. All else grows with what moves.
// References: Stauffer & Grimson 1999 (modes that change places); Manzanera & Richefeu 2007 (sigma-delta); Cucchiara et al. 2003
// (ghosts and shadows); Barnich & Van Droogenbroeck, ViBe, 2011 (a pixel may appear as its neighbours do).
#include "marey/detect/background/background_adaptive.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "marey/core/image.h"
#include "marey/detect/background/background_even.h"
#include "marey/detect/background/background_fringe.h"
#include "marey/detect/background/background_frozen.h"
#include "marey/detect/background/background_light.h"
#include "marey/detect/background/background_marks.h"
#include "marey/detect/background/background_patches.h"
#include "marey/detect/background/background_plane.h"
#include "marey/detect/background/background_regions.h"
#include "marey/detect/background/background_returning.h"
#include "marey/detect/background/background_samples.h"
#include "marey/detect/background/background_second.h"
#include "marey/detect/background/background_shadow.h"
#include "marey/detect/background/background_sway.h"
#include "marey/detect/silhouette.h"

namespace marey::detect::background {
namespace {

constexpr int kLumaFloor = 8;    // levels: the narrowest band's half width
constexpr int kChromaFloor = 6;  // levels
constexpr int kGate = 56;        // 3.5 spreads of 1.15 σ: 4 σ
constexpr int kPhases = 8;       // frames until each row was taught once
constexpr int kRowsPerPhase = 16;
constexpr int kPatchRotations = 4;     // frames between two searches for parts in another light, while none exist
constexpr double kPatchMarks = 0.005;  // of the image: with fewer pixels outside the bands none exist
constexpr double kRestart_s = 2;
constexpr double kTooMuch = 0.6;  // of the image

int shift_of(double time_constant, double step) {
  return std::clamp(static_cast<int>(std::lround(std::log2(std::max(time_constant / step, 1.0)))), 1, 7);
}

class AdaptiveBackground final : public Background {
 public:
  explicit AdaptiveBackground(const AdaptiveOptions& options) : options_(options), second_(options.absorb_after_s) {}

  void prime(std::span<const Frame> samples) override {
    std::vector<FramePlanes> kept;
    for (const Frame& sample : samples) {
      if (sample.image.empty() || (!kept.empty() && sample.image.size() != kept.front().luma.size())) continue;
      const FramePlanes planes = planes_of(sample.image);
      if (!kept.empty() && planes.cb.empty() != kept.front().cb.empty()) continue;
      kept.push_back(planes);
      black_ = black_of(sample.image);
    }
    if (kept.empty()) return;
    if (auto evened = evened_out(kept, black_)) kept = *std::move(evened);
    begin(kept);
    age_s_ = std::max(0.0, seconds(samples.back().time - samples.front().time));
  }

  Foreground apply(const Frame& frame, std::span<const Box> held) override {
    FramePlanes planes = planes_of(frame.image);
    black_ = black_of(frame.image);
    if (planes.luma.empty()) return {};
    if (planes.luma.size() != size_ || planes.cb.empty() == colour_) begin(planes);
    keep_time(frame.time);
    shift_ = sway_.measure(planes.luma, luma_);
    if (shift_ == cv::Point()) return apply(planes, held);
    planes = brought_back(planes, shift_, luma_, cb_, cr_);
    std::vector<Box> there(held.begin(), held.end());
    for (Box& box : there) box.left -= shift_.x, box.top -= shift_.y;
    const Foreground detected = apply(planes, there);
    carry_over(detected.mask, shift_, carried_mask_);
    carry_over(detected.covered, shift_, carried_covered_);
    return {carried_mask_, carried_covered_};
  }

  Foreground apply(const FramePlanes& planes, std::span<const Box> held) {
    mark(planes);
    if (track_light(planes)) mark(planes);
    if (track_patches(planes)) mark(planes);
    regions_.choose(marked_, size_.height);
    regions_.compare_borders(planes.luma, luma_);
    draw_mask(planes);
    if (restart_if_lost(planes)) return {mask_, covered_};
    learn(planes, held);
    if (samples_.keep(planes, age_s_)) correct(held);
    ++frames_;
    return {mask_, covered_};
  }

  Image scene() const override { return scene({{}, size_}); }

  Image scene(const cv::Rect& part) const override {
    if (size_.empty()) return {};
    if (!colour_) return Image(luma_.image(part));
    const cv::Rect half(part.tl() / 2, cv::Size((part.width + 1) / 2, (part.height + 1) / 2));
    return {luma_.image(part), cb_.image(half), cr_.image(half), black_ > 0 ? Image::Range::limited : Image::Range::full};
  }

  void trust(const Image& image, const cv::Mat& mask, cv::Point corner) override {
    FramePlanes planes = planes_of(image);
    if (planes.luma.size() != size_) return;
    if (shift_ != cv::Point()) planes = brought_back(planes, shift_, luma_, cb_, cr_);
    corner -= shift_;
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        const cv::Point at = corner + cv::Point(x, y);
        if (mask.at<std::uint8_t>(y, x) != 0 && cv::Rect({0, 0}, size_).contains(at)) trust(planes, at.y, at.x);
      }
    }
  }

 private:
  static int black_of(const Image& image) { return image.range() == Image::Range::limited ? 16 : 0; }

  static FramePlanes planes_of(const Image& image) {
    FramePlanes planes{image.luma(), image.cb(), image.cr()};
    if (planes.luma.depth() == CV_16U) {
      cv::Mat eight_bit;
      planes.luma.convertTo(eight_bit, CV_8U, 1.0 / 257.0);
      planes.luma = eight_bit;
    }
    return planes;
  }

  void begin(const std::vector<FramePlanes>& samples) {
    std::vector<cv::Mat> luma, cb, cr;
    for (const FramePlanes& planes : samples) {
      luma.push_back(planes.luma);
      cb.push_back(planes.cb);
      cr.push_back(planes.cr);
    }
    const bool colour = !cb.front().empty();
    luma_.begin(luma);
    if (colour) {
      cb_.begin(cb);
      cr_.begin(cr);
    }
    trust_what_returns(samples, {&luma_, colour ? &cb_ : nullptr, colour ? &cr_ : nullptr});
    make_room(luma.front().size(), colour, true);
  }

  void begin(const FramePlanes& planes) {
    luma_.begin(planes.luma);
    if (!planes.cb.empty()) {
      cb_.begin(planes.cb);
      cr_.begin(planes.cr);
    }
    make_room(planes.luma.size(), !planes.cb.empty(), false);
    samples_.begin();
    age_s_ = 0;
  }

  void make_room(cv::Size size, bool colour, bool learned_ahead) {
    size_ = size;
    colour_ = colour;
    mask_ = cv::Mat::zeros(size, CV_8UC1);
    covered_ = cv::Mat::zeros(size, CV_8UC1);
    second_.begin(size, learned_ahead);
    samples_ = {};
    shadows_.begin(size);
    sway_.begin();
    drawn_.clear();
    const std::size_t padded = static_cast<std::size_t>(size.width) + 4;
    marks_.begin(size);
    frozen_.assign(padded, 0);
    held_row_.assign(padded, 0);
    half_frozen_.assign(padded, 0);
    lost_s_ = 0;
    typical_fraction_ = 0;
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

  void mark(const FramePlanes& planes) { marks_.find(planes, {luma_, cb_, cr_, black_}, marked_); }

  /// Rescales the scene where the light has changed. True where it did.
  bool track_light(const FramePlanes& planes) {
    const double fraction = marked_.pixels / static_cast<double>(size_.area());
    const bool jumped = fraction > typical_fraction_ + 0.03;
    typical_fraction_ += (fraction - typical_fraction_) * 0.1;
    if (!jumped && frames_ % kPhases != 0) return false;
    const std::optional<LightChange> change = meter_.measure(planes.luma, luma_, black_);
    if (!change || !change->explained) return false;
    luma_.scale(change->gains, black_);
    samples_.forget();
    sway_.renew();
    if (colour_) {
      cb_.shift(median_difference(planes.cb, cb_));
      cr_.shift(median_difference(planes.cr, cr_));
    }
    return true;
  }

  /// The same for parts of the image, each by itself.
  bool track_patches(const FramePlanes& planes) {
    const bool appearances = patched_ || frames_ % kPatchRotations == 0;
    if (!appearances || marked_.pixels < kPatchMarks * size_.area()) return patched_ = false;
    const std::optional<cv::Mat> gains = patches_.measure(planes.luma, luma_, black_);
    patched_ = gains.has_value();
    if (!patched_) return false;
    luma_.relight(*gains, black_);
    if (colour_) {
      cb_.relight(*gains, 128);
      cr_.relight(*gains, 128);
    }
    return true;
  }

  // ---- clean -------------------------------------------------------------------------------------------------------------

  void draw_mask(const FramePlanes& planes) {
    for (const PixelRun& run : drawn_) {
      for (cv::Mat* mask : {&mask_, &covered_})
        std::fill_n(mask->ptr<std::uint8_t>(run.row) + run.begin, run.end - run.begin, std::uint8_t{0});
    }
    if (options_.suppress_shadows) shadows_.assess(regions_.runs(), planes, {luma_, cb_, cr_, black_});
    for (const PixelRun& run : regions_.runs()) {
      const auto* pixels = planes.luma.ptr<std::uint8_t>(run.row);
      const std::int16_t* means = luma_.mean(run.row);
      auto* mask = mask_.ptr<std::uint8_t>(run.row);
      for (int x = run.begin; x < run.end; ++x) {
        const int scene = ((means[x] + 64) >> 7) - black_;
        const bool shadow = options_.suppress_shadows && (shadows_.is_shadow(run.row, x, pixels[x] - black_, scene) ||
                                                          has_shadowed_colour(planes, run.row, x, pixels[x] - black_, scene));
        mask[x] = shadow || second_.knows(run.row, x, pixels[x]) ? 0 : 255;
      }
    }
    trim_fringe(mask_, regions_.runs(), planes, {luma_, cb_, cr_, black_}, covered_);
    drawn_ = regions_.runs();
  }

  bool has_shadowed_colour(const FramePlanes& planes, int row, int column, int level, int scene) const {
    if (planes.cb.empty()) return false;
    const int y = row / 2, x = column / 2;
    return ShadowFinder::is_coloured_shadow(level, scene, planes.cb.at<std::uint8_t>(y, x) - 128,
                                            planes.cr.at<std::uint8_t>(y, x) - 128, cb_.level(y, x) - 128, cr_.level(y, x) - 128);
  }

  /// After most of the image did not fit the scene for a while.
  bool restart_if_lost(const FramePlanes& planes) {
    lost_s_ = marked_.pixels > kTooMuch * size_.area() ? lost_s_ + step_s_ : 0;
    if (lost_s_ < kRestart_s) return false;
    begin(planes);
    return true;
  }

  // ---- learn -------------------------------------------------------------------------------------------------------------

  void learn(const FramePlanes& planes, std::span<const Box> held) {
    const double cycle_s = mean_step_s_ * kPhases;
    const int shift = shift_of(std::min(options_.memory_s, std::max(age_s_, 1.0)), cycle_s);
    const int ticks = second_.ticks_between(age_s_ - cycle_s, age_s_);
    const int phase = static_cast<int>(frames_ % kPhases);
    for (int first = phase * kRowsPerPhase; first < size_.height; first += kPhases * kRowsPerPhase) {
      const int last = std::min(first + kRowsPerPhase, size_.height);
      for (int y = first; y < last; ++y) count_still(planes, held, y, ticks);
      luma_.learn(planes.luma, first, last, shift, [&](int y) { return freeze(held, y, y); });
      if (!colour_) continue;
      const int half_last = std::min(last / 2 + (last == size_.height ? last % 2 : 0), planes.cb.rows);
      const auto half_frozen = [&](int y) {
        const std::uint8_t* full = freeze(held, 2 * y, std::min(2 * y + 1, size_.height - 1));
        for (int x = 0; x < planes.cb.cols; ++x) half_frozen_[x] = full[2 * x] | full[2 * x + 1];
        return half_frozen_.data();
      };
      cb_.learn(planes.cb, first / 2, half_last, shift, half_frozen);
      cr_.learn(planes.cr, first / 2, half_last, shift, half_frozen);
    }
  }

  /// By the samples since a model began that learned nothing ahead. People who are known, and what stands out as a thing does,
  /// stay; what else is foreground may have been the scene's all along.
  void correct(std::span<const Box> held) {
    cv::Mat fixed = cv::Mat::zeros(size_, CV_8UC1), flagged = cv::Mat::zeros(size_, CV_8UC1);
    for (std::size_t i = 0; i < regions_.runs().size(); ++i) {
      const PixelRun& run = regions_.runs()[i];
      cv::Mat& marked = regions_.is_thing(i) ? fixed : flagged;
      std::fill_n(marked.ptr<std::uint8_t>(run.row) + run.begin, run.end - run.begin, std::uint8_t{255});
    }
    for (int y = 0; y < size_.height && !held.empty(); ++y) {
      std::fill(held_row_.begin(), held_row_.end(), std::uint8_t{0});
      mark_held(held, y, y, size_.width, held_row_);
      for (int x = 0; x < size_.width; ++x) fixed.at<std::uint8_t>(y, x) |= held_row_[x];
    }
    luma_.correct(samples_.luma(), fixed, flagged);
    if (colour_) {
      const auto halved = [&](const cv::Mat& full) {
        cv::Mat half = cv::Mat::zeros(samples_.cb().front().size(), CV_8UC1);
        for (int y = 0; y < size_.height; ++y) {
          for (int x = 0; x < size_.width; ++x) half.at<std::uint8_t>(y / 2, x / 2) |= full.at<std::uint8_t>(y, x);
        }
        return half;
      };
      const cv::Mat half_fixed = halved(fixed), half_doubted = halved(flagged);
      cb_.correct(samples_.cb(), half_fixed, half_doubted);
      cr_.correct(samples_.cr(), half_fixed, half_doubted);
    }
    samples_.thin();
  }

  const std::uint8_t* freeze(std::span<const Box> held, int top, int bottom) {
    mark_frozen(regions_, held, top, bottom, size_, frozen_);
    return frozen_.data();
  }

  /// What has stood still for long enough becomes scene; its chroma is taken from the frame.
  void count_still(const FramePlanes& planes, std::span<const Box> held, int y, int ticks) {
    second_.forget(y, ticks, regions_);
    if (regions_.begin_of(y) == regions_.begin_of(y + 1)) return;
    std::fill(held_row_.begin(), held_row_.end(), std::uint8_t{0});
    mark_held(held, y, y, size_.width, held_row_);
    const auto* pixels = planes.luma.ptr<std::uint8_t>(y);
    second_.count(y, pixels, held_row_.data(), regions_, ticks, age_s_, luma_, taken_);
    for (const int x : taken_) trust(planes, y, x);
  }

  void trust(const FramePlanes& planes, int y, int x) {
    luma_.trust(y, x, planes.luma.at<std::uint8_t>(y, x));
    if (!colour_) return;
    cb_.trust(y / 2, x / 2, planes.cb.at<std::uint8_t>(y / 2, x / 2));
    cr_.trust(y / 2, x / 2, planes.cr.at<std::uint8_t>(y / 2, x / 2));
  }

  AdaptiveOptions options_;
  int black_ = 0;
  cv::Size size_;
  bool colour_ = false;

  ScenePlane luma_{scaled(kLumaFloor), scaled(kGate)};
  ScenePlane cb_{scaled(kChromaFloor), scaled(kGate)};
  ScenePlane cr_{scaled(kChromaFloor), scaled(kGate)};
  SecondScene second_;
  SceneSamples samples_;
  LightMeter meter_;
  LightPatches patches_;
  bool patched_ = false;  ///< the light of a part changed in the last frame
  ShadowFinder shadows_;
  SwayMeter sway_;
  cv::Point shift_;
  cv::Mat carried_mask_, carried_covered_;

  std::optional<Timestamp> last_time_;
  double step_s_ = 0, mean_step_s_ = 0, age_s_ = 0, lost_s_ = 0;
  double typical_fraction_ = 0;
  std::int64_t frames_ = 0;

  // Room for one frame's work.
  BandMarks marks_;
  std::vector<std::uint8_t> frozen_, half_frozen_, held_row_;
  MarkedRuns marked_;
  ForegroundRegions regions_;
  std::vector<PixelRun> drawn_;  ///< into the mask, for the frame before
  std::vector<int> taken_;
  cv::Mat mask_, covered_;

  int scaled(int threshold) const { return std::clamp(static_cast<int>(std::lround(threshold / options_.sensitivity)), 1, 64); }
};

}  // namespace

std::unique_ptr<Background> make_adaptive(const AdaptiveOptions& options) {
  return std::make_unique<AdaptiveBackground>(options);
}

}  // namespace marey::detect::background
