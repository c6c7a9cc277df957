#include "marey/pipeline/take/convert.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/format/motion/force_plates.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/skeleton/rig_names.h"
#include "marey/format/take/take_plates.h"
#include "marey/pipeline/take/ground_orientation.h"
#include "marey/pipeline/take/part_of_recording.h"

namespace marey::pipeline::take {
namespace {

using format::Content;
using format::Format;
using format::UpAxis;
using format::match::GroundMatch;

/// Whether y grows downwards in the user's frame; nothing if the user does not specify.
std::optional<bool> stated_y_down(const ConvertOptions& options) {
  if (!options.rig.empty()) return rig_has_y_down(options.rig);
  return options.frame.y_down ? std::optional(true) : std::nullopt;
}

/// The axes that are up in the two files; nothing for the first: as it says itself.
std::pair<std::optional<UpAxis>, UpAxis> axes(const ConvertOptions& options, const Format& from, const Format& to) {
  if (options.from_up) {
    if (from.z_up) throw format::WrongFormat("{}", "a take's z is up always; --from-up is for other files");
    return {options.from_up, options.up.value_or(UpAxis::z)};
  }
  if (to.z_up) return {options.up, UpAxis::z};
  return {std::nullopt, options.up.value_or(UpAxis::z)};
}

void refuse_axes(const std::string& from, const ConvertOptions& options, const char* what) {
  if (options.up || options.from_up) throw format::WrongFormat("{}: {}; --up and --from-up are for points in space", from, what);
}

ConvertSummary convert_rig(const std::string& from, const std::string& to, const Format& format, const ConvertOptions& options) {
  const Format& other = format::format_to_write(to, options.format, Content::rig);
  refuse_axes(from, options, "is a calibration, whose z is up always");
  const Rig rig = format.read_rig(from);
  other.write_rig(rig, to);
  ConvertSummary summary{.format = "a calibration", .counted = "cameras", .count = std::ssize(rig.cameras), .warnings = {}};
  if (!rig.ground.flat() && other.name != "marey")
    summary.warnings.push_back(fmt::format("{}: that the ground is not level is not reported: this format cannot", to));
  return summary;
}

/// Of people on the ground users count the places, of others the frames.
void count(const RecordingHeader& header, std::int64_t frames, std::int64_t samples, ConvertSummary& summary) {
  const bool ground = format::content_of(header.frame) == Content::ground;
  summary.counted = ground ? "places" : "frames";
  summary.count = ground ? samples : frames;
}

/// Halves end with the frames that are left.
void cut_to(GroundMatch& match, const edit::FrameRange& frames) {
  match.recording = part_of(match.recording, frames, match.recording.header.name);
  std::erase_if(match.order, [&](TrackId track) { return match.recording.find(track) == nullptr; });
  for (format::match::GroundPeriod& period : match.periods) {
    period.first_frame = static_cast<std::int32_t>(std::max<std::int64_t>(period.first_frame, frames.first));
    period.last_frame = static_cast<std::int32_t>(std::min<std::int64_t>(period.last_frame, frames.last));
  }
  std::erase_if(match.periods, [](const format::match::GroundPeriod& period) { return period.last_frame < period.first_frame; });
}

std::unique_ptr<format::FileReader> opened(const std::string& from, const Format& in, const format::ReadOptions& how,
                                           const std::optional<edit::FrameRange>& frames) {
  auto reader = format::open_recording(from, in, how);
  return frames ? part_of(std::move(reader), *frames) : std::move(reader);
}

/// A recording that is written whole, or was read whole.
ConvertSummary convert_match(GroundMatch match, const std::string& to, const Format& from, const Format& format,
                             const ConvertOptions& options) {
  if (!options.home.empty()) match.home = options.home;
  if (!options.away.empty()) match.away = options.away;
  if (!options.periods.empty()) match.periods = options.periods;
  if (options.frames) cut_to(match, *options.frames);
  if (options.labelled) match.recording.erase_tracks_if([](const TrackColumns& track) { return track.name.label.empty(); });
  const std::optional<bool> y_down = stated_y_down(options);
  if (from.from_corner != format.from_corner) {
    const auto rotated = format.from_corner ? format::match::to_corner : format::match::from_corner;
    const format::match::GroundFrame frame{.y_down = y_down.value_or(format.from_corner && y_grows_down(match.recording.header)),
                                           .centred = options.frame.centred};
    match.recording = rotated(std::move(match.recording), match.pitch, frame);
  } else if (y_down && match.recording.header.frame.kind == FrameOfReference::Kind::user_ground) {
    set_y_down(match.recording.header, *y_down);
  }
  ConvertSummary summary{.format = std::string(format.name), .counted = {}, .warnings = match.warnings};
  const std::vector<std::string> lost = format::write_whole(to, format, match);
  summary.warnings.insert(summary.warnings.end(), lost.begin(), lost.end());
  count(match.recording.header, std::ssize(match.recording.instants()), match.recording.samples(), summary);
  return summary;
}

/// `tracks` by id.
void exclude_others(Instant& instant, const std::vector<TrackName>& tracks) {
  std::erase_if(instant.samples, [&](const Sample& point) {
    const auto by_id = [](const TrackName& track, TrackId id) { return track.id < id; };
    const auto found = std::lower_bound(tracks.begin(), tracks.end(), point.track, by_id);
    return found == tracks.end() || found->id != point.track;
  });
}

/// Throws Error if no frame of `reader` is one of the plan's; warns of frames without channels, and of labels that are others.
void compare_with_analog(format::FileReader& reader, const std::string& path, const std::string& from,
                         const format::WritePlan& plan, std::vector<std::string>& warnings) {
  const format::FileInfo& info = reader.info();
  const auto begin = reader.next();
  if (!begin || std::abs(info.header.rate_hz / plan.info.header.rate_hz - 1) > 1e-6) return;  // the writer refuses other rates
  const std::int64_t first = begin->index, last = first + info.frame_count.value_or(1) - 1;
  const std::int64_t frames = plan.last_frame - plan.first_frame + 1;
  const std::int64_t shared = std::min(last, plan.last_frame) - std::max(first, plan.first_frame) + 1;
  const std::string ranges =
      fmt::format("{}: has frames {} to {}, and {} has {} to {}", path, first, last, from, plan.first_frame, plan.last_frame);
  if (frames > 0 && shared <= 0) throw Error("{}: none is in both; --analog wants the file that the recording was made of", ranges);
  if (shared < frames)
    warnings.push_back(
        fmt::format("{}: {} of {} frames have no values of its analog channels; is it the file that the recording was "
                    "made of?",
                    ranges, frames - shared, frames));
  std::set<std::string> labels;
  for (const TrackName& track : plan.info.tracks) labels.insert(track.label);
  labels.erase("");
  const auto known = [&](const TrackName& track) { return labels.contains(track.label); };
  if (!labels.empty() && !info.tracks.empty() && std::none_of(info.tracks.begin(), info.tracks.end(), known))
    warnings.push_back(
        fmt::format("{}: none of its {} labels is among the {} of {}; is it the file that the recording was made of?", path,
                    info.tracks.size(), labels.size(), from));
}

/// What stands beside the points of another C3D file, in place of what stands beside those of `from`.
format::AuxiliaryData analog_of(const std::string& path, const std::string& from, const std::string& to, const Format& out,
                                const format::WritePlan& plan, std::vector<std::string>& warnings) {
  if (!out.auxiliary_data) throw format::WrongFormat("{}: --analog is for C3D, which alone holds such channels", to);
  const auto reader = format::open_recording(path, format::format_to_read(path, Content::space));
  const format::AuxiliaryData auxiliary = reader->info().auxiliary, &own = plan.info.auxiliary;
  if (!auxiliary.any()) throw Error("{}: holds neither analog channels nor events; --analog wants a C3D file that does", path);
  compare_with_analog(*reader, path, from, plan, warnings);
  if (own.any() && own.path != path)
    warnings.push_back(fmt::format("{}: its own {} analog channels and {} events are omitted; those of {} take their place", from,
                                   own.channels, own.events, path));
  return auxiliary;
}

/// Force plates of a C3D file, or of another take, into a take.
void copy_plates(const std::string& from, const Format& in, const format::AuxiliaryData& auxiliary, const std::string& to,
                 std::vector<std::string>& warnings) {
  std::vector<ForcePlate> plates;
  if (auxiliary.channels > 0) {
    format::motion::AnalogData analog = format::motion::read_analog_data(auxiliary);
    plates = std::move(analog.plates);
    warnings.insert(warnings.end(), analog.warnings.begin(), analog.warnings.end());
  } else if (in.name == "take") {
    plates = format::take::read_plates(from);
  }
  if (!plates.empty()) format::take::write_plates(to, plates);
}

/// Instant by instant, so that memory does not grow with its length. Read twice: most formats begin with data known only at the
/// end.
ConvertSummary convert_stream(const std::string& from, const std::string& to, const Format& in, const Format& out,
                              const ConvertOptions& options, const Hooks& hooks) {
  ConvertSummary summary{.format = std::string(out.name), .counted = {}, .warnings = {}};
  std::int64_t frames = 0, samples = 0;
  format::ReadOptions how = options.read;
  const auto [from_up, to_up] = axes(options, in, out);
  how.up = from_up;
  format::WritePlan plan;
  {
    const auto first = opened(from, in, how, options.frames);
    plan = format::plan_of(*first, from);
    summary.warnings = first->warnings();
    if (options.frames) require_frames(plan.last_frame - plan.first_frame + 1, *options.frames, from);
  }
  plan.up = to_up;
  if (!options.rig.empty()) plan.info.header.rig = format::rig::read_rig(options.rig);
  if (options.labelled) {
    std::erase_if(plan.info.tracks, [](const TrackName& track) { return track.label.empty(); });
    if (plan.info.tracks.empty()) throw Error("{}: none of its tracks has a label; without --labelled-only all are written", from);
  }
  if (!options.rig_names.empty() && !format::skeleton::is_bone_file(to))
    throw format::WrongFormat("{}: --rig-names is for bones: .bvh and .glb", to);
  if (auto message_text = format::poses_lost(plan.info.header, to, out)) summary.warnings.push_back(std::move(*message_text));
  if (!options.analog.empty()) plan.info.auxiliary = analog_of(options.analog, from, to, out, plan, summary.warnings);
  if (auto message_text = format::auxiliary_lost(plan.info.auxiliary, to, out))
    summary.warnings.push_back(std::move(*message_text));
  const auto reader = opened(from, in, how, options.frames);
  const auto sink = options.rig_names.empty() ? format::create_recording(to, out, plan)
                                              : format::skeleton::create_bones(to, {.rig_names = options.rig_names});
  sink->begin(plan.info.header);
  while (auto instant = reader->next()) {
    if (options.labelled) exclude_others(*instant, plan.info.tracks);
    if (frames == 0) instant->named = plan.info.tracks;
    samples += std::ssize(instant->samples);
    sink->write(*instant);
    if (hooks.report({.step = "converting", .done = ++frames, .total = plan.info.frame_count}) == Continue::no) {
      summary.stopped = true;
      return summary;
    }
  }
  sink->finish();
  if (out.name == "take") copy_plates(from, in, plan.info.auxiliary, to, summary.warnings);
  count(plan.info.header, frames, samples, summary);
  return summary;
}

}  // namespace

ConvertSummary convert(const std::string& from, const std::string& to, const ConvertOptions& options, const Hooks& hooks) {
  const Format& in = format::format_to_read(from, format::kRecordings | Content::rig);
  if (in.read_rig != nullptr) {
    if (options.frames) throw format::WrongFormat("{}: is a calibration; --frames is for recordings", from);
    return convert_rig(from, to, in, options);
  }
  if (in.read != nullptr) {
    refuse_axes(from, options, "holds no points in space");
    GroundMatch match = format::read_whole(from, in, options.read);
    const Format& out = format::format_to_write(to, options.format, format::content_of(match.recording.header.frame));
    return convert_match(std::move(match), to, in, out, options);
  }
  ConvertOptions how = options;
  how.read.as_recorded = true;
  if (in.skeleton) how.read.skeleton_up = std::exchange(how.from_up, std::nullopt).value_or(UpAxis::y);
  const Content content = format::content_of(format::open_recording(from, in, how.read)->header().frame);
  if (content != Content::space) refuse_axes(from, options, "holds no points in space");
  const Format& out = format::format_to_write(to, options.format, content);
  // A copy of a take keeps the recorded data and its edits; the edited result is for the others.
  how.read.as_recorded = options.read.as_recorded || (in.name == out.name && !options.labelled && !options.frames);
  if (out.create != nullptr) return convert_stream(from, to, in, out, how, hooks);
  return convert_match(format::read_whole(from, in, how.read), to, in, out, how);
}

}  // namespace marey::pipeline::take
