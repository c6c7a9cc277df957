#include "marey/format/recording_file.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/edit/edited.h"
#include "marey/files/limits.h"
#include "marey/format/register.h"

namespace marey::format {
namespace {

/// (x, y, z) with y up, where z is up: (x, −z, y).
Matrix<3> z_up_from_y_up() {
  return Matrix<3>{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
}

void turn(Instant& instant, const Matrix<3>& rotation) {
  for (Sample& sample : instant.samples) {
    sample.position = (rotation * sample.position).eval();
    if (sample.velocity) sample.velocity = (rotation * *sample.velocity).eval();
    if (sample.covariance) sample.covariance = (rotation * *sample.covariance * rotation.transpose()).eval();
  }
  Matrix<6> both = Matrix<6>::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = rotation;
  for (BodyPose& pose : instant.bodies) {
    pose.world_from_body = Rigid3{rotation, Vector<3>::Zero()} * pose.world_from_body;
    if (pose.covariance) pose.covariance = (both * *pose.covariance * both.transpose()).eval();
  }
}

/// Turns a world whose y is up so that its z is. `reported` is a warning, or empty.
class AxisConvertingReader : public FileReader {
 public:
  AxisConvertingReader(std::unique_ptr<FileReader> reader, std::string reported)
      : reader_(std::move(reader)), reported_(std::move(reported)) {}
  const FileInfo& info() const override { return reader_->info(); }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> warnings = reader_->warnings();
    if (!reported_.empty()) warnings.push_back(reported_);
    return warnings;
  }
  std::optional<Instant> next() override {
    auto instant = reader_->next();
    if (instant) turn(*instant, z_up_from_y_up());
    return instant;
  }

 private:
  std::unique_ptr<FileReader> reader_;
  std::string reported_;
};

/// And back.
class AxisConvertingSink : public Sink {
 public:
  explicit AxisConvertingSink(std::unique_ptr<Sink> sink) : sink_(std::move(sink)) {}
  std::string name() const override { return sink_->name(); }
  SinkRequirements begin(const RecordingHeader& header) override { return sink_->begin(header); }
  void write(const Instant& instant) override {
    Instant rotated = instant;
    turn(rotated, z_up_from_y_up().transpose());
    sink_->write(rotated);
  }
  void finish() override { sink_->finish(); }

 private:
  std::unique_ptr<Sink> sink_;
};

void require_short_labels(const FileInfo& info, const std::string& path) {
  const std::size_t maximum = Limits::in_force().label_bytes;
  for (const TrackName& track : info.tracks) {
    if (track.label.size() > maximum)
      throw Error("{}: a name has {} bytes; they have at most {} (the limit label_bytes)", path, track.label.size(), maximum);
  }
}

/// A recording in memory as a file's.
class WholeReader : public FileReader {
 public:
  explicit WholeReader(const Recording& recording) : reader_(recording) {
    info_ = {.header = recording.header,
             .tracks = reader_.tracks(),
             .edits = recording.edits,
             .head = recording.head,
             .frame_count = reader_.instant_count(),
             .up = {},
             .auxiliary = {}};
  }
  const FileInfo& info() const override { return info_; }
  std::optional<Instant> next() override { return reader_.next(); }

 private:
  MemoryReader reader_;
  FileInfo info_;
};

/// The same of one that was read whole, which it owns.
class MatchReader : public FileReader {
 public:
  explicit MatchReader(match::GroundMatch match) : match_(std::move(match)), reader_(match_.recording) {}
  const FileInfo& info() const override { return reader_.info(); }
  std::optional<Instant> next() override { return reader_.next(); }
  std::vector<std::string> warnings() const override { return match_.warnings; }

 private:
  match::GroundMatch match_;
  WholeReader reader_;
};

/// Gathers what a format that is written whole writes at the end.
class GatheringSink : public Sink {
 public:
  GatheringSink(std::string path, const Format& format, std::vector<std::string>* lost)
      : path_(std::move(path)), format_(&format), lost_(lost) {}
  std::string name() const override { return path_; }
  SinkRequirements begin(const RecordingHeader& header) override {
    match_.recording = Recording(header);
    return {};
  }
  void write(const Instant& instant) override { match_.recording.add(instant); }
  void finish() override {
    for (const TrackColumns& track : match_.recording.tracks()) match_.order.push_back(track.id());
    std::vector<std::string> lost = format_->write(match_, path_);
    if (lost_ != nullptr) *lost_ = std::move(lost);
  }

