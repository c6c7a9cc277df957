// An edit as a person writes it: a word, the tracks it is done to, frames where it is not done to all of them.
//   rename LKNE LKneeOuter        swap LKNE RKNE 120:180       split LKNE 300 [NAME]       join LKNE LKNE2
//   delete LKNE,RKNE [120:180]    fill all|LKNE [120:180] [spline|rigid|pattern] [longest=0.5] [within=20]
//   filter all|LKNE [6|auto] [120:180]                       team LKNE,RKNE left
//   turn racket [310:]
// Tracks are named by their labels, or #12 by their numbers; names with blanks or commas stand in double quotes. Frames are counted
// from 0, both ends included; `120:` is from there on, `:180` up to there.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/edit/operation.h"

namespace marey::edit {

struct Request {
  Operation::Kind kind{};
  std::vector<std::string> tracks = {};  ///< as written; `all` alone stands for all of them; of turn the body
  std::optional<FrameRange> frames = {};
  std::string label = {};                 ///< of rename, split and team
  std::optional<FillMethod> method = {};  ///< of fill; nothing: the one that does best
  double longest_s = 1;                   ///< of fill
  double within_m = 0.05;                 ///< of fill
  std::optional<double> cutoff_hz = {};   ///< of filter; nothing: what residual analysis proposes for each track
};

/// FIRST:LAST alone; nothing for what is not a range. Throws Error for one that ends before it begins.
std::optional<FrameRange> parse_range(std::string_view text);

/// Throws Error, saying what is wrong and what is valid.
Request parse_request(std::string_view text);

}  // namespace marey::edit
