#include "marey/format/take/sqlite.h"

#include <sqlite3.h>

#include "marey/core/error.h"

namespace marey::format::take {
namespace {

/// No text, blob or row of ours is near this, so a file that claims more is refused before memory is asked for.
constexpr int kMaxValue = 256 << 20;
constexpr int kPatienceMs = 5000;

/// Memory holds a page's size once, but a hostile file may bring a schema that does something when it is read.
void distrust(sqlite3* handle) {
  sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kMaxValue);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(handle, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
}

}  // namespace

void Database::Close::operator()(sqlite3* handle) const {
  sqlite3_close_v2(handle);
}

Database::Database(const std::string& path, Mode mode) : path_(path) {
  sqlite3* handle = nullptr;
  const int flags = SQLITE_OPEN_READWRITE | (mode == Mode::create ? SQLITE_OPEN_CREATE : 0) | SQLITE_OPEN_NOMUTEX;
  const int result = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
  handle_.reset(handle);
  if (handle == nullptr) throw Error("{}: cannot be opened (out of memory)", path);
  if (result != SQLITE_OK) fail();
  sqlite3_extended_result_codes(handle, 1);
  sqlite3_busy_timeout(handle, kPatienceMs);
  distrust(handle);
  if (mode == Mode::read) run("PRAGMA query_only = ON");
}

void Database::fail() const {
  const int code = sqlite3_extended_errcode(handle_.get());
  switch (code & 0xff) {
    case SQLITE_FULL:
      throw Error("{}: cannot be written, the disk is full; what was written before is kept", path_);
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
      throw Error("{}: is damaged ({}); restore it from a copy", path_, sqlite3_errmsg(handle_.get()));
    case SQLITE_BUSY:
      throw Error("{}: another program is writing it; try again when it is done", path_);
    case SQLITE_READONLY:
      throw Error(
          "{}: its recording was cut off and must be tidied, but the file or its folder cannot be written; copy it, with the "
          "-journal beside it, to where you may write",
          path_);
    case SQLITE_IOERR:
      if (code == SQLITE_IOERR_WRITE || code == SQLITE_IOERR_FSYNC || code == SQLITE_IOERR_TRUNCATE) {
        throw Error(
            "{}: cannot be written to the end (disk error, or a limit on the size of files); what was written before is kept",
            path_);
      }
      [[fallthrough]];
    default:
      throw Error("{}: cannot be read or written ({})", path_, sqlite3_errmsg(handle_.get()));
  }
}

void Database::run(const char* sql) {
  if (sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

std::int64_t Database::number(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

bool Database::commit() {
  const int result = sqlite3_exec(handle_.get(), "COMMIT", nullptr, nullptr, nullptr);
  if (result == SQLITE_OK) return true;
  if ((result & 0xff) == SQLITE_BUSY) return false;
  fail();
}

void Database::roll_back() {
  sqlite3_exec(handle_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement::Statement(const Database& database, std::string_view sql) : database_(&database) {
  sqlite3_stmt* statement = nullptr;
  const int result = sqlite3_prepare_v3(database.handle(), sql.data(), static_cast<int>(sql.size()), SQLITE_PREPARE_PERSISTENT,
                                        &statement, nullptr);
  statement_.reset(statement);
  if (result != SQLITE_OK) database.fail();
}

void Statement::bind(int parameter, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), parameter + 1, value);
}
void Statement::bind(int parameter, double value) {
  sqlite3_bind_double(statement_.get(), parameter + 1, value);
}
void Statement::bind(int parameter, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), parameter + 1, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8);
}
void Statement::bind(int parameter, std::span<const std::byte> blob) {
  if (blob.empty()) {
    sqlite3_bind_zeroblob(statement_.get(), parameter + 1, 0);
  } else {
    sqlite3_bind_blob64(statement_.get(), parameter + 1, blob.data(), blob.size(), SQLITE_STATIC);
  }
}

void Statement::bind_null(int parameter) {
  sqlite3_bind_null(statement_.get(), parameter + 1);
}

bool Statement::step() {
  const int result = sqlite3_step(statement_.get());
  if (result == SQLITE_ROW) return true;
  if (result == SQLITE_DONE) return false;
  database_->fail();
}

void Statement::reset() {
  sqlite3_reset(statement_.get());
}

void Statement::run() {
  while (step()) {
  }
  reset();
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double Statement::real(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}
bool Statement::is_number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  return type == SQLITE_INTEGER || type == SQLITE_FLOAT;
}

std::string_view Statement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text), static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

std::span<const std::byte> Statement::blob(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  if (data == nullptr) return {};
  return {static_cast<const std::byte*>(data), static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

}  // namespace marey::format::take
