#include "marey/track/ground/offline/ground_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "marey/core/colour.h"
#include "marey/filter/human_motion.h"
#include "marey/geometry/median.h"

namespace marey::track::ground::offline {
namespace {

constexpr double bin_seconds = 0.5;
constexpr double border_seconds = 1;  // at the recording's own beginning and end tracks begin and end of themselves

/// The observed colour in half a second.
struct Bin {
  std::size_t first = 0, last = 0;       // samples, the second not included
  Vector<3> colour = Vector<3>::Zero();  // as perceived
};

Vector<3> point_of(const GroundSample& sample) {
  return perceived({.lightness = static_cast<float>(sample.colour[0]),
                    .a = static_cast<float>(sample.colour[1]),
                    .b = static_cast<float>(sample.colour[2])});
}

Vector<3> median_colour(std::span<const GroundSample> samples) {
  Vector<3> colour;
  std::array<std::vector<double>, 3> values;
  for (const GroundSample& sample : samples) {
    if (!sample.has_colour()) continue;
    const Vector<3> point = point_of(sample);
    for (int i = 0; i < 3; ++i) values[i].push_back(point[i]);
  }
  for (int i = 0; i < 3; ++i) colour[i] = geometry::median(values[i]);
  return colour;
}

std::vector<Bin> bins_of(std::span<const GroundSample> samples, std::span<const Timestamp> times) {
  std::vector<Bin> bins;
  const Duration length = duration_from_seconds(bin_seconds);
  for (std::size_t first = 0; first < samples.size();) {
    const Timestamp end = times[samples[first].instant] + length;
    std::size_t last = first;
    bool coloured = false;
    for (; last < samples.size() && times[samples[last].instant] < end; ++last) coloured |= samples[last].has_colour();
    if (coloured) bins.push_back({first, last, median_colour(samples.subspan(first, last - first))});
    first = last;
  }
  return bins;
}

class Cutter {
 public:
  Cutter(std::span<const GroundSample> samples, std::span<const Timestamp> times, const GroundCutOptions& options)
      : samples_(samples), options_(options), bins_(bins_of(samples, times)) {}

  /// The samples at which new pieces begin, in order.
  std::vector<std::size_t> cuts() {
    search(0, bins_.size());
    std::sort(cuts_.begin(), cuts_.end());
    return cuts_;
  }

 private:
  void search(std::size_t from, std::size_t to) {
    const std::optional<std::size_t> cut = best_cut(from, to);
    if (!cut) return;
    cuts_.push_back(sharpened(*cut));
    search(from, *cut);
    search(*cut, to);
  }

  /// The bin that begins the second of two pieces of [from, to).
  std::optional<std::size_t> best_cut(std::size_t from, std::size_t to) const {
    const auto min_bins = static_cast<std::size_t>(std::lround(options_.shortest / bin_seconds));
    Vector<3> all = Vector<3>::Zero();
    for (std::size_t i = from; i < to; ++i) all += bins_[i].colour;
    Vector<3> before = Vector<3>::Zero();
    std::optional<std::size_t> best;
    double best_gain = options_.certainly * options_.deviation * options_.deviation;
    for (std::size_t i = from; i < to; ++i) {
      const auto n = static_cast<double>(i - from);
      const auto m = static_cast<double>(to - i);
      // Within a track another person may have passed in front; before it begins and after it ends that is unknown.
      const std::size_t before_it = from == 0 ? 1 : min_bins, after_it = to == bins_.size() ? 1 : min_bins;
      if (i - from >= before_it && to - i >= after_it) {
        const double apart = (before / n - (all - before) / m).norm();
        const double gain = apart * apart * n * m / (n + m);
        if (apart > options_.minimum && gain > best_gain) {
          best_gain = gain;
          best = i;
        }
      }
      before += bins_[i].colour;
    }
    return best;
  }

  /// The sample nearest the true change, within the bins on either side of a cut: where what comes before looks like the bins
  /// before.
  std::size_t sharpened(std::size_t cut) const {
    const Vector<3> early = bins_[cut - 1].colour;
    const Vector<3> late = bins_[std::min(cut + 1, bins_.size() - 1)].colour;
    double sum = 0;
    double minimum = 0;
    std::size_t best = bins_[cut - 1].first + 1;
    for (std::size_t i = best; i < bins_[cut].last; ++i) {
      const GroundSample& sample = samples_[i - 1];
      if (sample.has_colour()) {
        const Vector<3> colour = point_of(sample);
        sum += (colour - early).squaredNorm() - (colour - late).squaredNorm();
      }
      if (sum > minimum) continue;
      minimum = sum;
      best = i;
    }
    return best;
  }

