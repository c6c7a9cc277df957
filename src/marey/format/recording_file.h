// Recordings in files of any format of the register: opened, read whole, written.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/format/format.h"
#include "marey/format/match/ground_match.h"

namespace marey::format {

/// The axis of a file of points that is taken for up: what the user says, else what the file says, else z.
UpAxis up_axis(const FileInfo& info, const std::optional<UpAxis>& stated);

/// Opens a recording instant by instant, whatever its format. Where its y is up, it is turned so that z is; a warning says so where
/// the file alone said it. Throws Error for what cannot be read.
std::unique_ptr<FileReader> open_recording(const std::string& path, const Format& format, const ReadOptions& options = {});
/// The same, known by its content.
std::unique_ptr<FileReader> open_recording(const std::string& path, const ReadOptions& options = {});

/// A whole recording, with what match formats contain beyond it.
match::GroundMatch read_whole(const std::string& path, const Format& format, const ReadOptions& options = {});
/// One of people on the ground, known by its content; "-" is CSV from standard input. Throws Error if it is not of the ground.
match::GroundMatch read_match(const std::string& path, const ReadOptions& options = {});

/// A reader in memory; what match formats contain beyond the recording is omitted. The recording must outlive it.
std::unique_ptr<FileReader> reader_of(const Recording& recording);

/// What a writer must know beforehand. Reads all of it. Throws Error, with `name` for the file, where millions of frames are
/// missing, which most formats would have to write out: a slip in a frame's number would fill the disk.
WritePlan plan_of(FileReader& reader, const std::string& name);

/// What writes a recording instant by instant, or gathers it where the format is written whole. A take's edits are the plan's; a
/// format that is written while recording needs none. `lost` gets what the format could not hold, with `finish`.
std::unique_ptr<Sink> create_recording(const std::string& path, const Format& format, const WritePlan& plan = {},
                                       std::vector<std::string>* lost = nullptr);

/// What a user should know where a recording has bodies and `format` holds no poses; nothing if it does, or no bodies exist.
std::optional<std::string> poses_lost(const RecordingHeader& header, const std::string& path, const Format& format);

/// The same of what stood beside the points of a file that was read.
std::optional<std::string> auxiliary_lost(const AuxiliaryData& auxiliary, const std::string& path, const Format& format);

/// Writes a recording that is whole, and says what the format could not hold.
std::vector<std::string> write_whole(const std::string& path, const Format& format, const match::GroundMatch& match,
                                     UpAxis up = UpAxis::z);

}  // namespace marey::format