 private:
  std::string path_;
  const Format* format_;
  std::vector<std::string>* lost_;
  match::GroundMatch match_;
};

}  // namespace

namespace {

/// With its edits applied, where it has any that count.
std::unique_ptr<FileReader> edited(std::unique_ptr<FileReader> reader, const std::string& path) {
  if (!reader->info().head) return reader;
  const std::vector<std::string> warnings = reader->warnings();
  try {
    Recording recording = read_all(*reader);
    recording.edits = reader->info().edits;
    recording.head = reader->info().head;
    match::GroundMatch match;
    match.recording = edit::edited(std::move(recording));
    match.warnings = warnings;
    return std::make_unique<MatchReader>(std::move(match));
  } catch (const Error& error) {
    throw Error("{}: {}; \"marey edit {} --undo\" goes back behind it", path, error.what(), path);
  }
}

}  // namespace

UpAxis up_axis(const FileInfo& info, const std::optional<UpAxis>& stated) {
  return stated.value_or(info.up.value_or(UpAxis::z));
}

std::unique_ptr<FileReader> open_recording(const std::string& path, const Format& format, const ReadOptions& options) {
  if (format.read != nullptr) return std::make_unique<MatchReader>(read_whole(path, format, options));
  if (format.open == nullptr) throw Error("{}: is {}, which is not a recording", path, format.title);
  auto reader = format.open(path, options);
  require_short_labels(reader->info(), path);
  if (!options.as_recorded) reader = edited(std::move(reader), path);
  if (format.z_up || up_axis(reader->info(), options.up) == UpAxis::z) return reader;
  std::string reported;
  if (!options.up)
    reported = fmt::format(
        "{}: its y is taken for up, as the file says; if z is up in it, say --up z (`marey convert`: --from-up z)", path);
  return std::make_unique<AxisConvertingReader>(std::move(reader), std::move(reported));
}

std::unique_ptr<FileReader> open_recording(const std::string& path, const ReadOptions& options) {
  return open_recording(path, format_to_read(path, kRecordings), options);
}

match::GroundMatch read_whole(const std::string& path, const Format& format, const ReadOptions& options) {
  match::GroundMatch match;
  if (format.read != nullptr) {
    match = format.read(path, options);
  } else {
    const auto reader = open_recording(path, format, options);
    match.recording = read_all(*reader);
    match.warnings = reader->warnings();
    match.pitch = options.pitch;
    for (const TrackColumns& track : match.recording.tracks()) match.order.push_back(track.id());
  }
  match.recording.header.name = path == "-" ? "standard input" : path;
  return match;
}

match::GroundMatch read_match(const std::string& path, const ReadOptions& options) {
  // What is not a format at all is reported by the reader of ours, which says what it wants.
  const Format* format = path == "-" ? nullptr : format_of_content(path);
  if (format == nullptr && std::filesystem::is_directory(path)) throw Error("{}: is a folder, not a file", path);
  if (format == nullptr || !format->holds.any_of(kRecordings)) format = format_named("ground", Content::ground);
  // Boxes in an image are reported by the reader of the same text with places.
  if (const Format* locations = format_named(format->name, Content::ground);
      !format->holds.has(Content::ground) && locations != nullptr)
    format = locations;
  match::GroundMatch match = read_whole(path, *format, options);
  require_ground(match.recording, "a match");
  return match;
}

std::unique_ptr<FileReader> reader_of(const Recording& recording) {
  return std::make_unique<WholeReader>(recording);
}

WritePlan plan_of(FileReader& reader, const std::string& name) {
  WritePlan plan;
  FrameNumbers numbers;
  while (const auto instant = reader.next()) {
    if (numbers.count() == 0) plan.first_frame = instant->index;
    numbers.add(instant->index);
    plan.last_frame = instant->index;
    for (const Sample& sample : instant->samples) {
      plan.farthest_m = std::max(plan.farthest_m, sample.position.cwiseAbs().maxCoeff());
      plan.reports_measured |= !sample.measured() || sample.cameras != 0 || sample.residual_m.has_value();
    }
  }
  numbers.check(name);
  plan.info = reader.info();
  plan.info.frame_count = plan.last_frame - plan.first_frame + 1;
  return plan;
}

std::unique_ptr<Sink> create_recording(const std::string& path, const Format& format, const WritePlan& plan,
                                       std::vector<std::string>* lost) {
  if (format.create == nullptr && format.write == nullptr) throw Error("{}: {} is read only", path, format.title);
  if (format.create == nullptr) return std::make_unique<GatheringSink>(path, format, lost);
  require_short_labels(plan.info, path);  // the output is read again
  auto sink = format.create(path, plan);
  if (plan.up == UpAxis::z || format.z_up) return sink;
  return std::make_unique<AxisConvertingSink>(std::move(sink));
}

std::vector<std::string> write_whole(const std::string& path, const Format& format, const match::GroundMatch& match, UpAxis up) {
  if (format.write != nullptr) {
    require_ground(match.recording, format.name);
    return format.write(match, path);
  }
  WritePlan plan = plan_of(*reader_of(match.recording), match.recording.header.name);
  plan.up = up;
  const auto sink = create_recording(path, format, plan);
  replay(*reader_of(match.recording), *sink);
  return {};
}

std::optional<std::string> poses_lost(const RecordingHeader& header, const std::string& path, const Format& format) {
  if (header.bodies.empty() || format.poses) return std::nullopt;
  return fmt::format(
      "{}: {} holds points alone, not the poses of the {} {}; a take (.marey), .c3d, .mcap, or CSV by --format poses does", path,
      format.title, header.bodies.size(), header.bodies.size() == 1 ? "body" : "bodies");
}

std::optional<std::string> auxiliary_lost(const AuxiliaryData& auxiliary, const std::string& path, const Format& format) {
  if (!auxiliary.any() || format.auxiliary_data) return std::nullopt;
  const std::string channels = auxiliary.channels > 0 ? fmt::format("{} analog channels (forces, EMG)", auxiliary.channels) : "";
  const std::string events = auxiliary.events > 0 ? fmt::format("{} events", auxiliary.events) : "";
  return fmt::format("{}: {} holds none of the {}{}{} of {}; they go along into .c3d alone{}", path, format.title, channels,
                     channels.empty() || events.empty() ? "" : " and ", events, auxiliary.path,
                     format.name == "take" && auxiliary.channels > 0 ? ", but for force plates" : "");
}

}  // namespace marey::format
