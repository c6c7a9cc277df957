// What answers to doubts mean. Rows speak of tracks as they were when the doubts were listed: where they have gone since is
// followed through the edits that were made after that, those of answers before and others. That shows what was applied already,
// too.

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/text_rows.h"
#include "marey/pipeline/identify/review.h"

namespace marey::pipeline::identify {
namespace {

using edit::Operation;

constexpr std::int64_t kToTheEnd = edit::FrameRange::kToTheEnd;
constexpr double kGoingOver = 10;  // s for which two tracks of one person are there at most

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// In which frames tracks are there, while edits are gathered.
class TrackFrames {
 public:
  explicit TrackFrames(const Recording& recording) {
    for (const TrackColumns& track : recording.tracks()) {
      std::set<std::int64_t>& frames = frames_[number(track.id())];
      for (const std::int32_t at : track.at())
        frames.insert(frames.end(), recording.instants()[static_cast<std::size_t>(at)].index);
    }
  }

  void swap(int a, int b, std::int64_t from) {
    std::set<std::int64_t> later_a = take(a, from), later_b = take(b, from);
    frames_[a].merge(later_b);
    frames_[b].merge(later_a);
  }
  void split(int track, std::int64_t from, int initiated) { frames_[initiated] = take(track, from); }
  void join(int track, int other) {
    frames_[track].merge(frames_[other]);
    frames_.erase(other);
  }
  /// Whether a track is there in this frame or later.
  bool has(int track, std::int64_t from = 0) const {
    const auto frames = frames_.find(track);
    return frames != frames_.end() && !frames->second.empty() && *frames->second.rbegin() >= from;
  }
  /// From the first to the last frame in which both are there.
  std::optional<std::pair<std::int64_t, std::int64_t>> together(int a, int b) {
    std::vector<std::int64_t> both;
    std::set_intersection(frames_[a].begin(), frames_[a].end(), frames_[b].begin(), frames_[b].end(), std::back_inserter(both));
    if (both.empty()) return std::nullopt;
    return std::pair(both.front(), both.back());
  }
  /// Whether `track` has others than these.
  bool outside(int track, const std::pair<std::int64_t, std::int64_t>& range) {
    const std::set<std::int64_t>& frames = frames_[track];
    return !frames.empty() && (*frames.begin() < range.first || *frames.rbegin() > range.second);
  }
  void remove(int track, const std::pair<std::int64_t, std::int64_t>& range) {
    std::set<std::int64_t>& frames = frames_[track];
    frames.erase(frames.lower_bound(range.first), frames.upper_bound(range.second));
  }

 private:
  std::set<std::int64_t> take(int track, std::int64_t from) {
    std::set<std::int64_t>& frames = frames_[track];
    std::set<std::int64_t> later(frames.lower_bound(from), frames.end());
    frames.erase(frames.lower_bound(from), frames.end());
    return later;
  }

  std::map<int, std::set<std::int64_t>> frames_;
};

/// Where tracks have gone since doubts were listed.
class TracksSince {
 public:
  explicit TracksSince(const take::EditHistory& history) {
    for (const take::DoneEdit& done : history.edits) {
      const bool counts = std::find(history.counting.begin(), history.counting.end(), done.edit.id) != history.counting.end();
      if (counts) done_.emplace_back(done.edit.id, done.operation);
    }
  }

  bool counts(std::int64_t edit) const {
    return edit == 0 || std::any_of(done_.begin(), done_.end(), [&](const auto& done) { return done.first == edit; });
  }
  /// The track that has now in a frame what `track` had there after `edit`.
  int now(int track, std::int64_t frame, std::int64_t edit) const {
    bool later = edit == 0;
    for (const auto& [id, operation] : done_) {
      if (later && operation) track = through(*operation, track, frame);
      later = later || id == edit;
    }
    return track;
  }
  void add(Operation operation) { done_.emplace_back(0, std::move(operation)); }

