#include "marey/source/stabilise/view_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "marey/geometry/median.h"

namespace marey::source::stabilise {
namespace {

constexpr int kAcross = 256, kThumbAcross = 32;  // px
constexpr double kEvery_s = 0.3;
constexpr int kCellsAcross = 14, kCellsDown = 10;  // one corner of each
constexpr int kMinCornerCount = 12;
constexpr float kCornerQuality = 0.003F;  // of the best corner
constexpr int kFlowWindow = 13, kFlowLevels = 3;
constexpr double kAgree = 0.5;                   // px
constexpr double kFractionTracked = 0.4;         // of the corners that were followed, which agree where the motion is known
constexpr double kMuchThere = 0.7;               // of all corners
constexpr double kFractionOfAll = 0.25;          // of all corners
constexpr double kSpread = 0.06;                 // of the image's height, standard deviation
constexpr double kCutChange = 0.12;              // 1 - correlation of two thumbnails
constexpr double kCutStandsOut = 4;              // times the typical change
constexpr double kCutMore = 1.2, kCutAlone = 2;  // times the change before; after
constexpr double kBlack = 24, kWhite = 232;      // levels: what is empty and so dark, or so bright, is in any scene
constexpr double kStillShownOfAll = 0.3;         // of the other cells
constexpr int kCell = 16;                        // px
constexpr double kSomething = 5, kAlike = 5;     // levels: standard deviation; mean difference
constexpr double kStillShown = 0.15;  // of the cells: that much stays where a person steps aside, and nothing of another scene
constexpr double kLost_s = 2;         // s without a motion, after which the watch begins again
constexpr double kStood_s = 2;        // s over which the place of a shaking camera is the mean
constexpr double kRotated = 0.05;     // of the image's width
constexpr double kZoomed = 0.05;      // ln of the scale
constexpr double kPanSpeed = 0.01;    // of the width a second, or of the scale: it moves
constexpr double kMaxMoving = 0.25;   // of the time, in one piece: more is not a single turn
constexpr int kMinScrolling = 12;     // corners that move, and as many that stand
constexpr double kStands = 0.25, kScrolls = 1.0, kAside = 0.3;  // px

/// Whether much of one image is in the other, at the same place: of the cells with something in them, or of all that are neither
/// black nor white. Before a lawn most cells are empty, and large people are in all others.
bool still_shown(const cv::Mat& a, const cv::Mat& b) {
  int with_something = 0, alike = 0, any = 0, any_alike = 0;
  for (int y = 0; y + kCell <= a.rows; y += kCell) {
    for (int x = 0; x + kCell <= a.cols; x += kCell) {
      const cv::Rect cell(x, y, kCell, kCell);
      cv::Scalar mean_a, mean_b, in_a, in_b;
      cv::meanStdDev(a(cell), mean_a, in_a);
      cv::meanStdDev(b(cell), mean_b, in_b);
      const bool something = std::max(in_a[0], in_b[0]) >= kSomething;
      const int same = cv::norm(a(cell), b(cell), cv::NORM_L1) < kAlike * kCell * kCell ? 1 : 0;
      if (something) {
        ++with_something;
        alike += same;
      }
      if (!something && (std::max(mean_a[0], mean_b[0]) < kBlack || std::min(mean_a[0], mean_b[0]) > kWhite)) continue;
      ++any;
      any_alike += same;
    }
  }
  return alike > kStillShown * with_something || any_alike > kStillShownOfAll * any;
}

cv::Mat shrunk_to(const cv::Mat& luma, int across) {
  cv::Mat small = luma;
  if (luma.cols > across) {
    const int down = std::max(1, static_cast<int>(std::lround(static_cast<double>(luma.rows) * across / luma.cols)));
    cv::resize(luma, small, {across, down}, 0, 0, cv::INTER_AREA);
  }
  if (small.depth() == CV_16U) small.convertTo(small, CV_8U, 1.0 / 256);
  return small.data == luma.data ? small.clone() : small;
}

/// From everywhere: of a page of text and the faint frame round it, corners of both.
std::vector<cv::Point2f> best_corners(const cv::Mat& small) {
  cv::Mat quality;
  cv::cornerMinEigenVal(small, quality, 3);
  double maximum = 0;
  cv::minMaxLoc(quality, nullptr, &maximum);
  std::vector<cv::Point2f> corners;
  for (int row = 0; row < kCellsDown; ++row) {
    for (int column = 0; column < kCellsAcross; ++column) {
      const cv::Point first(column * small.cols / kCellsAcross, row * small.rows / kCellsDown);
      const cv::Point end((column + 1) * small.cols / kCellsAcross, (row + 1) * small.rows / kCellsDown);
      if (end.x <= first.x || end.y <= first.y) continue;
      double best = 0;
      cv::Point at;
      cv::minMaxLoc(quality(cv::Rect(first, end)), nullptr, &best, nullptr, &at);
      if (best > kCornerQuality * maximum && best > 0)
        corners.emplace_back(static_cast<float>(first.x + at.x), static_cast<float>(first.y + at.y));
    }
  }
  return corners;
}

std::vector<cv::Mat> pyramid_of_small(const cv::Mat& small, bool gradients) {
  std::vector<cv::Mat> pyramid;
  cv::buildOpticalFlowPyramid(small, pyramid, {kFlowWindow, kFlowWindow}, kFlowLevels, gradients);
  return pyramid;
}

/// Of every few pixels.
cv::Mat thumb_of(const cv::Mat& luma) {
  cv::Mat thinned = luma;
  if (luma.cols > 4 * kThumbAcross)
    cv::resize(luma, thinned, {4 * kThumbAcross, std::max(1, luma.rows * 4 * kThumbAcross / luma.cols)}, 0, 0, cv::INTER_NEAREST);
  return shrunk_to(thinned, kThumbAcross);
}

/// 1 for images that have nothing in common, 0 for those that are alike but for light and contrast.
double change_between(const cv::Mat& a, const cv::Mat& b) {
  cv::Scalar mean_a, mean_b, spread_a, spread_b;
  cv::meanStdDev(a, mean_a, spread_a);
  cv::meanStdDev(b, mean_b, spread_b);
  constexpr double kFlat = 4;  // levels: a black image, a white one
  if (spread_a[0] < kFlat && spread_b[0] < kFlat) return std::abs(mean_a[0] - mean_b[0]) > 30 ? 1 : 0;
  if (spread_a[0] < kFlat || spread_b[0] < kFlat) return 1;
  cv::Mat x, y;
  a.convertTo(x, CV_32F, 1, -mean_a[0]);
  b.convertTo(y, CV_32F, 1, -mean_b[0]);
  return std::clamp(1 - x.dot(y) / (static_cast<double>(a.total()) * spread_a[0] * spread_b[0]), 0.0, 1.0);
}

/// Where the camera stood about an instant: the mean of two seconds, of one segment.
struct Stood {
  double time;
  Vector<2> middle;
  double log_scale;
  int segment;
};

/// One for each of `locations` (of ViewWatch), which are in order of time.
template <typename Locations>
std::vector<Stood> mean_stands(const Locations& locations) {
  std::vector<Stood> stood;
  std::size_t first = 0, end = 0;
  for (const auto& location : locations) {
    while (locations[first].segment != location.segment || locations[first].time < location.time - kStood_s / 2) ++first;
    while (end < locations.size() && locations[end].segment == location.segment &&
           locations[end].time <= location.time + kStood_s / 2)
      ++end;
    if (end < first) end = first;
    Stood mean{location.time, Vector<2>::Zero(), 0, location.segment};
    for (std::size_t i = first; i < end; ++i) {
      mean.middle += locations[i].at.middle / static_cast<double>(end - first);
      mean.log_scale += locations[i].at.log_scale / static_cast<double>(end - first);
    }
    stood.push_back(mean);
  }
  return stood;
}

}  // namespace

void ViewWatch::begin(const cv::Mat& small, double time) {
  anchor_ = {};
  anchor_.small = small;
  last_ = {};
  lost_since_s_ = -1;
  ++segment_;
  note({}, time);
}

void ViewWatch::note(const Shift& at, double time) {
  locations_.push_back({time, at, segment_});
}

void ViewWatch::add(const Frame& frame) {
  if (frame.image.empty()) return;
  const double time = seconds(frame.time);
  const bool other_size = frame.image.size() != size_;
  if (other_size) {
    size_ = frame.image.size();
    const cv::Mat small = shrunk_to(frame.image.luma(), kAcross);
    shrink_ = static_cast<double>(size_.width) / small.cols;
    lens_ = {1.5 * small.cols, {(small.cols - 1) / 2.0, (small.rows - 1) / 2.0}};
    previous_ = {};
    possible_cut_s_.reset();
  }
  const bool cut = was_cut(frame.image, time);
  if (cut || other_size) {
    begin(shrunk_to(frame.image.luma(), kAcross), time);
    next_s_ = time + kEvery_s;
  } else if (time >= next_s_ && !possible_cut_s_) {
    track_scene(shrunk_to(frame.image.luma(), kAcross), time);
    next_s_ = time + kEvery_s;
  }
  previous_ = frame.image;
}

/// Whether the image before this one was the first of another scene: it differs from the one before it by far more than images
/// do, those next to it too, for people near the camera change image after image; and nothing can be followed into it.
bool ViewWatch::was_cut(const Image& image, double time) {
  const cv::Mat thumb = thumb_of(image.luma());
  const double change = previous_.empty() ? 0 : change_between(previous_thumb_, thumb);
  previous_thumb_ = thumb;
  const double before = std::exchange(previous_change_, change);
  const bool stands_out = change > kCutChange && change > kCutStandsOut * typical_change_ && change > kCutMore * before;
  typical_change_ += (std::min(change, kCutChange) - typical_change_) * 0.1;
  const std::optional<double> cut_s = std::exchange(possible_cut_s_, std::nullopt);
  if (cut_s && before > kCutAlone * change) {
    cuts_.push_back(*cut_s);
    return true;
  }
  if (stands_out && shows_another_scene(image)) possible_cut_s_ = time;
  return false;
}

/// Than the image before it.
bool ViewWatch::shows_another_scene(const Image& image) {
  View before;
  before.small = shrunk_to(previous_.luma(), kAcross);
  const cv::Mat now = shrunk_to(image.luma(), kAcross);
  if (still_shown(before.small, now)) return false;
  const std::vector<cv::Mat> pyramid = pyramid_of_small(now, false);
  return !moved(before, pyramid) && !moved(anchor_, pyramid);
}

std::optional<ViewWatch::Motion> ViewWatch::moved(View& from, const std::vector<cv::Mat>& pyramid) const {
  if (from.pyramid.empty()) {
    from.pyramid = pyramid_of_small(from.small, true);
    from.corners = best_corners(from.small);
  }
  if (std::ssize(from.corners) < kMinCornerCount) return std::nullopt;
  std::vector<cv::Point2f> to;
  std::vector<unsigned char> found;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(from.pyramid, pyramid, from.corners, to, found, error, {kFlowWindow, kFlowWindow}, kFlowLevels,
                           {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 12, 0.03}, 0, 1e-3);
  Motion motion;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const bool within = to[i].x >= 2 && to[i].y >= 2 && to[i].x < from.small.cols - 2 && to[i].y < from.small.rows - 2;
    if (found[i] != 0 && within) motion.locations.push_back({{from.corners[i].x, from.corners[i].y}, {to[i].x, to[i].y}});
  }
  const auto fit = fit_motion(motion.locations, lens_, kAgree);
  if (!fit || fit->agreeing < kMinCornerCount || fit->agreeing < kFractionTracked * static_cast<double>(motion.locations.size()) ||
      fit->spread < kSpread * from.small.rows)
    return std::nullopt;
  motion.fraction = fit->agreeing / static_cast<double>(from.corners.size());
  if (motion.fraction < kFractionOfAll) return std::nullopt;
  const Vector<2> middle = (moved_from_rest(fit->motion, lens_) * lens_.principal.homogeneous()).hnormalized();
  motion.by = {middle - lens_.principal, fit->motion.log_scale};
  return motion;
}

