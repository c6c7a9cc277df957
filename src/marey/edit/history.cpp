#include "marey/edit/history.h"

#include <algorithm>

#include "marey/core/error.h"

namespace marey::edit {
namespace {

const Edit& edit_with(const std::vector<Edit>& edits, std::int64_t id) {
  const auto found = std::find_if(edits.begin(), edits.end(), [&](const Edit& edit) { return edit.id == id; });
  if (found == edits.end()) throw Error("there is no edit {}; `marey edit FILE --list` shows which there are", id);
  return *found;
}

}  // namespace

std::vector<Edit> branch_of(const std::vector<Edit>& edits, std::optional<std::int64_t> head) {
  std::vector<Edit> branch;
  while (head) {
    const Edit& edit = edit_with(edits, *head);
    if (edit.parent && *edit.parent >= edit.id) throw Error("edit {} follows edit {}, which is later", edit.id, *edit.parent);
    branch.push_back(edit);
    head = edit.parent;
  }
  std::reverse(branch.begin(), branch.end());
  return branch;
}

std::optional<std::int64_t> undone(const std::vector<Edit>& edits, std::optional<std::int64_t> head, std::int64_t steps) {
  for (; head && steps > 0; --steps) head = edit_with(edits, *head).parent;
  return head;
}

std::optional<std::int64_t> redone(const std::vector<Edit>& edits, std::optional<std::int64_t> head, std::int64_t steps) {
  for (; steps > 0; --steps) {
    std::optional<std::int64_t> last;
    for (const Edit& edit : edits) {
      if (edit.parent == head && edit.id > last.value_or(0)) last = edit.id;
    }
    if (!last) break;
    head = last;
  }
  return head;
}

std::int64_t next_id(const std::vector<Edit>& edits) {
  std::int64_t last = 0;
  for (const Edit& edit : edits) last = std::max(last, edit.id);
  return last + 1;
}

}  // namespace marey::edit
