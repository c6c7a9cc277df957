// StatsPerform's MA25: a line an instant, `unix ms;ms of the half,half,state:side,person,shirt,x,y;...:ball;`, m from the corner
// above on the left, y downwards. Sides are 0 at home, 1 the guests, 2 referees, 3 and 4 the keepers of 0 and 1. The rate is that
// of the first two lines; frames count from the first line on, those of the break too.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/match/ground_match.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

constexpr std::array<const char*, 5> kTeams = {"Home", "Away", "referee", "Home", "Away"};

class StatsperformReader {
 public:
  StatsperformReader(const std::string& name, const geometry::PitchSize& pitch) : builder_(name), name_(name) {
    match_.pitch = pitch;
    match_.home = "Home", match_.away = "Away";
  }

  GroundMatch read(std::string_view text) {
    learn_rate(text);
    for_each_line(text, name_, [this](std::string_view line, std::string where) {
      where_ = std::move(where);
      read_line(line);
    });
    match_.order = builder_.finish(match_.recording);
    return std::move(match_);
  }

 private:
  struct Head {
    double ms = 0;  ///< since 1970
    int period = 1;
  };

  Head head_of(std::string_view line, const std::string& where) {
    split_fields(line.substr(0, line.find(':')), ';', fields_);
    const auto ms = number_of(fields_[0]);
    std::vector<std::string_view> rest;
    if (fields_.size() > 1) split_fields(fields_[1], ',', rest);
    const double period = rest.size() > 1 ? number_of(rest[1]).value_or(0) : 0;
    if (!ms || !(*ms >= 0 && *ms < 1e14) || !(period >= 1 && period <= 9))
      throw Error("{}: is not an instant of MA25; it must read time;ms,half,state:people:ball", where);
    return {*ms, static_cast<int>(period)};
  }

  void learn_rate(std::string_view text) {
    TextLines lines(text);
    std::string_view line;
    FrameNumbers numbers;
    std::int64_t count = 0;
    match_.recording.header.rate_hz = 10;
    while (lines.next(line)) {
      if (line.empty()) continue;
      const Head head = head_of(line, fmt::format("{}:{}", name_, lines.number()));
      if (count == 0) start_ms_ = head.ms;
      numbers.add(count++, head.ms / 1000);
    }
    if (count < 2) return;
    const auto rate = numbers.rate_hz();
    if (!rate || !(*rate >= 0.1 && *rate <= 1000))
      throw Error("{}: its instants' times do not continue, which makes no rate", name_);
    match_.recording.header.rate_hz = std::round(*rate * 1000) / 1000;
  }

  void read_line(std::string_view line) {
    const Head head = head_of(line, where_);
    const double number = std::round((head.ms - start_ms_) / 1000 * match_.recording.header.rate_hz);
    if (!(number >= 0 && number <= 1e9)) throw Error("{}: its time lies before the first line's, or days behind it", where_);
    const auto frame = static_cast<std::int32_t>(number);
    extend(head.period, frame);
    const std::size_t begin = line.find(':');
    if (begin == std::string_view::npos) return;
    const std::string_view people = line.substr(begin + 1, std::min(line.find(':', begin + 1), line.size()) - begin - 1);
    split_fields(people, ';', fields_);
    const std::vector<std::string_view> each = fields_;
    for (const std::string_view one : each) {
      if (!one.empty()) read_person(one, frame);
    }
  }

  void read_person(std::string_view text, std::int32_t frame) {
    split_fields(text, ',', fields_);
    const auto side = whole_number_of(fields_[0]);
    const auto x = fields_.size() == 5 ? number_of(fields_[3]) : std::nullopt;
    const auto y = fields_.size() == 5 ? number_of(fields_[4]) : std::nullopt;
    if (!side || *side < 0 || *side >= static_cast<std::int64_t>(kTeams.size()) || !x || !y)
      throw Error("{}: {} is no person; it must read side,person,shirt,x,y", where_, shown(text));
    const std::int32_t person =
        builder_.person(std::string(fields_[1]), 0, std::string(fields_[2]), kTeams[static_cast<std::size_t>(*side)]);
    builder_.add(frame, frame / match_.recording.header.rate_hz, person, *x, match_.pitch.width - *y, where_);
  }

  void extend(int number, std::int32_t frame) {
    auto known = std::find_if(match_.periods.begin(), match_.periods.end(), [&](const auto& one) { return one.number == number; });
    if (known == match_.periods.end()) known = match_.periods.insert(known, {number, frame, frame});
    known->last_frame = std::max(known->last_frame, frame);
  }

  GroundBuilder builder_;
  GroundMatch match_;
  const std::string& name_;
  std::string where_;
  double start_ms_ = 0;
  std::vector<std::string_view> fields_;
};

}  // namespace

GroundMatch parse_statsperform(std::string_view text, const std::string& name, const geometry::PitchSize& pitch) {
  return StatsperformReader(name, pitch).read(text);
}

namespace {

bool is_statsperform(const Beginning& file) {
  const std::string_view line = file.first_line();
  const std::size_t semicolon = line.find(';'), colon = line.find(':');
  if (semicolon == std::string_view::npos || !whole_number_of(line.substr(0, semicolon)) || !(colon > semicolon)) return false;
  std::vector<std::string_view> fields;
  split_fields(line.substr(semicolon + 1, colon - semicolon - 1), ',', fields);
  return fields.size() == 3 && all_numbers(fields);
}

GroundMatch read_statsperform(const std::string& path, const ReadOptions& options) {
  return parse_statsperform(read_file(path), path, options.pitch);
}

}  // namespace

Format statsperform_format() {
  return {.name = "statsperform",
          .title = "an MA25 file of StatsPerform",
          .endings = {},
          .holds = Content::ground,
          .detail = "corner above on the left, y down, m; MA25 text, with the pitch's size from `--size`",
          .is = match::is_statsperform,
          .read = match::read_statsperform,
          .from_corner = true};
}

}  // namespace marey::format::match
