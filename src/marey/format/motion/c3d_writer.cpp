#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/text_safety.h"
#include "marey/core/whole_file.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_parameters.h"
#include "marey/format/motion/point_sink.h"

namespace marey::format::motion {
namespace {

constexpr std::size_t kMostNames = 255;  // in one parameter
constexpr std::size_t kLongestName = 127;
constexpr std::size_t kMostPoints = 65535;

void put_byte(std::string& bytes, std::size_t value) {
  bytes += static_cast<char>(static_cast<std::uint8_t>(value));
}
void put_word(std::string& bytes, std::int64_t value) {
  put_byte(bytes, static_cast<std::uint64_t>(value) & 0xff);
  put_byte(bytes, static_cast<std::uint64_t>(value) >> 8 & 0xff);
}
void put_real(std::string& bytes, double value) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  put_word(bytes, bits & 0xffff);
  put_word(bytes, bits >> 16);
}

/// The section of parameters, built up group by group.
class ParameterSection {
 public:
  void group(const std::string& name) {
    ++group_;
    put_byte(bytes_, name.size());
    put_byte(bytes_, static_cast<std::size_t>(-group_));
    bytes_ += name;
    put_word(bytes_, 3);
    put_byte(bytes_, 0);
  }
  void words(const std::string& name, const std::vector<std::int64_t>& values, bool scalar) {
    std::string data;
    for (const std::int64_t value : values) put_word(data, value);
    parameter(name, 2, scalar ? std::vector<std::size_t>{} : std::vector<std::size_t>{values.size()}, data);
  }
  void word(const std::string& name, std::int64_t value) { words(name, {value}, true); }
  void real(const std::string& name, double value) {
    std::string data;
    put_real(data, value);
    parameter(name, 4, {}, data);
  }
  void text(const std::string& name, const std::string& text) { parameter(name, -1, {text.size()}, text); }
  /// All of one width.
  void texts(const std::string& name, std::span<const std::string> texts, std::size_t width) {
    std::string data;
    for (const std::string& text : texts) data += text.substr(0, width) + std::string(width - std::min(width, text.size()), ' ');
    parameter(name, -1, {width, texts.size()}, data);
  }
  /// Whole blocks. Throws where it is longer than the format allows.
  std::string blocks(const std::string& path) {
    std::string section("\x01\x50", 2);
    const std::size_t count = (4 + bytes_.size() + 2 + kC3dBlock - 1) / kC3dBlock;
    if (count > 255)
      throw Error("{}: its names take {} blocks, and a C3D file has room for 255; use shorter or fewer", path, count);
    put_byte(section, count);
    put_byte(section, 84);
    section += bytes_;
    section.resize(count * kC3dBlock, '\0');
    return section;
  }

 private:
  void parameter(const std::string& name, int type, const std::vector<std::size_t>& dimensions, const std::string& data) {
    put_byte(bytes_, name.size());
    put_byte(bytes_, static_cast<std::size_t>(group_));
    bytes_ += name;
    put_word(bytes_, static_cast<std::int64_t>(2 + 2 + dimensions.size() + data.size() + 1));
    put_byte(bytes_, static_cast<std::size_t>(type));
    put_byte(bytes_, dimensions.size());
    for (const std::size_t dimension : dimensions) put_byte(bytes_, dimension);
    bytes_ += data;
    put_byte(bytes_, 0);
  }

  std::string bytes_;
  int group_ = 0;
};

class C3dWriter : public PointSink {
 public:
  C3dWriter(const std::string& path, const WritePlan& plan)
      : PointSink(path), plan_(plan), points_(plan.info.tracks.size()), next_(plan.first_frame) {
    if (points_ > kMostPoints) {
      throw Error("{}: {} tracks, and a C3D file has room for {}; write fewer", path, points_, kMostPoints);
    }
    // What integers of 16 bits would need, and fine enough that a residual, 255 steps at most, says something.
    scale_mm_ = std::max(plan.farthest_m * 1000 / 32000, 0.01);
    for (std::size_t i = 0; i < points_; ++i) column_[plan.info.tracks[i].id] = i;
  }

  void write(const Instant& frame) override {
    if (frame.index < next_ || frame.index > plan_.last_frame) {
      throw Error("{}: frame {} comes out of order, or beyond what was planned", path(), frame.index);
    }
    while (next_ < frame.index) put_frame({});
    put_frame(frame.samples);
  }

  void finish() override {
    while (next_ <= plan_.last_frame) put_frame({});
    file_->finish();
  }

 private:
  void start(const RecordingHeader&) override {
    file_.emplace(path());
    write_head(plan_.up);
  }

  void put_frame(std::span<const Sample> points) {
    row_.clear();
    row_.resize(points_ * 4, 0.0F);
    for (std::size_t i = 0; i < points_; ++i) row_[4 * i + 3] = -1;
    for (const Sample& point : points) {
      const auto column = column_.find(point.track);
      if (column == column_.end()) continue;
      float* out = row_.data() + 4 * column->second;
      for (int axis = 0; axis < 3; ++axis) out[axis] = static_cast<float>(point.position[axis] * 1000);
      out[3] = static_cast<float>(fourth_word(point));
    }
    static_assert(std::endian::native == std::endian::little, "rows are written as they lie in memory");
    file_->write({reinterpret_cast<const char*>(row_.data()), row_.size() * sizeof(float)});
    ++next_;
  }

