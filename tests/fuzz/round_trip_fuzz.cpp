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
#include "marey/format/match/ground_exchange.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/motion/motion.h"
#include "marey/format/motion/motion_csv.h"
#include "marey/format/rig/rig_exchange.h"
#include "marey/format/rig/rig_file.h"

#include "fuzz.h"

using marey::fuzz::check;
namespace fs = std::filesystem;
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
  marey::Vector<3> place = marey::Vector<3>::Zero();
  double largest = 0;
};

std::vector<Sum> sums(motion::MotionReader& reader) {
  std::vector<Sum> result;
  while (const auto instant = reader.next()) {
    Sum sum;
    for (const marey::Sample& sample : instant->samples) {
      ++sum.count;
      sum.place += sample.position;
      sum.largest = std::max(sum.largest, sample.position.cwiseAbs().maxCoeff());
    }
    if (sum.count > 0) result.push_back(sum);
  }
  return result;
}

void check_motion(std::string_view text) {
  const auto read = [&] { return motion::read_tidy_csv(text, "file"); };
  const std::vector<Sum> before = sums(*read());
  for (const auto& [format, name] :
       {std::pair{motion::MotionFormat::take, "a.marey"}, std::pair{motion::MotionFormat::c3d, "a.c3d"},
        std::pair{motion::MotionFormat::trc, "a.trc"}, std::pair{motion::MotionFormat::csv, "a.csv"}}) {
    const std::string path = folder() + name;
    const bool written = taken([&] {
      const motion::MotionPlan plan = motion::plan_of(*read(), "file");
      const auto sink = motion::create_motion(path, format, plan);
      const auto reader = read();
      sink->begin(plan.info.header);
      for (bool first = true; auto instant = reader->next(); first = false) {
        if (first) instant->named = plan.info.tracks;
        sink->write(*instant);
      }
      sink->finish();
    });
    if (!written) continue;
    const std::vector<Sum> after = sums(*motion::open_motion(path, format));
    check(after.size() == before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      check(after[i].count == before[i].count);
      const double most = static_cast<double>(before[i].count) * (1e-3 + 1e-5 * before[i].largest);
      check((after[i].place - before[i].place).norm() <= most);
    }
  }
}

void check_rig(std::string_view text) {
  const marey::Rig before = rig::parse_rig(text, "file");
  for (const auto& [format, name] : {std::pair{rig::RigFormat::marey, "a.toml"}, std::pair{rig::RigFormat::opencv, "a.yml"},
                                     std::pair{rig::RigFormat::opencv, "a.json"}, std::pair{rig::RigFormat::aniposelib, "b.toml"},
                                     std::pair{rig::RigFormat::qualisys, "a.qca.txt"}, std::pair{rig::RigFormat::tsai, "a.xml"}}) {
    const std::string path = folder() + name;
    if (!taken([&] { rig::write_rig_as(before, path, format); })) continue;
    const marey::Rig after = rig::read_rig_any(path);
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
  for (const auto& [format, name] :
       {std::pair{match::GroundFormat::csv, "a.csv"}, std::pair{match::GroundFormat::mot, "a.txt"},
        std::pair{match::GroundFormat::metrica, "a_home.csv"}, std::pair{match::GroundFormat::tracab, "a.dat"},
        std::pair{match::GroundFormat::epts, "a.xml"}, std::pair{match::GroundFormat::soccernet, "a.json"}}) {
    const std::string path = folder() + name;
    std::vector<std::string> warnings;
    if (!taken([&] { warnings = match::write_ground_as(before, path, format); })) continue;
    const match::GroundMatch after = match::read_ground_any(path);
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
