#include "marey/format/take/take_edits.h"

#include <algorithm>
#include <string_view>

#include "marey/core/error.h"
#include "marey/files/file_lock.h"
#include "marey/format/take/sqlite.h"
#include "marey/format/take/take_file.h"
#include "marey/format/take/take_schema.h"

namespace marey::format::take {

EditState edit_state(const std::vector<Edit>& edits, std::optional<std::int64_t> head) {
  EditState state{.head = head.value_or(0)};
  for (const Edit& edit : edits) state.newest = std::max(state.newest, edit.id);
  return state;
}

void fail_edited_elsewhere(const std::string& path) {
  throw Error("{}: another program has edited it in the meantime, and nothing was changed; look at it as it is now and do it again",
              path);
}

void add_edits(const std::string& path, std::span<const Edit> more, std::optional<std::int64_t> head, const EditState& on) {
  const TakeReader whole(path);  // says what is wrong with it
  const FileLock lock(path);
  Database database(path, Database::Mode::create);
  if (database.number("PRAGMA user_version") < kTakeSchemaVersion)
    throw Error("{}: is a take of an earlier version of Marey; bring it up to date with \"marey convert {} NEW.marey\"", path,
                path);
  database.run("BEGIN IMMEDIATE");
  const EditState now{.head = database.number("SELECT value FROM take WHERE key = 'head'"),
                      .newest = database.number("SELECT max(id) FROM edit")};
  if (now != on) {
    database.roll_back();
    fail_edited_elsewhere(path);
  }
  Statement add(database, "INSERT INTO edit VALUES (?, ?, ?, ?)");
  for (const Edit& edit : more) {
    add.bind(0, edit.id);
    if (edit.parent) {
      add.bind(1, *edit.parent);
    } else {
      add.bind_null(1);
    }
    add.bind(2, std::string_view(edit.operation));
    add.bind(3, std::string_view(edit.payload));
    add.run();
  }
  Statement set(database, "INSERT OR REPLACE INTO take VALUES ('head', ?)");
  set.bind(0, head.value_or(0));
  set.run();
  if (!database.commit()) throw Error("{}: another program holds it; try again", path);
}

}  // namespace marey::format::take
