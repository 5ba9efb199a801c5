#include "record/session_lock.hpp"

#include "record/store_fixture.hpp"
#include "support/catch.hpp"

#include <csignal>

#include <sys/wait.h>
#include <unistd.h>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

TEST_CASE("a participant's session is held once, and other participants' are not hindered") {
  const TempFolder folder;
  const std::filesystem::path database = folder.path() / "study.db";
  {
    const SessionLock first(database, "P07");
    const SessionLock other(database, "P08");
    const std::string line = refusal_of([&] { const SessionLock second(database, "P07"); });
    REQUIRE(names(line, "P07"));
  }
  REQUIRE(refusal_of([&] { const SessionLock again(database, "P07"); }).empty());
}

TEST_CASE("a session's lock goes with its process, even if that is killed") {
  const TempFolder folder;
  const std::filesystem::path database = folder.path() / "study.db";
  int ready[2] = {-1, -1};
  REQUIRE(::pipe(ready) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const SessionLock held(database, "P07");
    (void)!::write(ready[1], "x", 1);
    ::pause();
    ::_exit(1);
  }
  char byte = 0;
  REQUIRE(::read(ready[0], &byte, 1) == 1);
  REQUIRE_FALSE(refusal_of([&] { const SessionLock second(database, "P07"); }).empty());
  REQUIRE(::kill(child, SIGKILL) == 0);
  REQUIRE(::waitpid(child, nullptr, 0) == child);
  REQUIRE(refusal_of([&] { const SessionLock second(database, "P07"); }).empty());
  ::close(ready[0]);
  ::close(ready[1]);
}
