// Attacks by somebody who can write the database and its head files, and has the study file, the
// pack and this program's source, but no station's file and no key.
#include "analysis/text_matching.hpp"
#include "analysis/verification/verification.hpp"
#include "attacks/forger.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/head_file.hpp"
#include "record/payload_json.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

using namespace touchtrial;
using namespace touchtrial::attacks;
using record::EventKind;

namespace {

Signer forger() {
  return Signer(sha256(bytes_of("the forger's own key")));
}

void forge_answer(record::Event& event) {
  event.sealed[event.sealed.size() / 2] ^= 1U;
}

/// Signs the station in the first event as if `investigator` were the study's.
void certify(Forgery& forged, const Signer& investigator, const Signer& station) {
  record::StudyCommitment commitment =
      record::from_json<record::StudyCommitment>(forged.file().front().body);
  commitment.investigator = investigator.public_half();
  commitment.station->key = station.public_half();
  commitment.station->certificate = investigator.sign(
      station_statement(commitment.study_id, commitment.station->name, station.public_half()));
  forged.file().front().body = record::to_json(commitment);
}

constexpr const char* kUnsigned = "[unsigned]";
constexpr const char* kUnsignedLook = "[unsigned-look]";
constexpr const char* kDoesNotOpen = "[does-not-open]";

struct Attack {
  std::string what;
  std::function<void(Forgery&)> forge;
  std::string words;  ///< the code, and numbers, that `verify` names once all chains are made anew
};

/// In clear, on the file's chain, and in sessions that have ended.
const std::vector<Attack> kAttacks = {
    {"an answer's sealed bytes altered",
     [](Forgery& it) { forge_answer(it.first(2, EventKind::answered)); }, kUnsigned},
    {"an event's body altered",
     [](Forgery& it) { set(it.first(3, EventKind::presented), "block", "7"); }, kUnsigned},
    {"an exclusion moved before the look",
     [](Forgery& it) { std::swap(it.file()[4], it.file()[5]); }, kUnsigned},
    {"an exclusion erased", [](Forgery& it) { it.file().erase(it.file().begin() + 5); }, kUnsigned},
    {"an interim look erased", [](Forgery& it) { it.file().erase(it.file().begin() + 4); },
     kUnsigned},
    {"an interim look invented", [](Forgery& it) { it.file().push_back(it.file()[4]); },
     kUnsignedLook},
    {"a session dropped from the middle", [](Forgery& it) { it.drop(2); }, "3 [session-order]"},
    {"a session's end and its line removed",
     [](Forgery& it) {
       it.chains.at(3).pop_back();
       it.file().erase(it.file().begin() + 9);
     },
     kUnsigned},
    {"the station's clock shifted",
     [](Forgery& it) {
       for (record::Event& event : it.file()) event.at += std::chrono::hours(1);
     },
     kUnsigned},
    {"two participants' sessions exchanged",
     [](Forgery& it) {
       for (record::Event* event :
            {&it.chains.at(2).front(), &it.chains.at(3).front(), &it.file()[6], &it.file()[8]}) {
         const bool is_second = contains(event->body, "P02");
         set(*event, "participant", is_second ? "\"P03\"" : "\"P02\"");
         set(*event, "enrolment", is_second ? "3" : "2");
       }
     },
     kUnsigned},
    {"sealed answers of two sessions exchanged",
     [](Forgery& it) {
       std::swap(it.first(2, EventKind::answered).sealed, it.first(3, EventKind::answered).sealed);
     },
     kUnsigned},
    {"a participant's key replaced by one's own", [](Forgery& it) { it.keys[2] = it.keys.at(3); },
     kUnsigned},
    {"a signature copied to another event",
     [](Forgery& it) { it.file()[4].signature = it.file()[5].signature; }, kUnsignedLook},
    {"signatures taken off",
     [](Forgery& it) {
       for (record::Event& event : it.file()) event.signature.clear();
     },
     kUnsigned},
    {"everything signed with one's own key",
     [](Forgery& it) {
       const Signer own = forger();
       for (record::Event& event : it.file()) event = record::signed_event(event, own);
     },
     kUnsigned},
    {"a station of one's own that the investigator did not sign for",
     [](Forgery& it) {
       set(it.file().front(), "station",
           R"({"name": "own", "key": ")" + to_hex(forger().public_half()) +
               R"(", "certificate": ")" + std::string(128, '0') + "\"}");
     },
     "own [uncertified]"},
};

