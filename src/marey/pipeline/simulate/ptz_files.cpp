#include "marey/pipeline/simulate/ptz_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/draw/canvas.h"
#include "marey/draw/movie_writer.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/rig/rig_ptz.h"

namespace marey::pipeline::simulate {
namespace {

constexpr double kMaxVideo = 3 * 3600;  // s, by definition of the domain
constexpr double kClickedApart = 0.15;  // rad between frames that are clicked
constexpr std::size_t kMinClicks = 4;   // that a user would search for in a frame

/// The rows of clicks, from frames that face elsewhere than those clicked before.
class ClickedFrames {
 public:
  explicit ClickedFrames(const PtzFilesOptions& options)
      : noise_(options.click_noise), from_(options.clicked_from), frames_(options.clicked_frames), max_clicks_(options.clicks) {}

  void add(const marey::simulate::match::PtzMatch& match) {
    const auto heading = match.heading();
    if (!heading || std::ssize(pans_) >= frames_ || match.time() < from_) return;
    if (std::any_of(pans_.begin(), pans_.end(), [&](double pan) { return std::abs(pan - heading->pan) < kClickedApart; })) return;
    auto clicks = match.clicks(noise_);
    if (clicks.size() < kMinClicks) return;
    pans_.push_back(heading->pan);
    while (std::ssize(clicks) > max_clicks_) clicks.erase(clicks.begin() + std::ssize(clicks) / 2);
    for (const marey::simulate::match::MatchClick& click : clicks)
      fmt::format_to(std::back_inserter(rows_), "{},{:g},{:g},{:.2f},{:.2f}\n", match.frame(), click.ground.x(), click.ground.y(),
                     click.pixel.x(), click.pixel.y());
  }
  const std::string& rows() const { return rows_; }

 private:
  double noise_, from_;
  std::ptrdiff_t frames_, max_clicks_;
  std::vector<double> pans_;
  std::string rows_ = "frame,x,y,u,v\n";
};

std::string box_rows(const std::vector<LabelledBox>& boxes) {
  std::string rows;
  for (const LabelledBox& box : boxes)
    fmt::format_to(std::back_inserter(rows), "{},-1,{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},-1,-1,-1\n", box.frame + 1, box.box.left + 1,
                   box.box.top + 1, box.box.width, box.box.height, box.score);
  return rows;
}

Instant truth_of(const marey::simulate::match::PtzMatch& match) {
  Instant instant;
  instant.index = match.frame();
  instant.time = timestamp_from_seconds(match.time());
  std::vector<char> detected(marey::simulate::match::kMatchPeople, 0);
  for (const marey::simulate::match::ObservedPerson& person : match.detected())
    detected[static_cast<std::size_t>(person.person)] =
        match.heading() && person.visible_fraction >= marey::simulate::match::kHiddenFraction ? 1 : 0;
  for (int i = 0; i < marey::simulate::match::kMatchPeople; ++i) {
    if (match.frame() == 0)
      instant.named.push_back(
          {TrackId{i + 1}, marey::simulate::match::match_label(i), std::string(marey::simulate::match::match_team(i)), {}});
    const marey::simulate::match::MatchPerson& person = match.people()[static_cast<std::size_t>(i)];
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId{i + 1};
    sample.position.head<2>() = person.location;
    sample.velocity.emplace(Vector<3>::Zero()).head<2>() = person.velocity;
    sample.cameras = detected[static_cast<std::size_t>(i)] ? CameraMask{1} : CameraMask{0};
  }
  return instant;
}

Rig rig_of_video(const PtzFilesOptions& options, const std::filesystem::path& folder) {
  Rig rig;
  RigCamera camera;
  camera.name = "main";
  camera.source = (folder / "main.mp4").string();
  camera.rate_hz = options.match.rate_hz;
  camera.offset_s = 0;
  camera.size = options.match.size;
  rig.cameras.push_back(camera);
  rig.calibration.emplace().method = "pitch";
  return rig;
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  WholeFile file(path.string());
  file.write(text);
  file.finish();
}

}  // namespace

void write_ptz_match(const PtzFilesOptions& options, const std::string& folder, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  if (!(options.seconds > 0 && options.seconds <= kMaxVideo))
    throw Error("a video of {} s; more than 0 and {} at most are possible", options.seconds, kMaxVideo);
  const std::filesystem::path location = folder;
  marey::simulate::match::PtzMatch match(options.match, options.seed);
  const Rig rig = rig_of_video(options, location);
  draw::MovieWriter movie((location / "main.mp4").string(), options.match.size, options.match.rate_hz);
  format::match::GroundWriter truth((location / "truth.csv").string());
  RecordingHeader header;
  header.name = "truth.csv";
  header.frame.kind = FrameOfReference::Kind::user_ground;
  header.rate_hz = options.match.rate_hz;
  header.rig = rig;
  truth.begin(header);
  PtzCamera ptz{match.tripod(), {}};
  ClickedFrames clicks(options);
  WholeFile boxes((location / "boxes.txt").string());
  const auto frames = std::max<std::int64_t>(1, std::llround(options.seconds * options.match.rate_hz));
  for (std::int64_t i = 0; i < frames; ++i) {
    stop_point();
    match.advance();
    movie.write(draw::Canvas(match.image()).take(), timestamp_from_seconds(match.time()));
    truth.write(truth_of(match));
    if (match.heading()) boxes.write(box_rows(match.detect(options.detector)));
    ptz.rotations.push_back({match.time(), match.heading(), Matrix<3>::Zero(), {}});
    clicks.add(match);
    hooks.advance({"frames", i + 1, frames});
  }
  movie.finish();
  truth.finish();
  boxes.finish();
  write_file(location / "clicks.csv", clicks.rows());
  format::rig::write_ptz_rig(rig, {std::make_shared<const PtzCamera>(ptz)}, (location / "rig.toml").string());
}

}  // namespace marey::pipeline::simulate
