#include "marey/edit/request.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <span>

#include "marey/core/error.h"
#include "marey/files/limits.h"
#include "marey/files/text_safety.h"

namespace marey::edit {
namespace {

using Kind = Operation::Kind;

constexpr std::string_view kKnown = "rename, swap, split, join, delete, fill, filter, team and turn are known";

struct Word {
  std::string text;
  bool quoted = false;
};

/// Words between blanks, and within them lists between commas, as a list of lists.
std::vector<std::vector<Word>> words_of(std::string_view text) {
  std::vector<std::vector<Word>> words;
  bool open = false;  // within a word
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == ' ' || c == '\t') {
      open = false;
      ++i;
      continue;
    }
    if (!open) words.emplace_back(1);
    open = true;
    if (c == ',') {
      words.back().emplace_back();
      ++i;
    } else if (c == '"') {
      const std::size_t end = text.find('"', i + 1);
      if (end == std::string_view::npos) throw Error("a name begins with \" and does not end");
      words.back().back().text += text.substr(i + 1, end - i - 1);
      words.back().back().quoted = true;
      i = end + 1;
    } else {
      words.back().back().text += c;
      ++i;
    }
  }
  return words;
}

template <typename Number>
std::optional<Number> number_in(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

std::optional<FrameRange> range_in(const Word& word) {
  return word.quoted ? std::nullopt : parse_range(word.text);
}

/// The unread rest of a request.
class Reader {
 public:
  Reader(std::string_view kind, std::span<const std::vector<Word>> words) : kind_(kind), words_(words) {}

  bool ended() const { return words_.empty(); }

  std::vector<std::string> tracks(const char* what) {
    if (ended()) throw Error("{}: {} is missing", kind_, what);
    std::vector<std::string> names;
    for (const Word& word : words_.front()) {
      if (word.text.empty()) throw Error("{}: a name is empty", kind_);
      names.push_back(word.text);
    }
    words_ = words_.subspan(1);
    return names;
  }

  std::string name(const char* what) {
    const std::vector<std::string> names = tracks(what);
    if (names.size() != 1) throw Error("{}: {} is one name; one with commas stands in double quotes", kind_, what);
    return names.front();
  }

  /// The next word, where it is of this kind.
  template <typename Value>
  std::optional<Value> next(std::optional<Value> (*of)(const Word&)) {
    if (ended() || words_.front().size() != 1) return std::nullopt;
    const auto value = of(words_.front().front());
    if (value) words_ = words_.subspan(1);
    return value;
  }

  void end() const {
    if (!ended()) throw Error("{}: \"{}\" is too much", kind_, plain_text(words_.front().front().text));
  }

 private:
  std::string_view kind_;
  std::span<const std::vector<Word>> words_;
};

std::optional<FillMethod> method_in(const Word& word) {
  return word.quoted ? std::nullopt : method_named(word.text);
}

/// "NAME=NUMBER".
std::optional<double> setting_in(const Word& word, std::string_view name, double maximum, std::string_view unit) {
  if (word.quoted || !word.text.starts_with(name) || word.text.size() <= name.size() || word.text[name.size()] != '=')
    return std::nullopt;
  const auto value = number_in<double>(std::string_view(word.text).substr(name.size() + 1));
  if (!value || !(*value > 0 && *value <= maximum))
    throw Error("fill: {} is not one; {} is above 0, up to {:g} {}", plain_text(word.text), name, maximum, unit);
  return value;
}

std::optional<double> longest_in(const Word& word) {
  return setting_in(word, "longest", 60, "s");
}

std::optional<double> within_in(const Word& word) {
  return setting_in(word, "within", 1000, "mm");
}

std::optional<double> cutoff_in(const Word& word) {
  if (word.quoted || word.text.find(':') != std::string::npos) return std::nullopt;
  const auto value = number_in<double>(word.text);
  if (!value || !(*value > 0 && *value <= 10'000))
    throw Error("filter: \"{}\" is not a cut-off; it is in Hz, above 0, or auto", plain_text(word.text));
  return value;
}

std::optional<bool> auto_in(const Word& word) {
  return word.text == "auto" ? std::optional(true) : std::nullopt;
}

std::optional<std::int64_t> frame_in(const Word& word) {
  const auto frame = number_in<std::int64_t>(word.text);
  return frame && *frame >= 0 && *frame < FrameRange::kToTheEnd ? frame : std::nullopt;
}

void read_fill(Reader& words, Request& request) {
  while (!words.ended()) {
    if (const auto frames = words.next(range_in)) {
      request.frames = frames;
    } else if (const auto method = words.next(method_in)) {
      request.method = method;
    } else if (const auto longest = words.next(longest_in)) {
      request.longest_s = *longest;
    } else if (const auto within = words.next(within_in)) {
      request.within_m = *within / 1000;
    } else {
      break;
    }
  }
}

void read_filter(Reader& words, Request& request) {
  if (!words.next(auto_in)) request.cutoff_hz = words.next(cutoff_in);
  request.frames = words.next(range_in);
}

std::string new_name(Reader& words) {
  std::string name = plain_text(words.name("its new name"));
  const std::size_t maximum = Limits::in_force().label_bytes;
  if (name.size() > maximum) throw Error("a name has {} bytes; they have at most {} (the limit label_bytes)", name.size(), maximum);
  return name;
}

void read(Reader& words, Request& request) {
  switch (request.kind) {
    case Kind::rename:
      request.tracks = {words.name("the track")};
      request.label = new_name(words);
      break;
    case Kind::swap:
    case Kind::join:
      request.tracks = {words.name("the first track"), words.name("the second track")};
      if (request.kind == Kind::swap) request.frames = words.next(range_in);
      break;
    case Kind::split: {
      request.tracks = {words.name("the track")};
      const auto frame = words.next(frame_in);
      if (!frame) throw Error("split: the frame from which on it is another track is missing");
      request.frames = {*frame, *frame};
      if (!words.ended()) request.label = new_name(words);
      break;
    }
    case Kind::remove:
      request.tracks = words.tracks("the track");
      request.frames = words.next(range_in);
      break;
    case Kind::fill:
      request.tracks = words.tracks("the track, or all,");
      read_fill(words, request);
      break;
    case Kind::team:
      request.tracks = words.tracks("the track");
      request.label = new_name(words);
      break;
    case Kind::filter:
      request.tracks = words.tracks("the track, or all,");
      read_filter(words, request);
      break;
    case Kind::turn:
      request.tracks = {words.name("the body")};
      request.frames = words.next(range_in);
      break;
  }
  words.end();
}

}  // namespace

std::optional<FrameRange> parse_range(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const std::string_view first = text.substr(0, colon), last = text.substr(colon + 1);
  const auto begin = first.empty() ? std::optional<std::int64_t>(0) : number_in<std::int64_t>(first);
  const auto end = last.empty() ? std::optional<std::int64_t>(FrameRange::kToTheEnd) : number_in<std::int64_t>(last);
  if (!begin || !end) return std::nullopt;
  if (*begin < 0 || *end < *begin || *end > FrameRange::kToTheEnd)
    throw Error("\"{}\" are not frames; write FIRST:LAST, counted from 0", plain_text(text));
  return FrameRange{*begin, *end};
}

Request parse_request(std::string_view text) {
  const std::vector<std::vector<Word>> words = words_of(text);
  if (words.empty()) throw Error("an edit is empty; {}", kKnown);
  const std::string& word = words.front().front().text;
  const auto kind = words.front().size() == 1 ? kind_named(word) : std::nullopt;
  if (!kind) throw Error("\"{}\" is not an edit; {}", plain_text(word), kKnown);
  Request request{.kind = *kind};
  Reader rest(word, std::span(words).subspan(1));
  read(rest, request);
  return request;
}

}  // namespace marey::edit
