#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/files/whole_file.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_auxiliary.h"
#include "marey/format/motion/c3d_section.h"
#include "marey/format/motion/point_sink.h"

namespace marey::format::motion {
namespace {

constexpr std::size_t kMaxName = 127;
constexpr std::size_t kMaxPoints = 65535;
constexpr std::size_t kC3dMaxBlocks = 260;  // before the frames
/// What goes along from the file that was read; events where none were found again.
constexpr std::array<const char*, 6> kGroupsAlong = {"EVENT",          "EVENT_CONTEXT", "ANALOG",
                                                     "FORCE_PLATFORM", "PROCESSING",    "SUBJECTS"};

/// Rows that stand behind all others in the file, kept in a nameless one until then.
class RowsBehind {
 public:
  explicit RowsBehind(std::string path) : path_(std::move(path)), file_(std::tmpfile()) {
    if (file_ == nullptr) throw Error("{}: no temporary file can be made; is the folder for them full?", path_);
  }
  void add(std::span<const float> row) {
    if (std::fwrite(row.data(), sizeof(float), row.size(), file_.get()) != row.size())
      throw Error("{}: the folder for temporary files is full", path_);
  }
  void copy_to(WholeFile& file) {
    std::rewind(file_.get());
    std::array<char, 65536> bytes{};
    while (const std::size_t count = std::fread(bytes.data(), 1, bytes.size(), file_.get())) file.write({bytes.data(), count});
    if (std::ferror(file_.get()) != 0) throw Error("{}: its temporary file cannot be read again", path_);
  }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

class C3dWriter : public PointSink {
 public:
  C3dWriter(const std::string& path, const WritePlan& plan)
      : PointSink(path), plan_(plan), tracks_(plan.info.tracks.size()), next_(plan.first_frame) {
    if (plan.found) angles_ = plan.found->angles;
    points_ = tracks_ + angles_.size();
    if (points_ > kMaxPoints) {
      throw Error("{}: {} tracks, and a C3D file has room for {}; write fewer", path, points_, kMaxPoints);
    }
    // What integers of 16 bits would need, and fine enough that a residual, 255 steps at most, says something.
    scale_mm_ = std::max(plan.farthest_m * 1000 / 32000, 0.01);
    for (std::size_t i = 0; i < tracks_; ++i) column_[plan.info.tracks[i].id] = i;
  }

  void write(const Instant& frame) override {
    if (frame.index < next_ || frame.index > plan_.last_frame) {
      throw Error("{}: frame {} comes out of order, or beyond what was planned", path(), frame.index);
    }
    while (next_ < frame.index) put_frame({});
    put_frame(frame);
  }

  void finish() override {
    while (next_ <= plan_.last_frame) put_frame({});
    if (poses_) {
      file_->write(std::string(poses_begin() - points_begin() - frame_count() * frame_bytes(), '\0'));
      poses_->copy_to(*file_);
    }
    file_->finish();
  }

 private:
  void start(const RecordingHeader& header) override {
    if (!plan_.info.auxiliary.path.empty()) auxiliary_.emplace(plan_.info.auxiliary);
    if (analog_channels() > 0 && std::abs(auxiliary_->rate_hz() / plan_.info.header.rate_hz - 1) > 1e-6)
      throw Error("{}: {} has {:g} frames a second, and what is written {:g}; analog channels of another rate do not fit", path(),
                  plan_.info.auxiliary.path, auxiliary_->rate_hz(), plan_.info.header.rate_hz);
    bodies_ = header.bodies;
    if (!bodies_.empty()) poses_.emplace(path());
    file_.emplace(path());
    write_head();
  }

  std::size_t analog_channels() const { return auxiliary_ ? auxiliary_->channels() : 0; }
  std::size_t analog_samples() const { return analog_channels() > 0 ? auxiliary_->samples() : 0; }
  std::size_t frame_bytes() const { return (4 * points_ + analog_channels() * analog_samples()) * sizeof(float); }
  std::size_t frame_count() const { return static_cast<std::size_t>(plan_.last_frame - plan_.first_frame + 1); }
  std::size_t points_begin() const { return (data_block_ - 1) * kC3dBlock; }
  /// The block behind the frames.
  std::size_t poses_begin() const {
    return points_begin() + (frame_count() * frame_bytes() + kC3dBlock - 1) / kC3dBlock * kC3dBlock;
  }

