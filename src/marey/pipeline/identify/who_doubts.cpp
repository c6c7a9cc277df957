#include "marey/pipeline/identify/who_doubts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/format/csv_table.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::pipeline::identify {
namespace {

using format::match::clock_of_seconds;
using track::ground::offline::GroundIdentities;

constexpr double kShortestUnnamed = 2;  // s; who is there for less is not asked for
constexpr std::size_t kMostCandidates = 3;
constexpr double kLeastCandidate = 0.05;

class Doubter {
 public:
  Doubter(const GroundIdentities& found, const TrackedPeople& people, const NamedPaths& named, const Recording& recording,
          const std::vector<SquadMember>& squads)
      : found_(found), people_(people), named_(named), recording_(recording), squads_(squads) {}

  std::vector<Doubt> doubts(double least) {
    for (const GroundIdentities::Meeting& meeting : found_.meetings) {
      if (meeting.probability >= least) add_exchange(meeting);
    }
    for (const GroundIdentities::Link& link : found_.links) {
      if (link.probability >= least) add_same(link);
    }
    for (std::size_t path = 0; path < found_.paths.size(); ++path) {
      if (found_.paths[path].name < 0) add_who(static_cast<int>(path), least);
    }
    std::stable_sort(doubts_.begin(), doubts_.end(), [](const Doubt& a, const Doubt& b) { return a.probability > b.probability; });
    return std::move(doubts_);
  }

 private:
  const GroundIdentities::Stretch& stretch(int index) const { return found_.stretches[static_cast<std::size_t>(index)]; }
  double time_of(std::int32_t instant) const { return recording_.seconds_at(static_cast<std::size_t>(instant)); }
  std::int64_t frame_of(std::int32_t instant) const { return recording_.instants()[static_cast<std::size_t>(instant)].index; }

  /// "7 Kane", or "#41" for one without a name.
  std::string person(int path) const {
    const int name = found_.paths[static_cast<std::size_t>(path)].name;
    if (name >= 0) return squads_[static_cast<std::size_t>(name)].label();
    return fmt::format("#{}", number(*named_.tracks[static_cast<std::size_t>(path)]));
  }
  /// "#5 7 Kane".
  std::string track(int path) const {
    const std::string id = fmt::format("#{}", number(*named_.tracks[static_cast<std::size_t>(path)]));
    return found_.paths[static_cast<std::size_t>(path)].name >= 0 ? id + " " + person(path) : id;
  }
  std::string place(int stretch_index, std::int32_t instant) const {
    const auto& samples = people_.tracklets[static_cast<std::size_t>(stretch(stretch_index).tracklet)].samples;
    const std::size_t i = std::min(track::ground::offline::index_from(samples, instant), samples.size() - 1);
    return fmt::format("{} near ({:.0f}, {:.0f}) m", clock_of_seconds(time_of(instant)), samples[i].at().x(), samples[i].at().y());
  }
  bool has_track(int path) const { return named_.tracks[static_cast<std::size_t>(path)].has_value(); }
  bool is_named(int path) const { return found_.paths[static_cast<std::size_t>(path)].name >= 0; }

  void add_exchange(const GroundIdentities::Meeting& meeting) {
    int a = stretch(meeting.before_a).path, b = stretch(meeting.before_b).path;
    if (a == b || !has_track(a) || !has_track(b) || (!is_named(a) && !is_named(b))) return;
    if (!is_named(a)) std::swap(a, b);
    Doubt doubt{
        .time_s = time_of(meeting.instant),
        .kind = "exchange",
        .question = fmt::format("{}: did {} and {} change places?", place(meeting.before_a, meeting.instant), person(a), person(b)),
        .a = track(a),
        .b = track(b),
        .frame = frame_of(meeting.instant),
        .probability = meeting.probability};
    for (Doubt& other : doubts_) {
      const bool same_two = (other.a == doubt.a && other.b == doubt.b) || (other.a == doubt.b && other.b == doubt.a);
      if (!same_two || std::abs(other.time_s - doubt.time_s) > kOneMeeting) continue;
      if (doubt.probability > other.probability) other = doubt;
      return;
    }
    doubts_.push_back(std::move(doubt));
  }

  void add_same(const GroundIdentities::Link& link) {
    const int path = stretch(link.after).path;
    if (path != stretch(link.before).path || !has_track(path) || !is_named(path)) return;
    const std::int32_t instant = stretch(link.after).first;
    doubts_.push_back({.time_s = time_of(instant),
                       .kind = "same",
                       .question = fmt::format("{}: is this still {}, who was lost at {}?", place(link.after, instant),
                                               person(path), clock_of_seconds(time_of(stretch(link.before).last))),
                       .a = track(path),
                       .b = {},
                       .frame = frame_of(instant),
                       .probability = link.probability});
  }

