#include "marey/format/motion/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/motion/trc.h"
#include "marey/format/take/take_file.h"

namespace marey::format::motion {
namespace {

constexpr std::size_t kLookedAt = 4096;

struct NamedFormat {
  MotionFormat format;
  std::string_view name;
  std::string_view ending;  // empty: another format's
};
constexpr std::array kFormats{NamedFormat{MotionFormat::take, "take", ".marey"}, NamedFormat{MotionFormat::c3d, "c3d", ".c3d"},
                              NamedFormat{MotionFormat::trc, "trc", ".trc"},     NamedFormat{MotionFormat::csv, "csv", ".csv"},
                              NamedFormat{MotionFormat::motive, "motive", ""},   NamedFormat{MotionFormat::nexus, "nexus", ""}};

class TakeMotionReader : public MotionReader {
 public:
  explicit TakeMotionReader(const std::string& path) : reader_(path) {
    info_.header = reader_.header();
    info_.tracks = reader_.tracks();
    info_.frame_count = reader_.instant_count();
    info_.edits = reader_.edits();
    info_.head = reader_.head();
    if (info_.header.frame.kind == FrameOfReference::Kind::space) info_.up = UpAxis::z;
  }
  const MotionInfo& info() const override { return info_; }
  std::optional<Instant> next() override { return reader_.next(); }
  std::vector<std::string> warnings() const override { return reader_.warnings(); }

 private:
  take::TakeReader reader_;
  MotionInfo info_;
};

/// A take with the edits of the one it is a copy of.
class TakeSink : public Sink {
 public:
  TakeSink(const std::string& path, const MotionPlan& plan) : writer_(path), info_(plan.info) {}
  std::string name() const override { return writer_.name(); }
  Wants begin(const RecordingHeader& header) override {
    const Wants wants = writer_.begin(header);
    for (const TrackName& track : info_.tracks) writer_.set_name(track);
    for (const Edit& edit : info_.edits) writer_.add_edit(edit);
    writer_.set_head(info_.head);
    return wants;
  }
  void write(const Instant& instant) override { writer_.write(instant); }
  void finish() override { writer_.finish(); }

 private:
  take::TakeWriter writer_;
  MotionInfo info_;
};

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
}

/// Turns a world whose y is up so that its z is, or back.
class TurningReader : public MotionReader {
 public:
  explicit TurningReader(std::unique_ptr<MotionReader> reader) : reader_(std::move(reader)) {}
  const MotionInfo& info() const override { return reader_->info(); }
  std::vector<std::string> warnings() const override { return reader_->warnings(); }
  std::optional<Instant> next() override {
    auto instant = reader_->next();
    if (instant) turn(*instant, z_up_from_y_up());
    return instant;
  }

 private:
  std::unique_ptr<MotionReader> reader_;
};

class TurningSink : public Sink {
 public:
  explicit TurningSink(std::unique_ptr<Sink> sink) : sink_(std::move(sink)) {}
  std::string name() const override { return sink_->name(); }
  Wants begin(const RecordingHeader& header) override { return sink_->begin(header); }
  void write(const Instant& instant) override {
    Instant turned = instant;
    turn(turned, z_up_from_y_up().transpose());
    sink_->write(turned);
  }
  void finish() override { sink_->finish(); }

