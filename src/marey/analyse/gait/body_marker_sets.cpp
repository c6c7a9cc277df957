#include "marey/analyse/gait/body_marker_sets.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"

namespace marey::analyse::gait {
namespace {

using enum SegmentId;

// The Graphics Lab Motion Capture Database's labels, as its C3D files have them.
constexpr std::array<SetMarker, 23> kCmu = {{
    {"?FHD", head, "?FHD"},
    {"?BHD", head, "?BHD"},
    {"C7", trunk, "C7"},
    {"T10", trunk, "T10"},
    {"CLAV", trunk, "CLAV"},
    {"STRN", trunk, "STRN"},
    {"RBAC", trunk, "RBAK"},
    {"?SHO", left_clavicle, "?SHO"},
    {"?UPA", left_upper_arm, "?UPA"},
    {"?ELB", left_upper_arm, "?ELB"},
    {"?FRM", left_forearm, "?FRM"},
    {"?WRA", left_forearm, "?WRA"},
    {"?WRB", left_forearm, "?WRB"},
    {"?FIN", left_hand, "?FIN"},
    {"?FWT", pelvis, "?ASI"},
    {"?BWT", pelvis, "?PSI"},
    {"?THI", left_thigh, "?THI"},
    {"?KNE", left_thigh, "?KNE"},
    {"?SHN", left_shank, "?TIB"},
    {"?ANK", left_shank, "?ANK"},
    {"?HEE", left_foot, "?HEE"},
    {"?TOE", left_foot, "?TOE"},
    {"?MT5", left_foot},
}};
constexpr std::array<std::string_view, 8> kCmuNeeds = {"?FWT", "?BWT", "?THI", "?KNE", "?SHN", "?ANK", "?HEE", "?TOE"};

// Helen Hayes: a wand on thigh and shank, knees and ankles on both sides; by the names of OpenSim's example gait2354.
constexpr std::array<SetMarker, 25> kClevelandClinic = {{
    {"?.ASIS", pelvis, "?ASI"},
    {"V.Sacral", pelvis, "SACR"},
    {"?.Thigh.Upper", left_thigh, "?THI"},
    {"?.Knee.Lat", left_thigh, "?KNE"},
    {"?.Knee.Med", left_thigh, "?KNM"},
    {"?.Shank.Upper", left_shank, "?TIB"},
    {"?.Ankle.Lat", left_shank, "?ANK"},
    {"?.Ankle.Med", left_shank, "?ANM"},
    {"?.Heel", left_foot, "?HEE"},
    {"?.Toe.Tip", left_foot, "?TOE"},
    {"?.Toe.Lat", left_foot},
    {"?.Toe.Med", left_foot},
    {"?.Midfoot.Sup", left_foot},
    {"?.Midfoot.Lat", left_foot},
    {"Sternum", trunk, "STRN"},
    {"?.Acromium", left_clavicle, "?SHO"},
    {"?.Bicep", left_upper_arm, "?UPA"},
    {"?.Elbow", left_upper_arm, "?ELB"},
    {"?.Wrist.Lat", left_forearm, "?WRA"},
    {"?.Wrist.Med", left_forearm, "?WRB"},
    // The Cleveland Clinic's triads continue from here.
    {"?.Thigh.Front", left_thigh},
    {"?.Thigh.Rear", left_thigh},
    {"?.Shank.Front", left_shank},
    {"?.Shank.Rear", left_shank},
    {"Top.Head", head},
}};
constexpr std::array<std::string_view, 8> kHelenHayesNeeds = {"?.ASIS",        "V.Sacral",    "?.Thigh.Upper", "?.Knee.Lat",
                                                              "?.Shank.Upper", "?.Ankle.Lat", "?.Heel",        "?.Toe.Tip"};
constexpr std::array<std::string_view, 12> kClevelandNeeds = {"?.ASIS",       "V.Sacral",    "?.Thigh.Upper", "?.Thigh.Front",
                                                              "?.Thigh.Rear", "?.Knee.Lat",  "?.Shank.Upper", "?.Shank.Front",
                                                              "?.Shank.Rear", "?.Ankle.Lat", "?.Heel",        "?.Toe.Tip"};
constexpr std::size_t kTriads = 20;  // the table's first markers are Helen Hayes'

constexpr std::array<std::string_view, 8> kPlugInGaitNeeds = {"LASI", "RASI", "?THI", "?KNE", "?TIB", "?ANK", "?HEE", "?TOE"};

bool is_below_waist(SegmentId segment) {
  constexpr std::array kBelow{pelvis, left_thigh, left_shank, left_foot, right_thigh, right_shank, right_foot};
  return std::find(kBelow.begin(), kBelow.end(), segment) != kBelow.end();
}

std::string on_side(std::string_view text, char side) {
  std::string sided(text);
  std::replace(sided.begin(), sided.end(), '?', side);
  return sided;
}

std::vector<SetMarker> plug_in_gait_table() {
  std::vector<SetMarker> table;
  for (const std::string_view label : plug_in_gait_markers()) table.push_back({label, *segment_of_marker(label), label});
  return table;
}

const std::vector<BodyMarkerSet>& all_sets() {
  static const std::vector<BodyMarkerSet> sets = {
      {"plug-in-gait", "Plug-in Gait", plug_in_gait_table(), kPlugInGaitNeeds},
      {"cmu-41", "CMU's 41 markers", kCmu, kCmuNeeds},
      {"helen-hayes", "Helen Hayes", std::span(kClevelandClinic).first(kTriads), kHelenHayesNeeds},
      {"cleveland-clinic", "Cleveland Clinic", kClevelandClinic, kClevelandNeeds}};
  return sets;
}

}  // namespace

BodyMarkerSet::BodyMarkerSet(std::string_view name, std::string_view title, std::span<const SetMarker> markers,
                             std::span<const std::string_view> needed)
    : name_(name), title_(title) {
  for (const SetMarker& marker : markers) {
    const std::string_view key = marker.role.empty() ? marker.label : marker.role;
    if (marker.label.find('?') == std::string_view::npos) {
      markers_.push_back({std::string(marker.label), std::string(key), marker.segment});
      continue;
    }
    for (const Side side : kSides) {
      const char letter = side == Side::left ? 'L' : 'R';
      const bool middle = static_cast<int>(marker.segment) < static_cast<int>(left_thigh);
      markers_.push_back(
          {on_side(marker.label, letter), on_side(key, letter), middle ? marker.segment : of_side(marker.segment, side)});
    }
  }
  for (const std::string_view label : needed) {
    for (const char letter : {'L', 'R'}) {
      if (letter == 'L' || label.find('?') != std::string_view::npos) needed_.push_back(on_side(label, letter));
    }
  }
}

std::vector<std::string> BodyMarkerSet::labels() const {
  std::vector<std::string> labels;
  for (const Marker& marker : markers_) labels.push_back(marker.label);
  return labels;
}

const BodyMarkerSet::Marker* BodyMarkerSet::find(std::string_view label) const {
  const auto found = std::find_if(markers_.begin(), markers_.end(), [&](const Marker& marker) { return marker.label == label; });
  return found == markers_.end() ? nullptr : &*found;
}

std::optional<std::string> BodyMarkerSet::key_of(std::string_view label) const {
  const Marker* const marker = find(label);
  return marker == nullptr ? std::nullopt : std::optional(marker->key);
}

std::string BodyMarkerSet::label_of(std::string_view key) const {
  const auto found = std::find_if(markers_.begin(), markers_.end(), [&](const Marker& marker) { return marker.key == key; });
  return found == markers_.end() ? std::string(key) : found->label;
}

std::optional<SegmentId> BodyMarkerSet::segment_of_label(std::string_view label) const {
  const Marker* const marker = find(label);
  return marker == nullptr ? std::nullopt : std::optional(marker->segment);
}

std::optional<SegmentId> BodyMarkerSet::segment_of(std::string_view key) const {
  const auto found = std::find_if(markers_.begin(), markers_.end(), [&](const Marker& marker) { return marker.key == key; });
  return found == markers_.end() ? std::nullopt : std::optional(found->segment);
}

std::vector<std::string> BodyMarkerSet::missing(const std::set<std::string, std::less<>>& labels) const {
  std::vector<std::string> lacking;
  for (const std::string& label : needed_) {
    if (!labels.contains(label)) lacking.push_back(label);
  }
  return lacking;
}

const BodyMarkerSet& plug_in_gait() {
  return all_sets().front();
}

std::span<const BodyMarkerSet> body_marker_sets() {
  return all_sets();
}

const BodyMarkerSet& body_marker_set(std::string_view name) {
  std::vector<std::string_view> names;
  for (const BodyMarkerSet& set : all_sets()) {
    if (set.name() == name) return set;
    names.push_back(set.name());
  }
  throw Error("{}: no marker set that Marey knows; there are {}", name, fmt::join(names, ", "));
}

std::vector<std::string> marker_set_labels(std::string_view name) {
  constexpr std::string_view kLower = "-lower";
  std::vector<std::string> names;
  for (const BodyMarkerSet& set : all_sets()) {
    std::vector<std::string> labels = set.labels();
    if (set.name() == name) return labels;
    names.emplace_back(set.name());
    names.push_back(fmt::format("{}{}", set.name(), kLower));
    if (names.back() != name) continue;
    std::erase_if(labels, [&](const std::string& label) { return !is_below_waist(*set.segment_of_label(label)); });
    return labels;
  }
  throw Error("{}: no marker set that Marey knows; there are {}", name, fmt::join(names, ", "));
}

const BodyMarkerSet& recognised_marker_set(const std::set<std::string, std::less<>>& labels) {
  const BodyMarkerSet *best = nullptr, *second = nullptr, *nearest = &all_sets().front();
  const auto known = [&](const BodyMarkerSet& set) {
    return std::count_if(labels.begin(), labels.end(), [&](const std::string& label) { return set.has(label); });
  };
  for (const BodyMarkerSet& set : all_sets()) {
    if (set.missing(labels).size() < nearest->missing(labels).size()) nearest = &set;
    if (!set.missing(labels).empty()) continue;
    if (best == nullptr || known(set) > known(*best)) {
      second = nullptr;
      best = &set;
    } else if (known(set) == known(*best)) {
      second = &set;
    }
  }
  if (best == nullptr)
    throw Error("its labels are not a whole marker set that Marey knows; {} is nearest, and lacks {}", nearest->title(),
                fmt::join(nearest->missing(labels), ", "));
  if (second != nullptr)
    throw Error("its labels are as well those of {} as of {}: say which by --marker-set", best->title(), second->title());
  return *best;
}

}  // namespace marey::analyse::gait