  /// Whether somebody of the roster was not named at all.
  bool somebody_missing() const {
    std::vector<bool> named(squads_.size(), false);
    for (const GroundIdentities::Path& path : found_.paths) {
      if (path.name >= 0) named[static_cast<std::size_t>(path.name)] = true;
    }
    return std::find(named.begin(), named.end(), false) != named.end();
  }

  /// That nobody of the roster is there is wrong where it is one of those named, and taken for wrong while one of them is not.
  void add_who(int path, double least) {
    const std::vector<int>& stretches = found_.paths[static_cast<std::size_t>(path)].stretches;
    const std::int32_t first = stretch(stretches.front()).first, last = stretch(stretches.back()).last;
    if (!has_track(path) || named_.known_s[static_cast<std::size_t>(path)] < kShortestUnnamed || last <= first) return;
    std::vector<std::string> names;
    double somebody = 0;
    for (const GroundIdentities::Candidate& candidate : found_.candidates) {
      if (candidate.path != path) continue;
      somebody += candidate.probability;
      if (candidate.probability < kLeastCandidate || names.size() == kMostCandidates) continue;
      names.push_back(fmt::format("{} {:.2f}", squads_[static_cast<std::size_t>(candidate.name)].label(), candidate.probability));
    }
    if (somebody_missing()) somebody = 1;
    if (somebody < least) return;
    const std::string likeliest = names.empty() ? "" : names.front().substr(0, names.front().rfind(' '));
    const std::string asked = names.empty()
                                  ? fmt::format("who is #{}", number(*named_.tracks[static_cast<std::size_t>(path)]))
                                  : fmt::format("is #{} {}", number(*named_.tracks[static_cast<std::size_t>(path)]), likeliest);
    doubts_.push_back({.time_s = time_of(first),
                       .kind = "who",
                       .question = fmt::format("{}: {}, there until {}?", place(stretches.front(), first), asked,
                                               clock_of_seconds(time_of(last))),
                       .a = track(path),
                       .b = fmt::format("{}", fmt::join(names, "; ")),
                       .frame = frame_of(first),
                       .probability = somebody});
  }

  const GroundIdentities& found_;
  const TrackedPeople& people_;
  const NamedPaths& named_;
  const Recording& recording_;
  const std::vector<SquadMember>& squads_;
  std::vector<Doubt> doubts_;
};

double number_in(const format::CsvTable::Row& row, const std::string& column) {
  const auto value = format::number_of(row.text(column));
  if (!value || *value < 0 || *value > 1e9)
    throw Error("{}: {} is no {}; leave all columns but the last one as they are", row.where(), format::shown(row.text(column)),
                column);
  return *value;
}

}  // namespace

std::vector<Doubt> doubts_of(const GroundIdentities& found, const TrackedPeople& people, const NamedPaths& named,
                             const Recording& recording, const std::vector<SquadMember>& squads, double least) {
  return Doubter(found, people, named, recording, squads).doubts(least);
}

std::string doubts_csv(const std::vector<Doubt>& doubts) {
  using format::quoted_field;
  std::string text = "time,kind,question,a,b,frame,probability,edit,answer\n";
  for (const Doubt& doubt : doubts)
    text += fmt::format("{:.2f},{},{},{},{},{},{:.2f},{},{}\n", doubt.time_s, doubt.kind, quoted_field(doubt.question),
                        quoted_field(doubt.a), quoted_field(doubt.b), doubt.frame, doubt.probability, doubt.edit,
                        quoted_field(doubt.answer));
  return text;
}

std::vector<Doubt> parse_doubts(std::string_view text, const std::string& name) {
  const format::CsvTable table(text, name, {"time", "kind", "a", "b", "frame", "edit", "answer"}, {"question", "probability"});
  std::vector<Doubt> doubts;
  for (const format::CsvTable::Row& row : table.rows()) {
    Doubt doubt{.time_s = number_in(row, "time"),
                .kind = row.text("kind"),
                .question = row.text("question"),
                .a = row.text("a"),
                .b = row.text("b"),
                .frame = static_cast<std::int64_t>(number_in(row, "frame")),
                .edit = static_cast<std::int64_t>(number_in(row, "edit")),
                .answer = row.text("answer"),
                .where = row.where()};
    if (doubt.kind != "exchange" && doubt.kind != "same" && doubt.kind != "who")
      throw Error("{}: {} is no kind of doubt; exchange, same and who are", row.where(), format::shown(doubt.kind));
    doubts.push_back(std::move(doubt));
  }
  return doubts;
}

std::vector<Doubt> read_doubts(const std::string& path) {
  return parse_doubts(format::read_file(path), path);
}

}  // namespace marey::pipeline::identify
