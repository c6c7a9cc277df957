#include "marey/pipeline/markers/set_in_space.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/assign/no_index.h"
#include "marey/core/error.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/corridor/stopwatch.h"
#include "marey/pipeline/markers/labels_in_space.h"

namespace marey::pipeline::markers {
namespace {

using assign::kNoIndex;
using solve::labels::TrackedPoint;

constexpr double kFewestSeen = 0.4;    // of the set's markers, below which nothing is looked for; as label_recording has it
constexpr double kRememberedHz = 100;  // that points are remembered at, about
constexpr double kAgainS = 2;          // after a search, where many names are missing
constexpr double kStillFirstS = 1;     // of points, that names are looked for in first by such a set
constexpr int kStillSearches = 5;      // so many follow each other, where the set is of one who stood still
constexpr double kMostAgainS = 5;      // after a search that found nothing, at most
constexpr double kManyHeld = 0.7;      // of the names that could be
constexpr double kFewNamed = 0.6;      // of the set, on average: a doubtful set
constexpr std::size_t kFewestMarkers = 4;
constexpr std::size_t kSearchesToReport = 2;  // that found names, before a misfit is reported while cameras see

class NamedReader final : public RecordingReader {
 public:
  NamedReader(std::unique_ptr<RecordingReader> recording, std::shared_ptr<const LearnedMarkers> set, SetInSpaceOptions options)
      : recording_(std::move(recording)), named_(std::move(set), recording_->header().rate_hz, options) {
    for (const TrackName& track : recording_->tracks()) named_.name(track);
  }

  const RecordingHeader& header() const override { return recording_->header(); }
  std::vector<TrackName> tracks() const override { return {}; }  // they are other tracks
  std::optional<std::int64_t> instant_count() const override { return recording_->instant_count(); }
  std::optional<Instant> next() override {
    auto instant = recording_->next();
    if (instant) named_.add_to(*instant);
    return instant;
  }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = recording_->warnings();
    for (std::string& warning : named_.warnings()) all.push_back(std::move(warning));
    return all;
  }

 private:
  std::unique_ptr<RecordingReader> recording_;
  SetInSpace named_;
};

}  // namespace

solve::labels::LabelOptions live_label_options() {
  solve::labels::LabelOptions options;
  options.boots = 2;
  options.boot.answers = 250;
  return options;
}

SetInSpace::SetInSpace(std::shared_ptr<const LearnedMarkers> set, double rate_hz, const SetInSpaceOptions& options)
    : set_(std::move(set)),
      options_(options),
      rate_hz_(rate_hz),
      undecided_(set_->size(), 0),
      decided_(set_->size(), 0),
      id_of_name_(set_->size()),
      seen_(set_->size(), 0) {
  if (set_->size() < kFewestMarkers) throw Error("the set has {} markers; names are told from four on", set_->size());
  for (std::size_t name = 0; name < set_->size(); ++name) name_of_label_[set_->labels[name]] = static_cast<int>(name);
  if (!set_->moves) options_.first_after_s = std::max(options_.first_after_s, kStillFirstS);
  every_ = std::max<std::int64_t>(1, std::llround(rate_hz / kRememberedHz));
}

SetInSpace::~SetInSpace() {
  stop_.request_stop();
  if (searching_.valid()) searching_.wait();
}

void SetInSpace::add_to(Instant& instant) {
  const corridor::Stopwatch taken;
  for (const TrackName& track : instant.named) name(track);
  points_now_.clear();
  for (const Sample& sample : instant.samples) {
    if (sample.provenance == Provenance::predicted || sample.provenance == Provenance::solved || sample.position.isZero(0))
      continue;
    points_now_.push_back({sample.track, sample.position, fixed_name(sample.track)});
  }
  most_points_ = std::max(most_points_, points_now_.size());
  remember(instant);
  take_answer(instant.time);
  given_.clear();
  if (follower_ != nullptr) {
    const auto names = follower_->step(instant.time, points_now_);
    for (std::size_t p = 0; p < names.size(); ++p) {
      if (names[p] == kNoIndex) continue;
      if (points_now_[p].fixed == kNoIndex && undecided_[static_cast<std::size_t>(names[p])]) continue;
      given_[points_now_[p].track] = names[p];
      ++seen_[static_cast<std::size_t>(names[p])];
      ++named_;
    }
    points_ += std::ssize(points_now_);
  }
  tell(instant);
  search(instant.time);
  times_.add(taken.seconds());
}

int SetInSpace::fixed_name(TrackId track) const {
  if (!options_.names_hold) return kNoIndex;
  const auto named = names_before_.find(track);
  if (named == names_before_.end()) return kNoIndex;
  const auto found = name_of_label_.find(named->second.label);
  return found == name_of_label_.end() ? kNoIndex : found->second;
}

