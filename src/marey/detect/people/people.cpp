// From foreground to people. Regions that may belong together (by the size a person has there) form a cluster. A cluster that
// looks like one whole person, and where at most one is expected, is reported as it was measured. Any other (a group, a body in
// pieces, a body of which a pole hides half) is explained by whole bodies: people_fit.h. What neither explains is omitted and
// counted.
#include "marey/detect/people/people.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "marey/detect/people/people_pieces.h"
#include "marey/detect/runs.h"

namespace marey::detect::people {
namespace {

constexpr double kGapAcross = 0.15;                            // of a person's width: pieces of one person are no further apart
constexpr double kGapDown = 0.5;                               // of a person's height
constexpr double kMinLevel = 0.78, kMaxLevel = 1.28;           // height of one whole person, of the one learned
constexpr double kMinWidth = 0.4, kMaxWidth = 1.7;             // width, the same; from the side people are half as wide
constexpr double kUnambiguouslyOne = 1.25;                     // width up to which two are not considered
constexpr double kMinFilled = 0.3;                             // of its box
constexpr double kMinColumn = 0.15;                            // of the height, filled: less is a shadow or a hand
constexpr double kOutgrownAcross = 1.6, kOutgrownDown = 1.15;  // a region this much larger than one body holds another
constexpr double kMerged = 0.6;                                // share of an expected box that lies within a region with others
constexpr double kSameBody = 0.6;            // overlap of the body fitted with the one measured, which is then the better
constexpr double kAccepted = 0.4;            // share of a body seen, from which on the rest of it shows what hides people
constexpr double kOverlapExpected = 0.3;     // of the smaller of the two boxes
constexpr double kHeldBeyond = 0.15;         // of an expected box's height, round it, that is kept from the background
constexpr double kHeap = 1.6;                // heights of those who are expected there: no group of them is so tall
constexpr double kSpeck = 0.1;               // of the tallest body seen: less is not reported, while no size is known
constexpr double kUnknownFlattestCut = 0.3;  // the same of what the border cuts off
constexpr double kUnknownFlattest = 0.8, kUnknownTallest = 6;  // height over width, while no size is known
constexpr double kUnknownSmallest = 50;                        // px²

bool at_border(const Box& box, cv::Size image) {
  return box.left <= 1 || box.top <= 1 || box.right() >= image.width - 1 || box.bottom() >= image.height - 1;
}

/// With room for a person taller than expected, or not quite there: feet that the scene absorbed would be missed ever after.
Box grown(const Box& box) {
  const double more = kHeldBeyond * box.height;
  return {box.left - more, box.top - more, box.width + 2 * more, box.height + 2 * more};
}

Box clipped(const Box& box, cv::Size image) {
  return geometry::intersection(box, {0, 0, static_cast<double>(image.width), static_cast<double>(image.height)});
}

/// The box of a region without what sticks out at its sides, a shadow at the feet or a hand: columns at either side that are
/// filled over less than `least` of the height, and rows that then hold nothing.
Box trimmed(std::span<const PixelRun> runs, const Box& box, double minimum) {
  const int left = static_cast<int>(box.left), columns = static_cast<int>(box.width);
  std::vector<int> filled(columns + 1, 0);
  for (const PixelRun& run : runs) {
    ++filled[run.begin - left];
    --filled[run.end - left];
  }
  std::partial_sum(filled.begin(), filled.end(), filled.begin());
  const double enough = minimum * box.height;
  int first = 0, last = columns - 1;
  while (first < last && filled[first] < enough) ++first;
  while (last > first && filled[last] < enough) --last;
  const auto within = [&](const PixelRun& run) { return run.begin <= left + last && run.end > left + first; };
  const auto top = std::find_if(runs.begin(), runs.end(), within);
  const auto bottom = std::find_if(runs.rbegin(), runs.rend(), within);
  if (top == runs.end()) return box;
  return {box.left + first, static_cast<double>(top->row), static_cast<double>(last + 1 - first),
          static_cast<double>(bottom->row + 1 - top->row)};
}

/// The part of `runs` within `box`.
std::vector<PixelRun> runs_within(std::span<const PixelRun> runs, const Box& box) {
  const int top = static_cast<int>(std::lround(box.top)), bottom = static_cast<int>(std::lround(box.bottom()));
  const int left = static_cast<int>(std::lround(box.left)), right = static_cast<int>(std::lround(box.right()));
  std::vector<PixelRun> result;
  auto run = std::lower_bound(runs.begin(), runs.end(), top, [](const PixelRun& a, int row) { return a.row < row; });
  for (; run != runs.end() && run->row < bottom; ++run) {
    const PixelRun part{run->row, std::max(run->begin, left), std::min(run->end, right)};
    if (part.begin < part.end) result.push_back(part);
  }
  return result;
}

/// The largest part of the pixels in `runs` that the person covers, as the foreground says.
std::vector<Vector<2>> outline_within(std::span<const PixelRun> runs, const Foreground& foreground) {
  if (foreground.covered.empty()) return outline_of(largest_part(runs));
  std::vector<PixelRun> covered;
  for (const PixelRun& run : runs) {
    const std::size_t before = covered.size();
    append_runs(foreground.covered.ptr<std::uint8_t>(run.row) + run.begin, run.row, run.end - run.begin, covered);
    for (std::size_t i = before; i < covered.size(); ++i) {
      covered[i].begin += run.begin;
      covered[i].end += run.begin;
    }
  }
  return outline_of(largest_part(covered));
}

Detection detection_of(const Box& box, std::span<const PixelRun> runs, double score, const Foreground& foreground) {
  const cv::Size image = foreground.mask.size();
  Detection detection;
  detection.box = clipped(box, image);
  const double across = 1 + 0.08 * box.width, down = 1 + 0.04 * box.height;
  const double inflation = 1 / std::max(score, 0.2);
  detection.covariance = Vector<2>(across * across * inflation, down * down * inflation).asDiagonal();
  detection.score = score;
  std::vector<PixelRun> part = runs_within(runs, box);
  Vector<2> sum = Vector<2>::Zero();
  for (const PixelRun& run : part) {
    const double length = run.end - run.begin;
    detection.area += length;
    sum += length * Vector<2>((run.begin + run.end - 1) / 2.0, run.row);
  }
  detection.centre = detection.area > 0 ? Vector<2>(sum / detection.area) : detection.box.centre();
  detection.outline = outline_within(part, foreground);
  return detection;
}

bool outgrows(const Box& region, const Box& body) {
  return region.width > kOutgrownAcross * body.width || region.height > kOutgrownDown * body.height;
}

}  // namespace

PeopleDetector::PeopleDetector(std::unique_ptr<background::Background> background, const PeopleOptions& options)
    : background_(std::move(background)), options_(options) {}

std::optional<Box> PeopleDetector::body_at(const Vector<2>& foot) const {
  const auto size = size_at(foot.x(), foot.y());
  if (!size) return std::nullopt;
  return size->box_at(foot.x(), foot.y());
}

void PeopleDetector::prime(std::span<const Frame> samples) {
  background_->prime(samples);
  if (options_.sizes) return;
  for (const Frame& sample : samples) {
    // Held everywhere: the model says what it sees and learns nothing, so that the first frame finds it as it was primed.
    const cv::Size image = sample.image.size();
    const Box everywhere{0, 0, static_cast<double>(image.width), static_cast<double>(image.height)};
    const Foreground foreground = background_->apply(sample, std::span(&everywhere, 1));
    learn(find_regions(foreground.mask, {.min_area = options_.min_area}), {}, image);
  }
  sizes_.fit();
  background_->prime(samples);
}

Detections PeopleDetector::detect(const Frame& frame, std::span<const Expected> expected) {
  std::vector<Box> held;
  held.reserve(expected.size());
  for (const Expected& one : expected) held.push_back(grown(one.box));
  Detections result;
  result.foreground = background_->apply(frame, held);
  groups_ = 0;
  image_ = frame.image;
  const cv::Size image = frame.image.size();
  const std::vector<Region> regions = find_regions(result.foreground.mask, {.min_area = options_.min_area});
  for (const Cluster& cluster : clusters_of(without_noise(regions), expected)) {
    if (cluster.expected.size() <= 1 && appearance_whole(cluster, image, kUnambiguouslyOne)) {
      result.detections.push_back(whole(cluster, expected, result.foreground));
      if (size_known()) hidden_.note(cluster.body, result.foreground.mask);
    } else {
      explain(cluster, expected, result.foreground, result.detections);
    }
  }
  learn(regions, expected, image);
  if (sizes_.needs_fit()) sizes_.fit();
  image_ = {};
  return result;
}

double PeopleDetector::min_area(const Region& region) const {
  const auto foot = region.box.foot();
  const auto size = size_at(foot.x(), foot.y());
  if (!size) return size_known() ? std::numeric_limits<double>::infinity() : options_.min_area;
  return options_.min_fraction * size->height * size->width;
}

/// Which regions lie so near each other that they may be pieces of one body: by the size that a body has there, or while that is
/// not known by their own.
assign::DisjointSets PeopleDetector::pieces_that_lie_together(const std::vector<Region>& regions,
                                                              std::span<const Expected> expected) const {
  if (!size_known()) return pieces_of_those_expected(regions, expected);
  assign::DisjointSets pieces;
  pieces.reset(static_cast<int>(regions.size()));
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (std::size_t j = i + 1; j < regions.size(); ++j) {
      const Box& a = regions[i].box;
      const Box& b = regions[j].box;
      const auto foot = geometry::hull(a, b).foot();
      const auto size = size_at(foot.x(), foot.y());
      if (!size) continue;
      if (gap(a.left, a.right(), b.left, b.right()) > kGapAcross * size->width) continue;
      if (gap(a.top, a.bottom(), b.top, b.bottom()) > kGapDown * size->height) continue;
      pieces.join(static_cast<int>(i), static_cast<int>(j));
    }
  }
  return pieces;
}