/// A part of the image moves straight up or down while another does not move at all: no camera does that.
bool ViewWatch::scrolls(const std::vector<TrackedPosition>& locations, const Shift& motion) const {
  const Vector<2> main = motion.middle;
  std::vector<double> up;
  int still = 0;
  for (const TrackedPosition& location : locations) {
    const Vector<2> by = location.detected - location.rest;
    if (by.norm() < kStands) ++still;
    if (std::abs(by.y()) > kScrolls && std::abs(by.x()) < kAside) up.push_back(by.y());
  }
  if (still < kMinScrolling || std::ssize(up) < kMinScrolling) return false;
  if (main.norm() > kStands && std::abs(main.x()) > kAside) return false;
  const double by = geometry::median(up);
  const auto together = std::count_if(up.begin(), up.end(), [&](double one) { return std::abs(one - by) < kAside; });
  return together >= kMinScrolling && 5 * together >= std::ssize(locations);
}

/// First against the image that the others are reported against, which does not drift; where much of that is gone, against the last
/// one.
void ViewWatch::track_scene(const cv::Mat& small, double time) {
  const std::vector<cv::Mat> pyramid = pyramid_of_small(small, false);
  std::optional<Shift> at;
  const auto from_anchor = moved(anchor_, pyramid);
  if (from_anchor) at = anchor_.at + from_anchor->by;
  if (!last_.small.empty() && (!from_anchor || from_anchor->fraction < kMuchThere)) {
    const auto step = moved(last_, pyramid);
    if (step && scrolls(step->locations, step->by)) ++scrolled_;
    if (step && !at) {
      at = last_.at + step->by;
      anchor_ = std::move(last_);
    }
  }
  if (!at) {
    if (lost_since_s_ < 0) lost_since_s_ = time;
    if (time - lost_since_s_ > kLost_s) begin(small, time);
    return;
  }
  lost_since_s_ = -1;
  last_ = {};
  last_.small = small;
  last_.at = *at;
  note(*at, time);
}

