#include "marey/core/keypoint_sets.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"

namespace marey {
namespace {

/// Bones of a body. Those between points that a set has are the set's; the second list is of sets without a neck.
constexpr auto kBones = std::to_array<std::pair<const char*, const char*>>({
    {"left_shoulder", "left_elbow"},
    {"left_elbow", "left_wrist"},
    {"right_shoulder", "right_elbow"},
    {"right_elbow", "right_wrist"},
    {"left_hip", "left_knee"},
    {"left_knee", "left_ankle"},
    {"right_hip", "right_knee"},
    {"right_knee", "right_ankle"},
    {"left_ankle", "left_heel"},
    {"left_ankle", "left_big_toe"},
    {"left_heel", "left_big_toe"},
    {"left_big_toe", "left_small_toe"},
    {"right_ankle", "right_heel"},
    {"right_ankle", "right_big_toe"},
    {"right_heel", "right_big_toe"},
    {"right_big_toe", "right_small_toe"},
    {"left_wrist", "left_thumb"},
    {"left_wrist", "left_index"},
    {"left_wrist", "left_pinky"},
    {"left_index", "left_pinky"},
    {"right_wrist", "right_thumb"},
    {"right_wrist", "right_index"},
    {"right_wrist", "right_pinky"},
    {"right_index", "right_pinky"},
    {"neck", "left_shoulder"},
    {"neck", "right_shoulder"},
    {"neck", "mid_hip"},
    {"neck", "nose"},
    {"neck", "head_top"},
    {"mid_hip", "left_hip"},
    {"mid_hip", "right_hip"},
    {"upper_neck", "head_top"},
    {"upper_neck", "nose"},
    {"left_shoulder", "right_shoulder"},
    {"left_shoulder", "left_hip"},
    {"right_shoulder", "right_hip"},
    {"left_hip", "right_hip"},
    {"nose", "left_eye_inner"},
    {"left_eye_inner", "left_eye"},
    {"left_eye", "left_eye_outer"},
    {"left_eye_outer", "left_ear"},
    {"nose", "right_eye_inner"},
    {"right_eye_inner", "right_eye"},
    {"right_eye", "right_eye_outer"},
    {"right_eye_outer", "right_ear"},
    {"left_mouth", "right_mouth"},
    {"nose", "left_eye"},
    {"nose", "right_eye"},
    {"left_eye", "left_ear"},
    {"right_eye", "right_ear"},
});

std::string of_other_side(const std::string& name) {
  if (name.starts_with("left_")) return "right_" + name.substr(5);
  if (name.starts_with("right_")) return "left_" + name.substr(6);
  return name;
}

/// A trunk is drawn by its middle where the set has that, else by its sides; eyes beside the nose where nothing is between.
bool is_replaced(const KeypointSet& set, std::string_view from, std::string_view to) {
  const auto is = [&](std::string_view a, std::string_view b) { return from == a && to == b; };
  if (point_named(set, "left_eye_inner")) {
    if (is("nose", "left_eye") || is("nose", "right_eye") || is("left_eye", "left_ear") || is("right_eye", "right_ear"))
      return true;
  }
  const bool has_neck = point_named(set, "neck").has_value(), has_middle = point_named(set, "mid_hip").has_value();
  if (is("left_shoulder", "right_shoulder")) return has_neck;
  if (is("left_hip", "right_hip")) return has_middle;
  if (is("left_shoulder", "left_hip") || is("right_shoulder", "right_hip")) return has_neck && has_middle;
  return false;
}

std::vector<KeypointSet> presets() {
  using Names = std::vector<std::string>;
  const Names coco{"nose",           "left_eye",   "right_eye",   "left_ear",   "right_ear",   "left_shoulder",
                   "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_hip",
                   "right_hip",      "left_knee",  "right_knee",  "left_ankle", "right_ankle"};
  const auto with = [&](std::initializer_list<const char*> more) {
    Names names = coco;
    names.insert(names.end(), more.begin(), more.end());
    return names;
  };
  std::vector<KeypointSet> sets;
  sets.push_back(keypoint_set_of(
      "body_25", {"nose",       "neck",          "right_shoulder",  "right_elbow", "right_wrist", "left_shoulder", "left_elbow",
                  "left_wrist", "mid_hip",       "right_hip",       "right_knee",  "right_ankle", "left_hip",      "left_knee",
                  "left_ankle", "right_eye",     "left_eye",        "right_ear",   "left_ear",    "left_big_toe",  "left_small_toe",
                  "left_heel",  "right_big_toe", "right_small_toe", "right_heel"}));
  sets.push_back(keypoint_set_of("body_25b", with({"upper_neck", "head_top", "left_big_toe", "left_small_toe", "left_heel",
                                                   "right_big_toe", "right_small_toe", "right_heel"})));
  sets.push_back(keypoint_set_of("coco_18", {"nose", "neck", "right_shoulder", "right_elbow", "right_wrist", "left_shoulder",
                                             "left_elbow", "left_wrist", "right_hip", "right_knee", "right_ankle", "left_hip",
                                             "left_knee", "left_ankle", "right_eye", "left_eye", "right_ear", "left_ear"}));
  sets.push_back(keypoint_set_of("coco", coco));
  sets.push_back(keypoint_set_of("halpe_26", with({"head_top", "neck", "mid_hip", "left_big_toe", "right_big_toe", "left_small_toe",
                                                   "right_small_toe", "left_heel", "right_heel"})));
  sets.push_back(keypoint_set_of(
      "blazepose",
      {"nose",        "left_eye_inner", "left_eye",    "left_eye_outer", "right_eye_inner", "right_eye",      "right_eye_outer",
       "left_ear",    "right_ear",      "left_mouth",  "right_mouth",    "left_shoulder",   "right_shoulder", "left_elbow",
       "right_elbow", "left_wrist",     "right_wrist", "left_pinky",     "right_pinky",     "left_index",     "right_index",
       "left_thumb",  "right_thumb",    "left_hip",    "right_hip",      "left_knee",       "right_knee",     "left_ankle",
       "right_ankle", "left_heel",      "right_heel",  "left_big_toe",   "right_big_toe"}));
  return sets;
}

/// Lower case, words apart by one '_'; "RBigToe" is "r_big_toe".
std::string in_words(std::string_view name) {
  std::string words;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (std::isalnum(c) == 0) {
      if (!words.empty() && words.back() != '_') words += '_';
      continue;
    }
    const bool begins = std::isupper(c) != 0 && i > 0 &&
                        (std::islower(static_cast<unsigned char>(name[i - 1])) != 0 ||
                         (i + 1 < name.size() && std::islower(static_cast<unsigned char>(name[i + 1])) != 0));
    if (begins && !words.empty() && words.back() != '_') words += '_';
    words += static_cast<char>(std::tolower(c));
  }
  while (words.ends_with('_')) words.pop_back();
  return words;
}

}  // namespace

