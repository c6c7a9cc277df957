// One walk over the bytes for each notation, which knows as much of it as is needed to see where levels begin and end: strings,
// comments, brackets. Uncertain a level is counted: what a scanner trusts to be a comment, a parser may not.
#include "marey/format/nesting.h"

#include <algorithm>
#include <vector>

#include "marey/core/error.h"

namespace marey::format {
namespace {

class Scanner {
 public:
  Scanner(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  void toml();
  void json();
  void xml();

 private:
  bool more() const { return at_ < text_.size(); }
  char here() const { return text_[at_]; }
  bool begins(std::string_view word) const { return text_.substr(at_).starts_with(word); }

  void check(int depth) const {
    if (depth <= kMaxNestingDepth) return;
    const auto line = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size())), '\n') + 1;
    throw Error("{}:{}: is nested more than {} deep, as no file of its kind is; it must be damaged", name_, line, kMaxNestingDepth);
  }

  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
  /// To behind the next `end`; to the end of the text if it is absent.
  void skip_past(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == std::string_view::npos ? text_.size() : found + end.size();
  }
  /// To behind the quote that closes the string which begins here; not beyond the line.
  void skip_string(bool escapes, bool many_lines) {
    const char quote = here();
    for (++at_; more() && here() != quote && (many_lines || here() != '\n'); ++at_) {
      if (escapes && here() == '\\') ++at_;
    }
    at_ = std::min(at_ + 1, text_.size());
  }
  void skip_toml_string();
  void xml_tag(int& depth);

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

bool is_open(char c) {
  return c == '[' || c == '{';
}
bool is_close(char c) {
  return c == ']' || c == '}';
}

void Scanner::skip_toml_string() {
  for (const std::string_view triple : {R"(""")", "'''"}) {
    if (!begins(triple)) continue;
    at_ += 3;
    while (more() && !begins(triple)) at_ += here() == '\\' && triple[0] == '"' ? 2 : 1;
    at_ = std::min(at_ + 3, text_.size());
    return;
  }
  skip_string(here() == '"', false);
}

/// A key's dots are levels of what stands in its value: they are kept for each bracket that is open.
void Scanner::toml() {
  std::vector<int> open;  // the dots before each bracket
  int depth = 0, dots = 0;
  while (more()) {
    const char c = here();
    if (c == '#') {
      skip_line();
      continue;
    }
    if (c == '"' || c == '\'') {
      skip_toml_string();
      continue;
    }
    if (c == '.') {
      check(depth + ++dots);
    } else if (is_open(c)) {
      open.push_back(dots);
      depth += dots + 1;
      dots = 0;
      check(depth);
    } else if (is_close(c) && !open.empty()) {
      depth -= open.back() + 1;
      open.pop_back();
      dots = 0;
    } else if (c == '\n' || c == ',') {
      dots = 0;
    }
    ++at_;
  }
}

void Scanner::json() {
  int depth = 0;
  while (more()) {
    if (here() == '"') {
      skip_string(true, true);
      continue;
    }
    if (is_open(here())) check(++depth);
    if (is_close(here())) depth = std::max(0, depth - 1);
    ++at_;
  }
}

/// From the tag's "<" to behind its ">".
void Scanner::xml_tag(int& depth) {
  if (begins("</")) {
    depth = std::max(0, depth - 1);
    skip_past(">");
    return;
  }
  check(++depth);
  char last = ' ';
  for (++at_; more() && here() != '>' && here() != '<';) {
    if (here() == '"' || here() == '\'') {
      skip_string(false, true);
      last = ' ';
    } else {
      last = text_[at_++];
    }
  }
  if (!more() || here() != '>') return;
  if (last == '/') --depth;
  ++at_;
}

void Scanner::xml() {
  int depth = 0;
  while (more()) {
    at_ = std::min(text_.find('<', at_), text_.size());
    if (begins("<!--")) {
      skip_past("-->");
    } else if (begins("<![CDATA[")) {
      skip_past("]]>");
    } else if (begins("<?")) {
      skip_past("?>");
    } else if (begins("<!")) {
      at_ += 2;  // what a document type declares in brackets counts as elements
    } else if (more()) {
      xml_tag(depth);
    }
  }
}

std::string_view name_of(Notation notation) {
  switch (notation) {
    case Notation::toml:
      return "TOML text";
    case Notation::json:
      return "JSON text";
    case Notation::xml:
      break;
  }
  return "XML text";
}

}  // namespace

bool is_binary(std::string_view text) {
  constexpr std::size_t kBeginning = 4096;  // by definition
  return text.substr(0, kBeginning).find('\0') != std::string_view::npos;
}

void check_nesting(std::string_view text, Notation notation, const std::string& name) {
  if (is_binary(text)) throw Error("{}: is a binary file, as videos and images are; {} is wanted", name, name_of(notation));
  Scanner scanner(text, name);
  switch (notation) {
    case Notation::toml:
      return scanner.toml();
    case Notation::json:
      return scanner.json();
    case Notation::xml:
      return scanner.xml();
  }
}

}  // namespace marey::format
