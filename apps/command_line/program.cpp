// The words of the command line: which command they name, and the message if they do not name one; then its run, and the exit code.
#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "marey/files/text_safety.h"
#include "marey/format/register.h"

#include "declared.h"
#include "run_hooks.h"
#include "spelling.h"

namespace marey::cli {
namespace {

/// Options that were called otherwise once.
struct Renamed {
  const char *before, *now;
};
constexpr Renamed kRenamed[]{{"--as-recorded", "--without-edits"},
                             {"--associate", "--association"},
                             {"--bvh-names", "--rig-names"},
                             {"--cameras", "--soccernet-cameras"},
                             {"--contact", "--contact-shadow"},
                             {"--delay", "--lag"},
                             {"--do", "--job"},
                             {"--doubts", "--review"},
                             {"--dropped", "--miss-rate"},
                             {"--dry", "--dry-run"},
                             {"--ending", "--extension"},
                             {"--every", "--detector-interval"},
                             {"--fill", "--max-gap"},
                             {"--film", "--video"},
                             {"--filmed", "--broadcast-look"},
                             {"--fit-noise", "--estimate-noise"},
                             {"--for", "--duration"},
                             {"--frame", "--l-frame"},
                             {"--ground", "--background-image"},
                             {"--hidden", "--max-occlusion"},
                             {"--in-step", "--synced"},
                             {"--jobs", "--max-jobs"},
                             {"--labelled", "--labelled-only"},
                             {"--late", "--frame-timeout"},
                             {"--least", "--min-probability"},
                             {"--least-fit", "--min-fit"},
                             {"--least-margin", "--min-margin"},
                             {"--leave-out", "--exclude"},
                             {"--light", "--light-variation"},
                             {"--lines", "--measurement-lines"},
                             {"--loose", "--outlier-factor"},
                             {"--marker-width", "--marker-diameter"},
                             {"--masks", "--foreground-masks"},
                             {"--missed", "--miss-rate"},
                             {"--most-markers", "--max-markers"},
                             {"--most-offset", "--max-offset"},
                             {"--motion", "--rom-trial"},
                             {"--names", "--annotations"},
                             {"--options", "--job-options"},
                             {"--order", "--spline-order"},
                             {"--out", "--output"},
                             {"--outline", "--contour"},
                             {"--pace", "--speed-factor"},
                             {"--part", "--shard"},
                             {"--patience", "--connect-timeout"},
                             {"--picture", "--plot"},
                             {"--pictures", "--plots"},
                             {"--predict", "--max-prediction"},
                             {"--props", "--rigid-bodies"},
                             {"--quality", "--jpeg-quality"},
                             {"--realtime", "--realtime-priority"},
                             {"--roster", "--squads"},
                             {"--scaled", "--scale-invariant"},
                             {"--seen-only", "--measured-only"},
                             {"--set", "--marker-set"},
                             {"--skin", "--soft-tissue"},
                             {"--stand", "--layout"},
                             {"--static", "--static-trial"},
                             {"--steady", "--stabilise"},
                             {"--to", "--engine"},
                             {"--to", "--undo-to"},
                             {"--videos", "--render"},
                             {"--views", "--max-views"},
                             {"--widest", "--max-width"},
                             {"--without-background", "--no-background"}};
constexpr Renamed kRenamedCommands[]{{"turning", "ptz"}, {"follow", "track"}, {"who", "identify"}};

/// Help in one notation: "--rate HZ in (0, 1e6] (25)".
class HelpText : public CLI::Formatter {
 public:
  HelpText() { column_width(38); }

