#include "marey/edit/operation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/files/limits.h"
#include "marey/files/text_safety.h"

namespace marey::edit {
namespace {

using nlohmann::json;
using Kind = Operation::Kind;

constexpr std::array<std::pair<Kind, std::string_view>, 9> kKinds{{{Kind::rename, "rename"},
                                                                   {Kind::swap, "swap"},
                                                                   {Kind::split, "split"},
                                                                   {Kind::join, "join"},
                                                                   {Kind::remove, "delete"},
                                                                   {Kind::fill, "fill"},
                                                                   {Kind::team, "team"},
                                                                   {Kind::filter, "filter"},
                                                                   {Kind::turn, "turn"}}};
constexpr std::array<std::pair<FillMethod, std::string_view>, 3> kMethods{
    {{FillMethod::spline, "spline"}, {FillMethod::rigid, "rigid"}, {FillMethod::pattern, "pattern"}}};

template <typename Value, std::size_t Count>
std::string_view name_in(const std::array<std::pair<Value, std::string_view>, Count>& names, Value value) {
  return std::find_if(names.begin(), names.end(), [&](const auto& known) { return known.first == value; })->second;
}

template <typename Value, std::size_t Count>
std::optional<Value> value_in(const std::array<std::pair<Value, std::string_view>, Count>& names, std::string_view name) {
  const auto known = std::find_if(names.begin(), names.end(), [&](const auto& one) { return one.second == name; });
  return known == names.end() ? std::nullopt : std::optional(known->first);
}

json ids(const std::vector<TrackId>& tracks) {
  json list = json::array();
  for (const TrackId track : tracks) list.push_back(number(track));
  return list;
}

int id_of(const json& value) {
  const auto id = value.get<std::int64_t>();
  if (id <= 0 || id >= std::int64_t{1} << 31) throw json::other_error::create(500, "an id", &value);
  return static_cast<int>(id);
}

TrackId track_of(const json& value) {
  return TrackId{id_of(value)};
}

std::vector<TrackId> tracks_of(const json& list) {
  std::vector<TrackId> tracks;
  for (const json& id : list) tracks.push_back(track_of(id));
  return tracks;
}

FrameRange range_of(const json& value) {
  const FrameRange frames{value.at(0).get<std::int64_t>(), value.at(1).get<std::int64_t>()};
  if (frames.last < frames.first) throw json::other_error::create(500, "a range", &value);
  return frames;
}

double positive(const json& value) {
  const double number = value.get<double>();
  if (!(std::isfinite(number) && number >= 0)) throw json::other_error::create(500, "a number", &value);
  return number;
}

/// Sixteen hexadecimal digits a number, its bits from the highest on: exact, and read at once where there are many.
std::string digits_of(const std::vector<Vector<3>>& locations) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(48 * locations.size());
  for (const Vector<3>& location : locations) {
    for (const double value : location) {
      const auto bits = std::bit_cast<std::uint64_t>(value);
      for (int shift = 60; shift >= 0; shift -= 4) text += kDigits[(bits >> shift) & 15];
    }
  }
  return text;
}

std::vector<Vector<3>> positions_of(const json& value) {
  const auto& text = value.get_ref<const std::string&>();
  if (text.size() % 48 != 0) throw json::other_error::create(500, "places", &value);
  std::vector<Vector<3>> locations(text.size() / 48);
  std::size_t at = 0;
  for (Vector<3>& location : locations) {
    for (double& coordinate : location) {
      std::uint64_t bits = 0;
      for (int digit = 0; digit < 16; ++digit, ++at) {
        const char c = text[at];
        const int amount = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
        if (amount < 0) throw json::other_error::create(500, "places", &value);
        bits = bits << 4 | static_cast<std::uint64_t>(amount);
      }
      coordinate = std::bit_cast<double>(bits);
    }
    if (!location.allFinite()) throw json::other_error::create(500, "places", &value);
  }
  return locations;
}

FilledGap gap_of(const json& value) {
  FilledGap gap{.track = track_of(value.at("track")),
                .frames = range_of(value.at("frames")),
                .donors = tracks_of(value.value("donors", json::array())),
                .expected_m = positive(value.at("expected_m"))};
  const auto method = method_named(value.at("method").get<std::string>());
  if (!method) throw json::other_error::create(500, "a method", &value);
  gap.method = *method;
  if (value.contains("places")) gap.locations = positions_of(value["places"]);
  return gap;
}

/// How many tracks an operation names at least, and at most.
std::pair<std::size_t, std::size_t> tracks_required(Kind kind) {
  if (kind == Kind::rename || kind == Kind::split) return {1, 1};
  if (kind == Kind::swap || kind == Kind::join) return {2, 2};
  if (kind == Kind::fill || kind == Kind::turn) return {0, 0};
  return {1, SIZE_MAX};
}

Operation parsed(Kind kind, const json& payload) {
  Operation operation{.kind = kind};
  operation.tracks = tracks_of(payload.value("tracks", json::array()));
  if (payload.contains("frames")) operation.frames = range_of(payload["frames"]);
  operation.label = plain_text(payload.value("label", std::string()));
  if (operation.label.size() > Limits::in_force().label_bytes) throw json::other_error::create(500, "a name", &payload);
  if (payload.contains("born")) operation.initiated = track_of(payload["born"]);
  for (const json& gap : payload.value("gaps", json::array())) operation.gaps.push_back(gap_of(gap));
  for (const json& cutoff : payload.value("cutoffs_hz", json::array())) operation.cutoffs_hz.push_back(positive(cutoff));
  if (payload.contains("body")) operation.body = BodyId{id_of(payload["body"])};
  const auto [minimum, maximum] = tracks_required(kind);
  const bool whole = operation.tracks.size() >= minimum && operation.tracks.size() <= maximum &&
                     (kind != Kind::split || (operation.initiated && operation.frames)) &&
                     (kind != Kind::fill || !operation.gaps.empty()) && (kind != Kind::turn || operation.body) &&
                     (kind != Kind::filter || operation.cutoffs_hz.size() == operation.tracks.size());
  if (!whole) throw json::other_error::create(500, "its parts", &payload);
  return operation;
}

}  // namespace

