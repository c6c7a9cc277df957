#pragma once

#include <string>
#include <string_view>

#include "marey/core/rig.h"
#include "marey/format/format.h"

namespace marey::format::rig {

// Calibrations of other programs, one file each. Units become metres (aniposelib does not specify its unit: see docs/rig.md); what
// the format does not know is missing. Lenses that a format does not know are replaced by the nearest that it does, within 0.05 px
// RMS, else refused. All throw Error with the file, and the camera where there is one.
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

/// Whether the text begins as XML does.
bool is_xml(const Beginning& file);

/// For those who read: what an imported camera must fulfil. Rotations rounded by a writer are made exact; names are made fit for a
/// rig. Throws Error that names `path` and the camera.
void check_imported(Rig& rig, const std::string& path);

/// The camera's lens as a Brown lens of at most `coefficients` (4 or 5): itself, or the nearest. Throws Error if that is off by
/// more than 0.05 px RMS over the image, or lens or size is missing.
geometry::BrownLens as_brown(const RigCamera& camera, int coefficients, std::string_view format);

}  // namespace marey::format::rig
