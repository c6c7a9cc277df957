#include "marey/edit/turn_body.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"

namespace marey::edit {
namespace {

bool is_within(const Recording& recording, const std::optional<FrameRange>& frames, std::int32_t at) {
  return !frames || frames->holds(recording.instants()[static_cast<std::size_t>(at)].index);
}

}  // namespace

Operation decide_turn(const Request& request, const Recording& recording) {
  const std::string& name = request.tracks.front();
  const auto& bodies = recording.header.bodies;
  const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const Body& one) { return one.label == name; });
  if (body == bodies.end()) throw Error("turn: there is no body called \"{}\"", plain_text(name));
  const BodyColumns* poses = recording.find(body->id);
  bool any = false;
  for (std::size_t row = 0; poses != nullptr && row < poses->size(); ++row)
    any |= poses->other().known(row) && is_within(recording, request.frames, poses->at()[row]);
  if (!any)
    throw Error("turn: \"{}\" has no other pose in question {}", plain_text(name), request.frames ? "in these frames" : "anywhere");
  Operation operation{.kind = Operation::Kind::turn, .frames = request.frames};
  operation.body = body->id;
  return operation;
}

void turn_body(Recording& recording, const Operation& operation) {
  const BodyColumns* poses = recording.find(operation.body.value());
  if (poses == nullptr) throw Error("there is no body {}", number(*operation.body));
  BodyColumns turned(poses->body());
  for (std::size_t row = 0; row < poses->size(); ++row) {
    BodyPose pose = poses->pose(row);
    if (pose.other && is_within(recording, operation.frames, poses->at()[row])) {
      std::swap(pose.world_from_body, pose.other->world_from_body);
      pose.other->probability = 1 - pose.other->probability;
    }
    turned.add(poses->at()[row], pose);
  }
  recording.put(std::move(turned));
}

}  // namespace marey::edit
