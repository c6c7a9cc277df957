// What a C3D file says of itself twice often differs, and 16-bit counts run over. The layout is therefore chosen by what fits into
// the file: each count has its sources in the order of trust, and the first that fits wins.
#include "marey/format/motion/c3d_layout.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/motion/length_unit.h"

namespace marey::format::motion {
namespace {

/// A 16-bit count that was meant without sign.
std::int64_t unsigned_word(double value) {
  return value < 0 && value >= -32768 ? static_cast<std::int64_t>(value) + 65536 : std::llround(value);
}

/// TRIAL's fields are two words, the lower one first.
std::optional<std::int64_t> field(const C3dHead& head, std::string_view name) {
  const auto low = head.number(name, 0);
  if (!low || !std::isfinite(*low) || std::abs(*low) > 1e15) return std::nullopt;
  const auto high = head.number(name, 1);
  const std::int64_t value = unsigned_word(*low) + (high && std::isfinite(*high) ? unsigned_word(*high) * 65536 : 0);
  if (value <= 0) return std::nullopt;
  return value;
}

/// Finds the layout from the head and from how long the file is.
class LayoutFinder {
 public:
  LayoutFinder(const C3dHead& head, std::size_t size, const std::string& name) : head_(head), size_(size), name_(name) {}

  C3dLayout find() {
    find_scale();
    find_unit();
    find_begin();
    find_bodies();
    find_counts();
    find_analog();
    find_frames();
    if (layout_.frames == 0) layout_.analog_channels = layout_.analog_samples = 0;  // a count that no bytes bound
    return std::move(layout_);
  }

 private:
  void find_scale() {
    const auto parameter = head_.number("POINT:SCALE");
    double scale = parameter && std::isfinite(*parameter) ? *parameter : 0;
    if (scale == 0 && std::isfinite(head_.scale)) scale = head_.scale;
    if (scale == 0) {
      layout_.warnings.push_back("its scale is missing; floats in the file's unit are assumed");
      scale = -1;
    }
    layout_.real = scale < 0;
    layout_.scale = std::abs(scale);
  }

  void find_unit() {
    const std::string unit = head_.text("POINT:UNITS");
    const auto metres = metres_of_unit(unit);
    if (!metres) {
      layout_.warnings.push_back(unit.empty() ? std::string("it does not specify its unit; mm is assumed")
                                              : "its unit \"" + unit.substr(0, 20) + "\" is not known; mm is assumed");
    }
    layout_.unit_m = metres.value_or(0.001);
  }

  void find_begin() {
    std::size_t block = head_.data_block;
    const auto parameter = head_.number("POINT:DATA_START");
    const std::size_t other = parameter && *parameter >= 1 && *parameter <= 65535 ? static_cast<std::size_t>(*parameter) : 0;
    if (block < 2 || (block - 1) * kC3dBlock > size_) block = other;
    if (block < 2) throw Error("{}: does not specify where its frames begin; it is damaged", name_);
    layout_.begin = (block - 1) * kC3dBlock;
  }

  /// Of what the file says twice and differently: what ends where the file does. Where both do, or neither, the parameters are
  /// trusted about the points, and the first block about the analog values.
  void find_counts() {
    std::vector<std::size_t> points = {head_.points}, words = {words_of_first_block()};
    const auto used = head_.number("POINT:USED");
    if (used && std::isfinite(*used) && std::abs(*used) <= 65535)
      points.insert(points.begin(), static_cast<std::size_t>(unsigned_word(*used)));
    if (const auto other = words_of_parameters()) words.push_back(*other);
    if (const std::size_t samples = head_.analog_samples; samples > 0) words.push_back(count("ANALOG:USED", 1'000'000) * samples);
    layout_.points = points.front();
    layout_.analog_words = words.front();
    const bool fits = choose_by_length(points, words);
    if (points.front() != points.back())
      layout_.warnings.push_back(
          fmt::format("it names {} points in one place and {} in another; {}", points.front(), points.back(),
                      layout_.points == points.front() ? "the first is trusted" : "its length fits the second"));
    if (words.size() > 1 && words_of_parameters().value_or(words.front()) != words.front())
      layout_.warnings.push_back(fmt::format(
          "its first block names {} analog values a frame, and its rates of analog values and of points make {}; {}", words.front(),
          *words_of_parameters(),
          !fits ? "its length fits neither, and the first is trusted" : fmt::format("its length fits {}", layout_.analog_words)));
  }

