#include "marey/detect/network/network_detector.h"

#include <algorithm>
#include <cmath>

#include "marey/core/error.h"

namespace marey::detect::network {
namespace {

constexpr double kLowest = 0.65, kHighest = 1.5;   // height of a person, of that known there
constexpr double kFlattest = 1.4, kTallest = 4.5;  // height over width of who stands or walks
constexpr double kSure = 0.55;                     // score from which on a find teaches the size of people
constexpr double kSeenByBoth = 0.4;                // intersection over union
constexpr double kInRegion = 0.6;                  // of a find's area that lies in a region: it is one of those who share it
constexpr double kKnownAlready = 0.7;              // of a find's area that lies in a moving person's box: the same person

std::unique_ptr<people::PeopleDetector> moving_people(const NetworkDetectorOptions& options) {
  if (!options.background) return nullptr;
  return std::make_unique<people::PeopleDetector>(background::make_background(options.people.background), options.people.people);
}

Detection detection_of_find(const Candidate& one, cv::Size picture) {
  Detection detection;
  detection.box = geometry::intersection({one.left, one.top, one.right - one.left, one.bottom - one.top},
                                         {0, 0, static_cast<double>(picture.width), static_cast<double>(picture.height)});
  const double across = 1 + 0.08 * detection.box.width, down = 1 + 0.04 * detection.box.height;
  const double doubt = 1 / std::max(one.score, 0.2);
  detection.covariance = Vector<2>(across * across * doubt, down * down * doubt).asDiagonal();
  detection.centre = detection.box.centre();
  detection.area = 0.6 * detection.box.area();
  detection.score = one.score;
  return detection;
}

bool touches(const cv::Rect& tile, const Box& box) {
  const Box part{static_cast<double>(tile.x), static_cast<double>(tile.y), static_cast<double>(tile.width),
                 static_cast<double>(tile.height)};
  return geometry::intersection(part, box).area() > 0;
}

double share_in(const Box& inner, const Box& outer) {
  return inner.empty() ? 0 : geometry::intersection(inner, outer).area() / inner.area();
}

}  // namespace

NetworkDetector::NetworkDetector(const NetworkDetectorOptions& options)
    : options_(options), network_(read_network_model(options.model)), moving_(moving_people(options)) {
  if (options_.every > 1 && !options_.background)
    throw Error("a network that looks at every {}th frame needs the background model beside it, which sees people in between",
                options_.every);
}

void NetworkDetector::prime(std::span<const Frame> samples) {
  if (moving_ != nullptr) moving_->prime(samples);
}

std::optional<people::PersonSize> NetworkDetector::size_at(double x, double y) const {
  if (options_.people.people.sizes) return options_.people.people.sizes->at(x, y);
  return sizes_.at(x, y);
}

std::optional<Box> NetworkDetector::body_at(const Vector<2>& foot) const {
  const auto size = size_at(foot.x(), foot.y());
  if (!size) return std::nullopt;
  return size->box_at(foot.x(), foot.y());
}

DetectionCounts NetworkDetector::detection_counts() const {
  DetectionCounts counts = moving_ == nullptr ? DetectionCounts{} : moving_->detection_counts();
  counts.misfits = counts.misfits.value_or(0) + misfits_;
  return counts;
}

std::vector<cv::Rect> NetworkDetector::tiles_of(cv::Size picture) const {
  const bool known = options_.people.people.sizes != nullptr || sizes_.known();
  if (!known) return tiles_over(picture, {}, options_.first_height);
  const HeightAt height_at = [this](double x, double y) -> std::optional<double> {
    const auto size = size_at(x, y);
    return size ? std::optional<double>(size->height) : std::nullopt;
  };
  return tiles_over(picture, height_at, options_.first_height);
}

std::vector<Detection> NetworkDetector::look_at(const Frame& frame, std::span<const cv::Rect> tiles) {
  const cv::Mat bgr = frame.picture.bgr();
  std::vector<TileFinds> finds;
  for (const cv::Rect& tile : tiles) {
    TileFinds& one = finds.emplace_back(TileFinds{tile, network_.find(bgr(tile))});
    for (Candidate& found : one.found) {
      found.left += tile.x, found.right += tile.x;
      found.top += tile.y, found.bottom += tile.y;
    }
  }
  std::vector<Detection> people;
  for (const Candidate& one : join_finds(finds, bgr.size())) {
    const auto size = size_at((one.left + one.right) / 2, one.bottom);
    const double height = one.bottom - one.top;
    const double tall = height / (one.right - one.left);
    const bool at_border = one.top <= 1 || one.left <= 1 || one.bottom >= bgr.rows - 1 || one.right >= bgr.cols - 1;
    const bool shaped = tall > kFlattest && tall < kTallest;
    if (!at_border && (!shaped || (size && (height < kLowest * size->height || height > kHighest * size->height)))) {
      ++misfits_;
      continue;
    }
    people.push_back(detection_of_find(one, bgr.size()));
  }
  return people;
}

void NetworkDetector::learn(std::span<const Detection> found, cv::Size picture) {
  if (options_.people.people.sizes) return;
  for (const Detection& one : found) {
    const Box& box = one.box;
    if (one.score < kSure || box.left <= 1 || box.top <= 1 || box.right() >= picture.width - 1 ||
        box.bottom() >= picture.height - 1)
      continue;
    sizes_.see(box, picture);
  }
  if (sizes_.wants_fit()) sizes_.fit();
}

std::vector<Detection> NetworkDetector::look(const Frame& frame) {
  std::vector<Detection> people = look_at(frame, tiles_of(frame.picture.size()));
  learn(people, frame.picture.size());
  return people;
}

/// Those whom the background model sees, put right by those whom the network sees.
std::vector<Detection> NetworkDetector::joined(const std::vector<Detection>& moving, const std::vector<Detection>& seen) const {
  std::vector<Detection> result;
  std::vector<char> used(seen.size(), 0);
  for (const Detection& one : moving) {
    std::vector<std::size_t> same, inside;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (used[i]) continue;
      if (geometry::iou(seen[i].box, one.box) > kSeenByBoth) same.push_back(i);
      if (share_in(seen[i].box, one.box) > kInRegion) inside.push_back(i);
    }
    if (one.group && inside.size() > 1) {  // people who share one region: those whom the network tells apart
      for (const std::size_t i : inside) result.push_back(seen[i]), used[i] = 1;
      continue;
    }
    for (const std::size_t i : same) used[i] = 1;
    result.push_back(one);
    if (!same.empty()) result.back().score = std::max(one.score, seen[same.front()].score);
  }
  const std::size_t movers = result.size();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (used[i]) continue;
    const bool known = std::any_of(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(movers),
                                   [&](const Detection& one) { return share_in(seen[i].box, one.box) > kKnownAlready; });
    if (!known) result.push_back(seen[i]);
  }
  return result;
}

Detections NetworkDetector::detect(const Frame& frame, std::span<const Expected> expected) {
  const bool looks = frames_++ % options_.every == 0;
  if (moving_ == nullptr) return {.detections = look(frame), .foreground = {}};
  Detections result = moving_->detect(frame, expected);
  if (!looks) return result;
  std::vector<cv::Rect> tiles = tiles_of(frame.picture.size());
  const bool everywhere = !looked_everywhere_ || seconds(frame.time - *looked_everywhere_) >= options_.everywhere_s;
  if (everywhere) {
    looked_everywhere_ = frame.time;
  } else {
    std::erase_if(tiles, [&](const cv::Rect& tile) {
      return std::none_of(expected.begin(), expected.end(), [&](const Expected& one) { return touches(tile, one.box); }) &&
             std::none_of(result.detections.begin(), result.detections.end(),
                          [&](const Detection& one) { return touches(tile, one.box); });
    });
  }
  const std::vector<Detection> seen = look_at(frame, tiles);
  learn(seen, frame.picture.size());
  result.detections = joined(result.detections, seen);
  return result;
}

}  // namespace marey::detect::network
