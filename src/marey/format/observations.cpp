#include "marey/format/observations.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/files/input_file.h"
#include "marey/format/format.h"
#include "marey/format/rig/self_cal_folder.h"
#include "marey/format/take_observations.h"
#include "marey/format/text_rows.h"

namespace marey::format {
namespace {

constexpr double kMaxDistance = 1e7;  // px
constexpr std::int64_t kLastFrame = 1LL << 40;

/// One row of the table, still by name.
struct Row {
  std::string_view camera, marker;
  std::int64_t frame = 0;
  Vector<2> pixel = Vector<2>::Zero();
  bool detected = true;  ///< false where x and y are blank or NaN
};

std::string_view bare_field(std::string_view text) {
  while (!text.empty() && static_cast<unsigned char>(text.front()) <= ' ') text.remove_prefix(1);
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.remove_suffix(1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return text;
}

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(bare_field(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [stop, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The table, row by row.
class Table {
 public:
  explicit Table(const std::string& path) : path_(path), in_(path) {
    if (!in_ || std::filesystem::is_directory(path)) throw Error("{}: these observations cannot be read; is the name right?", path);
    if (!std::getline(in_, line_)) throw Error("{}: the file is empty; it must begin with camera,frame,x,y", path);
    std::string_view header = line_;
    if (header.starts_with("\xEF\xBB\xBF")) header.remove_prefix(3);
    split(header, fields_);
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (fields_[i] == kNames[k]) columns_[k] = i;
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      if (!columns_[k])
        throw Error("{}:1: there is no column \"{}\"; the header must be camera,frame,x,y or camera,frame,x,y,marker", path,
                    kNames[k]);
    }
  }

  /// False at the end.
  bool next(Row& row) {
    while (std::getline(in_, line_)) {
      ++number_;
      if (bare_field(line_).empty()) continue;
      split(line_, fields_);
      row = {};
      row.camera = field(0);
      if (row.camera.empty()) fail("the camera's name is missing");
      const auto frame = number(field(1));
      if (!frame || *frame != std::floor(*frame) || *frame < 0 || *frame > kLastFrame)
        fail(fmt::format("frame is {}; it must be a whole number from 0", shown(field(1))));
      row.frame = static_cast<std::int64_t>(*frame);
      row.pixel = {coordinate(2, row.detected), coordinate(3, row.detected)};
      if (columns_[4] && *columns_[4] < fields_.size()) row.marker = fields_[*columns_[4]];
      return true;
    }
    return false;
  }

  [[noreturn]] void fail(const std::string& what) const { throw Error("{}:{}: {}", path_, number_, what); }

 private:
  std::string_view field(std::size_t column) const {
    const std::size_t at = *columns_[column];
    if (at >= fields_.size()) fail(fmt::format("the row has {} fields, and none for {}", fields_.size(), kNames[column]));
    return fields_[at];
  }

  double coordinate(std::size_t column, bool& detected) const {
    const std::string_view text = field(column);
    const auto value = number(text);
    if (text.empty() || (value && std::isnan(*value))) {
      detected = false;
      return 0;
    }
    if (!value || !(std::abs(*value) < kMaxDistance))
      fail(fmt::format("{} is {}; it must be a number of px", kNames[column], shown(text)));
    return *value;
  }

  static constexpr std::array<std::string_view, 5> kNames{"camera", "frame", "x", "y", "marker"};
  std::string path_;
  InputStream in_;
  std::string line_;
  int number_ = 1;
  std::vector<std::string_view> fields_;
  std::array<std::optional<std::size_t>, 5> columns_{};
};

bool sorted_by_frame(const std::string& path) {
  Table table(path);
  std::int64_t last = -1;
  bool sorted = true;
  FrameNumbers numbers;
  for (Row row; table.next(row);) {
    sorted &= row.frame >= last;
    last = row.frame;
    numbers.add(row.frame);
  }
  numbers.check(path);
  return sorted;
}

void in_order(ObservedFrame& frame) {
  std::stable_sort(frame.points.begin(), frame.points.end(),
                   [](const ImageObservation& a, const ImageObservation& b) { return a.camera < b.camera; });
}

/// Which of the rig's cameras each of the folder's is: by name where all names agree, else in order.
std::vector<CameraId> cameras_of(const rig::SelfCalFolder& folder, const std::string& path, const Rig& rig) {
  std::map<std::string, int> by_name;
  for (int i = 0; i < std::ssize(rig.cameras); ++i) by_name[rig.cameras[static_cast<std::size_t>(i)].name] = i;
  const bool named =
      std::all_of(folder.names().begin(), folder.names().end(), [&](const std::string& name) { return by_name.contains(name); });
  if (!named && std::ssize(rig.cameras) != folder.cameras()) {
    throw Error("{}: {} cameras, and the rig has {}; they must be the same cameras in the same order", path, folder.cameras(),
                rig.cameras.size());
  }
  std::vector<CameraId> result;
  for (int i = 0; i < folder.cameras(); ++i)
    result.push_back(CameraId{named ? by_name[folder.names()[static_cast<std::size_t>(i)]] : i});
  return result;
}

std::vector<ObservedFrame> frames_of_folder(const std::string& path, const Rig& rig) {
  const rig::SelfCalFolder folder(path);
  const std::vector<CameraId> cameras = cameras_of(folder, path, rig);
  if (!folder.has_points())
    throw Error("{}: there are no observations in this folder: neither points.dat nor camN.points4cal.dat", path);
  std::vector<ObservedFrame> frames;
  for (const rig::SelfCalFolder::Point& point : folder.points()) {
    if (frames.empty() || frames.back().frame != point.frame) frames.push_back({.frame = point.frame});
    frames.back().points.push_back({cameras[static_cast<std::size_t>(point.camera)], point.pixel, ""});
  }
  for (ObservedFrame& frame : frames) in_order(frame);
  return frames;
}

}  // namespace

std::span<const ImageObservation> ObservedFrame::of(CameraId camera) const {
  const auto [begin, end] =
      std::equal_range(points.begin(), points.end(), ImageObservation{.camera = camera},
                       [](const ImageObservation& a, const ImageObservation& b) { return a.camera < b.camera; });
  return {begin, end};
}

struct ObservationReader::Parts {
  // One of the three: a take or a table that is read as it goes, or all frames.
  std::optional<TakeObservations> take;
  std::optional<Table> table;
  std::vector<ObservedFrame> frames;
  std::size_t at = 0;

  std::map<std::string, CameraId, std::less<>> cameras;
  std::string camera_names;
  std::optional<ObservedFrame> pending;  // begun by the row that ended the last one

  void add(const Row& row, ObservedFrame& frame) const {
    const auto camera = cameras.find(row.camera);
    if (camera == cameras.end())
      table->fail(fmt::format("the rig has no camera {}; there are: {}", shown(row.camera), camera_names));
    frame.points.push_back({camera->second, row.pixel, std::string(row.marker)});
  }

  std::optional<ObservedFrame> next_of_table() {
    std::optional<ObservedFrame> frame = std::exchange(pending, std::nullopt);
    for (Row row; table->next(row);) {
      if (!row.detected) continue;
      const bool other = frame && frame->frame != row.frame;
      std::optional<ObservedFrame>& into = other ? pending : frame;
      if (!into) into = ObservedFrame{.frame = row.frame};
      add(row, *into);
      if (other) break;
    }
    if (frame) in_order(*frame);
    return frame;
  }

  void read_all() {
    std::map<std::int64_t, ObservedFrame> by_frame;
    for (Row row; table->next(row);) {
      if (!row.detected) continue;
      ObservedFrame& frame = by_frame[row.frame];
      frame.frame = row.frame;
      add(row, frame);
    }
    table.reset();
    for (auto& [number, frame] : by_frame) {
      in_order(frame);
      frames.push_back(std::move(frame));
    }
  }
};

ObservationReader::ObservationReader(const std::string& path, const Rig& rig) : parts_(std::make_unique<Parts>()) {
  if (std::filesystem::is_directory(path)) {
    parts_->frames = frames_of_folder(path, rig);
    return;
  }
  if (take::is_take(path)) {
    parts_->take.emplace(path, rig);
    return;
  }
  for (int i = 0; i < std::ssize(rig.cameras); ++i) {
    const std::string& name = rig.cameras[static_cast<std::size_t>(i)].name;
    parts_->cameras.emplace(name, CameraId{i});
    parts_->camera_names += (i > 0 ? ", " : "") + name;
  }
  const bool sorted = sorted_by_frame(path);
  parts_->table.emplace(path);
  if (!sorted) parts_->read_all();
}

ObservationReader::~ObservationReader() = default;
ObservationReader::ObservationReader(ObservationReader&&) noexcept = default;
ObservationReader& ObservationReader::operator=(ObservationReader&&) noexcept = default;

std::optional<ObservedFrame> ObservationReader::next() {
  if (parts_->take) return parts_->take->next();
  if (parts_->table) return parts_->next_of_table();
  if (parts_->at == parts_->frames.size()) return std::nullopt;
  return std::move(parts_->frames[parts_->at++]);
}

std::optional<double> ObservationReader::rate_hz() const {
  if (parts_->take) return parts_->take->rate_hz();
  return std::nullopt;
}

std::vector<ObservedFrame> read_observations(const std::string& path, const Rig& rig) {
  ObservationReader reader(path, rig);
  std::vector<ObservedFrame> frames;
  while (auto frame = reader.next()) frames.push_back(std::move(*frame));
  return frames;
}

Rig rig_of_observations(const std::string& path) {
  Rig rig;
  if (std::filesystem::is_directory(path)) {
    const rig::SelfCalFolder folder(path);
    for (int i = 0; i < folder.cameras(); ++i) {
      RigCamera camera;
      camera.name = folder.names()[static_cast<std::size_t>(i)];
      camera.size = folder.size(i);
      if (camera.size) camera.lens = folder.lens(i);
      rig.cameras.push_back(std::move(camera));
    }
    return rig;
  }
  if (take::is_take(path)) return rig_of_take(path);
  Table table(path);
  std::set<std::string, std::less<>> names;
  for (Row row; table.next(row);) {
    if (!names.contains(row.camera)) names.emplace(row.camera);
  }
  for (const std::string& name : names) rig.cameras.emplace_back().name = name;
  return rig;
}

ObservationWriter::ObservationWriter(const std::string& path, const Rig& rig, bool with_markers)
    : file_(path), with_markers_(with_markers) {
  for (const RigCamera& camera : rig.cameras) cameras_.push_back(camera.name);
  file_.write(with_markers ? "camera,frame,x,y,marker\n" : "camera,frame,x,y\n");
}

void ObservationWriter::write(const ObservedFrame& frame) {
  lines_.clear();
  for (const ImageObservation& point : frame.points) {
    fmt::format_to(std::back_inserter(lines_), "{},{},{:.4f},{:.4f}", cameras_[static_cast<std::size_t>(number(point.camera))],
                   frame.frame, point.pixel.x(), point.pixel.y());
    if (with_markers_) (lines_ += ',') += point.marker;
    lines_ += '\n';
  }
  file_.write(lines_);
}

namespace {

bool is_observations(const Beginning& file) {
  if (!file.is_text()) return false;
  std::vector<std::string_view> head;
  split(file.first_line(), head);
  const auto has = [&](std::string_view name) { return std::find(head.begin(), head.end(), name) != head.end(); };
  return has("camera") && has("frame") && has("x") && has("y");
}

std::vector<Fact> facts_of_observations(const std::string& path) {
  const Rig rig = rig_of_observations(path);
  ObservationReader reader(path, rig);
  std::int64_t frames = 0, points = 0, first = 0, last = 0;
  std::set<std::string> markers;
  std::vector<std::int64_t> detected(rig.cameras.size());
  while (const auto frame = reader.next()) {
    if (frames++ == 0) first = frame->frame;
    last = frame->frame;
    points += std::ssize(frame->points);
    for (const ImageObservation& point : frame->points) {
      ++detected[static_cast<std::size_t>(marey::number(point.camera))];
      if (!point.marker.empty()) markers.insert(point.marker);
    }
  }
  std::vector<std::string> names, counts;
  for (std::size_t i = 0; i < detected.size(); ++i) {
    names.push_back(rig.cameras[i].name);
    counts.push_back(fmt::format("{}: {} points", rig.cameras[i].name, detected[i]));
  }
  std::vector<Fact> facts{{"cameras", names, fmt::format("{} ({})", names.size(), fmt::join(counts, ", "))},
                          {"points", points},
                          {"frames", frames, fmt::format("{} in which something was seen", frames)}};
  if (frames > 0) {
    facts.push_back({"first_frame", first, fmt::format("{}, counted from 0", first)});
    facts.push_back({"last_frame", last});
  }
  if (!markers.empty()) facts.push_back({"markers", std::vector<std::string>(markers.begin(), markers.end())});
  return facts;
}

}  // namespace

Format observations_format() {
  return {.name = "observations",
          .title = "observations of markers, one row each",
          .endings = {},
          .holds = Content::observations,
          .detail =
              "px; `camera,frame,x,y`, perhaps `marker`; frames and pixels count from 0. For `marey reconstruct --observations` "
              "and `marey calibrate wand`; so is a folder of MultiCamSelfCal's",
          .is = is_observations,
          .facts = facts_of_observations};
}

}  // namespace marey::format
