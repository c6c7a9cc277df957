#include "marey/format/motion/c3d_auxiliary.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/core/geometry.h"

namespace marey::format::motion {

AuxiliaryData auxiliary_data(const C3dHead& head, const C3dLayout& layout, const std::string& path) {
  const double events = head.number("EVENT:USED").value_or(0);
  AuxiliaryData auxiliary{.path = path,
                          .channels = static_cast<std::int64_t>(layout.analog_channels),
                          .events = std::isfinite(events) && events > 0 && events < 1e6 ? static_cast<std::int64_t>(events) : 0};
  return auxiliary;
}

C3dAuxiliary::C3dAuxiliary(std::unique_ptr<MappedFile> file, std::span<const std::byte> bytes, const AuxiliaryData& auxiliary)
    : file_(std::move(file)),
      head_(read_c3d_head(file_ ? file_->bytes() : bytes, auxiliary.path)),
      bytes_(file_ ? file_->bytes() : bytes, head_.processor),
      layout_(c3d_layout(head_, bytes_.size(), auxiliary.path)),
      up_(auxiliary.rotated ? UpAxis::y : UpAxis::z),
      unsigned_(!layout_.real && head_.text("ANALOG:FORMAT") == "UNSIGNED"),
      offsets_(head_.numbers("ANALOG:OFFSET")) {
  offsets_.resize(layout_.analog_channels, 0);
}

C3dAuxiliary::C3dAuxiliary(std::span<const std::byte> bytes, const AuxiliaryData& auxiliary)
    : C3dAuxiliary(nullptr, bytes, auxiliary) {}

C3dAuxiliary::C3dAuxiliary(const AuxiliaryData& auxiliary)
    : C3dAuxiliary(std::make_unique<MappedFile>(auxiliary.path), {}, auxiliary) {}

double C3dAuxiliary::rate_hz() const {
  const double rate = head_.number("POINT:RATE").value_or(0);
  return rate > 0 ? rate : static_cast<double>(head_.rate_hz);
}

std::vector<std::string> C3dAuxiliary::labels() const {
  std::vector<std::string> labels = head_.texts("ANALOG:LABELS");
  labels.resize(layout_.analog_channels);
  return labels;
}

std::vector<std::string> C3dAuxiliary::units() const {
  std::vector<std::string> units = head_.texts("ANALOG:UNITS");
  units.resize(layout_.analog_channels);
  return units;
}

std::vector<double> C3dAuxiliary::scales() const {
  std::vector<double> scales = head_.numbers("ANALOG:SCALE");
  scales.resize(layout_.analog_channels, 1);
  const double all = head_.number("ANALOG:GEN_SCALE").value_or(1);
  for (double& scale : scales) scale *= all;
  return scales;
}

std::span<const float> C3dAuxiliary::frame(std::int64_t index) {
  const std::size_t words = layout_.analog_channels * layout_.analog_samples;
  row_.assign(words, 0.0F);
  const std::int64_t frame = index - layout_.first_index;
  if (frame < 0 || frame >= static_cast<std::int64_t>(layout_.frames)) {
    for (std::size_t i = 0; i < words; ++i) row_[i] = static_cast<float>(offsets_[i % layout_.analog_channels]);
    return row_;
  }
  const std::size_t begin =
      layout_.begin + static_cast<std::size_t>(frame) * layout_.frame_bytes() + layout_.points * 4 * layout_.word();
  for (std::size_t i = 0; i < words; ++i) {
    const std::size_t at = begin + i * layout_.word();
    if (layout_.real) {
      row_[i] = bytes_.real(at);
    } else if (unsigned_) {
      // Offsets are words with a sign: what they count from turns with them.
      const double offset = offsets_[i % layout_.analog_channels];
      row_[i] = static_cast<float>(static_cast<int>(bytes_.word(at)) - (offset < 0 ? 65536 : 0));
    } else {
      row_[i] = static_cast<float>(bytes_.integer(at));
    }
  }
  return row_;
}

std::vector<C3dParameter> C3dAuxiliary::group(std::string_view name, UpAxis up) const {
  std::vector<C3dParameter> parameters;
  const std::string prefix = std::string(name) + ":";
  for (auto at = head_.parameters.lower_bound(prefix); at != head_.parameters.end() && at->first.starts_with(prefix); ++at) {
    parameters.push_back(at->second);
    fit(name, parameters.back(), up);
  }
  return parameters;
}

void C3dAuxiliary::fit(std::string_view group, C3dParameter& parameter, UpAxis up) const {
  if (group == "ANALOG" && parameter.name == "FORMAT" && unsigned_) {
    for (std::string& text : parameter.texts) text = "SIGNED";
  }
  if (group != "FORCE_PLATFORM" || parameter.type != 4 || (parameter.name != "CORNERS" && parameter.name != "ORIGIN")) return;
  for (double& number : parameter.numbers) number *= 1000 * layout_.unit_m;
  if (parameter.name != "CORNERS" || up == up_) return;
  for (std::size_t i = 0; i + 3 <= parameter.numbers.size(); i += 3) {
    const double y = parameter.numbers[i + 1], z = parameter.numbers[i + 2];
    parameter.numbers[i + 1] = up == UpAxis::z ? -z : z;
    parameter.numbers[i + 2] = up == UpAxis::z ? y : -y;
  }
}

}  // namespace marey::format::motion
