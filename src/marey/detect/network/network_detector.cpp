#include "marey/detect/network/network_detector.h"

#include <algorithm>
#include <cmath>

#include "marey/core/error.h"

namespace marey::detect::network {
namespace {

constexpr double kMinLevel = 0.65, kMaxLevel = 1.5;  // height of a person, of that known there
constexpr double kFlattest = 1.4, kTallest = 4.5;    // height over width of who stands or walks
constexpr double kSure = 0.55;                       // score from which on a find teaches the size of people
constexpr double kObservedByBoth = 0.4;              // intersection over union
constexpr double kInRegion = 0.6;                    // of a find's area that lies in a region: it is one of those who share it
constexpr double kKnownAlready = 0.7;                // of a find's area that lies in moving people's boxes: it is they
constexpr double kApart = 0.3;                       // intersection over union of two people who stand beside each other, at most
constexpr double kMadeUp = 0.6;                      // of a moving region's area that people found in it cover: it is they
constexpr double kThere = 0.3;                       // intersection over union of a person expected and who is found there
constexpr double kRoom = 0.25;                       // heights about a person expected in which what changes is theirs
constexpr double kRareInterval = 4;                  // times as long from one search of the whole image to the next, at most

std::unique_ptr<people::PeopleDetector> moving_people(const NetworkDetectorOptions& options) {
  if (!options.background) return nullptr;
  return std::make_unique<people::PeopleDetector>(background::make_background(options.people.background), options.people.people);
}

Detection detection_of_find(const Candidate& one, cv::Size image) {
  Detection detection;
  detection.box = geometry::intersection({one.left, one.top, one.right - one.left, one.bottom - one.top},
                                         {0, 0, static_cast<double>(image.width), static_cast<double>(image.height)});
  const double across = 1 + 0.08 * detection.box.width, down = 1 + 0.04 * detection.box.height;
  const double inflation = 1 / std::max(one.score, 0.2);
  detection.covariance = Vector<2>(across * across * inflation, down * down * inflation).asDiagonal();
  detection.centre = detection.box.centre();
  detection.area = 0.6 * detection.box.area();
  detection.score = one.score;
  return detection;
}

/// Black where the tile reaches beyond the image.
cv::Mat pixels_in(const cv::Mat& image, const cv::Rect& tile) {
  const cv::Rect there = tile & cv::Rect({}, image.size());
  if (there == tile) return image(tile);
  cv::Mat part(tile.size(), image.type(), cv::Scalar::all(0));
  image(there).copyTo(part(there - tile.tl()));
  return part;
}

double fraction_in(const Box& inner, const Box& outer) {
  return inner.empty() ? 0 : geometry::intersection(inner, outer).area() / inner.area();
}

/// Whether several people who stand beside each other are what a region is.
bool makes_up(const Box& region, std::span<const std::size_t> inside, std::span<const Detection> detected) {
  double covered = 0;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    covered += geometry::intersection(detected[inside[i]].box, region).area();
    for (std::size_t j = 0; j < i; ++j) {
      if (geometry::iou(detected[inside[i]].box, detected[inside[j]].box) > kApart) return false;
    }
  }
  return covered > kMadeUp * region.area();
}

}  // namespace

namespace {

NetworkModel model_of(const NetworkDetectorOptions& options) {
  NetworkModel model = read_network_model(options.model);
  model.score *= options.score_factor;
  return model;
}

}  // namespace

NetworkDetector::NetworkDetector(const NetworkDetectorOptions& options)
    : options_(options), network_(model_of(options)), moving_(moving_people(options)), until_everywhere_(options.everywhere_s) {}

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

std::vector<cv::Rect> NetworkDetector::tiles_of(cv::Size image) const {
  const bool known = options_.people.people.sizes != nullptr || sizes_.known();
  if (!known) return tiles_over(image, {}, options_.first_height);
  const HeightAt height_at = [this](double x, double y) -> std::optional<double> {
    const auto size = size_at(x, y);
    return size ? std::optional<double>(size->height) : std::nullopt;
  };
  std::vector<cv::Rect> tiles = tiles_over(image, height_at, options_.first_height);
  // A person close to the camera may be larger than all before.
  for (const cv::Rect& tile : tiles_over(image, {}, image.height)) {
    if (std::find(tiles.begin(), tiles.end(), tile) == tiles.end()) tiles.push_back(tile);
  }
  return tiles;
}

