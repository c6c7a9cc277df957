#include "marey/pipeline/simulate/square_files.h"

#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/simulate/random.h"
#include "marey/simulate/square/square_cameras.h"

namespace marey::pipeline::simulate {
namespace {

constexpr double kMaxSquareLength = 24 * 3600;  // s, by definition of the domain

/// What one camera's detector says, in a file of its name.
class SquareCameraFile {
 public:
  SquareCameraFile(const RigCamera& camera, const SquareFilesOptions& options, const std::filesystem::path& folder)
      : camera_(camera.camera().value()),
        options_(options.detector),
        random_(options.seed * 64 + static_cast<std::uint64_t>(camera.name.back())),
        file_((folder / (camera.name + ".txt")).string()) {}

  void write(const marey::simulate::square::SquareMotion& motion, std::int32_t frame) {
    std::string text;
    for (const LabelledBox& box : square_boxes(motion.people(), motion, camera_, frame, options_, random_)) {
      fmt::format_to(std::back_inserter(text), "{},-1,{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},-1,-1,-1\n", frame + 1, box.box.left + 1,
                     box.box.top + 1, box.box.width, box.box.height, box.score);
    }
    file_.write(text);
  }

  void finish() { file_.finish(); }

 private:
  Camera camera_;
  marey::simulate::square::SquareDetectorOptions options_;
  marey::simulate::Random random_;
  WholeFile file_;
};

/// Who is within the square; named when it first is.
Instant truth_of(const marey::simulate::square::SquareMotion& motion, std::int64_t frame, double rate_hz, std::set<int>& named) {
  Instant instant;
  instant.index = frame;
  instant.time = timestamp_from_seconds(static_cast<double>(frame) / rate_hz);
  for (const marey::simulate::square::SquarePerson& person : motion.people()) {
    if (!motion.holds(person.location)) continue;
    if (named.insert(person.id).second) instant.named.push_back({TrackId{person.id}, fmt::format("P{}", person.id), {}, {}});
    Sample& sample = instant.samples.emplace_back();
    sample.track = TrackId{person.id};
    sample.position.head<2>() = person.location;
    sample.velocity.emplace(Vector<3>::Zero()).head<2>() = person.velocity;
  }
  return instant;
}

}  // namespace

void write_square(const SquareFilesOptions& options, const std::string& folder, const Hooks& hooks) {
  if (!(options.seconds > 0 && options.seconds <= kMaxSquareLength))
    throw Error("a square of {} s; more than 0 and {} at most are possible", options.seconds, kMaxSquareLength);
  if (!(options.rate_hz > 0)) throw Error("the rate is {} frames a second; it must be positive", options.rate_hz);
  Rig rig = marey::simulate::square::square_cameras(options.cameras, options.rate_hz, options.square, options.seed);
  std::vector<std::unique_ptr<SquareCameraFile>> files;
  for (RigCamera& camera : rig.cameras) {
    files.push_back(std::make_unique<SquareCameraFile>(camera, options, folder));
    camera.detections = camera.name + ".txt";
  }
  format::match::GroundWriter truth((std::filesystem::path(folder) / "truth.csv").string());
  RecordingHeader header;
  header.name = "truth.csv";
  header.frame.kind = FrameOfReference::Kind::user_ground;
  header.rate_hz = options.rate_hz;
  header.rig = rig;
  truth.begin(header);
  marey::simulate::square::SquareMotion motion(options.seed, options.square);
  std::set<int> named;
  const auto frames = std::max<std::int64_t>(1, std::llround(options.seconds * options.rate_hz));
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    motion.advance(static_cast<double>(frame) / options.rate_hz);
    for (const auto& file : files) file->write(motion, static_cast<std::int32_t>(frame));
    truth.write(truth_of(motion, frame, options.rate_hz, named));
    hooks.advance({"frames", frame + 1, frames});
  }
  for (const auto& file : files) file->finish();
  truth.finish();
  WholeFile text((std::filesystem::path(folder) / "rig.toml").string());
  text.write(format::rig::rig_text(rig));
  text.finish();
}

}  // namespace marey::pipeline::simulate
