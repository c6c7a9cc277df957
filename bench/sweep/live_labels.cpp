// Names within the frame (pipeline/markers/set_in_space), with a search that is waited for, so that the results are the same on any
// machine.
//
//   live_labels RECORDING --set SET.toml -o OUT.csv   names a recording of points in space: a row a named point, frame,label,x,y,z
//   live_labels [--first-seed N]                      simulated people, as a Markdown table: % of the points that are right, wrong
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/bodies/label_set_file.h"
#include "marey/format/recording_file.h"

#include "experiments/markdown_table.h"
#include "support/labelled_person.h"

namespace {

using namespace marey;
using namespace marey::labelled;
using simulate::room::RoomMotion;

void name_recording(const std::string& recording, const std::string& set, const std::string& out) {
  pipeline::markers::SetInSpaceOptions options;
  options.wait = true;
  const auto reader = pipeline::markers::with_set(
      format::open_recording(recording), std::make_shared<const LearnedMarkers>(format::bodies::read_label_set(set)), options);
  std::string rows = "frame,label,x,y,z\n";
  std::map<TrackId, std::string> labels;
  while (const auto instant = reader->next()) {
    for (const TrackName& name : instant->named) labels[name.id] = name.label;
    for (const Sample& sample : instant->samples) {
      const std::string& label = labels[sample.track];
      if (label.empty()) continue;
      rows += fmt::format("{},{},{:.9f},{:.9f},{:.9f}\n", instant->index, label, sample.position.x(), sample.position.y(),
                          sample.position.z());
    }
  }
  for (const std::string& warning : reader->warnings()) fmt::print(stderr, "{}: {}\n", recording, warning);
  WholeFile file(out);
  file.write(rows);
  file.finish();
}

/// One kind of scene: the people's motion, and what taught the set.
struct Kind {
  const char* name;
  const char* taught;
  int seeds = 2;
  RoomMotion motion = RoomMotion::walk;
  RoomMotion taught_motion = RoomMotion::walk;
  int markers = 40;
  double hidden = 0.05;
  int swaps = 0;
};

NamedFraction fraction_of(const Kind& kind, std::uint64_t seed) {
  const bool same = kind.motion == kind.taught_motion;
  const RoomScene scene = person(kind.motion, kind.markers, seed, 2000);
  const auto set =
      set_of({same ? taught_by(scene, 12, 400) : taught_by(person(kind.taught_motion, kind.markers, seed, 2000), 12, 400)});
  return named_in(scene, Spoiler(scene, seed, kind.hidden, kind.swaps).detected(800), set);
}

void print_simulated(std::uint64_t first) {
  const std::vector<Kind> kinds{
      {"walk, 40 markers", "the same walk, later", 3},
      {"walk, 60 markers", "the same walk, later", 2, RoomMotion::walk, RoomMotion::walk, 60},
      {"walk, 40 markers, 15 % hidden", "the same walk, later", 2, RoomMotion::walk, RoomMotion::walk, 40, 0.15},
      {"walk, 40 markers, 15 swapped tracks", "the same walk, later", 2, RoomMotion::walk, RoomMotion::walk, 40, 0.05, 15},
      {"arms that wave over the head", "the same motion", 2, RoomMotion::wave, RoomMotion::wave},
      {"standing", "the same motion", 2, RoomMotion::still, RoomMotion::still},
      {"arms that wave over the head", "a walk, with arms that hang", 2, RoomMotion::wave, RoomMotion::walk},
      {"walk, 40 markers", "a person who stands still", 4, RoomMotion::walk, RoomMotion::still},
  };
  fmt::print("{}", experiments::markdown_header({"motion", "taught by", "seeds", "right, %", "wrong, %"}));
  for (const Kind& kind : kinds) {
    std::vector<std::string> right, wrong;
    for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(kind.seeds); ++seed) {
      const NamedFraction fraction = fraction_of(kind, seed);
      const double all = static_cast<double>(std::max<std::int64_t>(1, fraction.points)) / 100;
      right.push_back(fmt::format("{:.2f}", static_cast<double>(fraction.right) / all));
      wrong.push_back(fmt::format("{:.2f}", static_cast<double>(fraction.wrong) / all));
    }
    fmt::print("{}",
               experiments::markdown_row({kind.name, kind.taught, fmt::format("{}–{}", first, first + right.size() - 1),
                                          fmt::format("{}", fmt::join(right, ", ")), fmt::format("{}", fmt::join(wrong, ", "))}));
    std::fflush(stdout);
  }
}

}  // namespace

int main(int count, char** words) {
  std::string recording, set, out;
  std::uint64_t first = 101;
  CLI::App app("Names within the frame");
  auto* const input = app.add_option("RECORDING", recording, "points in space");
  auto* const learned = app.add_option("--set", set, "the learned set")->needs(input);
  auto* const output = app.add_option("-o,--output", out, "the named points, CSV");
  app.add_option("--first-seed", first, "of the simulated people")->capture_default_str();
  input->needs(learned)->needs(output);
  CLI11_PARSE(app, count, words);
  try {
    if (recording.empty()) {
      print_simulated(first);
    } else {
      name_recording(recording, set, out);
    }
  } catch (const Error& error) {
    fmt::print(stderr, "live_labels: {}\n", error.what());
    return 1;
  }
  return 0;
}
