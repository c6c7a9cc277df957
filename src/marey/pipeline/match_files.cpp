#include "marey/pipeline/match_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/draw/movie_writer.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/tracks/mot.h"
#include "marey/format/whole_file.h"

namespace marey::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr double kLongest = 24 * 3600;  // s

struct Match {
  const MatchFilesOptions& options;
  Rig rig;
  Matrix<3> world_from_pitch = Matrix<3>::Identity();
  std::array<simulate::people::Figure, simulate::match::kMatchPeople> figures;
  std::int64_t frames = 0;

  explicit Match(const MatchFilesOptions& asked)
      : options(asked),
        rig(simulate::match::match_cameras(asked.cameras, asked.seed)),
        figures(simulate::match::match_figures(asked.seed)) {
    if (!(asked.seconds > 0 && asked.seconds <= kLongest))
      throw Error("a match of {} s; more than 0 and {} at most are possible", asked.seconds, kLongest);
    frames = std::max<std::int64_t>(1, std::llround(asked.seconds * asked.cameras.rate_hz));
    if (rig.ground_from_world) world_from_pitch = rig.ground_from_world->inverse();
  }

  /// s since the kick-off; no camera begins before it.
  double match_time(double rig_time) const { return std::max(0.0, rig_time + options.cameras.offset_s); }

  std::array<simulate::people::Stance, simulate::match::kMatchPeople> stances(
      std::span<const simulate::match::MatchPerson, simulate::match::kMatchPeople> people) const {
    std::array<simulate::people::Stance, simulate::match::kMatchPeople> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = simulate::match::match_stance(people[i], world_from_pitch);
    return all;
  }
};

/// What one camera sees, frame by frame, by its own clock.
class CameraFiles {
 public:
  CameraFiles(const Match& match, int index, const fs::path& folder)
      : match_(match),
        eye_(match.rig.cameras[static_cast<std::size_t>(index)]),
        camera_(*eye_.camera()),
        motion_(match.options.seed, match.options.cameras.pitch),
        random_((match.options.seed * 64 + static_cast<std::uint64_t>(index)) * 2654435761u + 41),
        truth_((folder / (eye_.name + "_truth.txt")).string()) {
    if (match.options.boxes) detections_.emplace((folder / (eye_.name + ".txt")).string());
    if (match.options.films) start_film(index, folder);
  }

  void write(std::int64_t frame) {
    const double own_time = static_cast<double>(frame) / *eye_.rate_hz;
    const double time = match_.match_time(own_time + eye_.offset_s.value_or(0));
    motion_.advance(time);
    const auto stances = match_.stances(motion_.people());
    seen_ = simulate::match::look_at(camera_, match_.figures, stances);
    text_.clear();
    for (const simulate::match::SeenPerson& person : seen_) {
      fmt::format_to(std::back_inserter(text_), "{},{},{:.2f},{:.2f},{:.2f},{:.2f},1,1,{:.3f}\n", frame + 1, person.person + 1,
                     person.shown.left + 1, person.shown.top + 1, person.shown.width, person.shown.height, person.visible_share);
    }
    truth_.write(text_);
    if (detections_) write_detections(frame);
    if (movie_) movie_->write(film_->render(match_.figures, stances, time, frame), timestamp_from_seconds(own_time));
  }

  /// Whom it saw in the frame written last.
  std::span<const simulate::match::SeenPerson> seen() const { return seen_; }

  void finish() {
    if (movie_) movie_->finish();
    truth_.finish();
    if (detections_) detections_->finish();
  }

 private:
  void start_film(int index, const fs::path& folder) {
    const MatchFilesOptions& options = match_.options;
    const auto seed = options.seed * 64 + static_cast<std::uint64_t>(index);
    film_.emplace(camera_, match_.world_from_pitch, options.cameras.pitch, options.film, seed);
    movie_.emplace((folder / (eye_.name + ".mp4")).string(), *eye_.size, eye_.rate_hz);
    format::WholeFile clicks((folder / (eye_.name + "_clicks.csv")).string());
    clicks.write("x,y,u,v\n");
    for (const simulate::match::MatchClick& click : simulate::match::match_clicks(
             camera_, match_.world_from_pitch, options.cameras.pitch, options.click_noise, options.wrong_clicks, seed)) {
      clicks.write(fmt::format("{:g},{:g},{:.2f},{:.2f}\n", click.ground.x(), click.ground.y(), click.pixel.x(), click.pixel.y()));
    }
    clicks.finish();
  }

  void write_detections(std::int64_t frame) {
    text_.clear();
    for (const LabelledBox& box :
         simulate::match::detect_match(seen_, camera_, match_.world_from_pitch, match_.options.cameras.pitch,
                                       static_cast<std::int32_t>(frame), match_.options.detector, random_)) {
      fmt::format_to(std::back_inserter(text_), "{},-1,{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},-1,-1,-1\n", box.frame + 1,
                     box.box.left + 1, box.box.top + 1, box.box.width, box.box.height, box.score);
    }
    detections_->write(text_);
  }

