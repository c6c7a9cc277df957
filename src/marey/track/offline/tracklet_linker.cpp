#include "marey/track/offline/tracklet_linker.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "marey/assign/successors.h"

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

constexpr double fit_span = 0.8;        // s of a tracklet that its end is fitted to
constexpr double clothes_span = 5;      // s of a tracklet that show what it wears at its end
constexpr double prior_speed = 0.6;     // sizes/s; the prior before two observations
constexpr double score_of_joining = 9;  // how many log-likelihoods a newcomer at just this place and time is behind
constexpr double gate = 16;             // chi-square, place and size: 4 degrees of freedom
// bench/tuning.md has the sweep of those that follow.
constexpr double kOutOfEncounter = 0.5;  // gain, at least, of one who went into a meeting and may be the one who comes out
constexpr double kAsTracked = 1;         // gain of the tracker's choice
constexpr double kStands = 0.1;         // the same at least, where no other piece claims either: the light changes clothes; unswept
constexpr double kMaxEncounter = 20;    // s
constexpr double kStep = 1, kPace = 1;  // heights, heights/s: one that comes out no farther from where it went in may be the same
constexpr double kAtBorder = 0.1;       // heights from the image's border
constexpr double kHasLeft = 3;          // gain that each end at the border costs: a person there has left, or has just come
constexpr double kUnobservedAtBorder = 0.6;  // s from which on that counts

bool is_sure(const TrackRow& row) {
  return row.observed() && !row.ambiguous;
}

/// The observations of each row's clothes while it was sure who it is.
std::vector<image::Clothes> clothes_of(std::span<const TrackRow> rows) {
  std::vector<image::Clothes> detected;
  for (const TrackRow& row : rows) {
    const image::Clothes clothes = row.clothes.unpacked();
    if (is_sure(row) && (clothes.upper || clothes.lower)) detected.push_back(clothes);
  }
  return detected;
}

image::ClothesLikelihood learned(std::span<Tracklet> tracklets, const TrackletLog& log) {
  std::vector<std::vector<image::Clothes>> detected;
  for (const TrackletPart& part : find_parts_between_ambiguities(tracklets, log))
    detected.push_back(clothes_of(std::span(tracklets[part.tracklet]).subspan(part.first, part.end - part.first)));
  return image::ClothesLikelihood(detected);
}

bool touches_border(const TrackRow& row, const Box& view) {
  const double near = kAtBorder * row.height;
  return row.has_box() && (row.left < view.left + near || row.top < view.top + near || row.left + row.width > view.right() - near ||
                           row.top + row.height > view.bottom() - near);
}

/// Where both have rows of one time, those uncertain go: first the later piece's, then the earlier's.
void append(Tracklet& whole, const Tracklet& next) {
  const auto last_sure = std::find_if(whole.rbegin(), whole.rend(), is_sure);
  auto first = next.begin();
  while (first != next.end() && first->ambiguous && last_sure != whole.rend() && first->frame <= last_sure->frame) ++first;
  while (first != next.end() && !whole.empty() && whole.back().frame >= first->frame) whole.pop_back();
  whole.insert(whole.end(), first, next.end());
}

}  // namespace

/// One end of a tracklet: a straight line through its last, or first, observations.
struct TrackletLinker::End {
  double time = 0;  // s
  Vector<2> position = Vector<2>::Zero();
  Vector<2> velocity = Vector<2>::Zero();
  double speed_variance = 0;  // per axis, (sizes/s)²
  double size = 1;            // height, or 1
  double log_width = 0;
  image::Clothes clothes;
  bool at_border = false;  // of the image
};

TrackletLinker::TrackletLinker(std::span<Tracklet> tracklets, const TrackletLog& log, const JoinOptions& options)
    : log_(log), options_(options), clothes_(learned(tracklets, log)) {}

