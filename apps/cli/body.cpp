#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/format/register.h"
#include "marey/format/take/take_file.h"
#include "marey/pipeline/bodies/bodies_in_space.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "label_list.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct DefineCommand {
  std::string take, out, markers, axes;
  solve::bodies::DefineOptions options;
  std::string pivot;
  bool add = false, json = false, quiet = false;
};

struct BodyTrackCommand {
  std::string recording, bodies, out;
  pipeline::bodies::TrackBodiesOptions options;
  std::optional<double> noise_mm;
  double tolerance_mm = 4;
  bool json = false, quiet = false;
};

void print_defined(const DefineCommand& command, const solve::bodies::DefinedBody& defined) {
  fmt::print(stderr, "body \"{}\" of {} markers, from {} frames\n", defined.body.label, defined.body.markers.size(),
             defined.instants);
  for (const auto& marker : defined.markers)
    fmt::print(stderr, "  {:<16} varies by {:.2f} mm{}\n", marker.label, 1000 * marker.deviation,
               marker.loose ? ": loose, omitted" : "");
  if (defined.symmetries.empty()) fmt::print(stderr, "no turn makes it appear the same\n");
  warn(pipeline::bodies::review_items_of(defined));
  fmt::print(stderr, "bodies: {}\n", command.out);
}

Json defined_json(const DefineCommand& command, const solve::bodies::DefinedBody& defined) {
  Json json{{"name", defined.body.label},
            {"frames", defined.instants},
            {"bodies", command.out},
            {"shortest_edge_m", defined.shortest_edge}};
  json["markers"] = Json::array();
  for (const auto& marker : defined.markers)
    json["markers"].push_back({{"label", marker.label}, {"deviation_m", marker.deviation}, {"loose", marker.loose}});
  json["symmetries"] = Json::array();
  for (const auto& symmetry : defined.symmetries)
    json["symmetries"].push_back({{"turn", words_of(symmetry)}, {"worst_m", symmetry.worst}});
  json["warnings"] = Json(pipeline::bodies::review_items_of(defined));
  return json;
}

void run(DefineCommand& command) {
  command.options.markers = labels_in(command.markers);
  if (!command.pivot.empty()) command.options.pivot = command.pivot;
  if (!command.axes.empty()) {
    const auto axes = labels_in(command.axes);
    command.options.axes = {axes[0], axes[1], axes[2]};
  }
  const auto defined = pipeline::bodies::define_body(command.take, command.out, command.add, command.options);
  if (command.json) {
    print(defined_json(command, defined));
  } else if (!command.quiet) {
    print_defined(command, defined);
  }
}

/// What takes the other pose from a frame on; a take alone keeps both.
std::string command_to_turn(const std::string& out, const std::string& body, std::int64_t frame) {
  if (!format::take::is_take(out)) return "write a take (-o NAME.marey), which keeps both poses";
  const bool quoted = body.find_first_of(" ,\t") != std::string::npos;
  return quoted ? fmt::format("marey edit {} 'turn \"{}\" {}:'", out, body, frame)
                : fmt::format("marey edit {} \"turn {} {}:\"", out, body, frame);
}

/// The questions that the markers cannot answer, and the command that answers each.
void print_in_question(const BodyTrackCommand& command, const pipeline::bodies::TrackBodiesSummary& summary) {
  constexpr std::size_t kMaxPrinted = 10;
  for (std::size_t i = 0; i < std::min(summary.in_question.size(), kMaxPrinted); ++i) {
    const auto& one = summary.in_question[i];
    fmt::print(stderr, "  in question: from frame {} on ({:.2f} s) {} may be {} ({:.0f} %); if so: {}\n", one.frame,
               seconds(one.time), one.body, one.turn, 100 * one.probability, command_to_turn(command.out, one.body, one.frame));
  }
  if (summary.in_question.size() > kMaxPrinted)
    fmt::print(stderr, "  and {} more; --json lists all\n", summary.in_question.size() - kMaxPrinted);
}

void print_tracked(const BodyTrackCommand& command, const pipeline::bodies::TrackBodiesSummary& summary) {
  for (const auto& one : summary.bodies) {
    if (one.counts.measured + one.counts.predicted == 0) {
      fmt::print(stderr, "{}: not found in any of {} frames\n", one.body.label, summary.instants);
      continue;
    }
    fmt::print(stderr, "{}: measured in {} of {} frames, predicted in {}, lost {} times; markers {:.2f} mm from their places\n",
               one.body.label, one.counts.measured, summary.instants, one.counts.predicted, one.counts.lost, 1000 * one.error_m);
    if (one.counts.corrected > 0)
      fmt::print(stderr, "  found to be turned, {} times, and corrected; it appears the same {}\n", one.counts.corrected,
                 words_of(one.symmetries.front()));
  }
  print_in_question(command, summary);
  fmt::print(stderr, "noise of a point {:.2f} mm\n{}\n", 1000 * summary.noise_m, command.out);
}

