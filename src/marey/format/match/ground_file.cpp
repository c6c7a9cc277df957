#include "marey/format/match/ground_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/mapped_file.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::match {
namespace {

enum Column { frame, time_s, id, label, team, x, y, vx, vy, state, cameras, columns };
constexpr std::array<std::string_view, columns> kNames = {"frame", "time", "id", "label", "team",   "x",
                                                          "y",     "vx",   "vy", "state", "cameras"};
constexpr std::array kNeeded = {id, x, y};
constexpr double kFarthest = 1e5;  // m
constexpr std::size_t kMostCameras = 64;
constexpr std::size_t kShortestRow = 10;  // bytes, as 0,0,1,2,3

class Reader {
 public:
  Reader(const std::string& name, double rate_hz) : name_(name), rate_hz_(rate_hz) {}

  GroundRecording read(std::string_view text) {
    TextLines lines(text);
    std::string_view line;
    if (!lines.next(line)) throw Error("{}: the file is empty; its first line must be {}", name_, fmt::join(kNames, ","));
    read_header(line);
    const auto rows = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    recording_.samples.reserve(std::min(rows, text.size() / kShortestRow));
    while (lines.next(line)) {
      line_ = lines.number();
      if (line.empty()) continue;
      split_fields(line, ',', fields_);
      add();
    }
    if (!where_[frame]) number_frames();
    sort();
    return std::move(recording_);
  }

 private:
  void read_header(std::string_view line) {
    split_fields(line, ',', fields_);
    where_.fill(std::nullopt);
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const auto known = std::find(kNames.begin(), kNames.end(), fields_[i]);
      if (known != kNames.end()) where_[static_cast<std::size_t>(known - kNames.begin())] = i;
    }
    if (!where_[frame] && !where_[time_s])
      throw Error("{}:1: the header has neither a column \"frame\" nor \"time\"; it must read {}", name_, fmt::join(kNames, ","));
    for (const Column needed : kNeeded) {
      if (!where_[needed])
        throw Error("{}:1: the header has no column \"{}\"; it must read {}", name_, kNames[needed], fmt::join(kNames, ","));
    }
  }

  /// The column's field; nothing where it is missing or empty.
  std::optional<std::string_view> field(Column column) const {
    if (!where_[column] || *where_[column] >= fields_.size() || fields_[*where_[column]].empty()) return std::nullopt;
    return fields_[*where_[column]];
  }

  double number(Column column, double least, double most) const {
    const auto text = field(column);
    const auto value = text ? number_of(*text) : std::nullopt;
    if (!value || !(*value >= least && *value <= most))
      throw Error("{}:{}: {} is {}; a number from {:g} to {:g} is wanted", name_, line_, kNames[column],
                  text ? shown(*text) : std::string("missing"), least, most);
    return *value;
  }

  std::string text(Column column) const {
    const auto found = field(column);
    return found ? unquoted(*found) : std::string();
  }

  void add() {
    GroundRecording::Sample sample;
    if (where_[frame]) sample.frame = static_cast<std::int32_t>(number(frame, 0, 1e9));
    sample.time = where_[time_s] ? number(time_s, -1e7, 1e7) : sample.frame / rate_hz_;
    sample.person = person(static_cast<int>(number(id, 1, 1e9)));
    sample.place = {number(x, -kFarthest, kFarthest), number(y, -kFarthest, kFarthest)};
    if (field(vx) && field(vy)) sample.velocity = {number(vx, -kFarthest, kFarthest), number(vy, -kFarthest, kFarthest)};
    const std::string how = text(state);
    if (!how.empty() && how != "observed" && how != "predicted")
      throw Error("{}:{}: state is {}; it must be observed or predicted", name_, line_, shown(how));
    sample.observed = how != "predicted";
    sample.cameras = cameras_of(text(cameras));
    recording_.samples.push_back(sample);
  }

  /// Frames from times alone: as many a second as there are instants, from time 0 or the first instant on, which is the earlier.
  void number_frames() {
    std::vector<double> times;
    for (const auto& sample : recording_.samples) times.push_back(sample.time);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
    if (steps.empty()) return;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    const double start = std::min(0.0, times.front());
    if ((times.back() - start) / *middle > 1e9) throw Error("{}: its times are {:g} s apart, which makes no rate", name_, *middle);
    for (auto& sample : recording_.samples) sample.frame = static_cast<std::int32_t>(std::lround((sample.time - start) / *middle));
  }