  /// 0 says "not measured", so that what was measured must say something else.
  int fourth_word(const Sample& point) const {
    if (!plan_.tells_measured || point.provenance != Provenance::measured) return 0;
    const double steps = point.residual_m.value_or(0) * 1000 / scale_mm_;
    const int residual = static_cast<int>(std::clamp(std::round(steps), 0.0, 255.0));
    const int word = static_cast<int>(point.cameras & 0x7f) << 8 | residual;
    return word == 0 ? 1 : word;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const TrackName& track : plan_.info.tracks) {
      names.push_back(track.label.empty() ? fmt::format("*{}", number(track.id)) : plain_text(track.label).substr(0, kLongestName));
    }
    return names;
  }

  void write_head(UpAxis up) {
    const std::int64_t frames = plan_.last_frame - plan_.first_frame + 1;
    const std::int64_t first = plan_.first_frame + 1, last = plan_.last_frame + 1;
    const std::string section = parameters(up, frames, first, last, 0).blocks(path());
    const std::size_t data_block = 2 + section.size() / kC3dBlock;
    std::string head("\x02\x50", 2);
    put_word(head, static_cast<std::int64_t>(points_));
    put_word(head, 0);
    put_word(head, std::min<std::int64_t>(first, 65535));
    put_word(head, std::min<std::int64_t>(last, 65535));
    put_word(head, 0);
    put_real(head, -scale_mm_);
    put_word(head, static_cast<std::int64_t>(data_block));
    put_word(head, 0);
    put_real(head, plan_.info.header.rate_hz);
    head.resize(kC3dBlock, '\0');
    file_->write(head);
    file_->write(parameters(up, frames, first, last, data_block).blocks(path()));
  }

  ParameterSection parameters(UpAxis up, std::int64_t frames, std::int64_t first, std::int64_t last, std::size_t data_block) const {
    ParameterSection section;
    section.group("POINT");
    section.word("USED", static_cast<std::int64_t>(points_));
    section.real("SCALE", -scale_mm_);
    section.real("RATE", plan_.info.header.rate_hz);
    section.word("DATA_START", static_cast<std::int64_t>(data_block));
    section.word("FRAMES", std::min<std::int64_t>(frames, 65535));
    section.text("UNITS", "mm");
    section.text("X_SCREEN", "+X");
    section.text("Y_SCREEN", up == UpAxis::y ? "+Y" : "+Z");
    put_names(section);
    if (frames > 65535) section.real("LONG_FRAMES", static_cast<double>(frames));
    section.group("ANALOG");
    section.word("USED", 0);
    section.real("RATE", 0);
    section.real("GEN_SCALE", 1);
    section.group("TRIAL");
    section.words("ACTUAL_START_FIELD", {first & 0xffff, first >> 16}, false);
    section.words("ACTUAL_END_FIELD", {last & 0xffff, last >> 16}, false);
    section.group("MANUFACTURER");
    section.text("SOFTWARE", "Marey");
    return section;
  }

  void put_names(ParameterSection& section) const {
    const std::vector<std::string> all = names();
    std::size_t width = 4;
    for (const std::string& name : all) width = std::max(width, name.size());
    for (std::size_t begin = 0, part = 1; begin < all.size() || part == 1; begin += kMostNames, ++part) {
      const std::string number = part == 1 ? "" : std::to_string(part);
      const auto here = std::span(all).subspan(begin, std::min(kMostNames, all.size() - begin));
      section.texts("LABELS" + number, here, width);
      section.texts("DESCRIPTIONS" + number, std::vector<std::string>(here.size()), 1);
    }
  }

  WritePlan plan_;
  std::optional<WholeFile> file_;
  std::size_t points_;
  std::int64_t next_;
  double scale_mm_ = 1;
  std::map<TrackId, std::size_t> column_;
  std::vector<float> row_;
};

}  // namespace

std::unique_ptr<Sink> create_c3d(const std::string& path, const WritePlan& plan) {
  return std::make_unique<C3dWriter>(path, plan);
}

Format c3d_format() {
  return {.name = "c3d",
          .title = "a C3D file",
          .endings = ".c3d",
          .holds = Content::space,
          .detail =
              "mm; points, residuals in space, the first seven cameras, whether a point was measured. Written as a PC's floats; "
              "PC, DEC and SGI, integer and real, are read. Analog channels are passed over",
          .is =
              [](const Beginning& file) {
                return file.bytes.size() >= 2 && file.bytes[1] == 0x50 && file.bytes[0] > 0 && !file.bytes.starts_with("PP");
              },
          .open = [](const std::string& path, const ReadOptions&) { return motion::open_c3d(path); },
          .create = [](const std::string& path, const WritePlan& plan) { return motion::create_c3d(path, plan); }};
}

}  // namespace marey::format::motion