std::string_view name_of(Kind kind) {
  return name_in(kKinds, kind);
}

std::optional<Kind> kind_named(std::string_view name) {
  return value_in(kKinds, name);
}

std::string_view name_of(FillMethod method) {
  return name_in(kMethods, method);
}

std::optional<FillMethod> method_named(std::string_view name) {
  return value_in(kMethods, name);
}

Edit edit_of(const Operation& operation) {
  json payload = json::object();
  if (!operation.tracks.empty()) payload["tracks"] = ids(operation.tracks);
  if (operation.body) payload["body"] = number(*operation.body);
  if (operation.frames) payload["frames"] = {operation.frames->first, operation.frames->last};
  if (!operation.label.empty()) payload["label"] = operation.label;
  if (operation.initiated) payload["born"] = number(*operation.initiated);
  for (const FilledGap& gap : operation.gaps) {
    json entry{{"track", number(gap.track)},
               {"frames", {gap.frames.first, gap.frames.last}},
               {"method", name_of(gap.method)},
               {"expected_m", gap.expected_m}};
    if (!gap.donors.empty()) entry["donors"] = ids(gap.donors);
    if (!gap.locations.empty()) entry["places"] = digits_of(gap.locations);
    payload["gaps"].push_back(std::move(entry));
  }
  if (!operation.cutoffs_hz.empty()) payload["cutoffs_hz"] = operation.cutoffs_hz;
  return {.id = 0,
          .parent = {},
          .operation = std::string(name_of(operation.kind)),
          .payload = payload.dump(-1, ' ', false, json::error_handler_t::replace)};
}

bool is_known(const Edit& edit) {
  return edit.operation == "note" || kind_named(edit.operation);
}

std::optional<Operation> operation_of(const Edit& edit) {
  const auto kind = kind_named(edit.operation);
  if (!kind) return std::nullopt;
  try {
    return parsed(*kind, json::parse(edit.payload));
  } catch (const json::exception&) {
    throw Error("edit {} ({}) is damaged: what it was done to cannot be read", edit.id, edit.operation);
  }
}

}  // namespace marey::edit