std::vector<Detection> NetworkDetector::people_in(const Frame& frame, std::span<const cv::Rect> tiles) {
  const cv::Mat bgr = frame.image.bgr();
  std::vector<cv::Mat> parts;
  for (const cv::Rect& tile : tiles) parts.push_back(pixels_in(bgr, tile));
  const std::vector<std::vector<Candidate>> found = network_.find_all(parts);
  tiles_ += std::ssize(tiles);
  std::vector<TileFinds> finds;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    TileFinds& one = finds.emplace_back(TileFinds{tiles[i], found[i]});
    for (Candidate& candidate : one.found) {
      candidate.left += tiles[i].x, candidate.right += tiles[i].x;
      candidate.top += tiles[i].y, candidate.bottom += tiles[i].y;
    }
  }
  std::vector<Detection> people;
  for (const Candidate& one : join_finds(finds, bgr.size())) {
    const auto size = size_at((one.left + one.right) / 2, one.bottom);
    const double height = one.bottom - one.top;
    const double tall = height / (one.right - one.left);
    const bool at_border = one.top <= 1 || one.left <= 1 || one.bottom >= bgr.rows - 1 || one.right >= bgr.cols - 1;
    const bool shaped = tall > kFlattest && tall < kTallest;
    if (!at_border && (!shaped || (size && (height < kMinLevel * size->height || height > kMaxLevel * size->height)))) {
      ++misfits_;
      continue;
    }
    people.push_back(detection_of_find(one, bgr.size()));
  }
  return people;
}

void NetworkDetector::learn(std::span<const Detection> found, cv::Size image) {
  if (options_.people.people.sizes) return;
  for (const Detection& one : found) {
    const Box& box = one.box;
    if (one.score < kSure || box.left <= 1 || box.top <= 1 || box.right() >= image.width - 1 || box.bottom() >= image.height - 1)
      continue;
    sizes_.observe_frame(box, image);
  }
  if (sizes_.needs_fit()) sizes_.fit();
}

std::vector<Detection> NetworkDetector::people_everywhere(const Frame& frame) {
  std::vector<Detection> people = people_in(frame, tiles_of(frame.image.size()));
  learn(people, frame.image.size());
  return people;
}

void NetworkDetector::forget_changed(const ImageCells& cells) {
  std::erase_if(standing_, [&](const Standing& one) { return !is_unchanged(one.cells, cells, one.found.box); });
}

std::vector<Detection> NetworkDetector::standing() const {
  std::vector<Detection> people;
  for (const Standing& one : standing_) people.push_back(one.found);
  return people;
}

/// Whether a person who stands as before is there.
bool NetworkDetector::stands(const Box& box) const {
  return std::any_of(standing_.begin(), standing_.end(),
                     [&](const Standing& one) { return geometry::iou(one.found.box, box) > kThere; });
}

/// Where the network may find something new, one box for each person it may be, px.
std::vector<Box> NetworkDetector::requested(const ImageCells& cells, std::span<const Expected> expected,
                                            std::span<const Detection> moving, cv::Size image) const {
  const Box whole{0, 0, static_cast<double>(image.width), static_cast<double>(image.height)};
  std::vector<Box> boxes;
  const auto request = [&](const Box& box) { boxes.push_back(geometry::intersection(box, whole)); };
  const auto is_expected = [&](const Box& box) {
    return std::any_of(expected.begin(), expected.end(), [&](const Expected& one) { return geometry::iou(one.box, box) > kThere; });
  };
  const auto moves = [&](const Box& box) {
    return std::any_of(moving.begin(), moving.end(), [&](const Detection& one) {
      return geometry::iou(one.box, box) > kThere || fraction_in(box, one.box) > kKnownAlready;
    });
  };
  for (const Detection& one : moving) {
    if (one.group || !is_expected(one.box)) request(one.box);
  }
  for (const Expected& one : expected) {
    if (!stands(one.box) && !moves(one.box)) request(one.box);
  }
  if (moving_ != nullptr) return boxes;
  std::vector<Box> explained;
  for (const Expected& one : expected) {
    const double by = kRoom * one.box.height;
    explained.push_back({one.box.left - by, one.box.top - by, one.box.width + 2 * by, one.box.height + 2 * by});
  }
  for (const Box& part : changed_parts(before_, cells, explained)) {
    const auto size = size_at(part.centre().x(), part.bottom());
    const double height = std::max(part.height, size ? size->height : options_.first_height);
    request(geometry::hull(part, Box::from_centre(part.centre(), 0.4 * height, height)));
  }
  return boxes;
}

