// Edits of a take that is there: each is decided on what the ones before it made of the take, then all are kept, or none.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/recording.h"
#include "marey/edit/operation.h"
#include "marey/format/take/take_edits.h"

namespace marey::pipeline::take {

using format::take::EditState;

/// One edit as it was asked for, and where: "line 3" of a script.
struct EditRequest {
  std::string text;
  std::string where;
};

/// A script of edits: one a line, `#` begins a remark. Throws Error if it cannot be read.
std::vector<EditRequest> read_edit_script(const std::string& path);

/// An edit as it was done.
struct DoneEdit {
  Edit edit;
  std::optional<edit::Operation> operation;  ///< nothing for a note, or what a later version of Marey did
};

/// What was done to a take.
struct EditHistory {
  std::vector<DoneEdit> edits;         ///< all there are, by id
  std::vector<std::int64_t> counting;  ///< ids of those that count, from the first to the head
  std::vector<TrackName> tracks;       ///< as recorded
  std::vector<Body> bodies;
  EditState state;
};

EditHistory edit_history(const std::string& path);

// `on` says how the edits stood that the one who asks has seen; without it, it is how they stand when the call begins. Each throws
// Error, and changes nothing, where they are others by then.

/// Throws Error, with where it was asked for, at the first that cannot be done; then nothing is. Returns them as they were done.
/// With `notes` a fill that finds no gap to fill is not done, and is not an Error; they get a sentence for it, and for each fill
/// that leaves gaps open.
std::vector<DoneEdit> edit_take(const std::string& path, const std::vector<EditRequest>& requests, const Hooks& hooks = {},
                                const std::optional<EditState>& on = {}, std::vector<std::string>* notes = nullptr);

/// Goes back (steps < 0) or on along the branch that was taken last, and returns the head then; nothing: the recorded data.
std::optional<std::int64_t> move_head(const std::string& path, std::int64_t steps, const std::optional<EditState>& on = {});
/// Lets the edits up to this one count; 0: none. Throws Error if there is no such edit.
void set_head(const std::string& path, std::int64_t id, const std::optional<EditState>& on = {});

/// The tracks that may be others where `now` counts than where `before` did, by growing id. Both are of one take.
std::vector<TrackId> tracks_between(const EditHistory& before, const EditHistory& now);
/// These tracks as the edits that count have left them, in the same order; without rows where they have used one up.
std::vector<TrackColumns> edited_tracks(const std::string& path, const std::vector<TrackId>& tracks);
/// The bodies whose poses may be others, as `tracks_between`.
std::vector<BodyId> bodies_between(const EditHistory& before, const EditHistory& now);
/// The poses of these bodies after the edits that count. Reads the whole take.
std::vector<BodyColumns> edited_bodies(const std::string& path, const std::vector<BodyId>& bodies);

}  // namespace marey::pipeline::take
