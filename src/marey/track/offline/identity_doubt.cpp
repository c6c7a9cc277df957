#include "marey/track/offline/identity_doubt.h"

#include <algorithm>
#include <utility>

#include "marey/assign/disjoint_sets.h"
#include "marey/core/geometry.h"

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

constexpr int kFewestSure = 2;  // observations between two doubts: fewer say nothing of who it is

Box box_of(const TrackRow& row) {
  return {row.left, row.top, row.width, row.height};
}

/// A stretch of rows of one tracklet in doubt, both ends included.
struct Doubt {
  int first = 0, last = 0;
  int strongest = 0;    ///< the row in which others were nearest
  double overlap = -1;  ///< by how much they were
};

class DoubtFinder {
 public:
  DoubtFinder(std::span<Tracklet> tracklets, const TrackletLog& log, const DoubtOptions& options)
      : tracklets_(tracklets), log_(log), options_(options), nearest_(tracklets.size()) {
    for (int t = 0; t < std::ssize(tracklets_); ++t) {
      nearest_[t].assign(tracklets_[t].size(), -1);
      for (int k = 0; k < std::ssize(tracklets_[t]); ++k) {
        tracklets_[t][k].doubtful = false;
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
    for (Tracklet& tracklet : tracklets_) mark_unseen(tracklet);
    for (int t = 0; t < std::ssize(tracklets_); ++t) list_doubts(t);
    name_meetings();
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
      tracklets_[tracklet][row].doubtful = true;
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
        const double share = geometry::intersection(box, other).area() / std::min(box.area(), other.area());
        if (share > options_.overlap) touch(entries_[i].tracklet, entries_[i].row, entries_[j].tracklet, entries_[j].row, share);
      }
    }
  }

  void find_close_to_ends(int t) {
    const Tracklet& rows = tracklets_[t];
    find_close(t, 0, options_.after, options_.before);
    find_close(t, static_cast<int>(rows.size()) - 1, options_.before, options_.after);
  }

  /// Who is close to where a tracklet begins or ends, from `before` to `after` s of that moment.
  void find_close(int t, int end, double before, double after) {
    const TrackRow& edge = tracklets_[t][end];
    if (!edge.has_box()) return;
    const double more = options_.close * edge.height;
    const Box place{edge.left - more, edge.top - more / 2, edge.width + 2 * more, edge.height + more};
    const double now = time_of(edge);
    const auto earlier = [&](const Entry& entry, double time) { return seconds(log_.time_of(entry.frame)) < time; };
    for (auto at = std::lower_bound(entries_.begin(), entries_.end(), now - before, earlier); at != entries_.end(); ++at) {
      if (time_of(row(*at)) > now + after) break;
      if (at->tracklet == t) continue;
      const Box box = box_of(row(*at));
      const Vector<2> centre = box.centre();
      if (centre.x() < place.left || centre.x() > place.right() || centre.y() < place.top || centre.y() > place.bottom()) continue;
      touch(t, end, at->tracklet, at->row, geometry::intersection(place, box).area() / place.area());
    }
  }

  void mark_unseen(Tracklet& rows) const {
    for (std::size_t k = 0; k < rows.size();) {
      std::size_t next = k + 1;
      while (next < rows.size() && !rows[next].observed()) ++next;
      const bool long_ago = next < rows.size() && time_of(rows[next]) - time_of(rows[k]) > options_.unseen;
      for (std::size_t i = k + 1; long_ago && i < next; ++i) rows[i].doubtful = true;
      // A gap without rows, where tracklets were joined, is a doubt of the row before it.
      if (long_ago && next == k + 1 && k > 0) rows[k].doubtful = true;
      k = next;
    }
  }

