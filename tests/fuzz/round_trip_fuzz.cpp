// What we write, we read: an input that is points, a rig or people on the ground (its first byte says which) is written in every
// format; where that is taken, it reads back as what it was, within what the format holds.
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/error.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/match/ground_match.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace fs = std::filesystem;
namespace format = marey::format;
using format::Content;
namespace match = marey::format::match;
namespace motion = marey::format::motion;
namespace rig = marey::format::rig;

namespace {

/// An empty folder, the same one for every input.
std::string folder() {
  static const fs::path path = fs::temp_directory_path() / ("round_trip_fuzz_" + std::to_string(getpid()));
  fs::remove_all(path);
  fs::create_directory(path);
  return path.string() + "/";
}

/// Whether it was done; false where the format cannot hold it.
bool taken(const std::function<void()>& write) {
  try {
    write();
    return true;
  } catch (const marey::Error& error) {
    check(error.what()[0] != '\0');
    return false;
  }
}

/// Of a frame that has samples: how many, and the sum of their places, which no order changes.
struct Sum {
  std::size_t count = 0;
  marey::Vector<3> location = marey::Vector<3>::Zero();
  double largest = 0;
};

std::vector<Sum> sums(format::FileReader& reader) {
  std::vector<Sum> result;
  while (const auto instant = reader.next()) {
    Sum sum;
    for (const marey::Sample& sample : instant->samples) {
      ++sum.count;
      sum.location += sample.position;
      sum.largest = std::max(sum.largest, sample.position.cwiseAbs().maxCoeff());
    }
    if (sum.count > 0) result.push_back(sum);
  }
  return result;
}

void check_motion(std::string_view text) {
  const auto read = [&] { return motion::read_tidy_csv(text, "file"); };
  const std::vector<Sum> before = sums(*read());
  for (const auto& [name, file] :
       {std::pair{"take", "a.marey"}, std::pair{"c3d", "a.c3d"}, std::pair{"trc", "a.trc"}, std::pair{"csv", "a.csv"}}) {
    const std::string path = folder() + file;
    const format::Format& written_as = format::format_to_write(path, name, Content::space);
    const bool written = taken([&] {
      const format::WritePlan plan = format::plan_of(*read(), "file");
      const auto sink = format::create_recording(path, written_as, plan);
      const auto reader = read();
      sink->begin(plan.info.header);
      for (bool first = true; auto instant = reader->next(); first = false) {
        if (first) instant->named = plan.info.tracks;
        sink->write(*instant);
      }
      sink->finish();
    });
    if (!written) continue;
    const std::vector<Sum> after = sums(*format::open_recording(path, written_as));
    check(after.size() == before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      check(after[i].count == before[i].count);
      const double maximum = static_cast<double>(before[i].count) * (1e-3 + 1e-5 * before[i].largest);
      check((after[i].location - before[i].location).norm() <= maximum);
    }
  }
}

void check_rig(std::string_view text) {
  const marey::Rig before = rig::parse_rig(text, "file");
  for (const auto& [name, file] :
       {std::pair{"marey", "a.toml"}, std::pair{"opencv", "a.yml"}, std::pair{"opencv", "a.json"},
        std::pair{"aniposelib", "b.toml"}, std::pair{"qualisys", "a.qca.txt"}, std::pair{"tsai", "a.xml"}}) {
    const std::string path = folder() + file;
    const format::Format& written_as = format::format_to_write(path, name, Content::rig);
    if (!taken([&] { written_as.write_rig(before, path); })) continue;
    const marey::Rig after = format::format_to_read(path, Content::rig).read_rig(path);
    check(after.cameras.size() == before.cameras.size());
    for (std::size_t i = 0; i < after.cameras.size(); ++i) {
      const auto &ours = before.cameras[i].camera_from_world, &theirs = after.cameras[i].camera_from_world;
      if (!ours || !theirs) continue;
      check((ours->rotation - theirs->rotation).norm() < 1e-4);
      check((ours->translation - theirs->translation).norm() < 1e-3 + 1e-4 * ours->translation.norm());
    }
  }
}

void check_match(std::string_view text) {
  match::GroundMatch before;
  before.recording = match::parse_ground(text, "file");
  if (before.recording.samples() == 0) return;  // some formats are rows alone, and an empty file is refused
  for (const auto& [name, file] : {std::pair{"ground", "a.csv"}, std::pair{"mot", "a.txt"}, std::pair{"metrica", "a_home.csv"},
                                   std::pair{"tracab", "a.dat"}, std::pair{"epts", "a.xml"}, std::pair{"soccernet", "a.json"}}) {
    const std::string path = folder() + file;
    std::vector<std::string> warnings;
    const format::Format& written_as = format::format_to_write(path, name, Content::ground);
    if (!taken([&] { warnings = format::write_whole(path, written_as, before); })) continue;
    const match::GroundMatch after = format::read_match(path);
    // Who is of a third team is left out by some formats, which they say.
    check(warnings.empty() ? after.recording.samples() == before.recording.samples()
                           : after.recording.samples() <= before.recording.samples());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = marey::fuzz::text_of(data + 1, size - 1);
  constexpr std::array<void (*)(std::string_view), 3> kChecks{check_motion, check_rig, check_match};
  const auto check_it = kChecks[data[0] % kChecks.size()];
  try {
    check_it(text);
  } catch (const marey::Error& error) {
    // Reading the input may end so; what was written must read.
    if (!std::string_view(error.what()).starts_with("file")) throw;
  }
  return 0;
}
