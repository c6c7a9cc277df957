// FIFA's EPTS: a text with one line an instant, and an XML of metadata that says what stands where in it: registers split at a
// separator, down to channels of players and of the ball. Read is any such layout with channels x and y, as share of the pitch from
// the corner above on the left with y downwards, as Metrica writes them, or in metres. Written is Metrica's, without the ball's
// channels filled, and with the speed where it is known.
#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/epts.h"
#include "marey/format/match/epts_periods.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/match/ground_match.h"
#include "marey/format/match/line_ups.h"
#include "marey/format/text_rows.h"
#include "marey/format/xml_text.h"

namespace marey::format::match {
namespace {

constexpr int kMaxDepth = 16;  // registers in registers

/// What a line is made of: a register that splits it further, or the channel of a player's that stands there, or neither.
struct Register {
  char separator = 0;
  std::vector<Register> parts;
  std::int32_t person = -1;
  int axis = -1;  ///< 0 is x, 1 is y
  bool frame = false;
};

class EptsReader {
 public:
  EptsReader(const std::string& name, const std::string& metadata_name)
      : name_(name), metadata_name_(metadata_name), builder_(name) {}

  GroundMatch read(std::string_view text, std::string_view metadata) {
    const pugi::xml_document document = parse_xml(metadata, metadata_name_);
    const pugi::xml_node root = document.document_element();
    read_globals(root.child("Metadata"));
    read_people(root.child("Metadata"));
    read_layouts(root);
    for_each_line(text, name_, [this](std::string_view line, std::string where) {
      where_ = std::move(where);
      read_line(line);
    });
    match_.order = builder_.finish(match_.recording);
    return std::move(match_);
  }

 private:
  double number(const pugi::xml_node& node, const char* what, double minimum, double maximum) const {
    const auto value = number_of(node.child_value());
    if (!value || !(*value >= minimum && *value <= maximum))
      throw Error("{}: {} is {}; a number from {:g} to {:g} is wanted", metadata_name_, what, shown(node.child_value()), minimum,
                  maximum);
    return *value;
  }

