// A simulated room as files: what a scene of `simulate` shows goes through the writers of observations, rigs, bodies and videos.
#include "marey/pipeline/simulate/room_files.h"

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/files/whole_file.h"
#include "marey/format/bodies/body_file.h"
#include "marey/format/keypoints/keypoint_file.h"
#include "marey/format/observations.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/pipeline/corridor/video_file.h"
#include "marey/simulate/random.h"

namespace marey::pipeline::simulate {
namespace {

namespace fs = std::filesystem;
using marey::simulate::room::RoomFrame;
using marey::simulate::room::RoomScene;

void write_room_text(const fs::path& path, std::string_view text) {
  WholeFile file(path.string());
  file.write(text);
  file.finish();
}

format::ObservedFrame observed_of(const RoomFrame& frame, const std::vector<std::string>& labels) {
  format::ObservedFrame detected;
  detected.frame = frame.index;
  for (int camera = 0; camera < std::ssize(frame.detected); ++camera) {
    for (const marey::simulate::room::RoomBlob& blob : frame.detected[static_cast<std::size_t>(camera)]) {
      detected.points.push_back({CameraId{camera}, blob.pixel, blob.marker ? labels[static_cast<std::size_t>(*blob.marker)] : ""});
    }
  }
  return detected;
}

std::string truth_rows(const RoomScene& scene, const RoomFrame& frame) {
  const std::vector<int> cameras = marey::simulate::room::cameras_that_observe(scene, frame);
  std::string text;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    const Vector<3>& p = frame.points[i];
    fmt::format_to(std::back_inserter(text), "{},{:.6f},{},{:.6f},{:.6f},{:.6f},{}\n", frame.index, frame.time_s, scene.labels()[i],
                   p.x(), p.y(), p.z(), cameras[i]);
  }
  return text;
}

Rig with_sources(Rig rig, bool videos) {
  for (RigCamera& camera : rig.cameras) camera.source = videos ? camera.name + ".mp4" : "";
  return rig;
}

void write_labels(const RoomScene& scene, const fs::path& folder) {
  std::string text = "label,x,y,z\n";
  const std::vector<Vector<3>> points = scene.points(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{},{:.6f},{:.6f},{:.6f}\n", scene.labels()[i], points[i].x(), points[i].y(),
                   points[i].z());
  }
  write_room_text(folder / "labels.csv", text);
}

void write_room_rigs(const RoomScene& scene, const fs::path& folder, const RoomFilesOptions& options) {
  const bool videos = options.videos;
  const auto write = [&](const Rig& rig, const char* name) { write_room_text(folder / name, format::rig::rig_text(rig)); };
  Rig truth = with_sources(scene.rig(), videos);
  for (std::size_t c = 0; c < truth.cameras.size() && options.keypoint_errors.drift > 0; ++c)
    truth.cameras[c].rate_hz =
        scene.options().rate_hz / (1 + marey::simulate::room::clock_drift(scene, static_cast<int>(c), options.keypoint_errors));
  truth.calibration = Rig::Calibration{
      .method = "simulated: the exact truth", .mean_px = {}, .rms_px = {}, .inliers = {}, .observations = {}, .grade = {}};
  write(truth, "rig.toml");
  if (const auto& bump = scene.options().bump) write(with_sources(scene.rig_at(bump->time_s), videos), "rig_after.toml");
  Rig start = with_sources(scene.rig(), videos);
  for (RigCamera& camera : start.cameras) {
    camera.camera_from_world.reset();
    camera.offset_s = 0;
  }
  write(start, "start.toml");
}

/// "skeleton.toml" of the first person, "skeleton2.toml" of the second.
fs::path of_actor(const fs::path& folder, std::string_view stem, int actor, std::string_view ending) {
  return folder / fmt::format("{}{}{}", stem, actor == 0 ? "" : std::to_string(actor + 1), ending);
}

/// What the bodies' joints do, a row a frame.
class TrueAngles {
 public:
  TrueAngles(const RoomScene& scene, int actor, const fs::path& folder)
      : scene_(scene), actor_(actor), body_(*scene.skeleton(actor)), file_(of_actor(folder, "angles", actor, ".csv").string()) {
    std::string head = "frame,time";
    for (const Coordinate& coordinate : body_.coordinates) head.append(1, ',').append(coordinate.name);
    file_.write(head + '\n');
  }

  void write(const RoomFrame& frame) {
    const std::vector<double> values = scene_.coordinates(frame.time_s, actor_);
    std::string row = fmt::format("{},{:.6f}", frame.index, frame.time_s);
    for (std::size_t c = 0; c < values.size(); ++c)
      fmt::format_to(std::back_inserter(row), ",{:.6f}",
                     values[c] * (body_.coordinates[c].is_rotation ? 180 / std::numbers::pi : 1));
    file_.write(row + '\n');
  }

