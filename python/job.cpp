#include "job.h"

#include <array>

#include "marey/core/error.h"
#include "marey/core/recording_reader.h"
#include "marey/core/recording_sink.h"
#include "marey/core/rig_sources.h"
#include "marey/files/overwriting.h"
#include "marey/files/source_name.h"
#include "marey/format/observations.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/jobs/register.h"

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
  nb::dict excluded, figures;
  for (const pipeline::corridor::Exclusion& one : exclusions(summary)) excluded[std::string(one.key).c_str()] = one.count;
  for (const auto& [name, value] : pipeline::corridor::figures(summary)) figures[std::string(name).c_str()] = value;
  dict["excluded"] = excluded;
  dict["figures"] = figures;
  dict["notes"] = summary.notes;
  dict["warnings"] = summary.warnings;
  dict["interrupted"] = summary.stopped;
  return dict;
}

}  // namespace

Listening listening_of(const Options& options) {
  return {options.object("progress"), options.object("ends"), options.get<std::map<std::string, std::string>>("given", {})};
}

nb::tuple tuple_of(Result result) {
  return nb::make_tuple(std::move(result.recording), dict_of(result.summary));
}

Rows::Rows(pipeline::jobs::Table table, const Options& options) : table_(std::move(table)) {
  for (const auto& [name, text] : options.get<std::vector<std::pair<std::string, std::string>>>("rows", {})) {
    pipeline::jobs::Option* row = table_.find(name);
    if (row == nullptr) throw Error("there is no option {}", name);
    try {
      row->set(text);
    } catch (const Error& error) {
      throw Error("{}: {}", in_python("--" + name), in_python(error.what()));
    }
  }
  resolved([&] { table_.check_needs(); });
}

Listening Rows::listening(const Options& options) const {
  Listening listening = listening_of(options);
  listening.options = table_.given();
  if (options.has("own_filter_name")) listening.options["filter"] = options.get<std::string>("own_filter_name", {});
  return listening;
}

std::string Rows::in_python(const std::string& message_text) {
  const auto is_of_name = [](char c) { return (c >= 'a' && c <= 'z') || c == '-'; };
  std::string text;
  for (std::size_t at = 0; at < message_text.size();) {
    const bool starts = message_text.compare(at, 2, "--") == 0 && at + 2 < message_text.size() && is_of_name(message_text[at + 2]);
    if (starts) at += 2;
    do {
      text += starts && message_text[at] == '-' ? '_' : message_text[at];
      ++at;
    } while (starts && at < message_text.size() && is_of_name(message_text[at]));
  }
  return text;
}

nb::list rows_of_job(const std::string& job) {
  nb::list rows;
  pipeline::jobs::with_table(job, [&](pipeline::jobs::Table& table) {
    constexpr std::array kKinds{"flag",    "number",     "whole",       "text",          "choice", "size",
                                "corners", "input_file", "output_file", "output_folder", "texts"};
    for (const pipeline::jobs::Option& option : table.options()) {
      nb::dict row;
      row["name"] = option.name;
      row["kind"] = kKinds.at(static_cast<std::size_t>(option.kind));
      row["help"] = option.help;
      row["value"] = option.value;
      row["default"] = option.fallback;
      row["group"] = option.group;
      row["choices"] = option.choices;
      row["needs"] = option.needs;
      row["depends"] = option.depends;
      rows.append(row);
    }
  });
  return rows;
}

Outputs::Outputs(const Options& options, format::Content content, std::span<const RigCamera> cameras, const Rows* rows,
                 const std::vector<std::string>& also, const std::vector<std::string>& read)
    : content_(content),
      files_(options.get<std::vector<std::pair<std::string, std::string>>>("files", {})),
      keep_(options.get("keep", true)) {
  for (const auto& [object, images] : options.get<std::vector<std::pair<nb::object, bool>>>("sinks", {}))
    objects_.push_back({std::make_shared<Held>(object), images});
  std::vector<std::string> inputs{options.path("rig"), options.path("observations"), options.path("labels")};
  for (const RigCamera& camera : cameras) inputs.insert(inputs.end(), {path_of_source(camera.source), camera.detections});
  inputs.insert(inputs.end(), read.begin(), read.end());
  std::vector<std::string> outputs = also;
  outputs.push_back(options.path("take"));
  for (const auto& [path, name] : files_) outputs.push_back(path);
  if (rows != nullptr) {
    for (const std::string& path : rows->files(false)) inputs.push_back(path);
    for (const std::string& path : rows->files(true)) outputs.push_back(path);
  }
  keep_inputs(inputs, outputs);
}

void Outputs::keep_inputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
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
  for (const auto& [held, images] : objects_) sinks.push_back(sink_of(held, images));
  return sinks;
}

void Outputs::write(const Recording& recording) const {
  for (const auto& [path, name] : files_) write_recording(recording, path, name);
  for (const Object& object : objects_) {
    MemoryReader reader(recording);
    replay(reader, *sink_of(object.held, object.images));
  }
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