 private:
  std::unique_ptr<Sink> sink_;
};

std::unique_ptr<MotionReader> open_plainly(const std::string& path, MotionFormat format) {
  switch (format) {
    case MotionFormat::take:
      return std::make_unique<TakeMotionReader>(path);
    case MotionFormat::c3d:
      return open_c3d(path);
    case MotionFormat::trc:
      return open_trc(path);
    case MotionFormat::csv:
      return open_tidy_csv(path);
    case MotionFormat::motive:
      return open_motive_csv(path);
    case MotionFormat::nexus:
      return open_nexus_csv(path);
  }
  throw Error("{}: cannot be read", path);
}

std::unique_ptr<Sink> create_plainly(const std::string& path, MotionFormat format, const MotionPlan& plan, UpAxis up) {
  switch (format) {
    case MotionFormat::take:
      return std::make_unique<TakeSink>(path, plan);
    case MotionFormat::c3d:
      return create_c3d(path, plan, up);
    case MotionFormat::trc:
      return create_trc(path, plan);
    case MotionFormat::csv:
      return create_tidy_csv(path);
    case MotionFormat::motive:
      return create_motive_csv(path, plan);
    case MotionFormat::nexus:
      break;
  }
  throw Error("{}: Nexus's CSV is read only; write csv, motive, trc or c3d", path);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::string beginning_of(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw Error("{}: no such file", path);
  if (!std::filesystem::is_regular_file(status)) throw Error("{}: is no file", path);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error("{}: cannot be read; have you the right to?", path);
  std::string bytes(kLookedAt, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

}  // namespace

Sink::Wants MotionSink::begin(const RecordingHeader& header) {
  if (header.frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: such a file holds points in space, and these positions are {}", path_, to_string(header.frame));
  start(header);
  return {};
}

MotionPlan plan_of(const MotionInfo& info, RecordingReader& reader, const std::string& name) {
  MotionPlan plan;
  plan.info = info;
  FrameNumbers numbers;
  while (const auto instant = reader.next()) {
    if (numbers.count() == 0) plan.first_frame = instant->index;
    numbers.add(instant->index);
    plan.last_frame = instant->index;
    for (const Sample& sample : instant->samples) {
      plan.farthest_m = std::max(plan.farthest_m, sample.position.cwiseAbs().maxCoeff());
      plan.tells_measured |= !sample.measured() || sample.cameras != 0 || sample.residual_m.has_value();
    }
  }
  numbers.check(name);
  plan.info.frame_count = plan.last_frame - plan.first_frame + 1;
  return plan;
}

MotionPlan plan_of(MotionReader& reader, const std::string& name) {
  return plan_of(reader.info(), reader, name);
}

std::string motion_format_names() {
  std::string names;
  for (const NamedFormat& format : kFormats) names.append(names.empty() ? "" : ", ").append(format.name);
  return names;
}

std::string_view motion_format_name(MotionFormat format) {
  const auto named =
      std::find_if(kFormats.begin(), kFormats.end(), [format](const NamedFormat& each) { return each.format == format; });
  return named == kFormats.end() ? std::string_view() : named->name;
}

MotionFormat parse_motion_format(std::string_view name) {
  for (const NamedFormat& format : kFormats) {
    if (format.name == name) return format.format;
  }
  throw Error("\"{}\" is no format of motion; these are: {}", name, motion_format_names());
}

std::optional<MotionFormat> motion_format_of_content(const std::string& path) {
  const std::string bytes = beginning_of(path);
  if (take::is_take(path)) return MotionFormat::take;
  std::string_view text = bytes;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.starts_with("PathFileType")) return MotionFormat::trc;
  if (text.starts_with("Format Version")) return MotionFormat::motive;
  const std::string_view first_line = text.substr(0, text.find_first_of("\r\n"));
  if (first_line.starts_with("frame,") || first_line.find(",frame,") != std::string_view::npos) return MotionFormat::csv;
  for (const char* part : {"Trajectories", "Joints", "Devices", "Model Outputs"}) {
    if (first_line.starts_with(part)) return MotionFormat::nexus;
  }
  if (bytes.size() >= 2 && bytes[1] == 0x50 && bytes[0] > 0 && !text.starts_with("PP")) return MotionFormat::c3d;
  return std::nullopt;
}

std::optional<MotionFormat> motion_format_of_name(std::string_view path) {
  const std::string lower = lower_case(path);
  for (const NamedFormat& format : kFormats) {
    if (!format.ending.empty() && lower.ends_with(format.ending)) return format.format;
  }
  return std::nullopt;
}

std::unique_ptr<MotionReader> open_motion(const std::string& path, MotionFormat format, UpAxis up) {
  auto reader = open_plainly(path, format);
  if (up == UpAxis::z || format == MotionFormat::take) return reader;
  return std::make_unique<TurningReader>(std::move(reader));
}

bool written_while_recording(MotionFormat format) {
  return format == MotionFormat::take || format == MotionFormat::csv;
}

std::unique_ptr<Sink> create_motion(const std::string& path, MotionFormat format, const MotionPlan& plan, UpAxis up) {
  auto sink = create_plainly(path, format, plan, up);
  if (up == UpAxis::z || format == MotionFormat::take) return sink;
  return std::make_unique<TurningSink>(std::move(sink));
}

void write_motion(const std::string& path, MotionFormat format, const Recording& recording, UpAxis up) {
  MemoryReader first(recording), second(recording);
  const MotionInfo info{.header = recording.header,
                        .tracks = first.tracks(),
                        .edits = recording.edits,
                        .head = recording.head,
                        .frame_count = first.instant_count(),
                        .up = {}};
  const auto sink = create_motion(path, format, plan_of(info, first, recording.header.name), up);
  replay(second, *sink);
}

}  // namespace marey::format::motion
