// What a C3D file says of itself twice often differs, and 16-bit counts run over. The layout is therefore chosen by what fits into
// the file: each count has its sources in the order of trust, and the first that fits wins.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "marey/core/error.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_parameters.h"
#include "marey/format/motion/length_unit.h"

namespace marey::format::motion {
namespace {

/// Where the frames are and what they hold.
struct Layout {
  bool real = true;
  double scale = 1;       // file's units a step, of integer coordinates and of residuals
  double unit_m = 0.001;  // a file's unit
  std::size_t begin = 0;  // bytes
  std::size_t points = 0;
  std::size_t analog_words = 0;
  std::size_t frames = 0;
  std::int64_t first_index = 0;

  std::size_t word() const { return real ? 4 : 2; }
  std::size_t frame_bytes() const { return word() * (4 * points + analog_words); }
};

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

  Layout find() {
    find_scale();
    find_unit();
    find_begin();
    find_points();
    find_frames();
    return layout_;
  }
  std::vector<std::string> warnings;

 private:
  void find_scale() {
    const auto parameter = head_.number("POINT:SCALE");
    double scale = parameter && std::isfinite(*parameter) ? *parameter : 0;
    if (scale == 0 && std::isfinite(head_.scale)) scale = head_.scale;
    if (scale == 0) {
      warnings.push_back("its scale is missing; floats in the file's unit are assumed");
      scale = -1;
    }
    layout_.real = scale < 0;
    layout_.scale = std::abs(scale);
  }

  void find_unit() {
    const std::string unit = head_.text("POINT:UNITS");
    const auto metres = metres_of_unit(unit);
    if (!metres) {
      warnings.push_back(unit.empty() ? std::string("it does not say its unit; mm is assumed")
                                      : "its unit \"" + unit.substr(0, 20) + "\" is not known; mm is assumed");
    }
    layout_.unit_m = metres.value_or(0.001);
  }

  void find_begin() {
    std::size_t block = head_.data_block;
    const auto parameter = head_.number("POINT:DATA_START");
    const std::size_t other = parameter && *parameter >= 1 && *parameter <= 65535 ? static_cast<std::size_t>(*parameter) : 0;
    if (block < 2 || (block - 1) * kC3dBlock > size_) block = other;
    if (block < 2) throw Error("{}: does not say where its frames begin; it is damaged", name_);
    layout_.begin = (block - 1) * kC3dBlock;
  }

  void find_points() {
    const auto used = head_.number("POINT:USED");
    layout_.points =
        used && std::isfinite(*used) && std::abs(*used) <= 65535 ? static_cast<std::size_t>(unsigned_word(*used)) : head_.points;
    if (used && layout_.points != head_.points) {
      warnings.push_back(
          fmt::format("it names {} points in one place and {} in another; the first is believed", layout_.points, head_.points));
    }
    layout_.analog_words = head_.analog_words;
    // A count of more than 16 bits: the parameters know.
    const double words =
        head_.number("ANALOG:USED").value_or(0) *
        std::round(head_.number("ANALOG:RATE").value_or(0) / std::max(1e-9, head_.number("POINT:RATE").value_or(0)));
    if (words > 65535 && words < 1e9 && static_cast<std::uint16_t>(static_cast<std::uint64_t>(words)) == head_.analog_words) {
      layout_.analog_words = static_cast<std::size_t>(words);
    }
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
    const std::size_t bytes = layout_.frame_bytes();
    if (bytes == 0) return;
    const auto there = static_cast<std::int64_t>(size_ > layout_.begin ? (size_ - layout_.begin) / bytes : 0);
    const std::vector<std::int64_t> counts = named_counts();
    if (counts.empty()) return;
    const auto fits = std::find_if(counts.begin(), counts.end(), [&](std::int64_t count) { return count <= there; });
    if (fits == counts.end()) return refuse_or_count(counts, there);
    layout_.frames = static_cast<std::size_t>(*fits);
    if (fits != counts.begin()) warnings.push_back(fmt::format("it names {} frames, but holds {}", counts.front(), *fits));
    count_beyond_16_bits(*fits, there, bytes);
  }

