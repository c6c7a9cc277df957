#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "marey/core/rig.h"

namespace marey::format::rig {

/// Calibrations as Marey and other programs keep them.
enum class RigFormat {
  marey,       ///< rig.toml
  opencv,      ///< cv::FileStorage: YAML, XML or JSON
  aniposelib,  ///< TOML of aniposelib and Caliscope
  self_cal,    ///< a folder of MultiCamSelfCal
  qualisys,    ///< .qca.txt, which is XML
  tsai,        ///< XML of one camera in Tsai's model, as PETS gives it
};

/// Every format's name with commas between.
std::string rig_format_names();
/// Throws Error with the list of names where there is no such format.
RigFormat parse_rig_format(std::string_view name);
/// What is at `path` (a file or a folder), by its content; nothing where it is no calibration that is known.
std::optional<RigFormat> rig_format_of_content(const std::string& path);
/// What the name of a file to be written says: .toml, .yml and .yaml and .json, .qca.txt, .xml (Tsai), a name that ends in /
/// (MultiCamSelfCal).
std::optional<RigFormat> rig_format_of_name(std::string_view path);

/// Reads a calibration of any of these. Units become metres (aniposelib does not say its unit: see docs/rig.md); what the
/// format does not know is missing. Throws Error with the file, and the camera where there is one.
Rig read_rig_any(const std::string& path);

/// Writes one. Throws Error where it cannot be written, or where the format cannot hold this rig: it says which camera and what to
/// do. Lenses that the format does not know are replaced by the nearest that it does, within 0.05 px RMS, else refused.
void write_rig_as(const Rig& rig, const std::string& path, RigFormat format);

// One file each.
Rig read_opencv_rig(const std::string& path);
Rig read_aniposelib_rig(const std::string& path);
Rig read_self_cal_rig(const std::string& path);
Rig read_qualisys_rig(const std::string& path);
Rig read_tsai_rig(const std::string& path);
// The same of text already in memory; `name` stands for the path in messages.
Rig parse_opencv_rig(const std::string& text, const std::string& name);
Rig parse_aniposelib_rig(std::string_view text, const std::string& name);
Rig parse_qualisys_rig(std::string_view text, const std::string& name);
Rig parse_tsai_rig(std::string_view text, const std::string& name);
void write_opencv_rig(const Rig& rig, const std::string& path);
void write_aniposelib_rig(const Rig& rig, const std::string& path);
void write_self_cal_rig(const Rig& rig, const std::string& path);
void write_qualisys_rig(const Rig& rig, const std::string& path);
void write_tsai_rig(const Rig& rig, const std::string& path);

/// For those who read: what an imported camera must fulfil. Rotations rounded by a writer are made exact; names are made fit for a
/// rig. Throws Error that names `path` and the camera.
void check_imported(Rig& rig, const std::string& path);

/// The camera's lens as a Brown lens of at most `coefficients` (4 or 5): itself, or the nearest. Throws Error where that is off by
/// more than 0.05 px RMS over the picture, or lens or size is missing.
geometry::BrownLens as_brown(const RigCamera& camera, int coefficients, std::string_view format);

}  // namespace marey::format::rig