  std::int32_t person(int number) {
    const auto [entry, is_new] = people_.try_emplace(number, static_cast<std::int32_t>(recording_.people.size()));
    if (is_new) recording_.people.push_back({number, {}, {}});
    GroundRecording::Person& one = recording_.people[static_cast<std::size_t>(entry->second)];
    if (one.label.empty()) one.label = text(label);
    if (one.team.empty()) one.team = text(team);
    return entry->second;
  }

  CameraMask cameras_of(const std::string& names) {
    std::uint64_t mask = 0;
    split_fields(names, ' ', names_);
    for (const std::string_view one : names_) {
      if (one.empty()) continue;
      auto known = std::find(recording_.cameras.begin(), recording_.cameras.end(), one);
      if (known == recording_.cameras.end()) {
        if (recording_.cameras.size() == kMostCameras) throw Error("{}:{}: more than {} cameras", name_, line_, kMostCameras);
        known = recording_.cameras.insert(known, std::string(one));
      }
      mask |= std::uint64_t{1} << (known - recording_.cameras.begin());
    }
    return mask;
  }

  void sort() {
    auto& samples = recording_.samples;
    const auto order = [&](const GroundRecording::Sample& one) {
      return std::pair(one.frame, recording_.people[static_cast<std::size_t>(one.person)].id);
    };
    const auto before = [&](const auto& a, const auto& b) { return order(a) < order(b); };
    if (!std::is_sorted(samples.begin(), samples.end(), before)) std::stable_sort(samples.begin(), samples.end(), before);
    const auto twice =
        std::adjacent_find(samples.begin(), samples.end(), [&](const auto& a, const auto& b) { return order(a) == order(b); });
    if (twice != samples.end())
      throw Error("{}: person {} is twice in frame {}", name_, recording_.people[static_cast<std::size_t>(twice->person)].id,
                  twice->frame);
  }

  const std::string& name_;
  double rate_hz_;
  std::size_t line_ = 1;
  GroundRecording recording_;
  std::map<int, std::int32_t> people_;
  std::array<std::optional<std::size_t>, columns> where_;
  std::vector<std::string_view> fields_, names_;
};

}  // namespace

GroundRecording parse_ground(std::string_view text, const std::string& name, double rate_hz) {
  return Reader(name, rate_hz).read(text);
}

GroundRecording read_ground(const std::string& path, double rate_hz) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) return parse_ground(MappedFile(path).text(), path, rate_hz);
  return parse_ground(read_file(path), path == "-" ? "standard input" : path, rate_hz);
}

GroundWriter::GroundWriter(const std::string& path, std::vector<std::string> cameras) : file_(path), cameras_(std::move(cameras)) {
  text_ = fmt::format("{}\n", fmt::join(kNames, ","));
}

void GroundWriter::write(const GroundRecording::Sample& sample, const GroundRecording::Person& person) {
  seen_by_.clear();
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if ((sample.cameras >> i & 1) == 0) continue;
    if (!seen_by_.empty()) seen_by_ += ' ';
    seen_by_ += cameras_[i];
  }
  fmt::format_to(std::back_inserter(text_), "{},{:.4f},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{},{}\n", sample.frame, sample.time,
                 person.id, quoted_field(person.label), quoted_field(person.team), sample.place.x(), sample.place.y(),
                 sample.velocity.x(), sample.velocity.y(), sample.observed ? "observed" : "predicted", quoted_field(seen_by_));
  if (text_.size() > (std::size_t{1} << 20)) {
    file_.write(text_);
    text_.clear();
  }
}

void GroundWriter::finish() {
  file_.write(text_);
  text_.clear();
  file_.finish();
}

void write_ground(const GroundRecording& recording, const std::string& path) {
  GroundWriter writer(path, recording.cameras);
  for (const GroundRecording::Sample& sample : recording.samples) {
    writer.write(sample, recording.people[static_cast<std::size_t>(sample.person)]);
  }
  writer.finish();
}

}  // namespace marey::format::match
