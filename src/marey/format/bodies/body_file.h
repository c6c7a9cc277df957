// bodies.toml: rigid bodies by their markers, as `marey body define` writes them and people do by hand.
//
//   [[body]]
//   name = "racket"
//   [[body.marker]]
//   label = "tip"
//   position = [0.0, 0.12, 0.31]   # m, in the body's frame
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "marey/core/body.h"

namespace marey::format::bodies {

/// Reads bodies; or, where the file is one of names and places (`label,x,y,z`, m), one body of the file's name. Ids follow the
/// file's order, from 1. Throws Error with every problem, one line each, `path:LINE: what; what to do`.
std::vector<Body> read_bodies(const std::string& path);
std::vector<Body> parse_bodies(std::string_view text, const std::string& name);

/// The same as text. `notes` by body, as comments above it; none where they are fewer.
std::string bodies_text(const std::vector<Body>& bodies, const std::vector<std::vector<std::string>>& notes = {});
/// Atomically.
void write_bodies(const std::string& path, const std::vector<Body>& bodies,
                  const std::vector<std::vector<std::string>>& notes = {});

}  // namespace marey::format::bodies
