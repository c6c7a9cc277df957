#include "marey/format/motion/force_plates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/motion/c3d_auxiliary.h"

namespace marey::format::motion {
namespace {

constexpr std::size_t kMaxAnalogValues = std::size_t{1} << 28;  // 2 GB; a day of 24 channels at 100 Hz
/// A channel is at its limit where its largest or smallest value repeats for this long. A foot's peak force changes by more: of
/// 600 N at 5 Hz by 16 N within 7.5 ms.
constexpr double kAtLimitS = 0.015;
constexpr std::size_t kMinAtLimit = 5;  // samples

/// Channels that a plate of a type has; nothing for a type that is not supported.
std::optional<std::size_t> channels_of_type(int type) {
  if (type == 3) return 8;
  if (type == 1 || type == 2 || type == 4) return 6;
  return std::nullopt;
}

/// A parameter's numbers of one plate.
struct PlateGroup {
  explicit PlateGroup(const std::vector<C3dParameter>& parameters) {
    for (const C3dParameter& parameter : parameters) by_name[parameter.name] = &parameter;
  }
  std::size_t used() const {
    const auto numbers = all("USED");
    return numbers.empty() || !(numbers[0] > 0) ? 0 : static_cast<std::size_t>(std::min(numbers[0], 64.0));
  }
  std::span<const double> all(std::string_view name) const {
    const auto found = by_name.find(name);
    return found == by_name.end() ? std::span<const double>() : std::span<const double>(found->second->numbers);
  }
  /// `count` numbers of plate `index`, where `stride` are stored for each; empty if they are not there.
  std::span<const double> of(std::string_view name, std::size_t index, std::size_t count, std::size_t stride) const {
    const auto numbers = all(name);
    return numbers.size() < index * stride + count ? std::span<const double>() : numbers.subspan(index * stride, count);
  }
  std::size_t stride(std::string_view name, std::size_t without) const {
    const auto found = by_name.find(name);
    return found == by_name.end() || found->second->dimensions.empty() ? without : found->second->dimensions.front();
  }

  std::map<std::string, const C3dParameter*, std::less<>> by_name;
};

/// Metres of a moment's or a length's unit: "Nmm" has 0.001; `without` if it names no length.
double metres_of_unit(std::string_view unit, double without) {
  if (unit.find("mm") != std::string_view::npos) return 0.001;
  if (unit.find("cm") != std::string_view::npos) return 0.01;
  return unit.find('m') != std::string_view::npos ? 1 : without;
}

/// What the channels of a plate are, in its own axes.
struct PlateChannels {
  int type = 2;
  std::vector<std::size_t> channels;
  Vector<3> origin = Vector<3>::Zero();  // m, of the surface's middle as the sensor has it; of type 3 half distances of sensors
  Eigen::Matrix<double, 6, 6> calibration = Eigen::Matrix<double, 6, 6>::Identity();
  std::array<double, 8> unit{1, 1, 1, 1, 1, 1, 1, 1};  // SI per the file's unit, by channel

  /// In the plate's axes, the moment about the surface's middle.
  PlateLoad load(std::span<const double> values) const {
    std::array<double, 8> v{};
    for (std::size_t i = 0; i < channels.size(); ++i) v[i] = values[channels[i]] * (type == 4 ? 1 : unit[i]);
    switch (type) {
      case 1:
        return of_centre_of_pressure(v);
      case 3:
        return of_corners(v);
      case 4:
        return of_sensor(calibrated(v));
      default:
        return of_sensor(v);
    }
  }

 private:
  PlateLoad of_centre_of_pressure(const std::array<double, 8>& v) const {
    const Vector<3> force(v[0], v[1], v[2]), at(v[3], v[4], 0);
    return {force, at.cross(force) + Vector<3>(0, 0, v[5])};
  }
  PlateLoad of_sensor(const std::array<double, 8>& v) const {
    const Vector<3> force(v[0], v[1], v[2]);
    return {force, Vector<3>(v[3], v[4], v[5]) - origin.cross(force)};
  }
  /// x of corners 1 and 2, of 3 and 4; y of 1 and 4, of 2 and 3; z of each.
  PlateLoad of_corners(const std::array<double, 8>& v) const {
    const double a = std::abs(origin.x()), b = std::abs(origin.y());
    const Vector<3> force(v[0] + v[1], v[2] + v[3], v[4] + v[5] + v[6] + v[7]);
    const Vector<3> moment(b * (v[4] + v[5] - v[6] - v[7]), a * (-v[4] + v[5] + v[6] - v[7]),
                           b * (-v[0] + v[1]) + a * (v[2] - v[3]));
    return {force, moment - Vector<3>(0, 0, origin.z()).cross(force)};
  }
  std::array<double, 8> calibrated(const std::array<double, 8>& v) const {
    const Eigen::Matrix<double, 6, 1> loads = calibration * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(v.data());
    std::array<double, 8> result{};
    for (Eigen::Index i = 0; i < 6; ++i) result[static_cast<std::size_t>(i)] = loads[i] * unit[static_cast<std::size_t>(i)];
    return result;
  }
};

class PlateReader {
 public:
  explicit PlateReader(const AuxiliaryData& auxiliary) : path_(auxiliary.path), file_(auxiliary), units_(file_.units()) {}

