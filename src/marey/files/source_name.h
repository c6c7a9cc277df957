#pragma once

#include <string>
#include <string_view>

namespace marey {

/// The kinds of sources that are not files, by what their names begin with: "v4l2:/dev/video0", "gige:SERIAL", "rtsp://host/path",
/// "play:walk.avi?loop", "sim://room?cameras=8". Empty for anything else, which is a path.
std::string_view scheme_of(std::string_view source);

/// What is safe to be shown and kept of a source's name: without a user's name and password.
std::string shown_source(std::string_view source);

/// The source of a rig file in `folder`, as seen from where the program runs: a relative path lies in the folder, also one that is
/// played; what names a device or a host is not a path.
std::string source_in_folder(const std::string& folder, const std::string& source);

/// The path of a source that is a path, also of one that is played, without its options; empty for a device and a host.
std::string path_of_source(std::string_view source);

}  // namespace marey