/// The people that the network sees, or saw where nothing has changed since.
std::vector<Detection> NetworkDetector::search(const Frame& frame, const ImageCells& cells, std::span<const Expected> expected,
                                               std::span<const Detection> moving) {
  const cv::Size image = frame.image.size();
  const bool everywhere = !last_everywhere_ || seconds(frame.time - *last_everywhere_) >= until_everywhere_;
  const std::vector<cv::Rect> tiles = everywhere ? tiles_of(image) : tiles_round(image, requested(cells, expected, moving, image));
  std::vector<Detection> people = tiles.empty() ? std::vector<Detection>() : people_in(frame, tiles);
  learn(people, image);
  const auto is_new = [&](const Detection& found) {
    const auto there = [&](const auto& one) { return geometry::iou(one.box, found.box) > kThere; };
    return !stands(found.box) && std::none_of(expected.begin(), expected.end(), there) &&
           std::none_of(moving.begin(), moving.end(), there);
  };
  if (everywhere) {
    const bool news = !last_everywhere_ || std::any_of(people.begin(), people.end(), is_new);
    until_everywhere_ = news ? options_.everywhere_s : std::min(2 * until_everywhere_, kRareInterval * options_.everywhere_s);
    last_everywhere_ = frame.time;
    standing_.clear();
  }
  // Who stands where this search did not reach is there as before.
  std::erase_if(standing_, [&](const Standing& one) {
    const auto holds = [&](const cv::Rect& tile) {
      return fraction_in(one.found.box, {static_cast<double>(tile.x), static_cast<double>(tile.y), static_cast<double>(tile.width),
                                         static_cast<double>(tile.height)}) > 0.98;
    };
    return std::any_of(tiles.begin(), tiles.end(), holds) || std::any_of(people.begin(), people.end(), [&](const Detection& found) {
             return geometry::iou(found.box, one.found.box) > kThere || fraction_in(found.box, one.found.box) > kKnownAlready;
           });
  });
  for (const Detection& one : people) standing_.push_back({one, cells});
  before_ = cells;
  return standing();
}

/// The people that the background model sees, corrected by those that the network sees.
std::vector<Detection> NetworkDetector::joined(const std::vector<Detection>& moving, const std::vector<Detection>& detected) const {
  std::vector<Detection> result;
  std::vector<char> used(detected.size(), 0);
  for (const Detection& one : moving) {
    std::vector<std::size_t> same, inside;
    for (std::size_t i = 0; i < detected.size(); ++i) {
      if (used[i]) continue;
      if (geometry::iou(detected[i].box, one.box) > kObservedByBoth) same.push_back(i);
      if (fraction_in(detected[i].box, one.box) > kInRegion) inside.push_back(i);
    }
    if (one.group && inside.size() > 1) {  // people who share one region: those that the network distinguishes
      for (const std::size_t i : inside) result.push_back(detected[i]), used[i] = 1;
      continue;
    }
    if (inside.size() > 1 && makes_up(one.box, inside, detected)) {  // people who move as one region
      for (const std::size_t i : inside) result.push_back(detected[i]), used[i] = 1;
      continue;
    }
    for (const std::size_t i : same) used[i] = 1;
    result.push_back(one);
    if (!same.empty()) result.back().score = std::max(one.score, detected[same.front()].score);
  }
  const std::size_t movers = result.size();
  for (std::size_t i = 0; i < detected.size(); ++i) {
    if (used[i]) continue;
    double covered = 0;  // of it, by all who move together
    for (std::size_t m = 0; m < movers; ++m) covered += fraction_in(detected[i].box, result[m].box);
    if (covered <= kKnownAlready) result.push_back(detected[i]);
  }
  return result;
}

Detections NetworkDetector::detect(const Frame& frame, std::span<const Expected> expected) {
  const bool searches = frames_++ % options_.every == 0;
  Detections result;
  if (moving_ != nullptr) result = moving_->detect(frame, expected);
  const ImageCells cells = cells_of(frame.image);
  forget_changed(cells);
  if (!searches && moving_ == nullptr) {
    result.searched = false;
    return result;
  }
  const std::vector<Detection> detected = searches ? search(frame, cells, expected, result.detections) : standing();
  result.detections = moving_ != nullptr ? joined(result.detections, detected) : detected;
  return result;
}

}  // namespace marey::detect::network
