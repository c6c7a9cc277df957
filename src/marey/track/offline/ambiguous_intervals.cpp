#include "marey/track/offline/ambiguous_intervals.h"

#include <algorithm>
#include <utility>

#include "marey/assign/disjoint_sets.h"
#include "marey/core/geometry.h"

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

constexpr int kMinSure = 2;  // observations between two doubts: fewer say nothing of who it is

Box box_of(const TrackRow& row) {
  return {row.left, row.top, row.width, row.height};
}

/// A segment of rows of one tracklet uncertain, both ends included.
struct AmbiguousInterval {
  int first = 0, last = 0;
  int strongest = 0;    ///< the row in which others were nearest
  double overlap = -1;  ///< by how much they were
};

class AmbiguityFinder {
 public:
  AmbiguityFinder(std::span<Tracklet> tracklets, const TrackletLog& log, const AmbiguityOptions& options)
      : tracklets_(tracklets), log_(log), options_(options), nearest_(tracklets.size()) {
    for (int t = 0; t < std::ssize(tracklets_); ++t) {
      nearest_[t].assign(tracklets_[t].size(), -1);
      for (int k = 0; k < std::ssize(tracklets_[t]); ++k) {
        tracklets_[t][k].ambiguous = false;
        if (tracklets_[t][k].has_box()) entries_.push_back({tracklets_[t][k].frame, t, k});
      }
    }
    std::sort(entries_.begin(), entries_.end(), [&](const Entry& a, const Entry& b) {
      if (a.frame != b.frame) return a.frame < b.frame;
      const float left_a = row(a).left, left_b = row(b).left;
      return left_a != left_b ? left_a < left_b : a.tracklet < b.tracklet;
    });
  }

  std::vector<TrackletPart> parts() {
    find_overlaps();
    for (int t = 0; t < std::ssize(tracklets_); ++t) find_close_to_ends(t);
    for (Tracklet& tracklet : tracklets_) mark_unobserved(tracklet);
    for (int t = 0; t < std::ssize(tracklets_); ++t) list_intervals(t);
    name_encounters();
    std::vector<TrackletPart> all;
    for (int t = 0; t < std::ssize(tracklets_); ++t) part(t, all);
    return all;
  }

 private:
  struct Entry {
    std::int32_t frame = 0;
    int tracklet = 0, row = 0;
  };
  struct Contact {
    int a = 0, row_a = 0, b = 0, row_b = 0;
  };

  TrackRow& row(const Entry& entry) { return tracklets_[entry.tracklet][entry.row]; }
  double time_of(const TrackRow& row) const { return seconds(log_.time_of(row.frame)); }

  void touch(int a, int row_a, int b, int row_b, double overlap) {
    contacts_.push_back({a, row_a, b, row_b});
    const auto note = [&](int tracklet, int row) {
      tracklets_[tracklet][row].ambiguous = true;
      nearest_[tracklet][row] = std::max(nearest_[tracklet][row], overlap);
    };
    note(a, row_a);
    note(b, row_b);
  }

