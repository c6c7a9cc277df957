#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "marey/core/text_safety.h"
#include "marey/pipeline/edit_take.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

using edit::FilledGap;
using edit::Operation;
using pipeline::DoneEdit;

struct EditCommand {
  std::string take, script;
  std::vector<std::string> edits;
  bool undo = false, redo = false, list = false;
  std::optional<std::int64_t> to;
  bool json = false;
  bool quiet = false;
};

/// What tracks are called.
class Names {
 public:
  explicit Names(const std::vector<TrackName>& tracks) {
    for (const TrackName& track : tracks) names_[track.id] = track.label;
  }
  std::string of(TrackId track) const {
    const auto found = names_.find(track);
    return found == names_.end() || found->second.empty() ? fmt::format("#{}", number(track)) : found->second;
  }
  std::string of(const std::vector<TrackId>& tracks) const {
    constexpr std::size_t kMost = 6;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(tracks.size(), kMost); ++i) names.push_back(of(tracks[i]));
    return fmt::format("{}{}", fmt::join(names, ", "),
                       tracks.size() > kMost ? fmt::format(" and {} more", tracks.size() - kMost) : "");
  }
  /// What it did to names counts for the edits behind it.
  void follow(const Operation& operation) {
    if (operation.kind == Operation::Kind::rename) names_[operation.tracks[0]] = operation.label;
    if (operation.kind == Operation::Kind::split) names_[*operation.born] = operation.label;
  }

 private:
  std::map<TrackId, std::string> names_;
};

std::string frames_of(const std::optional<edit::FrameRange>& frames) {
  if (!frames) return {};
  constexpr std::int64_t kOpen = 2'147'483'647;
  if (frames->last == kOpen) return fmt::format(", from frame {} on", frames->first);
  return fmt::format(", frames {} to {}", frames->first, frames->last);
}

std::string fills_of(const std::vector<FilledGap>& gaps) {
  std::int64_t frames = 0;
  std::map<std::string_view, int> by_method;
  double least = gaps.front().expected_m, most = least;
  for (const FilledGap& gap : gaps) {
    frames += gap.frames.last - gap.frames.first + 1;
    ++by_method[edit::name_of(gap.method)];
    least = std::min(least, gap.expected_m);
    most = std::max(most, gap.expected_m);
  }
  std::vector<std::string> methods;
  for (const auto& [method, count] : by_method) methods.push_back(fmt::format("{} by {}", count, method));
  return fmt::format("{} {}, {} frames: {}; expected to be off by {:.1f} to {:.1f} mm", gaps.size(),
                     gaps.size() == 1 ? "gap" : "gaps", frames, fmt::join(methods, ", "), least * 1e3, most * 1e3);
}

std::string cutoffs_of(const std::vector<double>& cutoffs) {
  const auto [least, most] = std::minmax_element(cutoffs.begin(), cutoffs.end());
  return *least == *most ? fmt::format("{:g} Hz", *least) : fmt::format("{:g} to {:g} Hz", *least, *most);
}

std::string raw_words_of(const DoneEdit& done, const Names& names) {
  if (!done.operation) return fmt::format("{} {}", done.edit.operation, done.edit.payload);
  const Operation& operation = *done.operation;
  using Kind = Operation::Kind;
  std::string words(edit::name_of(operation.kind));
  if (operation.kind == Kind::fill) return fmt::format("{} {}", words, fills_of(operation.gaps));
  words += " " + names.of(operation.tracks);
  if (operation.kind == Kind::rename) return fmt::format("{} to {}", words, operation.label);
  if (operation.kind == Kind::split)
    return fmt::format("{} at frame {}: {} from there on", words, operation.frames->first,
                       operation.label.empty() ? fmt::format("#{}", number(*operation.born)) : operation.label);
  if (operation.kind == Kind::filter) words += " at " + cutoffs_of(operation.cutoffs_hz);
  return words + frames_of(operation.frames);
}

/// "swap LKNE, RKNE, frames 120 to 180". Names and edits may be a stranger's.
std::string words_of(const DoneEdit& done, const Names& names) {
  return plain_text(raw_words_of(done, names));
}

Json gaps_of(const Operation& operation, const Names& names) {
  Json gaps = Json::array();
  for (const FilledGap& gap : operation.gaps) {
    gaps.push_back({{"track", names.of(gap.track)},
                    {"first", gap.frames.first},
                    {"last", gap.frames.last},
                    {"method", std::string(edit::name_of(gap.method))},
                    {"expected_mm", gap.expected_m * 1e3}});
  }
  return gaps;
}