/// Of the open session, whose chain nobody has signed beyond its first event.
const std::vector<Attack> kAttacksOnOpenSession = {
    {"an answer's sealed bytes altered",
     [](Forgery& it) { forge_answer(it.first(4, EventKind::answered)); }, kDoesNotOpen},
    {"an event's body altered",
     [](Forgery& it) { set(it.first(4, EventKind::presented), "block", "7"); }, kDoesNotOpen},
    {"an event removed from the middle",
     [](Forgery& it) { it.chains.at(4).erase(it.chains.at(4).begin() + 2); }, kDoesNotOpen},
    {"two answers exchanged",
     [](Forgery& it) {
       // opened; then presented, first-contact, trace-stored, answered for each trial
       std::swap(it.chains.at(4).at(4).sealed, it.chains.at(4).at(8).sealed);
     },
     kDoesNotOpen},
    {"an answer of another session put in",
     [](Forgery& it) { it.chains.at(4).at(4).sealed = it.first(2, EventKind::answered).sealed; },
     kDoesNotOpen},
    {"a trace and its digest exchanged",
     [](Forgery& it) {
       std::swap(it.first(4, EventKind::trace_stored).body, it.chains.at(4).at(7).body);
       for (const int at : {3, 7}) {
         set(it.chains.at(4).at(static_cast<std::size_t>(at)), "trial", at == 3 ? "1" : "2");
       }
       record::SealedTrace* ours = nullptr;
       for (record::SealedTrace& trace : it.traces) {
         if (trace.session != 4 || trace.trial > 2) continue;
         if (ours != nullptr) std::swap(ours->box, trace.box);
         ours = &trace;
       }
     },
     kDoesNotOpen},
    {"an event's time written in clear",
     [](Forgery& it) { it.first(4, EventKind::answered).at = std::chrono::seconds(1); },
     "[time-in-clear]"},
    {"the session's end invented",
     [](Forgery& it) {
       record::Event end = it.chains.at(4).back();
       end.kind = EventKind::closed;
       end.body = R"({"complete":true})";
       it.chains.at(4).push_back(end);
     },
     "[unrecorded-end]"},
};

/// \param place  words of what `verify` finds
void require_found(AttackedStudy& study, const Attack& attack, const std::string& place) {
  INFO(attack.what);
  Forgery forged(study.database());
  attack.forge(forged);
  forged.relink();
  forged.write();
  INFO(study.found());
  CHECK(names_in_order(study.found(), place));
  note(attack.what, Outcome::named);
}

/// Whether this station can go on with the open session: every event opens with the key it kept.
bool can_resume(const AttackedStudy& study) {
  const record::StudyStore store =
      record::StudyStore::open(study.database(), record::StudyStore::Access::read_only);
  const std::optional<Bytes> kept = store.kept_key(AttackedStudy::open_session());
  if (!kept) return false;
  const auto own = record::open_station_copy(study.station().station.secret,
                                             AttackedStudy::open_session(), *kept);
  if (!own) return false;
  const std::vector<record::Event> events = store.events(AttackedStudy::open_session());
  return std::ranges::all_of(events, [&](const record::Event& event) {
    return record::opened_event(event, *own).has_value();
  });
}

/// The database as it was left, for one attack after the other.
class Restored {
 public:
  explicit Restored(AttackedStudy& study) : study_(study), whole_(read_file(study.database())) {}
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;
  void restore() const { replace_file(study_.database(), ByteView(whole_)); }

 private:
  AttackedStudy& study_;
  Bytes whole_;
};

}  // namespace

TEST_CASE("an untouched study holds, with the key and without, and its session can go on") {
  AttackedStudy study;
  study.close();
  CHECK(study.found().empty());
  CHECK(study.found_without_key().empty());
  CHECK(can_resume(study));
  // A forger's tools alone change nothing.
  const std::string before = rows_of(study.database());
  Forgery forged(study.database());
  forged.relink();
  forged.write();
  CHECK(rows_of(study.database()) == before);
  CHECK(study.found().empty());
}

TEST_CASE("whoever makes the chains anew without a station's file is named by a signature") {
  AttackedStudy study;
  study.close();
  const Restored whole(study);
  for (const Attack& attack : kAttacks) {
    whole.restore();
    require_found(study, attack, "chain: " + attack.words);
    INFO(attack.what);
    CHECK(names_in_order(study.found_without_key(), "chain: " + attack.words));
  }
}

TEST_CASE("an open session made anew does not open, and its head gives it away without a key") {
  AttackedStudy study;
  study.close();
  const Restored whole(study);
  for (const Attack& attack : kAttacksOnOpenSession) {
    whole.restore();
    require_found(study, attack, "4 " + attack.words);
    INFO(attack.what);
    CHECK_FALSE(study.found_without_key().empty());
    CHECK_FALSE((attack.words == kDoesNotOpen && can_resume(study)));
  }
}

