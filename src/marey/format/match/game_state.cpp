// SoccerNet's game state as its evaluation sees it: V. Somers et al., "SoccerNet Game State Reconstruction", CVPR Workshops 2024,
// and the reader of sn-trackeval 0.4.0 (datasets/soccernet_gs.py). Every annotation has a role, team and number of its own, which
// may change from image to image, so that this is not the recording that soccernet.cpp makes. What the program stops at with an
// assertion is named here in a sentence.
#include "marey/format/match/game_state.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

using json = nlohmann::ordered_json;  // an eighth faster to read: its objects are small

constexpr std::int64_t kImagesOfClip = 1'000'000;
constexpr std::int64_t kNoClip = 1000;  // what Marey writes
constexpr std::size_t kIdDigits = 10;
constexpr std::array<std::pair<std::string_view, PitchRole>, 4> kRoles{{{"player", PitchRole::player},
                                                                        {"goalkeeper", PitchRole::goalkeeper},
                                                                        {"referee", PitchRole::referee},
                                                                        {"other", PitchRole::other}}};
constexpr std::array<std::pair<std::string_view, PitchTeam>, 3> kTeams{
    {{"left", PitchTeam::left}, {"right", PitchTeam::right}, {"nan", PitchTeam::nan}}};

/// One list of people.
class PeopleReader {
 public:
  PeopleReader(const std::string& name, const LabelledImages& images) : name_(name), images_(images) {}