 private:
  static int through(const Operation& operation, int track, std::int64_t frame) {
    using Kind = Operation::Kind;
    const bool held = !operation.frames || operation.frames->holds(frame);
    const auto is = [&](std::size_t i) { return i < operation.tracks.size() && number(operation.tracks[i]) == track; };
    if (operation.kind == Kind::swap && held)
      return number(is(0) ? operation.tracks[1] : is(1) ? operation.tracks[0] : TrackId{track});
    if (operation.kind == Kind::split && is(0) && operation.initiated && frame >= operation.frames->first)
      return number(*operation.initiated);
    if (operation.kind == Kind::join && is(1)) return number(operation.tracks[0]);
    return track;
  }

  std::vector<std::pair<std::int64_t, std::optional<Operation>>> done_;  // those that count and those to be done, with their ids
};

class Answerer {
 public:
  Answerer(const Recording& recording, const take::EditHistory& history, const std::vector<SquadMember>& squads, TrackId initiated)
      : recording_(recording), squads_(squads), next_(number(initiated)), frames_(recording), since_(history) {
    for (const TrackColumns& track : recording.tracks()) labels_[number(track.id())] = track.name.label;
  }

  AnswerEdits edits(std::vector<ReviewItem> review_items) {
    std::erase_if(review_items, [](const ReviewItem& review_item) { return review_item.answer.empty(); });
    std::stable_sort(review_items.begin(), review_items.end(),
                     [](const ReviewItem& a, const ReviewItem& b) { return a.frame < b.frame; });
    for (const ReviewItem& review_item : review_items) {
      if (!since_.counts(review_item.edit))
        throw Error("{}: edit {}, after which this was listed, was taken back; list the doubts again", review_item.where,
                    review_item.edit);
      if (review_item.kind == "swap") apply_swap(review_item);
      if (review_item.kind == "continuity") same(review_item);
    }
    for (const ReviewItem& review_item : review_items) {  // when every other person is where they belong
      if (review_item.kind == "identity") identity(review_item);
    }
    return std::move(answered_);
  }

 private:
  void edit(const ReviewItem& review_item, std::string text) {
    answered_.edits.push_back({.text = std::move(text), .where = review_item.where});
  }

