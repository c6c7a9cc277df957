#include "marey/format/take/take_plates.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/format/take/sqlite.h"

namespace marey::format::take {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they lie in memory");

constexpr std::size_t kLoadFloats = 6, kCornerNumbers = 12;

constexpr const char* kPlateTable = R"(
  CREATE TABLE IF NOT EXISTS plate (id INTEGER PRIMARY KEY, name TEXT NOT NULL, type INTEGER NOT NULL, rate_hz REAL NOT NULL,
                                    begin_s REAL NOT NULL, corners BLOB NOT NULL, loads BLOB NOT NULL, saturated BLOB);
  DELETE FROM plate;
)";

std::vector<float> packed_loads(const ForcePlate& plate) {
  std::vector<float> packed;
  packed.reserve(plate.loads.size() * kLoadFloats);
  for (const PlateLoad& load : plate.loads) {
    for (const double value : load.force) packed.push_back(static_cast<float>(value));
    for (const double value : load.moment) packed.push_back(static_cast<float>(value));
  }
  return packed;
}

/// A blob's numbers. Throws Error if it is not a whole number of them, or one is not finite.
template <typename T>
std::vector<T> unpacked(std::span<const std::byte> blob, std::size_t multiple, const std::string& path) {
  if (blob.size() % (sizeof(T) * multiple) != 0) throw Error("{}: its force plates are damaged", path);
  std::vector<T> values(blob.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), blob.data(), blob.size());
  for (const T value : values) {
    if (!std::isfinite(value)) throw Error("{}: its force plates are damaged: a value is not finite", path);
  }
  return values;
}

ForcePlate plate_of_row(const Statement& row, const std::string& path) {
  ForcePlate plate;
  plate.name = plain_text(row.text(0));
  plate.type = static_cast<int>(row.integer(1));
  plate.rate_hz = row.real(2);
  plate.begin_s = row.real(3);
  if (!(std::isfinite(plate.rate_hz) && plate.rate_hz > 0 && std::isfinite(plate.begin_s)))
    throw Error("{}: its force plates are damaged: a rate of {} Hz", path, plate.rate_hz);
  const std::vector<double> corners = unpacked<double>(row.blob(4), kCornerNumbers, path);
  if (corners.size() != kCornerNumbers) throw Error("{}: its force plates are damaged: a plate has 4 corners", path);
  for (std::size_t c = 0; c < 4; ++c) plate.corners[c] = Vector<3>(corners[3 * c], corners[3 * c + 1], corners[3 * c + 2]);
  const std::vector<float> loads = unpacked<float>(row.blob(5), kLoadFloats, path);
  for (std::size_t i = 0; i < loads.size(); i += kLoadFloats)
    plate.loads.push_back({Vector<3>(loads[i], loads[i + 1], loads[i + 2]), Vector<3>(loads[i + 3], loads[i + 4], loads[i + 5])});
  for (const std::byte one : row.blob(6)) plate.saturated.push_back(std::to_integer<std::uint8_t>(one));
  if (!plate.saturated.empty() && plate.saturated.size() != plate.loads.size())
    throw Error("{}: its force plates are damaged: marks do not fit loads", path);
  return plate;
}

}  // namespace

void write_plates(const std::string& path, std::span<const ForcePlate> plates) {
  Database database(path, Database::Mode::create);
  database.run("BEGIN IMMEDIATE");
  database.run(kPlateTable);
  Statement add(database, "INSERT INTO plate VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  for (std::size_t p = 0; p < plates.size(); ++p) {
    const ForcePlate& plate = plates[p];
    std::array<double, kCornerNumbers> corners{};
    for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = plate.corners[i / 3][static_cast<Eigen::Index>(i % 3)];
    const std::vector<float> loads = packed_loads(plate);
    add.bind(0, static_cast<std::int64_t>(p) + 1);
    add.bind(1, std::string_view(plate.name));
    add.bind(2, std::int64_t{plate.type});
    add.bind(3, plate.rate_hz);
    add.bind(4, plate.begin_s);
    add.bind(5, std::as_bytes(std::span(corners)));
    add.bind(6, std::as_bytes(std::span(loads)));
    plate.saturated.empty() ? add.bind_null(7) : add.bind(7, std::as_bytes(std::span(plate.saturated)));
    add.run();
  }
  if (!database.commit()) throw Error("{}: another program keeps reading it, so its force plates could not be written", path);
}

std::vector<ForcePlate> read_plates(const std::string& path) {
  Database database(path, Database::Mode::read);
  const ReadTransaction all(database);
  std::vector<ForcePlate> plates;
  if (database.number("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'plate'") == 0) return plates;
  Statement rows(database, "SELECT name, type, rate_hz, begin_s, corners, loads, saturated FROM plate ORDER BY id");
  while (rows.step()) plates.push_back(plate_of_row(rows, path));
  return plates;
}

}  // namespace marey::format::take