  void finish() { file_.finish(); }

 private:
  const RoomScene& scene_;
  int actor_;
  Skeleton body_;
  WholeFile file_;
};

/// Where all bodies are: the people's segments, by person, then the rigid ones.
class TruePoses {
 public:
  TruePoses(const RoomScene& scene, const fs::path& folder)
      : scene_(scene),
        sink_(format::create_recording((folder / "poses.csv").string(), *format::format_named("poses", format::Content::space))) {
    RecordingHeader header;
    header.frame.kind = FrameOfReference::Kind::space;
    header.rate_hz = scene.options().rate_hz;
    for (int actor = 0; actor < scene.actors(); ++actor) {
      const auto first = std::ssize(header.bodies);
      for (Body segment : bodies_of(*scene.skeleton(actor))) {
        if (segment.parent) segment.parent = BodyId{number(*segment.parent) + static_cast<int>(first)};
        add(header, std::move(segment));
      }
    }
    for (const Body& prop : scene.props()) add(header, prop);
    sink_->begin(header);
  }

  void write(const RoomFrame& frame) {
    Instant instant{.index = frame.index,
                    .time = timestamp_from_seconds(frame.time_s),
                    .samples = {},
                    .detected = {},
                    .bodies = {},
                    .named = {},
                    .boxes = {},
                    .frames = {}};
    const auto put = [&](const std::vector<Rigid3>& poses) {
      for (const Rigid3& pose : poses)
        instant.bodies.push_back(
            {.body = ids_[instant.bodies.size()], .world_from_body = pose, .covariance = {}, .residual_m = {}});
    };
    for (int actor = 0; actor < scene_.actors(); ++actor) put(scene_.segments(frame.time_s, actor));
    put(scene_.prop_poses(frame.time_s));
    sink_->write(instant);
  }

  void finish() { sink_->finish(); }

 private:
  void add(RecordingHeader& header, Body body) {
    body.id = BodyId{static_cast<int>(header.bodies.size()) + 1};
    ids_.push_back(body.id);
    header.bodies.push_back(std::move(body));
  }

  const RoomScene& scene_;
  std::unique_ptr<Sink> sink_;
  std::vector<BodyId> ids_;
};

/// Points in space as a system gives them that knows no names.
class UnnamedPoints {
 public:
  UnnamedPoints(const RoomScene& scene, const fs::path& folder)
      : scene_(scene), file_((folder / "unnamed.csv").string()), random_(scene.options().seed + 77), track_(scene.labels().size()) {
    file_.write("frame,time,id,label,x,y,z\n");
  }

  void write(const RoomFrame& frame) {
    const std::vector<int> cameras = marey::simulate::room::cameras_that_observe(scene_, frame);
    std::string rows;
    const auto put = [&](std::int64_t track, const Vector<3>& location) {
      fmt::format_to(std::back_inserter(rows), "{},{:.6f},{},,{:.6f},{:.6f},{:.6f}\n", frame.index, frame.time_s, track,
                     location.x() + random_.gaussian(0, kNoiseM), location.y() + random_.gaussian(0, kNoiseM),
                     location.z() + random_.gaussian(0, kNoiseM));
    };
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
      if (cameras[i] < kMinCameras) {
        track_[i].reset();
        continue;
      }
      if (!track_[i]) track_[i] = ++tracks_;
      put(*track_[i], frame.points[i]);
      if (random_.chance(scene_.options().ghosts / kGhostFrames)) begin_ghost();
    }
    for (Ghost& ghost : ghosts_) put(ghost.track, ghost.location);
    std::erase_if(ghosts_, [](Ghost& ghost) { return --ghost.left <= 0; });
    file_.write(rows);
  }

  void finish() { file_.finish(); }

 private:
  struct Ghost {
    std::int64_t track = 0;
    Vector<3> location = Vector<3>::Zero();
    int left = 0;  // frames
  };
  static constexpr double kNoiseM = 0.0003;
  static constexpr int kMinCameras = 2, kGhostFrames = 5;  // a ghost is seen 1 to 9 frames

  void begin_ghost() {
    const Vector<3> half = scene_.options().volume / 2;
    const Vector<3> location(random_.uniform(-half.x(), half.x()), random_.uniform(-half.y(), half.y()),
                             random_.uniform(0, 2 * half.z()));
    ghosts_.push_back({++tracks_, location, 1 + static_cast<int>(random_.uniform(0, 2 * kGhostFrames - 1))});
  }

  const RoomScene& scene_;
  WholeFile file_;
  marey::simulate::Random random_;
  std::vector<std::optional<std::int64_t>> track_;  // by marker, while it is seen
  std::vector<Ghost> ghosts_;
  std::int64_t tracks_ = 0;
};

