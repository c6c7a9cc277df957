// What every job has in common: options out of Python's, a thread to run on, files and objects for its results.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/recording.h"
#include "marey/core/rig.h"
#include "marey/format/format.h"
#include "marey/pipeline/corridor/run.h"
#include "marey/pipeline/jobs/option.h"

#include "bindings.h"

namespace marey::python {

/// What Python gave beside the input, by name; every job takes out what it knows.
class Options {
 public:
  explicit Options(nb::dict given) : given_(std::move(given)) {}

  bool has(const char* name) const { return given_.contains(name) && !nb::object(given_[name]).is_none(); }
  template <typename T>
  T get(const char* name, T typical) const {
    return has(name) ? nb::cast<T>(given_[name]) : typical;
  }
  template <typename T>
  std::optional<T> find(const char* name) const {
    return has(name) ? std::optional<T>(nb::cast<T>(given_[name])) : std::nullopt;
  }
  /// A path, where it is given and no list.
  std::string path(const char* name) const {
    return has(name) && nb::isinstance<nb::str>(given_[name]) ? nb::cast<std::string>(given_[name]) : std::string();
  }
  std::shared_ptr<Held> object(const char* name) const {
    return has(name) ? std::make_shared<Held>(nb::object(given_[name])) : nullptr;
  }

 private:
  nb::dict given_;
};

/// How a job is reported about, and what Python receives of it.
struct Listening {
  std::shared_ptr<Held> progress;  ///< called with (step, done, total)
  std::shared_ptr<Held> ends;      ///< asked now and then whether the job is to end
  std::map<std::string, std::string> options;
};

Listening listening_of(const Options& options);

/// The rows of a job's description, set to what Python gave by name as texts ("rows").
class Rows {
 public:
  /// Throws Error, with the option's name, for a text that is not in its domain, and for options that the job does not have.
  Rows(pipeline::jobs::Table table, const Options& options);

  /// `resolve()`; a sentence of its WrongOption spells options as Python does.
  template <typename Resolve>
  auto resolved(Resolve resolve) const {
    try {
      return resolve();
    } catch (const pipeline::jobs::WrongOption& error) {
      throw Error("{}", in_python(error.what()));
    }
  }
  /// With the options for the recording.
  Listening listening(const Options& options) const;
  std::vector<std::string> files(bool outputs) const { return table_.files(outputs); }

 private:
  /// "--measured-only" → "measured_only".
  static std::string in_python(const std::string& message_text);

  pipeline::jobs::Table table_;
};

/// One dict per row: what the documentation and the signatures of python/marey are made from.
nb::list rows_of_job(const std::string& job);

/// `work(hooks)` on another thread: the one that called waits, so that Ctrl-C ends it, and lets others have Python in the meantime.
/// Throws what it threw: an exception of Python's with its own traceback.
template <typename Work>
auto run_job(const Listening& listening, Work work) {
  std::optional<decltype(work(Hooks{}))> result;
  std::exception_ptr failure, interrupt;
  std::mutex guard;
  std::condition_variable changed;
  bool done = false;
  std::stop_source stop;
  Hooks hooks{.progress = {}, .stop = stop.get_token(), .options = listening.options};
  auto last = std::chrono::steady_clock::now();
  if (listening.progress) {
    hooks.progress = [&](const Progress& now) {
      const auto time = std::chrono::steady_clock::now();
      if (time - last < std::chrono::milliseconds(100)) return;
      last = time;
      const nb::gil_scoped_acquire gil;
      listening.progress->get()(std::string(now.step), now.done, now.total);
    };
  }
  {
    const nb::gil_scoped_release free;
    std::thread worker([&] {
      try {
        result.emplace(work(hooks));
      } catch (...) {
        failure = std::current_exception();
      }
      const std::lock_guard lock(guard);
      done = true;
      changed.notify_all();
    });
    std::unique_lock lock(guard);
    while (!changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return done; })) {
      lock.unlock();
      {
        const nb::gil_scoped_acquire gil;
        if (!interrupt && PyErr_CheckSignals() != 0) {
          interrupt = std::make_exception_ptr(nb::python_error());
          stop.request_stop();
        }
        if (listening.ends && nb::cast<bool>(listening.ends->get()())) stop.request_stop();
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  if (interrupt) std::rethrow_exception(interrupt);
  if (failure) std::rethrow_exception(failure);
  return std::move(*result);
}

struct Result {
  Recording recording;
  pipeline::corridor::Summary summary;
};

/// The recording, and the summary as a dict.
nb::tuple tuple_of(Result result);

/// Files by name, and objects of Python's; the recording in memory, unless it is not wanted.
class Outputs {
 public:
  /// `also`: files that are written besides; `read`: that are read besides. Throws Error if a file that is written is one that is
  /// read: one of the options', or what one of the cameras shows.
  Outputs(const Options& options, format::Content content, std::span<const RigCamera> cameras, const Rows* rows = nullptr,
          const std::vector<std::string>& also = {}, const std::vector<std::string>& read = {});

  std::vector<std::unique_ptr<Sink>> open(Recording& recording) const;
  void add_to(pipeline::corridor::Sinks& sinks, Recording& recording) const;
  /// A recording that was made in memory.
  void write(const Recording& recording) const;
  /// Throws Error if a file that is written is one that is read.
  static void keep_inputs(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

 private:
  struct Object {
    std::shared_ptr<Held> held;
    bool images = false;
  };

  format::Content content_;
  std::vector<std::pair<std::string, std::string>> files_;
  std::vector<Object> objects_;
  bool keep_ = true;
};

/// A rig file's, or what observations name, with other sources as {camera: path} pairs.
Rig rig_of(const Options& options);

}  // namespace marey::python
