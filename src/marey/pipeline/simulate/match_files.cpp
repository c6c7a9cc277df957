// A simulated match as files. Nothing is simulated here.
#include "marey/pipeline/simulate/match_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/draw/movie_writer.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/rig/rig_file.h"

namespace marey::pipeline::simulate {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxMatch = 24 * 3600;  // s, by definition of the domain

/// What one camera of a match yields, in files of its name.
class MatchCameraFiles {
 public:
  MatchCameraFiles(marey::simulate::match::MatchCamera& camera, const MatchFilesOptions& options, const fs::path& folder)
      : camera_(camera), truth_((folder / (camera.rig_camera().name + "_truth.txt")).string()) {
    const RigCamera& rig_camera = camera.rig_camera();
    if (options.boxes) detections_.emplace((folder / (rig_camera.name + ".txt")).string());
    if (!options.videos) return;
    movie_.emplace((folder / (rig_camera.name + ".mp4")).string(), *rig_camera.size, rig_camera.rate_hz);
    if (options.video.ball) {
      ball_.emplace((folder / (rig_camera.name + "_ball.csv")).string());
      ball_->write("frame,x,y,radius,visible\n");
    }
    clicks_.emplace((folder / (rig_camera.name + "_clicks.csv")).string());
    clicks_->write("x,y,u,v\n");
    for (const marey::simulate::match::MatchClick& click : camera.clicks(options.click_noise, options.wrong_clicks))
      clicks_->write(
          fmt::format("{:g},{:g},{:.2f},{:.2f}\n", click.ground.x(), click.ground.y(), click.pixel.x(), click.pixel.y()));
  }

  /// The frame at which the camera stands.
  void write() {
    text_.clear();
    for (const marey::simulate::match::ObservedPerson& person : camera_.detected()) {
      fmt::format_to(std::back_inserter(text_), "{},{},{:.2f},{:.2f},{:.2f},{:.2f},1,1,{:.3f}\n", camera_.frame() + 1,
                     person.person + 1, person.shown.left + 1, person.shown.top + 1, person.shown.width, person.shown.height,
                     person.visible_fraction);
    }
    truth_.write(text_);
    if (detections_) write_detections();
    if (movie_) video();
  }

  void finish() {
    if (movie_) movie_->finish();
    if (ball_) ball_->finish();
    if (clicks_) clicks_->finish();
    truth_.finish();
    if (detections_) detections_->finish();
  }

 private:
  void video() {
    const marey::simulate::match::MatchCamera::Shot shot = camera_.shoot();
    movie_->write(shot.image, timestamp_from_seconds(camera_.time()));
    if (ball_ && shot.ball)
      ball_->write(fmt::format("{},{:.3f},{:.3f},{:.3f},{:.3f}\n", camera_.frame(), shot.ball->at.x(), shot.ball->at.y(),
                               shot.ball->radius, shot.ball->visible_fraction));
  }

  void write_detections() {
    text_.clear();
    for (const LabelledBox& box : camera_.detect()) {
      fmt::format_to(std::back_inserter(text_), "{},-1,{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},-1,-1,-1\n", box.frame + 1,
                     box.box.left + 1, box.box.top + 1, box.box.width, box.box.height, box.score);
    }
    detections_->write(text_);
  }

  marey::simulate::match::MatchCamera& camera_;
  WholeFile truth_;
  std::optional<WholeFile> detections_, clicks_, ball_;
  std::optional<draw::MovieWriter> movie_;
  std::string text_;
};

/// Where the ball is, row by row.
class BallTruthFile {
 public:
  BallTruthFile(const marey::simulate::match::MatchScene& scene, const fs::path& folder)
      : truth_(scene), rate_hz_(scene.options.rate_hz), file_((folder / "ball.csv").string()) {
    file_.write("frame,time,x,y,z,vx,vy,vz,state,holder\n");
  }

  void write(std::int64_t frame) {
    const marey::simulate::match::BallPosition ball = truth_.next();
    if (!ball.there) return;
    const Vector<3>&p = ball.location, &v = ball.velocity;
    file_.write(fmt::format("{},{:.4f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{}\n", frame,
                            static_cast<double>(frame) / rate_hz_, p.x(), p.y(), p.z(), v.x(), v.y(), v.z(),
                            marey::simulate::match::to_string(ball.state), ball.holder < 0 ? "" : std::to_string(ball.holder + 1)));
  }
  void finish() { file_.finish(); }

 private:
  marey::simulate::match::BallTruth truth_;
  double rate_hz_;
  WholeFile file_;
};

void write_match_rigs(const Rig& rig, const MatchFilesOptions& options, const fs::path& folder) {
  const auto write = [&](const Rig& each, const char* name) {
    WholeFile file((folder / name).string());
    file.write(format::rig::rig_text(each));
    file.finish();
  };
  Rig exact = rig;
  for (RigCamera& camera : exact.cameras) {
    if (options.videos)
      camera.source = camera.name + ".mp4";
    else if (options.boxes)
      camera.detections = camera.name + ".txt";
  }
  Rig known = exact;
  if (options.hide_offsets) {
    write(exact, "true_rig.toml");
    for (RigCamera& camera : known.cameras) camera.offset_s.reset();
  }
  write(known, "rig.toml");
  if (!options.videos) return;
  Rig boxes = known, start = known;
  start.ground_from_world.reset();
  start.ground = {};
  start.calibration.reset();
  for (RigCamera& camera : boxes.cameras) {
    camera.source.clear();
    camera.detections = camera.name + ".txt";
  }
  for (RigCamera& camera : start.cameras) {
    camera.lens.reset();
    camera.camera_from_world.reset();
  }
  if (options.boxes) write(boxes, "boxes.toml");
  write(start, "start.toml");
}

}  // namespace

void write_match(const MatchFilesOptions& options, const std::string& folder, const Hooks& hooks) {
  const marey::simulate::match::MatchScene scene(options.cameras, options.seed);
  if (!(options.seconds > 0 && options.seconds <= kMaxMatch))
    throw Error("a match of {} s; more than 0 and {} at most are possible", options.seconds, kMaxMatch);
  const auto frames = std::max<std::int64_t>(1, std::llround(options.seconds * options.cameras.rate_hz));
  const fs::path location = folder;
  const std::size_t count = scene.rig.cameras.size();
  std::vector<marey::simulate::match::MatchCamera> cameras;
  cameras.reserve(count);  // the files hold references
  std::vector<std::unique_ptr<MatchCameraFiles>> files;
  for (std::size_t i = 0; i < count; ++i) {
    cameras.emplace_back(scene, i, options.detector, options.videos ? std::optional(options.video) : std::nullopt);
    files.push_back(std::make_unique<MatchCameraFiles>(cameras[i], options, location));
  }
  marey::simulate::match::MatchTruth truth(scene);
  std::optional<BallTruthFile> ball;
  if (options.videos && options.video.ball) ball.emplace(scene, location);
  format::match::GroundWriter writer((location / "truth.csv").string());
  RecordingHeader header;
  header.name = "truth.csv";
  header.frame.kind = FrameOfReference::Kind::user_ground;
  header.rate_hz = options.cameras.rate_hz;
  header.rig = scene.rig;
  writer.begin(header);
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      cameras[i].advance();
      files[i]->write();
    });
    writer.write(truth.next(cameras));
    if (ball) ball->write(frame);
    hooks.advance({"frames", frame + 1, frames});
  }
  for (const auto& each : files) each->finish();
  if (ball) ball->finish();
  writer.finish();
  write_match_rigs(scene.rig, options, location);
}

}  // namespace marey::pipeline::simulate