  void read_globals(const pugi::xml_node& metadata) {
    const pugi::xml_node global = metadata.child("GlobalConfig");
    if (!global) throw Error("{}: is not a metadata of EPTS: <GlobalConfig> is missing", metadata_name_);
    match_.recording.header.rate_hz = number(global.child("FrameRate"), "FrameRate", 0.1, 10'000);
    const pugi::xml_node size = metadata.child("Sessions").child("Session").child("FieldSize");
    if (size) {
      match_.pitch.length = number(size.child("Width"), "FieldSize's Width", 1, 1000);
      match_.pitch.width = number(size.child("Height"), "FieldSize's Height", 1, 1000);
    }
    std::map<std::string, std::string> parameters;
    for (const pugi::xml_node one : global.child("ProviderGlobalParameters").children("ProviderParameter"))
      parameters[one.child_value("Name")] = one.child_value("Value");
    for (std::size_t i = 0; i < kEptsPeriodNames.size(); ++i) {
      const auto first = number_of(parameters[fmt::format("{}_start", kEptsPeriodNames[i])]);
      const auto last = number_of(parameters[fmt::format("{}_end", kEptsPeriodNames[i])]);
      if (!first || !last || !(*first >= 0 && *first <= *last && *last < 1e9)) continue;
      match_.periods.push_back({static_cast<int>(i) + 1, static_cast<std::int32_t>(*first), static_cast<std::int32_t>(*last)});
    }
    for (const pugi::xml_node sensor : metadata.child("Devices").child("Device").child("Sensors").children("Sensor")) {
      for (const pugi::xml_node channel : sensor.child("Channels").children("Channel")) {
        const std::string_view id = channel.attribute("id").as_string();
        if (id == "x") normalized_ = std::string_view(channel.child_value("Unit")) == "normalized";
      }
    }
  }

  void read_people(const pugi::xml_node& metadata) {
    std::map<std::string, std::string> teams;
    for (const pugi::xml_node team : metadata.child("Teams").children("Team")) {
      const std::string name = team.child_value("Name");
      teams[team.attribute("id").as_string()] = name;
      (match_.home.empty() ? match_.home : match_.away) = name;
    }
    const pugi::xml_node score = metadata.child("Sessions").child("Session").child("MatchParameters").child("Score");
    if (const auto home = teams.find(score.attribute("idLocalTeam").as_string()); home != teams.end()) match_.home = home->second;
    if (const auto away = teams.find(score.attribute("idVisitingTeam").as_string()); away != teams.end())
      match_.away = away->second;
    std::map<std::string, std::int32_t> people;
    for (const pugi::xml_node player : metadata.child("Players").children("Player")) {
      const std::string id = player.attribute("id").as_string();
      const auto team = teams.find(player.attribute("teamId").as_string());
      const int shirt = player.child("ShirtNumber").text().as_int(0);
      const auto digits = id.find_last_not_of("0123456789") + 1;
      const auto required = whole_number_of(std::string_view(id).substr(digits));
      people[id] = builder_.person(id, required && *required < 1'000'000'000 ? static_cast<int>(*required) : 0,
                                   label_of(player.child_value("Name"), shirt), team == teams.end() ? std::string() : team->second);
    }
    for (const pugi::xml_node channel : metadata.child("PlayerChannels").children("PlayerChannel")) {
      const std::string_view what = channel.attribute("channelId").as_string();
      const auto person = people.find(channel.attribute("playerId").as_string());
      if (person == people.end() || (what != "x" && what != "y")) continue;
      channels_[channel.attribute("id").as_string()] = {person->second, what == "x" ? 0 : 1};
    }
    if (channels_.empty()) throw Error("{}: no player has a channel x or y, so no person has a place", metadata_name_);
  }

  Register layout(const pugi::xml_node& node, int depth) const {
    if (depth > kMaxDepth) throw Error("{}: registers are nested more than {} deep", metadata_name_, kMaxDepth);
    Register one;
    const std::string_view kind = node.name();
    if (kind == "PlayerChannelRef") {
      const auto channel = channels_.find(node.attribute("playerChannelId").as_string());
      if (channel != channels_.end()) one.person = channel->second.first, one.axis = channel->second.second;
    } else if (kind == "StringRegister") {
      one.frame = std::string_view(node.attribute("name").as_string()) == "frameCount";
    } else if (kind == "SplitRegister" || kind == "DataFormatSpecification") {
      const std::string_view separator = node.attribute("separator").as_string();
      if (separator.size() != 1) throw Error("{}: the separator {} is not a single letter", metadata_name_, shown(separator));
      one.separator = separator[0];
      for (const pugi::xml_node part : node.children()) {
        if (part.type() == pugi::node_element) one.parts.push_back(layout(part, depth + 1));
      }
    }
    return one;
  }

  void read_layouts(const pugi::xml_node& root) {
    for (const pugi::xml_node node : root.child("DataFormatSpecifications").children("DataFormatSpecification")) {
      layouts_.push_back(layout(node, 0));
      last_frames_.push_back(node.attribute("endFrame").as_llong(0));
    }
    if (layouts_.empty())
      throw Error("{}: <DataFormatSpecifications> is missing or empty, so the text cannot be read", metadata_name_);
  }

  /// Walks a line by its layout.
  void walk(std::string_view text, const Register& one) {
    if (one.separator == 0) {
      if (one.frame) frame_ = text;
      if (one.axis >= 0) locations_[one.person][static_cast<std::size_t>(one.axis)] = text;
      return;
    }
    for (const Register& part : one.parts) {
      const std::size_t end = std::min(text.find(one.separator), text.size());
      walk(text.substr(0, end), part);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  void read_line(std::string_view line) {
    const auto frame_first = whole_number_of(line.substr(0, line.find(layouts_.front().separator)));
    std::size_t which = 0;
    while (frame_first && which + 1 < layouts_.size() && *frame_first > last_frames_[which]) ++which;
    frame_ = {};
    locations_.clear();
    walk(line, layouts_[which]);
    const auto frame = whole_number_of(frame_);
    if (!frame || *frame < 0 || *frame > 1'000'000'000) throw Error("{}: {} is no frame's number", where_, shown(frame_));
    for (const auto& [person, location] : locations_) {
      const auto missing = [](std::string_view text) { return text.empty() || text == "NaN" || text == "nan"; };
      if (missing(location[0]) || missing(location[1])) continue;
      const auto x = number_of(location[0]), y = number_of(location[1]);
      if (!x || !y) throw Error("{}: {}, {} is not a place", where_, shown(location[0]), shown(location[1]));
      const double right = normalized_ ? match_.pitch.length * *x : *x;
      const double up = normalized_ ? match_.pitch.width * (1 - *y) : *y;
      builder_.add(static_cast<std::int32_t>(*frame), static_cast<double>(*frame) / match_.recording.header.rate_hz, person, right,
                   up, where_);
    }
  }

  const std::string& name_;
  const std::string& metadata_name_;
  GroundBuilder builder_;
  GroundMatch match_;
  bool normalized_ = false;
  std::map<std::string, std::pair<std::int32_t, int>> channels_;
  std::vector<Register> layouts_;
  std::vector<std::int64_t> last_frames_;
  std::string where_;
  std::string_view frame_;
  std::map<std::int32_t, std::array<std::string_view, 2>> locations_;
};

}  // namespace

GroundMatch parse_epts(std::string_view text, const std::string& name, std::string_view metadata,
                       const std::string& metadata_name) {
  return EptsReader(name, metadata_name).read(text, metadata);
}

namespace {

bool is_epts_metadata(std::string_view text) {
  return text.find("<GlobalConfig") != std::string_view::npos;
}

/// Lines that begin with a frame and a colon; those of TRACAB's are known by their targets.
bool is_epts(const Beginning& file) {
  if (is_epts_metadata(file.bytes)) return true;
  const std::string_view line = file.first_line();
  const std::size_t colon = line.find(':');
  return !file.has("<") && colon != std::string_view::npos && whole_number_of(line.substr(0, colon));
}

const TwoFiles& epts_files() {
  static const TwoFiles files{parse_epts, is_epts, is_epts_metadata, {".txt", ".dat"}};
  return files;
}

}  // namespace

Format epts_format() {
  return {.name = "epts",
          .title = "a FIFA EPTS file",
          .endings = ".xml",
          .holds = Content::ground,
          .detail =
              "with `.txt` beside it; corner above on the left, y down, 0 to 1 (others are read in m); halves, shirts, names, two "
              "teams, speed in km/h. Whole numbers of frames a second",
          .is = match::is_epts,
          .read = [](const std::string& path,
                     const ReadOptions& options) { return match::read_two_files(path, match::epts_files(), options); },
          .write = match::write_epts,
          .from_corner = true,
          .companions = {{".xml", ".txt"}}};
}

}  // namespace marey::format::match