  void put_frame(const Instant& frame) {
    row_.clear();
    row_.resize(points_ * 4, 0.0F);
    for (std::size_t i = 0; i < points_; ++i) row_[4 * i + 3] = -1;
    for (const Sample& point : frame.samples) {
      const auto column = column_.find(point.track);
      if (column != column_.end()) put_point(column->second, point.position * 1000, fourth_word(point));
    }
    const auto row = static_cast<std::size_t>(next_ - plan_.first_frame);
    for (std::size_t i = 0; i < angles_.size(); ++i) {
      if (row < angles_[i].rows.size() && angles_[i].rows[row]) put_point(tracks_ + i, *angles_[i].rows[row], 0);
    }
    if (analog_channels() > 0) {
      const std::span<const float> values = auxiliary_->frame(next_);
      row_.insert(row_.end(), values.begin(), values.end());
    }
    static_assert(std::endian::native == std::endian::little, "rows are written as they lie in memory");
    file_->write({reinterpret_cast<const char*>(row_.data()), row_.size() * sizeof(float)});
    if (poses_) put_poses(frame.bodies);
    ++next_;
  }

  void put_point(std::size_t column, const Vector<3>& location, int word) {
    float* out = row_.data() + 4 * column;
    for (int axis = 0; axis < 3; ++axis) out[axis] = static_cast<float>(location[axis]);
    out[3] = static_cast<float>(word);
  }

  void put_poses(std::span<const BodyPose> poses) {
    row_.assign(bodies_.size() * kC3dMatrixFloats, 0.0F);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      float* out = row_.data() + i * kC3dMatrixFloats;
      out[16] = -1;
      const auto pose = std::find_if(poses.begin(), poses.end(), [&](const BodyPose& one) { return one.body == bodies_[i].id; });
      if (pose == poses.end()) continue;
      for (int column = 0; column < 3; ++column) {
        for (int line = 0; line < 3; ++line)
          out[4 * column + line] = static_cast<float>(pose->world_from_body.rotation(line, column));
      }
      for (int line = 0; line < 3; ++line) out[12 + line] = static_cast<float>(pose->world_from_body.translation[line] * 1000);
      out[15] = 1;
      out[16] = 0;
    }
    poses_->add(row_);
  }

  /// 0 says "not measured", so that measured values must say something else.
  int fourth_word(const Sample& point) const {
    if (!plan_.reports_measured || point.provenance != Provenance::measured) return 0;
    const double steps = point.residual_m.value_or(0) * 1000 / scale_mm_;
    const int residual = static_cast<int>(std::clamp(std::round(steps), 0.0, 255.0));
    const int word = static_cast<int>(point.cameras & 0x7f) << 8 | residual;
    return word == 0 ? 1 : word;
  }

  void write_head() {
    const std::int64_t first = plan_.first_frame + 1, last = plan_.last_frame + 1;
    data_block_ = 2 + parameters().blocks(path()).size() / kC3dBlock;
    std::string head("\x02\x50", 2);
    put_word(head, static_cast<std::int64_t>(points_));
    put_word(head, static_cast<std::int64_t>(analog_channels() * analog_samples()));
    put_word(head, std::min<std::int64_t>(first, 65535));
    put_word(head, std::min<std::int64_t>(last, 65535));
    put_word(head, 0);
    put_real(head, -scale_mm_);
    put_word(head, static_cast<std::int64_t>(data_block_));
    put_word(head, static_cast<std::int64_t>(analog_samples()));
    put_real(head, plan_.info.header.rate_hz);
    head.resize(kC3dBlock, '\0');
    file_->write(head);
    file_->write(parameters().blocks(path()));
  }

