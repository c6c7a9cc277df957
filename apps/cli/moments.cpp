#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/pipeline/bodies/joint_moments.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct MomentsCommand {
  std::string model, motion, output, powers;
  pipeline::bodies::MomentOptions options;
  bool json = false;
  bool quiet = false;
};

using pipeline::bodies::JointMoments;

/// The value farthest from 0.
double largest(const std::vector<double>& values) {
  double found = 0;
  for (const double value : values) {
    if (std::abs(value) > std::abs(found)) found = value;
  }
  return found;
}

void print_moments(const JointMoments& moments) {
  fmt::print("{} frames at {:g} Hz, {:.1f} kg\n", moments.times.size(), moments.rate_hz, moments.mass_kg);
  if (moments.residual_n)
    fmt::print("residual force at the root: {:.1f} N RMS ({:.1f} % of the weight)\n", *moments.residual_n,
               100 * *moments.residual_n / (moments.mass_kg * solve::skeleton::kGravity));
  if (moments.unexplained_fraction.value_or(0) > 0)
    fmt::print("more than a tenth of the weight is missing in {:.0f} % of the frames: a foot is on no plate\n",
               100 * *moments.unexplained_fraction);
  fmt::print("{:<28} {:>14} {:>12}\n", "", "largest", "power");
  for (const JointMoments::Coordinate& one : moments.coordinates)
    fmt::print("{:<28} {:>10.2f} {:<3} {:>10.2f} W\n", one.name, largest(one.forces), one.is_rotation ? "N m" : "N",
               largest(one.powers));
}

Json moments_json(const JointMoments& moments) {
  Json coordinates = Json::array();
  for (const JointMoments::Coordinate& one : moments.coordinates)
    coordinates.push_back({{"name", one.name},
                           {"unit", one.is_rotation ? "N m" : "N"},
                           {"largest", largest(one.forces)},
                           {"largest_power_w", largest(one.powers)}});
  Json json = {{"frames", moments.times.size()},
               {"rate_hz", moments.rate_hz},
               {"mass_kg", moments.mass_kg},
               {"coordinates", coordinates},
               {"warnings", moments.warnings}};
  if (moments.residual_n) json["residual_n"] = *moments.residual_n;
  if (moments.unexplained_fraction) json["unexplained_fraction"] = *moments.unexplained_fraction;
  return json;
}

void run(MomentsCommand& command) {
  const JointMoments moments = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::bodies::joint_moments(command.model, command.motion, command.options, hooks);
  });
  if (!command.output.empty()) pipeline::bodies::write_moments(command.output, moments);
  if (!command.powers.empty()) pipeline::bodies::write_powers(command.powers, moments);
  warn(moments.warnings);
  if (command.json) {
    print(moments_json(moments));
  } else if (!command.quiet) {
    print_moments(moments);
  }
}

}  // namespace

void add_moments(Command& program) {
  auto options = std::make_shared<MomentsCommand>();
  Command command = program.subcommand("moments", "Joint moments and powers of a model's motion (inverse dynamics)");
  command.input_file("MODEL", options->model, "OpenSim's .osim with masses").required();
  command.input_file("MOTION", options->motion, ".mot or .sto of the model's coordinates, as marey solve writes it").required();
  command.input_file("--loads", options->options.loads,
                     "the ground's forces: a C3D file with force plates, or OpenSim's external loads (.xml)");
  command.output_file("-o,--output", options->output, "a moment (N m) or force (N) for each coordinate").ends_in({".sto", ".mot"});
  command.output_file("--powers", options->powers, "moment times speed of each coordinate, W").ends_in({".sto", ".mot"});
  command.number("--cutoff", options->options.cutoff_hz, "Hz", {0, 1000}, "low pass of coordinates and plates' forces; 0: none");
  using Axis = std::optional<format::UpAxis>;
  constexpr std::array<std::pair<const char*, Axis>, 2> kAxes{{{"y", format::UpAxis::y}, {"z", format::UpAxis::z}}};
  command.choice("--up", options->options.up, kAxes,
                 "the axis that is up in the C3D file; as it says where this is omitted, else z");
  command.text("--left-foot", options->options.left_foot, "the model's body on which the left foot's loads act");
  command.text("--right-foot", options->options.right_foot, "the model's body on which the right foot's loads act");
  command.reports(options->json, options->quiet, "figures");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