  std::span<const GroundSample> samples_;
  const GroundCutOptions& options_;
  std::vector<Bin> bins_;
  std::vector<std::size_t> cuts_;
};

/// Adds the pieces of a tracklet that begin at its samples `cuts`, which are in order.
void cut(GroundTracklet tracklet, const std::vector<std::size_t>& cuts, std::vector<GroundTracklet>& pieces) {
  std::vector<GroundTracklet> later;  // the last first
  for (auto from = cuts.rbegin(); from != cuts.rend(); ++from) {
    if (*from == 0 || *from >= tracklet.samples.size()) continue;
    later.push_back(split(tracklet, *from));
    tracklet.goes_on = true;
  }
  pieces.push_back(std::move(tracklet));
  std::move(later.rbegin(), later.rend(), std::back_inserter(pieces));
}

/// Where to cut these samples at `instant`, if the person they show stands near `end` then.
void cut_near(const std::vector<GroundSample>& samples, const GroundSample& end, std::int32_t instant, double near,
              std::vector<std::size_t>& cuts) {
  if (samples.front().instant >= instant || samples.back().instant < instant) return;
  const std::size_t next = index_from(samples, instant);
  const double unsure = 2 * (samples[next].spread().trace() + end.spread().trace());
  if ((samples[next].at() - end.at()).squaredNorm() > near * near + unsure) return;
  cuts.push_back(next);
}

/// Whether what both show at the same instants may be one person: near, and seen by different cameras.
bool may_be_one(std::span<const GroundSample> earlier, std::span<const GroundSample> later, double together) {
  for (const GroundSample& last : earlier) {
    const auto same =
        std::find_if(later.begin(), later.end(), [&](const GroundSample& one) { return one.instant >= last.instant; });
    if (same == later.end() || same->instant != last.instant) continue;
    const double unsure = 2 * (last.spread().trace() + same->spread().trace());
    if ((last.cameras & same->cameras) != 0 || (last.at() - same->at()).squaredNorm() > together * together + unsure) return false;
  }
  return true;
}

/// From which sample of `tracklet` on `next` shows the same person, who then continues in it.
std::optional<std::size_t> handed_over(const GroundTracklet& tracklet, const GroundTracklet& next, std::span<const Timestamp> times,
                                       const GroundCutOptions& options) {
  const std::int32_t last = tracklet.samples.back().instant, begin = next.samples.front().instant;
  if (begin > last || begin <= tracklet.samples.front().instant || next.samples.back().instant <= last) return std::nullopt;
  if (seconds(times[last] - times[begin]) > options.overlap) return std::nullopt;
  const std::size_t from = index_from(tracklet.samples, begin);
  if (!may_be_one(std::span(tracklet.samples).subspan(from), next.samples, options.together)) return std::nullopt;
  return from;
}

}  // namespace

std::vector<GroundTracklet> end_before_successors(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times,
                                                  const GroundCutOptions& options) {
  for (GroundTracklet& tracklet : tracklets) {
    for (const GroundTracklet& next : tracklets) {
      if (&next == &tracklet) continue;
      const auto from = handed_over(tracklet, next, times, options);
      if (from) split(tracklet, *from);
    }
  }
  return tracklets;
}

std::vector<GroundTracklet> cut_at_appearance_changes(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times,
                                                      const GroundCutOptions& options) {
  std::vector<GroundTracklet> pieces;
  for (GroundTracklet& tracklet : tracklets) {
    const std::vector<std::size_t> cuts = Cutter(tracklet.samples, times, options).cuts();
    cut(std::move(tracklet), cuts, pieces);
  }
  return pieces;
}

std::vector<GroundTracklet> cut_where_impossible(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times) {
  std::vector<GroundTracklet> pieces;
  std::vector<filter::TimedPosition> locations;
  for (GroundTracklet& tracklet : tracklets) {
    locations.clear();
    for (const GroundSample& sample : tracklet.samples)
      locations.push_back({seconds(times[static_cast<std::size_t>(sample.instant)]), sample.at(), sample.spread()});
    const std::vector<filter::ImpossiblePiece> wrong = filter::impossible_pieces(locations);
    std::vector<GroundTracklet> later;  // the last first
    for (auto piece = wrong.rbegin(); piece != wrong.rend(); ++piece) {
      if (piece->first == 0 || piece->last + 1 == tracklet.samples.size()) continue;
      if (!piece->one_person) {
        later.push_back(split(tracklet, piece->last + 1));
        tracklet.goes_on = false;
      }
      erase(tracklet, piece->first, piece->last + 1);
    }
    pieces.push_back(std::move(tracklet));
    std::move(later.rbegin(), later.rend(), std::back_inserter(pieces));
  }
  return pieces;
}

std::vector<GroundTracklet> cut_where_others_end(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times,
                                                 const GroundCutOptions& options) {
  if (tracklets.empty()) return tracklets;
  const Timestamp early = times.front() + duration_from_seconds(border_seconds);
  const Timestamp late = times.back() - duration_from_seconds(border_seconds);
  std::vector<std::vector<std::size_t>> cuts(tracklets.size());
  for (std::size_t ending = 0; ending < tracklets.size(); ++ending) {
    if (tracklets[ending].goes_on || (ending > 0 && tracklets[ending - 1].goes_on)) continue;
    const GroundSample& first = tracklets[ending].samples.front();
    const GroundSample& last = tracklets[ending].samples.back();
    for (std::size_t other = 0; other < tracklets.size(); ++other) {
      if (other == ending) continue;
      const std::vector<GroundSample>& samples = tracklets[other].samples;
      if (times[last.instant] < late) cut_near(samples, last, last.instant + 1, options.near, cuts[other]);
      if (times[first.instant] > early) cut_near(samples, first, first.instant, options.near, cuts[other]);
    }
  }
  std::vector<GroundTracklet> pieces;
  for (std::size_t i = 0; i < tracklets.size(); ++i) {
    std::sort(cuts[i].begin(), cuts[i].end());
    cuts[i].erase(std::unique(cuts[i].begin(), cuts[i].end()), cuts[i].end());
    cut(std::move(tracklets[i]), cuts[i], pieces);
  }
  return pieces;
}

}  // namespace marey::track::ground::offline
