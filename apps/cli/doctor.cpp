#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>

extern "C" {
#include <libavcodec/avcodec.h>
}

#include "command_line.h"
#include "commands.h"
#include "completion.h"
#include "json_value.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

/// One thing that is there or not.
struct Finding {
  const char* group;
  std::string name;
  bool there;
  std::string detail;  ///< what it is, or how to get it
};

std::string found_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string rest = path != nullptr ? path : "/usr/bin:/bin";
  for (std::size_t begin = 0; begin <= rest.size();) {
    const std::size_t end = std::min(rest.find(':', begin), rest.size());
    const std::string candidate = rest.substr(begin, end - begin) + "/" + name;
    if (access(candidate.c_str(), X_OK) == 0 && !fs::is_directory(candidate)) return candidate;
    begin = end + 1;
  }
  return {};
}

Finding program(const char* name, const char* serves, const char* package) {
  const std::string path = found_program(name);
  return {"programs", name, !path.empty(), path.empty() ? fmt::format("{}: apt install {}", serves, package) : path};
}

Finding h264_encoder() {
  const AVCodec* encoder = avcodec_find_encoder(AV_CODEC_ID_H264);
  const char* serves = "videos of overlays are written";
  return {"videos", encoder == nullptr ? "H.264 encoder" : encoder->name, encoder != nullptr,
          encoder != nullptr ? serves : fmt::format("{}: this build of FFmpeg lacks it", serves)};
}

Finding decoder(AVCodecID id, const char* name) {
  const bool there = avcodec_find_decoder(id) != nullptr;
  return {"videos", name, there, there ? "is read" : "this build of FFmpeg does not read it"};
}

std::vector<Finding> cameras() {
  std::vector<Finding> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/sys/class/video4linux", error)) {
    std::string name;
    std::getline(std::ifstream(entry.path() / "name"), name);
    const std::string device = "/dev/" + entry.path().filename().string();
    const bool readable = access(device.c_str(), R_OK) == 0;
    found.push_back({"cameras", device, readable, readable ? name : name + ": may not be read; add yourself to the group video"});
  }
  if (found.empty())
    found.push_back({"cameras", "video devices", false, "none is connected; files and folders of images need none"});
  return found;
}

std::vector<Finding> examine() {
  std::vector<Finding> found{
      {"machine", "processors", true, fmt::format("{} at once", std::thread::hardware_concurrency())},
      {"machine", "AVX2", __builtin_cpu_supports("avx2") != 0, "markers and background models are faster with it"},
      {"machine", "AVX-512", __builtin_cpu_supports("avx512bw") != 0, "markers are faster with it"},
      decoder(AV_CODEC_ID_H264, "H.264"),
      decoder(AV_CODEC_ID_HEVC, "HEVC"),
      decoder(AV_CODEC_ID_AV1, "AV1"),
      h264_encoder(),
      program("ffmpeg", "the wheel of Python reads videos by it", "ffmpeg"),
      program("parallel", "marey batch submit --engine parallel", "parallel"),
      program("sbatch", "marey batch submit --engine slurm", "slurm-client"),
  };
  for (Finding& camera : cameras()) found.push_back(std::move(camera));
  return found;
}

void run_doctor(bool json, bool quiet) {
  const std::vector<Finding> found = examine();
  if (json) {
    Json list = Json::array();
    for (const Finding& each : found)
      list.push_back({{"group", each.group}, {"name", each.name}, {"there", each.there}, {"detail", each.detail}});
    print({{"version", version_text()}, {"findings", list}});
    return;
  }
  if (quiet) return;
  fmt::print("marey {}\n", version_text());
  std::string group;
  for (const Finding& each : found) {
    if (each.group != group) fmt::print("{}\n", group = each.group);
    fmt::print("  {} {:<14} {}\n", each.there ? "yes" : "no ", each.name, each.detail);
  }
}

}  // namespace

void add_doctor(Command& program) {
  struct Flags {
    bool json = false, quiet = false;
  };
  auto flags = std::make_shared<Flags>();
  Command command = program.subcommand("doctor", "What is installed, which cameras are there, and how to get what is missing");
  command.reports(flags->json, flags->quiet, "findings");
  command.runs([flags] { run_doctor(flags->json, flags->quiet); });
}

void add_completion(Command& program) {
  struct Flags {
    std::string shell, manual;
    bool json = false, quiet = false;
  };
  auto flags = std::make_shared<Flags>();
  Command command = program.subcommand("completion", "What a shell needs to complete these words, or their manual pages");
  command.text("SHELL", flags->shell, "bash, zsh or fish: the script goes to standard output");
  command.output_folder("--manual", flags->manual, "folder for the manual pages, marey.1 and one a command");
  command.runs([flags, program] {
    if (flags->shell.empty() == flags->manual.empty()) throw WrongUsage("{}", "give a shell (bash, zsh, fish), or --manual FOLDER");
    if (flags->manual.empty()) {
      fmt::print("{}", completion_for(program, flags->shell));
    } else {
      write_manual(program, flags->manual);
    }
  });
}

}  // namespace marey::cli