  AnalogData read() {
    if (file_.channels() == 0 || file_.samples() == 0) return std::move(data_);
    data_.rate_hz = file_.rate_hz() * static_cast<double>(file_.samples());
    data_.begin_s = static_cast<double>(file_.first_index()) / file_.rate_hz();
    if (!(std::isfinite(data_.rate_hz) && data_.rate_hz > 0)) throw Error("{}: its rate is not a positive number", path_);
    read_values();
    const std::vector<C3dParameter> parameters = file_.group("FORCE_PLATFORM", UpAxis::z);
    const PlateGroup group(parameters);
    for (std::size_t p = 0; p < group.used(); ++p) add_plate(group, p);
    add_channels();
    return std::move(data_);
  }

 private:
  /// By channel.
  void read_values() {
    const std::size_t n = file_.channels(), samples = file_.samples(), rows = samples * static_cast<std::size_t>(file_.frames());
    if (n * rows > kMaxAnalogValues) throw Error("{}: {} analog values; at most {} are read", path_, n * rows, kMaxAnalogValues);
    values_.assign(n, std::vector<double>(rows));
    const std::vector<double> scales = file_.scales();
    for (std::int64_t f = 0; f < file_.frames(); ++f) {
      const std::span<const float> row = file_.frame(file_.first_index() + f);
      for (std::size_t i = 0; i < row.size(); ++i) {
        const std::size_t c = i % n;
        const double value = (static_cast<double>(row[i]) - file_.offsets()[c]) * scales[c];
        values_[c][static_cast<std::size_t>(f) * samples + i / n] = std::isfinite(value) ? value : 0;
      }
    }
  }

  void omit(std::size_t plate, std::string_view why) {
    data_.warnings.push_back(fmt::format("{}: force plate {} is omitted: {}", path_, plate + 1, why));
  }

  void add_plate(const PlateGroup& group, std::size_t p) {
    const auto types = group.of("TYPE", p, 1, 1), corners = group.of("CORNERS", p, 12, 12);
    const int type = types.empty() ? 0 : static_cast<int>(types[0]);
    const auto count = channels_of_type(type);
    if (!count) return omit(p, fmt::format("its type is {}; 1 to 4 are supported", type));
    if (corners.empty()) return omit(p, "the file lacks its corners");
    PlateChannels channels;
    channels.type = type;
    if (!find_channels(group, p, *count, channels)) return omit(p, "its channels are not in the file");
    if (type == 4 && !find_calibration(group, p, channels)) return omit(p, "the file lacks its CAL_MATRIX");
    ForcePlate plate;
    plate.name = fmt::format("plate {}", p + 1);
    plate.type = type;
    for (std::size_t c = 0; c < 4; ++c) plate.corners[c] = Vector<3>(corners[3 * c], corners[3 * c + 1], corners[3 * c + 2]) / 1000;
    if (!plate.axes().allFinite() || std::abs(plate.axes().determinant() - 1) > 1e-6)
      return omit(p, "its corners are not those of a rectangle");
    plate.rate_hz = data_.rate_hz;
    plate.begin_s = data_.begin_s;
    find_origin(group, p, channels);
    find_units(channels);
    read_loads(channels, plate);
    data_.plates.push_back(std::move(plate));
  }

  bool find_channels(const PlateGroup& group, std::size_t p, std::size_t count, PlateChannels& channels) {
    const auto numbers = group.of("CHANNEL", p, count, group.stride("CHANNEL", count));
    for (const double number : numbers) {
      if (!(number >= 1 && number <= static_cast<double>(values_.size()))) return false;
      channels.channels.push_back(static_cast<std::size_t>(number) - 1);
    }
    of_plates_.insert(channels.channels.begin(), channels.channels.end());
    return !numbers.empty();
  }