  /// The rows in doubt of a tracklet, as stretches with enough that is sure between them.
  void list_doubts(int t) {
    const Tracklet& rows = tracklets_[t];
    first_doubt_.push_back(static_cast<int>(doubts_.size()));
    node_of_row_.emplace_back(rows.size(), -1);
    int sure = kFewestSure;
    for (int k = 0; k < std::ssize(rows); ++k) {
      if (!rows[k].doubtful) {
        sure += rows[k].observed();
        continue;
      }
      const bool begun = std::ssize(doubts_) > first_doubt_.back();
      if (begun && (sure < kFewestSure || time_of(rows[k]) - time_of(rows[doubts_.back().last]) < options_.parted)) {
        doubts_.back().last = k;
      } else {
        doubts_.push_back({k, k, k});
      }
      if (nearest_[t][k] > doubts_.back().overlap) {
        doubts_.back().overlap = nearest_[t][k];
        doubts_.back().strongest = k;
      }
      sure = 0;
    }
    for (int d = first_doubt_.back(); d < std::ssize(doubts_); ++d) {
      Doubt& doubt = doubts_[d];
      if (doubt.overlap < 0) doubt.strongest = (doubt.first + doubt.last) / 2;
      for (int k = doubt.first; k <= doubt.last; ++k) {
        node_of_row_.back()[k] = d;
        tracklets_[t][k].doubtful = true;
      }
    }
  }

  void name_meetings() {
    first_doubt_.push_back(static_cast<int>(doubts_.size()));
    meetings_.reset(doubts_.size());
    for (const Contact& contact : contacts_)
      meetings_.join(node_of_row_[contact.a][contact.row_a], node_of_row_[contact.b][contact.row_b]);
  }

  void part(int t, std::vector<TrackletPart>& all) {
    const Tracklet& rows = tracklets_[t];
    const auto count = static_cast<int>(rows.size());
    TrackletPart part{.tracklet = t, .first = 0, .end = count, .head_meeting = {}, .tail_meeting = {}};
    int done = 0;
    for (int d = first_doubt_[t]; d < first_doubt_[t + 1]; ++d) {
      const Doubt& doubt = doubts_[d];
      const bool at_begin = sure_between(rows, done, doubt.first) < kFewestSure;
      const bool at_end = sure_between(rows, doubt.last + 1, count) < kFewestSure;
      const int meeting = meetings_.find(d);
      done = doubt.last + 1;
      if (at_end) part.tail_meeting = meeting;
      if (at_begin) part.head_meeting = meeting;
      if (at_begin || at_end) continue;
      part.tail_meeting = meeting;
      part.end = doubt.strongest;
      all.push_back(part);
      part = {.tracklet = t, .first = doubt.strongest, .end = count, .head_meeting = meeting, .tail_meeting = {}};
    }
    all.push_back(part);
  }

  static int sure_between(const Tracklet& rows, int first, int last) {
    return static_cast<int>(std::count_if(rows.begin() + first, rows.begin() + last,
                                          [](const TrackRow& row) { return row.observed() && !row.doubtful; }));
  }

  std::span<Tracklet> tracklets_;
  const TrackletLog& log_;
  const DoubtOptions& options_;
  std::vector<Entry> entries_;                ///< by frame, then from left to right
  std::vector<std::vector<double>> nearest_;  ///< of each row: by how much another overlaps it, at most
  std::vector<Contact> contacts_;
  std::vector<Doubt> doubts_;     ///< of all tracklets, one after another
  std::vector<int> first_doubt_;  ///< of each tracklet
  std::vector<std::vector<int>> node_of_row_;
  assign::DisjointSets meetings_;  ///< of doubts
};

}  // namespace

std::vector<TrackletPart> find_parts_between_doubts(std::span<Tracklet> tracklets, const TrackletLog& log,
                                                    const DoubtOptions& options) {
  return DoubtFinder(tracklets, log, options).parts();
}

std::vector<TrackletPiece> cut_where_in_doubt(std::vector<Tracklet> tracklets, const TrackletLog& log,
                                              const DoubtOptions& options) {
  std::vector<TrackletPiece> pieces;
  for (const TrackletPart& part : find_parts_between_doubts(tracklets, log, options)) {
    Tracklet& rows = tracklets[part.tracklet];
    TrackletPiece& piece = pieces.emplace_back(TrackletPiece{{}, part.tracklet, part.head_meeting, part.tail_meeting});
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
