#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "marey/core/stop.h"
#include "marey/format/register.h"
#include "marey/pipeline/take/ground_orientation.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "pitch_size.h"
#include "run_hooks.h"
#include "view_options.h"
#include "viewer/recording_viewer.h"

namespace marey::cli {
namespace {

struct ViewCommand {
  std::string file;
  std::string size, rig;
  bool y_down = false;
  viewer::ViewOptions options;
  bool json = false;
  bool quiet = false;
};

void run(ViewCommand& command) {
  if (!command.size.empty()) {
    command.options.ground.pitch = parse_pitch_size(command.size);
    command.options.read.pitch = *command.options.ground.pitch;
  }
  if (command.y_down) command.options.ground.y_down = true;
  if (!command.rig.empty()) command.options.ground.y_down = pipeline::take::rig_has_y_down(command.rig);
  viewer::RecordingViewer shown(command.file, command.options);
  // The address alone stands on standard output, so that a script can read it.
  if (command.json) {
    print({{"file", command.file}, {"address", shown.address()}});
  } else {
    fmt::print("{}\n", shown.address());
  }
  std::fflush(stdout);
  if (!command.quiet) fmt::print(stderr, "{}: open the address in a browser; Ctrl-C ends it\n", command.file);
  try {
    warn(with_progress(command.quiet, [&](const Hooks& hooks) { return shown.read(hooks); }));
  } catch (const Stopped&) {
    return;  // the ordinary end of what has no end
  }
  wait_for_stop();
}

}  // namespace

void add_view(Command& program) {
  auto options = std::make_shared<ViewCommand>();
  viewer::ViewOptions& how = options->options;
  Command command =
      program.subcommand("view", "Show a recording in the browser: markers in space, people on a pitch, tracks in an image");
  command.input_file("FILE", options->file, "a recording, known by its content: " + format::names_of_read(format::kRecordings))
      .required();
  command.input_file("--video", how.video, "the video that was tracked, to be shown behind tracks in an image");
  command.flag("--edit", how.edit, "let the page change FILE, a take: what \"marey edit\" can do, each edit to be undone");
  add_listen_address(command, how.location);
  using Axis = std::optional<format::UpAxis>;
  constexpr std::array<std::pair<const char*, Axis>, 2> kAxes{{{"y", format::UpAxis::y}, {"z", format::UpAxis::z}}};
  command.choice("--up", how.read.up, kAxes,
                 "the axis that is up in FILE, of points in space; as FILE says where it is omitted, else z");
  command.group("People on the ground");
  command.input_file("--metadata", how.read.metadata,
                     "of TRACAB, EPTS or DFL, and an AMC file's .asf, where it is not beside FILE under a like name");
  command.text("--size", options->size, "of the pitch, LENGTHxWIDTH in m; without it a pitch is drawn where people move on one")
      .check(parse_pitch_size);
  command.number("--rate", how.read.rate_hz, "Hz", kRates, "frames a second, where FILE does not specify");
  const Option y_down = command.flag("--y-down", options->y_down,
                                     "y grows downwards, seen from above with x to the right, where FILE does not specify");
  command.input_file("--rig", options->rig, "rig whose ground_from_world says whether --y-down is so").excludes(y_down);
  command.flag("--centred", how.ground.centred, "places count from the middle of the pitch, not from a corner");
  command.group("");
  command.reports(options->json, options->quiet, "address");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