  C3dSection parameters() const {
    const std::int64_t frames = static_cast<std::int64_t>(frame_count());
    C3dSection section;
    section.group("POINT");
    section.word("USED", static_cast<std::int64_t>(points_));
    section.real("SCALE", -scale_mm_);
    section.real("RATE", plan_.info.header.rate_hz);
    section.word("DATA_START", static_cast<std::int64_t>(data_block_));
    section.word("FRAMES", std::min<std::int64_t>(frames, 65535));
    section.text("UNITS", "mm");
    section.text("X_SCREEN", "+X");
    section.text("Y_SCREEN", plan_.up == UpAxis::y ? "+Y" : "+Z");
    put_names(section);
    if (frames > 65535) section.real("LONG_FRAMES", static_cast<double>(frames));
    put_groups_along(section);
    if (plan_.found) put_events(section, plan_.found->events);
    if (!bodies_.empty()) put_bodies(section);
    put_trial(section);
    return section;
  }

  void put_trial(C3dSection& section) const {
    const std::int64_t first = plan_.first_frame + 1, last = plan_.last_frame + 1;
    section.group("TRIAL");
    section.words("ACTUAL_START_FIELD", std::array{first & 0xffff, first >> 16});
    section.words("ACTUAL_END_FIELD", std::array{last & 0xffff, last >> 16});
    section.group("MANUFACTURER");
    section.text("SOFTWARE", "Marey");
  }

  void put_names(C3dSection& section) const {
    std::vector<std::string> labels, descriptions(tracks_), names_of_angles;
    for (const TrackName& track : plan_.info.tracks)
      labels.push_back(track.label.empty() ? fmt::format("*{}", number(track.id)) : plain_text(track.label).substr(0, kMaxName));
    for (const AngleTriple& triple : angles_) {
      labels.push_back(triple.label);
      names_of_angles.push_back(triple.label);
      descriptions.push_back(triple.description);
    }
    section.texts("LABELS", labels);
    section.texts("DESCRIPTIONS", descriptions);
    if (angles_.empty()) return;
    section.texts("ANGLES", names_of_angles);
    section.text("ANGLE_UNITS", "deg");
    section.texts("TYPE_GROUPS", std::array<std::string, 2>{"ANGLES", "ANGLE"});
  }

  void put_groups_along(C3dSection& section) const {
    if (analog_channels() == 0) {
      section.group("ANALOG");
      section.word("USED", 0);
      section.real("RATE", 0);
      section.real("GEN_SCALE", 1);
    }
    for (const std::string_view name : kGroupsAlong) {
      const auto parameters = auxiliary_ ? auxiliary_->group(name, plan_.up) : std::vector<C3dParameter>();
      if (parameters.empty() || (plan_.found && name.starts_with("EVENT"))) continue;
      const bool analog = name == "ANALOG";
      if (analog && analog_channels() == 0) continue;
      section.group(std::string(name));
      for (const C3dParameter& parameter : parameters) {
        if (!analog || (parameter.name != "USED" && parameter.name != "RATE")) section.copy(parameter);
      }
      if (!analog) continue;
      put_absent_scales(section, parameters);
      section.word("USED", static_cast<std::int64_t>(analog_channels()));
      section.real("RATE", plan_.info.header.rate_hz * static_cast<double>(analog_samples()));
    }
  }

  /// What a file may omit, and readers (ezc3d) take to be there once a rate is: values as they stand. Parts of 255.
  void put_absent_scales(C3dSection& section, std::span<const C3dParameter> parameters) const {
    const auto absent = [&](std::string_view name) {
      return std::none_of(parameters.begin(), parameters.end(), [&](const C3dParameter& one) { return one.name == name; });
    };
    if (absent("GEN_SCALE")) section.real("GEN_SCALE", 1);
    const bool scale = absent("SCALE"), offset = absent("OFFSET");
    for (std::size_t begin = 0, part = 1; begin < analog_channels(); begin += kC3dMaxNames, ++part) {
      const std::size_t here = std::min(analog_channels() - begin, kC3dMaxNames);
      const std::string number = part == 1 ? "" : std::to_string(part);
      if (scale) section.reals("SCALE" + number, std::vector<double>(here, 1), {here});
      if (offset) section.words("OFFSET" + number, std::vector<std::int64_t>(here, 0));
    }
  }

