#include "edit_message.h"

#include <array>
#include <utility>

#include "command_tokens.h"

namespace marey::viewer {
namespace {

constexpr std::int64_t kMaxId = 1'000'000'000;

std::optional<EditMessage::Kind> kind_of(std::string_view word) {
  using Kind = EditMessage::Kind;
  constexpr std::array<std::pair<std::string_view, Kind>, 4> kKinds{
      {{"edit", Kind::edit}, {"undo", Kind::undo}, {"redo", Kind::redo}, {"go", Kind::go}}};
  for (const auto& [name, kind] : kKinds) {
    if (word == name) return kind;
  }
  return std::nullopt;
}

}  // namespace

bool queries_for_edit(std::string_view line) {
  return kind_of(next_word(line)).has_value();
}

std::optional<EditMessage> edit_message(std::string_view line) {
  const auto kind = kind_of(next_word(line));
  const auto head = whole_in(next_word(line), 0, kMaxId), newest = whole_in(next_word(line), 0, kMaxId);
  if (!kind || !head || !newest) return std::nullopt;
  EditMessage message{.kind = *kind, .on = {.head = *head, .newest = *newest}};
  if (message.kind == EditMessage::Kind::edit) {
    if (line.size() < 2) return std::nullopt;
    message.text = line.substr(1);
    return message;
  }
  if (message.kind == EditMessage::Kind::go) {
    const auto to = whole_in(next_word(line), 0, kMaxId);
    if (!to) return std::nullopt;
    message.to = *to;
  }
  return next_word(line).empty() ? std::optional(message) : std::nullopt;
}

}  // namespace marey::viewer
