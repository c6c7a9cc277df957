// Metrica's CSV: a file of the home team and one of the guests, `Period,Frame,Time [s],x,y,...` below three lines of heads, the
// ball in the last two columns; 0 to 1 from the corner above on the left, y downwards; NaN where a person is missing. Frames count
// from 1, and the first is at one frame's time.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/files/whole_file.h"
#include "marey/format/mapped_file.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/match/ground_match.h"
#include "marey/format/match/line_ups.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

constexpr double kMinRate = 0.1, kMaxRate = 10'000;  // Hz
constexpr double kMaxPitches = 1000;                 // lengths and widths of the pitch

bool is_given_by_times(double rate_hz) {
  return rate_hz >= kMinRate && rate_hz <= kMaxRate;
}

constexpr std::size_t kFirstPlayer = 3;  // columns before it
constexpr std::size_t kBall = 2;         // columns of it

struct PersonColumn {
  std::size_t at = 0;
  std::int32_t person = 0;
};

class MetricaReader {
 public:
  MetricaReader(const std::string& name, const geometry::PitchSize& pitch) : builder_(name) { match_.pitch = pitch; }

  void read(std::string_view text, const std::string& name, const char* otherwise, std::string& team) {
    name_ = name;
    learn_rate(text);
    lines_ = TextLines(text);
    team = otherwise;
    if (next_fields() && fields_.size() > kFirstPlayer && !fields_[kFirstPlayer].empty()) team = unquoted(fields_[kFirstPlayer]);
    const bool numbered = next_fields();
    std::vector<std::string> numbers;
    for (const std::string_view field : fields_) numbers.emplace_back(field);
    if (!numbered || !next_fields() || fields_.size() < kFirstPlayer + kBall || fields_[0] != "Period" || fields_[1] != "Frame")
      throw Error("{}:3: must read Period,Frame,Time [s],Player...; it is not a tracking file of Metrica", name_);
    std::vector<PersonColumn> columns;
    for (std::size_t at = kFirstPlayer; at + kBall < fields_.size(); at += 2) {
      const auto number = at < numbers.size() ? whole_number_of(numbers[at]) : std::nullopt;
      if (!number || *number < 0 || *number > std::numeric_limits<int>::max())
        throw Error("{}:2: column {} must hold a shirt's number", name_, at + 1);
      const int shirt = static_cast<int>(*number);
      columns.push_back(
          {at, builder_.person(fmt::format("{} {}", otherwise, shirt), 0, label_of(unquoted(fields_[at]), shirt), team)});
    }
    const std::size_t width = fields_.size();
    while (next_fields()) {
      if (fields_.size() == 1 && fields_[0].empty()) continue;
      if (fields_.size() != width)
        throw Error("{}: has {} columns, the head {}; the file may be cut off", where(), fields_.size(), width);
      read_row(columns);
      if (otherwise == std::string_view("Home")) read_ball(width - kBall);
    }
  }

  GroundMatch finish() {
    match_.order = builder_.finish(match_.recording);
    return std::move(match_);
  }

 private:
  std::string where() const { return fmt::format("{}:{}", name_, lines_.number()); }

  bool next_fields() {
    std::string_view line;
    if (!lines_.next(line)) return false;
    split_fields(line, ',', fields_);
    return true;
  }

  double number(std::size_t column, double minimum, double maximum) const {
    const auto value = number_of(fields_[column]);
    if (!value || !(*value >= minimum && *value <= maximum))
      throw Error("{}: column {} is {}; a number from {:g} to {:g} is wanted", where(), column + 1, shown(fields_[column]), minimum,
                  maximum);
    return *value;
  }

  void read_row(const std::vector<PersonColumn>& columns) {
    const int period = static_cast<int>(number(0, 1, 9));
    const auto frame = static_cast<std::int32_t>(number(1, 1, kMaxFrame)) - 1;
    number(2, -1e11, 1e11);
    auto known = std::find_if(match_.periods.begin(), match_.periods.end(), [&](const auto& one) { return one.number == period; });
    if (known == match_.periods.end()) known = match_.periods.insert(known, {period, frame, frame});
    known->first_frame = std::min(known->first_frame, frame);
    known->last_frame = std::max(known->last_frame, frame);
    for (const PersonColumn& column : columns) {
      const std::string_view x = fields_[column.at], y = fields_[column.at + 1];
      if (x.empty() || y.empty() || x == "NaN" || y == "NaN") continue;
      builder_.add(frame, frame / match_.recording.header.rate_hz, column.person,
                   match_.pitch.length * number(column.at, -kMaxPitches, kMaxPitches),
                   match_.pitch.width * (1 - number(column.at + 1, -kMaxPitches, kMaxPitches)), where());
    }
  }