Json json_of(const DoneEdit& done, const Names& names) {
  Json entry{{"id", done.edit.id}, {"operation", plain_text(done.edit.operation)}, {"words", words_of(done, names)}};
  if (done.edit.parent) entry["parent"] = *done.edit.parent;
  if (done.operation && !done.operation->gaps.empty()) entry["gaps"] = gaps_of(*done.operation, names);
  return entry;
}

/// All edits: those that count marked, each in the words of its time.
void list(const EditCommand& command) {
  const pipeline::EditHistory history = pipeline::edit_history(command.take);
  Names names(history.tracks);
  const auto counts = [&](const DoneEdit& done) {
    return std::find(history.counting.begin(), history.counting.end(), done.edit.id) != history.counting.end();
  };
  Json entries = Json::array();
  for (const DoneEdit& done : history.edits) {
    Json entry = json_of(done, names);
    entry["counts"] = counts(done);
    entries.push_back(std::move(entry));
    if (!command.json) fmt::print("{} {:4}  {}\n", counts(done) ? "*" : " ", done.edit.id, words_of(done, names));
    if (done.operation && counts(done)) names.follow(*done.operation);
  }
  if (command.json) {
    print({{"edits", entries}, {"head", history.counting.empty() ? Json(0) : Json(history.counting.back())}});
  } else if (history.edits.empty()) {
    fmt::print("{}: nothing was edited\n", command.take);
  } else {
    fmt::print("* counts: what is read of the take has it\n");
  }
}

void say_head(const EditCommand& command) {
  const std::size_t count = pipeline::edit_history(command.take).counting.size();
  if (command.json) {
    print({{"take", command.take}, {"counting", static_cast<std::int64_t>(count)}});
  } else if (!command.quiet) {
    fmt::print(stderr, "{}: {}\n", command.take,
               count == 0   ? "as it was recorded"
               : count == 1 ? "1 edit counts"
                            : fmt::format("{} edits count", count));
  }
}

void do_edits(const EditCommand& command) {
  std::vector<pipeline::EditRequest> requests;
  if (!command.script.empty()) requests = pipeline::read_edit_script(command.script);
  for (const std::string& edit : command.edits) requests.push_back({.text = edit, .where = fmt::format("\"{}\"", edit)});
  if (requests.empty()) throw Error("{}: holds no edit", command.script);
  Names names(pipeline::edit_history(command.take).tracks);
  const auto done =
      with_progress(command.quiet, [&](const Hooks& hooks) { return pipeline::edit_take(command.take, requests, hooks); });
  if (command.json) {
    Json entries = Json::array();
    for (const DoneEdit& one : done) {
      entries.push_back(json_of(one, names));
      if (one.operation) names.follow(*one.operation);
    }
    print({{"take", command.take}, {"edits", entries}});
    return;
  }
  for (const DoneEdit& one : done) {
    if (!command.quiet) fmt::print(stderr, "{:4}  {}\n", one.edit.id, words_of(one, names));
    if (one.operation) names.follow(*one.operation);
  }
  say_head(command);
}

void run(const EditCommand& command) {
  const bool moves = command.undo || command.redo || command.to;
  const bool edits = !command.edits.empty() || !command.script.empty();
  if (int{command.undo} + int{command.redo} + int{command.to.has_value()} + int{command.list} + int{edits} > 1)
    throw WrongUsage("--undo, --redo, --to and --list stand alone, without edits");
  if (edits) return do_edits(command);
  if (!moves) return list(command);
  if (command.to) {
    pipeline::set_head(command.take, *command.to);
  } else {
    pipeline::move_head(command.take, command.undo ? -1 : 1);
  }
  say_head(command);
}

}  // namespace

void add_edit(Command& program) {
  auto options = std::make_shared<EditCommand>();
  Command command = program.subcommand("edit", "Change a take without changing what was recorded: each edit can be undone");
  command.input_file("TAKE", options->take, "a take (.marey); nothing recorded in it is changed").required();
  command.texts("EDIT", options->edits,
                "done in this order, all or none: \"rename A B\", \"swap A B 120:180\", \"split A 300 [NAME]\", \"join A B\", "
                "\"delete A [120:180]\", \"fill all|A [120:180] [spline|rigid|pattern] [longest=1] [within=50]\", \"filter all|A "
                "[6|auto] [120:180]\"; "
                "frames are counted from 0");
  command.input_file("--script", options->script, "edits, one a line, done before those on the command line; # begins a remark");
  command.flag("--undo", options->undo, "let the last edit not count");
  command.flag("--redo", options->redo, "let it count again");
  command.whole("--to", options->to, "ID", 0, 1'000'000'000,
                "let the edits up to this one count, 0: none; --list shows their numbers");
  command.flag("--list", options->list, "show the edits; without any other option this is done");
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli
