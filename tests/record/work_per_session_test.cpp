// What a session costs in a file of many. Counted in pages that SQLite looks at, not in time.
#include "record/schema.hpp"
#include "record/store_fixture.hpp"
#include "record/stored_study.hpp"
#include "support/catch.hpp"

#include <atomic>
#include <filesystem>

#include <sqlite3.h>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

constexpr int kFew = 10;
constexpr int kMany = 160;

int counted(const Database& database, int counter) {
  int now = 0;
  int highest = 0;
  REQUIRE(sqlite3_db_status(database.connection().getHandle(), counter, &now, &highest, 0) ==
          SQLITE_OK);
  return now;
}

/// Pages that were looked at, in the cache or not.
int pages_looked_at(const Database& database) {
  return counted(database, SQLITE_DBSTATUS_CACHE_HIT) +
         counted(database, SQLITE_DBSTATUS_CACHE_MISS);
}

/// \return how many pages adding one more session looks at, and splitting full ones
int pages_of_adding(StoredStudy& study, int session) {
  const BufferedEvents events = session_of(session);
  const NewKeys keys = wrapped_key_of(session);
  const int before = pages_looked_at(study.database());
  study.change([&] { study.store_complete(events, keys, kUtc); });
  return pages_looked_at(study.database()) - before;
}

/// What a report's check of a file reads.
struct PagesOfCheck {
  int looked_at = 0;
  int read = 0;  ///< from the file, with room for all of them
  int sessions_given = 0;
};

PagesOfCheck pages_of_check(const std::filesystem::path& path) {
  const Database database = Database::open(path, Database::Mode::read_only);
  database.connection().exec("PRAGMA cache_size = 100000");
  const int looked_at = pages_looked_at(database);
  const int read = counted(database, SQLITE_DBSTATUS_CACHE_MISS);
  std::atomic<int> given = 0;
  const auto fault = find_first_fault(database, TraceCheck::skip,
                                      [&](int, const std::vector<Event>&) { ++given; });
  REQUIRE_FALSE(fault);
  return {pages_looked_at(database) - looked_at,
          counted(database, SQLITE_DBSTATUS_CACHE_MISS) - read, given};
}

}  // namespace

TEST_CASE("the cost of a session does not depend on the number of sessions") {
  StoredFixture few(kFew);
  few.store.reset();
  StoredFixture many(few.path);
  StoredStudy study(Database::open(many.path, Database::Mode::read_write));
  study.sign_with(investigator());
  int early = 0;  // of the last ten of the first half: by then trees have the height that they keep
  int late = 0;   // of the last ten
  for (int session = kFew + 1; session <= kMany; ++session) {
    const int pages = pages_of_adding(study, session);
    if (session > kMany / 2 - 10 && session <= kMany / 2) early += pages;
    if (session > kMany - 10) late += pages;
  }
  INFO("adding ten: " << early << " and " << late << " pages");
  CHECK(late < 1.15 * early);

  const PagesOfCheck of_few = pages_of_check(few.path);
  const PagesOfCheck of_many = pages_of_check(many.path);
  INFO("checking: " << of_few.looked_at << " and " << of_many.looked_at << " pages, " << of_few.read
                    << " and " << of_many.read << " read");
  CHECK(of_few.sessions_given == kFew);
  CHECK(of_many.sessions_given == kMany);
  CHECK(of_many.looked_at < 1.25 * kMany / kFew * of_few.looked_at);
  CHECK(of_many.read < 1.25 * kMany / kFew * of_few.read);

  // Traces, most of a file, are left alone.
  SQLite::Database raw(many.path.string(), SQLite::OPEN_READONLY);
  CHECK(of_many.read < 0.3 * raw.execAndGet("PRAGMA page_count").getInt());
}
