#include <array>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/format/register.h"
#include "marey/pipeline/bodies/measure_gait.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct GaitCommand {
  std::string recording;
  pipeline::bodies::GaitOutput output;
  pipeline::bodies::GaitOptions options;
  std::optional<double> leg_length, knee_width, ankle_width;
  bool json = false;
  bool quiet = false;
};

namespace gait = analyse::gait;

void print_forces(const pipeline::bodies::GaitMeasure& measure) {
  if (measure.forces.feet[0].empty()) return;
  std::array<int, 2> whole{};
  for (const gait::PlateContact& contact : measure.forces.contacts) {
    if (contact.side) ++whole[static_cast<std::size_t>(*contact.side)];
  }
  fmt::print("force plates: {} contacts, {} of the left foot, {} of the right\n", measure.forces.contacts.size(), whole[0],
             whole[1]);
  for (const auto& [name, of] : {std::pair("strikes", &measure.by_force.strikes), std::pair("offs", &measure.by_force.offs)}) {
    if (of->count > 0)
      fmt::print("{} by kinematics against force: {:+.1f} ± {:.1f} ms ({})\n", name, 1000 * of->mean_s, 1000 * of->deviation_s,
                 of->count);
  }
}

Json forces_json(const pipeline::bodies::GaitMeasure& measure) {
  if (measure.forces.feet[0].empty()) return nullptr;
  Json contacts = Json::array();
  for (const gait::PlateContact& contact : measure.forces.contacts) {
    const auto time = [&](std::size_t sample) {
      return measure.forces_begin_s + static_cast<double>(sample) / measure.forces.rate_hz;
    };
    Json one = {{"plate", contact.plate + 1}, {"begin_s", time(contact.first)}, {"end_s", time(contact.last)}};
    if (contact.side) one["foot"] = *contact.side == gait::Side::left ? "left" : "right";
    if (!contact.reason.empty()) one["not_used"] = contact.reason;
    contacts.push_back(std::move(one));
  }
  const auto difference = [](const gait::PreferredEvents::Difference& of) {
    return Json{{"count", of.count}, {"mean_s", of.mean_s}, {"deviation_s", of.deviation_s}};
  };
  return {{"rate_hz", measure.forces.rate_hz},
          {"contacts", contacts},
          {"kinematic_strikes_against_force", difference(measure.by_force.strikes)},
          {"kinematic_offs_against_force", difference(measure.by_force.offs)}};
}

constexpr double kDegreesOfRadian = 180 / std::numbers::pi;

void print_profile(const pipeline::bodies::GaitMeasure& measure) {
  if (!measure.profile) return;
  const gait::GaitProfile& profile = *measure.profile;
  const auto degrees = [](const std::optional<double>& score) {
    return score ? fmt::format("{:.1f}", *score * kDegreesOfRadian) : std::string("-");
  };
  for (const gait::VariableScore& variable : profile.variables)
    fmt::print("{:<22} {:>10} {:>10} deg RMS\n", variable.name, degrees(variable.mean[0]), degrees(variable.mean[1]));
  fmt::print("{:<22} {:>10} {:>10} deg, of both {}{}\n", "Gait Profile Score", degrees(profile.score[0]), degrees(profile.score[1]),
             degrees(profile.overall),
             measure.before && measure.before->profile ? ", before " + degrees(measure.before->profile->overall) : "");
}

Json profile_json(const pipeline::bodies::GaitMeasure& measure) {
  if (!measure.profile) return nullptr;
  const auto degrees = [](const std::optional<double>& score) -> Json {
    return score ? Json(*score * kDegreesOfRadian) : Json(nullptr);
  };
  const auto sides = [&](const auto& mean, const auto& deviation) {
    return Json{{"left_deg", degrees(mean[0])},
                {"right_deg", degrees(mean[1])},
                {"left_deviation_deg", degrees(deviation[0])},
                {"right_deviation_deg", degrees(deviation[1])}};
  };
  Json variables = Json::object();
  for (const gait::VariableScore& variable : measure.profile->variables)
    variables[variable.name] = sides(variable.mean, variable.deviation);
  Json json = sides(measure.profile->score, measure.profile->score_deviation);
  json["overall_deg"] = degrees(measure.profile->overall);
  json["variables"] = std::move(variables);
  return json;
}

Json reference_json(const pipeline::bodies::GaitMeasure& measure) {
  if (!measure.reference) return nullptr;
  const pipeline::bodies::GaitReference& group = *measure.reference;
  Json scores = Json::object();
  for (const gait::ReferenceScore& score : group.scores)
    scores[score.name] = {{"mean_deg", score.mean * kDegreesOfRadian}, {"deviation_deg", score.deviation * kDegreesOfRadian}};
  return {{"people", group.people.size()},
          {"walks", group.walks},
          {"cycles", group.cycles},
          {"turning_cycles", group.curved},
          {"scores", scores}};
}

void print_gait(const pipeline::bodies::GaitMeasure& measure) {
  int strikes = 0, offs = 0;
  for (const gait::GaitEvent& event : measure.events) ++(event.strike ? strikes : offs);
  fmt::print("{} frames at {:g} Hz: {} strikes, {} offs, {} whole cycles\n", measure.frames, measure.rate_hz, strikes, offs,
             measure.cycles.cycles.size());
  print_forces(measure);
  fmt::print("{:<22} {:>10} {:>10}\n", "", "left", "right");
  for (const gait::GaitFigure& figure : measure.cycles.figures) {
    const auto shown = [&](std::size_t side) {
      return figure.mean[side] ? fmt::format("{:.3g}", *figure.mean[side]) : std::string("-");
    };
    fmt::print("{:<22} {:>10} {:>10} {}\n", figure.name, shown(0), shown(1), figure.unit);
  }
  print_profile(measure);
}

