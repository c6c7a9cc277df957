#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/core/rig_sources.h"
#include "marey/files/source_name.h"
#include "marey/pipeline/jobs/detection_rows.h"
#include "marey/pipeline/live/camera_node.h"
#include "marey/pipeline/live/live_feeds.h"

#include "camera_health.h"
#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "live_sources.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

enum class NodeSends { markers, images };
constexpr std::array<std::pair<const char*, NodeSends>, 2> kNodeSends{
    {{"markers", NodeSends::markers}, {"images", NodeSends::images}}};

struct NodeCommand {
  std::vector<std::string> sources;
  NodeSends send = NodeSends::markers;
  int quality = 90;
  pipeline::live::NodeOptions options;
  bool json = false, quiet = false;
};

bool is_open_to_others(const std::string& address) {
  return !address.starts_with("127.") && address != "localhost" && address != "[::1]";
}

/// What the other computer is to be reported.
void print_begun(const NodeCommand& command, const Rig& rig) {
  const bool everywhere = command.options.address == "0.0.0.0" || command.options.address == "[::]";
  const std::string host = everywhere ? "THIS-COMPUTER" : command.options.address;
  fmt::print(stderr, "{}: marey live node:{}:{}\n", camera_names(rig), host, command.options.port);
  if (is_open_to_others(command.options.address))
    warn({fmt::format("the one who reaches port {} of this computer sees what its cameras see", command.options.port)});
}

Json as_json(const pipeline::live::NodeSummary& summary, const NodeCommand& command) {
  Json json{{"address", fmt::format("{}:{}", command.options.address, command.options.port)},
            {"seconds", summary.seconds},
            {"bytes", summary.bytes},
            {"cameras", Json::object()}};
  for (const pipeline::live::NodeSummary::Camera& camera : summary.cameras)
    json["cameras"][camera.health.name] = health_json_of(camera.health, "sent", camera.sent);
  return json;
}

void print_node(const pipeline::live::NodeSummary& summary) {
  for (const pipeline::live::NodeSummary::Camera& camera : summary.cameras) {
    fmt::print(stderr, "  {}{}\n", health_line_of(camera.health, camera.sent, "frames sent"),
               camera.health.trouble.empty() ? "" : "; " + camera.health.trouble);
  }
  fmt::print(stderr, "{:.1f} s, {:.1f} MB\n", summary.seconds, 1e-6 * static_cast<double>(summary.bytes));
}

void run(NodeCommand& command) {
  const Rig rig = rig_of_live_sources(command.sources);
  command.options.allow_control = command.options.allow_control || !is_open_to_others(command.options.address);
  if (command.send == NodeSends::images) command.options.quality = command.quality;
  if (!command.quiet) command.options.begun = [&](const Rig& reported) { print_begun(command, reported); };
  const pipeline::live::NodeSummary summary = with_progress(command.quiet || command.json, [&](const Hooks& hooks) {
    return pipeline::live::serve_cameras(rig, command.options, hooks);
  });
  if (command.json) {
    print(as_json(summary, command));
  } else if (!command.quiet) {
    print_node(summary);
  }
}

}  // namespace

void add_node(Command& program) {
  auto options = std::make_shared<NodeCommand>();
  pipeline::live::NodeOptions& how = options->options;
  Command command = program.subcommand("node", "Hand this computer's cameras to another one, where marey live runs");
  add_live_sources(command, options->sources);
  command.choice("--send", options->send, kNodeSends, "what goes over the network: the markers that are found here, or the images");
  command.whole("--jpeg-quality", options->quality, "N", 1, 100, "of the images, which are JPEG");
  command.text("--listen", how.address, "address of this machine at which its cameras are had; 0.0.0.0: all of them");
  command.whole("--port", how.port, "N", 1, 65535, "TCP port that it listens on");
  command.flag("--allow-control", how.allow_control,
               "hosts on other computers (--listen) may set exposure, gain and threshold, not this one's alone");
  command.number("--duration", how.for_s, "s", closed(0.1, 1e7), "end after this long (default: on Ctrl-C)");
  command.number("--connect-timeout", how.patience_s, "s", closed(0, 60), "that cameras are waited for at the beginning");
  pipeline::jobs::Table rows;
  add_blob_rows(rows, how.markers);
  command.rows(std::move(rows));
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