/// The truth that grows with the frames.
class RoomTruth {
 public:
  RoomTruth(const RoomScene& scene, const fs::path& folder, bool unnamed)
      : scene_(scene), points_((folder / "truth.csv").string()) {
    points_.write("frame,time,label,x,y,z,cameras\n");
    for (int actor = 0; actor < scene.actors(); ++actor) angles_.push_back(std::make_unique<TrueAngles>(scene, actor, folder));
    if (scene.actors() > 0 || !scene.props().empty()) poses_.emplace(scene, folder);
    if (unnamed) unnamed_.emplace(scene, folder);
  }

  void write(const RoomFrame& frame) {
    points_.write(truth_rows(scene_, frame));
    for (const auto& angles : angles_) angles->write(frame);
    if (poses_) poses_->write(frame);
    if (unnamed_) unnamed_->write(frame);
  }

  void finish() {
    points_.finish();
    for (const auto& angles : angles_) angles->finish();
    if (poses_) poses_->finish();
    if (unnamed_) unnamed_->finish();
  }

 private:
  const RoomScene& scene_;
  WholeFile points_;
  std::vector<std::unique_ptr<TrueAngles>> angles_;
  std::optional<TruePoses> poses_;
  std::optional<UnnamedPoints> unnamed_;
};

/// A file of keypoints for each camera, and where the joints truly are.
void write_room_keypoints(const RoomScene& scene, const fs::path& folder, const marey::simulate::room::KeypointErrors& errors) {
  for (int camera = 0; camera < std::ssize(scene.rig().cameras); ++camera) {
    const std::string& name = scene.rig().cameras[static_cast<std::size_t>(camera)].name;
    format::keypoints::write_coco_keypoints(marey::simulate::room::keypoints_of_camera(scene, camera, errors),
                                            (folder / fmt::format("keypoints_{}.json", name)).string());
  }
  WholeFile file((folder / "keypoints_truth.csv").string());
  file.write("frame,time,label,x,y,z\n");
  const KeypointSet& set = marey::simulate::room::room_keypoint_set();
  std::string rows;
  for (std::int64_t i = 0; i < scene.options().frames; ++i) {
    const double time_s = static_cast<double>(i) / scene.options().rate_hz;
    const auto people = marey::simulate::room::true_keypoints(scene, time_s);
    rows.clear();
    for (std::size_t p = 0; p < people.size(); ++p) {
      for (std::size_t k = 0; k < set.points.size(); ++k) {
        const Vector<3>& at = people[p][k];
        fmt::format_to(std::back_inserter(rows), "{},{:.6f},{}{},{:.6f},{:.6f},{:.6f}\n", i, time_s,
                       people.size() > 1 ? fmt::format("P{}:", p + 1) : "", set.points[k], at.x(), at.y(), at.z());
      }
    }
    file.write(rows);
  }
  file.finish();
}

}  // namespace

void write_room(const RoomScene& scene, const std::string& folder, const RoomFilesOptions& options, const Hooks& hooks) {
  const fs::path location = folder;
  format::ObservationWriter observations((location / "observations.csv").string(), scene.rig(), false);
  format::ObservationWriter blobs((location / "blobs.csv").string(), scene.rig(), true);
  RoomTruth truth(scene, location, options.unnamed);
  std::vector<std::unique_ptr<corridor::VideoFile>> videos;
  for (std::size_t i = 0; options.videos && i < scene.rig().cameras.size(); ++i) {
    videos.push_back(std::make_unique<corridor::VideoFile>(marey::simulate::room::video_room(scene.options(), i, options.video),
                                                           (location / (scene.rig().cameras[i].name + ".mp4")).string()));
  }
  for (std::int64_t i = 0; i < scene.options().frames; ++i) {
    const RoomFrame frame = scene.frame(i);
    const format::ObservedFrame detected = observed_of(frame, scene.labels());
    observations.write(detected);
    blobs.write(detected);
    truth.write(frame);
    tbb::parallel_for(std::size_t{0}, videos.size(), [&](std::size_t camera) { videos[camera]->write_next(); });
    hooks.advance({"frames", i + 1, scene.options().frames});
  }
  observations.finish();
  blobs.finish();
  truth.finish();
  for (const auto& video : videos) video->finish();
  write_room_rigs(scene, location, options);
  write_labels(scene, location);
  for (int actor = 0; actor < scene.actors(); ++actor)
    write_room_text(of_actor(location, "skeleton", actor, ".toml"), format::skeleton::to_toml(*scene.skeleton(actor)));
  if (options.keypoints) write_room_keypoints(scene, location, options.keypoint_errors);
  if (!scene.props().empty()) format::bodies::write_bodies((location / "bodies.toml").string(), scene.props());
}

}  // namespace marey::pipeline::simulate
