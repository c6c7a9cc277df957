#include "edit_session.h"

#include <chrono>
#include <system_error>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/take/take_file.h"
#include "marey/pipeline/take/describe_edits.h"

#include "edit_json.h"

namespace marey::viewer {
namespace {

constexpr std::chrono::seconds kPollInterval{1};

std::string history_text(const pipeline::take::EditHistory& history) {
  cli::Json edits = cli::Json::array();
  for (const pipeline::take::EditLine& line : pipeline::take::lines_of(history)) {
    cli::Json entry = cli::edit_json(line);
    entry["active"] = line.counts;
    edits.push_back(std::move(entry));
  }
  return cli::compact({{"edits", edits}, {"head", history.state.head}, {"newest", history.state.newest}});
}

const std::string& take_to_edit(const std::string& path) {
  if (!format::take::is_take(path))
    throw Error("{}: is not a take, and only a take can be edited; \"marey convert {} NEW.marey\" makes one of it", path, path);
  return path;
}

}  // namespace

EditSession::EditSession(const std::string& take, StoredRecording& recording, Answers answers)
    : take_(take_to_edit(take)),
      recording_(&recording),
      answers_(std::move(answers)),
      shown_(pipeline::take::edit_history(take)),
      history_(bytes_of(history_text(shown_))) {}

void EditSession::begin() {
  {
    const std::lock_guard lock(mutex_);
    begun_ = true;
  }
  thread_ = std::thread([this] { run(); });
}

void EditSession::request(PageId page, std::string_view line) {
  std::optional<EditMessage> message = edit_message(line);
  const char* refused = nullptr;
  {
    const std::lock_guard lock(mutex_);
    if (!message) {
      refused = "refused this is not an edit";
    } else if (!begun_) {
      refused = "refused the take is still being read; edit it when all of it is there";
    } else if (busy_) {
      refused = "refused another edit is being done; try again when it is";
    } else {
      busy_ = true;
      request_.emplace(page, std::move(*message));
    }
  }
  if (refused != nullptr) return answers_.answer(page, refused);
  changed_.notify_one();
}

Bytes EditSession::history() const {
  const std::lock_guard lock(mutex_);
  return history_;
}

void EditSession::end() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void EditSession::run() {
  for (;;) {
    std::optional<std::pair<PageId, EditMessage>> request;
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, kPollInterval, [this] { return ending_ || request_; });
      if (ending_) return;
      request = std::exchange(request_, std::nullopt);
    }
    if (request) {
      act(request->first, request->second);
    } else if (was_written()) {
      catch_up();
    }
  }
}

void EditSession::act(PageId page, const EditMessage& message) {
  std::string answer = "done";
  try {
    using Kind = EditMessage::Kind;
    if (message.kind == Kind::edit) {
      pipeline::take::edit_take(take_, {{.text = message.text, .where = "\"" + message.text + "\""}}, {}, message.on);
    } else if (message.kind == Kind::go) {
      pipeline::take::set_head(take_, message.to, message.on);
    } else {
      pipeline::take::move_head(take_, message.kind == Kind::undo ? -1 : 1, message.on);
    }
  } catch (const Error& error) {
    answer = "refused " + plain_text(error.what());
  }
  catch_up();
  {
    const std::lock_guard lock(mutex_);
    busy_ = false;
  }
  answers_.answer(page, answer);
}

void EditSession::catch_up() {
  try {
    was_written();
    pipeline::take::EditHistory now = pipeline::take::edit_history(take_);
    if (now.state == shown_.state) return;
    recording_->put(pipeline::take::edited_tracks(take_, pipeline::take::tracks_between(shown_, now)));
    const std::vector<BodyId> bodies = pipeline::take::bodies_between(shown_, now);
    if (!bodies.empty()) recording_->put_poses(pipeline::take::edited_bodies(take_, bodies));
    shown_ = std::move(now);
    Bytes text = bytes_of(history_text(shown_));
    const std::lock_guard lock(mutex_);
    history_ = std::move(text);
  } catch (const Error&) {
    return;  // it is gone, or being written: the next inspection may find it
  }
  answers_.changed();
}

bool EditSession::was_written() {
  std::error_code failed;
  const auto written = std::filesystem::last_write_time(take_, failed);
  return !failed && std::exchange(written_, written) != written;
}

}  // namespace marey::viewer
