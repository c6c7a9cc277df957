#include "marey/format/match/ground_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/files/text_safety.h"
#include "marey/format/mapped_file.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"
#include "marey/geometry/median.h"

namespace marey::format::match {
namespace {

enum Column {
  kFrame,
  kTime,
  kId,
  kLabel,
  kTeam,
  kX,
  kY,
  kVx,
  kVy,
  kState,
  kCameras,
  kLeft,
  kTop,
  kWidth,
  kHeight,
  kZ,
  kVz,
  kXx,
  kXy,
  kYy,
  kYDown,
  kColumns
};
constexpr std::array<std::string_view, kColumns> kAllNames = {"frame",  "time", "id",    "label",   "team", "x",   "y",
                                                              "vx",     "vy",   "state", "cameras", "left", "top", "width",
                                                              "height", "z",    "vz",    "xx",      "xy",   "yy",  "y_down"};
constexpr std::span<const std::string_view> kNames = std::span(kAllNames).first(
    kLeft);  // the others are of tracks in an image, of the ball, of places whose covariance is known, and of a reflected ground
constexpr std::array kNeeded = {kId, kX, kY};
constexpr double kMaxDistance = 1e5;  // m
constexpr double kMaxTime = 1e10;     // s: frame 1e9 at 0.1 Hz
constexpr std::size_t kMaxCameras = 64;
constexpr double kMaxVariance = 1e6, kRounded = 1e-3;  // m²
constexpr double kDefault = 0.1;  // share by which a step may differ from the median one, for times are rounded

/// Frames a second: the mean over the steps that are about the median one, to 1/1000 Hz; 25 if there is no step.
double rate_of(std::span<const Recording::TimeStep> time_steps) {
  const auto median = median_rate_hz(time_steps);
  if (!median) return 25;
  std::int64_t frames = 0;
  Duration time{};
  for (std::size_t i = 1; i < time_steps.size(); ++i) {
    const std::int64_t count = time_steps[i].index - time_steps[i - 1].index;
    const Duration step = time_steps[i].time - time_steps[i - 1].time;
    if (std::abs(seconds(step) * *median - static_cast<double>(count)) > kDefault * static_cast<double>(count)) continue;
    frames += count;
    time += step;
  }
  return std::round(1000 * static_cast<double>(frames) / seconds(time)) / 1000;
}

class GroundFileReader {
 public:
  GroundFileReader(const std::string& name, double rate_hz) : name_(name), rate_hz_(rate_hz), builder_(name) {}

  void read(std::string_view text, GroundMatch& match) {
    TextLines lines(text);
    std::string_view line;
    if (!lines.next(line)) throw Error("{}: the file is empty; its first line must be {}", name_, fmt::join(kNames, ","));
    read_header(line);
    if (!where_[kFrame]) number_frames(text);
    while (lines.next(line)) {
      line_ = lines.number();
      if (line.empty()) continue;
      split_fields(line, ',', fields_);
      add();
    }
    if (!moves_) builder_.forget_velocities();
    finish(match);
  }

 private:
  void read_header(std::string_view line) {
    split_fields(line, ',', fields_);
    where_.fill(std::nullopt);
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const auto known = std::find(kAllNames.begin(), kAllNames.end(), fields_[i]);
      if (known != kAllNames.end()) where_[static_cast<std::size_t>(known - kAllNames.begin())] = i;
    }
    if (!where_[kFrame] && !where_[kTime])
      throw Error("{}:1: the header has neither a column \"frame\" nor \"time\"; it must read {}", name_, fmt::join(kNames, ","));
    for (const Column needed : kNeeded) {
      if (!where_[needed])
        throw Error("{}:1: the header has no column \"{}\"; it must read {}", name_, kAllNames[needed], fmt::join(kNames, ","));
    }
    has_boxes_ = where_[kLeft] && where_[kTop] && where_[kWidth] && where_[kHeight];
  }

