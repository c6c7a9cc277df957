#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/pipeline/take/describe_edits.h"
#include "marey/pipeline/take/edit_take.h"

#include "command_line.h"
#include "commands.h"
#include "edit_json.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

using pipeline::take::EditLine;

struct EditCommand {
  std::string take, script;
  std::vector<std::string> edits;
  bool undo = false, redo = false, list = false;
  std::optional<std::int64_t> to;
  bool json = false;
  bool quiet = false;
};

/// All edits: those that count marked, each in the words of its time.
void list(const EditCommand& command) {
  const pipeline::take::EditHistory history = pipeline::take::edit_history(command.take);
  Json entries = Json::array();
  for (const EditLine& line : pipeline::take::lines_of(history)) {
    Json entry = edit_json(line);
    entry["active"] = line.counts;
    entries.push_back(std::move(entry));
    if (!command.json) fmt::print("{} {:4}  {}\n", line.counts ? "*" : " ", line.id, line.words);
  }
  if (command.json) {
    print({{"edits", entries}, {"head", history.state.head}});
  } else if (history.edits.empty()) {
    fmt::print("{}: nothing was edited\n", command.take);
  } else {
    fmt::print("* counts: what is read of the take has it\n");
  }
}

void report_head(const EditCommand& command) {
  const std::size_t count = pipeline::take::edit_history(command.take).counting.size();
  if (command.json) {
    print({{"take", command.take}, {"active", static_cast<std::int64_t>(count)}});
  } else if (!command.quiet) {
    fmt::print(stderr, "{}: {}\n", command.take,
               count == 0   ? "as it was recorded"
               : count == 1 ? "1 edit counts"
                            : fmt::format("{} edits count", count));
  }
}

void do_edits(const EditCommand& command) {
  std::vector<pipeline::take::EditRequest> requests;
  if (!command.script.empty()) requests = pipeline::take::read_edit_script(command.script);
  for (const std::string& edit : command.edits) requests.push_back({.text = edit, .where = fmt::format("\"{}\"", edit)});
  if (requests.empty()) throw Error("{}: holds no edit", command.script);
  std::vector<std::string> notes;
  const auto done = with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::take::edit_take(command.take, requests, hooks, {}, &notes); });
  std::vector<EditLine> lines = pipeline::take::lines_of(pipeline::take::edit_history(command.take));
  std::erase_if(lines, [&](const EditLine& line) {
    return done.empty() || line.id < done.front().edit.id || line.id > done.back().edit.id;  // another program's
  });
  if (command.json) {
    Json entries = Json::array();
    for (const EditLine& line : lines) entries.push_back(edit_json(line));
    print({{"take", command.take}, {"edits", entries}, {"notes", notes}});
    return;
  }
  for (const EditLine& line : lines) {
    if (!command.quiet) fmt::print(stderr, "{:4}  {}\n", line.id, line.words);
  }
  for (const std::string& note : notes) {
    if (!command.quiet) fmt::print(stderr, "{}\n", note);
  }
  report_head(command);
}

/// The edits that `other` has counting and `history` has not, in words.
void report_without(const pipeline::take::EditHistory& history, const pipeline::take::EditHistory& other, std::string_view what) {
  constexpr std::size_t kMostSaid = 12;
  std::vector<EditLine> lines = pipeline::take::lines_of(other);
  const auto& counting = history.counting;
  std::erase_if(lines, [&](const EditLine& line) {
    return !line.counts || std::find(counting.begin(), counting.end(), line.id) != counting.end();
  });
  for (std::size_t i = 0; i < std::min(kMostSaid, lines.size()); ++i)
    fmt::print(stderr, "{}: {:4}  {}\n", what, lines[i].id, lines[i].words);
  if (lines.size() > kMostSaid) fmt::print(stderr, "{}: {} more\n", what, lines.size() - kMostSaid);
}

/// --undo, --redo, --undo-to.
void move(const EditCommand& command) {
  const pipeline::take::EditHistory before = pipeline::take::edit_history(command.take);
  if (command.to) {
    pipeline::take::set_head(command.take, *command.to);
  } else {
    pipeline::take::move_head(command.take, command.undo ? -1 : 1);
  }
  if (!command.json && !command.quiet) {
    const pipeline::take::EditHistory now = pipeline::take::edit_history(command.take);
    report_without(now, before, "undone");
    report_without(before, now, "done again");
  }
  report_head(command);
}

void run(const EditCommand& command) {
  const bool moves = command.undo || command.redo || command.to;
  const bool edits = !command.edits.empty() || !command.script.empty();
  if (int{command.undo} + int{command.redo} + int{command.to.has_value()} + int{command.list} + int{edits} > 1)
    throw WrongUsage("--undo, --redo, --undo-to and --list stand alone, without edits");
  if (edits) return do_edits(command);
  if (!moves) return list(command);
  move(command);
}

}  // namespace

void add_edit(Command& program) {
  auto options = std::make_shared<EditCommand>();
  Command command = program.subcommand("edit", "Change a take without changing what was recorded: each edit can be undone");
  command.input_file("TAKE", options->take, "a take (.marey); nothing recorded in it is changed").required();
  command.texts("EDIT", options->edits,
                "done in this order, all or none: \"rename A B\", \"swap A B 120:180\", \"split A 300 [NAME]\", \"join A B\", "
                "\"delete A [120:180]\", \"team A,B Reds\", \"fill all|A [120:180] [spline|rigid|pattern] [longest=1] "
                "[within=50]\", \"filter all|A [6|auto] [120:180]\", \"turn BODY [120:180]\"; frames are counted from 0");
  command.input_file(
      "--script", options->script,
      "edits, one a line, done before those on the command line; # at a line's beginning or between blanks begins a remark");
  command.flag("--undo", options->undo, "let the last edit not count");
  command.flag("--redo", options->redo, "let it count again");
  command.whole("--undo-to", options->to, "ID", 0, 1'000'000'000,
                "let the edits up to this one count, 0: none; --list shows their numbers");
  command.flag("--list", options->list, "show the edits; without any other option this is done");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
