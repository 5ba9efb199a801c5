#include "record/personal_data.hpp"

#include "core/draft.hpp"
#include "core/errors.hpp"

#include <cerrno>
#include <cstring>
#include <utility>

#include <SQLiteCpp/Database.h>
#include <SQLiteCpp/Exception.h>
#include <SQLiteCpp/Statement.h>
#include <SQLiteCpp/Transaction.h>
#include <fcntl.h>
#include <unistd.h>

namespace touchtrial::record {
namespace {

constexpr int kPersonalApplicationId = 0x54545250;  // "TTRP"
constexpr int kPersonalVersion = 2;
constexpr int kPersonalBusyTimeoutMs = 2000;

[[noreturn]] void refuse_personal_data(const std::filesystem::path& path,
                                       const std::string& reason) {
  throw StoreError(one_line(path.string() + ": " + reason));
}

/// Creates the file with its final permissions, so that others cannot read it even for a moment.
void make_private(const std::filesystem::path& path) {
  refuse_link(path);
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file >= 0) {
    ::close(file);
  } else if (errno != EEXIST) {
    refuse_personal_data(path, std::string("cannot be created (") + std::strerror(errno) +
                                   "); check that its folder exists and is writable");
  }
}

void set_up(SQLite::Database& connection, const std::filesystem::path& path) {
  connection.exec(
      "PRAGMA secure_delete = ON; PRAGMA synchronous = FULL; PRAGMA trusted_schema = OFF");
  const int id = connection.execAndGet("PRAGMA application_id").getInt();
  const int version = connection.execAndGet("PRAGMA user_version").getInt();
  if (id == kPersonalApplicationId && version == kPersonalVersion) return;
  if (id == kPersonalApplicationId) {
    refuse_personal_data(path, "contains personal data of version " + std::to_string(version) +
                                   ", not " + std::to_string(kPersonalVersion) +
                                   "; use the program that wrote it");
  }
  if (id != 0 || connection.execAndGet("SELECT count(*) FROM sqlite_schema").getInt() != 0) {
    refuse_personal_data(path, "is not one of Touchtrial's files of personal data; move it away");
  }
  SQLite::Transaction transaction(connection);
  connection.exec(
      "CREATE TABLE people(participant TEXT NOT NULL, number INTEGER NOT NULL, consent_version "
      "TEXT NOT NULL, consented_utc TEXT NOT NULL, age INTEGER, gender TEXT NOT NULL, contact TEXT "
      "NOT NULL, PRIMARY KEY(participant, number)) STRICT");
  connection.exec("PRAGMA application_id = " + std::to_string(kPersonalApplicationId));
  connection.exec("PRAGMA user_version = " + std::to_string(kPersonalVersion));
  transaction.commit();
}

PersonalRecord record_in(SQLite::Statement& row) {
  PersonalRecord record;
  record.participant = row.getColumn("participant").getString();
  record.consent_version = row.getColumn("consent_version").getString();
  record.consented_utc = row.getColumn("consented_utc").getString();
  if (!row.isColumnNull("age")) record.age = row.getColumn("age").getInt();
  record.gender = row.getColumn("gender").getString();
  record.contact = row.getColumn("contact").getString();
  return record;
}

/// Calls `work`; errors of SQLite are rethrown as StoreError with file and remedy.
template <typename Work>
auto with_file_errors(const std::filesystem::path& path, Work&& work) {
  try {
    return work();
  } catch (const SQLite::Exception& error) {
    refuse_personal_data(path, std::string("personal data cannot be read or written (") +
                                   error.what() +
                                   "); check the disk and that no other program uses the file");
  }
}

}  // namespace

std::filesystem::path personal_data_path(const std::filesystem::path& database) {
  return database_companion(database, ".personal");
}

struct PersonalData::Impl {
  explicit Impl(const std::filesystem::path& file)
      : path(file),
        connection(absolute(file).string(), SQLite::OPEN_READWRITE, kPersonalBusyTimeoutMs) {
    set_up(connection, path);
  }

  std::filesystem::path path;
  SQLite::Database connection;
};

PersonalData::PersonalData(const std::filesystem::path& path) {
  make_private(path);
  require_owner_only(path);
  impl_ = with_file_errors(path, [&] { return std::make_unique<Impl>(path); });
}
PersonalData::~PersonalData() = default;
PersonalData::PersonalData(PersonalData&&) noexcept = default;
PersonalData& PersonalData::operator=(PersonalData&&) noexcept = default;

void PersonalData::put(const PersonalRecord& record) {
  with_file_errors(impl_->path, [&] {
    SQLite::Statement query(
        impl_->connection,
        "INSERT INTO people VALUES(?1, (SELECT coalesce(max(number), 0) + 1 FROM people WHERE "
        "participant = ?1), ?2, ?3, ?4, ?5, ?6)");
    query.bind(1, record.participant);
    query.bind(2, record.consent_version);
    query.bind(3, record.consented_utc);
    if (record.age) query.bind(4, *record.age);
    query.bind(5, record.gender);
    query.bind(6, record.contact);
    return query.exec();
  });
}

std::optional<PersonalRecord> PersonalData::find(const std::string& participant) const {
  std::optional<PersonalRecord> last;
  for (PersonalRecord& record : all()) {
    if (record.participant != participant) continue;
    if (last && !record.age) record.age = last->age;
    if (last && record.gender.empty()) record.gender = last->gender;
    if (last && record.contact.empty()) record.contact = last->contact;
    last = std::move(record);
  }
  return last;
}

std::vector<PersonalRecord> PersonalData::all() const {
  return with_file_errors(impl_->path, [&] {
    SQLite::Statement query(impl_->connection, "SELECT * FROM people ORDER BY participant, number");
    std::vector<PersonalRecord> records;
    while (query.executeStep()) records.push_back(record_in(query));
    return records;
  });
}

bool PersonalData::remove(const std::string& participant) {
  return with_file_errors(impl_->path, [&] {
    SQLite::Statement query(impl_->connection, "DELETE FROM people WHERE participant = ?");
    query.bind(1, participant);
    return query.exec() > 0;
  });
}

}  // namespace touchtrial::record
