#include "marey/format/register.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <vector>

#include <fmt/format.h>

// One line a format, in the order in which a file is asked: the first that says yes has it. Each stands at the end of its own file.
// clang-format off
#define MAREY_FORMATS(row) \
  row(format::take, take) \
  row(format::mcap, mcap) \
  row(format::skeleton, bvh) \
  row(format::skeleton, acclaim) \
  row(format::skeleton, glb) \
  row(format::scene, blender) \
  row(format::bodies, poses) \
  row(format::motion, trc) \
  row(format::motion, motive) \
  row(format::motion, nexus) \
  row(format::motion, qualisys_tsv) \
  row(format::motion, qualisys_mat) \
  row(format::tracks, blobs) \
  row(format::tracks, image_csv) \
  row(format::tracks, jsonl) \
  row(format::keypoints, coco) \
  row(format::keypoints, openpose) \
  row(format::tracks, mots) \
  row(format::tracks, coco_instances) \
  row(format::match, ground) \
  row(format::match, soccernet) \
  row(format::match, sportec) \
  row(format::match, tracab) \
  row(format::match, epts) \
  row(format::match, metrica) \
  row(format::match, world_mot) \
  row(format::tracks, detections) \
  row(format::tracks, image_mot) \
  row(format::match, statsperform) \
  row(format, observations) \
  row(format::motion, tidy_csv) \
  row(format::motion, c3d) \
  row(format::rig, opencv) \
  row(format::rig, qualisys) \
  row(format::rig, tsai) \
  row(format::bodies, bodies) \
  row(format::bodies, label_set) \
  row(format::rig, soccernet_camera) \
  row(format::rig, marey) \
  row(format::rig, aniposelib) \
  row(format::rig, openptv) \
  row(format::rig, self_cal) \
  row(format::motion, labels)
// clang-format on

#define MAREY_DECLARED(room, name) \
  namespace marey::room {          \
  format::Format name##_format();  \
  }
MAREY_FORMATS(MAREY_DECLARED)

namespace marey::format {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kInspectedAt = std::size_t{64} << 10;
constexpr std::array kContents = {Content::space,        Content::image,      Content::ground, Content::rig,
                                  Content::observations, Content::detections, Content::labels};

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// The parts of a text between blanks.
std::vector<std::string_view> words_in(std::string_view text) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (end > 0) words.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

std::string listed(const std::vector<std::string>& words, std::string_view between = ", ") {
  return fmt::format("{}", fmt::join(words, between));
}

template <typename Wanted>
std::string names_of(Wanted&& required) {
  std::vector<std::string> names;
  for (const Format& format : formats()) {
    if (required(format) && std::find(names.begin(), names.end(), format.name) == names.end()) names.emplace_back(format.name);
  }
  return listed(names);
}

std::string words_of_all(Contents contents) {
  std::vector<std::string> words;
  for (const Content one : kContents) {
    if (contents.has(one)) words.emplace_back(words_of(one));
  }
  return listed(words);
}

constexpr Contents kAll = kRecordings | Content::rig | Content::observations | Content::detections | Content::labels;

[[noreturn]] void refuse(const std::string& path, const Format& format, Content content) {
  throw WrongFormat("{}: {} holds {}, and not {}; these can be written: {}", path, format.title, words_of_all(format.holds),
                    words_of(content), endings_of_written(content));
}

}  // namespace

Content content_of(const FrameOfReference& frame) {
  if (!frame.metric()) return Content::image;
  return frame.dimensions() == 2 ? Content::ground : Content::space;
}

std::string_view words_of(Content content) {
  switch (content) {
    case Content::image:
      return "tracks in an image";
    case Content::ground:
      return "people on the ground";
    case Content::space:
      return "points in space";
    case Content::rig:
      return "calibrations";
    case Content::observations:
      return "observations of markers";
    case Content::detections:
      return "detections";
    case Content::labels:
      return "names of markers";
  }
  return {};
}

std::string_view Beginning::text() const {
  std::string_view all = bytes;
  if (all.starts_with("\xEF\xBB\xBF")) all.remove_prefix(3);
  return all;
}

std::string_view Beginning::first_line() const {
  std::string_view all = text();
  all.remove_prefix(std::min(all.find_first_not_of("\r\n"), all.size()));
  return all.substr(0, all.find_first_of("\r\n"));
}

Beginning beginning_of(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw Error("{}: no such file; is the name right?", path);
  Beginning beginning{.path = path, .folder = fs::is_directory(status), .bytes = {}};
  if (beginning.folder) return beginning;
  if (!fs::is_regular_file(status)) return beginning;  // data read from a pipe is gone
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error("{}: cannot be read; have you the right to?", path);
  beginning.bytes.resize(kInspectedAt);
  in.read(beginning.bytes.data(), std::ssize(beginning.bytes));
  beginning.bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  return beginning;
}

std::span<const Format> formats() {
#define MAREY_CALLED(room, name) marey::room::name##_format(),
  static const std::vector<Format> all = {MAREY_FORMATS(MAREY_CALLED)};
  return all;
}

const Format* format_of_content(const std::string& path) {
  const Beginning beginning = beginning_of(path);
  const auto known = std::find_if(formats().begin(), formats().end(),
                                  [&](const Format& format) { return format.is != nullptr && format.is(beginning); });
  return known == formats().end() ? nullptr : &*known;
}