  void finish(GroundMatch& match) {
    RecordingHeader& header = match.recording.header;
    header.name = name_;
    header.frame.kind = has_boxes_ ? FrameOfReference::Kind::image : FrameOfReference::Kind::user_ground;
    match.order = builder_.finish(match.recording);
    header.rate_hz = rate_of(match.recording.instants());
    if (!cameras_.empty()) header.rig.emplace();
    for (std::string& camera : cameras_) header.rig->cameras.emplace_back().name = std::move(camera);
    if (y_down_) set_y_down(header, *y_down_);
  }

  /// The column's field; nothing if it is missing or empty.
  std::optional<std::string_view> field(Column column) const {
    if (!where_[column] || *where_[column] >= fields_.size() || fields_[*where_[column]].empty()) return std::nullopt;
    return fields_[*where_[column]];
  }

  double number(Column column, double minimum, double maximum) const {
    const auto text = field(column);
    const auto value = text ? number_of(*text) : std::nullopt;
    if (!value || !(*value >= minimum && *value <= maximum))
      throw Error("{}:{}: {} is {}; a number from {:g} to {:g} is wanted", name_, line_, kAllNames[column],
                  text ? shown(*text) : std::string("missing"), minimum, maximum);
    return *value;
  }

  std::string text(Column column) const {
    const auto found = field(column);
    return found ? plain_text(unquoted(*found)) : std::string();
  }

  void add() {
    GroundBuilder::Row row;
    if (where_[kFrame]) row.frame = static_cast<std::int32_t>(number(kFrame, 0, kMaxFrame - 1));
    row.time = where_[kTime] ? number(kTime, -kMaxTime, kMaxTime) : row.frame / rate_hz_;
    if (!where_[kFrame]) row.frame = static_cast<std::int32_t>(std::lround((row.time - start_s_) / step_s_));
    const std::int32_t person = builder_.person(static_cast<int>(number(kId, 1, 1e9)), text(kLabel), text(kTeam));
    row.location = {number(kX, -kMaxOnGround, kMaxOnGround), number(kY, -kMaxOnGround, kMaxOnGround)};
    if (field(kVx) && field(kVy))
      row.velocity = Vector<2>(number(kVx, -kMaxOnGround, kMaxOnGround), number(kVy, -kMaxOnGround, kMaxOnGround));
    if (field(kXx) && field(kXy) && field(kYy)) row.covariance = covariance();
    if (field(kZ)) row.height = number(kZ, -kMaxOnGround, kMaxOnGround);
    if (field(kVz)) row.climb = number(kVz, -kMaxOnGround, kMaxOnGround);
    moves_ |= row.velocity && *row.velocity != Vector<2>::Zero();
    if (const std::string state = text(kState); !state.empty()) {
      const auto provenance = provenance_of(state);
      if (!provenance)
        throw Error("{}:{}: state is {}; it must be {}", name_, line_, shown(state), fmt::join(kProvenanceNames, ", "));
      row.provenance = *provenance;
    }
    row.cameras = cameras_of(text(kCameras));
    if (has_boxes_ && field(kLeft)) {
      row.box = Box{number(kLeft, -kMaxDistance, kMaxDistance), number(kTop, -kMaxDistance, kMaxDistance),
                    number(kWidth, 0, kMaxDistance), number(kHeight, 0, kMaxDistance)};
    }
    if (field(kYDown)) read_y_down();
    builder_.add(person, row);
  }

  void read_y_down() {
    const double value = number(kYDown, 0, 1);
    const bool down = value > 0.5;
    if ((value != 0 && value != 1) || y_down_.value_or(down) != down)
      throw Error("{}:{}: y_down is {}; it must be 0 or 1, in all rows the same", name_, line_, shown(*field(kYDown)));
    y_down_ = down;
  }

  Matrix<2> covariance() const {
    const double xx = number(kXx, 0, kMaxVariance), xy = number(kXy, -kMaxVariance, kMaxVariance),
                 yy = number(kYy, 0, kMaxVariance);
    if (xy * xy > xx * yy * (1 + kRounded) + kRounded)
      throw Error("{}:{}: xx {:g}, xy {:g}, yy {:g} is not a covariance: xy is at most the root of xx times yy", name_, line_, xx,
                  xy, yy);
    return (Matrix<2>() << xx, xy, xy, yy).finished();
  }