  const Match& match_;
  const RigCamera& eye_;
  Camera camera_;
  simulate::match::MatchMotion motion_;
  simulate::Random random_;
  format::WholeFile truth_;
  std::optional<format::WholeFile> detections_;
  std::optional<simulate::match::MatchFilm> film_;
  std::optional<draw::MovieWriter> movie_;
  std::vector<simulate::match::SeenPerson> seen_;
  std::string text_;
};

class GroundTruth {
 public:
  GroundTruth(const Match& match, const fs::path& folder)
      : match_(match), motion_(match.options.seed, match.options.cameras.pitch), writer_((folder / "truth.csv").string()) {
    RecordingHeader header;
    header.name = "truth.csv";
    header.frame.kind = FrameOfReference::Kind::user_ground;
    header.rate_hz = match.options.cameras.rate_hz;
    header.rig = match.rig;
    writer_.begin(header);
    for (const RigCamera& eye : match.rig.cameras) cameras_.push_back(*eye.camera());
    for (int i = 0; i < simulate::match::kMatchPeople; ++i)
      people_.push_back({TrackId{i + 1}, simulate::match::match_label(i), std::string(simulate::match::match_team(i))});
  }

  /// `films` have written the same frame: cameras that were started with the first one have looked already.
  void write(std::int64_t frame, std::span<const std::unique_ptr<CameraFiles>> films) {
    const double time = static_cast<double>(frame) / match_.options.cameras.rate_hz;
    motion_.advance(match_.match_time(time));
    const auto stances = match_.stances(motion_.people());
    std::array<CameraMask, simulate::match::kMatchPeople> seen_by{};
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      std::vector<simulate::match::SeenPerson> own;
      const bool in_step = match_.rig.cameras[i].offset_s.value_or(0) == 0;
      if (!in_step) own = simulate::match::look_at(cameras_[i], match_.figures, stances);
      for (const simulate::match::SeenPerson& person :
           in_step ? films[i]->seen() : std::span<const simulate::match::SeenPerson>(own)) {
        if (person.visible_share >= simulate::match::kHiddenShare)
          seen_by[static_cast<std::size_t>(person.person)] |= CameraMask{1} << i;
      }
    }
    Instant instant;
    instant.index = frame;
    instant.time = timestamp_from_seconds(time);
    if (frame == 0) instant.named = people_;
    for (std::size_t i = 0; i < people_.size(); ++i) {
      const simulate::match::MatchPerson& person = motion_.people()[i];
      Sample& sample = instant.samples.emplace_back();
      sample.track = people_[i].id;
      sample.position.head<2>() = person.place;
      sample.velocity.emplace(Vector<3>::Zero()).head<2>() = person.velocity;
      sample.cameras = seen_by[i];
    }
    writer_.write(instant);
  }

  void finish() { writer_.finish(); }

 private:
  const Match& match_;
  simulate::match::MatchMotion motion_;
  std::vector<Camera> cameras_;
  std::vector<TrackName> people_;
  format::match::GroundWriter writer_;
};

void write_rigs(const Match& match, const fs::path& folder) {
  const auto write = [&](const Rig& rig, const char* name) {
    format::WholeFile file((folder / name).string());
    file.write(format::rig::rig_text(rig));
    file.finish();
  };
  const MatchFilesOptions& options = match.options;
  Rig exact = match.rig;
  for (RigCamera& camera : exact.cameras) {
    if (options.films)
      camera.source = camera.name + ".mp4";
    else if (options.boxes)
      camera.detections = camera.name + ".txt";
  }
  Rig told = exact;
  if (options.hide_offsets) {
    write(exact, "true_rig.toml");
    for (RigCamera& camera : told.cameras) camera.offset_s.reset();
  }
  write(told, "rig.toml");
  if (!options.films) return;
  Rig boxes = told, start = told;
  start.ground_from_world.reset();
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

void write_match(const MatchFilesOptions& options, const std::string& folder,
                 const std::function<void(std::int64_t, std::int64_t)>& progress) {
  const Match match(options);
  const fs::path place = folder;
  std::vector<std::unique_ptr<CameraFiles>> cameras;
  for (int i = 0; i < std::ssize(match.rig.cameras); ++i) cameras.push_back(std::make_unique<CameraFiles>(match, i, place));
  GroundTruth truth(match, place);
  for (std::int64_t frame = 0; frame < match.frames; ++frame) {
    tbb::parallel_for(std::size_t{0}, cameras.size(), [&](std::size_t i) { cameras[i]->write(frame); });
    truth.write(frame, cameras);
    if (progress) progress(frame + 1, match.frames);
  }
  for (const auto& camera : cameras) camera->finish();
  truth.finish();
  write_rigs(match, place);
}

}  // namespace marey::pipeline
