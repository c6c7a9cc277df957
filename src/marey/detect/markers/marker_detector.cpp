// Markers in one frame: search what stands out, sort out what no marker is, fit each of the rest, learn what markers are like from
// those that are plainly discs, and explain the others: several that touch, one in motion, or something else. The steps are in
// files of their own: marker_search with marker_levels, marker_clutter, marker_contrast and marker_runs; marker_fit, marker_split,
// marker_likeness. The number of runs, of blobs fitted and the size of each are bounded, so that glare or a white frame costs
// bounded time and memory.
#include "marey/detect/markers/marker_detector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/detect/markers/marker_fit.h"
#include "marey/detect/markers/marker_likeness.h"
#include "marey/detect/markers/marker_neighbours.h"
#include "marey/detect/markers/marker_search.h"
#include "marey/detect/markers/marker_split.h"

namespace marey::detect::markers {
namespace {

constexpr int kMaxSplitPixels = 20000;  // a frame: about 200 small pairs
constexpr std::size_t kBlobsATask =
    64;  // numerical, time alone: a quarter of a millisecond of fitting: a frame of few markers is one task
constexpr std::size_t kSplitsATask = 8;   // unswept, as the one above
constexpr double kShapeMisfit = 0.06;     // of the contrast: what a lone round marker leaves at most
constexpr double kOfRoundness = 0.6;      // a blob this much less round is not even split: it bounds a window by its blob's area
constexpr double kLessReport = 0.1;       // of a disc's, about how large markers are
constexpr double kColourDeviation = 0.5;  // px; where chroma lies within its four pixels is not known for certain
constexpr double kMinLumaContrast = 8;    // noises, for the centre of a coloured marker

bool inside(const Box& box, double x, double y) {
  return x >= box.left - 0.5 && y >= box.top - 0.5 && x < box.right() - 0.5 && y < box.bottom() - 0.5;
}

/// Of the ellipse of a blob's instants, px.
double half_width_of(const MarkerBlob& blob) {
  const double mean = (blob.var_x + blob.var_y) / 2, spread = std::hypot((blob.var_x - blob.var_y) / 2, blob.cov_xy);
  return 2 * std::sqrt(std::max(mean - spread, 1.0 / 12));
}

Box box_of(const cv::Rect& box) {
  return {static_cast<double>(box.x), static_cast<double>(box.y), static_cast<double>(box.width), static_cast<double>(box.height)};
}

/// One thread's room for a blob at a time.
struct MarkerWorkspace {
  std::vector<MarkerNeighbour> near;
  MarkerWindow window;
};

/// Calls `each(i, workspace)` for i in [0, count), in tasks of `grain`.
template <typename Each>
void for_blobs(std::size_t count, std::size_t grain, Each&& each) {
  if (count == 0) return;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
    MarkerWorkspace workspace;
    for (std::size_t i = range.begin(); i < range.end(); ++i) each(i, workspace);
  });
}

std::size_t expected_in(const cv::Rect& box, std::span<const Expected> expected) {
  return static_cast<std::size_t>(std::count_if(expected.begin(), expected.end(), [&](const Expected& e) {
    return box.contains({static_cast<int>(std::lround(e.box.centre().x())), static_cast<int>(std::lround(e.box.centre().y()))});
  }));
}

}  // namespace

class MarkerDetector::Impl {
 public:
  explicit Impl(const MarkerOptions& options) : options_(options), search_(options), likeness_(options.widest) {}

  void prime(std::span<const Frame> samples) { search_.prime(samples); }
  Detections detect(const Frame& frame, std::span<const Expected> expected);

  MarkerCounts counts_;
  const MarkerLevels& levels() const { return search_.levels(); }
  std::optional<std::vector<cv::Rect>> learned_parts() const { return search_.learned_parts(); }

 private:
  /// A blob as one disc.
  struct Lone {
    std::size_t blob = 0;
    MarkerShape shape;
    bool has_halo = false;
    bool is_lamp = false;  ///< it has one, and is larger than the markers
    bool is_disc = false;  ///< it is one, as sharp as the others
    int pixels = 0;        ///< of its window
  };
  /// What a blob is that is not a lone disc.
  struct Explained {
    std::vector<MarkerShape> shapes;
    std::int64_t MarkerCounts::* counted = nullptr;  ///< where what it is adds one
  };