void SetInSpace::remember(const Instant& instant) {
  if (count_++ % every_ != 0) return;
  auto moment = std::make_shared<Moment>();
  moment->index = instant.index;
  moment->time = instant.time;
  moment->points = points_now_;
  recent_.push_back(std::move(moment));
  while (seconds(instant.time - recent_.front()->time) > options_.remembered_s) recent_.pop_front();
}

/// Begins to look for names, where there is a reason to and nobody looks.
void SetInSpace::search(Timestamp now) {
  const double least = std::max(4.0, kFewestSeen * static_cast<double>(set_->size()));
  if (static_cast<double>(points_now_.size()) < least) {
    enough_since_.reset();
    return;
  }
  if (!enough_since_) enough_since_ = now;
  if (searching_.valid() || seconds(now - *enough_since_) < options_.first_after_s) return;
  if (searches_ > 0) {
    double pause = options_.looked_anew_s;
    const std::size_t could = std::min(points_now_.size(), set_->size());
    if (follower_ == nullptr) {
      pause = std::min<double>(failures_, kMostAgainS);
    } else if (searches_ - failures_ <= (set_->moves ? 1 : kStillSearches) ||
               static_cast<double>(follower_->held()) < kManyHeld * static_cast<double>(could)) {
      pause = set_->moves ? kAgainS : 0;
    }
    if (seconds(now - searched_at_) < options_.answer_after_s + pause) return;
  }
  ++searches_;
  searched_at_ = now;
  searching_ = std::async(std::launch::async,
                          [recent = recent_, rate = rate_hz_ / static_cast<double>(every_), set = set_, options = options_,
                           stop = stop_.get_token()] { return search_in(recent, rate, *set, options, stop); });
}

SetInSpace::Searched SetInSpace::search_in(const std::deque<std::shared_ptr<const Moment>>& recent, double rate_hz,
                                           const LearnedMarkers& set, const SetInSpaceOptions& options,
                                           const std::stop_token& stop) {
  const corridor::Stopwatch taken;
  Searched searched;
  Recording recording;
  recording.header.name = "the markers seen";
  recording.header.rate_hz = rate_hz;
  Instant instant;
  for (const auto& moment : recent) {
    instant.index = moment->index;
    instant.time = moment->time;
    instant.samples.clear();
    for (const TrackedPoint& point : moment->points) {
      Sample& sample = instant.samples.emplace_back();
      sample.track = point.track;
      sample.position = point.place;
    }
    recording.add(instant);
  }
  try {
    const Hooks hooks{.progress = {}, .stop = stop, .options = {}};
    searched.found = solve::labels::find_names(recording, set, options.find, options.follow, hooks);
  } catch (const std::exception& error) {
    searched.trouble = error.what();
  }
  searched.seconds = taken.seconds();
  return searched;
}