Json tracked_json(const BodyTrackCommand& command, const pipeline::bodies::TrackBodiesSummary& summary) {
  Json json{{"frames", summary.instants}, {"noise_m", summary.noise_m}, {"recording", command.out}, {"warnings", summary.warnings}};
  json["bodies"] = Json::array();
  for (const auto& one : summary.bodies)
    json["bodies"].push_back({{"name", one.body.label},
                              {"measured", one.counts.measured},
                              {"predicted", one.counts.predicted},
                              {"absent", one.counts.absent},
                              {"lost", one.counts.lost},
                              {"turned", one.counts.corrected},
                              {"error_m", one.error_m}});
  json["in_question"] = Json::array();
  for (const auto& one : summary.in_question)
    json["in_question"].push_back({{"body", one.body},
                                   {"frame", one.frame},
                                   {"time_s", seconds(one.time)},
                                   {"probability", one.probability},
                                   {"turn", one.turn}});
  return json;
}

void run(BodyTrackCommand& command) {
  command.options.tracking.tolerance = command.tolerance_mm / 1000;
  if (command.noise_mm) command.options.tracking.noise = *command.noise_mm / 1000;
  const auto summary = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::bodies::track_bodies(command.recording, command.bodies, command.out, command.options, hooks);
  });
  warn(summary.warnings);
  if (summary.stopped) {
    fmt::print(stderr, "marey: stopped; {} was not finished\n", command.out);
    throw EndWith{kInterrupted};
  }
  if (command.json) {
    print(tracked_json(command, summary));
  } else if (!command.quiet) {
    print_tracked(command, summary);
  }
}

void add_define(Command& body) {
  auto options = std::make_shared<DefineCommand>();
  Command command = body.subcommand("define", "Make a rigid body out of markers of a recording in which it moves");
  command.input_file("TAKE", options->take, "a recording of points in space: " + format::names_of_read(format::Content::space))
      .required();
  command.text("--markers", options->markers, "the labels of its markers, commas between; three or more")
      .required()
      .check([](const std::string& text) {
        if (labels_in(text).size() < 3) throw Error("a body takes three markers or more, commas between");
      });
  command.text("--name", options->options.name, "what the body is called");
  command.output_file("-o,--output", options->out, "the bodies, as bodies.toml").required();
  command.flag("--add", options->add, "keep the bodies that the output holds already; one of that name is replaced");
  command.text("--pivot", options->pivot, "the marker that is its origin (default: the middle of all)");
  command
      .text("--axes", options->axes,
            "three markers A,B,C: x goes from A to B, C is on the side of y (default: the world's, at first)")
      .check([](const std::string& text) {
        if (labels_in(text).size() != 3) throw Error("axes take three markers, commas between");
      });
  command.number("--outlier-factor", options->options.loose, "factor", closed(1, 100),
                 "a marker that varies this many times as much as the others is omitted");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

void add_body_track(Command& body) {
  auto options = std::make_shared<BodyTrackCommand>();
  Command command = body.subcommand("track", "Follow rigid bodies through a recording, with six degrees of freedom each");
  command
      .input_file("RECORDING", options->recording,
                  "points in space, with names or without: " + format::names_of_read(format::Content::space))
      .required();
  command.input_file("BODIES", options->bodies, "bodies.toml, or a table label,x,y,z (m) of one body").required();
  command.output_file("-o,--output", options->out, "the recording with the bodies: a take").required();
  command.text("--format", options->options.format, "in place of the output's ending").check(format::check_written_name);
  auto& tracking = options->options.tracking;
  command.number("--tolerance", options->tolerance_mm, "mm", closed(0.01, 100), "farther from its place no marker is the body's");
  command.number("--noise", options->noise_mm, "mm", closed(1e-4, 100),
                 "standard deviation of a point's coordinates (default: learned)");
  command.number("--max-prediction", tracking.predict_s, "s", closed(0, 10),
                 "this long a body is reported of which fewer than three markers are seen");
  command.number("--acceleration", tracking.acceleration, "m/s²", closed(0.1, 1e4), "standard deviation of a body's acceleration");
  command.number("--angular-acceleration", tracking.angular_acceleration, "rad/s²", closed(0.1, 1e5), "and of its turning's");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace

void add_body(Command& program) {
  Command body = program.subcommand("body", "Rigid bodies: define them by their markers, follow them");
  add_define(body);
  add_body_track(body);
}

}  // namespace marey::cli