  void choose(std::span<const MarkerBlob> blobs);
  void keep_max(std::span<const MarkerBlob> blobs, std::span<const Expected> expected);
  MarkerSurroundings surroundings(const cv::Mat& luma, const MarkerBlob& blob, std::size_t index) const;
  Lone fit_lone(const cv::Mat& luma, std::span<const MarkerBlob> blobs, std::size_t index, MarkerWorkspace& workspace) const;
  void fit_all(const cv::Mat& luma, std::span<const MarkerBlob> blobs);
  void explain_all(const cv::Mat& luma, std::span<const MarkerBlob> blobs, std::span<const Expected> expected);
  Explained explain(const cv::Mat& luma, std::span<const MarkerBlob> blobs, const Lone& lone, std::span<const Expected> expected,
                    bool may_split, MarkerWorkspace& workspace) const;
  Detection report(const MarkerShape& shape, const MarkerBlob& blob);

  MarkerOptions options_;
  MarkerSearch search_;
  MarkerLikeness likeness_;
  std::vector<std::size_t> chosen_;
  MarkerNeighbours neighbours_;
  std::vector<Lone> lone_;
  std::vector<std::size_t> unclear_;  // of the lone ones, those that are to be explained, and
  std::vector<char> may_split_;       // of each whether there is time to split it
  std::vector<Explained> explained_;  // likewise
  std::vector<MarkerLikeness::Witness> detected_;
  bool moving_ = false;  // most markers of the frame are not discs
};

Detections MarkerDetector::Impl::detect(const Frame& frame, std::span<const Expected> expected) {
  Detections result;
  ++counts_.frames;
  if (frame.image.empty()) return result;
  const cv::Mat& luma = frame.image.luma();
  const auto blobs = search_.find(frame, likeness_.widest());
  if (search_.was_cut()) ++counts_.frames_cut;
  counts_.masked_fraction = search_.masked_fraction();
  choose(blobs);
  keep_max(blobs, expected);
  neighbours_.file(blobs, chosen_, luma.size());
  fit_all(luma, blobs);
  explain_all(luma, blobs, expected);
  result.detections.reserve(chosen_.size());
  std::size_t next = 0;
  for (const Lone& lone : lone_) {
    const MarkerBlob& blob = blobs[lone.blob];
    if (lone.is_disc) {
      result.detections.push_back(report(lone.shape, blob));
      continue;
    }
    const Explained& explained = explained_[next++];
    if (explained.counted != nullptr) ++(counts_.*explained.counted);
    for (const MarkerShape& shape : explained.shapes) result.detections.push_back(report(shape, blob));
  }
  counts_.markers += std::ssize(result.detections);
  return result;
}

void MarkerDetector::Impl::choose(std::span<const MarkerBlob> blobs) {
  chosen_.clear();
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    const auto area = static_cast<double>(blobs[i].area);
    if (area < options_.min_area) {
      ++counts_.too_small;
    } else if (area > options_.max_area) {
      ++counts_.too_large;
    } else if (roundness_of(blobs[i]) < kOfRoundness * options_.min_roundness) {
      ++counts_.not_round;
    } else if (!search_.stands_out(i)) {
      ++counts_.faint;
    } else if (likeness_.too_large(area) && roundness_of(blobs[i]) < kOfRoundness) {
      ++counts_.unlike;
    } else {
      chosen_.push_back(i);
    }
  }
}

/// Those where the tracker expects a marker, then the largest.
void MarkerDetector::Impl::keep_max(std::span<const MarkerBlob> blobs, std::span<const Expected> expected) {
  const auto maximum = static_cast<std::size_t>(options_.max_markers);
  if (chosen_.size() <= maximum) return;
  counts_.over_limit += static_cast<std::int64_t>(chosen_.size() - maximum);
  const auto required = [&](std::size_t i) {
    return std::any_of(expected.begin(), expected.end(),
                       [&](const Expected& e) { return inside(e.box, blobs[i].mean_x, blobs[i].mean_y); });
  };
  std::vector<std::tuple<bool, std::int64_t, std::size_t>> order;  // what sorts first stays
  order.reserve(chosen_.size());
  for (const std::size_t i : chosen_) order.emplace_back(!required(i), -blobs[i].area, i);
  std::sort(order.begin(), order.end());
  std::transform(order.begin(), order.end(), chosen_.begin(), [](const auto& entry) { return std::get<2>(entry); });
  chosen_.resize(maximum);
  std::sort(chosen_.begin(), chosen_.end());
}

