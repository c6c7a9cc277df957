#include "marey/pipeline/people/ground_defaults.h"

#include <algorithm>

namespace marey::pipeline::people {

PeopleOnGroundOptions resolved(PeopleOnGroundOptions options, const Rig& rig, const GroundChoices& choices) {
  using Association = track::ground::GroundAssociation;
  options.learn.walk = !choices.filter;
  options.tracker.associate = choices.association.value_or(options.live ? Association::gnn : Association::mht);
  // Compared with decoding and detection, hypotheses cost little; detections alone arrive too fast for them.
  const auto has_images = [](const RigCamera& camera) { return !camera.source.empty(); };
  options.learn.association = !choices.association && std::none_of(rig.cameras.begin(), rig.cameras.end(), has_images);
  const bool bounded = options.pitch || !options.area.empty();
  if (!bounded && rig.calibration && rig.calibration->method == "pitch") options.pitch.emplace();
  return options;
}

}  // namespace marey::pipeline::people
