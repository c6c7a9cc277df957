#pragma once

#include <string>

namespace marey {

/// Whether the path is "-", or leads to a pipe or a device.
bool is_stream(const std::string& path);

/// Whether two paths lead to one file, through links too; it need not be there.
bool is_one_file(const std::string& a, const std::string& b);

/// Whether writing `output` would change the data read from `input`: the same file, by device and inode, or one of the images of
/// a folder or a pattern. A stream is never overwritten, nor is what is not there.
bool overwrites(const std::string& output, const std::string& input);

}  // namespace marey
