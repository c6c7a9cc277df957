// A C3D file is blocks of 512 bytes: a header, a section of parameters that the header points to, and frames. The parameters are a
// list whose links are offsets; real files have sections at odd places, wrong counts of blocks, groups after their parameters,
// numbers too many or too few, so nothing is trusted that can be seen from the file itself. Reference: C3D.org, "The C3D File
// Format User Guide" (2008).
#include "marey/format/motion/c3d_parameters.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdlib>
#include <utility>

#include "marey/core/error.h"
#include "marey/format/text_rows.h"

namespace marey::format::motion {
namespace {

constexpr std::uint8_t kKey = 0x50;
constexpr std::size_t kMaxParameters = 20'000;
constexpr std::size_t kMostValues = std::size_t{1} << 20;  // eight times what 255 blocks can hold

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

std::string trimmed(std::string_view text) {
  const std::size_t end = text.find('\0');
  if (end != std::string_view::npos) text = text.substr(0, end);
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

/// Walks the list of groups and parameters.
class ParameterWalk {
 public:
  ParameterWalk(const C3dBytes& bytes, std::size_t begin, std::size_t end, C3dHead& head)
      : bytes_(bytes), at_(begin), end_(end), head_(head) {}

  void run() {
    while (parameters_.size() < kMaxParameters && step()) {
    }
    if (parameters_.size() == kMaxParameters) warn("its parameters have no end");
    for (auto& [key, parameter] : parameters_) {
      const auto group = groups_.find(key.first);
      if (group != groups_.end()) head_.parameters.try_emplace(group->second + ":" + key.second, std::move(parameter));
    }
  }

 private:
  /// One group or parameter; false at the end of the list.
  bool step() {
    if (!has(2)) return false;
    const auto name_length = static_cast<std::size_t>(std::abs(static_cast<std::int8_t>(bytes_.byte(at_))));
    const int id = static_cast<std::int8_t>(bytes_.byte(at_ + 1));
    // A group without a name is legal (BTS writes one); a parameter without one is the end.
    if (name_length == 0 && id >= 0) return false;
    if (!has(2 + name_length + 2)) return warn("its parameters are cut off");
    const std::string written = trimmed(bytes_.text(at_ + 2, name_length)), name = upper(written);
    const std::size_t link = at_ + 2 + name_length;
    const std::size_t offset = bytes_.word(link);
    if (id < 0) {
      groups_.try_emplace(-id, name);
    } else {
      parameter(id, written, link + 2);
    }
    if (offset == 0) return false;
    // A link that leads out of the section ends the list too: files are written so.
    if (offset < 2 || link + offset > end_) return false;
    at_ = link + offset;
    return true;
  }

  void parameter(int group, const std::string& written, std::size_t at) {
    const std::string name = upper(written);
    if (at + 2 > end_) return;
    const int type = static_cast<std::int8_t>(bytes_.byte(at));
    const std::size_t dimensions = bytes_.byte(at + 1);
    at += 2;
    if (dimensions > 7 || at + dimensions > end_) {
      warn("parameter " + shown(name) + " is damaged");
      return;
    }
    std::size_t count = 1;
    for (std::size_t i = 0; i < dimensions && count <= kMostValues; ++i) count *= bytes_.byte(at + i);
    const std::size_t width = dimensions > 0 ? bytes_.byte(at) : 1;
    std::vector<std::size_t> sizes;
    for (std::size_t i = 0; i < dimensions; ++i) sizes.push_back(bytes_.byte(at + i));
    at += dimensions;
    const std::size_t size = type == 4 ? 4 : type == 2 ? 2 : 1;
    values_ += count;
    if (values_ > kMostValues || at + count * size > end_) {
      warn("parameter " + shown(name) + " is damaged");
      return;
    }
    C3dParameter read = type == -1 ? texts(at, count, width) : numbers(at, count, type);
    read.name = written;
    read.type = type == -1 || type == 2 || type == 4 ? type : 1;
    read.dimensions = std::move(sizes);
    parameters_.try_emplace({group, name}, std::move(read));
  }

  C3dParameter texts(std::size_t at, std::size_t count, std::size_t width) const {
    C3dParameter parameter;
    for (std::size_t i = 0; width > 0 && i + width <= count; i += width) {
      parameter.texts.push_back(trimmed(bytes_.text(at + i, width)));
    }
    return parameter;
  }

  C3dParameter numbers(std::size_t at, std::size_t count, int type) const {
    C3dParameter parameter;
    for (std::size_t i = 0; i < count; ++i) {
      if (type == 4) {
        parameter.numbers.push_back(bytes_.real(at + 4 * i));
      } else if (type == 2) {
        parameter.numbers.push_back(bytes_.integer(at + 2 * i));
      } else {
        parameter.numbers.push_back(static_cast<std::int8_t>(bytes_.byte(at + i)));
      }
    }
    return parameter;
  }

  bool has(std::size_t length) const { return at_ + length <= end_; }
  bool warn(std::string message_text) {
    head_.warnings.push_back(std::move(message_text));
    return false;
  }

  const C3dBytes& bytes_;
  std::size_t at_, end_;
  C3dHead& head_;
  std::size_t values_ = 0;  // in all parameters, which may overlap in a damaged file
  std::map<int, std::string> groups_;
  std::map<std::pair<int, std::string>, C3dParameter> parameters_;
};

template <typename Value>
std::vector<Value> all_parts(const std::map<std::string, C3dParameter, std::less<>>& parameters, std::string_view name,
                             std::vector<Value> C3dParameter::* values) {
  std::vector<Value> all;
  for (int part = 1;; ++part) {
    const auto found = parameters.find(part == 1 ? std::string(name) : fmt::format("{}{}", name, part));
    if (found == parameters.end()) return all;
    all.insert(all.end(), (found->second.*values).begin(), (found->second.*values).end());
  }
}

C3dProcessor processor_of(std::uint8_t mark, C3dHead& head) {
  if (mark == 84 || mark == 85 || mark == 86) return static_cast<C3dProcessor>(mark);
  head.warnings.push_back("it does not specify whose numbers it holds; a PC's are assumed");
  return C3dProcessor::intel;
}

}  // namespace

float C3dBytes::real(std::size_t at) const {
  const std::uint32_t a = byte(at), b = byte(at + 1), c = byte(at + 2), d = byte(at + 3);
  switch (processor_) {
    case C3dProcessor::sgi:
      return std::bit_cast<float>(a << 24 | b << 16 | c << 8 | d);
    case C3dProcessor::dec:
      // VAX F floating: the more significant word first, and an exponent that is greater by two.
      return (b & 0x7f) == 0 && (a & 0x80) == 0 ? 0.0F : std::bit_cast<float>(b << 24 | a << 16 | d << 8 | c) / 4;
    case C3dProcessor::intel:
      break;
  }
  return std::bit_cast<float>(d << 24 | c << 16 | b << 8 | a);
}

std::optional<double> C3dHead::number(std::string_view name, std::size_t index) const {
  const auto found = parameters.find(name);
  if (found == parameters.end() || found->second.numbers.size() <= index) return std::nullopt;
  return found->second.numbers[index];
}

std::string C3dHead::text(std::string_view name) const {
  const auto found = parameters.find(name);
  return found == parameters.end() || found->second.texts.empty() ? std::string() : found->second.texts.front();
}

std::vector<std::string> C3dHead::texts(std::string_view name) const {
  return all_parts(parameters, name, &C3dParameter::texts);
}

std::vector<double> C3dHead::numbers(std::string_view name) const {
  return all_parts(parameters, name, &C3dParameter::numbers);
}

C3dHead read_c3d_head(std::span<const std::byte> bytes, const std::string& name) {
  const C3dBytes plain(bytes, C3dProcessor::intel);
  if (bytes.size() < 2 || plain.byte(1) != kKey) throw Error("{}: is not a C3D file (its second byte is not 0x50)", name);
  // A pointer of 0 is a mistake that some programs make, and means the typical place.
  const std::size_t section = (plain.byte(0) == 0 ? 1 : plain.byte(0) - std::size_t{1}) * kC3dBlock;
  if (bytes.size() < kC3dBlock || section + 4 > bytes.size()) {
    throw Error("{}: is cut off within its header ({} bytes); copy it again", name, bytes.size());
  }
  C3dHead head;
  head.processor = processor_of(plain.byte(section + 3), head);
  const C3dBytes own(bytes, head.processor);
  head.points = own.word(2);
  head.analog_words = own.word(4);
  head.first_frame = own.word(6);
  head.last_frame = own.word(8);
  head.scale = own.real(12);
  head.data_block = own.word(16);
  head.analog_samples = own.word(18);
  head.rate_hz = own.real(20);
  // Some lists have no end but where the frames begin.
  const std::size_t data = head.data_block * kC3dBlock;
  const std::size_t end = data > section + kC3dBlock ? std::min(data - kC3dBlock, bytes.size()) : bytes.size();
  ParameterWalk(own, section + 4, end, head).run();
  return head;
}

}  // namespace marey::format::motion
