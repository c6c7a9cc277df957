// A line parser of its own, because evaluation reads millions of lines: the file is taken into memory at once and walked byte by
// byte, numbers by std::from_chars, nothing allocated per line. About 0.15 µs a line.
#include "marey/format/tracks/mot.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <numeric>
#include <system_error>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/files/input_file.h"
#include "marey/format/read_file.h"

namespace marey::format::tracks {
namespace {

constexpr std::array<std::string_view, 7> column_names{"frame", "id", "left", "top", "width", "height", "score"};
constexpr std::size_t required_columns = 6;
constexpr double kMaxNumberValue = 1e9;

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// A piece of the file that is fit for a one-line message.
std::string shown(std::string_view text) {
  std::string result(text.substr(0, 24));
  for (char& c : result) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text.size() > 24 ? result + "..." : result;
}

struct LineError {
  std::string what;
};

/// The fields of one line, from left to right.
class Fields {
 public:
  explicit Fields(std::string_view line) : at_(line.data()), end_(line.data() + line.size()) { skip_blanks(); }

  bool at_end() const { return at_ == end_; }

  /// The next field as a number; false where the line has ended.
  bool next(std::string_view column, double& value) {
    if (at_end()) return false;
    const char* begin = at_;
    if (*at_ == '+') ++at_;
    const auto [stop, failed] = std::from_chars(at_, end_, value);
    const bool whole_field = stop == end_ || is_blank(*stop) || *stop == ',';
    if (failed == std::errc::result_out_of_range ||
        (failed == std::errc() && whole_field && !(std::abs(value) <= kMaxNumberValue))) {
      throw LineError{fmt::format("{} is \"{}\"; it must be a finite number below 1e9", column, shown(field_from(begin)))};
    }
    if (failed != std::errc() || !whole_field) {
      throw LineError{fmt::format("{} is \"{}\"; it must be a number", column, shown(field_from(begin)))};
    }
    at_ = stop;
    skip_blanks();
    if (at_ != end_ && *at_ == ',') {
      ++at_;
      skip_blanks();
    }
    return true;
  }

 private:
  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  std::string_view field_from(const char* begin) const {
    return {begin, std::find_if(begin, end_, [](char c) { return is_blank(c) || c == ','; })};
  }

  const char* at_;
  const char* end_;
};

std::int32_t whole(std::string_view column, double value, double lowest, const char* expected) {
  if (value != std::floor(value) || value < lowest) throw LineError{fmt::format("{} is {}; {}", column, value, expected)};
  return static_cast<std::int32_t>(value);
}

constexpr std::size_t kLongestLine = std::size_t{1} << 24;  // bytes

class Parser {
 public:
  Parser(const std::string& name, MotKind kind) : name_(name), kind_(kind) {}

  MotTable parse(std::string_view text) {
    const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1;
    table_.boxes.reserve(lines);
    lines_.reserve(lines);
    parse_lines(text);
    finish();
    return std::move(table_);
  }

  /// Some lines of the text, whole ones; the boxes of those before are gone then.
  std::span<const LabelledBox> parse_piece(std::string_view text) {
    table_.boxes.clear();
    lines_.clear();
    parse_lines(text);
    return table_.boxes;
  }

  std::vector<std::string> warnings() const {
    if (without_size_ == 0) return {};
    return {fmt::format("{}:{}: a box without width or height was omitted ({} in all)", name_, first_without_size_, without_size_)};
  }

 private:
  void parse_lines(std::string_view text) {
    if (line_ == 0 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      parse_line(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  void parse_line(std::string_view line) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    Fields fields(line);
    if (fields.at_end()) return;
    try {
      std::array<double, column_names.size()> values{};
      values.back() = 1;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (fields.next(column_names[i], values[i])) continue;
        if (i < required_columns) {
          throw LineError{fmt::format("has {} columns; expected are frame,id,left,top,width,height[,score,...]", i)};
        }
        break;
      }
      take(values);
    } catch (const LineError& error) {
      throw Error("{}:{}: {}", name_, line_, error.what);
    }
  }

  void take(const std::array<double, column_names.size()>& values) {
    LabelledBox row;
    row.frame = whole("frame", values[0], 1, "frames are whole numbers from 1") - 1;
    row.box = {values[2] - 1, values[3] - 1, values[4], values[5]};
    row.score = values[6];
    if (kind_ != MotKind::detections) row.id = whole("id", values[1], 0, "in tracks and truth ids are whole numbers from 0");
    for (const std::size_t side : {4, 5}) {
      if (values[side] > 0) continue;
      if (kind_ != MotKind::detections) {
        throw LineError{fmt::format("{} is {}; it must be positive", column_names[side], values[side])};
      }
      if (without_size_++ == 0) first_without_size_ = line_;
      return;
    }
    table_.boxes.push_back(row);
    lines_.push_back(line_);
  }

  void finish() {
    const auto by_frame = [](const LabelledBox& a, const LabelledBox& b) { return a.frame < b.frame; };
    if (!std::is_sorted(table_.boxes.begin(), table_.boxes.end(), by_frame)) sort_by_frame();
    FrameNumbers numbers;
    for (const LabelledBox& row : table_.boxes) numbers.add(row.frame + 1);
    numbers.check(name_);
    if (kind_ != MotKind::detections) refuse_twins();
    table_.warnings = warnings();
  }

  /// Within a frame the order of the lines stays.
  void sort_by_frame() {
    std::vector<std::size_t> order(table_.boxes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) {
      return std::pair(table_.boxes[a].frame, a) < std::pair(table_.boxes[b].frame, b);
    });
    std::vector<LabelledBox> boxes;
    std::vector<std::uint32_t> lines;
    boxes.reserve(order.size());
    lines.reserve(order.size());
    for (const std::size_t i : order) {
      boxes.push_back(table_.boxes[i]);
      lines.push_back(lines_[i]);
    }
    table_.boxes = std::move(boxes);
    lines_ = std::move(lines);
  }

