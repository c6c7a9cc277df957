#include "marey/pipeline/keypoints/camera_people.h"

#include <algorithm>
#include <cmath>

namespace marey::pipeline::keypoints {
namespace {

using detect::keypoints::Body;
using detect::keypoints::PersonRegion;

bool is_complete(const Keypoints<2>& body) {
  return std::all_of(body.points.begin(), body.points.end(), [](const auto& point) { return point.has_value(); });
}

double extent_of(const Keypoints<2>& body) {
  Vector<2> low = Vector<2>::Constant(1e9), high = -low;
  for (const auto& point : body.points) {
    if (point) low = low.cwiseMin(point->position), high = high.cwiseMax(point->position);
  }
  return std::max(1.0, (high - low).maxCoeff());
}

/// px between the same points of both, on average.
double distance_of(const Keypoints<2>& a, const Keypoints<2>& b) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    if (!a.points[i] || !b.points[i]) continue;
    sum += (a.points[i]->position - b.points[i]->position).norm();
    ++count;
  }
  return count > 0 ? sum / count : 1e9;
}

bool is_same(const PersonRegion& a, const PersonRegion& b, const CameraPeopleOptions& how) {
  return (a.centre - b.centre).norm() < how.same_centre * std::max(a.side, b.side) &&
         how.max_growth * std::min(a.side, b.side) > std::max(a.side, b.side);
}

bool continues(const PersonRegion& from, const PersonRegion& to, const CameraPeopleOptions& how) {
  return (to.centre - from.centre).norm() < how.max_step * from.side && to.side < how.max_growth * from.side &&
         from.side < how.max_growth * to.side;
}

}  // namespace

CameraPeople::CameraPeople(const KeypointSet& set, const CameraPeopleOptions& options) : set_(set), options_(options) {}

std::optional<double> CameraPeople::search_due(Timestamp now, bool full) const {
  if (!searched_) return options_.search_s;
  if (full) return std::nullopt;
  const double ago = seconds(now - *searched_);
  const double due = required_ || known_.empty() ? options_.retry_s : options_.search_s;
  return ago >= due ? std::optional(ago - due) : std::nullopt;
}

void CameraPeople::searched(std::span<const Box> boxes, Timestamp now) {
  searched_ = now;
  required_ = false;
  for (const Box& box : boxes) {
    if (!box.empty()) propose(detect::keypoints::region_of(box));
  }
}

void CameraPeople::expect(const PersonRegion& region, Timestamp now) {
  // Several people may be expected in the same image.
  if (expected_ && now != *expected_ && seconds(now - *expected_) < options_.expect_s) return;
  expected_ = now;
  propose(region);
}

bool CameraPeople::covered(const PersonRegion& region) const {
  return std::any_of(known_.begin(), known_.end(), [&](const Known& known) { return is_same(known.region, region, options_); });
}

void CameraPeople::propose(const PersonRegion& region) {
  if (known_.size() < options_.max_regions && !covered(region)) known_.emplace_back(region, set_);
}

std::span<const PersonRegion> CameraPeople::regions() {
  regions_.clear();
  for (const Known& known : known_) regions_.push_back(known.region);
  return regions_;
}

void CameraPeople::take(std::span<const Body> bodies, Timestamp now, bool full) {
  for (std::size_t i = 0; i < known_.size(); ++i) {
    Known& known = known_[i];
    const Body& body = bodies[i];
    if (known.appearances++ == 0) known.confirmed = now;
    const bool first = !known.detected.has_value();
    if (body.keypoints.presence < options_.presence || (!first && !continues(known.region, body.next, options_))) {
      known.ended = true;
      continue;
    }
    known.body = body.keypoints;
    if (is_complete(body.keypoints)) {
      known.swaps.add(body.keypoints, known.detected ? seconds(now - *known.detected) : 0);
      known.body = known.swaps.take();
    }
    known.detected = now;
    known.region = body.next;
    known.ended = seconds(now - known.confirmed) > (full ? options_.surplus_s : options_.unplaced_s);
  }
  end_doubles();
  const auto gone = std::erase_if(known_, [](const Known& known) { return known.ended; });
  ended_ += static_cast<std::int64_t>(gone);
  required_ |= gone > 0;
  people_.clear();
  of_people_.clear();
  for (std::size_t i = 0; i < known_.size(); ++i) {
    if (known_[i].appearances < options_.min_detector_runs) continue;
    people_.push_back(known_[i].body);
    of_people_.push_back(i);
  }
}

/// Of two regions that show the same body the one that began later ends.
void CameraPeople::end_doubles() {
  for (std::size_t i = 0; i < known_.size(); ++i) {
    for (std::size_t k = 0; k < i && !known_[i].ended; ++k) {
      if (known_[k].ended) continue;
      known_[i].ended = distance_of(known_[i].body, known_[k].body) < options_.same_points * extent_of(known_[k].body);
    }
  }
}

void CameraPeople::located(std::size_t index, Timestamp now) {
  known_[of_people_[index]].confirmed = now;
}

}  // namespace marey::pipeline::keypoints