  /// Frames from times alone: as many a second as there are instants, from time 0 or the first instant on, which is the earlier.
  void number_frames(std::string_view text) {
    std::vector<double> times;
    TextLines lines(text);
    std::string_view line;
    lines.next(line);  // the header
    while (lines.next(line)) {
      line_ = lines.number();
      if (line.empty()) continue;
      split_fields(line, ',', fields_);
      times.push_back(number(kTime, -kMaxTime, kMaxTime));
    }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
    if (!times.empty()) start_s_ = times.front();
    if (steps.empty()) return;
    step_s_ = geometry::median(steps);
    start_s_ = std::min(0.0, times.front());
    if ((times.back() - start_s_) / step_s_ > 1e9)
      throw Error("{}: its times are {:g} s apart, which makes no rate", name_, step_s_);
  }

  CameraMask cameras_of(const std::string& names) {
    std::uint64_t mask = 0;
    split_fields(names, ' ', names_);
    for (const std::string_view one : names_) {
      if (one.empty()) continue;
      auto known = std::find(cameras_.begin(), cameras_.end(), one);
      if (known == cameras_.end()) {
        if (cameras_.size() == kMaxCameras) throw Error("{}:{}: more than {} cameras", name_, line_, kMaxCameras);
        known = cameras_.insert(known, std::string(one));
      }
      mask |= std::uint64_t{1} << (known - cameras_.begin());
    }
    return mask;
  }

  const std::string& name_;
  double rate_hz_;
  std::size_t line_ = 1;
  GroundBuilder builder_;
  std::vector<std::string> cameras_;
  std::optional<bool> y_down_;
  bool has_boxes_ = false;
  bool moves_ = false;               // a velocity that is not 0 was read
  double start_s_ = 0, step_s_ = 1;  // of frames that only times give
  std::array<std::optional<std::size_t>, kColumns> where_;
  std::vector<std::string_view> fields_, names_;
};

}  // namespace

Recording parse_ground(std::string_view text, const std::string& name, double rate_hz) {
  GroundMatch match;
  GroundFileReader(name, rate_hz).read(text, match);
  return std::move(match.recording);
}

Recording read_ground(const std::string& path, double rate_hz) {
  return read_ground_match(path, {.metadata = {}, .pitch = {}, .rate_hz = rate_hz}).recording;
}

GroundMatch read_ground_match(const std::string& path, const ReadOptions& options) {
  std::error_code error;
  GroundMatch match;
  match.pitch = options.pitch;
  if (std::filesystem::is_regular_file(path, error)) {
    GroundFileReader(path, options.rate_hz).read(MappedFile(path).text(), match);
  } else {
    const std::string name = path == "-" ? "standard input" : path;
    GroundFileReader(name, options.rate_hz).read(read_file(path), match);
  }
  return match;
}

bool is_own_ground_csv(const Beginning& file) {
  return file.first_line().starts_with(fmt::format("{}", fmt::join(kNames, ",")));
}

bool is_ground_csv(const Beginning& file, bool with_boxes) {
  std::vector<std::string_view> head;
  split_fields(file.first_line(), ',', head);
  const auto has = [&](std::string_view name) { return std::find(head.begin(), head.end(), name) != head.end(); };
  const bool boxes = has("left") && has("top") && has("width") && has("height");
  return (has("frame") || has("time")) && has("id") && has("x") && has("y") && (!has("z") || has("team")) && boxes == with_boxes;
}

Sink::SinkRequirements GroundWriter::begin(const RecordingHeader& header) {
  require_ground(header, "the CSV of people");
  if (header.rig) {
    for (const RigCamera& camera : header.rig->cameras) cameras_.push_back(camera.name);
  }
  if (y_grows_down(header)) extras_.push_back(Extra::y_down);
  return {};
}