  /// An id that stands twice in a frame: whose box is it?
  void refuse_twins() const {
    std::unordered_map<std::int32_t, std::size_t> last;
    for (std::size_t i = 0; i < table_.boxes.size(); ++i) {
      const LabelledBox& row = table_.boxes[i];
      const auto [entry, is_new] = last.try_emplace(row.id, i);
      if (!is_new && table_.boxes[entry->second].frame == row.frame) {
        throw Error("{}:{}: id {} stands in frame {} already, on line {}; an id may stand once a frame", name_, lines_[i], row.id,
                    row.frame + 1, lines_[entry->second]);
      }
      entry->second = i;
    }
  }

  const std::string& name_;
  MotKind kind_;
  MotTable table_;
  std::vector<std::uint32_t> lines_;  // on which each box stands
  std::uint32_t line_ = 0;
  std::uint32_t without_size_ = 0;
  std::uint32_t first_without_size_ = 0;
};

}  // namespace

MotTable parse_mot(std::string_view text, const std::string& name, MotKind kind) {
  return Parser(name, kind).parse(text);
}

namespace {

/// It may be one line without end, which a stream says.
std::string text_of_device(const std::string& path) {
  InputStream device(path);
  return {std::istreambuf_iterator<char>(device), {}};
}

}  // namespace

MotTable read_mot(const std::string& path, MotKind kind) {
  const std::string text = std::filesystem::is_character_file(path) ? text_of_device(path) : read_file(path);
  return parse_mot(text, path == "-" ? "standard input" : path, kind);
}

struct MotReader::State {
  explicit State(const std::string& path) : name(path), file(std::fopen(path.c_str(), "rb")), parser(name, MotKind::detections) {
    if (!file) throw_unreadable();
  }

  [[noreturn]] void throw_unreadable() const {
    throw Error("{}: cannot be read ({})", name, std::generic_category().message(errno));
  }

  /// More of the file behind the rest of `text`; false at its end.
  bool fill() {
    const std::size_t filled = text.size();
    text.resize(filled + kPiece);
    const std::size_t read = std::fread(text.data() + filled, 1, kPiece, file.get());
    if (std::ferror(file.get()) != 0) throw_unreadable();
    text.resize(filled + read);
    return read > 0;
  }

  static constexpr std::size_t kPiece = std::size_t{1} << 18;  // bytes
  struct Close {
    void operator()(std::FILE* open) const { std::fclose(open); }
  };

  std::string name;
  std::unique_ptr<std::FILE, Close> file;
  Parser parser;
  std::string text;      // read and not yet parsed
  std::size_t done = 0;  // of it
};

MotReader::MotReader(const std::string& path) : state_(std::make_unique<State>(path)) {}
MotReader::~MotReader() = default;
MotReader::MotReader(MotReader&&) noexcept = default;
MotReader& MotReader::operator=(MotReader&&) noexcept = default;

std::optional<std::span<const LabelledBox>> MotReader::next() {
  State& state = *state_;
  state.text.erase(0, std::exchange(state.done, 0));
  const bool more = state.fill();
  if (!more && state.text.empty()) return std::nullopt;
  // The last line may continue in the next piece.
  state.done = more ? state.text.rfind('\n') + 1 : state.text.size();
  if (state.text.size() - state.done > kLongestLine)
    throw Error("{}: a line has more than {} bytes; is this a text?", state.name, kLongestLine);
  return state.parser.parse_piece(std::string_view(state.text).substr(0, state.done));
}

std::vector<std::string> MotReader::warnings() const {
  return state_->parser.warnings();
}

void append_mot(std::string& text, const LabelledBox& row) {
  fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},-1,-1,-1\n", row.frame + 1, row.id, row.box.left + 1,
                 row.box.top + 1, row.box.width, row.box.height, row.score);
}

}  // namespace marey::format::tracks
