#include "marey/pipeline/edit_take.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/input_file.h"
#include "marey/edit/decide.h"
#include "marey/edit/history.h"
#include "marey/edit/tracks.h"
#include "marey/format/take/take_edits.h"
#include "marey/format/take/take_file.h"

namespace marey::pipeline {
namespace {

using format::take::TakeReader;

/// The take's tracks as its edits have left them. They are read from it when they are wanted.
edit::Tracks tracks_of(const TakeReader& take, const std::string& path) {
  edit::Tracks tracks(take.moments(), take.tracks(), [&take](TrackId track) { return take.read_track(track); });
  try {
    for (const Edit& one : edit::branch_of(take.edits(), take.head())) {
      if (const auto operation = edit::operation_of(one)) tracks.apply(*operation);
    }
  } catch (const Error& error) {
    throw Error("{}: {}", path, error.what());
  }
  return tracks;
}

}  // namespace

std::vector<EditRequest> read_edit_script(const std::string& path) {
  InputStream in(path);
  if (!in) throw Error("{}: cannot be read; is the name right?", path);
  std::vector<EditRequest> requests;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.pop_back();
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string::npos || line[begin] == '#') continue;
    if (line.size() > 100'000) throw Error("{}:{}: is no edit; a line has at most 100,000 bytes", path, number);
    requests.push_back({.text = line.substr(begin), .where = fmt::format("{}:{}", path, number)});
  }
  return requests;
}

EditHistory edit_history(const std::string& path) {
  const TakeReader take(path);
  EditHistory history{.edits = {}, .counting = {}, .tracks = take.tracks()};
  for (const Edit& one : take.edits()) history.edits.push_back({one, edit::operation_of(one)});
  for (const Edit& one : edit::branch_of(take.edits(), take.head())) history.counting.push_back(one.id);
  return history;
}

std::vector<DoneEdit> edit_take(const std::string& path, const std::vector<EditRequest>& requests, const Hooks& hooks) {
  std::vector<DoneEdit> done;
  const TakeReader take(path);
  edit::Tracks tracks = tracks_of(take, path);
  std::optional<std::int64_t> head = take.head();
  std::int64_t id = edit::next_id(take.edits());
  for (const EditRequest& request : requests) {
    hooks.advance({.step = "editing", .done = std::ssize(done), .total = std::ssize(requests)});
    try {
      const edit::Operation operation = edit::decide(edit::parse_request(request.text), tracks);
      tracks.apply(operation);
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
  std::vector<Edit> edits;
  for (const DoneEdit& one : done) edits.push_back(one.edit);
  format::take::add_edits(path, edits, head);
  return done;
}

std::optional<std::int64_t> move_head(const std::string& path, std::int64_t steps) {
  std::optional<std::int64_t> head;
  {
    const TakeReader take(path);
    const std::vector<Edit> edits = take.edits();
    head = steps < 0 ? edit::undone(edits, take.head(), -steps) : edit::redone(edits, take.head(), steps);
    if (head == take.head()) throw Error("{}: there is nothing to be {}", path, steps < 0 ? "undone" : "done again");
  }
  format::take::add_edits(path, {}, head);
  return head;
}

void set_head(const std::string& path, std::int64_t id) {
  const auto head = id == 0 ? std::nullopt : std::optional(id);
  try {
    edit::branch_of(TakeReader(path).edits(), head);
  } catch (const Error& error) {
    throw Error("{}: {}", path, error.what());
  }
  format::take::add_edits(path, {}, head);
}

}  // namespace marey::pipeline
