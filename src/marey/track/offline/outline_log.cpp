#include "marey/track/offline/outline_log.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <system_error>

#include <unistd.h>

#include "marey/core/error.h"

namespace marey::track::offline {
namespace {

namespace fs = std::filesystem;

struct FrameHead {
  std::int64_t frame;
  std::int64_t outlines;
};

struct OutlineHead {
  std::int32_t id;
  std::int32_t order;
  std::int32_t state;
  std::int32_t control_points;
  std::int32_t lines;
  std::int32_t has_silhouette;
  std::int32_t behind;
  std::int32_t hidden;
};

constexpr std::size_t kMotion = 12, kPoint = 4, kLine = 8;  // numbers each

[[noreturn]] void throw_no_room(const std::string& spill_path) {
  throw Error("{}: no room beside it to keep outlines until they are written ({})", spill_path,
              std::generic_category().message(errno));
}

[[noreturn]] void throw_unreadable(const std::string& spill_path) {
  throw Error("{}: the outlines kept beside it cannot be read again ({})", spill_path, std::generic_category().message(errno));
}

std::FILE* make_unnamed_file(const fs::path& folder) {
  std::string name = (folder / "marey-outlines-XXXXXX").string();
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) return nullptr;
  unlink(name.c_str());
  return fdopen(descriptor, "w+b");
}

void put(std::vector<float>& numbers, const Vector<2>& v) {
  numbers.push_back(static_cast<float>(v.x()));
  numbers.push_back(static_cast<float>(v.y()));
}

void put_all(std::vector<float>& numbers, const Outline& outline, bool with_lines) {
  put(numbers, outline.centre);
  put(numbers, outline.velocity);
  numbers.push_back(static_cast<float>(outline.scale_rate));
  put(numbers, outline.centre_deviation);
  put(numbers, outline.velocity_deviation);
  numbers.push_back(static_cast<float>(outline.scale_rate_deviation));
  put(numbers, outline.silhouette.value_or(Vector<2>::Zero()));
  for (std::size_t i = 0; i < outline.control_points.size(); ++i) {
    put(numbers, outline.control_points[i]);
    put(numbers, outline.deviations[i]);
  }
  for (const TrackId id : outline.behind) numbers.push_back(static_cast<float>(number(id)));
  for (const int point : outline.hidden) numbers.push_back(static_cast<float>(point));
  if (!with_lines) return;
  for (const MeasurementLine& line : outline.lines) {
    put(numbers, line.foot);
    put(numbers, line.normal);
    for (const double value : {line.reach, line.offset, line.variance}) numbers.push_back(static_cast<float>(value));
    numbers.push_back(static_cast<float>(line.finding));
  }
}

std::shared_ptr<const Outline> outline_from(const OutlineHead& head, const float* number) {
  const auto next = [&] { return static_cast<double>(*number++); };
  const auto pair = [&] {
    const double x = next();
    return Vector<2>(x, next());
  };
  auto outline = std::make_shared<Outline>();
  outline->order = head.order;
  outline->state = static_cast<Outline::State>(head.state);
  outline->centre = pair();
  outline->velocity = pair();
  outline->scale_rate = next();
  outline->centre_deviation = pair();
  outline->velocity_deviation = pair();
  outline->scale_rate_deviation = next();
  const Vector<2> silhouette = pair();
  if (head.has_silhouette != 0) outline->silhouette = silhouette;
  for (int i = 0; i < head.control_points; ++i) {
    outline->control_points.push_back(pair());
    outline->deviations.push_back(pair());
  }
  for (int i = 0; i < head.behind; ++i) outline->behind.push_back(TrackId{static_cast<int>(next())});
  for (int i = 0; i < head.hidden; ++i) outline->hidden.push_back(static_cast<int>(next()));
  for (int i = 0; i < head.lines; ++i) {
    MeasurementLine line;
    line.foot = pair();
    line.normal = pair();
    line.reach = next();
    line.offset = next();
    line.variance = next();
    line.finding = static_cast<MeasurementLine::Finding>(static_cast<int>(next()));
    outline->lines.push_back(line);
  }
  return outline;
}

}  // namespace

OutlineLog::OutlineLog(const std::string& spill_path, bool with_lines) : spill_path_(spill_path), with_lines_(with_lines) {
  std::error_code ignored;
  const fs::path folder = fs::path(spill_path).parent_path();
  if (!fs::exists(spill_path, ignored) || fs::is_regular_file(spill_path, ignored)) {
    file_.reset(make_unnamed_file(folder.empty() ? "." : folder));
  }
  if (file_ == nullptr) file_.reset(make_unnamed_file(fs::temp_directory_path(ignored)));
  if (file_ == nullptr) {
    throw Error("{}: there is no place beside it to keep outlines until they are written ({})", spill_path,
                std::generic_category().message(errno));
  }
}

OutlineLog::~OutlineLog() = default;

void OutlineLog::append(const void* data, std::size_t size) {
  if (std::fwrite(data, 1, size, file_.get()) != size) throw_no_room(spill_path_);
}

void OutlineLog::take(void* data, std::size_t size) {
  if (std::fread(data, 1, size, file_.get()) != size) throw_unreadable(spill_path_);
}

void OutlineLog::add(std::int64_t frame, std::span<const Track<2>> tracks) {
  FrameHead head{frame, 0};
  for (const Track<2>& track : tracks) head.outlines += track.outline ? 1 : 0;
  if (head.outlines == 0) return;
  append(&head, sizeof head);
  for (const Track<2>& track : tracks) {
    if (!track.outline) continue;
    const Outline& outline = *track.outline;
    const OutlineHead one{number(track.id),
                          outline.order,
                          static_cast<std::int32_t>(outline.state),
                          static_cast<std::int32_t>(outline.control_points.size()),
                          with_lines_ ? static_cast<std::int32_t>(outline.lines.size()) : 0,
                          outline.silhouette ? 1 : 0,
                          static_cast<std::int32_t>(outline.behind.size()),
                          static_cast<std::int32_t>(outline.hidden.size())};
    append(&one, sizeof one);
    numbers_.clear();
    put_all(numbers_, outline, with_lines_);
    append(numbers_.data(), numbers_.size() * sizeof(float));
  }
}

const OutlineLog::Frame& OutlineLog::at(std::int64_t frame) {
  static const Frame none;
  if (!reading_ || (last_requested_ && frame < *last_requested_)) {
    if (std::fflush(file_.get()) != 0) throw_no_room(spill_path_);
    if (std::fseek(file_.get(), 0, SEEK_SET) != 0) throw_unreadable(spill_path_);
    reading_ = true;
    read_.reset();
  }
  last_requested_ = frame;
  while (!read_ || *read_ < frame) read_frame();
  return read_ == frame ? frame_ : none;
}

void OutlineLog::read_frame() {
  frame_.clear();
  FrameHead head{};
  if (std::fread(&head, sizeof head, 1, file_.get()) != 1) {
    read_ = std::numeric_limits<std::int64_t>::max();
    return;
  }
  read_ = head.frame;
  for (std::int64_t i = 0; i < head.outlines; ++i) {
    OutlineHead one{};
    take(&one, sizeof one);
    numbers_.resize(kMotion + kPoint * static_cast<std::size_t>(one.control_points) + kLine * static_cast<std::size_t>(one.lines) +
                    static_cast<std::size_t>(one.behind + one.hidden));
    take(numbers_.data(), numbers_.size() * sizeof(float));
    frame_.emplace(one.id, outline_from(one, numbers_.data()));
  }
}

}  // namespace marey::track::offline