  std::string make_option_opts(const CLI::Option* option) const override {
    if (option->get_type_size() == 0) return {};
    std::string text = " " + option->get_type_name();
    if (option->get_expected_min() > 1) text += " x " + std::to_string(option->get_expected_min());
    if (!option->get_default_str().empty()) text += " (" + option->get_default_str() + ")";
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
    if (option->get_required()) text += " REQUIRED";
    return text;
  }
};

/// The program or a group of commands was named without the command that is wanted.
struct CommandMissing {
  std::string help;
};

std::map<std::string, std::string> requested_for;  // of the command that runs

/// One line: it may hold words of a file or of the command, which may hold anything.
void announce(std::string_view message_text) {
  fmt::print(stderr, "marey: {}\n", plain_text(message_text));
}

/// The exit code, after the last byte of standard output: what it did not take was lost.
int finish(int code) {
  errno = 0;
  const bool lost = std::ferror(stdout) != 0 || std::fflush(stdout) != 0;
  const int reason = errno;
  if (!lost && std::fclose(stdout) == 0) return code;
  const std::string why = reason != 0 ? fmt::format(" ({})", std::strerror(reason)) : "";
  announce(fmt::format("standard output: could not be written to the end{}", why));
  return code == 0 ? 1 : code;
}

}  // namespace

struct Program::Parser {
  CLI::App app;
  Command::Declared program;
};

Command::Declared& Command::Declared::child(const std::string& word) {
  std::vector<std::string> names;
  for (const auto& each : below) {
    if (each->app->get_name() == word) return *each;
    names.push_back(each->app->get_name());
  }
  for (const Renamed& renamed : kRenamedCommands) {
    if (word == renamed.before && std::ranges::find(names, renamed.now) != names.end())
      throw WrongUsage("{} {} is called {} {} now", path(), word, path(), renamed.now);
  }
  throw WrongUsage("{} has no command \"{}\", but {}.{}", path(), word, CLI::detail::join(names, ", "), suggestion(word, names));
}

const CLI::Option& Command::Declared::option(const std::string& name) const {
  if (const CLI::Option* found = app->get_option_no_throw(name)) return *found;
  for (const Renamed& renamed : kRenamed) {
    if (name == renamed.before && app->get_option_no_throw(renamed.now) != nullptr)
      throw WrongUsage("{} is called {} now", name, renamed.now);
  }
  std::vector<std::string> names;
  for (const CLI::Option* each : app->get_options()) {
    for (const std::string& known : each->get_lnames()) names.push_back("--" + known);
  }
  throw WrongUsage("{} has no option {}; `{} --help` lists them.{}", path(), name, path(), suggestion(name, names));
}

Command::Declared& Command::Declared::named_by(const std::vector<std::string>& words) {
  Declared* at = this;
  bool own = false;  // it is the one that runs, and takes positionals
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
    const std::string& word = words[i];
    if (word == "-h" || word == "--help" || word == "--version") return *at;
    const bool is_long = word.starts_with("--");
    const bool is_short = !is_long && word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
    if (is_long) {
      const CLI::Option& named = at->option(word.substr(0, word.find('=')));
      if (word.find('=') == std::string::npos) i += static_cast<std::size_t>(named.get_items_expected_min());
    } else if (is_short) {
      const CLI::Option& named = at->option(word.substr(0, 2));
      if (word.size() == 2) i += static_cast<std::size_t>(named.get_items_expected_min());
    } else if (!at->below.empty() && !own) {
      // A command that does something itself takes what is not one of those below it as its own.
      const auto is_named = [&](const auto& entry) { return entry->app->get_name() == word; };
      own = at->run && std::none_of(at->below.begin(), at->below.end(), is_named);
      if (!own) at = &at->child(word);
    }
  }
  if (!at->below.empty() && !at->run) throw CommandMissing{at->app->help("marey")};
  return *at;
}

const std::set<std::string_view> kOfThisRun{"--threads", "--quiet", "--json"};  // have no part in what comes out

/// The request, by option, except for its files: those are reported by name and hash.
std::map<std::string, std::string> Command::Declared::given() const {
  if (records) return records();
  std::map<std::string, std::string> texts;
  for (const auto& option : options) {
    if (option->inputs || option->outputs || option->parsed->count() == 0) continue;
    const std::string longest = option->name.substr(option->name.find_last_of(',') + 1);
    if (kOfThisRun.contains(longest)) continue;
    texts[longest.substr(longest.find_first_not_of('-'))] = CLI::detail::join(option->parsed->results(), " ");
  }
  return texts;
}

const std::map<std::string, std::string>& given_options() {
  return requested_for;
}

extern const char* const kCommit;  // of the repository; empty if the source lies in none

std::string version_text() {
  const std::string commit = kCommit;
  return commit.empty() ? MAREY_VERSION : fmt::format("{} (commit {})", MAREY_VERSION, commit);
}

Program::Program(const std::string& name, const std::string& meaning) : parser_(std::make_unique<Parser>()) {
  parser_->app.name(name);
  parser_->app.description(meaning);
  parser_->app.formatter(std::make_shared<HelpText>());
  parser_->app.require_subcommand(0, 1);
  parser_->app.set_version_flag("--version", name + " " + version_text());
  parser_->program.app = &parser_->app;
}

Program::~Program() = default;

Command Program::root() {
  return Command(parser_->program);
}

int Program::run(int argc, char** argv) {
  int code = 0;
  std::string of_command;
  try {
    std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    if (!words.empty() && words.front() == "help") {
      words.erase(words.begin());
      words.emplace_back("--help");
    }
    const Command::Declared& command = parser_->program.named_by(words);
    of_command = command.path();
    std::reverse(words.begin(), words.end());
    parser_->app.parse(words);
    command.check_its_files();
    requested_for = command.given();
    const StopScope scope(stop_by_signals());
    command.run();
  } catch (const EndWith& end) {
    code = end.code;
  } catch (const Stopped& stopped) {
    announce(stopped.what());
    code = kInterrupted;
  } catch (const CommandMissing& missing) {
    fmt::print(stderr, "{}", missing.help);
    code = 2;
  } catch (const CLI::Success& stated) {
    parser_->app.exit(stated);
  } catch (const CLI::ExtrasError& error) {
    announce(fmt::format("{}; `{} --help` lists what this command takes", error.what(), of_command));
    code = 2;
  } catch (const CLI::ParseError& error) {
    announce(error.what());
    code = 2;
  } catch (const WrongUsage& error) {
    announce(error.what());
    code = 2;
  } catch (const pipeline::jobs::WrongOption& error) {
    announce(error.what());
    code = 2;
  } catch (const format::WrongFormat& error) {
    announce(error.what());
    code = 2;
  } catch (const std::bad_alloc&) {
    announce("there is not enough memory for this; give it a shorter recording, smaller images, or a machine with more");
    code = 1;
  } catch (const std::exception& error) {
    if (std::ferror(stdout) == 0) announce(error.what());  // else `finish` says it
    code = 1;
  }
  return finish(code);
}

}  // namespace marey::cli
