// A disk that fails: an event that could not be made durable is refused, and can be stored again.
#include "record/power_cut_fixture.hpp"

#include <set>

using namespace touchtrial;
using namespace touchtrial::record;
using namespace touchtrial::fixture;

namespace {

using Kind = Fault::Kind;

/// Events in session 2 when it is complete.
constexpr std::size_t kWholeSession = 2 + kTrials * 4 + 1;

/// Session 2 on a disk with one fault; a step that is refused is repeated once the disk works
/// again.
struct RetriedSession {
  RetriedSession(FaultVfs& vfs, const std::filesystem::path& path, const Fault& fault)
      : story([this, &vfs, fault](StudyStore& store, Acknowledged& acknowledged) {
          vfs.plan(fault);
          record_session(store, acknowledged, [&](const std::function<void()>& step) {
            const bool was_struck = vfs.has_occurred();
            const std::string line = refusal_of(step);
            if (line.empty()) {
              unnoticed += vfs.has_occurred() != was_struck ? 1 : 0;
              return;
            }
            refusals.insert(line);
            vfs.repair();
            step();
          });
          // The last event is acknowledged: from here on only durable data count.
          has_occurred = vfs.has_occurred();
          operations = vfs.operations();
          vfs.plan({.kind = Kind::power_cut, .at = 1});
        }),
        outcome(tell(path, story)) {}

  std::set<std::string> refusals;
  int unnoticed = 0;  ///< steps that succeeded although an operation in them failed
  bool has_occurred = false;
  std::int64_t operations = 0;
  Story story;
  Outcome outcome;
};

/// Injects one fault at every operation in turn, and then a power cut; the session must be
/// complete.
/// \return the messages with which steps were refused, without the file's name
std::set<std::string> fail_everywhere(const Fault& fault, int& unnoticed) {
  FaultVfs vfs;
  std::set<std::string> lines;
  for (Fault now = fault;; ++now.at) {
    INFO("kind " << static_cast<int>(now.kind) << " at operation " << now.at);
    StoredFixture study(finished_session());
    const RetriedSession session(vfs, study.path, now);
    REQUIRE(session.outcome.refusal.empty());
    REQUIRE(session.outcome.acknowledged.session.size() == kWholeSession);
    vfs.restore_disk();
    {
      const StudyStore store = StudyStore::open(study.path, StudyStore::Access::read_only);
      require_kept(store, session.outcome.acknowledged);
      REQUIRE(store.sessions().at(1).state == SessionState::completed);
    }
    unnoticed += session.unnoticed;
    for (const std::string& line : session.refusals) {
      REQUIRE(contains(line, study.path.string() + ": "));
      lines.insert(line.substr(study.path.string().size() + 2));
    }
    if (!session.has_occurred) return lines;
  }
}

}  // namespace

TEST_CASE("an event that a failing disk refused is stored when the disk is well again") {
  struct Failure {
    Fault fault;
    const char* words;        ///< of SQLite in the refusal
    bool is_one_line = true;  ///< whether every refusal reads the same
  };
  constexpr const char* kBroken = "(disk I/O error)";
  const std::vector<Failure> failures = {
      {{.kind = Kind::error, .at = 1}, kBroken},
      {{.kind = Kind::short_write, .at = 1}, "", false},
      {{.kind = Kind::full, .at = 1, .only = DiskOperation::write, .is_persistent = true}, ""},
      {{.kind = Kind::error, .at = 1, .only = DiskOperation::sync, .is_persistent = false},
       kBroken}};
  for (const auto& [fault, words, is_one_line] : failures) {
    int unnoticed = 0;
    const std::set<std::string> lines = fail_everywhere(fault, unnoticed);
    INFO("kind " << static_cast<int>(fault.kind));
    REQUIRE(unnoticed == 0);
    if (!is_one_line) continue;
    REQUIRE(lines.size() == 1);
    REQUIRE(contains(*lines.begin(), words));
  }
}

TEST_CASE("every event that is acknowledged was synced on its own") {
  FaultVfs vfs;
  StoredFixture study(finished_session());
  StudyStore store = writable(study.path);
  Acknowledged acknowledged;
  record_session(store, acknowledged, [&](const std::function<void()>& step) {
    vfs.plan({});
    step();
    REQUIRE(vfs.count(DiskOperation::sync) >= 1);
  });
}
