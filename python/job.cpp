#include "job.h"

#include "marey/core/error.h"
#include "marey/core/overwriting.h"
#include "marey/core/recording_sink.h"
#include "marey/core/rig_sources.h"
#include "marey/core/source_name.h"
#include "marey/format/observations.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"

namespace marey::python {
namespace {

nb::dict dict_of(const pipeline::corridor::Summary& summary) {
  nb::dict dict;
  dict["frames"] = summary.frames;
  dict["seconds"] = summary.seconds;
  dict["rate_hz"] = summary.rate_hz;
  dict["tracks"] = summary.tracks;
  dict["samples"] = summary.samples;
  dict["measured"] = summary.measured;
  dict["filled"] = summary.filled;
  dict["predicted"] = summary.predicted;
  dict["detections"] = summary.detections;
  nb::dict left_out, figures;
  for (const auto& [name, count] : summary.left_out) left_out[name.c_str()] = count;
  for (const auto& [name, value] : summary.figures) figures[name.c_str()] = value;
  dict["left_out"] = left_out;
  dict["figures"] = figures;
  dict["notes"] = summary.notes;
  dict["warnings"] = summary.warnings;
  dict["stopped"] = summary.stopped;
  return dict;
}

}  // namespace

Listening listening_of(const Options& options) {
  return {options.object("progress"), options.object("ends"), options.get<std::map<std::string, std::string>>("given", {})};
}

nb::tuple tuple_of(Result result) {
  return nb::make_tuple(std::move(result.recording), dict_of(result.summary));
}

Outputs::Outputs(const Options& options, format::Content content, std::span<const RigCamera> cameras)
    : content_(content),
      files_(options.get<std::vector<std::pair<std::string, std::string>>>("files", {})),
      keep_(options.get("keep", true)) {
  for (const auto& [object, pictures] : options.get<std::vector<std::pair<nb::object, bool>>>("sinks", {}))
    objects_.push_back({std::make_shared<Held>(object), pictures});
  keep_inputs(options, cameras);
}

void Outputs::keep_inputs(const Options& options, std::span<const RigCamera> cameras) const {
  std::vector<std::string> inputs{options.path("rig"), options.path("observations"), options.path("labels")};
  for (const RigCamera& camera : cameras) inputs.insert(inputs.end(), {path_of_source(camera.source), camera.detections});
  std::vector<std::string> outputs{options.path("take")};
  for (const auto& [path, name] : files_) outputs.push_back(path);
  for (const std::string& output : outputs) {
    for (const std::string& input : inputs) {
      if (overwrites(output, input))
        throw Error("{}: is an input too ({}) and would be destroyed; name another file", output, input);
    }
  }
}

std::vector<std::unique_ptr<Sink>> Outputs::open(Recording& recording) const {
  std::vector<std::unique_ptr<Sink>> sinks;
  if (keep_) sinks.push_back(std::make_unique<RecordingSink>(recording));
  for (const auto& [path, name] : files_)
    sinks.push_back(format::create_recording(path, format::format_to_write(path, name, content_)));
  for (const auto& [held, pictures] : objects_) sinks.push_back(sink_of(held, pictures));
  return sinks;
}

void Outputs::add_to(pipeline::corridor::Sinks& sinks, Recording& recording) const {
  for (std::unique_ptr<Sink>& sink : open(recording)) sinks.add(std::move(sink));
}

Rig rig_of(const Options& options) {
  const auto path = options.get<std::string>("rig", {});
  const auto observations = options.get<std::string>("observations", {});
  Rig rig;
  if (options.has("rig_object")) {
    rig = options.get<Rig>("rig_object", {});
  } else if (!path.empty()) {
    rig = format::rig::read_rig(path);
  } else if (!observations.empty()) {
    rig = format::rig_of_observations(observations);
  } else {
    throw Error("{}", "give a rig, or observations");
  }
  set_sources(rig, options.get<std::vector<std::string>>("sources", {}));
  return rig;
}

}  // namespace marey::python