/// The earlier session's figures and scores.
Json before_json(const pipeline::bodies::GaitMeasure& measure) {
  if (!measure.before) return nullptr;
  Json figures = Json::object();
  for (const gait::GaitFigure& figure : measure.before->cycles.figures)
    figures[figure.name] = {{"left", figure.mean[0]}, {"right", figure.mean[1]}, {"unit", figure.unit}};
  return {{"recording", measure.before_name},
          {"cycles", measure.before->cycles.cycles.size()},
          {"figures", figures},
          {"profile", profile_json(*measure.before)}};
}

Json gait_json(const pipeline::bodies::GaitMeasure& measure) {
  Json events = Json::array(), figures = Json::object();
  for (const gait::GaitEvent& event : measure.events) {
    events.push_back({{"side", event.side == gait::Side::left ? "left" : "right"},
                      {"event", event.strike ? "strike" : "off"},
                      {"time_s", measure.begin_s + event.time_s},
                      {"deviation_s", event.deviation_s}});
  }
  for (const gait::GaitFigure& figure : measure.cycles.figures)
    figures[figure.name] = {{"left", figure.mean[0]}, {"right", figure.mean[1]}, {"unit", figure.unit}};
  return {{"frames", measure.frames},
          {"rate_hz", measure.rate_hz},
          {"cycles", measure.cycles.cycles.size()},
          {"events", events},
          {"figures", figures},
          {"force_plates", forces_json(measure)},
          {"profile", profile_json(measure)},
          {"reference", reference_json(measure)},
          {"before", before_json(measure)},
          {"warnings", measure.warnings}};
}

void run(GaitCommand& command) {
  gait::GaitSubject& subject = command.options.subject;
  subject.leg_length.fill(command.leg_length);
  subject.knee_width.fill(command.knee_width);
  subject.ankle_width.fill(command.ankle_width);
  const pipeline::bodies::GaitMeasure measure = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::bodies::measure_gait(command.recording, command.output, command.options, hooks);
  });
  warn(measure.warnings);
  if (command.json) {
    print(gait_json(measure));
  } else if (!command.quiet) {
    print_gait(measure);
  }
}

}  // namespace

void add_gait(Command& program) {
  auto options = std::make_shared<GaitCommand>();
  Command command = program.subcommand("gait", "Joint angles, steps and gait cycles of a walk, from Plug-in Gait's markers");
  command.input_file("RECORDING", options->recording, "labelled markers: " + format::names_of_read(format::Content::space))
      .required();
  command.input_file("--static-trial", options->options.static_trial,
                     "the same person, standing: for the feet's neutral position and the legs' lengths");
  command.output_file("-o,--output", options->output.cycles, "CSV: every angle at 101 points of the cycle, mean and deviation")
      .ends_in({".csv"});
  command.output_file("--angles", options->output.angles, "CSV: every angle at every frame, degrees").ends_in({".csv"});
  command.input_file("--plates", options->options.plates,
                     "a C3D file of the same walk with its force plates, if RECORDING does not contain them");
  command
      .output_file(
          "--forces", options->output.forces,
          "the ground's force, centre of pressure and free moment on each foot: .mot for OpenSim, with the external loads in "
          "an .xml beside it, or .csv")
      .ends_in({".mot", ".csv"});
  command.output_file("--report", options->output.report, "a page with the curves, the walk's figures and its events")
      .ends_in({".html"});
  command
      .output_file(
          "--c3d", options->output.c3d,
          "RECORDING again, with the angles among its points, strikes and offs as events; what stands beside the points of a "
          "C3D file (forces, EMG) goes along")
      .ends_in({".c3d"});
  using Axis = std::optional<format::UpAxis>;
  constexpr std::array<std::pair<const char*, Axis>, 2> kAxes{{{"y", format::UpAxis::y}, {"z", format::UpAxis::z}}};
  command.choice("--up", options->options.up, kAxes, "the axis that is up in RECORDING; as it says where this is omitted, else z");
  command.input_files("--moments", options->options.joint_moments,
                      "joint moments and powers of the walk for --report (.sto of marey moments); omitted: the C3D file's own");
  command.group("Compared with");
  command.input_file("--reference", options->options.reference,
                     "a control group: a folder for each person, with walks and a static trial (static….c3d); gives its band, the "
                     "Gait Profile Score and the Movement Analysis Profile");
  const Option before = command.input_file("--before", options->options.before, "a walk of the same person at an earlier session");
  command.input_file("--before-static", options->options.before_static, "the static trial of that session").needs(before);
  command.group("The person, where the files do not specify");
  command.number("--leg-length", options->leg_length, "m", above(0, 2), "from the hip's front spine to the inner ankle");
  command.number("--knee-width", options->knee_width, "m", above(0, 0.5), "across its sides");
  command.number("--ankle-width", options->ankle_width, "m", above(0, 0.5), "across its sides");
  command.number("--mass", options->options.mass_kg, "kg", {1, 500}, "for forces in % of weight, and moments per kg");
  command.group("");
  command.reports(options->json, options->quiet, "figures");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
