#include "marey/track/offline/fill_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "marey/filter/bridge.h"

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

/// What changes evenly in a gap.
constexpr std::array kEven = {&TrackRow::x,   &TrackRow::y,     &TrackRow::vx,     &TrackRow::vy,   &TrackRow::left,
                              &TrackRow::top, &TrackRow::width, &TrackRow::height, &TrackRow::score};
using EvenValues = Eigen::Matrix<double, 1, kEven.size()>;

EvenValues values_of(const TrackRow& row) {
  EvenValues values;
  for (std::size_t i = 0; i < kEven.size(); ++i) values[static_cast<Eigen::Index>(i)] = row.*kEven[i];
  return values;
}

/// A gap of one target, by a motion model.
class RowGap {
 public:
  RowGap(const TrackRow& from, double begin, const TrackRow& to, double end)
      : from_(from),
        to_(to),
        span_(end - begin),
        straight_(values_of(from), begin, values_of(to), end),
        cubic_(state_of(from), begin, state_of(to), end) {}

  TrackRow straight(std::int32_t frame, double time) const {
    TrackRow row = from_;
    row.frame = frame;
    row.provenance = Provenance::filled;
    row.has_centre = false;
    const EvenValues values = straight_.at(time);
    for (std::size_t i = 0; i < kEven.size(); ++i) row.*kEven[i] = static_cast<float>(values[static_cast<Eigen::Index>(i)]);
    return row;
  }

  /// The rest as it was guessed.
  TrackRow cubic(const TrackRow& guess, double time) const {
    TrackRow row = guess;
    const auto state = cubic_.at(time);
    row.x = static_cast<float>(state(0, 0));
    row.y = static_cast<float>(state(0, 1));
    row.vx = static_cast<float>((to_.x - from_.x) / span_);
    row.vy = static_cast<float>((to_.y - from_.y) / span_);
    row.provenance = Provenance::filled;
    row.left = row.x - (row.width - 1) / 2;
    row.top = row.y - (row.height - 1) / 2;
    return row;
  }

 private:
  /// Velocities at the ends are held to what keeps the curve between both places: a target that turned unseen has left with another
  /// velocity.
  Matrix<2> state_of(const TrackRow& row) const {
    const auto held = [&](float velocity, float rise) {
      const double maximum = 3 * std::abs(rise / span_);  // Fritsch & Carlson 1980: no overshoot
      return std::clamp<double>(velocity, -maximum, maximum);
    };
    return (Matrix<2>() << row.x, row.y, held(row.vx, to_.x - from_.x), held(row.vy, to_.y - from_.y)).finished();
  }

  const TrackRow &from_, &to_;
  double span_;
  filter::Bridge<filter::RandomWalk, kEven.size()> straight_;
  filter::Bridge<filter::WhiteAcceleration, 2> cubic_;
};

void sort_by_frame(std::vector<TrackRow>& rows) {
  std::sort(rows.begin(), rows.end(),
            [](const TrackRow& a, const TrackRow& b) { return std::pair(a.frame, a.id) < std::pair(b.frame, b.id); });
}

/// The rows of the frames between the first and the last of `rows`, which are observed; what lies between them was guessed.
void append_between(std::span<const TrackRow> rows, const TrackletLog& log, double longest, GapInterpolation method,
                    Tracklet& filled) {
  const TrackRow &from = rows.front(), &to = rows.back();
  const Timestamp begin = log.time_of(from.frame);
  const auto time_of = [&](std::int32_t frame) { return seconds(log.time_of(frame) - begin); };
  if (time_of(to.frame) > longest) return;
  const RowGap gap(from, 0, to, time_of(to.frame));
  auto guess = rows.begin();
  for (std::int32_t frame = from.frame + 1; frame < to.frame; ++frame) {
    const TrackRow straight = gap.straight(frame, time_of(frame));
    if (method == GapInterpolation::straight) {
      filled.push_back(straight);
      continue;
    }
    while (guess->frame < frame) ++guess;
    filled.push_back(gap.cubic(guess->frame == frame ? *guess : straight, time_of(frame)));
  }
}

}  // namespace

void fill_gaps(Tracklet& rows, const TrackletLog& log, double longest, GapInterpolation method) {
  Tracklet filled;
  filled.reserve(rows.empty() ? 0 : static_cast<std::size_t>(rows.back().frame - rows.front().frame + 1));
  const TrackRow* last = nullptr;
  for (const TrackRow& row : rows) {
    if (!row.observed()) continue;
    if (last != nullptr) append_between(std::span(last, &row + 1), log, longest, method, filled);
    filled.push_back(row);
    last = &row;
  }
  rows = std::move(filled);
}

std::vector<TrackRow> fill_between_searches(std::span<const TrackRow> rows, std::span<const std::int32_t> searched,
                                            std::span<const Timestamp> times) {
  std::vector<TrackRow> filled;
  std::map<std::int32_t, TrackRow> last;  // of each target; `frame` counts searched frames
  for (const TrackRow& row : rows) {
    const std::int32_t frame = searched[static_cast<std::size_t>(row.frame)];
    const auto before = last.find(row.id);
    if (before != last.end() && before->second.frame == row.frame - 1) {
      const std::int32_t begin = searched[static_cast<std::size_t>(row.frame) - 1];
      const auto time_of = [&](std::int32_t at) {
        return seconds(times[static_cast<std::size_t>(at)] - times[static_cast<std::size_t>(begin)]);
      };
      const RowGap gap(before->second, 0, row, time_of(frame));
      const bool extrapolated = before->second.provenance == Provenance::predicted || row.provenance == Provenance::predicted;
      for (std::int32_t between = begin + 1; between < frame; ++between) {
        filled.push_back(gap.straight(between, time_of(between)));
        if (extrapolated) filled.back().provenance = Provenance::predicted;
      }
    }
    last[row.id] = row;
    filled.push_back(row);
    filled.back().frame = frame;
  }
  sort_by_frame(filled);
  return filled;
}

std::vector<TrackRow> rows_of_points(TrackletLog& log, int min_detections, double longest) {
  std::vector<TrackRow> rows;
  for (TrackletLog::Tracklet& tracklet : log.take_tracklets()) {
    const auto detected = [](const TrackRow& row) { return row.observed(); };
    if (std::count_if(tracklet.begin(), tracklet.end(), detected) < min_detections) continue;
    fill_gaps(tracklet, log, longest, GapInterpolation::cubic);
    rows.insert(rows.end(), tracklet.begin(), tracklet.end());
  }
  sort_by_frame(rows);
  return rows;
}

}  // namespace marey::track::offline