  /// False where no pair of counts ends with the file; then nothing is changed.
  bool choose_by_length(std::span<const std::size_t> points, std::span<const std::size_t> words) {
    for (const std::size_t w : words) {
      for (const std::size_t p : points) {
        if (!ends_with_file(p, w)) continue;
        layout_.points = p;
        layout_.analog_words = w;
        return true;
      }
    }
    return false;
  }

  /// Whether this many frames as the file names end in its last block.
  bool ends_with_file(std::size_t points, std::size_t analog_words) const {
    const std::size_t bytes = layout_.word() * (4 * points + analog_words), end = end_of_frames();
    if (bytes == 0 || end <= layout_.begin) return false;
    const std::size_t room = end - layout_.begin;
    const auto counts = named_counts();
    return std::any_of(counts.begin(), counts.end(), [&](std::int64_t count) {
      const auto frames = static_cast<std::size_t>(std::max<std::int64_t>(0, count));
      return frames > 0 && frames <= room / bytes && room - frames * bytes < kC3dBlock;
    });
  }

  /// Where the bytes end that frames may have.
  std::size_t end_of_frames() const {
    return layout_.bodies == 0 || layout_.bodies_begin <= layout_.begin ? size_ : layout_.bodies_begin;
  }

  /// Samples of a channel in a frame by the rates that the parameters name.
  std::optional<double> samples_of_rates() const {
    const double analog = head_.number("ANALOG:RATE").value_or(0);
    const double points = head_.number("POINT:RATE").value_or(static_cast<double>(head_.rate_hz));
    if (!(analog > 0) || !(points > 0) || !std::isfinite(analog / points) || analog / points > 1e9) return std::nullopt;
    return analog / points;
  }

  std::optional<std::size_t> words_of_parameters() const {
    const double samples = std::round(samples_of_rates().value_or(0)), used = head_.number("ANALOG:USED").value_or(0);
    if (!(used > 0) || !(samples >= 1) || !(used * samples < 1e9)) return std::nullopt;
    return static_cast<std::size_t>(used * samples);
  }

  /// A count of more than 16 bits has turned over: the parameters know.
  std::size_t words_of_first_block() const {
    const std::size_t words = words_of_parameters().value_or(0);
    return words > 65535 && static_cast<std::uint16_t>(words) == head_.analog_words ? words : head_.analog_words;
  }

  /// Channels and how often they are sampled in a frame: what the parameters and the first block say must make the words there are.
  void find_analog() {
    const std::size_t words = layout_.analog_words;
    if (words == 0) return;
    const std::size_t used = count("ANALOG:USED", 1'000'000), samples = head_.analog_samples;
    if (used > 0 && words % used == 0) {
      layout_.analog_channels = used;
    } else if (samples > 0 && words % samples == 0) {
      layout_.analog_channels = words / samples;
    } else {
      layout_.warnings.push_back(
          fmt::format("it names {} analog channels, and has {} values of them a frame; they are skipped", used, words));
      return;
    }
    layout_.analog_samples = words / layout_.analog_channels;
  }

  std::size_t count(std::string_view parameter, double maximum) const {
    const double value = head_.number(parameter).value_or(0);
    return std::isfinite(value) && std::abs(value) <= maximum ? static_cast<std::size_t>(unsigned_word(value)) : 0;
  }

  void find_bodies() {
    layout_.bodies = count("ROTATION:USED", 65535);
    if (layout_.bodies == 0) return;
    layout_.bodies_ratio = std::max<std::size_t>(1, count("ROTATION:RATIO", 1000));
    const std::size_t block = count("ROTATION:DATA_START", 1e12);
    layout_.bodies_begin = block < 2 ? size_ : (block - 1) * kC3dBlock;
    if (layout_.bodies_begin < size_) return;
    layout_.warnings.emplace_back("where the matrices of its bodies begin there is nothing; they are omitted");
    layout_.bodies = 0;
  }