void SetInSpace::take_answer(Timestamp now) {
  if (!searching_.valid() || seconds(now - searched_at_) < options_.answer_after_s) return;
  if (!options_.wait && searching_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Searched searched = searching_.get();
  searched_s_ = std::max(searched_s_, searched.seconds);
  if (searched.found.follower == nullptr) {
    ++failures_;
    trouble_ = searched.trouble;
    return;
  }
  if (!found_at_s_) found_at_s_ = seconds(now);
  const double names = static_cast<double>(set_->size());
  // Of a set of one who stood still, what is rigid is known the better the longer it was looked at.
  if (follower_ == nullptr || !set_->moves || static_cast<double>(follower_->held()) < kFewestSeen * names) {
    if (follower_ != nullptr) searched.found.follower->take(follower_->borne());
    follower_ = std::move(searched.found.follower);
  }
  follower_->take(searched.found.name_of);
  take_check(searched.found);
}

/// What the search's final check says of each name that it could tell something of, and of the set.
void SetInSpace::take_check(const solve::labels::FoundNames& found) {
  for (std::size_t name = 0; name < set_->size(); ++name) {
    decided_[name] = decided_[name] || (found.decided[name] && !found.undecided[name]);
    undecided_[name] = !decided_[name] && (undecided_[name] || found.undecided[name]);
  }
  misfits_.push_back(found.misfit);
  misfits_m_.push_back(found.misfit_m);
}

TrackId SetInSpace::fresh_id() {
  const TrackId id{used_.empty() ? 1 : number(*used_.rbegin()) + 1};
  used_.insert(id);
  return id;
}

/// Under what number a track is told: its own as far as nobody else has it.
TrackId SetInSpace::told_id(TrackId track, int name) {
  const auto own = told_of_.find(track);
  if (name == kNoIndex) {
    if (own != told_of_.end()) return own->second;
    const TrackId id = used_.insert(track).second ? track : fresh_id();
    told_of_.emplace(track, id);
    return id;
  }
  auto& id = id_of_name_[static_cast<std::size_t>(name)];
  if (!id && own != told_of_.end()) {  // the track's number is the name's from now on
    id = own->second;
    told_of_.erase(own);
  } else if (!id) {
    id = used_.insert(track).second ? track : fresh_id();
  }
  return *id;
}

void SetInSpace::tell(Instant& instant) {
  instant.named.clear();
  std::map<TrackId, TrackId> told;
  const auto is_idle = [&](const Sample& sample) {  // the name that it had is another's
    if (sample.provenance != Provenance::predicted || given_.contains(sample.track)) return false;
    return follower_ != nullptr && !told_of_.contains(sample.track);
  };
  std::erase_if(instant.samples, is_idle);
  for (Sample& sample : instant.samples) {
    const auto given = given_.find(sample.track);
    const int name = given == given_.end() ? kNoIndex : given->second;
    TrackName wanted{told_id(sample.track, name), {}, {}};
    if (const auto before = names_before_.find(sample.track); before != names_before_.end()) {
      wanted.team = before->second.team;
      wanted.colour = before->second.colour;
      if (options_.names_hold || !name_of_label_.contains(before->second.label)) wanted.label = before->second.label;
    }
    if (name != kNoIndex) wanted.label = set_->labels[static_cast<std::size_t>(name)];
    told[sample.track] = wanted.id;
    sample.track = wanted.id;
    const auto [known, is_new] = told_names_.try_emplace(wanted.id, wanted);
    if (is_new || !(known->second == wanted)) {
      known->second = wanted;
      instant.named.push_back(std::move(wanted));
    }
  }
  std::sort(instant.samples.begin(), instant.samples.end(), [](const Sample& a, const Sample& b) { return a.track < b.track; });
  for (SeenPoint& seen : instant.seen) {
    if (seen.track) seen.track = told.contains(*seen.track) ? std::optional(told.at(*seen.track)) : std::nullopt;
  }
  for (BoxInView& box : instant.boxes) {
    if (const auto found = told.find(box.track); found != told.end()) box.track = found->second;
  }
}

/// By the median over all searches: a short one alone may be off.
std::optional<std::string> SetInSpace::misfit() const {
  const auto found = std::count_if(seen_.begin(), seen_.end(), [](std::int64_t points) { return points > 0; });
  return set_misfit("the set", geometry::median(std::vector(misfits_)), geometry::median(std::vector(misfits_m_)),
                    static_cast<std::size_t>(found), seen_.size());
}

std::vector<std::string> SetInSpace::news() {
  if (misfit_reported_ || misfits_.size() < kSearchesToReport) return {};
  auto sentence = misfit();
  if (!sentence) return {};
  misfit_reported_ = true;
  return {std::move(*sentence)};
}

std::vector<std::string> SetInSpace::warnings() const {
  const double size = static_cast<double>(set_->size());
  if (!found_at_s_) {
    if (static_cast<double>(most_points_) < std::max(4.0, kFewestSeen * size))
      return {fmt::format("nothing was named: never more than {} markers were seen at once, of the set's {}", most_points_,
                          set_->size())};
    return {"nothing was named: " + (trouble_.empty() ? std::string("the recording ended before names were found") : trouble_)};
  }
  std::vector<std::string> said, missing;
  for (std::size_t name = 0; name < seen_.size(); ++name) {
    if (seen_[name] == 0) missing.push_back(set_->labels[name]);
  }
  if (!missing.empty()) said.push_back(fmt::format("the set's markers {} were not found", fmt::join(missing, ", ")));
  if (auto sentence = misfit()) {
    said.push_back(std::move(*sentence));
    return said;
  }
  const double frames = static_cast<double>(*std::max_element(seen_.begin(), seen_.end()));
  if (static_cast<double>(named_) < kFewNamed * size * frames)
    said.push_back(fmt::format("of the set's {} markers only {:.0f} had names at a time; is it this subject's?", set_->size(),
                               static_cast<double>(named_) / std::max(frames, 1.0)));
  return said;
}

std::unique_ptr<RecordingReader> with_set(std::unique_ptr<RecordingReader> recording, std::shared_ptr<const LearnedMarkers> set,
                                          SetInSpaceOptions options) {
  if (recording->header().frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: holds no points in space; a set's names are for markers in space", recording->header().name);
  return std::make_unique<NamedReader>(std::move(recording), std::move(set), options);
}

}  // namespace marey::pipeline::markers