  /// Both files have it; the home team's is taken.
  void read_ball(std::size_t column) {
    const std::string_view x = fields_[column], y = fields_[column + 1];
    if (x.empty() || y.empty() || x == "NaN" || y == "NaN") return;
    const auto frame = static_cast<std::int32_t>(number(1, 1, kMaxFrame)) - 1;
    builder_.add(frame, frame / match_.recording.header.rate_hz, builder_.ball(),
                 match_.pitch.length * number(column, -kMaxPitches, kMaxPitches),
                 match_.pitch.width * (1 - number(column + 1, -kMaxPitches, kMaxPitches)), where());
  }

  /// The head does not specify the rate; frames and times of the rows do, the beginning at 0 among them. Rows that cannot be read
  /// are left to who reads them.
  void learn_rate(std::string_view text) {
    FrameNumbers numbers;
    numbers.add(0, 0.0);
    TextLines lines(text);
    std::string_view line;
    while (lines.next(line)) {
      split_fields(line.substr(0, end_of_time(line)), ',', fields_);
      const auto frame = fields_.size() == kFirstPlayer ? whole_number_of(fields_[1]) : std::nullopt;
      const auto time = fields_.size() == kFirstPlayer ? number_of(fields_[2]) : std::nullopt;
      if (frame && time && *frame > 0 && *frame <= 1'000'000'000) numbers.add(*frame, *time);
    }
    if (numbers.count() < 2) return;
    const double rate = std::round(1000 * numbers.rate_hz().value_or(0)) / 1000;
    if (!is_given_by_times(rate))
      throw Error("{}: its frames and times make no rate; the match begins with frame 1 at one frame's time", name_);
    match_.recording.header.rate_hz = rate;
  }

  /// Behind period, frame and time.
  static std::size_t end_of_time(std::string_view line) {
    std::size_t at = line.find(',');
    for (int more = 1; more < 3 && at != std::string_view::npos; ++more) at = line.find(',', at + 1);
    return std::min(at, line.size());
  }

  std::string name_;
  TextLines lines_{""};
  GroundBuilder builder_;
  GroundMatch match_;
  std::vector<std::string_view> fields_;
};

/// Readers take the heads for ASCII.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) >= 0x80 && (static_cast<unsigned char>(c) & 0xC0) == 0x80)
      continue;  // continues with a letter
    result += c < ' ' || c > '~' || c == ',' || c == '"' ? '?' : c;
  }
  return result;
}

std::string heads(const LineUps& line_ups, Side side, const std::vector<std::size_t>& people) {
  std::string teams = ",,", numbers = ",,", names = "Period,Frame,Time [s]";
  for (const std::size_t person : people) {
    const int number = line_ups.members[person].number;
    teams += fmt::format(",{},", plain(line_ups.teams[side == Side::home ? 0 : 1]));
    numbers += fmt::format(",{},", number);
    names += fmt::format(",Player{},", number);
  }
  return fmt::format("{},,\n{},,\n{},Ball,\n", teams, numbers, names);
}

void write_team(const GroundMatch& match, const LineUps& line_ups, Side side, const std::vector<GroundPeriod>& periods,
                WholeFile& file) {
  const std::vector<std::size_t> people = line_ups.of(side);
  std::string text = heads(line_ups, side, people);
  const Recording& recording = match.recording;
  const std::vector<std::optional<BallAt>> balls = ball_by_instant(match, line_ups);
  std::vector<std::optional<Vector<2>>> locations(recording.tracks().size());
  InstantRows rows(recording);
  for (std::size_t instant = 0; instant < recording.instants().size(); ++instant) {
    const std::int64_t frame = recording.instants()[instant].index;
    const auto period = std::find_if(periods.begin(), periods.end(),
                                     [&](const auto& one) { return one.first_frame <= frame && frame <= one.last_frame; });
    if (period == periods.end()) continue;
    std::fill(locations.begin(), locations.end(), std::nullopt);
    for (const auto& [track, row] : rows.at(instant)) locations[track] = recording.tracks()[track].location(row);
    fmt::format_to(std::back_inserter(text), "{},{},{:.5f}", period->number, frame + 1,
                   static_cast<double>(frame + 1) / recording.header.rate_hz);
    for (const std::size_t person : people) {
      if (const auto& location = locations[person]) {
        const Vector<2> fraction(location->x() / match.pitch.length, 1 - location->y() / match.pitch.width);
        if (!(fraction.cwiseAbs().maxCoeff() <= kMaxPitches))
          throw Error("a person is at ({:g}, {:g}) m, farther from the pitch than Metrica's files can say", location->x(),
                      location->y());
        fmt::format_to(std::back_inserter(text), ",{:.5f},{:.5f}", fraction.x(), fraction.y());
      } else {
        text += ",NaN,NaN";
      }
    }
    if (const auto& ball = balls[instant])
      fmt::format_to(std::back_inserter(text), ",{:.5f},{:.5f}\n", ball->location.x() / match.pitch.length,
                     1 - ball->location.y() / match.pitch.width);
    else
      text += ",NaN,NaN\n";
    if (text.size() < (std::size_t{1} << 20)) continue;
    file.write(text);
    text.clear();
  }
  file.write(text);
}

}  // namespace

