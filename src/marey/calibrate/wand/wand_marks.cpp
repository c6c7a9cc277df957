#include "marey/calibrate/wand/wand_marks.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::wand {
namespace {

/// Distances of a wand's two ends from the camera differ by no more than this factor where a view is used at first.
constexpr double kDepthRatio = 1.35;
constexpr double kMinGapPx = 3;          // of neighbouring markers: nearer, their blobs spoil one another
constexpr std::size_t kMaxBlobs = 40;    // of one view in which triples are tried
constexpr double kStillFraction = 0.25;  // of the frames in which a blob at one place is not a wand
constexpr std::size_t kFewFrames = 40;   // too few to detect what stands still
constexpr double kCell = 3;              // px: "one place"

using Cell = std::pair<int, int>;

Cell cell_of(const Vector<2>& pixel) {
  return {static_cast<int>(std::floor(pixel.x() / kCell)), static_cast<int>(std::floor(pixel.y() / kCell))};
}

/// Cells that hold a blob in too many of the frames.
std::map<Cell, int> still_cells(std::span<const BlobFrame> frames) {
  std::map<Cell, int> counts;
  if (frames.size() < kFewFrames) return counts;
  for (const BlobFrame& frame : frames) {
    for (const auto& blob : frame.blobs) ++counts[cell_of(blob)];
  }
  std::erase_if(counts, [&](const auto& cell) { return cell.second < kStillFraction * static_cast<double>(frames.size()); });
  return counts;
}

bool near_still(const std::map<Cell, int>& still, const Vector<2>& pixel) {
  const auto [x, y] = cell_of(pixel);
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      if (still.contains({x + dx, y + dy})) return true;
    }
  }
  return false;
}

/// Straightens what a lens bends: triples of blobs on a plane across their own direction, in px.
class Straightener {
 public:
  Straightener(const std::optional<geometry::Lens>& lens, cv::Size size) {
    if (lens) camera_.emplace(*lens, Rigid3{}, size);
  }

  bool knows_lens() const { return camera_.has_value(); }

  std::optional<std::array<Vector<2>, 3>> operator()(const std::array<Vector<2>, 3>& pixels) const {
    if (!camera_) return pixels;
    std::array<Vector<3>, 3> bearings;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto bearing = camera_->bearing(pixels[i]);
      if (!bearing) return std::nullopt;
      bearings[i] = *bearing;
    }
    const Vector<3> ahead = (bearings[0] + bearings[1] + bearings[2]).normalized();
    const Vector<3> right = ahead.unitOrthogonal(), down = ahead.cross(right);
    std::array<Vector<2>, 3> straight;
    for (std::size_t i = 0; i < 3; ++i) {
      straight[i] = geometry::focal_of(camera_->lens()).x() * Vector<2>(right.dot(bearings[i]), down.dot(bearings[i])) /
                    ahead.dot(bearings[i]);
    }
    return straight;
  }

 private:
  std::optional<Camera> camera_;
};

/// Where the middle marker may divide the line seen from the first end to the last, for a division `s` of the wand itself.
bool divides(double t, double s) {
  const auto detected = [s](double ratio) { return s * ratio / (1 - s + s * ratio); };
  return t >= detected(1 / kDepthRatio) && t <= detected(kDepthRatio);
}

/// Orientations in which three points, ends first and last, can be the wand: bit 0 as they are, bit 1 reversed.
int orientations_of(const std::array<Vector<2>, 3>& points, double s, bool knows_lens) {
  const Vector<2> line = points[2] - points[0];
  const double length = line.norm();
  if (length < 2 * kMinGapPx) return 0;
  const Vector<2> along = line / length, from_end = points[1] - points[0];
  const double t = from_end.dot(along) / length, off = std::abs(along.x() * from_end.y() - along.y() * from_end.x());
  if (t * length < kMinGapPx || (1 - t) * length < kMinGapPx) return 0;
  if (off > std::max(1.0, (knows_lens ? 0.01 : 0.03) * length)) return 0;
  return (divides(t, s) ? 1 : 0) | (divides(t, 1 - s) ? 2 : 0);
}

/// The one triple that can be the wand, or nothing if none or several can.
std::optional<Marks> only_triple(const std::vector<Vector<2>>& blobs, const MarkerLine& wand, const Straightener& straighten) {
  if (blobs.size() > kMaxBlobs) return std::nullopt;
  const double s = wand.distances[1] / wand.distances[2];
  std::optional<Marks> found;
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    for (std::size_t j = i + 1; j < blobs.size(); ++j) {
      for (std::size_t middle = 0; middle < blobs.size(); ++middle) {
        if (middle == i || middle == j) continue;
        // Cheap first: the middle one lies between the ends.
        if ((blobs[middle] - blobs[i]).dot(blobs[middle] - blobs[j]) >= 0) continue;
        const auto straight = straighten({blobs[i], blobs[middle], blobs[j]});
        const int orientations = straight ? orientations_of(*straight, s, straighten.knows_lens()) : 0;
        if (orientations == 0) continue;
        if (found || (orientations == 3 && !wand.reversible())) return std::nullopt;
        found = (orientations & 1) != 0 ? Marks{blobs[i], blobs[middle], blobs[j]} : Marks{blobs[j], blobs[middle], blobs[i]};
      }
    }
  }
  return found;
}

}  // namespace

std::vector<MarkFrame> find_marks(std::span<const BlobFrame> frames, const MarkerLine& wand,
                                  const std::optional<geometry::Lens>& lens, cv::Size size) {
  const auto still = still_cells(frames);
  const Straightener straighten(lens, size);
  std::vector<MarkFrame> found;
  std::vector<Vector<2>> blobs;
  for (const BlobFrame& frame : frames) {
    blobs.clear();
    std::copy_if(frame.blobs.begin(), frame.blobs.end(), std::back_inserter(blobs),
                 [&](const auto& blob) { return still.empty() || !near_still(still, blob); });
    if (wand.markers() == 3) {
      if (const auto marks = only_triple(blobs, wand, straighten)) found.push_back({frame.time_s, *marks});
    } else if (blobs.size() == wand.markers()) {
      MarkFrame marks{frame.time_s, {}};
      std::copy(blobs.begin(), blobs.end(), marks.marks.begin());
      found.push_back(marks);
    }
  }
  return found;
}

Marks match_marks(const BlobFrame& frame, const Marks& expected, double gate_px) {
  struct Candidate {
    double distance;
    std::size_t marker, blob;
  };
  std::vector<Candidate> candidates;
  for (std::size_t m = 0; m < expected.size(); ++m) {
    for (std::size_t b = 0; expected[m] && b < frame.blobs.size(); ++b) {
      const double distance = (frame.blobs[b] - *expected[m]).norm();
      if (distance <= gate_px) candidates.push_back({distance, m, b});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  Marks marks;
  std::vector<char> taken(frame.blobs.size(), 0);
  for (const Candidate& candidate : candidates) {
    if (marks[candidate.marker] || taken[candidate.blob]) continue;
    marks[candidate.marker] = frame.blobs[candidate.blob];
    taken[candidate.blob] = 1;
  }
  return marks;
}

}  // namespace marey::calibrate::wand