KeypointSet keypoint_set_of(std::string name, std::vector<std::string> points) {
  KeypointSet set{.name = std::move(name), .points = std::move(points), .bones = {}, .mirrored = {}};
  for (int i = 0; i < std::ssize(set.points); ++i)
    set.mirrored.push_back(point_named(set, of_other_side(set.points[static_cast<std::size_t>(i)])).value_or(i));
  for (const auto& [from, to] : kBones) {
    const auto a = point_named(set, from), b = point_named(set, to);
    if (a && b && !is_replaced(set, from, to)) set.bones.emplace_back(*a, *b);
  }
  return set;
}

std::span<const KeypointSet> keypoint_sets() {
  static const std::vector<KeypointSet> sets = presets();
  return sets;
}

std::string keypoint_set_names() {
  std::vector<std::string_view> names;
  for (const KeypointSet& set : keypoint_sets()) names.push_back(set.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

const KeypointSet& keypoint_set_named(std::string_view name) {
  for (const KeypointSet& set : keypoint_sets()) {
    if (set.name == name) return set;
  }
  throw Error("keypoint set \"{}\" is not known; there are {}", name, keypoint_set_names());
}

std::optional<int> point_named(const KeypointSet& set, std::string_view point) {
  const auto found = std::find(set.points.begin(), set.points.end(), point);
  if (found == set.points.end()) return std::nullopt;
  return static_cast<int>(found - set.points.begin());
}

std::string common_keypoint_name(std::string_view name) {
  std::string words = in_words(name);
  std::string side;
  for (const auto& [prefix, full] : {std::pair{"left_", "left_"}, {"right_", "right_"}, {"l_", "left_"}, {"r_", "right_"}}) {
    if (side.empty() && words.starts_with(prefix)) {
      side = full;
      words.erase(0, std::string_view(prefix).size());
    }
  }
  for (const auto& [suffix, full] : {std::pair{"_left", "left_"}, {"_right", "right_"}, {"_l", "left_"}, {"_r", "right_"}}) {
    if (side.empty() && words.ends_with(suffix)) {
      side = full;
      words.erase(words.size() - std::string_view(suffix).size());
    }
  }
  for (const auto& [other, common] : {std::pair{"hand", "wrist"},
                                      {"foot", "ankle"},
                                      {"bigtoe", "big_toe"},
                                      {"smalltoe", "small_toe"},
                                      {"foot_index", "big_toe"},
                                      {"toe", "big_toe"},
                                      {"index_finger", "index"}}) {
    if (!side.empty() && words == other) words = common;
  }
  for (const auto& [other, common] : {std::pair{"head", "head_top"},
                                      {"hip", "mid_hip"},
                                      {"pelvis", "mid_hip"},
                                      {"midhip", "mid_hip"},
                                      {"upperneck", "upper_neck"}}) {
    if (side.empty() && words == other) words = common;
  }
  return side + words;
}

}  // namespace marey