GroundMatch parse_metrica(std::string_view home, const std::string& home_name, std::string_view away, const std::string& away_name,
                          const geometry::PitchSize& pitch) {
  MetricaReader reader(home_name, pitch);
  std::string home_team, away_team;
  reader.read(home, home_name, "Home", home_team);
  reader.read(away, away_name, "Away", away_team);
  GroundMatch match = reader.finish();
  match.home = home_team, match.away = away_team;
  return match;
}

namespace {

GroundMatch read_metrica(const std::string& path, const ReadOptions& options) {
  std::string other = path;
  bool is_home = true;
  for (const auto& [mine, theirs] :
       {std::pair("home", "away"), std::pair("Home", "Away"), std::pair("away", "home"), std::pair("Away", "Home")}) {
    const std::size_t at = std::filesystem::path(path).filename().string().rfind(mine);
    if (at == std::string::npos) continue;
    other = (std::filesystem::path(path).parent_path() / std::filesystem::path(path).filename().string().replace(at, 4, theirs))
                .string();
    is_home = mine[0] == 'h' || mine[0] == 'H';
    break;
  }
  std::error_code error;
  if (other == path || !std::filesystem::exists(other, error))
    throw Error("{}: Metrica's files come in pairs, ..._home.csv and ..._away.csv, and the other one is not beside it", path);
  const MappedFile mine(path), theirs(other);
  return is_home ? parse_metrica(mine.text(), path, theirs.text(), other, options.pitch)
                 : parse_metrica(theirs.text(), other, mine.text(), path, options.pitch);
}

bool is_metrica(const Beginning& file) {
  TextLines lines(file.text());
  std::string_view line;
  while (lines.next(line) && line.empty()) continue;
  return lines.next(line) && lines.next(line) && line.starts_with("Period,Frame,Time [s]");
}

std::vector<std::string> write_metrica(const GroundMatch& match, const std::string& path) {
  if (!is_given_by_times(match.recording.header.rate_hz)) {
    throw Error("{}: Metrica's files tell a rate of {:g} to {:g} Hz by their times; this is one of {:g} Hz", path, kMinRate,
                kMaxRate, match.recording.header.rate_hz);
  }
  LineUps line_ups = line_ups_of(match);
  const std::vector<GroundPeriod> periods = periods_of(match);
  std::string stem = with_ending(path, "");
  for (const std::string_view side : {"_home", "_away"}) {
    if (stem.ends_with(side)) stem.resize(stem.size() - side.size());
  }
  WholeFile home(stem + "_home.csv"), away(stem + "_away.csv");
  write_team(match, line_ups, Side::home, periods, home);
  write_team(match, line_ups, Side::away, periods, away);
  home.finish();
  away.finish();
  const auto excluded = line_ups.of(Side::referee).size() + line_ups.of(Side::other).size();
  if (excluded > 0)
    line_ups.warnings.push_back(fmt::format("{} people of neither team were omitted: Metrica's files hold two teams", excluded));
  return line_ups.warnings;
}

}  // namespace

Format metrica_format() {
  return {.name = "metrica",
          .title = "a pair of Metrica's CSV files",
          .endings = "_home.csv _away.csv",
          .holds = Content::ground,
          .detail =
              "corner above on the left, y down, 0 to 1; halves, shirts, two teams, NaN where a person is missing. Frames from 1. "
              "The pitch's size is not in it: `--size`",
          .is = match::is_metrica,
          .read = match::read_metrica,
          .write = match::write_metrica,
          .from_corner = true,
          .companions = {{"_home.csv", "_away.csv"}, {"_away.csv", "_home.csv"}}};
}

}  // namespace marey::format::match