ViewReport ViewWatch::report() const {
  ViewReport report;
  report.cuts = cuts_;
  report.images = std::ssize(locations_);
  if (locations_.empty() || size_.empty()) return report;
  report.scrolling = static_cast<double>(scrolled_) / static_cast<double>(locations_.size());
  const std::vector<Stood> stood = mean_stands(locations_);
  double squares = 0;
  for (std::size_t i = 0; i < stood.size(); ++i) squares += (locations_[i].at.middle - stood[i].middle).squaredNorm();
  report.shake_px = shrink_ * std::sqrt(squares / static_cast<double>(locations_.size()));
  const double width = size_.width / shrink_;
  ViewReport::Turn turn;
  double all_s = 0, moving_s = 0;
  bool moves = false;
  int pieces = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < stood.size(); ++i) {
    if (stood[i].segment != stood[begin].segment) begin = i;
    const Vector<2> by = stood[i].middle - stood[begin].middle;
    const double zoomed = stood[i].log_scale - stood[begin].log_scale;
    if (by.norm() / width > turn.fraction) turn.fraction = by.norm() / width;
    if (std::abs(zoomed) > std::abs(std::log(turn.zoom))) turn.zoom = std::exp(zoomed);
    if (i == begin) continue;
    const double step_s = stood[i].time - stood[i - 1].time;
    all_s += step_s;
    const double speed =
        (stood[i].middle - stood[i - 1].middle).norm() / width + std::abs(stood[i].log_scale - stood[i - 1].log_scale);
    const bool now = speed > kPanSpeed * step_s;
    if (now) {
      moving_s += step_s;
      pieces += moves ? 0 : 1;
      if (turn.to_s == 0) turn.from_s = stood[i - 1].time;
      turn.to_s = stood[i].time;
    }
    moves = now;
  }
  if (turn.fraction < kRotated && std::abs(std::log(turn.zoom)) < kZoomed) return report;
  turn.stays = pieces <= 2 && moving_s < kMaxMoving * all_s;
  report.turn = turn;
  return report;
}

}  // namespace marey::source::stabilise