  static bool find_calibration(const PlateGroup& group, std::size_t p, PlateChannels& channels) {
    const auto numbers = group.of("CAL_MATRIX", p, 36, 36);
    if (!numbers.empty()) channels.calibration = Eigen::Map<const Eigen::Matrix<double, 6, 6>>(numbers.data());
    return !numbers.empty();
  }

  /// In m. The file says where the surface's middle is from the sensor, with z down: a sensor is below it, so that z is negative.
  /// Some write the vector from the surface to the sensor.
  static void find_origin(const PlateGroup& group, std::size_t p, PlateChannels& channels) {
    const auto numbers = group.of("ORIGIN", p, 3, 3);
    if (numbers.empty()) return;
    channels.origin = Vector<3>(numbers[0], numbers[1], numbers[2]) / 1000;
    if (channels.origin.z() > 0) channels.origin = -channels.origin;
  }

  void find_units(PlateChannels& channels) const {
    for (std::size_t i = 0; i < channels.channels.size(); ++i) {
      const std::string_view unit = units_[channels.channels[i]];
      const bool kilo = unit.starts_with("kN");
      const bool force = channels.type == 3 || i < 3;
      if (channels.type == 4) {
        channels.unit[i] = force ? 1 : file_.unit_m();
      } else {
        channels.unit[i] = (kilo ? 1000 : 1) * (force ? 1 : metres_of_unit(unit, file_.unit_m()));
      }
    }
  }

  void read_loads(const PlateChannels& channels, ForcePlate& plate) {
    const Matrix<3> axes = plate.axes();
    std::vector<double> row(values_.size());
    plate.loads.resize(values_[0].size());
    for (std::size_t r = 0; r < plate.loads.size(); ++r) {
      for (const std::size_t c : channels.channels) row[c] = values_[c][r];
      const PlateLoad load = channels.load(row);
      plate.loads[r] = {axes * load.force, axes * load.moment};
    }
    for (const std::size_t c : channels.channels) mark_limits(values_[c], plate);
    if (const auto count = std::count(plate.saturated.begin(), plate.saturated.end(), 1); count > 0)
      data_.warnings.push_back(fmt::format("{}: {}: a channel is at its limit for {:.2f} s; loads are unknown there", path_,
                                           plate.name, static_cast<double>(count) / plate.rate_hz));
  }

  /// Where a channel's largest or smallest value repeats, unless that is where it rests.
  void mark_limits(const std::vector<double>& values, ForcePlate& plate) const {
    if (values.empty()) return;
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    std::vector<double> sorted = values;
    const auto middle = sorted.begin() + std::ssize(sorted) / 2;
    std::nth_element(sorted.begin(), middle, sorted.end());
    const auto longest = std::max(kMinAtLimit, static_cast<std::size_t>(std::ceil(kAtLimitS * data_.rate_hz)));
    for (const double limit : {*lowest, *highest}) {
      // A channel that rests there is not at a limit.
      if (std::abs(limit - *middle) < 0.2 * (*highest - *lowest) || limit == 0) continue;
      for (std::size_t begin = 0; begin < values.size();) {
        std::size_t end = begin;
        while (end < values.size() && values[end] == limit) ++end;
        if (end - begin >= longest) {
          plate.saturated.resize(values.size(), 0);
          std::fill(plate.saturated.begin() + static_cast<std::ptrdiff_t>(begin),
                    plate.saturated.begin() + static_cast<std::ptrdiff_t>(end), std::uint8_t{1});
        }
        begin = std::max(end, begin + 1);
      }
    }
  }

  void add_channels() {
    const std::vector<std::string> labels = file_.labels();
    for (std::size_t c = 0; c < values_.size(); ++c) {
      if (!of_plates_.contains(c)) data_.channels.push_back({plain_text(labels[c]), plain_text(units_[c]), std::move(values_[c])});
    }
  }

  std::string path_;
  C3dAuxiliary file_;
  std::vector<std::string> units_;
  AnalogData data_;
  std::vector<std::vector<double>> values_;  // by channel
  std::set<std::size_t> of_plates_;
};

}  // namespace

AnalogData read_analog_data(const AuxiliaryData& auxiliary) {
  return auxiliary.path.empty() ? AnalogData() : PlateReader(auxiliary).read();
}

}  // namespace marey::format::motion
