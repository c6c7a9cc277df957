#include "marey/core/recording.h"

#include <algorithm>
#include <cmath>

#include <nanobind/eigen/dense.h>

#include "marey/core/error.h"
#include "marey/evaluate/evaluation.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/tracks/boxes.h"
#include "marey/pipeline/take/evaluate_match.h"

#include "bindings.h"

namespace marey::python {
std::vector<std::string> write_recording(const Recording& recording, const std::string& path, const std::string& name) {
  const format::Format& format = format::format_to_write(path, name, format::content_of(recording.header.frame));
  const auto reader = format::reader_of(recording);
  std::vector<std::string> lost;
  format::WritePlan plan = format::plan_of(*reader, path);
  const auto again = format::reader_of(recording);
  const auto sink = format::create_recording(path, format, plan, &lost);
  replay(*again, *sink);
  return lost;
}

namespace {

/// Numbers that belong to `owner`: nothing is copied, and Python may not write.
template <typename T>
nb::object view(nb::handle owner, const T* data, std::size_t rows, std::size_t width = 1, std::int64_t stride = 0) {
  static const T none{};
  if (data == nullptr) data = &none;
  if (width == 1) {
    const std::int64_t step = stride != 0 ? stride : 1;
    return nb::cast(nb::ndarray<nb::numpy, const T>(data, {rows}, owner, {step}));
  }
  return nb::cast(nb::ndarray<nb::numpy, const T>(data, {rows, width}, owner));
}

/// (values, known): values are the recording's own up to the last row that is known; `known` is a copy, of all rows.
nb::object optional_column(nb::handle owner, const TrackColumns& track, TrackColumns::Optional which) {
  const OptionalColumn& column = track.column(which);
  const auto width = static_cast<std::size_t>(column.width());
  auto* known = new bool[std::max<std::size_t>(track.size(), 1)];
  const nb::capsule its(known, [](void* data) noexcept { delete[] static_cast<bool*>(data); });
  for (std::size_t row = 0; row < track.size(); ++row) known[row] = column.known(row);
  return nb::make_tuple(view(owner, column.values().data(), column.size(), width),
                        nb::cast(nb::ndarray<nb::numpy, bool>(known, {track.size()}, its)));
}

nb::object column_of(nb::handle self, std::size_t index, const std::string& name) {
  const auto& recording = nb::cast<const Recording&>(self);
  if (index >= recording.tracks().size()) throw nb::index_error("the recording has no such track");
  const TrackColumns& track = recording.tracks()[index];
  const std::size_t rows = track.size();
  if (name == "at") return view(self, track.at().data(), rows);
  if (name == "x") return view(self, track.x().data(), rows);
  if (name == "y") return view(self, track.y().data(), rows);
  if (name == "z") return view(self, track.z().data(), track.z().size());
  if (name == "provenance") return view(self, reinterpret_cast<const std::uint8_t*>(track.provenance().data()), rows);
  if (name == "cameras") return view(self, track.cameras().data(), rows);
  using enum TrackColumns::Optional;
  if (name == "velocity") return optional_column(self, track, velocity);
  if (name == "covariance") return optional_column(self, track, covariance);
  if (name == "score") return optional_column(self, track, score);
  if (name == "box") return optional_column(self, track, box);
  if (name == "residual_px") return optional_column(self, track, residual_px);
  if (name == "residual_m") return optional_column(self, track, residual_m);
  throw nb::key_error(name.c_str());
}

nb::object time_steps_of(nb::handle self) {
  static_assert(sizeof(Recording::TimeStep) == 2 * sizeof(std::int64_t) && sizeof(Timestamp) == sizeof(std::int64_t));
  const auto& time_steps = nb::cast<const Recording&>(self).instants();
  const auto* numbers = reinterpret_cast<const std::int64_t*>(time_steps.data());
  return nb::make_tuple(view(self, numbers, time_steps.size(), 1, 2),
                        view(self, numbers == nullptr ? nullptr : numbers + 1, time_steps.size(), 1, 2));
}

nb::list tracks_of(const Recording& recording) {
  nb::list tracks;
  for (const TrackColumns& track : recording.tracks())
    tracks.append(nb::make_tuple(number(track.id()), track.name.label, track.name.team, track.size(),
                                 std::string(to_string(track.name.kind))));
  return tracks;
}

nb::dict made_by(const Recording& recording) {
  const MadeBy& made = recording.header.made_by;
  nb::dict dict;
  dict["program"] = made.program;
  dict["options"] = nb::cast(made.options);
  nb::list inputs;
  for (const MadeBy::Input& input : made.inputs) inputs.append(nb::make_tuple(input.name, input.hash));
  dict["inputs"] = inputs;
  return dict;
}

const char* kind_of(const Recording& recording) {
  using Kind = FrameOfReference::Kind;
  switch (recording.header.frame.kind) {
    case Kind::image:
      return "image";
    case Kind::ground:
      return "ground";
    case Kind::user_ground:
      return "user_ground";
    case Kind::space:
      break;
  }
  return "space";
}

FrameOfReference frame_named(const std::string& name) {
  using Kind = FrameOfReference::Kind;
  if (name == "image") return {Kind::image, {}};
  if (name == "ground") return {Kind::ground, {}};
  if (name == "user_ground") return {Kind::user_ground, {}};
  if (name == "space") return {Kind::space, {}};
  throw Error("\"{}\" is not a frame of reference; supported: image, ground, user_ground, space", name);
}

std::vector<std::string> write(const Recording& recording, const std::string& path, const std::string& name) {
  const nb::gil_scoped_release free;
  return write_recording(recording, path, name);
}

std::pair<Recording, std::vector<std::string>> read(const std::string& path, const std::string& format, double rate_hz,
                                                    const std::string& metadata) {
  const nb::gil_scoped_release free;
  format::ReadOptions options;
  options.rate_hz = rate_hz;
  options.metadata = metadata;
  const format::Format* named = format.empty() ? nullptr : format::format_named(format, format::kRecordings);
  if (!format.empty() && named == nullptr)
    throw Error("\"{}\" is not a format that is read; supported: {}", format, format::names_of_read(format::kRecordings));
  auto match = format::read_whole(path, named != nullptr ? *named : format::format_to_read(path, format::kRecordings), options);
  return {std::move(match.recording), std::move(match.warnings)};
}

using Numbers = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;
using Times = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Names = std::vector<std::pair<std::string, std::string>>;

/// Positions, instants × tracks × axes, in which NaN stands for an instant at which a track is not known.
Recording from_arrays(const Numbers& position, const Times& times, const std::string& frame, double rate_hz, const Names& names) {
  RecordingHeader header;
  header.frame = frame_named(frame);
  header.rate_hz = rate_hz;
  header.made_by.program = "marey Python " MAREY_VERSION;
  Recording recording(header);
  const std::size_t instants = position.shape(0), tracks = position.shape(1), axes = position.shape(2);
  for (std::size_t track = 0; track < tracks; ++track)
    recording.set_name({TrackId{static_cast<int>(track) + 1}, names[track].first, names[track].second});
  for (std::size_t i = 0; i < instants; ++i) {
    Instant instant;
    instant.index = static_cast<std::int64_t>(i);
    instant.time = timestamp_from_seconds(times.data()[i]);
    for (std::size_t track = 0; track < tracks; ++track) {
      const double* location = position.data() + (i * tracks + track) * axes;
      if (std::isnan(location[0])) continue;
      Sample& sample = instant.samples.emplace_back();
      sample.track = TrackId{static_cast<int>(track) + 1};
      for (std::size_t axis = 0; axis < axes; ++axis) sample.position[static_cast<Eigen::Index>(axis)] = location[axis];
    }
    recording.add(instant);
  }
  return recording;
}

nb::object number_or_none(const std::optional<double>& value) {
  return value ? nb::cast(*value) : nb::none();
}

nb::dict scores_of(const evaluate::Evaluation& result) {
  nb::dict dict;
  dict["frames"] = result.frames;
  dict["objects"] = result.objects;
  dict["tracks"] = result.tracks;
  dict["truths"] = result.true_boxes;
  dict["reported"] = result.track_boxes;
  dict["mota"] = number_or_none(result.clear.mota);
  dict["motp"] = number_or_none(result.clear.motp);
  dict["recall"] = number_or_none(result.clear.recall);
  dict["precision"] = number_or_none(result.clear.precision);
  dict["false_positives"] = result.clear.false_positives;
  dict["misses"] = result.clear.misses;
  dict["switches"] = result.clear.switches;
  dict["fragmentations"] = result.clear.fragmentations;
  dict["idf1"] = number_or_none(result.identity.f1);
  dict["idp"] = number_or_none(result.identity.precision);
  dict["idr"] = number_or_none(result.identity.recall);
  dict["hota"] = result.hota.hota;
  dict["deta"] = result.hota.detection;
  dict["assa"] = result.hota.association;
  dict["loca"] = result.hota.localisation;
  return dict;
}

std::vector<LabelledBox> boxes_of(const Recording& recording) {
  std::vector<LabelledBox> boxes;
  InstantRows rows(recording);
  for (std::size_t instant = 0; instant < recording.instants().size(); ++instant) {
    for (const auto& [index, row] : rows.at(instant)) {
      const Sample sample = recording.tracks()[index].sample(row);
      if (!sample.box) continue;
      boxes.push_back({.frame = static_cast<std::int32_t>(recording.instants()[instant].index),
                       .id = number(sample.track),
                       .box = *sample.box,
                       .score = sample.score.value_or(1)});
    }
  }
  if (boxes.empty() && recording.samples() > 0) throw Error("{}: holds positions alone, without boxes", recording.header.name);
  return boxes;
}

nb::dict evaluate_boxes(const Recording& truth, const Recording& tracks, double iou) {
  evaluate::Evaluation result;
  {
    const nb::gil_scoped_release free;
    result = evaluate::evaluate(boxes_of(truth), boxes_of(tracks), iou);
  }
  return scores_of(result);
}

nb::dict evaluate_box_files(const std::string& truth, const std::string& tracks, double iou, bool motchallenge) {
  evaluate::Evaluation result;
  {
    const nb::gil_scoped_release free;
    auto expected = format::tracks::read_boxes(truth, format::tracks::MotKind::truth);
    if (motchallenge) std::erase_if(expected.boxes, [](const LabelledBox& box) { return box.score == 0; });
    result = evaluate::evaluate(expected.boxes, format::tracks::read_boxes(tracks, format::tracks::MotKind::tracks).boxes, iou);
  }
  return scores_of(result);
}

nb::dict evaluate_positions(const Recording& truth, const Recording& tracks, double distance) {
  pipeline::take::MatchEvaluation evaluated;
  {
    const nb::gil_scoped_release free;
    evaluated = pipeline::take::evaluate_match(truth, tracks, distance);
  }
  nb::dict dict = scores_of(evaluated.evaluation.scores);
  const auto& position = evaluated.evaluation.position;
  dict["position_rms_m"] = position ? nb::cast(position->rms) : nb::none();
  dict["distance_error"] = number_or_none(evaluated.distance_error);
  return dict;
}

nb::list cameras_of(const Rig& rig) {
  nb::list cameras;
  for (const RigCamera& camera : rig.cameras) {
    nb::dict dict;
    dict["name"] = camera.name;
    dict["source"] = camera.source;
    dict["size"] = camera.size ? nb::cast(std::pair{camera.size->width, camera.size->height}) : nb::none();
    dict["rate_hz"] = number_or_none(camera.rate_hz);
    dict["offset_s"] = number_or_none(camera.offset_s);
    dict["rms_px"] = number_or_none(camera.rms_px);
    dict["lens"] = nb::none();
    if (camera.lens) {
      const Vector<2>&f = geometry::focal_of(*camera.lens), &c = geometry::principal_of(*camera.lens);
      const Matrix<3> K{{f.x(), 0, c.x()}, {0, f.y(), c.y()}, {0, 0, 1}};
      std::vector<double> distortion;
      std::visit([&](const auto& lens) { distortion.assign(lens.distortion.begin(), lens.distortion.end()); }, *camera.lens);
      dict["lens"] = nb::make_tuple(std::string(geometry::name_of(*camera.lens)), K, distortion);
    }
    dict["rotation"] = camera.camera_from_world ? nb::cast(camera.camera_from_world->rotation) : nb::none();
    dict["translation"] = camera.camera_from_world ? nb::cast(camera.camera_from_world->translation) : nb::none();
    cameras.append(dict);
  }
  return cameras;
}

}  // namespace

void bind_recording(nb::module_& module) {
  nb::class_<Recording>(module, "Recording")
      .def_prop_ro("kind", &kind_of)
      .def_prop_ro("time_base",
                   [](const Recording& self) -> std::optional<std::string> {
                     if (!self.header.rig || self.header.time_base.kind == TimeBase::Kind::unspecified) return std::nullopt;
                     return to_string(self.header.time_base, *self.header.rig);
                   })
      .def_prop_ro("frame", [](const Recording& self) { return to_string(self.header.frame); })
      .def_prop_ro("dimensions", &Recording::dimensions)
      .def_prop_ro("name", [](const Recording& self) { return self.header.name; })
      .def_prop_ro("recorded_at", [](const Recording& self) { return self.header.recorded_at; })
      .def_prop_ro("rate_hz", [](const Recording& self) { return self.header.rate_hz; })
      .def_prop_ro("smoothed", [](const Recording& self) { return self.header.smoothed; })
      .def_prop_ro("made_by", &made_by)
      .def_prop_ro("samples", &Recording::samples)
      .def_prop_ro("tracks", &tracks_of)
      .def_prop_ro("rig", [](const Recording& self) -> std::optional<Rig> { return self.header.rig; })
      .def("moments", [](nb::handle_t<Recording> self) { return time_steps_of(self); })
      .def("column",
           [](nb::handle_t<Recording> self, std::size_t track, const std::string& name) { return column_of(self, track, name); })
      .def("write", &write, nb::arg("path"), nb::arg("format"));
  nb::class_<Rig>(module, "Rig").def_prop_ro("cameras", &cameras_of).def("write", [](const Rig& self, const std::string& path) {
    format::rig::write_rig(self, path);
  });
  module.def("read", &read, nb::arg("path"), nb::arg("format"), nb::arg("rate_hz"), nb::arg("metadata"));
  module.def("read_rig", &format::rig::read_rig, nb::arg("path"));
  module.def("from_arrays", &from_arrays);
  module.def("evaluate_boxes", &evaluate_boxes);
  module.def("evaluate_box_files", &evaluate_box_files);
  module.def("evaluate_places", &evaluate_positions);
  module.def("formats", [] {
    return nb::make_tuple(format::names_of_read(format::kRecordings), format::names_of_written(format::kRecordings));
  });
}

}  // namespace marey::python
