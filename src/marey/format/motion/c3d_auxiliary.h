// What a C3D file holds beside its points, from one file into another: analog channels as they were recorded, and the groups of
// parameters that belong to them, to its events, and to the person.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/format/auxiliary_data.h"
#include "marey/format/format.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/c3d_layout.h"
#include "marey/format/motion/c3d_parameters.h"

namespace marey::format::motion {

AuxiliaryData auxiliary_data(const C3dHead& head, const C3dLayout& layout, const std::string& path);

class C3dAuxiliary {
 public:
  /// Throws Error if it cannot be read.
  explicit C3dAuxiliary(const AuxiliaryData& auxiliary);
  /// The same of bytes in memory, which must outlive it.
  C3dAuxiliary(std::span<const std::byte> bytes, const AuxiliaryData& auxiliary);

  std::size_t channels() const { return layout_.analog_channels; }
  std::size_t samples() const { return layout_.analog_samples; }  ///< of a channel in a frame
  double rate_hz() const;                                         ///< of the points
  std::int64_t first_index() const { return layout_.first_index; }
  std::int64_t frames() const { return static_cast<std::int64_t>(layout_.frames); }
  double unit_m() const { return layout_.unit_m; }  ///< of the points
  /// Of each channel; empty text if the file has none.
  std::vector<std::string> labels() const;
  std::vector<std::string> units() const;
  /// A value is (what `frame` gives − offset) · scale.
  std::vector<double> scales() const;
  const std::vector<double>& offsets() const { return offsets_; }
  /// One frame's values, sample by sample, all channels of each: what stands in the file, as floats, so that its own scales and
  /// offsets hold. Of a frame that the file has not: what stands for 0.
  std::span<const float> frame(std::int64_t index);

  /// A group's parameters by name, fit for a file whose points are in mm and whose world has `up` up; empty if absent.
  /// Corners and origins of force plates follow the unit and the axes; all else is as it was.
  std::vector<C3dParameter> group(std::string_view name, UpAxis up) const;
  /// Of the first person in it; empty if it names none.
  std::string subject() const { return head_.text("SUBJECTS:NAMES"); }

 private:
  void fit(std::string_view group, C3dParameter& parameter, UpAxis up) const;

  C3dAuxiliary(std::unique_ptr<MappedFile> file, std::span<const std::byte> bytes, const AuxiliaryData& auxiliary);

  std::unique_ptr<MappedFile> file_;
  C3dHead head_;
  C3dBytes bytes_;
  C3dLayout layout_;
  UpAxis up_;
  bool unsigned_ = false;        // integers of 16 bits without sign
  std::vector<double> offsets_;  // of each channel, as they stand
  std::vector<float> row_;
};

}  // namespace marey::format::motion
