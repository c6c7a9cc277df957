#include "scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "marey/core/ground_transform.h"
#include "marey/core/keypoint_sets.h"
#include "marey/geometry/camera.h"

#include "json_value.h"

namespace marey::viewer {
namespace {

using cli::Json;

constexpr double kMaxShownDigits = 1e4;  // a tenth of a millimetre

Json rounded(double value) {
  return std::round(value * kMaxShownDigits) / kMaxShownDigits;
}

Json json_of(const Vector<3>& location) {
  Json list = Json::array();
  for (int axis = 0; axis < 3; ++axis) list.push_back(rounded(location[axis]));
  return list;
}

Json json_of(const TrackName& name) {
  Json track{{"id", number(name.id)}, {"label", name.label}, {"team", name.team}};
  if (name.colour) track["colour"] = Json(*name.colour);
  return track;
}

Json json_of(const RecordingState::Course& course) {
  Json track = json_of(course.name);
  track["rows"] = course.rows;
  track["measured"] = course.measured;
  track["first"] = course.first_s;
  track["last"] = course.last_s;
  track["version"] = course.version;
  track["within"] = course.last_instant - course.first_instant + 1;
  return track;
}

Json json_of(const Body& body) {
  Json json{{"id", number(body.id)}, {"label", body.label}, {"skeleton", body.skeleton}, {"markers", Json::array()}};
  if (body.parent) json["parent"] = number(*body.parent);
  if (body.end) json["end"] = json_of(*body.end);
  for (const BodyMarker& marker : body.markers) json["markers"].push_back(json_of(marker.position));
  return json;
}

/// Where it stands, and where it points: the directions of its image's corners, length 1.
Json json_of(const RigCamera& camera) {
  Json json{{"name", camera.name}};
  if (camera.size) json["size"] = Json(std::array{camera.size->width, camera.size->height});
  const std::optional<Camera> whole = camera.camera();
  if (!whole) return json;
  json["centre"] = json_of(whole->centre());
  const double right = whole->size().width - 1, bottom = whole->size().height - 1;
  Json corners = Json::array();
  for (const Vector<2>& pixel : {Vector<2>(0, 0), Vector<2>(right, 0), Vector<2>(right, bottom), Vector<2>(0, bottom)}) {
    if (const std::optional<Ray> ray = whole->ray(pixel)) corners.push_back(json_of(ray->direction));
  }
  json["corners"] = corners;
  return json;
}

/// Of all keypoint sets, by the points' names: which of them there will be is not known before a live run's first person.
Json named_bones() {
  std::set<std::pair<std::string, std::string>> bones;
  for (const KeypointSet& set : keypoint_sets()) {
    for (const auto& [from, to] : set.bones)
      bones.emplace(set.points[static_cast<std::size_t>(from)], set.points[static_cast<std::size_t>(to)]);
  }
  Json list = Json::array();
  for (const auto& [from, to] : bones) list.push_back(Json(std::array{from, to}));
  return list;
}

const char* frame_name(FrameOfReference::Kind kind) {
  switch (kind) {
    case FrameOfReference::Kind::image:
      return "image";
    case FrameOfReference::Kind::ground:
    case FrameOfReference::Kind::user_ground:
      return "ground";
    case FrameOfReference::Kind::space:
      break;
  }
  return "space";
}

Json header_json(const RecordingHeader& header) {
  Json scene{{"name", header.name},      {"frame", frame_name(header.frame.kind)},
             {"rate", header.rate_hz},   {"made_by", header.made_by.program},
             {"cameras", Json::array()}, {"bodies", Json::array()}};
  for (const Body& body : header.bodies) scene["bodies"].push_back(json_of(body));
  if (header.keypoints) {
    scene["keypoints"] = Json(header.keypoints->points);
    scene["bones"] = Json::array();
    for (const auto& [from, to] : header.keypoints->bones) scene["bones"].push_back(Json(std::array{from, to}));
  } else if (header.track_kind == TrackKind::keypoint) {
    scene["named_bones"] = named_bones();
  }
  if (!header.rig) return scene;
  for (const RigCamera& camera : header.rig->cameras) scene["cameras"].push_back(json_of(camera));
  if (header.frame.kind == FrameOfReference::Kind::image) {
    const auto shown = static_cast<std::size_t>(header.frame.camera ? number(*header.frame.camera) : 0);
    scene["camera"] = shown;
    if (shown < header.rig->cameras.size() && header.rig->cameras[shown].size)
      scene["size"] = Json(std::array{header.rig->cameras[shown].size->width, header.rig->cameras[shown].size->height});
  }
  return scene;
}

/// Whether places from `low` to `high` lie on a pitch that begins at `corner`, and use at least half of it.
bool fits_pitch(const Extent& extent, const geometry::PitchSize& pitch, const Vector<2>& corner) {
  constexpr double kMargin = 8;  // m: bench, linesmen, keepers behind their lines
  const Vector<2> size(pitch.length, pitch.width), low = extent.low.head<2>() - corner, high = extent.high.head<2>() - corner;
  return (low.array() > -kMargin).all() && ((high - size).array() < kMargin).all() &&
         ((high - low).array() > 0.5 * size.array()).all();
}

/// The pitch's corner and size; null where people move on some other ground.
Json pitch_json(const GroundChoice& choice, const std::optional<Extent>& extent) {
  const geometry::PitchSize size = choice.pitch.value_or(geometry::PitchSize{});
  const Vector<2> middle(size.length / 2, size.width / 2), none = Vector<2>::Zero();
  Vector<2> corner = choice.centred ? Vector<2>(-middle) : none;
  if (!choice.pitch) {
    if (!extent) return {};
    const bool here = fits_pitch(*extent, size, corner);
    if (!here && !fits_pitch(*extent, size, -middle)) return {};
    if (!here) corner = -middle;
  }
  return Json{{"length", size.length}, {"width", size.width}, {"x", corner.x()}, {"y", corner.y()}};
}

void add_extent(Json& scene, const std::optional<Extent>& extent) {
  if (!extent) return;
  scene["low"] = json_of(extent->low);
  scene["high"] = json_of(extent->high);
}

/// `pitch`: its corner and size, or null.
void add_ground(Json& scene, const RecordingHeader& header, std::optional<bool> y_down, const Json& pitch) {
  if (frame_name(header.frame.kind) != std::string_view("ground")) return;
  scene["pitch"] = pitch;
  scene["y_down"] = y_down ? *y_down : y_grows_down(header);
}

}  // namespace

std::string scene_text(const RecordingHeader& header, const RecordingState& state, const GroundChoice& ground,
                       const SceneCan& can) {
  Json scene = header_json(header);
  scene["kind"] = "recording";
  scene["video"] = can.show_video;
  scene["can_edit"] = can.edit;
  scene["instants"] = state.instants;
  scene["last"] = state.last_s;
  scene["complete"] = state.complete;
  scene["warnings"] = Json(state.warnings);
  scene["chunks"] = Json::array();
  for (const RecordingState::TimeChunk& segment : state.segments) {
    Json one = Json::array();
    one.push_back(segment.first_s);
    one.push_back(segment.instants);
    one.push_back(segment.rows);
    one.push_back(segment.version);
    scene["chunks"].push_back(one);
  }
  scene["tracks"] = Json::array();
  for (const RecordingState::Course& course : state.tracks) scene["tracks"].push_back(json_of(course));
  add_extent(scene, state.extent);
  add_ground(scene, header, ground.y_down, pitch_json(ground, state.extent));
  return compact(scene);
}

std::string scene_text(const RecordingHeader& header, const LiveScene& live) {
  Json scene = header_json(header);
  scene["kind"] = "live";
  scene["can_record"] = live.can_record;
  scene["can_change"] = live.can_change;
  if (!live.job.empty()) scene["job"] = live.job;
  if (!live.rig_file.empty()) scene["rig_file"] = live.rig_file;
  add_extent(scene, live.extent);
  // No pitch is inferred from where people are so far: the view would jump.
  add_ground(scene, header, live.ground.y_down, live.ground.pitch ? pitch_json(live.ground, live.extent) : Json());
  scene["tracks"] = Json::array();
  for (const TrackName& name : live.names) scene["tracks"].push_back(json_of(name));
  return compact(scene);
}

}  // namespace marey::viewer