  GameState read(const json& list, const char* key, bool truth) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      index_ = i;
      if (!list[i].is_object()) fail("is not an object");
      add(list[i], truth);
    }
    std::stable_sort(state_.people.begin(), state_.people.end(), [](const auto& a, const auto& b) { return a.frame < b.frame; });
    check_once();
    warn_of_shared_numbers();
    if (!truth && state_.people.empty() && elsewhere_ > 0)
      state_.warnings.push_back(fmt::format("{}: none of its {} {} is of an image of the truth (their image_id begin with {})",
                                            name_, elsewhere_, key, images_.clip));
    if (numbers_ > 0)
      state_.warnings.push_back(
          fmt::format("{}: {} shirt numbers are JSON numbers; SoccerNet compares texts (\"7\"), and a number "
                      "equals none of them",
                      name_, numbers_));
    return std::move(state_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error("{}: person {} of the list {}", name_, index_ + 1, what); }

  const json& member(const json& object, const char* key) const {
    const auto value = object.find(key);
    if (value == object.end()) fail(fmt::format("has no {}", key));
    return *value;
  }

  std::string text_of(const json& value, const char* key) const {
    if (!value.is_string()) fail(fmt::format("has a {} that is not a text", key));
    return value.get<std::string>();
  }

  /// The image's number from 0; nothing if the truth does not have it.
  std::optional<std::int32_t> frame_of(const std::string& image_id, bool truth) const {
    const auto id = whole_number_of(image_id);
    if (!id || *id < 0) fail(fmt::format("has the image_id \"{}\", which is no number", image_id));
    const std::int64_t clip = *id / kImagesOfClip;
    std::int64_t frame = *id % kImagesOfClip - 1;
    if (clip != images_.clip) {
      if (truth) return std::nullopt;
      if (image_id.size() != kIdDigits) {
        frame = *id % 10'000;
      } else if (clip != kNoClip) {
        return std::nullopt;
      }
    }
    const auto at = static_cast<std::int32_t>(frame);
    return std::binary_search(images_.frames.begin(), images_.frames.end(), at) ? std::optional(at) : std::nullopt;
  }

  void add(const json& one, bool truth) {
    if (text_of(member(one, "supercategory"), "supercategory") != "object") return;
    const auto frame = frame_of(text_of(member(one, "image_id"), "image_id"), truth);
    if (!frame) {
      ++elsewhere_;
      return;
    }
    const json& attributes = member(one, "attributes");
    if (!attributes.is_object()) fail("has attributes that are not an object");
    const std::string role = text_of(member(attributes, "role"), "role");
    if (role == "ball") return;
    PitchPerson& person = state_.people.emplace_back();
    person.frame = *frame;
    const json& track = member(one, "track_id");
    const std::optional<std::int64_t> id = track.is_string()           ? whole_number_of(track.get<std::string>())
                                           : track.is_number_integer() ? std::optional(track.get<std::int64_t>())
                                           : track.is_number() && track.get<double>() == static_cast<int>(track.get<double>())
                                               ? std::optional<std::int64_t>(static_cast<int>(track.get<double>()))
                                               : std::nullopt;
    if (!id || *id < 0 || *id > 1'000'000'000) fail("has a track_id that is not a whole number from 0");
    person.id = static_cast<std::int32_t>(*id);
    read_position(member(one, "bbox_pitch"), person);
    describe(attributes, role, person);
  }

  void read_position(const json& box, PitchPerson& person) const {
    if (!box.is_object()) fail("has no place on the pitch (bbox_pitch)");
    const auto coordinate = [&](const char* key) {
      const json& value = member(box, key);
      if (!value.is_number()) fail(fmt::format("has a bbox_pitch whose {} is no number", key));
      return value.get<double>();
    };
    person.location = {coordinate("x_bottom_middle"), coordinate("y_bottom_middle")};
  }

  void describe(const json& attributes, const std::string& role, PitchPerson& person) {
    const auto known = std::ranges::find(kRoles, role, &std::pair<std::string_view, PitchRole>::first);
    if (known == kRoles.end())
      fail(fmt::format("has the role \"{}\"; a game state has player, goalkeeper, referee, other and ball", role));
    person.role = known->second;
    const json& team = member(attributes, "team");
    const json& jersey = member(attributes, "jersey");
    if (person.role > PitchRole::goalkeeper) return;
    if (!team.is_null()) {
      const std::string text = text_of(team, "team");
      const auto side = std::ranges::find(kTeams, text, &std::pair<std::string_view, PitchTeam>::first);
      if (side == kTeams.end()) fail(fmt::format("has the team \"{}\"; a game state has left and right, and null", text));
      person.team = side->second;
    }
    if (person.role != PitchRole::player || jersey.is_null()) return;
    const auto number = jersey.is_string()           ? whole_number_of(jersey.get<std::string>())
                        : jersey.is_number_integer() ? std::optional(jersey.get<std::int64_t>())
                                                     : std::nullopt;
    if (!number || *number < 0 || *number > 10'000)
      fail(fmt::format("has the shirt number {}; expected a text such as \"7\", or null", jersey.dump()));
    // A number is equal to numbers alone, as in the reference: the sign keeps it apart from every text.
    person.jersey = jersey.is_string() ? jersey.get<std::string>() : fmt::format("#{}", *number);
    if (!jersey.is_string()) ++numbers_;
  }

  void check_once() const {
    std::vector<std::pair<std::int32_t, std::int32_t>> seen;
    seen.reserve(state_.people.size());
    for (const PitchPerson& person : state_.people) seen.emplace_back(person.frame, person.id);
    std::sort(seen.begin(), seen.end());
    const auto twice = std::adjacent_find(seen.begin(), seen.end());
    if (twice != seen.end()) throw Error("{}: track {} is twice in image {}", name_, twice->second, twice->first + 1);
  }

  /// People of one team with one number in one image: those who are so in the most images, in one sentence.
  void warn_of_shared_numbers() {
    using Shirt = std::pair<PitchTeam, std::string>;
    std::map<Shirt, std::pair<int, std::set<std::int32_t>>> shared;
    std::map<Shirt, std::int32_t> wearing;
    std::int32_t frame = -1;
    for (const PitchPerson& person : state_.people) {
      if (person.frame != frame) wearing.clear();
      frame = person.frame;
      if (person.jersey.empty() || person.team == PitchTeam::none) continue;
      const auto [first, is_new] = wearing.try_emplace({person.team, person.jersey}, person.id);
      if (is_new) continue;
      auto& [images, tracks] = shared[first->first];
      ++images;
      tracks.insert({first->second, person.id});
    }
    if (shared.empty()) return;
    const auto& [shirt, found] = *std::ranges::max_element(shared, {}, [](const auto& one) { return one.second.first; });
    state_.warnings.push_back(fmt::format("{}: {} people of the team {} have the number {} (tracks {}), in {} image{}{}", name_,
                                          found.second.size(), shirt.first == PitchTeam::left ? "left" : "right", shirt.second,
                                          fmt::join(found.second, ", "), found.first, found.first == 1 ? "" : "s",
                                          more_shared(shared.size() - 1)));
  }

  static std::string more_shared(std::size_t count) {
    return count == 0   ? ""
           : count == 1 ? "; 1 more number is shared by people of one team"
                        : fmt::format("; {} more numbers are shared by people of one team", count);
  }

  const std::string& name_;
  const LabelledImages& images_;
  GameState state_;
  std::size_t index_ = 0;
  std::int64_t elsewhere_ = 0, numbers_ = 0;
};

json parse_text(std::string_view text, const std::string& name) {
  check_nesting(text, Notation::json, name);
  json root = json::parse(text, nullptr, false);
  if (root.is_discarded()) throw Error("{}: is not JSON; the file may be cut off", name);
  if (!root.is_object()) throw Error("{}: is not a game state of SoccerNet: it must be an object", name);
  return root;
}

const json& list_of(const json& root, const char* key, const std::string& name) {
  const auto list = root.find(key);
  if (list != root.end() && list->is_array()) return *list;
  const bool other = root.contains("annotations") || root.contains("predictions");
  throw Error("{}: has no list \"{}\"{}", name, key,
              !other                              ? "; is it a game state of SoccerNet?"
              : key == std::string("annotations") ? "; these are predictions, the truth is named Labels-GameState.json"
                                                  : "; this is the truth, a tracker's result has predictions");
}

bool is_labelled(const json& image, const std::string& name) {
  return std::ranges::all_of(std::array{"has_labeled_pitch", "has_labeled_camera", "has_labeled_person"}, [&](const char* key) {
    const auto value = image.find(key);
    if (value == image.end() || !value->is_boolean()) throw Error("{}: an image has no {} (true or false)", name, key);
    return value->get<bool>();
  });
}

LabelledImages labelled_images(const json& list, const std::string& name) {
  LabelledImages images;
  for (const json& image : list) {
    const auto id_text = image.is_object() && image.contains("image_id") && image["image_id"].is_string()
                             ? image["image_id"].get<std::string>()
                             : std::string();
    const auto id = whole_number_of(id_text);
    if (!id || *id % kImagesOfClip < 1)
      throw Error("{}: an image's image_id is \"{}\"; expected ten digits such as 2021000001", name, id_text);
    if (!is_labelled(image, name)) continue;
    if (!images.frames.empty() && *id / kImagesOfClip != images.clip)
      throw Error("{}: its images are of two clips, {} and {}; expected one clip a file", name, images.clip, *id / kImagesOfClip);
    images.clip = *id / kImagesOfClip;
    images.frames.push_back(static_cast<std::int32_t>(*id % kImagesOfClip - 1));
  }
  std::sort(images.frames.begin(), images.frames.end());
  images.frames.erase(std::unique(images.frames.begin(), images.frames.end()), images.frames.end());
  return images;
}

}  // namespace

TrueGameState parse_true_game_state(std::string_view text, const std::string& name) {
  const json root = parse_text(text, name);
  const json& list = list_of(root, "annotations", name);
  TrueGameState truth;
  truth.images = labelled_images(list_of(root, "images", name), name);
  truth.state = PeopleReader(name, truth.images).read(list, "annotations", true);
  return truth;
}

GameState parse_predicted_game_state(std::string_view text, const std::string& name, const LabelledImages& images) {
  const json root = parse_text(text, name);
  return PeopleReader(name, images).read(list_of(root, "predictions", name), "predictions", false);
}

TrueGameState read_true_game_state(const std::string& path) {
  return parse_true_game_state(read_file(path), path);
}

GameState read_predicted_game_state(const std::string& path, const LabelledImages& images) {
  return parse_predicted_game_state(read_file(path), path, images);
}

}  // namespace marey::format::match