std::vector<Region> PeopleDetector::without_noise(std::vector<Region> regions) {
  counts_.noise += static_cast<std::int64_t>(std::erase_if(regions, [&](const Region& r) { return r.area < min_area(r); }));
  return regions;
}

std::vector<PeopleDetector::Cluster> PeopleDetector::clusters_of(std::vector<Region> regions,
                                                                 std::span<const Expected> expected) const {
  assign::DisjointSets pieces = pieces_that_lie_together(regions, expected);
  std::vector<Cluster> clusters;
  std::vector<int> cluster_of(regions.size(), -1);
  for (std::size_t i = 0; i < regions.size(); ++i) {
    int& index = cluster_of[pieces.find(static_cast<int>(i))];
    if (index < 0) {
      index = static_cast<int>(clusters.size());
      clusters.push_back({{}, regions[i].box, {}, 0, 0, {}});
    }
    Cluster& cluster = clusters[index];
    cluster.box = geometry::hull(cluster.box, regions[i].box);
    cluster.area += regions[i].area;
    ++cluster.regions;
    cluster.runs.insert(cluster.runs.end(), regions[i].runs.begin(), regions[i].runs.end());
  }
  for (Cluster& cluster : clusters) {
    if (cluster.regions > 1) put_in_order(cluster.runs);
    cluster.body = trimmed(cluster.runs, cluster.box, kMinColumn);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double shared = geometry::intersection(expected[i].box, cluster.box).area();
      if (shared > kOverlapExpected * std::min(expected[i].box.area(), cluster.box.area())) {
        cluster.expected.push_back(static_cast<int>(i));
      }
    }
  }
  return clusters;
}

