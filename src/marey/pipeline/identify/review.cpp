#include "marey/pipeline/identify/review.h"

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

constexpr double kMinUnnamed = 2;  // s; a person there for less is not asked for
constexpr std::size_t kMaxCandidates = 3;
constexpr double kMinCandidate = 0.05;

class ReviewBuilder {
 public:
  ReviewBuilder(const GroundIdentities& found, const TrackedPeople& people, const NamedPaths& named, const Recording& recording,
                const std::vector<SquadMember>& squads)
      : found_(found), people_(people), named_(named), recording_(recording), squads_(squads) {}

  std::vector<ReviewItem> review_items(double minimum) {
    for (const GroundIdentities::CloseEncounter& close_encounter : found_.close_encounters) {
      if (close_encounter.probability >= minimum) add_swap(close_encounter);
    }
    for (const GroundIdentities::Link& link : found_.links) {
      if (link.probability >= minimum) add_same(link);
    }
    for (std::size_t path = 0; path < found_.paths.size(); ++path) {
      if (found_.paths[path].name < 0) add_identify(static_cast<int>(path), minimum);
    }
    std::stable_sort(review_items_.begin(), review_items_.end(),
                     [](const ReviewItem& a, const ReviewItem& b) { return a.probability > b.probability; });
    return std::move(review_items_);
  }

 private:
  const GroundIdentities::TimeChunk& segment(int index) const { return found_.segments[static_cast<std::size_t>(index)]; }
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
  std::string location(int stretch_index, std::int32_t instant) const {
    const auto& samples = people_.tracklets[static_cast<std::size_t>(segment(stretch_index).tracklet)].samples;
    const std::size_t i = std::min(track::ground::offline::index_from(samples, instant), samples.size() - 1);
    return fmt::format("{} near ({:.0f}, {:.0f}) m", clock_of_seconds(time_of(instant)), samples[i].at().x(), samples[i].at().y());
  }
  bool has_track(int path) const { return named_.tracks[static_cast<std::size_t>(path)].has_value(); }
  bool is_named(int path) const { return found_.paths[static_cast<std::size_t>(path)].name >= 0; }

  void add_swap(const GroundIdentities::CloseEncounter& close_encounter) {
    int a = segment(close_encounter.before_a).path, b = segment(close_encounter.before_b).path;
    if (a == b || !has_track(a) || !has_track(b) || (!is_named(a) && !is_named(b))) return;
    if (!is_named(a)) std::swap(a, b);
    ReviewItem review_item{
        .time_s = time_of(close_encounter.instant),
        .kind = "exchange",
        .question = fmt::format("{}: did {} and {} change places?", location(close_encounter.before_a, close_encounter.instant),
                                person(a), person(b)),
        .a = track(a),
        .b = track(b),
        .frame = frame_of(close_encounter.instant),
        .probability = close_encounter.probability};
    for (ReviewItem& other : review_items_) {
      const bool same_two =
          (other.a == review_item.a && other.b == review_item.b) || (other.a == review_item.b && other.b == review_item.a);
      if (!same_two || std::abs(other.time_s - review_item.time_s) > kOneEncounter) continue;
      if (review_item.probability > other.probability) other = review_item;
      return;
    }
    review_items_.push_back(std::move(review_item));
  }

  void add_same(const GroundIdentities::Link& link) {
    const int path = segment(link.after).path;
    if (path != segment(link.before).path || !has_track(path) || !is_named(path)) return;
    const std::int32_t instant = segment(link.after).first;
    review_items_.push_back({.time_s = time_of(instant),
                             .kind = "same",
                             .question = fmt::format("{}: is this still {}, who was lost at {}?", location(link.after, instant),
                                                     person(path), clock_of_seconds(time_of(segment(link.before).last))),
                             .a = track(path),
                             .b = {},
                             .frame = frame_of(instant),
                             .probability = link.probability});
  }

  /// Whether a person of the roster was not named at all.
  bool person_missing() const {
    std::vector<bool> named(squads_.size(), false);
    for (const GroundIdentities::Path& path : found_.paths) {
      if (path.name >= 0) named[static_cast<std::size_t>(path.name)] = true;
    }
    return std::find(named.begin(), named.end(), false) != named.end();
  }