MarkerSurroundings MarkerDetector::Impl::surroundings(const cv::Mat& luma, const MarkerBlob& blob, std::size_t index) const {
  MarkerSurroundings around;
  around.background = search_.around(luma, index);
  around.noise = search_.levels().noise();
  around.white = search_.levels().white();
  around.dark = options_.dark;
  around.blur = likeness_.blur();
  // A coloured marker may be brighter or darker than what is around it.
  if (options_.colour) around.dark = cv::mean(luma(blob.box & cv::Rect({}, luma.size())))[0] < around.background;
  return around;
}

MarkerDetector::Impl::Lone MarkerDetector::Impl::fit_lone(const cv::Mat& luma, std::span<const MarkerBlob> blobs, std::size_t index,
                                                          MarkerWorkspace& workspace) const {
  const MarkerBlob& blob = blobs[index];
  auto& [near, window] = workspace;
  const MarkerSurroundings around = surroundings(luma, blob, index);
  neighbours_.find(blobs, index, near);
  collect_window(luma, blob, around, near, window);
  Lone lone{.blob = index, .shape = fit_disc(window, blob, around), .pixels = window.count};
  MarkerShape& shape = lone.shape;
  if (options_.colour &&
      (!shape.fitted || shape.contrast < kMinLumaContrast * around.noise)) {  // luma does not show it: chroma does
    shape.fitted = false;
    shape.centre = {blob.mean_x, blob.mean_y};
    shape.covariance = Matrix<2>::Identity() * (kColourDeviation * kColourDeviation);
  }
  const double grain = 3 * around.noise / window.scale;
  lone.has_halo = search_.has_halo(index);
  lone.is_disc = shape.fitted && shape.misfit <= std::max(kShapeMisfit, grain) && roundness_of(blob) >= options_.min_roundness;
  return lone;
}

void MarkerDetector::Impl::fit_all(const cv::Mat& luma, std::span<const MarkerBlob> blobs) {
  lone_.resize(chosen_.size());
  for_blobs(chosen_.size(), kBlobsATask,
            [&](std::size_t i, MarkerWorkspace& workspace) { lone_[i] = fit_lone(luma, blobs, chosen_[i], workspace); });
  detected_.clear();
  for (const Lone& lone : lone_) {
    const std::size_t index = lone.blob;
    if (lone.has_halo) continue;
    const double announce = report_of(lone.shape.contrast, static_cast<double>(blobs[index].area));
    if (lone.is_disc) {
      detected_.push_back({lone.shape.radius, lone.shape.blur, announce, lone.shape.contrast, true});
    } else {  // what moves, or touches another, says by its width how large it is
      const bool round = roundness_of(blobs[index]) > kOfRoundness;
      detected_.push_back({half_width_of(blobs[index]), std::nullopt, kLessReport * announce, lone.shape.contrast, round});
    }
  }
  likeness_.learn(detected_);
  const auto discs = std::count_if(lone_.begin(), lone_.end(), [](const Lone& lone) { return lone.is_disc; });
  moving_ = 2 * discs < std::ssize(lone_);
  for (Lone& lone : lone_) {
    const double radius = lone.is_disc ? lone.shape.radius : half_width_of(blobs[lone.blob]);
    lone.is_lamp = lone.has_halo && likeness_.lamp(radius);
    lone.is_disc = lone.is_disc && !lone.is_lamp && likeness_.sharp(lone.shape.blur);
  }
}

/// Which are split is settled ahead, in their order: a frame has time for this many pixels.
void MarkerDetector::Impl::explain_all(const cv::Mat& luma, std::span<const MarkerBlob> blobs, std::span<const Expected> expected) {
  unclear_.clear();
  may_split_.clear();
  int left = kMaxSplitPixels;
  for (std::size_t i = 0; i < lone_.size(); ++i) {
    const Lone& lone = lone_[i];
    if (lone.is_disc) continue;
    const MarkerBlob& blob = blobs[lone.blob];
    const bool known = lone.is_lamp || likeness_.too_large(static_cast<double>(blob.area));
    const bool splits = !known && blob.area >= 8 && lone.pixels <= left;
    if (splits) left -= lone.pixels;
    unclear_.push_back(i);
    may_split_.push_back(splits ? 1 : 0);
  }
  explained_.resize(unclear_.size());
  for_blobs(unclear_.size(), kSplitsATask, [&](std::size_t i, MarkerWorkspace& workspace) {
    explained_[i] = explain(luma, blobs, lone_[unclear_[i]], expected, may_split_[i] != 0, workspace);
  });
}