  /// A count that ran over its 16 bits, or stopped at their end, where the frames go on for as long as a whole turn.
  void count_beyond_16_bits(std::int64_t named, std::int64_t there, std::size_t bytes) {
    if (named > 65535 || there <= 65535) return;
    const std::int64_t turned = named + (there - named) / 65536 * 65536;
    const bool ends_there = static_cast<std::size_t>(there - turned) * bytes < kC3dBlock;
    if (named != 65535 && !(turned > named && ends_there)) return;
    layout_.frames = static_cast<std::size_t>(named == 65535 ? there : turned);
    warnings.push_back(fmt::format("it names {} frames, which is as far as it counts; it holds {}", named, layout_.frames));
  }

  void refuse_or_count(const std::vector<std::int64_t>& counts, std::int64_t there) {
    // 65535 (or -1) stands for "more than can be said", even where it is less.
    if (counts.front() == 65535 && there > 0) {
      layout_.frames = static_cast<std::size_t>(there);
      warnings.push_back(fmt::format("it does not say how many frames it holds; there are {}", there));
      return;
    }
    throw Error("{}: is cut off: it names {} frames and holds {}; copy it again", name_,
                *std::min_element(counts.begin(), counts.end()), there);
  }

  const C3dHead& head_;
  std::size_t size_;
  const std::string& name_;
  Layout layout_;
};

class C3dReader : public FileReader {
 public:
  C3dReader(std::unique_ptr<MappedFile> file, std::span<const std::byte> bytes, const std::string& name, C3dPoints points)
      : file_(std::move(file)), path_(name), head_(read_c3d_head(bytes, name)), bytes_(bytes, head_.processor) {
    LayoutFinder finder(head_, bytes.size(), name);
    layout_ = finder.find();
    for (const auto* sentences : {&head_.warnings, &finder.warnings}) {
      for (const std::string& sentence : *sentences) warnings_.push_back(name + ": " + sentence);
    }
    tells_measured_ = any_point_tells();
    info_.header.made_by.program = maker();
    info_.header.rate_hz = rate(name);
    info_.frame_count = static_cast<std::int64_t>(layout_.frames);
    const std::string screen = head_.text("POINT:Y_SCREEN");
    if (screen == "+Y" || screen == "+Z") info_.up = screen == "+Y" ? UpAxis::y : UpAxis::z;
    find_tracks(points);
    warn_of_what_is_not_read();
  }

  const FileInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return warnings_; }

  std::optional<Instant> next() override {
    if (at_ == layout_.frames) return std::nullopt;
    Instant frame;
    frame.index = layout_.first_index + static_cast<std::int64_t>(at_);
    frame.time = timestamp_from_seconds(static_cast<double>(frame.index) / info_.header.rate_hz);
    for (std::size_t i = 0; i < layout_.points; ++i) {
      if (!is_place_[i]) continue;
      if (auto point = point_at(at_, i)) frame.samples.push_back(*point);
    }
    ++at_;
    return frame;
  }

 private:
  std::size_t offset(std::size_t frame, std::size_t point) const {
    return layout_.begin + frame * layout_.frame_bytes() + point * 4 * layout_.word();
  }

  /// The fourth word: its lower byte the residual, its higher one the cameras; negative where the point is missing.
  int fourth_word(std::size_t at) const {
    if (!layout_.real) return bytes_.integer(at + 6);
    const double value = std::round(bytes_.real(at + 12));
    return value >= 0 && value <= 32767 ? static_cast<int>(value) : value > 32767 ? 0 : -1;
  }

  bool any_point_tells() const {
    for (std::size_t frame = 0; frame < layout_.frames; ++frame) {
      for (std::size_t i = 0; i < layout_.points; ++i) {
        if (fourth_word(offset(frame, i)) > 0) return true;
      }
    }
    return false;
  }

