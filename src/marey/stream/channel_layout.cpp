#include "marey/stream/channel_layout.h"

#include <algorithm>

#include "marey/files/text_safety.h"

namespace marey::stream {
namespace {

/// Shirts have the same number in both teams: a team's name stands before it.
std::string shown_label(const TrackName& name) {
  if (name.label.empty()) return {};
  return plain_text(name.team.empty() ? name.label : name.team + " " + name.label);
}

}  // namespace

void ChannelLayout::begin(const RecordingHeader& header) {
  *this = {};
  for (const Body& body : header.bodies) {
    if (body.skeleton.empty()) {
      bodies_.push_back(body);
      continue;
    }
    const auto known =
        std::find_if(skeletons_.begin(), skeletons_.end(), [&](const auto& each) { return each.name == body.skeleton; });
    auto& skeleton = known == skeletons_.end() ? skeletons_.emplace_back(Skeleton{body.skeleton, {}}) : *known;
    skeleton.segments.push_back(body);
  }
}

bool ChannelLayout::add(std::span<const TrackName> names) {
  const std::size_t before = labels_.size();
  for (const TrackName& name : names) {
    const std::string label = shown_label(name);
    if (label.empty()) {
      position_of_track_.erase(number(name.id));
      continue;
    }
    const auto [it, is_new] = position_of_.emplace(label, labels_.size());
    if (is_new) labels_.push_back(label);
    position_of_track_[number(name.id)] = it->second;
  }
  return labels_.size() > before;
}

std::string_view ChannelLayout::label_of(TrackId track) const {
  const auto found = position_of_track_.find(number(track));
  return found == position_of_track_.end() ? std::string_view() : std::string_view(labels_[found->second]);
}

void ChannelLayout::location(const Instant& instant, Scene& scene) const {
  scene.labelled.assign(labels_.size(), nullptr);
  scene.others.clear();
  for (const Sample& sample : instant.samples) {
    const auto found = position_of_track_.find(number(sample.track));
    if (found == position_of_track_.end() || scene.labelled[found->second] != nullptr) {
      scene.others.push_back(&sample);
    } else {
      scene.labelled[found->second] = &sample;
    }
  }
}

const BodyPose* pose_of(const Instant& instant, BodyId body) {
  const auto found = std::lower_bound(instant.bodies.begin(), instant.bodies.end(), body,
                                      [](const BodyPose& pose, BodyId id) { return pose.body < id; });
  return found != instant.bodies.end() && found->body == body ? &*found : nullptr;
}

Rigid3 in_parent(const BodyPose& parent, const BodyPose& child) {
  return parent.world_from_body.inverse() * child.world_from_body;
}

}  // namespace marey::stream
