#include "protocols/store/database_copy.hpp"

#include "protocols/store/database.hpp"
#include "protocols/store/schema.hpp"

#include <system_error>

namespace touchtrial::store {

void copy_database(const std::filesystem::path& from, const std::filesystem::path& to) {
  const Database database = Database::open(from, Database::Mode::read_only, kSchemaVersion);
  std::filesystem::path draft = to;
  draft += ".part";
  std::error_code error;
  std::filesystem::remove(draft, error);  // of a copy that was broken off
  database.run([&] { write_copy(database, draft); });
  std::filesystem::rename(draft, to, error);
  if (error) {
    throw StoreError(one_line(to.string()) + ": cannot be written (" + error.message() +
                     "); give another folder or change its permissions");
  }
}

}  // namespace touchtrial::store
