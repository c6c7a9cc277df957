#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace marey::format::take {

/// One SQLite file, open. Every failure is an Error that names the file. One thread at a time.
class Database {
 public:
  enum class Mode {
    create,  ///< to read and write; made where it is not there
    read,    ///< nothing is written, but for the rollback of what another program left half done
  };
  Database(const std::string& path, Mode mode);

  const std::string& path() const { return path_; }
  /// Statements without results, `;` between them.
  void run(const char* sql);
  /// The first column of the first row; 0 if no row exists.
  std::int64_t number(const std::string& sql);
  /// False where the lock that it needs stayed with another connection; to be tried again.
  bool commit();
  /// Undoes what the open transaction did; nothing if none is open.
  void roll_back();

  sqlite3* handle() const { return handle_.get(); }
  /// Throws what the last call failed with.
  [[noreturn]] void fail() const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// While it lives, all reads are of one instant, whatever another program writes in the meantime.
class ReadTransaction {
 public:
  explicit ReadTransaction(Database& database) : database_(&database) { database.run("BEGIN"); }
  ~ReadTransaction() { database_->roll_back(); }
  ReadTransaction(const ReadTransaction&) = delete;
  ReadTransaction& operator=(const ReadTransaction&) = delete;

 private:
  Database* database_;
};

/// A prepared statement: bind, step, read columns; columns and parameters count from 0.
class Statement {
 public:
  Statement(const Database& database, std::string_view sql);

  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);
  /// Text and blobs must live until the statement is reset.
  void bind(int parameter, std::string_view text);
  void bind(int parameter, std::span<const std::byte> blob);
  void bind_null(int parameter);

  /// True where there is a row.
  bool step();
  void reset();
  /// Binds nothing more, runs to the end, resets.
  void run();

  std::int64_t integer(int column) const;
  double real(int column) const;
  bool is_number(int column) const;
  /// Valid until the next step; empty for NULL.
  std::string_view text(int column) const;
  std::span<const std::byte> blob(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

}  // namespace marey::format::take
