// BVH as it is met: turns in any order, 0, 3 or 6 channels a joint, several roots, tabs and line endings of any kind, no MOTION at
// all. A joint's rotation is R(ch1)·R(ch2)·R(ch3), its channels in the order they are written; positions take the place of its
// OFFSET.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/format/text_rows.h"

namespace marey::format::skeleton {
namespace {

constexpr std::size_t kMaxJoints = 10'000;
constexpr double kRadians = std::numbers::pi / 180;
constexpr double kMaxDistanceUnits = 1e9;

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && static_cast<unsigned char>(text.front()) <= ' ') text.remove_prefix(1);
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.remove_suffix(1);
  return text;
}

/// The next word; the rest stays.
std::string_view take_word(std::string_view& line) {
  line = without_blanks(line);
  const std::size_t end = std::min(line.find_first_of(" \t\r"), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

class BvhText {
 public:
  BvhText(std::string_view text, std::string name, const SkeletonOptions& options)
      : lines_(text), name_(std::move(name)), options_(options) {}

  SkeletonFile read() {
    if (!next() || !same_word(take_word(rest_), "HIERARCHY")) fail("a BVH file begins with HIERARCHY");
    while (next()) {
      const std::string_view word = take_word(rest_);
      if (same_word(word, "MOTION")) {
        motion();
        break;
      }
      hierarchy(word);
    }
    if (file_.skeleton.segments.empty()) fail("has no joints");
    if (!open_.empty()) fail("ends within a joint; the file is cut off");
    check_names();
    file_.unit_m = options_.unit_m;
    return std::move(file_);
  }

 private:
  struct Channel {
    int coordinate;
    double factor;  ///< from the file's number
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw Error("{}:{}: {}", name_, std::max<std::size_t>(1, lines_.number()), what);
  }

  /// The next line with anything in it.
  bool next() {
    while (lines_.next(rest_)) {
      rest_ = without_blanks(rest_);
      if (!rest_.empty()) return true;
    }
    return false;
  }

  void hierarchy(std::string_view word) {
    if (same_word(word, "ROOT") || same_word(word, "JOINT")) {
      joint(same_word(word, "ROOT"));
    } else if (same_word(word, "End")) {
      if (open_.empty()) fail("an End Site outside any joint");
      in_end_ = true;
      if (rest_.ends_with('{')) open_.push_back(-1);
    } else if (word == "{") {
      if (!in_end_ && pending_ < 0) fail("{ where no joint begins");
      open_.push_back(in_end_ ? -1 : std::exchange(pending_, -1));
    } else if (word == "}") {
      if (open_.empty()) fail("} where nothing is open");
      if (open_.back() == -1) in_end_ = false;
      open_.pop_back();
    } else if (same_word(word, "OFFSET")) {
      offset();
    } else if (same_word(word, "CHANNELS")) {
      channels();
    } else {
      fail(fmt::format("{} is not a word of a BVH file's hierarchy", shown(word)));
    }
  }

  void joint(bool root) {
    if (in_end_) fail("a joint within an End Site");
    if (root != open_.empty()) fail(root ? "a ROOT within a joint" : "a JOINT outside any other");
    if (file_.skeleton.segments.size() >= kMaxJoints) fail(fmt::format("more than {} joints", kMaxJoints));
    std::string_view name = rest_;
    const bool opens = name.ends_with('{');
    if (opens) name.remove_suffix(1);
    Segment segment;
    segment.name = plain_text(without_blanks(name));
    if (segment.name.empty()) fail("a joint without a name");
    if (!open_.empty()) segment.parent = open_.back();
    const int index = static_cast<int>(file_.skeleton.segments.size());
    file_.skeleton.segments.push_back(std::move(segment));
    if (opens) {
      open_.push_back(index);
    } else {
      pending_ = index;
    }
  }

  Segment& current() {
    const auto joint = std::find_if(open_.rbegin(), open_.rend(), [](int i) { return i >= 0; });
    if (joint == open_.rend()) fail("stands outside any joint");
    return file_.skeleton.segments[static_cast<std::size_t>(*joint)];
  }

  double finite_number(std::string_view word) const {
    const auto value = number_of(word);
    if (!value || std::abs(*value) > kMaxDistanceUnits) fail(fmt::format("{} is no number that could stand here", shown(word)));
    return *value;
  }

  void offset() {
    Vector<3> location;
    for (int i = 0; i < 3; ++i) location[i] = finite_number(take_word(rest_)) * options_.unit_m;
    Segment& segment = current();
    if (in_end_) {
      segment.end = location;
      return;
    }
    segment.joint.parent_from_joint.translation = location;
    if (!segment.parent) {
      const Matrix<3> up = z_up_from(options_.up);
      segment.joint.parent_from_joint = {up, up * location};
    }
  }

  void channels() {
    if (in_end_) fail("CHANNELS of an End Site");
    Segment& segment = current();
    if (!segment.joint.axes.empty()) fail(fmt::format("{} has CHANNELS twice", shown(segment.name)));
    const auto count = whole_number_of(take_word(rest_));
    if (!count || *count < 0 || *count > 6) fail("CHANNELS of a joint are 0 to 6");
    std::vector<JointAxis> rotations, shifts;
    for (std::int64_t i = 0; i < *count; ++i) add_channel(segment, take_word(rest_), rotations, shifts);
    // What positions there are take the place of the offset: the joint rests where it is.
    for (const JointAxis& shift : shifts) {
      const Vector<3> in_file = segment.parent
                                    ? segment.joint.parent_from_joint.translation
                                    : Vector<3>(z_up_from(options_.up).transpose() * segment.joint.parent_from_joint.translation);
      file_.skeleton.coordinates[static_cast<std::size_t>(*shift.coordinate)].rest = in_file.dot(shift.axis);
    }
    if (!shifts.empty()) forget_offset(segment, shifts);
    segment.joint.axes = std::move(shifts);
    segment.joint.axes.insert(segment.joint.axes.end(), rotations.begin(), rotations.end());
  }

  void forget_offset(Segment& segment, const std::vector<JointAxis>& shifts) const {
    Rigid3& location = segment.joint.parent_from_joint;
    for (const JointAxis& shift : shifts) {
      const Vector<3> along = location.rotation * shift.axis;
      location.translation -= along * along.dot(location.translation);
    }
  }

  void add_channel(const Segment& segment, std::string_view word, std::vector<JointAxis>& rotations,
                   std::vector<JointAxis>& shifts) {
    const bool turn = word.size() == 9 && same_word(word.substr(1), "rotation"),
               shift = word.size() == 9 && same_word(word.substr(1), "position");
    const int axis = word.empty() ? -1 : std::toupper(static_cast<unsigned char>(word.front())) - 'X';
    if ((!turn && !shift) || axis < 0 || axis > 2) fail(fmt::format("{} is not a channel; Xposition … Zrotation are", shown(word)));
    std::vector<JointAxis>& into = turn ? rotations : shifts;
    if (rotations.size() + shifts.size() >= 6 || into.size() >= 3) fail("more than three turns, or three positions, of one joint");
    const int index = static_cast<int>(file_.skeleton.coordinates.size());
    std::string name = fmt::format("{}_{}{}", segment.name, static_cast<char>('X' + axis), turn ? "rotation" : "position");
    file_.skeleton.coordinates.push_back({std::move(name), turn, 0, {}, {}, false, {}});
    into.push_back({turn, Vector<3>::Unit(axis), {}, index});
    channels_.push_back({index, turn ? kRadians : options_.unit_m});
  }

  void motion() {
    if (!open_.empty()) fail("MOTION within a joint");
    std::optional<std::int64_t> frames;
    double step = 0;
    while (next()) {
      const std::string_view line = rest_;
      if (line.size() > 7 && same_word(line.substr(0, 7), "Frames:")) {
        frames = whole_number_of(without_blanks(line.substr(7)));
      } else if (line.size() > 11 && same_word(line.substr(0, 11), "Frame Time:")) {
        step = finite_number(without_blanks(line.substr(11)));
        break;
      } else {
        fail("MOTION begins with \"Frames:\" and \"Frame Time:\"");
      }
    }
    if (!(step > 1e-6 && step < 1e3)) {
      if (step != 0 || frames.value_or(0) > 1) fail("Frame Time is not a time between frames; write seconds");
      return;
    }
    rows(frames, step);
  }

  void rows(std::optional<std::int64_t> frames, double step) {
    SkeletonMotion motion{.rate_hz = rounded_rate(1 / step), .times = {}, .rows = {}};
    const std::vector<double> rest = file_.skeleton.rest();
    while (next()) {
      std::vector<double> row = rest;
      std::size_t count = 0;
      for (std::string_view word = take_word(rest_); !word.empty(); word = take_word(rest_), ++count) {
        if (count < channels_.size())
          row[static_cast<std::size_t>(channels_[count].coordinate)] = finite_number(word) * channels_[count].factor;
      }
      if (count != channels_.size()) {
        if (count < channels_.size() && !lines_.ended()) {
          file_.warnings.push_back(fmt::format("{}:{}: the last row is cut off; it is omitted", name_, lines_.number()));
          break;
        }
        fail(fmt::format("{} numbers; the hierarchy has {} channels", count, channels_.size()));
      }
      motion.times.push_back(timestamp_from_seconds(static_cast<double>(motion.rows.size()) / motion.rate_hz));
      motion.rows.push_back(std::move(row));
    }
    if (frames && *frames != static_cast<std::int64_t>(motion.rows.size()))
      file_.warnings.push_back(fmt::format("{}: announces {} frames and has {}", name_, *frames, motion.rows.size()));
    if (!motion.rows.empty()) file_.motion = std::move(motion);
  }

  /// Frame Time is often written with few digits: 0.008333 means 120 Hz.
  static double rounded_rate(double rate) {
    const double whole = std::round(rate);
    return whole > 0 && std::abs(rate - whole) < 1e-4 * whole ? whole : rate;
  }

  /// Segments are known by their names: a second one gets a number.
  void check_names() {
    std::map<std::string, int> count;
    for (Segment& segment : file_.skeleton.segments) {
      const int before = count[segment.name]++;
      if (before == 0) continue;
      file_.warnings.push_back(fmt::format("{}: several joints are called {}; one is named {}.{}", name_, shown(segment.name),
                                           segment.name, before + 1));
      segment.name = fmt::format("{}.{}", segment.name, before + 1);
    }
  }

  TextLines lines_;
  std::string_view rest_;
  std::string name_;
  SkeletonOptions options_;
  SkeletonFile file_;
  std::vector<int> open_;  // joints whose braces are open; −1: an End Site
  int pending_ = -1;       // the joint whose brace comes next
  bool in_end_ = false;
  std::vector<Channel> channels_;  // in the order of a row
};

}  // namespace

SkeletonFile parse_bvh(std::string_view text, const std::string& name, const SkeletonOptions& options) {
  return BvhText(text, name, options).read();
}

}  // namespace marey::format::skeleton
