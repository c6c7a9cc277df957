// MOTS text: Voigtlaender et al., "MOTS: Multi-Object Tracking and Segmentation", CVPR 2019; its runs as in COCO's maskApi.c.
#include "marey/format/tracks/mots.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/text_rows.h"

namespace marey::format::tracks {
namespace {

constexpr int kIgnored = 10;       // class of regions that are not evaluated
constexpr int kMaxSide = 100'000;  // px
constexpr int kMaxNumber = 1'000'000'000;

/// The next field of a line, blanks between.
std::string_view next_field(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view field = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return field;
}

int whole_field(std::string_view& line, const char* name, int minimum, int maximum, const std::string& where) {
  const std::string_view field = next_field(line);
  int value = 0;
  const auto [end, code] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (code != std::errc() || end != field.data() + field.size() || value < minimum || value > maximum) {
    throw Error("{}: column {} is not a whole number from {} to {}; expected frame id class height width runs", where, name,
                minimum, maximum);
  }
  return value;
}

}  // namespace

std::string compressed_runs(const RunMask& mask) {
  std::string text;
  for (std::size_t i = 0; i < mask.runs.size(); ++i) {
    std::int64_t value = mask.runs[i];
    if (i > 2) value -= mask.runs[i - 2];
    for (bool more = true; more;) {
      std::int64_t bits = value & 0x1f;
      value >>= 5;
      more = (bits & 0x10) != 0 ? value != -1 : value != 0;
      if (more) bits |= 0x20;
      text += static_cast<char>(bits + 48);
    }
  }
  return text;
}

RunMask mask_of_compressed(std::string_view text, int width, int height) {
  const std::int64_t all = std::int64_t{width} * height;
  RunMask mask{width, height, {}};
  std::int64_t sum = 0;
  for (std::size_t at = 0; at < text.size();) {
    std::int64_t value = 0;
    int shift = 0;
    for (bool more = true; more;) {
      if (at == text.size() || text[at] < 48 || text[at] > 111 || shift > 35) throw Error("malformed runs of a mask");
      const std::int64_t bits = text[at++] - 48;
      value |= (bits & 0x1f) << shift;
      shift += 5;
      more = (bits & 0x20) != 0;
      if (!more && (bits & 0x10) != 0) value |= -(std::int64_t{1} << shift);
    }
    if (mask.runs.size() > 2) value += mask.runs[mask.runs.size() - 2];
    if (value < 0 || value > all - sum) throw Error("runs of a mask beyond its {} x {} pixels", width, height);
    sum += value;
    mask.runs.push_back(static_cast<std::uint32_t>(value));
  }
  if (sum != all) throw Error("runs of a mask that cover {} of its {} x {} pixels", sum, width, height);
  return mask;
}

MaskTable parse_mots(std::string_view text, const std::string& path) {
  MaskTable table;
  std::set<std::pair<std::int32_t, std::int32_t>> known;
  for_each_line(text, path, [&](std::string_view line, const std::string& where) {
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) return;
    LabelledMask mask;
    mask.frame = whole_field(line, "1 (frame)", 1, kMaxNumber, where) - 1;
    mask.id = whole_field(line, "2 (id)", 0, kMaxNumber, where);
    const int kind = whole_field(line, "3 (class)", 0, kMaxNumber, where);
    const int height = whole_field(line, "4 (height)", 1, kMaxSide, where);
    const int width = whole_field(line, "5 (width)", 1, kMaxSide, where);
    try {
      mask.mask = mask_of_compressed(next_field(line), width, height);
    } catch (const Error& error) {
      throw Error("{}: {}; expected COCO's compressed runs in column 6", where, error.what());
    }
    if (kind != kIgnored && !known.emplace(mask.frame, mask.id).second) {
      throw Error("{}: id {} is twice in frame {}; expected once", where, mask.id, mask.frame + 1);
    }
    (kind == kIgnored ? table.ignored : table.masks).push_back(std::move(mask));
  });
  const auto by_frame = [](const LabelledMask& a, const LabelledMask& b) {
    return std::pair(a.frame, a.id) < std::pair(b.frame, b.id);
  };
  std::stable_sort(table.masks.begin(), table.masks.end(), by_frame);
  std::stable_sort(table.ignored.begin(), table.ignored.end(), by_frame);
  return table;
}

bool is_mots_text(std::string_view text) {
  std::string_view line = text.substr(0, text.find('\n'));
  try {
    for (const char* name : {"frame", "id", "class"}) whole_field(line, name, 0, kMaxNumber, {});
    const int height = whole_field(line, "height", 1, kMaxSide, {}), width = whole_field(line, "width", 1, kMaxSide, {});
    mask_of_compressed(next_field(line), width, height);
    return next_field(line).empty();
  } catch (const Error&) {
    return false;
  }
}

void append_mots(std::string& text, const LabelledMask& mask, int kind) {
  fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {}\n", mask.frame + 1, mask.id, kind, mask.mask.height, mask.mask.width,
                 compressed_runs(mask.mask));
}

}  // namespace marey::format::tracks