/// How large people are is learned from regions that are joined by their own size, never by the one that was learned before, which
/// would only find itself confirmed: a person who is taken for a heap of small people must be seen whole.
void PeopleDetector::learn(const std::vector<Region>& regions, std::span<const Expected> expected, cv::Size image) {
  if (options_.sizes || std::ssize(regions) >= kManyRegions) return;  // there is nothing to learn, or all is noise
  assign::DisjointSets pieces = pieces_by_their_own_size(regions);
  for (const Body& body : bodies_of(regions, pieces)) {
    if (body.area < kMinFilled * body.box.area()) continue;
    int known = 0;
    double tallest = 0;
    for (const Expected& one : expected) {
      const double shared = geometry::intersection(one.box, body.box).area();
      if (shared <= kOverlapExpected * std::min(one.box.area(), body.box.area())) continue;
      ++known;
      tallest = std::max(tallest, one.box.height);
    }
    if (known > 1 && body.box.height < kHeap * tallest) continue;  // a group
    if (at_border(body.box, image)) {
      const bool within = body.box.left > 1 && body.box.right() < image.width - 1;
      if (within) sizes_.observe_cut(body.box, image);
    } else {
      sizes_.observe_frame(trimmed(body.runs, body.box, kMinColumn), image);
    }
  }
}

bool PeopleDetector::appearance_whole(const Cluster& cluster, cv::Size image, double widest) const {
  const Box& box = cluster.body;
  const auto foot = box.foot();
  const auto size = size_at(foot.x(), foot.y());
  if (!size) {
    if (size_known()) return false;
    const double tall = box.height / box.width, flattest = at_border(cluster.box, image) ? kUnknownFlattestCut : kUnknownFlattest;
    return box.area() >= kUnknownSmallest && box.height > kSpeck * sizes_.tallest_observed() && tall > flattest &&
           tall < kUnknownTallest;
  }
  return !at_border(cluster.box, image) && box.height > kMinLevel * size->height && box.height < kMaxLevel * size->height &&
         box.width > kMinWidth * size->width && box.width < widest * size->width && cluster.area > kMinFilled * box.area();
}

