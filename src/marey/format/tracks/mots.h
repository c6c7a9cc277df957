#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "marey/core/run_mask.h"

namespace marey::format::tracks {

/// Masks of a file, as `marey evaluate` takes them.
struct MaskTable {
  std::vector<LabelledMask> masks;    ///< by frame, within a frame by id
  std::vector<LabelledMask> ignored;  ///< regions that are not evaluated (class 10 of MOTS text, `iscrowd` of COCO), by frame
  std::vector<std::string> warnings;
};

/// MOTS text: one mask a line, `frame id class height width rle`; frames count from 1 in the file, from 0 here. `rle` are the runs
/// of the mask in COCO's compressed form. An id names an object of one class. Class 10 is a region that is not evaluated. Throws
/// Error, `path:line: …`, for a malformed line, runs that do not fill the image, and an id that is twice in a frame.
MaskTable parse_mots(std::string_view text, const std::string& path);

/// Whether the first line of a text is such a line.
bool is_mots_text(std::string_view text);

/// Appends the line of a mask of class `kind` (MOTS: 2 is a pedestrian).
void append_mots(std::string& text, const LabelledMask& mask, int kind = 2);

/// COCO's compressed runs: 5 bits a character from '0' on, each run from the fourth on as the difference to the run before the
/// last.
std::string compressed_runs(const RunMask& mask);
/// The reverse. Throws Error, without a place, if the text is malformed or the runs do not sum to width × height.
RunMask mask_of_compressed(std::string_view text, int width, int height);

}  // namespace marey::format::tracks
