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

void check(bool condition, const char* fault) {
  if (!condition) throw VerificationError(fault);
}

/// Reports that the key is older than the station file.
[[noreturn]] void refuse_older_key(const std::string& what) {
  throw VerificationError(
      what +
      ": the key is older than the last `touchtrial plan`; use a newer copy, or "
      "run the same `plan` again with this key");
}

void require_same_study(const study::StudyKey& key, const study::StationKey& station) {
  check(station.study_id == key.study_id,
        "belongs to another study; give the station the file that was made with this key");
  check(
      station.seal == key.seal && station.configuration == key.configuration,
      "was made from another version of the study; run `touchtrial prepare`, and give the station "
      "its new file");
  const auto code = [](const study::KeyedStimulus& keyed) { return keyed.code; };
  check(std::ranges::equal(station.fields(), key.fields(), {}, code, code) &&
            station.catch_code == key.catch_code,
        "has codes that differ from the key's; give the station the file that was made with the "
        "key");
}

void require_same_secrets(const study::StudyKey& key, const study::StationKey& station) {
  check(station.investigator_box == key.box().public_half &&
            station.investigator_signature == key.signer().public_half(),
        "encrypts for another investigator; give the station the file that was made with this key");
  const auto key_station =
      std::ranges::find(key.stations, station.station.name, &study::Station::name);
  if (key_station == key.stations.end() && key.stations.front().name == study::kOnlyStation) {
    refuse_older_key("belongs to a station that the key does not have");
  }
  check(key_station != key.stations.end(),
        "belongs to a station that the key does not have; give the station the file that "
        "`touchtrial plan` wrote");
  check(station.station.secret == key_station->secret,
        "has a secret that differs from the key's for this station; give the station the file that "
        "was made with this key");
  if (key_station->size() < station.station.size()) {
    refuse_older_key("has enrolment numbers that the key does not have");
  }
  check(station.station.ranges == key_station->ranges,
        "has enrolment numbers that differ from the key's for this station; give the station "
        "its new file");
  const Bytes statement =
      station_statement(station.study_id, station.station.name, station.signer().public_half());
  check(is_signed_by(key.signer().public_half(), statement, station.certificate),
        "was not signed with this key; give the station the file that was made with the key");
}

/// The record that a station stores when it opens a session.
struct TestRecord {
  int enrolment = 0;
  Bytes wrapped;       ///< the participant's key, encrypted for the investigator
  Bytes station_copy;  ///< the same key, encrypted for the station
  record::BufferedEvents events;
};

TestRecord test_record(const study::StationKey& station) {
  TestRecord record;
  record.enrolment = station.station.ranges.front().first;
  SystemEntropy entropy;
  const SecretKey key = entropy.secret("participant key");
  record.wrapped =
      record::wrap_participant_key(station.investigator_box, kTestSession, key).participant;
  record.station_copy = record::seal_station_copy(station.station.secret, kTestSession, key);
  auto order =
      study::make_order(station.study, station.draw_of(record.enrolment, study::Draws::people));
  const std::string schedule = study::schedule_to_json(order->schedule(), station);
  Session session(std::move(order), station.study.trials,
                  record::SessionRecorder(kTestSession, key, record.events),
                  block_serialiser(station));
  record::SessionOpening opening;
  opening.participant = "test";
  opening.enrolment = record.enrolment;
  opening.study_id = station.study_id;
  opening.seal = station.seal;
  session.open({}, opening, schedule);
  return record;
}

/// The schedule in a record, decrypted with the key; nothing if it cannot be decrypted.
std::optional<study::Schedule> opened_schedule(const study::StudyKey& key,
                                               const TestRecord& record) {
  const auto participant_key =
      record::unwrap_participant_key(key.box(), kTestSession, record.wrapped);
  if (!participant_key) return std::nullopt;
  const auto opened = record::opened_event(record.events.events.front(), *participant_key);
  if (!opened) return std::nullopt;
  return study::schedule_from_json(opened->secret, key);
}

}  // namespace

void require_decryptable(const study::StudyKey& key, const study::StationKey& station,
                         const engine::Pack& pack) {
  require_same_study(key, station);
  require_same_secrets(key, station);
  study::require_complete_pack(pack, station);
  check(!station.station.ranges.empty(),
        "has no enrolment numbers; assign some with `touchtrial plan --extend`");
  const TestRecord record = test_record(station);
  check(record::open_station_copy(station.station.secret, kTestSession, record.station_copy) ==
            record::unwrap_participant_key(key.box(), kTestSession, record.wrapped),
        "wrote a test record that the station cannot decrypt; run `touchtrial prepare`");
  const auto schedule = opened_schedule(key, record);
  check(schedule.has_value(),
        "wrote a test record that the key cannot decrypt; run `touchtrial prepare`");
  check(*schedule ==
            study::make_schedule(key.study, key.draw_of(record.enrolment, study::Draws::people)),
        "draws a different schedule than the key; run `touchtrial prepare`");
}

}  // namespace touchtrial::session