void GroundWriter::write(const Instant& instant) {
  for (const TrackName& name : instant.named) {
    const bool ball = name.kind == TrackKind::ball;  // known by its label when the file is read
    fields_[name.id] = {ball ? std::string(kBallLabel) : quoted_field(name.label), ball ? "" : quoted_field(name.team), ball};
    if (ball) add_columns(Extra::heights);
  }
  const double time = seconds(instant.time);
  for (const Sample& sample : instant.samples) {
    if (sample.covariance) add_columns(Extra::covariances);
    observed_by_.clear();
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      if ((sample.cameras >> i & 1) == 0) continue;
      if (!observed_by_.empty()) observed_by_ += ' ';
      observed_by_ += cameras_[i];
    }
    const Fields& fields = fields_[sample.track];
    const Vector<3> velocity = sample.velocity.value_or(Vector<3>::Zero());
    fmt::format_to(std::back_inserter(text_), "{},{:.4f},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{},{}", instant.index, time,
                   number(sample.track), fields.label, fields.team, sample.position.x(), sample.position.y(), velocity.x(),
                   velocity.y(), to_string(sample.provenance), quoted_field(observed_by_));
    for (const Extra extra : extras_) write_extra(extra, sample, fields.ball);
    text_ += '\n';
  }
  if (text_.size() > (std::size_t{1} << 20)) flush();
}

void GroundWriter::write_extra(Extra extra, const Sample& sample, bool ball) {
  if (extra == Extra::y_down) {
    text_ += ",1";
  } else if (extra == Extra::heights) {
    if (!ball) return void(text_ += ",,");
    fmt::format_to(std::back_inserter(text_), ",{:.3f},{:.3f}", sample.position.z(),
                   sample.velocity.value_or(Vector<3>::Zero()).z());
  } else if (sample.covariance) {
    const Matrix<3>& P = *sample.covariance;
    fmt::format_to(std::back_inserter(text_), ",{:.5f},{:.5f},{:.5f}", P(0, 0), P(0, 1), P(1, 1));
  } else {
    text_ += ",,,";
  }
}

/// From now on each row has these columns too, and those that wait get them empty; too late where some are written.
void GroundWriter::add_columns(Extra extra) {
  if (head_written_ || std::find(extras_.begin(), extras_.end(), extra) != extras_.end()) return;
  extras_.push_back(extra);
  std::string longer;
  for (const char c : text_) longer.append(c == '\n' ? empty_of(extra) : "").push_back(c);
  text_ = std::move(longer);
}

const char* GroundWriter::empty_of(Extra extra) {
  return extra == Extra::covariances ? ",,," : ",,";
}

const char* GroundWriter::columns_of(Extra extra) {
  switch (extra) {
    case Extra::y_down:
      return ",y_down";
    case Extra::heights:
      return ",z,vz";
    case Extra::covariances:
      break;
  }
  return ",xx,xy,yy";
}

void GroundWriter::flush() {
  if (!std::exchange(head_written_, true)) {
    file_.write(fmt::format("{}", fmt::join(kNames, ",")));
    for (const Extra extra : extras_) file_.write(columns_of(extra));
    file_.write("\n");
  }
  file_.write(text_);
  text_.clear();
}

void GroundWriter::finish() {
  flush();
  file_.finish();
}

void write_ground(const Recording& recording, const std::string& path) {
  GroundWriter writer(path);
  writer.begin(recording.header);
  InstantsOf instants(recording);
  while (const auto instant = instants.next()) writer.write(*instant);
  writer.finish();
}

Format ground_format() {
  return {
      .name = "ground",
      .title = "people on the ground, one row each",
      .endings = ".csv",
      .holds = Content::ground,
      .detail =
          "yours, m; everything: `frame,time,id,label,team,x,y,vx,vy,state,cameras`, and `y_down` where y grows downwards. Read "
          "with any columns beyond `id,x,y` and `frame` or `time`, in any order",
      .is = [](const Beginning& file) { return match::is_ground_csv(file, false); },
      .read = match::read_ground_match,
      .create = [](const std::string& path, const WritePlan&) -> std::unique_ptr<Sink> {
        return std::make_unique<match::GroundWriter>(path);
      },
      .while_recording = true};
}

}  // namespace marey::format::match
