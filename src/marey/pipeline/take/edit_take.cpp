#include "marey/pipeline/take/edit_take.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/edit/decide.h"
#include "marey/edit/edited.h"
#include "marey/edit/history.h"
#include "marey/edit/tracks.h"
#include "marey/edit/turn_body.h"
#include "marey/files/input_file.h"
#include "marey/format/take/take_file.h"

namespace marey::pipeline::take {
namespace {

using edit::Operation;
using format::take::TakeReader;

/// The take's tracks as its edits have left them. They are read from it when they are wanted.
edit::Tracks tracks_of(const TakeReader& take, const std::string& path) {
  edit::Tracks tracks(take.time_steps(), take.tracks(), [&take](TrackId track) { return take.read_track(track); });
  try {
    for (const Edit& one : edit::branch_of(take.edits(), take.head())) {
      if (const auto operation = edit::operation_of(one)) tracks.apply(*operation);
    }
  } catch (const Error& error) {
    throw Error("{}: {}", path, error.what());
  }
  return tracks;
}

/// A take's edits as they stand.
struct Standing {
  std::vector<Edit> edits;
  std::optional<std::int64_t> head;
  EditState state;
};

/// Throws Error if they do not stand at `on`.
Standing standing_of(const TakeReader& take, const std::string& path, const std::optional<EditState>& on) {
  Standing standing{.edits = take.edits(), .head = take.head(), .state = {}};
  standing.state = format::take::edit_state(standing.edits, standing.head);
  if (on && *on != standing.state) format::take::fail_edited_elsewhere(path);
  return standing;
}

void add_tracks_of(const Operation& operation, std::set<TrackId>& tracks) {
  tracks.insert(operation.tracks.begin(), operation.tracks.end());
  if (operation.initiated) tracks.insert(*operation.initiated);
  for (const edit::FilledGap& gap : operation.gaps) tracks.insert(gap.track);
}

/// The operations of edits that count in only one of two states of a take.
std::vector<Operation> operations_between(const EditHistory& before, const EditHistory& now) {
  const auto [left, common] =
      std::mismatch(before.counting.begin(), before.counting.end(), now.counting.begin(), now.counting.end());
  std::set<std::int64_t> others(left, before.counting.end());
  others.insert(common, now.counting.end());
  std::vector<Operation> operations;
  for (const DoneEdit& done : now.edits) {
    if (done.operation && others.contains(done.edit.id)) operations.push_back(*done.operation);
  }
  return operations;
}

/// Where a remark begins: a `#` between blanks, or at the line's end, that stands in no quotes; the line's length where there is
/// none.
std::size_t end_before_remark(std::string_view line) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (quoted || line[i] != '#' || i == 0 || !blank(line[i - 1])) continue;
    if (i + 1 == line.size() || blank(line[i + 1])) return i;
  }
  return line.size();
}

}  // namespace

std::vector<EditRequest> read_edit_script(const std::string& path) {
  InputStream in(path);
  if (!in) throw Error("{}: cannot be read; is the name right?", path);
  std::vector<EditRequest> requests;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line.resize(end_before_remark(line));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.pop_back();
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos || line[begin] == '#') continue;
    if (line.size() > 100'000) throw Error("{}:{}: is not an edit; a line has at most 100,000 bytes", path, number);
    requests.push_back({.text = line.substr(begin), .where = fmt::format("{}:{}", path, number)});
  }
  return requests;
}

EditHistory edit_history(const std::string& path) {
  const TakeReader take(path);
  const auto [edits, head, state] = standing_of(take, path, {});
  EditHistory history{.edits = {}, .counting = {}, .tracks = take.tracks(), .bodies = take.header().bodies, .state = state};
  for (const Edit& one : edits) history.edits.push_back({one, edit::operation_of(one)});
  for (const Edit& one : edit::branch_of(edits, head)) history.counting.push_back(one.id);
  return history;
}