/// While no size is known: of a person that the image's border cuts off, and who is expected there, what is not seen any more is
/// where it was; else who walks out of the image would leap as his parts do.
Box PeopleDetector::completed(const Cluster& cluster, std::span<const Expected> expected, cv::Size image) {
  Box box = cluster.body;
  if (cluster.expected.size() != 1) return box;
  const Box& known = expected[static_cast<std::size_t>(cluster.expected.front())].box;
  if (box.left <= 1 || box.right() >= image.width - 1) {
    const double height = std::max(box.height, std::min(known.height, static_cast<double>(image.height)));
    box.top = std::clamp(known.top, box.bottom() - height, box.top);
    box.height = height;
  }
  if (box.top <= 1 || box.bottom() >= image.height - 1) {
    const double width = std::max(box.width, std::min(known.width, static_cast<double>(image.width)));
    box.left = std::clamp(known.left, box.right() - width, box.left);
    box.width = width;
  }
  return box;
}

/// A silhouette runs on the halo of sharpening and on the shadow under the shoes; where the background model shows what is behind
/// it, its ends are put where the body ends.
Box PeopleDetector::without_halo(const Box& box, std::span<const PixelRun> runs) {
  if (image_.luma().depth() != CV_8U) return box;
  const cv::Rect part = part_for_ends(box, image_.size());
  const Image scene = background_->scene(part);
  if (scene.empty()) return box;
  const BodyEnds ends = find_ends(runs, box, {image_.part(part), scene, part.tl()});
  excess_.learn(box, ends);
  return excess_.without(box, ends);
}

Detection PeopleDetector::whole(const Cluster& cluster, std::span<const Expected> expected, const Foreground& foreground) {
  const auto foot = cluster.body.foot();
  const auto size = size_at(foot.x(), foot.y());
  const double filled = std::min(1.0, cluster.area / (0.6 * cluster.body.area()));
  if (!size) return detection_of(completed(cluster, expected, foreground.mask.size()), cluster.runs, 0.5 * filled, foreground);
  const double off = (cluster.body.height / size->height - 1) / 0.3;
  Box box = without_halo(cluster.body, cluster.runs);
  box.width = (box.width + size->width) / 2;
  box.left += (cluster.body.width - box.width) / 2;
  Detection detection = detection_of(box, cluster.runs, filled * (1 - 0.3 * off * off), foreground);
  detection.outline = outline_within(cluster.runs, foreground);  // with the arms and legs that stick out of the box
  return detection;
}

void PeopleDetector::explain(const Cluster& cluster, std::span<const Expected> expected, const Foreground& foreground,
                             std::vector<Detection>& found) {
  const cv::Mat& mask = foreground.mask;
  const cv::Size image = mask.size();
  std::vector<Box> known;
  known.reserve(cluster.expected.size());
  for (const int identity : cluster.expected) known.push_back(expected[identity].box);
  const FitScene scene{image, [&](double x, double y) { return size_at(x, y); },
                       [&](double x, double y) { return hidden_.at(x, y); }};
  const std::vector<Located> located = fit_people(cluster.runs, known, scene, options_.fit);
  for (const Located& one : located) {
    if (one.detected > kAccepted) hidden_.note(one.box, mask);
  }
  if (located.size() == 1 && appearance_whole(cluster, image, kMaxWidth) && iou(located[0].box, cluster.body) > kSameBody) {
    found.push_back(whole(cluster, expected, foreground));
    return;
  }
  const auto within = std::count_if(known.begin(), known.end(), [&](const Box& box) {
    return geometry::intersection(box, cluster.body).area() > kMerged * box.area();
  });
  if (located.size() == 1 && within > 1 && outgrows(cluster.body, located[0].box)) {
    // One body cannot be all of this, and two do not stand out: the region is theirs together.
    Detection together = whole(cluster, expected, foreground);
    together.group = groups_++;
    counts_.shared += within;
    found.push_back(std::move(together));
    return;
  }
  if (located.empty()) ++counts_.misfits;
  if (located.size() == 1) ++counts_.completed;
  if (located.size() > 1) {
    ++groups_;
    counts_.shared += static_cast<std::int64_t>(located.size());
  }
  for (const Located& one : located) {
    Detection detection = detection_of(one.box, cluster.runs, std::clamp(0.3 + one.cover, 0.1, 1.0), foreground);
    if (located.size() > 1) detection.group = groups_ - 1;
    found.push_back(std::move(detection));
  }
}

}  // namespace marey::detect::people
