#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "marey/analyse/gait/body_marker_sets.h"
#include "marey/format/motion/marker_set.h"
#include "marey/format/register.h"
#include "marey/pipeline/markers/labels_in_space.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "label_list.h"
#include "run_hooks.h"
#include "summary_figures.h"

namespace marey::cli {
namespace {

struct LearnLabelsCommand {
  std::vector<std::string> recordings;
  std::string out, markers;
  std::vector<std::string> exclude;
  solve::labels::LearnOptions options;
  bool json = false, quiet = false;
};

struct LabelCommand {
  std::string recording, set, out;
  std::vector<std::string> exclude, accept;
  solve::labels::LabelOptions options;
  bool json = false, quiet = false;
};

/// "A,B" is A and B.
std::vector<std::string> patterns_in(const std::vector<std::string>& given) {
  std::vector<std::string> patterns;
  for (const std::string& list : given) {
    for (std::string& pattern : labels_in(list)) patterns.push_back(std::move(pattern));
  }
  return patterns;
}

std::string marker_set_names() {
  std::string names;
  for (const analyse::gait::BodyMarkerSet& set : analyse::gait::body_marker_sets())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", set.name());
  return names + "; with -lower behind it its pelvis and legs";
}

void run(LearnLabelsCommand& command) {
  if (!command.markers.empty()) {
    std::error_code too_long_for_a_file;
    const bool file = std::filesystem::is_regular_file(command.markers, too_long_for_a_file);
    command.options.as_far_as_there = !file && command.markers.find(',') == std::string::npos;
    command.options.labels = file                              ? format::motion::read_marker_set(command.markers).labels
                             : command.options.as_far_as_there ? analyse::gait::marker_set_labels(command.markers)
                                                               : labels_in(command.markers);
  }
  std::vector<std::string> warnings;
  const LearnedMarkers learned =
      pipeline::markers::learn_labels(command.recordings, command.out, command.options, patterns_in(command.exclude), &warnings);
  for (std::string& warning : pipeline::markers::warnings_of(learned)) warnings.push_back(std::move(warning));
  warn(warnings);
  if (command.json) {
    print({{"labels", learned.labels},
           {"moves", learned.moves},
           {"scaled", learned.scaled},
           {"set", command.out},
           {"warnings", warnings}});
  } else if (!command.quiet) {
    fmt::print(stderr, "{} markers from {} recording{}{}\nset: {}\n", learned.size(), command.recordings.size(),
               command.recordings.size() == 1 ? "" : "s",
               learned.moves ? "" : "; the subject stood still: what is rigid will be learned where names are given", command.out);
  }
}

void print_labelled(const LabelCommand& command, const pipeline::markers::LabelSummary& summary) {
  fmt::print(stderr, "{:.2f} % of {} points in {} frames have names\n", percent_of(summary.named, summary.points), summary.points,
             summary.instants);
  fmt::print(stderr, "  {:<16} {:>8} {:>6} {:>9} {:>9}\n", "marker", "seen", "gaps", "renamed", "outliers");
  for (const auto& marker : summary.health) {
    if (marker.detected == 0) {
      fmt::print(stderr, "  {:<16}    never: no points lie as far from the others as it should\n", marker.label);
      continue;
    }
    fmt::print(stderr, "  {:<16} {:>6.1f} % {:>6} {:>9} {:>9}\n", marker.label, percent_of(marker.detected, summary.instants),
               marker.gaps, marker.renamed, marker.outliers);
  }
  fmt::print(stderr,
             "  (seen: of the frames; gaps: times that it is missing in between; renamed: frames in which its track had another "
             "name of the set before; outliers: frames in which its distances to the others are off)\n");
  if (summary.renamed > 0) fmt::print(stderr, "corrected: {} stretches of tracks had another name of the set\n", summary.renamed);
  if (summary.accepted > 0)
    fmt::print(stderr, "accepted: {} {} the name that fits best\n", summary.accepted,
               summary.accepted == 1 ? "piece got" : "pieces got");
  int reported = 0;
  for (const auto& piece : summary.unnamed) {
    if (piece.best.empty() || piece.last - piece.first < 10 || reported++ >= 10) continue;
    fmt::print(stderr, "  frames {}-{} of track {} have no name: {}{}{}?\n", piece.first, piece.last, number(piece.track),
               piece.best, piece.next.empty() ? "" : " or ", piece.next);
  }
  if (reported > 0 && command.accept.empty())
    fmt::print(stderr, "  --accept all, or --accept with some of these names, gives pieces the first name\n");
  fmt::print(stderr, "{}\n", command.out);
}

Json labelled_json(const LabelCommand& command, const pipeline::markers::LabelSummary& summary) {
  Json json{{"frames", summary.instants}, {"points", summary.points},     {"named", summary.named},
            {"renamed", summary.renamed}, {"accepted", summary.accepted}, {"scale", summary.scale},
            {"misfit", summary.misfit},   {"recording", command.out},     {"warnings", summary.warnings}};
  json["markers"] = Json::array();
  for (const auto& marker : summary.health)
    json["markers"].push_back({{"label", marker.label},
                               {"seen", marker.detected},
                               {"gaps", marker.gaps},
                               {"renamed", marker.renamed},
                               {"outliers", marker.outliers}});
  json["unnamed"] = Json::array();
  for (const auto& piece : summary.unnamed)
    json["unnamed"].push_back(
        {{"track", number(piece.track)}, {"first", piece.first}, {"last", piece.last}, {"best", piece.best}, {"next", piece.next}});
  return json;
}

void run(const LabelCommand& command) {
  const auto summary = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::markers::label_recording(command.recording, command.set, command.out, command.options, hooks,
                                              patterns_in(command.exclude), patterns_in(command.accept));
  });
  warn(summary.warnings);
  if (command.json) {
    print(labelled_json(command, summary));
  } else if (!command.quiet) {
    print_labelled(command, summary);
  }
}

void add_exclude(Command& command, std::vector<std::string>& patterns) {
  command.texts("--exclude", patterns, "points that are not markers, by their labels: LHJC,RHJC or *JC; may be given often");
}

void add_learn(Command& label) {
  auto options = std::make_shared<LearnLabelsCommand>();
  Command command = label.subcommand("learn", "Learn a marker set from recordings in which its markers have names");
  command.input_files("TAKES", options->recordings, "points in space with names: " + format::names_of_read(format::Content::space))
      .required();
  command.output_file("-o,--output", options->out, "the set, as set.toml").required();
  command.text(
      "--markers", options->markers,
      "those that belong to it: commas between, a file with one a line, or a set of the field as far as they have its markers: " +
          marker_set_names() + " (default: all with names)");
  command.also_reads([options] { return std::vector{options->markers}; });  // it may be a file
  add_exclude(command, options->exclude);
  command.flag("--scale-invariant", options->options.scaled,
               "the recordings are of subjects of several sizes, and the set is for others still");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace

void add_label(Command& program) {
  Command command = program.subcommand("label", "Name the markers of a recording by a set that was learned");
  add_learn(command);
  auto options = std::make_shared<LabelCommand>();
  // None of these is required by the parser, which would ask "label learn" for them too.
  command.input_file("RECORDING", options->recording,
                     "points in space; names that it has count nothing: " + format::names_of_read(format::Content::space));
  command.input_file("--marker-set", options->set, "set.toml, by \"marey label learn\"");
  command.output_file("-o,--output", options->out,
                      "the recording with names: " + format::endings_of_written(format::Content::space));
  add_exclude(command, options->exclude);
  command.texts(
      "--accept", options->accept,
      "what stays without a name gets the one that fits it best, where no other person bears it: all, or C7,T10; may be given "
      "often");
  auto& how = options->options;
  command.number("--min-fit", how.min_fit, "nats", closed(0, 100), "what fits no name better stays without one");
  command.number("--min-margin", how.min_margin, "nats", closed(0, 100), "by this much a name must be better than the next");
  command.reports(options->json, options->quiet);
  command.runs([options] {
    if (options->recording.empty())
      throw WrongUsage("RECORDING is missing; \"marey label RECORDING --marker-set set.toml -o OUTPUT\"");
    if (options->set.empty()) throw WrongUsage("--marker-set is missing; \"marey label learn\" makes one");
    if (options->out.empty()) throw WrongUsage("-o is missing; name the file to write");
    run(*options);
  });
}

}  // namespace marey::cli