std::vector<DoneEdit> edit_take(const std::string& path, const std::vector<EditRequest>& requests, const Hooks& hooks,
                                const std::optional<EditState>& on, std::vector<std::string>* notes) {
  std::vector<DoneEdit> done;
  const TakeReader take(path);
  auto [before, head, state] = standing_of(take, path, on);
  edit::Tracks tracks = tracks_of(take, path);
  std::optional<Recording> bodies;  // read where an edit wants them
  std::int64_t id = edit::next_id(before);
  for (const EditRequest& request : requests) {
    hooks.advance({.step = "editing", .done = std::ssize(done), .total = std::ssize(requests)});
    try {
      const edit::Request parsed = edit::parse_request(request.text);
      edit::OpenGaps open;
      const bool turn = parsed.kind == Operation::Kind::turn;
      if (turn && !bodies) bodies = edit::edited(format::take::read_recording(path));
      const Operation operation =
          turn ? edit::decide_turn(parsed, *bodies) : edit::decide(parsed, tracks, notes == nullptr ? nullptr : &open);
      const bool nothing = operation.kind == Operation::Kind::fill && operation.gaps.empty();
      if (nothing || open.all() > 0)
        notes->push_back(
            fmt::format("{}: {}{}", request.where, edit::words_of(open, parsed), nothing ? "; nothing was filled" : ""));
      if (nothing) continue;
      tracks.apply(operation);
      if (turn) edit::turn_body(*bodies, operation);
      Edit edit = edit::edit_of(operation);
      edit.id = id++;
      edit.parent = std::exchange(head, edit.id);
      done.push_back({std::move(edit), operation});
    } catch (const Stopped&) {
      throw;
    } catch (const Error& error) {
      throw Error("{}: {}{}", request.where, error.what(), requests.size() > 1 ? "; nothing was changed" : "");
    }
  }
  if (done.empty()) return done;
  std::vector<Edit> edits;
  for (const DoneEdit& one : done) edits.push_back(one.edit);
  format::take::add_edits(path, edits, head, state);
  return done;
}

std::optional<std::int64_t> move_head(const std::string& path, std::int64_t steps, const std::optional<EditState>& on) {
  const auto [edits, before, state] = standing_of(TakeReader(path), path, on);
  const auto head = steps < 0 ? edit::undone(edits, before, -steps) : edit::redone(edits, before, steps);
  if (head == before) throw Error("{}: there is nothing to be {}", path, steps < 0 ? "undone" : "done again");
  format::take::add_edits(path, {}, head, state);
  return head;
}

void set_head(const std::string& path, std::int64_t id, const std::optional<EditState>& on) {
  const auto [edits, before, state] = standing_of(TakeReader(path), path, on);
  const auto head = id == 0 ? std::nullopt : std::optional(id);
  try {
    edit::branch_of(edits, head);
  } catch (const Error& error) {
    throw Error("{}: {}", path, error.what());
  }
  format::take::add_edits(path, {}, head, state);
}

std::vector<TrackId> tracks_between(const EditHistory& before, const EditHistory& now) {
  std::set<TrackId> tracks;
  for (const Operation& operation : operations_between(before, now)) add_tracks_of(operation, tracks);
  return {tracks.begin(), tracks.end()};
}

std::vector<BodyId> bodies_between(const EditHistory& before, const EditHistory& now) {
  std::set<BodyId> bodies;
  for (const Operation& operation : operations_between(before, now)) {
    if (operation.body) bodies.insert(*operation.body);
  }
  return {bodies.begin(), bodies.end()};
}

std::vector<TrackColumns> edited_tracks(const std::string& path, const std::vector<TrackId>& tracks) {
  const TakeReader take(path);
  edit::Tracks now = tracks_of(take, path);
  const int dimensions = take.header().frame.dimensions();
  std::vector<TrackColumns> columns;
  for (const TrackId track : tracks)
    columns.push_back(now.has(track) ? now.columns(track, dimensions)
                                     : TrackColumns({.id = track, .label = {}, .team = {}, .colour = {}}, dimensions));
  return columns;
}

std::vector<BodyColumns> edited_bodies(const std::string& path, const std::vector<BodyId>& bodies) {
  const Recording now = edit::edited(format::take::read_recording(path));
  std::vector<BodyColumns> columns;
  for (const BodyId body : bodies) {
    if (const BodyColumns* poses = now.find(body)) columns.push_back(*poses);
  }
  return columns;
}

}  // namespace marey::pipeline::take