std::vector<Tracklet> TrackletLinker::join(std::vector<Tracklet> tracklets, double longest_gap) const {
  std::vector<TrackletPiece> pieces;
  for (Tracklet& tracklet : tracklets) {
    for (TrackRow& row : tracklet) row.ambiguous = false;
    pieces.push_back({std::move(tracklet), static_cast<int>(pieces.size()), {}, {}});
  }
  return link(std::move(pieces), longest_gap);
}

std::vector<Tracklet> TrackletLinker::decide_again(std::vector<Tracklet> tracklets) const {
  return link(cut_where_in_ambiguity(std::move(tracklets), log_), options_.longest_gap);
}

std::vector<Tracklet> TrackletLinker::link(std::vector<TrackletPiece> pieces, double longest_gap) const {
  const int count = static_cast<int>(pieces.size());
  const std::vector<int> next = assign::best_successors(count, candidates(pieces, longest_gap));
  std::vector<Tracklet> joined;
  for (const std::vector<int>& chain : assign::chains_of(next)) {
    Tracklet& whole = joined.emplace_back(std::move(pieces[chain.front()].rows));
    std::size_t rows = whole.size();
    for (const int piece : std::span(chain).subspan(1)) rows += pieces[piece].rows.size();
    whole.reserve(rows);  // no spare room: rows are what grows with a match
    for (const int piece : std::span(chain).subspan(1)) {
      append(whole, pieces[piece].rows);
      Tracklet().swap(pieces[piece].rows);
    }
  }
  return joined;
}

/// A regularised line through observations, the edge's time being 0.
struct TrackletLinker::Line {
  double n = 0, t1 = 0, t2 = 0, size = 0, width = 0;
  Vector<2> x1 = Vector<2>::Zero(), xt = Vector<2>::Zero();

  void add(const TrackRow& row, double t) {
    const Vector<2> x(row.x, row.y);
    n += 1;
    t1 += t;
    t2 += t * t;
    x1 += x;
    xt += t * x;
    size += row.has_box() ? row.height : 1;
    width += row.has_box() ? std::log(row.width) : 0;
  }

  void fit(double position_noise, End& end) const {
    end.size = size / n;
    end.log_width = width / n;
    const double spread = t2 - t1 * t1 / n;
    const double noise = position_noise * position_noise / 2;
    const double regular = noise / (prior_speed * prior_speed);  // as if the target had been at rest, that surely
    end.velocity = (xt - t1 * x1 / n) / (spread + regular);
    end.speed_variance = noise / (spread + regular);
    end.position = x1 / n - end.velocity * (t1 / n);
  }
};

/// Of the observed rows of the last, or first, `fit_span` seconds. Rows uncertain count only where there are no others.
TrackletLinker::End TrackletLinker::end_of(const TrackletPiece& piece, bool tail) const {
  const Tracklet& rows = piece.rows;
  const bool any_sure = std::any_of(rows.begin(), rows.end(), is_sure);
  const TrackRow& edge = tail ? rows.back() : rows.front();
  std::optional<double> time;
  Line line;
  std::vector<image::Clothes> clothes;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const TrackRow& row = tail ? rows[rows.size() - 1 - k] : rows[k];
    if (any_sure ? !is_sure(row) : !row.observed()) continue;
    if (!time) time = time_of(row);
    const double t = time_of(row) - *time;
    if (std::abs(t) > clothes_span) break;
    if (any_sure) clothes.push_back(row.clothes.unpacked());
    if (std::abs(t) <= fit_span) line.add(row, t);
  }
  if (!time) line.add(edge, 0);
  End end;
  end.time = time.value_or(time_of(edge));
  line.fit(options_.position_noise, end);
  end.clothes = image::mean_clothes(clothes);
  end.at_border = options_.view && touches_border(log_.in_view(edge), *options_.view);
  return end;
}

std::vector<assign::GatedPair> TrackletLinker::candidates(std::span<const TrackletPiece> pieces, double longest_gap) const {
  std::vector<End> heads, tails;
  for (const TrackletPiece& piece : pieces) {
    heads.push_back(end_of(piece, false));
    tails.push_back(end_of(piece, true));
  }
  const double longest = std::max(longest_gap, kMaxEncounter);
  const auto gap = [&](int tail, int head) { return heads[head].time - tails[tail].time; };
  std::vector<assign::GatedPair> pairs = assign::successor_pairs(tails, heads, longest, [&](int tail, int head) {
    const Passage passage = passage_of(pieces, tail, head);
    const bool possible = passage != Passage::apart || gap(tail, head) <= longest_gap;
    return possible ? std::optional(score_of(tails[tail], heads[head], passage)) : std::nullopt;
  });
  for (int tail = 0; tail + 1 < static_cast<int>(pieces.size()); ++tail) {  // who walked together for long
    const bool as_tracked = passage_of(pieces, tail, tail + 1) == Passage::as_tracked;
    if (!as_tracked || gap(tail, tail + 1) <= longest) continue;
    const double merit = score_of(tails[tail], heads[tail + 1], Passage::as_tracked);
    if (merit > 0) pairs.push_back({tail, tail + 1, merit});
  }
  return pairs;
}

TrackletLinker::Passage TrackletLinker::passage_of(std::span<const TrackletPiece> pieces, int tail, int head) {
  const TrackletPiece& from = pieces[tail];
  const TrackletPiece& to = pieces[head];
  if (!from.tail_encounter || from.tail_encounter != to.head_encounter) return Passage::apart;
  return head == tail + 1 && from.tracklet == to.tracklet ? Passage::as_tracked : Passage::through_encounter;
}

/// Place, motion and size, then clothes; 0 or less where it is out of the question.
double TrackletLinker::score_of(const End& tail, const End& head, Passage passage) const {
  double merit = gain(tail, head);
  const double gap = head.time - tail.time;
  if (passage != Passage::apart) {
    const double distance = (head.position - tail.position).norm() / std::sqrt(tail.size * head.size);
    if (passage == Passage::as_tracked || distance < kStep + kPace * gap) merit = std::max(merit, kOutOfEncounter);
  }
  if (passage == Passage::as_tracked)
    merit += kAsTracked;
  else if (gap > kUnobservedAtBorder)
    merit -= kHasLeft * (static_cast<int>(tail.at_border) + static_cast<int>(head.at_border));
  if (merit > 0) merit += clothes_.log_ratio(tail.clothes, head.clothes);
  return passage == Passage::as_tracked ? std::max(merit, kStands) : merit;
}

/// Logarithm of how much likelier it is that one target made both ends than that one left and another came, by place, motion and
/// size; 0 where it cannot be.
double TrackletLinker::gain(const End& tail, const End& head) const {
  const double gap = head.time - tail.time;
  const double size = std::sqrt(tail.size * head.size);
  const double weight_sum = 1 / tail.speed_variance + 1 / head.speed_variance;
  const Vector<2> velocity = (tail.velocity / tail.speed_variance + head.velocity / head.speed_variance) / weight_sum;
  const Vector<2> residual = (head.position - tail.position - gap * velocity) / size;
  const double strayed = options_.speed_noise * gap;
  const double variance = options_.position_noise * options_.position_noise + strayed * strayed / 2 + gap * gap / weight_sum;
  const double rotated = (head.velocity - tail.velocity).squaredNorm() / (size * size) /
                         (tail.speed_variance + head.speed_variance + 2 * options_.speed_noise * options_.speed_noise);
  const double grown = (std::log(head.size / tail.size)) / options_.size_noise;
  const double widened = (head.log_width - tail.log_width) / (2 * options_.size_noise);
  const double distance = residual.squaredNorm() / variance + grown * grown + widened * widened;
  if (distance > gate) return 0;
  const double scale = options_.position_noise * options_.position_noise;
  return (score_of_joining - distance - rotated / 2 - std::log(variance / scale) - gap / 2) / 2;
}

}  // namespace marey::track::offline
