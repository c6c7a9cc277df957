#include "marey/format/motion/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
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
    const TakeSummary summary = reader_.summary();
    info_.header = reader_.header();
    for (const auto& count : summary.tracks) info_.tracks.push_back(count.track);
    info_.frame_count = summary.first_frame ? *summary.last_frame - *summary.first_frame + 1 : 0;
    info_.edits = reader_.edits();
    info_.up = UpAxis::z;
    if (!summary.complete) warnings_.push_back(path + ": its recording was cut off, or still goes on; what there is was read");
  }
  const MotionInfo& info() const override { return info_; }
  std::optional<TakeFrame> next() override { return reader_.next(); }
  std::vector<std::string> warnings() const override { return warnings_; }

 private:
  take::TakeReader reader_;
  MotionInfo info_;
  std::vector<std::string> warnings_;
};

class TakeMotionWriter : public MotionWriter {
 public:
  TakeMotionWriter(const std::string& path, const MotionPlan& plan) : writer_(path, plan.info.header) {
    for (const TakeTrack& track : plan.info.tracks) writer_.set_label(track.id, track.label);
    for (const TakeEdit& edit : plan.info.edits) writer_.add_edit(edit);
  }
  void write(const TakeFrame& frame) override { writer_.write(frame); }
  void finish() override { writer_.finish(); }

 private:
  take::TakeWriter writer_;
};

/// Turns a world whose y is up so that its z is, or back.
class TurningReader : public MotionReader {
 public:
  explicit TurningReader(std::unique_ptr<MotionReader> reader) : reader_(std::move(reader)) {}
  const MotionInfo& info() const override { return reader_->info(); }
  std::vector<std::string> warnings() const override { return reader_->warnings(); }
  std::optional<TakeFrame> next() override {
    auto frame = reader_->next();
    if (!frame) return frame;
    for (TakePoint& point : frame->points) point.position = {point.position.x(), -point.position.z(), point.position.y()};
    return frame;
  }

 private:
  std::unique_ptr<MotionReader> reader_;
};

class TurningWriter : public MotionWriter {
 public:
  explicit TurningWriter(std::unique_ptr<MotionWriter> writer) : writer_(std::move(writer)) {}
  void write(const TakeFrame& frame) override {
    TakeFrame turned = frame;
    for (TakePoint& point : turned.points) point.position = {point.position.x(), point.position.z(), -point.position.y()};
    writer_->write(turned);
  }
  void finish() override { writer_->finish(); }

 private:
  std::unique_ptr<MotionWriter> writer_;
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

std::unique_ptr<MotionWriter> create_plainly(const std::string& path, MotionFormat format, const MotionPlan& plan, UpAxis up) {
  switch (format) {
    case MotionFormat::take:
      return std::make_unique<TakeMotionWriter>(path, plan);
    case MotionFormat::c3d:
      return create_c3d(path, plan, up);
    case MotionFormat::trc:
      return create_trc(path, plan);
    case MotionFormat::csv:
      return create_tidy_csv(path, plan);
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

MotionPlan plan_of(MotionReader& reader, const std::string& name) {
  MotionPlan plan;
  plan.info = reader.info();
  FrameNumbers numbers;
  while (const auto frame = reader.next()) {
    if (numbers.count() == 0) plan.first_frame = frame->index;
    numbers.add(frame->index);
    plan.last_frame = frame->index;
    for (const TakePoint& point : frame->points) {
      plan.farthest_m = std::max(plan.farthest_m, point.position.cwiseAbs().maxCoeff());
      plan.tells_measured |= point.provenance != Provenance::measured || point.cameras != 0 || point.residual_m.has_value();
    }
  }
  numbers.check(name);
  plan.info.frame_count = plan.last_frame - plan.first_frame + 1;
  return plan;
}

TakeSummary summary_of(MotionReader& reader) {
  TakeSummary summary;
  summary.complete = true;
  std::map<TrackId, TakeSummary::TrackCount> counts;
  for (const TakeTrack& track : reader.info().tracks) counts[track.id].track = track;
  while (const auto frame = reader.next()) {
    if (summary.frames++ == 0) {
      summary.first_frame = frame->index;
      summary.first_time = frame->time;
    }
    summary.last_frame = frame->index;
    summary.last_time = frame->time;
    summary.observations += static_cast<std::int64_t>(frame->observations.size());
    summary.points += static_cast<std::int64_t>(frame->points.size());
    for (const TakePoint& point : frame->points) {
      TakeSummary::TrackCount& count = counts[point.track];
      if (count.measured + count.filled + count.predicted == 0) count.first_frame = frame->index;
      count.last_frame = frame->index;
      ++(point.provenance == Provenance::measured ? count.measured
         : point.provenance == Provenance::filled ? count.filled
                                                  : count.predicted);
    }
  }
  for (auto& [id, count] : counts) summary.tracks.push_back(std::move(count));
  return summary;
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

std::unique_ptr<MotionWriter> create_motion(const std::string& path, MotionFormat format, const MotionPlan& plan, UpAxis up) {
  auto writer = create_plainly(path, format, plan, up);
  if (up == UpAxis::z || format == MotionFormat::take) return writer;
  return std::make_unique<TurningWriter>(std::move(writer));
}

}  // namespace marey::format::motion