  /// Counts of frames that the file names, the most trusted first.
  std::vector<std::int64_t> named_counts() const {
    std::vector<std::int64_t> counts;
    const auto start = field(head_, "TRIAL:ACTUAL_START_FIELD"), end = field(head_, "TRIAL:ACTUAL_END_FIELD");
    if (start && end && *end >= *start) counts.push_back(*end - *start + 1);
    for (const char* name : {"POINT:LONG_FRAMES", "POINT:FRAMES"}) {
      const auto frames = head_.number(name);
      if (frames && std::isfinite(*frames) && std::abs(*frames) < 1e12 && *frames != 0) counts.push_back(unsigned_word(*frames));
    }
    if (head_.last_frame > 0 && head_.last_frame >= head_.first_frame) counts.push_back(head_.last_frame - head_.first_frame + 1);
    return counts;
  }

  void find_frames() {
    const std::int64_t first = field(head_, "TRIAL:ACTUAL_START_FIELD").value_or(head_.first_frame);
    layout_.first_index = std::max<std::int64_t>(first - 1, 0);
    const std::int64_t of_bodies =
        layout_.bodies == 0 ? -1 : static_cast<std::int64_t>((size_ - layout_.bodies_begin) / layout_.bodies_bytes());
    const std::size_t bytes = layout_.frame_bytes() > 0 ? layout_.frame_bytes() : layout_.bodies_bytes();
    if (bytes == 0) return;
    const std::size_t end = end_of_frames();
    const auto there =
        layout_.frame_bytes() == 0 ? of_bodies : static_cast<std::int64_t>(end > layout_.begin ? (end - layout_.begin) / bytes : 0);
    const std::vector<std::int64_t> counts = named_counts();
    if (counts.empty()) return;
    const auto fits = std::find_if(counts.begin(), counts.end(), [&](std::int64_t count) { return count <= there; });
    if (fits == counts.end()) return count_what_is_there(counts, there, of_bodies);
    layout_.frames = static_cast<std::size_t>(*fits);
    if (fits != counts.begin()) layout_.warnings.push_back(fmt::format("it names {} frames, but holds {}", counts.front(), *fits));
    count_beyond_16_bits(*fits, there, bytes);
    require_matrices(of_bodies);
  }

  /// A count that ran over its 16 bits, or stopped at their end, where the frames continue for as long as a whole turn.
  void count_beyond_16_bits(std::int64_t named, std::int64_t there, std::size_t bytes) {
    if (named > 65535 || there <= 65535) return;
    const std::int64_t rotated = named + (there - named) / 65536 * 65536;
    const bool ends_there = static_cast<std::size_t>(there - rotated) * bytes < kC3dBlock;
    if (named != 65535 && !(rotated > named && ends_there)) return;
    layout_.frames = static_cast<std::size_t>(named == 65535 ? there : rotated);
    layout_.warnings.push_back(fmt::format("it names {} frames, which is as far as it counts; it holds {}", named, layout_.frames));
  }

  /// What the file holds where it is shorter than any count it names. Throws Error if it holds nothing.
  void count_what_is_there(const std::vector<std::int64_t>& counts, std::int64_t there, std::int64_t of_bodies) {
    const std::int64_t named = *std::min_element(counts.begin(), counts.end());
    if (there <= 0) throw Error("{}: is cut off: it names {} frames and holds {}; copy it again", name_, named, there);
    layout_.frames = static_cast<std::size_t>(there);
    // 65535 (or -1) stands for "more than can be said", even where it is less.
    layout_.warnings.push_back(
        counts.front() == 65535
            ? fmt::format("it does not specify how many frames it holds; there are {}", there)
            : fmt::format("is cut off: it names {} frames and holds {}, which are read; copy it again to have them all", named,
                          there));
    require_matrices(of_bodies);
  }

  /// A file that ends among the matrices of its bodies has as many frames as it has matrices.
  void require_matrices(std::int64_t of_bodies) {
    if (of_bodies < 0 || of_bodies >= static_cast<std::int64_t>(layout_.frames)) return;
    if (of_bodies == 0)
      throw Error("{}: is cut off: it has {} frames and no matrix of its bodies; copy it again", name_, layout_.frames);
    layout_.warnings.push_back(
        fmt::format("is cut off: it has {} frames and the matrices of {}, which are read; copy it again to have them all",
                    layout_.frames, of_bodies));
    layout_.frames = static_cast<std::size_t>(of_bodies);
  }

  const C3dHead& head_;
  std::size_t size_;
  const std::string& name_;
  C3dLayout layout_;
};

}  // namespace

C3dLayout c3d_layout(const C3dHead& head, std::size_t size, const std::string& name) {
  return LayoutFinder(head, size, name).find();
}

}  // namespace marey::format::motion