TEST_CASE("swapped and replaced traces and keys are named where no chain was made anew") {
  AttackedStudy study;
  study.close();
  const Restored whole(study);
  const std::vector<std::pair<std::string, std::string>> attacks = {
      {"UPDATE traces SET box = (SELECT t.box FROM traces t WHERE t.session = 3 AND t.trial = 1) "
       "WHERE session = 2 AND trial = 1",
       "2 1 [altered-trace]"},
      {"UPDATE participant_keys SET wrapped = (SELECT k.wrapped FROM participant_keys k WHERE "
       "k.session = 3) WHERE session = 2",
       "2 [altered-key]"},
      {"DELETE FROM participant_keys WHERE session = 2", "2 [missing-key]"},
      {"UPDATE events SET own_session = session WHERE session = 2", "2 [own-number]"},
      {"UPDATE events SET own_session = session WHERE session = 0", "[own-number]"},
      {"INSERT INTO station_keys SELECT session + 4294967296, kept FROM station_keys",
       "[stray-copy]"},
      {"UPDATE station_keys SET kept = zeroblob(length(kept))", "4 [altered-copy]"},
      {"DELETE FROM station_keys", "4 [missing-copy]"},
  };
  for (const auto& [sql, words] : attacks) {
    INFO(sql);
    whole.restore();
    with_sql(study.database(), sql);
    INFO(study.found());
    CHECK(names(study.found(), "chain: " + words));
    note("rows altered behind the program's back", Outcome::named);
  }
}

TEST_CASE("a participant's key wrapped by a forger for the investigator is named") {
  AttackedStudy study;
  study.close();
  const SecretKey own = sha256(bytes_of("the forger's participant"));
  Forgery forged(study.database());
  const record::NewKeys wrapped =
      record::wrap_participant_key(study.key().investigator_box, 2, own);
  forged.keys[2] = {.participant = wrapped.participant, .safety = wrapped.safety};
  forged.write();
  CHECK(names(study.found(), "chain: 2 [altered-key]"));
  forged.relink();
  forged.write();
  CHECK(names(study.found(), "chain: [unsigned]"));
  note("a participant's key wrapped by the forger", Outcome::named);
}

TEST_CASE("a study made anew with an investigator of one's own is found by the key alone") {
  AttackedStudy study;
  study.close();
  const Signer own = forger();
  Forgery forged(study.database());
  std::erase_if(forged.file(), [](const record::Event& event) {
    return event.kind == EventKind::study_unblinded || event.kind == EventKind::heads_kept;
  });
  certify(forged, own, own);
  forged.relink(&own);
  forged.write();
  CHECK(names(study.found(), "[other-investigator]"));
  CHECK_FALSE(study.found_without_key().empty());  // the genuine head file is still there
  note("an investigator of one's own", Outcome::named);
  // Without the key only the investigator that `verify` prints differs.
  fs::remove(study.head());
  CHECK(study.found_without_key().empty());
  const analysis::Verification verification = analysis::verify_study(
      record::StudyStore::open(study.database(), record::StudyStore::Access::read_only), nullptr,
      nullptr);
  CHECK(verification.investigator == own.public_half());
  CHECK_FALSE(verification.investigator == study.key().investigator_signature);
  note("an investigator of one's own, checked without the key", Outcome::possible);
}

TEST_CASE("sessions dropped from the end are named by the head files, and by a head on paper") {
  AttackedStudy study;
  const Digest on_paper = study.store().file_head().hash;
  study.close();
  Forgery forged(study.database());
  forged.drop(4);
  forged.drop(3);
  forged.write();
  CHECK(contains(study.found(), "heads: "));
  CHECK(names(study.found_without_key(), "8"));
  note("sessions dropped from the end", Outcome::named);
  for (const fs::path& file : {study.head(), study.second_head()}) {
    fs::remove(file);
    CHECK(contains(study.found_without_key(), file.string()));
  }
  note("sessions dropped from the end, and the head files removed", Outcome::named);
  CHECK(names(study.found_by_head(on_paper), "[unknown-head]"));
}

TEST_CASE("a session that has ended cannot be opened again to be sealed by the station") {
  AttackedStudy study(0);
  study.close();
  Forgery forged(study.database());
  forged.chains.at(3).pop_back();
  forged.file().pop_back();
  forged.write();
  CHECK(contains(study.found(), "heads: "));
  study.open();
  // The station does not hold the key any more, and says so instead of going on.
  CHECK_FALSE(study.store().kept_key(3));
  note("an ended session opened again", Outcome::refused);
}

TEST_CASE("the station signs nothing on top of a chain that somebody made anew") {
  AttackedStudy study;
  study.close();
  Forgery forged(study.database());
  forged.file().erase(forged.file().begin() + 4);  // the interim look
  forged.relink();
  forged.write();
  study.store() =
      record::StudyStore::open(study.database(), record::StudyStore::Access::read_write);
  study.store().sign_with(study.station().signer());
  const std::string refusal =
      message_of<StoreError>([&] { study.store().note(2, std::chrono::seconds(9), "", "late"); });
  CHECK(names(refusal, kUnsigned));
  note("a forged chain continued by the station", Outcome::refused);
}
