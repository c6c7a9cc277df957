// DFL's positional data (Sportec): XML with a set of frames for each person and half, m from the centre spot, y upwards. Frames of
// the first half count from 10,000, those of the second from 100,000. Names of people and teams are in the match's information, an
// XML of its own, which may be missing.
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
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format::match {
namespace {

constexpr std::array<std::string_view, 4> kSections = {"firstHalf", "secondHalf", "firstHalfExtra", "secondHalfExtra"};

struct Identify {
  std::string label, team;
};

/// Seconds since midnight of 2020-06-05T20:29:57.840+02:00.
std::optional<double> seconds_of_day(std::string_view time) {
  const std::size_t begin = time.find('T');
  if (begin == std::string_view::npos || time.size() < begin + 9) return std::nullopt;
  const auto hours = number_of(time.substr(begin + 1, 2)), minutes = number_of(time.substr(begin + 4, 2));
  const std::string_view rest = time.substr(begin + 7);
  const auto seconds = number_of(rest.substr(0, rest.find_first_of("+-Z")));
  if (!hours || !minutes || !seconds) return std::nullopt;
  return 3600 * *hours + 60 * *minutes + *seconds;
}

class SportecReader {
 public:
  SportecReader(const std::string& name, const std::string& metadata_name)
      : name_(name), metadata_name_(metadata_name), builder_(name) {}

  GroundMatch read(std::string_view text, std::string_view metadata) {
    if (!metadata.empty()) read_people(metadata);
    const pugi::xml_document document = parse_xml(text, name_);
    const pugi::xml_node positions = document.document_element().child("Positions");
    if (!positions) throw Error("{}: is not a positional data of DFL: <Positions> is missing", name_);
    if (const pugi::xml_node size = positions.child("MetaData").child("PitchSize")) {
      match_.pitch.length = number(size, "X", 1, 1000);
      match_.pitch.width = number(size, "Y", 1, 1000);
    }
    for (const pugi::xml_node set : positions.children("FrameSet")) learn_rate(set);
    for (const pugi::xml_node set : positions.children("FrameSet")) read_set(set);
    std::sort(match_.periods.begin(), match_.periods.end(), [](const auto& a, const auto& b) { return a.number < b.number; });
    match_.order = builder_.finish(match_.recording);
    return std::move(match_);
  }

 private:
  void read_people(std::string_view metadata) {
    const pugi::xml_document document = parse_xml(metadata, metadata_name_);
    for (const pugi::xml_node team : document.document_element().child("MatchInformation").child("Teams").children("Team")) {
      const std::string name = team.attribute("TeamName").as_string();
      (std::string_view(team.attribute("Role").as_string()) == "home" ? match_.home : match_.away) = name;
      for (const pugi::xml_node player : team.child("Players").children("Player"))
        people_[player.attribute("PersonId").as_string()] = {player.attribute("Shortname").as_string(), name};
    }
  }

  double number(const pugi::xml_node& node, const char* attribute, double minimum, double maximum) const {
    const std::string_view text = node.attribute(attribute).as_string();
    const auto value = number_of(text);
    if (!value || !(*value >= minimum && *value <= maximum))
      throw Error("{}: {} of a <{}> is {}; a number from {:g} to {:g} is wanted", name_, attribute, node.name(), shown(text),
                  minimum, maximum);
    return *value;
  }

  void learn_rate(const pugi::xml_node& set) {
    if (rate_known_) return;
    FrameNumbers numbers;
    for (const pugi::xml_node frame : set.children("Frame")) {
      numbers.add(static_cast<std::int64_t>(number(frame, "N", 0, 1e9)), seconds_of_day(frame.attribute("T").as_string()));
    }
    const auto rate = numbers.rate_hz();
    if (!rate || *rate < 0.1 || *rate > 10'000) return;
    match_.recording.header.rate_hz = std::round(*rate * 100) / 100;
    rate_known_ = true;
  }

  void read_set(const pugi::xml_node& set) {
    const std::string team = set.attribute("TeamId").as_string(), id = set.attribute("PersonId").as_string();
    const std::string_view section = set.attribute("GameSection").as_string();
    const auto known = std::find(kSections.begin(), kSections.end(), section);
    if (known == kSections.end())
      throw Error("{}: a <FrameSet> has the section {}; firstHalf, secondHalf, ... are known", name_, shown(section));
    const int period = static_cast<int>(known - kSections.begin()) + 1;
    const auto identity = people_.find(id);
    const bool ball = team == "BALL";
    const std::int32_t person = ball                        ? builder_.ball()
                                : identity == people_.end() ? builder_.person(id, 0, id, team == "referee" ? "referee" : team)
                                                            : builder_.person(id, 0, identity->second.label, identity->second.team);
    for (const pugi::xml_node node : set.children("Frame")) {
      const auto frame = static_cast<std::int32_t>(number(node, "N", 0, 1e9));
      extend(period, frame);
      GroundBuilder::Row row{.frame = frame, .time = frame / match_.recording.header.rate_hz};
      row.location = {match_.pitch.length / 2 + number(node, "X", -1e5, 1e5),
                      match_.pitch.width / 2 + number(node, "Y", -1e5, 1e5)};
      if (ball && node.attribute("Z")) row.height = number(node, "Z", -1e5, 1e5);
      builder_.add(person, row);
    }
  }

  void extend(int number, std::int32_t frame) {
    auto known = std::find_if(match_.periods.begin(), match_.periods.end(), [&](const auto& one) { return one.number == number; });
    if (known == match_.periods.end()) known = match_.periods.insert(known, {number, frame, frame});
    known->first_frame = std::min(known->first_frame, frame);
    known->last_frame = std::max(known->last_frame, frame);
  }

  const std::string& name_;
  const std::string& metadata_name_;
  GroundBuilder builder_;
  GroundMatch match_;
  bool rate_known_ = false;
  std::map<std::string, Identify> people_;
};

}  // namespace

GroundMatch parse_sportec(std::string_view text, const std::string& name, std::string_view metadata,
                          const std::string& metadata_name) {
  return SportecReader(name, metadata_name).read(text, metadata);
}

namespace {

bool is_sportec_metadata(std::string_view text) {
  return text.find("<MatchInformation") != std::string_view::npos;
}

bool is_sportec(const Beginning& file) {
  return file.has("<PutDataRequest") && (file.has("<Positions") || is_sportec_metadata(file.bytes));
}

const TwoFiles& sportec_files() {
  static const TwoFiles files{parse_sportec, is_sportec, is_sportec_metadata, {".xml"}, false};
  return files;
}

}  // namespace

Format sportec_format() {
  return {.name = "sportec",
          .title = "positional data of DFL (Sportec)",
          .endings = {},
          .holds = Content::ground,
          .detail = "centre spot, y up, m; DFL's positional XML; names from the match's information beside it",
          .is = match::is_sportec,
          .read = [](const std::string& path,
                     const ReadOptions& options) { return match::read_two_files(path, match::sportec_files(), options); },
          .from_corner = true};
}

}  // namespace marey::format::match
