#include "marey/pipeline/identify/who.h"

#include <memory>
#include <string>

#include <fmt/core.h>

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct WhoCommand {
  std::string take, answers;
  pipeline::identify::WhoOptions options;
  bool json = false;
  bool quiet = false;
};

std::string edits_of(std::int64_t count) {
  return fmt::format("{} edit{}", count, count == 1 ? "" : "s");
}

Json json_of(const pipeline::identify::Doubt& doubt) {
  return {{"time", doubt.time_s}, {"kind", doubt.kind},   {"question", doubt.question},       {"a", doubt.a},
          {"b", doubt.b},         {"frame", doubt.frame}, {"probability", doubt.probability}, {"changes_s", doubt.changes_s}};
}

void report_json(const WhoCommand& command, const pipeline::identify::WhoSummary& summary) {
  Json people = Json::array(), doubts = Json::array();
  for (const pipeline::identify::WhoSummary::Person& person : summary.people)
    people.push_back({{"label", person.label}, {"team", person.team}, {"track", person.track}, {"known_s", person.known_s}});
  for (const pipeline::identify::Doubt& doubt : summary.doubts) doubts.push_back(json_of(doubt));
  print({{"take", command.take},
         {"seconds", summary.recorded_s},
         {"people", people},
         {"unnamed_s", summary.unnamed_s},
         {"left_out", summary.left_out},
         {"doubts", doubts},
         {"edits", summary.edits}});
}

void report(const WhoCommand& command, const pipeline::identify::WhoSummary& summary) {
  fmt::print("{:<24} {:<16} {:>6} {:>9}\n", "name", "team", "track", "known, %");
  for (const pipeline::identify::WhoSummary::Person& person : summary.people)
    fmt::print("{:<24} {:<16} {:>6} {:>9.1f}\n", person.label, person.team, fmt::format("#{}", person.track),
               summary.recorded_s > 0 ? std::min(100.0, 100 * person.known_s / summary.recorded_s) : 0);
  fmt::print("{} named; {} in doubt{}; {:.0f} s of others; {}: `marey edit {} --list`\n", summary.people.size(),
             summary.doubts.size(), command.options.doubts.empty() ? "" : ", listed in " + command.options.doubts,
             summary.unnamed_s, edits_of(summary.edits), command.take);
  if (summary.left_out > 0)
    fmt::print("{} place{} deleted: of somebody who is elsewhere then, or between two people\n", summary.left_out,
               summary.left_out == 1 ? "" : "s");
}

void apply(const WhoCommand& command) {
  const auto done = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::identify::apply_answers(command.take, command.answers, command.options.roster, hooks);
  });
  if (command.json) {
    print({{"take", command.take},
           {"answered", done.answered},
           {"blank", done.blank},
           {"before", done.before},
           {"edits", done.edits}});
  } else if (!command.quiet) {
    fmt::print("{}: {} answered{}, {} left open; {}\n", command.take, done.answered,
               done.before > 0 ? fmt::format(" ({} applied before)", done.before) : "", done.blank, edits_of(done.edits));
  }
}

void run(const WhoCommand& command) {
  if (!command.answers.empty()) return apply(command);
  if (command.options.roster.empty() || command.options.names.empty())
    throw WrongUsage("write --roster and --names to name people, or --answers to apply answers");
  const auto summary = with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::identify::name_people(command.take, command.options, hooks); });
  if (command.json) {
    report_json(command, summary);
  } else if (!command.quiet) {
    report(command, summary);
  }
}

}  // namespace

void add_who(Command& program) {
  auto options = std::make_shared<WhoCommand>();
  Command command = program.subcommand("who", "Name the people of a take, carry the names through it, and list what is in doubt");
  command.input_file("TAKE", options->take, "a take of people on the ground (.marey); nothing recorded in it is changed")
      .required();
  command.input_file("--roster", options->options.roster, "who plays: CSV with number,name,team and, if wanted, role,in,out");
  const Option names = command.input_file("--names", options->options.names, "who was recognised where: CSV with time,id,name");
  const Option doubts =
      command.output_file("--doubts", options->options.doubts, "what is in doubt, to be answered in its last column: FILE.csv");
  command.number("--least", options->options.least, "P", closed(0, 1), "list what is wrong with this probability at least");
  const Option answers = command.input_file("--answers", options->answers, "apply the answers in such a list, all or none");
  Option(answers).excludes(names).excludes(doubts);
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
