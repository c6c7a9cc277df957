#include "marey/pipeline/identify/identify.h"

#include <memory>
#include <string>

#include <fmt/core.h>

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct IdentifyCommand {
  std::string take, answers;
  pipeline::identify::IdentifyOptions options;
  bool json = false;
  bool quiet = false;
};

std::string edits_of(std::int64_t count) {
  return fmt::format("{} edit{}", count, count == 1 ? "" : "s");
}

Json json_of(const pipeline::identify::ReviewItem& review_item) {
  return {{"time", review_item.time_s},
          {"kind", review_item.kind},
          {"question", review_item.question},
          {"a", review_item.a},
          {"b", review_item.b},
          {"frame", review_item.frame},
          {"probability", review_item.probability},
          {"changes_s", review_item.changes_s}};
}

void report_json(const IdentifyCommand& command, const pipeline::identify::IdentifySummary& summary) {
  Json people = Json::array(), review_items = Json::array();
  for (const pipeline::identify::IdentifySummary::Person& person : summary.people)
    people.push_back({{"label", person.label}, {"team", person.team}, {"track", person.track}, {"identified_s", person.known_s}});
  for (const pipeline::identify::ReviewItem& review_item : summary.review_items) review_items.push_back(json_of(review_item));
  print({{"take", command.take},
         {"seconds", summary.recorded_s},
         {"people", people},
         {"unidentified_s", summary.unnamed_s},
         {"excluded", summary.excluded},
         {"review", review_items},
         {"numbered", summary.numbered},
         {"unused_numbers", summary.unused_numbers},
         {"edits", summary.edits}});
}

void report(const IdentifyCommand& command, const pipeline::identify::IdentifySummary& summary) {
  fmt::print("{:<24} {:<16} {:>6} {:>9}\n", "name", "team", "track", "known, %");
  for (const pipeline::identify::IdentifySummary::Person& person : summary.people)
    fmt::print("{:<24} {:<16} {:>6} {:>9.1f}\n", person.label, person.team, fmt::format("#{}", person.track),
               summary.recorded_s > 0 ? std::min(100.0, 100 * person.known_s / summary.recorded_s) : 0);
  fmt::print("{} named; {} uncertain{}; {:.0f} s of others; {}: `marey edit {} --list`\n", summary.people.size(),
             summary.review_items.size(), command.options.review_items.empty() ? "" : ", listed in " + command.options.review_items,
             summary.unnamed_s, edits_of(summary.edits), command.take);
  if (!command.options.numbers.empty()) fmt::print("{} named by the number of the shirt\n", summary.numbered);
  for (const std::string& message_text : summary.unused_numbers) fmt::print("{}\n", message_text);
  if (summary.excluded > 0)
    fmt::print("{} place{} deleted: of a person who is elsewhere then, or between two people\n", summary.excluded,
               summary.excluded == 1 ? "" : "s");
}

void apply(const IdentifyCommand& command) {
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

void run(const IdentifyCommand& command) {
  if (!command.answers.empty()) return apply(command);
  if (command.options.roster.empty() || (command.options.names.empty() && command.options.numbers.empty()))
    throw WrongUsage("write --squads, and --annotations or --numbers, to name people, or --answers to apply answers");
  const auto summary = with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::identify::name_people(command.take, command.options, hooks); });
  if (command.json) {
    report_json(command, summary);
  } else if (!command.quiet) {
    report(command, summary);
  }
}

}  // namespace

void add_identify(Command& program) {
  auto options = std::make_shared<IdentifyCommand>();
  Command command =
      program.subcommand("identify", "Name the people of a take, carry the names through it, and list what is uncertain");
  command.input_file("TAKE", options->take, "a take of people on the ground (.marey); nothing recorded in it is changed")
      .required();
  command.input_file("--squads", options->options.roster, "who plays: CSV with number,name,team and, if wanted, role,in,out");
  const Option names =
      command.input_file("--annotations", options->options.names, "who was recognised where: CSV with time,id,name");
  const Option numbers =
      command.input_file("--numbers", options->options.numbers,
                         "the shirts' numbers, as \"marey track --ground --numbers\" writes them: each names its "
                         "person where it is certain enough, and --annotations counts more");
  command.number("--min-number-probability", options->options.min_number, "P", closed(0, 1), "of a number that names a person");
  const Option review_items = command.output_file("--review", options->options.review_items,
                                                  "what is uncertain, to be answered in its last column: FILE.csv");
  command.number("--min-probability", options->options.minimum, "P", closed(0, 1),
                 "list what is wrong with this probability at least");
  const Option answers = command.input_file("--answers", options->answers, "apply the answers in such a list, all or none");
  Option(answers).excludes(names).excludes(numbers).excludes(review_items);
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
