#include "marey/pipeline/take/play.h"

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/pipeline/jobs/space_names.h"
#include "marey/pipeline/markers/set_in_space.h"
#include "marey/pipeline/markers/skeleton_in_space.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "pitch_size.h"
#include "run_hooks.h"
#include "stream_options.h"

namespace marey::cli {
namespace {

struct PlayCommand {
  std::string recording;
  pipeline::jobs::SpaceNames names;
  std::string size = "105x68";
  format::ReadOptions read;
  pipeline::take::PlayOptions how;
  StreamArguments streams;
  bool json = false;
  bool quiet = false;
};

void report(const PlayCommand& command, const pipeline::take::PlaySummary& done, const stream::Streams& streams) {
  warn(done.warnings);
  if (command.json) {
    print({{"recording", command.recording},
           {"instants", done.instants},
           {"excluded", done.excluded},
           {"skipped", done.skipped},
           {"loops", done.rounds},
           {"seconds", done.seconds},
           {"interrupted", done.stopped},
           {"streams", json_of(streams)}});
  } else if (!command.quiet) {
    fmt::print(stderr, "{}: {} instants in {:.1f} s", command.recording, done.instants, done.seconds);
    if (command.how.loop) fmt::print(stderr, ", {} loop{}", done.rounds, done.rounds == 1 ? "" : "s");
    if (done.excluded > 0) fmt::print(stderr, ", {} omitted by --rate", done.excluded);
    if (done.skipped > 0) fmt::print(stderr, ", {} skipped because this machine was late", done.skipped);
    fmt::print(stderr, "\n");
    report_streams(streams);
  }
  // If it loops, it has to be ended.
  if (done.stopped && !command.how.loop) throw EndWith{kInterrupted};
}

void run(PlayCommand& command) {
  command.read.pitch = parse_pitch_size(command.size);
  if (command.streams.streams.empty()) command.streams.streams = {"json"};
  std::vector<std::string> warnings;
  const auto skeleton = pipeline::jobs::skeleton_of(command.names.skeleton, warnings);
  warn(warnings);
  const auto set = pipeline::jobs::learned_set_of(command.names.set, skeleton.get());
  pipeline::markers::SetInSpaceOptions naming;
  naming.names_hold = false;
  const auto open = [&]() -> std::unique_ptr<RecordingReader> {
    std::unique_ptr<RecordingReader> reader = format::open_recording(command.recording, command.read);
    if (set != nullptr) reader = pipeline::markers::with_set(std::move(reader), set, naming);
    return skeleton == nullptr ? std::move(reader) : pipeline::markers::with_skeleton(std::move(reader), skeleton);
  };
  command.how.name = std::filesystem::path(command.recording).filename();
  open();  // what cannot be read is reported before a port is taken
  const stream::Streams streams = open_streams(command.streams, command.quiet);
  const auto sinks = streams.sinks();
  const pipeline::take::PlaySummary done = with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::take::play(open, sinks, command.how, &streams.clock(), hooks); });
  report(command, done, streams);
}

}  // namespace

void add_play(Command& program) {
  auto options = std::make_shared<PlayCommand>();
  pipeline::take::PlayOptions& how = options->how;
  Command command = program.subcommand("play", "Play a recording in real time, as if it were captured now, to the one who listens");
  command.input_file("RECORDING", options->recording, "known by its content: " + format::names_of_read(format::kRecordings))
      .required();
  command.flag("--loop", how.loop, "from the beginning again, until Ctrl-C");
  command.number("--speed", how.speed, "factor", closed(0.01, 100), "as fast as it was recorded");
  command.number("--rate", how.rate_hz, "Hz", kRates, "at most this many instants a second of the recording");
  pipeline::jobs::Table names;
  add_set_rows(names, options->names);
  command.rows(std::move(names));
  add_stream_options(command, options->streams);
  command.group("The recording");
  using Axis = std::optional<format::UpAxis>;
  constexpr std::array<std::pair<const char*, Axis>, 2> kAxes{{{"y", format::UpAxis::y}, {"z", format::UpAxis::z}}};
  command.choice(
      "--from-up,--up", options->read.up, kAxes,
      "the axis that is up in a file of points, as it says where this is omitted, else z; streams have z up, or what they want");
  command.number("--recorded-rate", options->read.rate_hz, "Hz", kRates, "frames a second, where the file does not specify");
  command.input_file("--metadata", options->read.metadata,
                     "of TRACAB, EPTS or DFL, and an AMC file's .asf, where it is not beside it under a like name");
  command.text("--size", options->size, "of the pitch, LENGTHxWIDTH in m, where a match does not specify").check(parse_pitch_size);
  command.group("");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