/// What a blob is that is not a disc: several, or one all the same, or none.
MarkerDetector::Impl::Explained MarkerDetector::Impl::explain(const cv::Mat& luma, std::span<const MarkerBlob> blobs,
                                                              const Lone& lone, std::span<const Expected> expected, bool may_split,
                                                              MarkerWorkspace& workspace) const {
  const MarkerBlob& blob = blobs[lone.blob];
  const auto area = static_cast<double>(blob.area);
  if (lone.is_lamp || likeness_.too_large(area)) return {{}, &MarkerCounts::unlike};
  bool reported = false;
  if (may_split) {
    auto& [near, window] = workspace;
    const MarkerSurroundings around = surroundings(luma, blob, lone.blob);
    neighbours_.find(blobs, lone.blob, near);
    collect_window(luma, blob, around, near, window);
    MarkerSplit split = split_markers(window, blob, around, expected_in(blob.box, expected), moving_);
    const std::size_t count = split.discs.size();
    const bool alike =
        std::all_of(split.discs.begin(), split.discs.end(), [&](const MarkerShape& d) { return likeness_.fits(d.radius, count); });
    if (!split.discs.empty() && alike) return {std::move(split.discs), &MarkerCounts::split};
    reported = split.swept && likeness_.fits(split.swept->radius);
  }
  if (roundness_of(blob) < options_.min_roundness) return {{}, &MarkerCounts::not_round};
  if (!reported && likeness_.odd(area)) return {{}, &MarkerCounts::unlike};
  return {{lone.shape}, lone.shape.fitted ? nullptr : &MarkerCounts::not_fitted};
}

Detection MarkerDetector::Impl::report(const MarkerShape& shape, const MarkerBlob& blob) {
  Detection detection;
  detection.centre = shape.centre;
  detection.covariance = shape.covariance;
  detection.area = shape.fitted ? std::numbers::pi * shape.radius * shape.radius : static_cast<double>(blob.area);
  detection.box = shape.part ? Box::from_centre(shape.centre, 2 * shape.radius + 1, 2 * shape.radius + 1) : box_of(blob.box);
  if (!options_.automatic()) return detection;
  detection.score = std::clamp(shape.contrast / (2 * search_.min_contrast(blob)), 0.1, 1.0);
  return detection;
}

MarkerDetector::MarkerDetector(const MarkerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
MarkerDetector::~MarkerDetector() = default;

void MarkerDetector::prime(std::span<const Frame> samples) {
  impl_->prime(samples);
}

void MarkerDetector::change(const MarkerOptions& options) {
  auto other = std::make_unique<Impl>(options);
  other->counts_ = impl_->counts_;
  impl_ = std::move(other);
}

std::optional<std::vector<cv::Rect>> MarkerDetector::learned_parts() const {
  return impl_->learned_parts();
}

Detections MarkerDetector::detect(const Frame& frame, std::span<const Expected> expected) {
  return impl_->detect(frame, expected);
}

DetectionCounts MarkerDetector::detection_counts() const {
  const MarkerCounts& all = counts();
  return {all.too_small, all.too_large + all.not_round + all.unlike};
}

const MarkerCounts& MarkerDetector::counts() const {
  return impl_->counts_;
}

double MarkerDetector::typical_threshold() const {
  return impl_->levels().typical_min_contrast();
}

double MarkerDetector::noise() const {
  return impl_->levels().noise();
}

std::vector<std::string> warnings(const MarkerCounts& counts) {
  std::vector<std::string> result;
  if (counts.over_limit > 0) {
    result.push_back(
        fmt::format("{} blobs beyond the most markers allowed a frame were omitted: is there glare? A mask or a higher "
                    "threshold helps",
                    counts.over_limit));
  }
  if (counts.frames_cut > 0) {
    result.push_back(
        fmt::format("{} of {} frames had too much above the threshold to be searched to the bottom; a higher threshold helps",
                    counts.frames_cut, counts.frames));
  }
  if (counts.unlike > 0) {
    result.push_back(
        fmt::format("{} bright spots unlike the markers were omitted: neither discs nor several that touch nor in motion, "
                    "and larger; where they are markers, say how wide those are with --max-width",
                    counts.unlike));
  }
  if (counts.frames > 0 && counts.markers == 0) result.push_back("no marker was seen in any frame");
  return result;
}

}  // namespace marey::detect::markers