  /// Parts of 255, as labels have them.
  void put_events(C3dSection& section, std::span<const MotionEvent> events) const {
    section.group("EVENT");
    section.word("USED", std::ssize(events));
    std::vector<std::string> contexts, labels;
    for (const MotionEvent& event : events) {
      contexts.push_back(event.context);
      labels.push_back(event.label);
    }
    section.texts("CONTEXTS", contexts);
    section.texts("LABELS", labels);
    section.texts("SUBJECTS", std::vector<std::string>(events.size(), auxiliary_ ? auxiliary_->subject() : std::string()));
    for (std::size_t begin = 0, part = 1; begin < events.size() || part == 1; begin += kC3dMaxNames, ++part) {
      const auto here = events.subspan(begin, std::min(kC3dMaxNames, events.size() - begin));
      const std::string number = part == 1 ? "" : std::to_string(part);
      std::vector<double> times;
      std::vector<std::int64_t> icons;
      for (const MotionEvent& event : here) {
        const double minutes = std::floor(event.time_s / 60);
        times.insert(times.end(), {minutes, event.time_s - 60 * minutes});
        icons.push_back(event.label == "Foot Strike" ? 1 : event.label == "Foot Off" ? 2 : 0);
      }
      section.reals("TIMES" + number, times, {2, here.size()});
      section.words("ICON_IDS" + number, icons);
    }
    section.group("EVENT_CONTEXT");
    section.word("USED", 3);
    section.words("ICON_IDS", std::array<std::int64_t, 3>{0, 1, 2});
    section.texts("LABELS", std::array<std::string, 3>{"General", "Left", "Right"});
    section.texts("DESCRIPTIONS", std::array<std::string, 3>{"For other events", "Left side", "Right side"});
  }

  void put_bodies(C3dSection& section) const {
    std::vector<std::string> labels;
    for (const Body& body : bodies_) labels.push_back(plain_text(body.label).substr(0, kMaxName).append(kC3dMatrixEnding));
    // Said as a real number where a word has no room for it, as LONG_FRAMES is; the section is as long whatever comes before.
    const bool fits = frame_count() * frame_bytes() / kC3dBlock + kC3dMaxBlocks < 65535;
    const std::size_t block = 1 + poses_begin() / kC3dBlock;
    section.group("ROTATION");
    section.word("USED", std::ssize(bodies_));
    section.texts("LABELS", labels);
    section.real("RATE", plan_.info.header.rate_hz);
    section.word("RATIO", 1);
    if (fits) {
      section.word("DATA_START", static_cast<std::int64_t>(block));
    } else {
      section.real("DATA_START", static_cast<double>(block));
    }
  }

  WritePlan plan_;
  std::optional<WholeFile> file_;
  std::optional<C3dAuxiliary> auxiliary_;
  std::optional<RowsBehind> poses_;
  std::vector<AngleTriple> angles_;
  std::vector<Body> bodies_;
  std::size_t tracks_, points_ = 0, data_block_ = 2;
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
  return {
      .name = "c3d",
      .title = "a C3D file",
      .endings = ".c3d",
      .holds = Content::space,
      .detail =
          "mm; points, residuals in space, the first seven cameras, whether a point was measured. Written as a PC's floats; "
          "PC, DEC and SGI, integer and real, are read. Bodies' poses as matrices (ROTATION); analog channels, force plates "
          "and events "
          "go along from C3D to C3D",
      .is =
          [](const Beginning& file) {
            return file.bytes.size() >= 2 && file.bytes[1] == 0x50 && file.bytes[0] > 0 && !file.bytes.starts_with("PP");
          },
      .open = [](const std::string& path, const ReadOptions& how) { return motion::open_c3d(path, C3dPoints::locations, how.up); },
      .create = [](const std::string& path, const WritePlan& plan) { return motion::create_c3d(path, plan); },
      .poses = true,
      .auxiliary_data = true};
}

}  // namespace marey::format::motion
