#include "protocols/session/key_check.hpp"

#include "core/cipher.hpp"
#include "core/errors.hpp"
#include "core/public_keys.hpp"
#include "protocols/session/session.hpp"
#include "record/sealing.hpp"
#include "study/protocol.hpp"
#include "study/signed_pack.hpp"

#include <algorithm>
#include <optional>
#include <string>

namespace touchtrial::session {
namespace {

constexpr int kTestSession = 1;

void require_holds(bool holds, const char* what) {
  if (!holds) throw VerificationError(what);
}

/// The key signed for this station since it was written.
[[noreturn]] void refuse_older_key(const std::string& what) {
  throw VerificationError(what +
                          ": the key is from before the last `touchtrial plan`; take a newer "
                          "copy, or run the same `plan` again with this key");
}

void require_same_study(const study::StudyKey& key, const study::StationKey& station) {
  require_holds(station.study_id == key.study_id,
                "is another study's; give the station the file that was made with this key");
  require_holds(
      station.seal == key.seal && station.configuration == key.configuration,
      "was made before or after a change of the study; run `touchtrial prepare`, and give "
      "the station its new file");
  const auto code = [](const study::KeyedStimulus& keyed) { return keyed.code; };
  require_holds(std::ranges::equal(station.fields(), key.fields(), {}, code, code) &&
                    station.catch_code == key.catch_code,
                "has other codes than the key; give the station the file that was made with it");
}

void require_same_secrets(const study::StudyKey& key, const study::StationKey& station) {
  require_holds(
      station.investigator_box == key.box().public_half &&
          station.investigator_signature == key.signer().public_half(),
      "seals for another investigator; give the station the file that was made with this key");
  const auto own = std::ranges::find(key.stations, station.station.name, &study::Station::name);
  if (own == key.stations.end() && key.stations.front().name == study::kOnlyStation) {
    refuse_older_key("is of a station that the key does not know");
  }
  require_holds(own != key.stations.end(),
                "is of a station that the key does not know; give the station the file that "
                "`touchtrial plan` wrote");
  require_holds(
      station.station.secret == own->secret,
      "has another secret than the key gives this station; give the station the file that "
      "was made with this key");
  if (own->size() < station.station.size()) {
    refuse_older_key("has enrolment numbers that the key does not know");
  }
  require_holds(station.station.ranges == own->ranges,
                "has other enrolment numbers than the key gives this station; give the station its "
                "new file");
  const Bytes statement =
      station_statement(station.study_id, station.station.name, station.signer().public_half());
  require_holds(is_signed_by(key.signer().public_half(), statement, station.certificate),
                "was not signed with this key; give the station the file that was made with it");
}

/// The record that a station stores when it opens a session.
struct TestRecord {
  int enrolment = 0;
  Bytes wrapped;  ///< the participant's key, for the investigator
  Bytes kept;     ///< the same, for the station
  record::BufferedEvents events;
};

TestRecord test_record(const study::StationKey& station) {
  TestRecord record;
  record.enrolment = station.station.ranges.front().first;
  SystemEntropy entropy;
  const SecretKey key = entropy.secret("participant key");
  record.wrapped =
      record::wrap_participant_key(station.investigator_box, kTestSession, key).participant;
  record.kept = record::keep_participant_key(station.station.secret, kTestSession, key);
  auto order =
      study::make_order(station.study, station.draw_of(record.enrolment, study::Draws::people));
  const std::string schedule = study::schedule_to_json(order->schedule(), station);
  Session session(std::move(order), station.study.trials,
                  record::SessionRecorder(kTestSession, key, record.events), seal_with(station));
  record::SessionOpening opening;
  opening.participant = "test";
  opening.enrolment = record.enrolment;
  opening.study_id = station.study_id;
  opening.seal = station.seal;
  session.open({}, opening, schedule);
  return record;
}

/// The schedule that the key opens in a record.
std::optional<study::Schedule> opened_schedule(const study::StudyKey& key,
                                               const TestRecord& record) {
  const auto own = record::unwrap_participant_key(key.box(), kTestSession, record.wrapped);
  if (!own) return std::nullopt;
  const auto opened = record::opened_event(record.events.events.front(), *own);
  if (!opened) return std::nullopt;
  return study::schedule_from_json(opened->secret, key);
}

}  // namespace

void require_opens(const study::StudyKey& key, const study::StationKey& station,
                   const engine::Pack& pack) {
  require_same_study(key, station);
  require_same_secrets(key, station);
  study::require_whole(pack, station);
  require_holds(!station.station.ranges.empty(),
                "has no enrolment numbers; hand some out with `touchtrial plan --extend`");
  const TestRecord record = test_record(station);
  require_holds(record::kept_participant_key(station.station.secret, kTestSession, record.kept) ==
                    record::unwrap_participant_key(key.box(), kTestSession, record.wrapped),
                "sealed a test record whose key the station cannot recover");
  const auto schedule = opened_schedule(key, record);
  require_holds(schedule.has_value(), "sealed a test record that the key does not open");
  require_holds(*schedule == study::make_schedule(
                                 key.study, key.draw_of(record.enrolment, study::Draws::people)),
                "draws another schedule than the key");
}

}  // namespace touchtrial::session