  /// In each frame by a sweep from left to right.
  void find_overlaps() {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const Box box = box_of(row(entries_[i]));
      for (std::size_t j = i + 1; j < entries_.size() && entries_[j].frame == entries_[i].frame; ++j) {
        const Box other = box_of(row(entries_[j]));
        if (other.left >= box.right()) break;
        const double fraction = geometry::intersection(box, other).area() / std::min(box.area(), other.area());
        if (fraction > options_.overlap)
          touch(entries_[i].tracklet, entries_[i].row, entries_[j].tracklet, entries_[j].row, fraction);
      }
    }
  }

  void find_close_to_ends(int t) {
    const Tracklet& rows = tracklets_[t];
    find_close(t, 0, options_.after, options_.before);
    find_close(t, static_cast<int>(rows.size()) - 1, options_.before, options_.after);
  }

  /// Who is close to where a tracklet begins or ends, from `before` to `after` s of that instant.
  void find_close(int t, int end, double before, double after) {
    const TrackRow& edge = tracklets_[t][end];
    if (!edge.has_box()) return;
    const double more = options_.close * edge.height;
    const Box location{edge.left - more, edge.top - more / 2, edge.width + 2 * more, edge.height + more};
    const double now = time_of(edge);
    const auto earlier = [&](const Entry& entry, double time) { return seconds(log_.time_of(entry.frame)) < time; };
    for (auto at = std::lower_bound(entries_.begin(), entries_.end(), now - before, earlier); at != entries_.end(); ++at) {
      if (time_of(row(*at)) > now + after) break;
      if (at->tracklet == t) continue;
      const Box box = box_of(row(*at));
      const Vector<2> centre = box.centre();
      if (centre.x() < location.left || centre.x() > location.right() || centre.y() < location.top ||
          centre.y() > location.bottom())
        continue;
      touch(t, end, at->tracklet, at->row, geometry::intersection(location, box).area() / location.area());
    }
  }

  void mark_unobserved(Tracklet& rows) const {
    for (std::size_t k = 0; k < rows.size();) {
      std::size_t next = k + 1;
      while (next < rows.size() && !rows[next].observed()) ++next;
      const bool long_ago = next < rows.size() && time_of(rows[next]) - time_of(rows[k]) > options_.unobserved;
      for (std::size_t i = k + 1; long_ago && i < next; ++i) rows[i].ambiguous = true;
      // A gap without rows, where tracklets were joined, is a doubt of the row before it.
      if (long_ago && next == k + 1 && k > 0) rows[k].ambiguous = true;
      k = next;
    }
  }

  /// The rows uncertain of a tracklet, as segments with enough that is sure between them.
  void list_intervals(int t) {
    const Tracklet& rows = tracklets_[t];
    first_interval_.push_back(static_cast<int>(intervals_.size()));
    interval_of_row_.emplace_back(rows.size(), -1);
    int sure = kMinSure;
    for (int k = 0; k < std::ssize(rows); ++k) {
      if (!rows[k].ambiguous) {
        sure += rows[k].observed();
        continue;
      }
      const bool begun = std::ssize(intervals_) > first_interval_.back();
      if (begun && (sure < kMinSure || time_of(rows[k]) - time_of(rows[intervals_.back().last]) < options_.parted)) {
        intervals_.back().last = k;
      } else {
        intervals_.push_back({k, k, k});
      }
      if (nearest_[t][k] > intervals_.back().overlap) {
        intervals_.back().overlap = nearest_[t][k];
        intervals_.back().strongest = k;
      }
      sure = 0;
    }
    for (int d = first_interval_.back(); d < std::ssize(intervals_); ++d) {
      AmbiguousInterval& interval = intervals_[d];
      if (interval.overlap < 0) interval.strongest = (interval.first + interval.last) / 2;
      for (int k = interval.first; k <= interval.last; ++k) {
        interval_of_row_.back()[k] = d;
        tracklets_[t][k].ambiguous = true;
      }
    }
  }

  void name_encounters() {
    first_interval_.push_back(static_cast<int>(intervals_.size()));
    encounters_.reset(intervals_.size());
    for (const Contact& contact : contacts_)
      encounters_.join(interval_of_row_[contact.a][contact.row_a], interval_of_row_[contact.b][contact.row_b]);
  }

  void part(int t, std::vector<TrackletPart>& all) {
    const Tracklet& rows = tracklets_[t];
    const auto count = static_cast<int>(rows.size());
    TrackletPart part{.tracklet = t, .first = 0, .end = count, .head_encounter = {}, .tail_encounter = {}};
    int done = 0;
    for (int d = first_interval_[t]; d < first_interval_[t + 1]; ++d) {
      const AmbiguousInterval& interval = intervals_[d];
      const bool at_begin = sure_between(rows, done, interval.first) < kMinSure;
      const bool at_end = sure_between(rows, interval.last + 1, count) < kMinSure;
      const int encounter = encounters_.find(d);
      done = interval.last + 1;
      if (at_end) part.tail_encounter = encounter;
      if (at_begin) part.head_encounter = encounter;
      if (at_begin || at_end) continue;
      part.tail_encounter = encounter;
      part.end = interval.strongest;
      all.push_back(part);
      part = {.tracklet = t, .first = interval.strongest, .end = count, .head_encounter = encounter, .tail_encounter = {}};
    }
    all.push_back(part);
  }

  static int sure_between(const Tracklet& rows, int first, int last) {
    return static_cast<int>(std::count_if(rows.begin() + first, rows.begin() + last,
                                          [](const TrackRow& row) { return row.observed() && !row.ambiguous; }));
  }

  std::span<Tracklet> tracklets_;
  const TrackletLog& log_;
  const AmbiguityOptions& options_;
  std::vector<Entry> entries_;                ///< by frame, then from left to right
  std::vector<std::vector<double>> nearest_;  ///< of each row: by how much another overlaps it, at most
  std::vector<Contact> contacts_;
  std::vector<AmbiguousInterval> intervals_;  ///< of all tracklets, one after another
  std::vector<int> first_interval_;           ///< of each tracklet
  std::vector<std::vector<int>> interval_of_row_;
  assign::DisjointSets encounters_;  ///< of doubts
};

}  // namespace

std::vector<TrackletPart> find_parts_between_ambiguities(std::span<Tracklet> tracklets, const TrackletLog& log,
                                                         const AmbiguityOptions& options) {
  return AmbiguityFinder(tracklets, log, options).parts();
}

std::vector<TrackletPiece> cut_where_in_ambiguity(std::vector<Tracklet> tracklets, const TrackletLog& log,
                                                  const AmbiguityOptions& options) {
  std::vector<TrackletPiece> pieces;
  for (const TrackletPart& part : find_parts_between_ambiguities(tracklets, log, options)) {
    Tracklet& rows = tracklets[part.tracklet];
    TrackletPiece& piece = pieces.emplace_back(TrackletPiece{{}, part.tracklet, part.head_encounter, part.tail_encounter});
    const bool last = part.end == std::ssize(rows);
    if (last && part.first == 0)
      piece.rows = std::move(rows);
    else
      piece.rows.assign(rows.begin() + part.first, rows.begin() + part.end);
    if (last) Tracklet().swap(rows);
  }
  return pieces;
}

}  // namespace marey::track::offline