  /// That no person of the roster is there is wrong where it is one of those named, and taken for wrong while one of them is not.
  void add_identify(int path, double minimum) {
    const std::vector<int>& segments = found_.paths[static_cast<std::size_t>(path)].segments;
    const std::int32_t first = segment(segments.front()).first, last = segment(segments.back()).last;
    if (!has_track(path) || named_.known_s[static_cast<std::size_t>(path)] < kMinUnnamed || last <= first) return;
    std::vector<std::string> names;
    double any_person = 0;
    for (const GroundIdentities::Candidate& candidate : found_.candidates) {
      if (candidate.path != path) continue;
      any_person += candidate.probability;
      if (candidate.probability < kMinCandidate || names.size() == kMaxCandidates) continue;
      names.push_back(fmt::format("{} {:.2f}", squads_[static_cast<std::size_t>(candidate.name)].label(), candidate.probability));
    }
    if (person_missing()) any_person = 1;
    if (any_person < minimum) return;
    const std::string likeliest = names.empty() ? "" : names.front().substr(0, names.front().rfind(' '));
    const std::string requested = names.empty()
                                      ? fmt::format("who is #{}", number(*named_.tracks[static_cast<std::size_t>(path)]))
                                      : fmt::format("is #{} {}", number(*named_.tracks[static_cast<std::size_t>(path)]), likeliest);
    review_items_.push_back({.time_s = time_of(first),
                             .kind = "who",
                             .question = fmt::format("{}: {}, there until {}?", location(segments.front(), first), requested,
                                                     clock_of_seconds(time_of(last))),
                             .a = track(path),
                             .b = fmt::format("{}", fmt::join(names, "; ")),
                             .frame = frame_of(first),
                             .probability = any_person});
  }

  const GroundIdentities& found_;
  const TrackedPeople& people_;
  const NamedPaths& named_;
  const Recording& recording_;
  const std::vector<SquadMember>& squads_;
  std::vector<ReviewItem> review_items_;
};

double number_in(const format::CsvTable::Row& row, const std::string& column) {
  const auto value = format::number_of(row.text(column));
  if (!value || *value < 0 || *value > 1e9)
    throw Error("{}: {} is no {}; leave all columns but the last one as they are", row.where(), format::shown(row.text(column)),
                column);
  return *value;
}

}  // namespace

std::vector<ReviewItem> review_items_of(const GroundIdentities& found, const TrackedPeople& people, const NamedPaths& named,
                                        const Recording& recording, const std::vector<SquadMember>& squads, double minimum) {
  return ReviewBuilder(found, people, named, recording, squads).review_items(minimum);
}

std::string review_csv(const std::vector<ReviewItem>& review_items) {
  using format::quoted_field;
  std::string text = "time,kind,question,a,b,frame,probability,edit,answer\n";
  for (const ReviewItem& review_item : review_items)
    text += fmt::format("{:.2f},{},{},{},{},{},{:.2f},{},{}\n", review_item.time_s, review_item.kind,
                        quoted_field(review_item.question), quoted_field(review_item.a), quoted_field(review_item.b),
                        review_item.frame, review_item.probability, review_item.edit, quoted_field(review_item.answer));
  return text;
}

std::vector<ReviewItem> parse_review_items(std::string_view text, const std::string& name) {
  const format::CsvTable table(text, name, {"time", "kind", "a", "b", "frame", "edit", "answer"}, {"question", "probability"});
  std::vector<ReviewItem> review_items;
  for (const format::CsvTable::Row& row : table.rows()) {
    ReviewItem review_item{.time_s = number_in(row, "time"),
                           .kind = row.text("kind"),
                           .question = row.text("question"),
                           .a = row.text("a"),
                           .b = row.text("b"),
                           .frame = static_cast<std::int64_t>(number_in(row, "frame")),
                           .edit = static_cast<std::int64_t>(number_in(row, "edit")),
                           .answer = row.text("answer"),
                           .where = row.where()};
    if (review_item.kind != "exchange" && review_item.kind != "same" && review_item.kind != "who")
      throw Error("{}: {} is not a kind of doubt; exchange, same and who are", row.where(), format::shown(review_item.kind));
    review_items.push_back(std::move(review_item));
  }
  return review_items;
}

std::vector<ReviewItem> read_review_items(const std::string& path) {
  return parse_review_items(format::read_file(path), path);
}

}  // namespace marey::pipeline::identify
