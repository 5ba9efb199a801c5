// Kills and power cuts at every operation on the disk: nothing acknowledged is lost.
#include "core/files.hpp"
#include "record/power_cut_fixture.hpp"

#include <algorithm>
#include <array>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

using Kind = Fault::Kind;

void note_head(const StudyStore& store, Acknowledged& acknowledged) {
  acknowledged.file = store.file_head();
}

Story changing(const std::function<void(StudyStore&)>& change) {
  return [change](StudyStore& store, Acknowledged& acknowledged) {
    change(store);
    note_head(store, acknowledged);
  };
}

/// Interrupts a story at one operation, and checks what is left.
/// \return whether the story reached that operation
bool survives(FaultVfs& vfs, const Story& story, const Fault& fault) {
  INFO("kind " << static_cast<int>(fault.kind) << " at operation " << fault.at << ", seed "
               << fault.seed);
  StoredFixture study(finished_session());
  vfs.plan(fault);
  const Outcome outcome = tell(study.path, story);
  if (!vfs.has_occurred()) return false;
  vfs.restore_disk();
  {
    const StudyStore store = StudyStore::open(study.path, StudyStore::Access::read_only);
    require_kept(store, outcome.acknowledged);
  }
  require_writable(study.path);
  return true;
}

/// Interrupts a story at each of its operations in turn.
/// \param seeds  number of random choices of the unsynced writes that reach the disk
void end_everywhere(const Story& story, Kind kind, std::uint64_t seeds = 1) {
  FaultVfs vfs;
  const std::int64_t operations = operations_of(vfs, story);
  REQUIRE(operations > 5);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    for (std::int64_t at = 1; at <= operations; ++at) {
      REQUIRE(survives(vfs, story,
                       {.kind = kind, .at = at, .only = {}, .is_persistent = false, .seed = seed}));
    }
  }
}

const std::array<Kind, 4> kEnds = {Kind::kill, Kind::torn_kill, Kind::power_cut,
                                   Kind::torn_power_cut};

void end_everywhere_in_every_way(const Story& story) {
  for (const Kind kind : kEnds) end_everywhere(story, kind);
}

}  // namespace

TEST_CASE("a session killed at any operation on the disk keeps what was acknowledged") {
  end_everywhere(tell_session, Kind::kill);
  end_everywhere(tell_session, Kind::torn_kill);
}

TEST_CASE("a session whose power is cut at any operation keeps what was acknowledged") {
  end_everywhere(tell_session, Kind::power_cut);
}

TEST_CASE("a session whose power is cut keeps it whichever unsynced writes reached the disk") {
  end_everywhere(tell_session, Kind::torn_power_cut, 3);
}

TEST_CASE("a session added whole is there whole or not at all after a kill or a power cut") {
  end_everywhere_in_every_way([](StudyStore& store, Acknowledged& acknowledged) {
    acknowledged.under_way = 100;
    add(store, 2);
    note_head(store, acknowledged);
  });
}

TEST_CASE("an exclusion, a look at outcomes and a closing survive kills and power cuts") {
  end_everywhere_in_every_way(changing([](StudyStore& store) { store.exclude(1, kUtc, "ill"); }));
  end_everywhere_in_every_way(
      changing([](StudyStore& store) { store.unblind(kUtc, "safety board", true); }));
  end_everywhere_in_every_way(changing([](StudyStore& store) { store.close_study(kUtc); }));
}

TEST_CASE("a database that is being made is whole or not there after a kill or a power cut") {
  FaultVfs vfs;
  for (const Kind kind : kEnds) {
    Fault fault{.kind = kind, .at = 1};
    for (;; ++fault.at) {
      INFO("kind " << static_cast<int>(kind) << " at operation " << fault.at);
      TempFolder folder;
      const auto path = folder.path() / "study.db";
      vfs.plan(fault);
      static_cast<void>(
          refusal_of([&] { return StudyStore::create(path, commitment(), kUtc, investigator()); }));
      if (!vfs.has_occurred()) break;
      vfs.restore_disk();
      if (!std::filesystem::exists(path)) {
        static_cast<void>(StudyStore::create(path, commitment(), kUtc, investigator()));
      }
      REQUIRE_FALSE(StudyStore::open(path, StudyStore::Access::read_only).first_fault());
      StudyStore store = writable(path);
      add(store, 1);
    }
    REQUIRE(fault.at > 10);
  }
}

TEST_CASE("a destroyed key is not restored by a power cut") {
  FaultVfs vfs;
  const Bytes key = wrapped_key_of(1).participant;
  for (const Kind kind : kEnds) {
    Fault fault{.kind = kind, .at = 1};
    for (;; ++fault.at) {
      INFO("kind " << static_cast<int>(kind) << " at operation " << fault.at);
      StoredFixture study(finished_session());
      bool acknowledged = false;
      static_cast<void>(refusal_of([&] {
        StudyStore store = writable(study.path);
        vfs.plan(fault);
        store.withdraw(1, kUtc, "asked to");
        acknowledged = true;
      }));
      if (!vfs.has_occurred()) break;
      vfs.restore_disk();
      const bool withdrawn = writable(study.path).sessions().at(0).withdrawn;
      REQUIRE((withdrawn || !acknowledged));
      const Bytes file = read_file(study.path);
      const bool has_key =
          std::search(file.begin(), file.end(), key.begin(), key.end()) != file.end();
      REQUIRE(has_key == !withdrawn);
      REQUIRE_FALSE(std::filesystem::exists(study.path.string() + "-wal"));
    }
  }
}

TEST_CASE("a folder that cannot have a write-ahead log is refused") {
  FaultVfs vfs;
  vfs.forbid_shared_memory();
  TempFolder folder;
  const std::filesystem::path path = folder.path() / "study.db";
  REQUIRE(refuses([&] { return StudyStore::create(path, commitment(), kUtc, investigator()); },
                  "journal_mode wal"));
  REQUIRE(std::filesystem::is_empty(folder.path()));
}
