#include "marey/pipeline/take/measure_contours.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/rig.h"
#include "marey/files/whole_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/text_rows.h"
#include "marey/geometry/ground_view.h"

namespace marey::pipeline::take {
namespace {

using analyse::BodyShape;
using analyse::Figure;

constexpr std::array kFigures{&BodyShape::area, &BodyShape::width, &BodyShape::height, &BodyShape::lean, &BodyShape::leg_opening};
constexpr std::array kNames{"area", "width", "height", "lean", "leg_opening"};

/// "area_m2": each name with its unit.
std::string column_of(std::size_t figure, bool metric) {
  const char* unit = figure == 3 ? "deg" : metric ? "m" : "px";
  return fmt::format("{}_{}{}", kNames[figure], unit, figure == 0 ? "2" : "");
}

/// Sums of one figure.
struct Sums {
  double value = 0, square = 0, variance = 0;
  int count = 0;

  void add(const Figure& figure) {
    value += figure.value;
    square += figure.value * figure.value;
    variance += figure.deviation * figure.deviation;
    ++count;
  }
  ContourFigure figure() const {
    if (count == 0) return {};
    const double mean = value / count;
    return {mean, std::sqrt(std::max(0.0, square / count - mean * mean)), std::sqrt(variance / count), count};
  }
};

struct OnePerson {
  std::string label;
  int contours = 0;
  std::array<Sums, kFigures.size()> sums;
};

Figure product(const Figure& a, const Figure& b) {
  return {a.value * b.value, std::hypot(a.value * b.deviation, b.value * a.deviation)};
}

/// The shape in metres where the ground is seen.
std::optional<BodyShape> in_metres(const BodyShape& shape, const Outline& outline, const GroundView& view) {
  const auto body = analyse::body_on_ground(outline, view);
  if (!body) return std::nullopt;
  const Figure area_scale{body->scale.value * body->scale.value, 2 * body->scale.value * body->scale.deviation};
  return BodyShape{.area = product(shape.area, area_scale),
                   .width = product(shape.width, body->scale),
                   .height = body->height,
                   .lean = shape.lean,
                   .leg_opening = product(shape.leg_opening, body->scale)};
}

std::optional<GroundView> ground_of(const std::string& rig_file, const RecordingHeader& header) {
  const std::optional<Rig> rig = rig_file.empty() ? header.rig : std::optional(format::rig::read_rig(rig_file));
  if (!rig || rig->cameras.empty()) return std::nullopt;
  auto view = rig->cameras.front().ground_view(rig->ground);
  if (!rig_file.empty() && (!view || view->camera() == nullptr))
    throw Error("{}: its first camera is not calibrated, so nothing can be measured in metres", rig_file);
  return view && view->camera() != nullptr ? view : std::nullopt;
}

std::string figures_csv(const ContourMeasurement& measured) {
  std::string text = "id,label,contours,measured";
  for (std::size_t f = 0; f < kFigures.size(); ++f) {
    const std::string column = column_of(f, measured.metric);
    text += fmt::format(",{0},{0}_sd,{0}_sigma", column);
  }
  text += '\n';
  for (const PersonContours& person : measured.people) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{}", person.id, format::quoted_field(person.label), person.contours,
                   person.area.samples);
    for (const ContourFigure& one : {person.area, person.width, person.height, person.lean, person.leg_opening}) {
      if (one.samples == 0) {
        text += ",,,";
      } else {
        fmt::format_to(std::back_inserter(text), ",{:.4g},{:.3g},{:.3g}", one.mean, one.spread, one.deviation);
      }
    }
    text += '\n';
  }
  return text;
}

/// A row for each person and instant.
class Series {
 public:
  Series(const std::string& path, bool metric) {
    if (path.empty()) return;
    file_.emplace(path);
    std::string head = "frame,time,id";
    for (std::size_t f = 0; f < kFigures.size(); ++f) head += fmt::format(",{0},{0}_sigma", column_of(f, metric));
    file_->write(head + '\n');
  }

  void add(const Instant& instant, TrackId id, const BodyShape& shape) {
    if (!file_) return;
    std::string row = fmt::format("{},{:.4f},{}", instant.index, seconds(instant.time), number(id));
    for (const auto which : kFigures)
      fmt::format_to(std::back_inserter(row), ",{:.4g},{:.3g}", (shape.*which).value, (shape.*which).deviation);
    file_->write(row + '\n');
  }
  void finish() {
    if (file_) file_->finish();
  }

 private:
  std::optional<WholeFile> file_;
};

ContourMeasurement summed(const std::map<TrackId, OnePerson>& people, bool metric) {
  ContourMeasurement measured{.metric = metric, .people = {}};
  for (const auto& [id, one] : people) {
    measured.people.push_back({.id = number(id),
                               .label = one.label,
                               .contours = one.contours,
                               .area = one.sums[0].figure(),
                               .width = one.sums[1].figure(),
                               .height = one.sums[2].figure(),
                               .lean = one.sums[3].figure(),
                               .leg_opening = one.sums[4].figure()});
  }
  return measured;
}

}  // namespace

bool is_of_image(const std::string& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return false;  // a pipe is read once
  const format::Format* format = format::format_of_content(path);
  if (format == nullptr || !format->holds.has(format::Content::image)) return false;
  return format::open_recording(path, *format)->header().frame.kind == FrameOfReference::Kind::image;
}

ContourMeasurement measure_contours(const std::string& take, const std::string& figures, const MeasureContoursOptions& options,
                                    const Hooks& hooks) {
  const auto reader = format::open_recording(take);
  const std::optional<GroundView> ground = ground_of(options.rig, reader->header());
  WholeFile file(figures);
  Series series(options.series, ground.has_value());
  std::map<TrackId, OnePerson> people;
  std::int64_t done = 0;
  while (const auto instant = reader->next()) {
    if (hooks.report({"frames", ++done, reader->instant_count().value_or(0)}) == Continue::no) throw Stopped();
    for (const Sample& sample : instant->samples) {
      if (!sample.outline) continue;
      OnePerson& person = people[sample.track];
      ++person.contours;
      if (!analyse::is_measurable(*sample.outline)) continue;
      std::optional<BodyShape> shape = analyse::body_shape(*sample.outline);
      if (ground) shape = in_metres(*shape, *sample.outline, *ground);
      if (!shape) continue;
      for (std::size_t f = 0; f < kFigures.size(); ++f) person.sums[f].add((*shape).*kFigures[f]);
      series.add(*instant, sample.track, *shape);
    }
  }
  if (people.empty())
    throw Error(
        "{}: tracks in px without contours have no world coordinates; measure those of `marey track --ground`, or of --contour in "
        "a take",
        take);
  for (const TrackName& name : reader->tracks()) {
    if (const auto person = people.find(name.id); person != people.end()) person->second.label = name.label;
  }
  ContourMeasurement measured = summed(people, ground.has_value());
  file.write(figures_csv(measured));
  file.finish();
  series.finish();
  return measured;
}

}  // namespace marey::pipeline::take