const Format& format_to_read(const std::string& path, Contents required) {
  const Format* format = format_of_content(path);
  if (format == nullptr && !fs::is_regular_file(path) && !fs::is_directory(path))
    throw Error("{}: is not a file, and is inspected more than once; write what it says to a file first", path);
  if (format == nullptr)
    throw Error("{}: {} not one of the files that Marey knows; {} are wanted: {}", path,
                fs::is_directory(path) ? "is a folder, and" : "is", words_of_all(required), names_of_read(required));
  if (!format->holds.any_of(required))
    throw Error("{}: is {}; {} are wanted: {}", path, format->title, words_of_all(required), names_of_read(required));
  return *format;
}

const Format* format_named(std::string_view name, Contents required) {
  for (const Format& format : formats()) {
    if (format.name == name && format.holds.any_of(required)) return &format;
  }
  return name.find_first_of("./_") == std::string_view::npos ? format_of_name(fmt::format(".{}", name), required) : nullptr;
}

const Format* format_of_name(std::string_view path, Contents required) {
  const std::string lower = lower_case(path);
  const Format* found = nullptr;
  std::size_t longest = 0;  // "_home.csv" before ".csv"
  for (const Format& format : formats()) {
    if (!format.is_written() || !format.holds.any_of(required)) continue;
    for (const std::string_view ending : words_in(format.endings)) {
      if (ending.size() <= longest || !lower.ends_with(ending)) continue;
      found = &format;
      longest = ending.size();
    }
  }
  return found;
}

const Format& format_to_write(const std::string& path, std::string_view name, Content content) {
  if (!name.empty()) {
    if (const Format* format = format_named(name, content)) {
      if (!format->is_written())
        throw WrongFormat("{}: {} is read only; these can be written: {}", path, format->title, endings_of_written(content));
      return *format;
    }
    if (const Format* other = format_named(name, kAll); other != nullptr && !path.empty()) refuse(path, *other, content);
    if (format_named(name, kAll) != nullptr)
      throw WrongFormat("\"{}\" holds no {}; these can be written: {}", name, words_of(content), names_of_written(content));
    throw WrongFormat("\"{}\" is not a format; these can be written: {}", name, names_of_written(kAll));
  }
  if (const Format* format = format_of_name(path, content)) return *format;
  if (const Format* other = format_of_name(path, kAll)) refuse(path, *other, content);
  throw WrongFormat("{}: unknown ending; these can be written: {}; or name a format with --format", path,
                    endings_of_written(content));
}

void check_written_name(const std::string& name) {
  if (format_named(name, kAll) == nullptr)
    throw WrongFormat("\"{}\" is not a format; these can be written: {}", name, names_of_written(kAll));
}

std::string names_of_read(Contents required) {
  // Of some recordings it is reported what they hold, and no more; that counts where everything is asked for.
  const bool only_told = required.has(Content::labels);
  return names_of([&](const Format& format) {
    const bool recording = format.open != nullptr || format.read != nullptr;
    return format.is_read() && format.holds.any_of(required) && (recording || only_told || !format.holds.any_of(kRecordings));
  });
}

std::string names_of_written(Contents required) {
  return names_of([&](const Format& format) { return format.is_written() && format.holds.any_of(required); });
}

std::string endings_of_written(Contents required) {
  std::vector<std::string> all;
  for (const Format& format : formats()) {
    if (!format.is_written() || !format.holds.any_of(required)) continue;
    const auto endings = words_in(format.endings);
    all.push_back(endings.empty() ? fmt::format("--format {}", format.name) : fmt::format("{} ({})", endings.front(), format.name));
  }
  return listed(all);
}

std::string shown_endings(const Format& format) {
  std::vector<std::string> endings;
  for (const std::string_view ending : words_in(format.endings)) endings.push_back(fmt::format("`{}`", ending));
  return listed(endings);
}

std::string first_ending(const Format& format) {
  const auto endings = words_in(format.endings);
  return endings.empty() ? std::string() : std::string(endings.front());
}

std::string companion_file(const std::string& path) {
  for (const Format& format : formats()) {
    for (const auto& [ending, other] : format.companions) {
      if (path.ends_with(ending)) return path.substr(0, path.size() - ending.size()).append(other);
    }
  }
  return {};
}

std::string format_table() {
  std::string table = "| holds | format | ending | read | written | in detail |\n| --- | --- | --- | --- | --- | --- |\n";
  std::vector<const Format*> reported;
  for (const Content content : kContents) {
    for (const Format& format : formats()) {
      if (!format.holds.has(content) || std::find(reported.begin(), reported.end(), &format) != reported.end()) continue;
      reported.push_back(&format);
      const char* written = !format.is_written()                                    ? "no"
                            : format.while_recording || format.write_rig != nullptr ? "yes"
                                                                                    : "at the end";
      table += fmt::format("| {} | `{}` | {} | {} | {} | {} |\n", words_of_all(format.holds), format.name, shown_endings(format),
                           format.is_read() ? "yes" : "no", written, format.detail);
    }
  }
  return table;
}

}  // namespace marey::format
