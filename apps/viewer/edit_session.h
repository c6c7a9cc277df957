#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "marey/pipeline/take/edit_take.h"

#include "edit_message.h"
#include "stored_recording.h"
#include "web_server.h"

namespace marey::viewer {

/// Edits a take that is shown, on a thread of its own, as `marey edit` does and by the same functions. What a page asks for is done
/// only where the take's edits still stand as that page shows them. What another program does to the take in the meantime is shown
/// within a second.
class EditSession {
 public:
  struct Answers {
    /// To the one who asked: "done", or "refused" and a sentence. On the session's thread, or on the caller's of `ask`.
    std::function<void(PageId, std::string)> answer;
    /// The history and the recording are others now. On the session's thread.
    std::function<void()> changed;
  };

  /// Throws Error if the file is not a take, or one that cannot be edited.
  EditSession(const std::string& take, StoredRecording& recording, Answers answers);
  ~EditSession() { end(); }
  EditSession(const EditSession&) = delete;
  EditSession& operator=(const EditSession&) = delete;

  /// The recording is complete: edits are taken from now on.
  void begin();
  /// What a page said, the one who wrote it; never waits. One thing at a time is done, a second is refused.
  void request(PageId page, std::string_view line);
  /// The history as JSON, as page/src/edits.ts declares it.
  Bytes history() const;
  /// Answers no more.
  void end();

 private:
  void run();
  void act(PageId page, const EditMessage& message);
  /// Shows what the take is now.
  void catch_up();
  /// Whether the file was written since the last inspection.
  bool was_written();

  std::string take_;
  StoredRecording* recording_;
  Answers answers_;
  pipeline::take::EditHistory shown_;  // the session's thread's, once it runs
  std::filesystem::file_time_type written_{};

  mutable std::mutex mutex_;  // for what follows
  std::condition_variable changed_;
  std::optional<std::pair<PageId, EditMessage>> request_;
  Bytes history_;
  bool begun_ = false, busy_ = false, ending_ = false;
  std::thread thread_;
};

}  // namespace marey::viewer
