#include "marey/core/ground_transform.h"

#include <utility>

#include <Eigen/LU>

namespace marey {
namespace {

TrackColumns changed(const TrackColumns& track, const GroundChange& change) {
  TrackColumns result(track.name, track.dimensions());
  result.reserve(track.size());
  for (std::size_t row = 0; row < track.size(); ++row) {
    Sample sample = track.sample(row);
    sample.position.head<2>() = change.location(track.location(row));
    if (sample.velocity) sample.velocity->head<2>() = change.linear * Vector<2>(sample.velocity->head<2>());
    if (sample.covariance) {
      const Matrix<2> covariance = sample.covariance->topLeftCorner<2, 2>();
      sample.covariance->topLeftCorner<2, 2>() = change.linear * covariance * change.linear.transpose();
      const Vector<2> with_height = change.linear * Vector<2>(sample.covariance->topRightCorner<2, 1>());
      sample.covariance->topRightCorner<2, 1>() = with_height;
      sample.covariance->bottomLeftCorner<1, 2>() = with_height.transpose();
    }
    result.add(track.at()[row], sample);
  }
  return result;
}

}  // namespace

Recording on_other_ground(Recording recording, const FrameOfReference& frame, const GroundChange& change) {
  require_ground(recording, "another frame of reference");
  std::vector<TrackColumns> tracks = recording.take_tracks();
  Recording result = std::move(recording);
  result.header.frame = frame;
  for (TrackColumns& track : tracks) {
    result.put(changed(track, change));
    track = TrackColumns({}, 2);
  }
  return result;
}

bool is_reflection(const Matrix<3>& ground_from_world) {
  return ground_from_world.topLeftCorner<2, 2>().determinant() < 0;
}

bool y_grows_down(const RecordingHeader& header) {
  return header.frame.kind == FrameOfReference::Kind::user_ground && header.rig && header.rig->ground_from_world &&
         is_reflection(*header.rig->ground_from_world);
}

void set_y_down(RecordingHeader& header, bool down) {
  if (header.rig && header.rig->ground_from_world) return;
  if (!header.rig) header.rig.emplace();
  header.rig->ground_from_world = Matrix<3>(Vector<3>(1, down ? -1 : 1, 1).asDiagonal());
}

}  // namespace marey
