#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/recording_reader.h"
#include "marey/format/format.h"
#include "marey/format/match/ground_match.h"
#include "marey/pipeline/take/describe_edits.h"

#include "json_value.h"

// What `marey info` says, for people and for programs.
namespace marey::cli {

/// "points in space: take, c3d, …; calibrations: …".
std::string files_that_are_known();

/// 1,234,567
std::string counted(std::int64_t value);
std::string duration_words(double duration_s);
void print_row(const char* name, const std::string& value);
void print_warnings(const std::vector<std::string>& warnings);

/// `summary` is of what the edits that count have left; `edits` are all of them, in words.
void print_recording(const std::string& path, const format::Format& format, const format::FileInfo& info,
                     const RecordingSummary& summary, const std::vector<pipeline::take::EditLine>& edits);
Json info_json(const format::Format& format, const format::FileInfo& info, const RecordingSummary& summary,
               const std::vector<pipeline::take::EditLine>& edits);

void print_match(const std::string& path, const format::Format& format, const format::match::GroundMatch& match);
Json info_json(const format::Format& format, const format::match::GroundMatch& match);

void print_rig(const Rig& rig);
/// Its cameras.
Json info_json(const Rig& rig);

}  // namespace marey::cli