  /// The track that a row names, as "#5 7 Kane".
  int track_in(const ReviewItem& review_item, const std::string& text) const {
    const std::size_t blank = text.find(' ');
    const auto id = text.starts_with('#')
                        ? format::whole_number_of(std::string_view(text).substr(1, blank == std::string::npos ? blank : blank - 1))
                        : std::nullopt;
    if (!id)
      throw Error("{}: {} names no track, as \"#5 7 Kane\" does; leave all columns but the last one as they are", review_item.where,
                  format::shown(text));
    if (*id < 1 || *id > 1'000'000'000) fail_edited(review_item, text);
    return static_cast<int>(*id);
  }

  /// The track that has what a row names from the row's frame on.
  int now_of(const ReviewItem& review_item, const std::string& text) const {
    return since_.now(track_in(review_item, text), review_item.frame, review_item.edit);
  }

  [[noreturn]] static void fail_edited(const ReviewItem& review_item, const std::string& text) {
    throw Error("{}: the take has no track {} any longer: it was edited since; list the doubts again", review_item.where,
                format::shown(text));
  }

  /// Throws Error if the take has no such track any longer, or not after `frame`.
  void require_there(const ReviewItem& review_item, const std::string& text, int id, std::int64_t frame) const {
    const TrackColumns* track = recording_.find(TrackId{track_in(review_item, text)});
    const std::size_t blank = text.find(' ');
    if (track != nullptr && blank != std::string::npos && track->name.label != text.substr(blank + 1))
      fail_edited(review_item, text);
    if (!frames_.has(id)) fail_edited(review_item, text);
    if (!frames_.has(id, frame))
      throw Error("{}: {} is not there any longer in frame {}: the take was edited since; list the doubts again", review_item.where,
                  format::shown(text), review_item.frame);
  }

  /// Whether it is a person's, not inferred from clothing colours.
  static bool is_name(const std::string& label) { return !label.empty() && label != "keeper" && label != "referee"; }

  void apply_swap(const ReviewItem& review_item) {
    const std::string answer = lower(review_item.answer);
    if (answer == "no" || answer == "n") return;
    if (answer != "yes" && answer != "y")
      throw Error("{}: {} is no answer to whether two changed places; write yes, no or nothing", review_item.where,
                  format::shown(review_item.answer));
    if (swapped(review_item, 0) || swapped(review_item, static_cast<std::int64_t>(kOneEncounter * recording_.header.rate_hz))) {
      ++answered_.before;
      return;
    }
    const int a = now_of(review_item, review_item.a), b = now_of(review_item, review_item.b);
    require_there(review_item, review_item.a, a, review_item.frame);
    require_there(review_item, review_item.b, b, 0);
    if (a == b) throw Error("{}: names one track twice", review_item.where);
    if (before(review_item, review_item.a) != a || before(review_item, review_item.b) != b)
      throw Error("{}: the take was edited there since; list the doubts again", review_item.where);
    swap(review_item, a, b);
  }

  int before(const ReviewItem& review_item, const std::string& text) const {
    return since_.now(track_in(review_item, text), review_item.frame - 1, review_item.edit);
  }

  /// Whether the two that a row names continue as each other, from this many frames before to this many after.
  bool swapped(const ReviewItem& review_item, std::int64_t within) const {
    const int a = track_in(review_item, review_item.a), b = track_in(review_item, review_item.b);
    const std::int64_t first = review_item.frame - 1 - within, last = review_item.frame + within;
    const int a_first = since_.now(a, first, review_item.edit), b_first = since_.now(b, first, review_item.edit);
    return a_first != b_first && since_.now(a, last, review_item.edit) == b_first &&
           since_.now(b, last, review_item.edit) == a_first;
  }

  void swap(const ReviewItem& review_item, int a, int b) { swap(review_item, a, b, review_item.frame); }
  void swap(const ReviewItem& review_item, int a, int b, std::int64_t from) {
    edit(review_item, fmt::format("swap #{} #{} {}:", a, b, from));
    frames_.swap(a, b, from);
    since_.add({.kind = Operation::Kind::swap, .tracks = {TrackId{a}, TrackId{b}}, .frames = edit::FrameRange{from, kToTheEnd}});
  }

  void split(const ReviewItem& review_item, int a, const std::string& label) {
    edit(review_item, fmt::format("split #{} {}{}", a, review_item.frame, label.empty() ? "" : " " + quoted_name(label)));
    frames_.split(a, review_item.frame, next_);
    labels_[next_] = label;
    since_.add({.kind = Operation::Kind::split,
                .tracks = {TrackId{a}},
                .frames = edit::FrameRange{review_item.frame, kToTheEnd},
                .initiated = TrackId{next_}});
    ++next_;
  }

  void same(const ReviewItem& review_item) {
    const std::string answer = lower(review_item.answer);
    if (answer == "yes" || answer == "y") return;
    const int a = now_of(review_item, review_item.a);
    const bool ended = before(review_item, review_item.a) != a;
    if (answer == "no" || answer == "n") {
      if (ended) {
        ++answered_.before;
        return;
      }
      require_there(review_item, review_item.a, a, review_item.frame);
      split(review_item, a, {});
      return;
    }
    const std::string label = label_of(review_item, review_item.answer);
    const auto other = track_called(label);
    if (other == a) {
      ++answered_.before;
      return;
    }
    require_there(review_item, review_item.a, a, review_item.frame);
    if (other) {
      swap(review_item, a, *other);
    } else {
      split(review_item, a, label);
    }
  }

  void identity(const ReviewItem& review_item) {
    const std::string answer = lower(review_item.answer);
    if (answer == "no" || answer == "n") return;
    const int a = now_of(review_item, review_item.a);
    std::string meant = review_item.answer;
    if (answer == "yes" || answer == "y") {
      const std::string first = review_item.b.substr(0, review_item.b.find(';'));
      meant = first.substr(0, first.rfind(' '));
      if (meant.empty()) throw Error("{}: yes answers nothing, for no person was proposed; write a name", review_item.where);
    }
    const std::string label = label_of(review_item, meant);
    const auto other = track_called(label);
    if (other == a) {
      ++answered_.before;
      return;
    }
    if (is_name(labels_[a])) fail_edited(review_item, review_item.a);
    require_there(review_item, review_item.a, a, review_item.frame);
    if (other) {
      join(review_item, *other, a);
      return;
    }
    edit(review_item, fmt::format("rename #{} {}", a, quoted_name(label)));
    labels_[a] = label;
    const auto member = std::find_if(squads_.begin(), squads_.end(), [&](const SquadMember& one) { return one.label() == label; });
    if (member != squads_.end() && !member->team.empty())
      edit(review_item, fmt::format("team #{} {}", a, quoted_name(member->team)));
  }

  /// While one track goes over into the other both may be there for a while. Where they are there for longer, what the track had
  /// from there on was another person's.
  void join(const ReviewItem& review_item, int track, int other) {
    if (const auto both = frames_.together(track, other)) {
      const double lasting = static_cast<double>(both->second - both->first) / recording_.header.rate_hz;
      if (lasting > kGoingOver || !frames_.outside(other, *both)) {
        swap(review_item, track, other, both->first);
        return;
      }
      edit(review_item, fmt::format("delete #{} {}:{}", other, both->first, both->second));
      frames_.remove(other, *both);
    }
    edit(review_item, fmt::format("join #{} #{}", track, other));
    frames_.join(track, other);
    labels_.erase(other);
    since_.add({.kind = Operation::Kind::join, .tracks = {TrackId{track}, TrackId{other}}});
  }

  std::optional<int> track_called(const std::string& label) const {
    for (const auto& [track, called] : labels_) {
      if (called == label) return track;
    }
    return std::nullopt;
  }

  /// The label that is meant by what a person wrote: as the roster or the take has it, "Kane" or "7" for "7 Kane".
  std::string label_of(const ReviewItem& review_item, const std::string& meant) const {
    if (!squads_.empty())
      return squads_[static_cast<std::size_t>(format::match::member_called(meant, {}, squads_, review_item.where))].label();
    std::vector<std::string> found;
    for (const TrackColumns& track : recording_.tracks()) {
      const std::string label = lower(track.name.label), required = lower(meant);
      const std::size_t blank = label.find(' ');
      const bool part = blank != std::string::npos && (label.substr(0, blank) == required || label.substr(blank + 1) == required);
      if (label == required) return track.name.label;
      if (part) found.push_back(track.name.label);
    }
    if (found.size() > 1)
      throw Error("{}: {} may be {} or {}; say number and name", review_item.where, format::shown(meant), found[0], found[1]);
    if (found.empty())
      throw Error("{}: no person in the take is called {}; with --squads others can be named too", review_item.where,
                  format::shown(meant));
    return found.front();
  }

  const Recording& recording_;
  const std::vector<SquadMember>& squads_;
  int next_;
  TrackFrames frames_;
  TracksSince since_;
  std::map<int, std::string> labels_;  // of tracks, once what was gathered is done
  AnswerEdits answered_;
};

}  // namespace

AnswerEdits edits_of_answers(const std::vector<ReviewItem>& review_items, const Recording& recording,
                             const take::EditHistory& history, const std::vector<SquadMember>& squads, TrackId initiated) {
  return Answerer(recording, history, squads, initiated).edits(review_items);
}

}  // namespace marey::pipeline::identify
