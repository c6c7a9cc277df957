#include "info.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/source/open_source.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"

namespace marey::cli {
namespace {

struct InfoOptions {
  std::string file;
  std::string metadata;
  bool json = false;
  bool quiet = false;
};

/// What the edits that count have left of a take; what cameras saw they do not touch.
RecordingSummary edited_summary(const InfoOptions& options, const format::Format& format, const RecordingSummary& recorded) {
  RecordingSummary summary = format::open_recording(options.file, format, {})->summary();
  summary.detected = recorded.detected;
  summary.complete = recorded.complete;
  return summary;
}

void report_recording(const InfoOptions& options, const format::Format& format) {
  format::ReadOptions how;
  how.as_recorded = true;
  how.metadata = options.metadata;
  const auto reader = format::open_recording(options.file, format, how);
  RecordingSummary summary = reader->summary();
  std::vector<std::string> warnings = reader->warnings();
  std::vector<pipeline::take::EditLine> edits;
  if (!reader->info().edits.empty()) {
    try {
      edits = pipeline::take::lines_of(pipeline::take::edit_history(options.file));
      if (reader->info().head) summary = edited_summary(options, format, summary);
    } catch (const Error& error) {
      warnings.push_back(fmt::format("{}; what follows is as it was recorded", error.what()));
    }
  }
  print_warnings(warnings);
  if (options.json) {
    print(info_json(format, reader->info(), summary, edits));
  } else if (!options.quiet) {
    print_recording(options.file, format, reader->info(), summary, edits);
  }
}

void report_match(const InfoOptions& options, const format::Format& format) {
  const format::match::GroundMatch match = format::read_whole(options.file, format, {.metadata = options.metadata, .pitch = {}});
  print_warnings(match.warnings);
  if (options.json) {
    print(info_json(format, match));
  } else if (!options.quiet) {
    print_match(options.file, format, match);
  }
}

void report_rig(const InfoOptions& options, const format::Format& format) {
  const Rig rig = format.read_rig(options.file);
  if (options.json) return print({{"format", "rig"}, {"cameras", info_json(rig)}});
  if (options.quiet) return;
  fmt::print("{}: a rig of {} camera{}\n", options.file, rig.cameras.size(), rig.cameras.size() == 1 ? "" : "s");
  print_rig(rig);
}

void report_facts(const InfoOptions& options, std::string_view format, std::string_view title,
                  const std::vector<format::Fact>& facts) {
  Json json{{"format", format}};
  if (!options.json && !options.quiet) fmt::print("{}: {}\n", options.file, title);
  for (const format::Fact& fact : facts) {
    std::visit([&](const auto& value) { json[fact.name] = Json(value); }, fact.value);
    std::string words = fact.words;
    const auto* list = std::get_if<std::vector<std::string>>(&fact.value);
    if (words.empty() && list != nullptr) words = fmt::format("{}: {}", list->size(), fmt::join(*list, ", "));
    if (words.empty())
      std::visit(
          [&](const auto& value) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, std::vector<std::string>>)
              words = fmt::format("{}", value);
          },
          fact.value);
    std::string name = fact.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    if (!options.json && !options.quiet) print_row(name.c_str(), words);
  }
  if (options.json) print(json);
}

/// A video or images; nothing if it is neither.
std::unique_ptr<Source> video_at(const std::string& path) {
  try {
    return source::open_source(path);
  } catch (const Error&) {
    return nullptr;
  }
}

void report_video(const InfoOptions& options, const Source& video) {
  const SourceInfo& info = video.info();
  std::vector<format::Fact> facts{{"size", fmt::format("{}x{}", info.size.width, info.size.height),
                                   fmt::format("{} x {} px", info.size.width, info.size.height)}};
  if (info.rate_hz) facts.push_back({"rate_hz", *info.rate_hz, fmt::format("{:g} frames a second", *info.rate_hz)});
  if (info.frame_count) {
    facts.push_back({"frames", *info.frame_count, fmt::format("about {}", counted(*info.frame_count))});
    const double length_s = info.rate_hz ? static_cast<double>(*info.frame_count) / *info.rate_hz : 0;
    if (info.rate_hz) facts.push_back({"duration_s", length_s, duration_words(length_s)});
  }
  print_warnings(video.warnings());
  report_facts(options, "film", "a video, or images", facts);
}

void run(const InfoOptions& options) {
  const format::Format* format = format::format_of_content(options.file);
  if (format == nullptr) {
    if (const auto video = video_at(options.file)) return report_video(options, *video);
    throw Error("{}: is not one of the files that Marey knows: videos, images; {}", options.file, files_that_are_known());
  }
  if (format->read != nullptr) return report_match(options, *format);
  if (format->open != nullptr) return report_recording(options, *format);
  if (format->read_rig != nullptr) return report_rig(options, *format);
  report_facts(options, format->name, format->title, format->facts(options.file));
}

}  // namespace

void add_info(Command& program) {
  auto options = std::make_shared<InfoOptions>();
  Command command = program.subcommand("info", "Say what is in a file");
  command.input_file("FILE", options->file, "a video, images, or a file of: " + files_that_are_known()).required();
  command.input_file("--metadata", options->metadata,
                     "of TRACAB, EPTS or DFL, and an AMC file's .asf, where it is not beside FILE under a like name");
  command.reports(options->json, options->quiet, "contents");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