  std::optional<Sample> point_at(std::size_t frame, std::size_t i) const {
    const std::size_t at = offset(frame, i);
    const int word = fourth_word(at);
    if (word < 0) return std::nullopt;
    Sample point;
    point.track = TrackId(static_cast<int>(i) + 1);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value =
          layout_.real ? static_cast<double>(bytes_.real(at + 4 * axis)) : bytes_.integer(at + 2 * axis) * layout_.scale;
      if (!std::isfinite(value)) return std::nullopt;
      point.position[static_cast<Eigen::Index>(axis)] = value * layout_.unit_m;
    }
    if (word > 0) {
      point.cameras = static_cast<CameraMask>(word >> 8);
      point.residual_m = (word & 0xff) * layout_.scale * layout_.unit_m;
    } else if (tells_measured_) {
      point.provenance = Provenance::filled;
    }
    return point;
  }

  double rate(const std::string& name) {
    for (const double rate : {head_.number("POINT:RATE").value_or(0), static_cast<double>(head_.rate_hz)}) {
      if (std::isfinite(rate) && rate > 1e-6 && rate < 1e9) return rate;
    }
    warnings_.push_back(name + ": does not say its rate; 100 frames a second are assumed");
    return 100;
  }

  std::string maker() const {
    const std::string software = head_.text("MANUFACTURER:SOFTWARE"), company = head_.text("MANUFACTURER:COMPANY");
    if (software.empty() || company.empty() || software.starts_with(company)) return software.empty() ? company : software;
    return company + " " + software;
  }

  /// Of a parameter that goes on in others of its name, with a number behind it.
  std::vector<std::string> texts(std::string_view parameter) const {
    std::vector<std::string> texts;
    for (int part = 1;; ++part) {
      const auto found = head_.parameters.find(part == 1 ? std::string(parameter) : fmt::format("{}{}", parameter, part));
      if (found == head_.parameters.end()) return texts;
      texts.insert(texts.end(), found->second.texts.begin(), found->second.texts.end());
    }
  }

  /// What stands among the points and is none: angles in degrees, forces in N, …
  std::map<std::string, std::string_view> other_quantities() const {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kGroups{{{"POINT:ANGLES", "angles"},
                                                                                    {"POINT:FORCES", "forces"},
                                                                                    {"POINT:MOMENTS", "moments"},
                                                                                    {"POINT:POWERS", "powers"},
                                                                                    {"POINT:SCALARS", "scalars"}}};
    std::map<std::string, std::string_view> quantities;
    for (const auto& [parameter, quantity] : kGroups) {
      for (const std::string& label : texts(parameter)) quantities.emplace(label, quantity);
    }
    return quantities;
  }

  void find_tracks(C3dPoints points) {
    std::vector<std::string> labels = texts("POINT:LABELS");
    labels.resize(layout_.points);
    const auto quantities = points == C3dPoints::all ? std::map<std::string, std::string_view>() : other_quantities();
    std::map<std::string_view, int> left_out;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto other = labels[i].empty() ? quantities.end() : quantities.find(labels[i]);
      is_place_.push_back(other == quantities.end());
      if (is_place_.back()) {
        info_.tracks.push_back({TrackId(static_cast<int>(i) + 1), std::move(labels[i]), {}});
      } else {
        ++left_out[other->second];
      }
    }
    if (left_out.empty()) return;
    std::string counts;
    for (const auto& [quantity, count] : left_out) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, quantity);
    warnings_.push_back(fmt::format("{}: {} stand among its points and are no places; they are left out", path_, counts));
  }

  void warn_of_what_is_not_read() {
    const auto count = [&](const char* parameter) {
      const double value = head_.number(parameter).value_or(0);
      return std::isfinite(value) && value > 0 && value < 1e6 ? static_cast<int>(value) : 0;
    };
    const int channels = layout_.analog_words > 0 ? count("ANALOG:USED") : 0, events = count("EVENT:USED");
    if (channels == 0 && events == 0) return;
    const std::string analog = channels > 0 ? fmt::format("{} channels of analog data (forces, EMG)", channels) : "";
    const std::string marked = events > 0 ? fmt::format("{} events", events) : "";
    warnings_.push_back(
        fmt::format("{}: its {}{}{} are not read", path_, analog, channels > 0 && events > 0 ? " and " : "", marked));
  }

  std::unique_ptr<MappedFile> file_;
  std::string path_;
  C3dHead head_;
  C3dBytes bytes_;
  Layout layout_;
  bool tells_measured_ = false;
  FileInfo info_;
  std::vector<bool> is_place_;  // of each point
  std::vector<std::string> warnings_;
  std::size_t at_ = 0;
};

}  // namespace

std::unique_ptr<FileReader> open_c3d(const std::string& path, C3dPoints points) {
  auto file = std::make_unique<MappedFile>(path);
  const std::span<const std::byte> bytes = file->bytes();
  return std::make_unique<C3dReader>(std::move(file), bytes, path, points);
}

std::unique_ptr<FileReader> read_c3d(std::span<const std::byte> bytes, const std::string& name) {
  return std::make_unique<C3dReader>(nullptr, bytes, name, C3dPoints::places);
}

}  // namespace marey::format::motion
