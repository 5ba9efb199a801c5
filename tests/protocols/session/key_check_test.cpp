/// The proof before the first participant that sealed data will open.
#include "protocols/session/key_check.hpp"

#include "core/errors.hpp"
#include "protocols/session/tiny_study.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial {
namespace {

study::StationKey station_of(const study::StudyKey& key) {
  return study::station_key(key, key.stations.front().name);
}

TinyStudyOptions with_pictures() {
  return {.pictures = true};
}

/// What a station's file that was changed in one way is refused with; empty if it is accepted.
std::string fault_of(const TinyStudy& study,
                     const std::function<void(study::StationKey&)>& change) {
  study::StationKey station = station_of(study.key());
  change(station);
  return message_of<VerificationError>(
      [&] { session::require_decryptable(study.key(), station, study.pack()); });
}

}  // namespace

TEST_CASE("what a station seals opens with its study's key") {
  for (const bool comparison : {false, true}) {
    TinyStudyOptions options = with_pictures();
    options.comparison = comparison;
    const TinyStudy study(options);
    CHECK_NOTHROW(session::require_decryptable(study.key(), station_of(study.key()), study.pack()));
  }
}

TEST_CASE("a station's file with other codes of practice than the key is refused") {
  TinyStudyOptions options = with_pictures();
  options.trials = R"({"practice": 2})";
  options.practised = 2;
  const TinyStudy study(options);
  using Key = study::StationKey;
  CHECK(fault_of(study, [](Key&) {}).empty());
  CHECK_FALSE(
      fault_of(study, [](Key& key) { std::swap(key.practice[0], key.practice[1]); }).empty());
  CHECK_FALSE(fault_of(study, [](Key& key) { key.practice.pop_back(); }).empty());
}

TEST_CASE("every station of a divided study is proved, and an older file of one is not") {
  const TinyStudy study(with_pictures());
  study::StudyKey key = study.key();
  const std::vector<std::string> names = {"attic", "cellar"};
  std::vector<study::Station> stations = study::stations_named(names);
  study::assign_enrolments(stations, 10);
  study::assign_stations(key, stations);
  const study::StationKey older = study::station_key(key, "cellar");
  const study::StudyKey older_key = key;
  for (const std::string& name : names) {
    CHECK_NOTHROW(session::require_decryptable(key, study::station_key(key, name), study.pack()));
  }
  study::assign_enrolments(stations, 14);
  study::assign_stations(key, stations);
  CHECK_THROWS_AS(session::require_decryptable(key, older, study.pack()), VerificationError);
  CHECK_THROWS_AS(session::require_decryptable(key, station_of(study.key()), study.pack()),
                  VerificationError);
  const study::StationKey newer = study::station_key(key, "cellar");
  CHECK_THROWS_AS(session::require_decryptable(older_key, newer, study.pack()), VerificationError);
  CHECK_THROWS_AS(session::require_decryptable(study.key(), newer, study.pack()),
                  VerificationError);
}

TEST_CASE("a station's file that differs from the key in anything is refused") {
  const TinyStudy study(with_pictures());
  using Key = study::StationKey;
  CHECK(fault_of(study, [](Key&) {}).empty());
  const std::vector<void (*)(Key&)> changes = {
      [](Key& key) { key.study_id = "0123"; },
      [](Key& key) { key.seal[0] ^= 1U; },
      [](Key& key) { key.configuration += " "; },
      [](Key& key) { std::swap(key.stimuli[0], key.stimuli[1]); },
      [](Key& key) { key.catch_code = key.stimuli[0].code; },
      [](Key& key) { key.investigator_box[5] ^= 1U; },
      [](Key& key) { key.investigator_signature[5] ^= 1U; },
      [](Key& key) { key.station.name = "other"; },
      [](Key& key) { key.station.secret[0] ^= 1U; },
      [](Key& key) { key.station.ranges.front().first = 2; },
      [](Key& key) { key.certificate[63] ^= 1U; }};
  for (const auto& change : changes) CHECK_FALSE(fault_of(study, change).empty());
}

TEST_CASE("another study's pack, an altered field and an altered picture are refused") {
  const TinyStudy study(with_pictures());
  TinyStudyOptions options = with_pictures();
  options.secret = 2;
  const TinyStudy other(options);
  const study::StationKey station = station_of(study.key());
  CHECK_THROWS_AS(session::require_decryptable(study.key(), station, other.pack()), Error);
  const auto field =
      study.pack().folder() / (study.pack().manifest().entries.front().code + ".field");
  Bytes bytes = read_file(field);
  bytes.back() ^= 1U;
  replace_file(field, bytes);
  CHECK_THROWS_WITH(session::require_decryptable(study.key(), station, study.pack()),
                    names(study.pack().manifest().entries.front().code));
  bytes.back() ^= 1U;
  replace_file(field, bytes);
  CHECK_NOTHROW(session::require_decryptable(study.key(), station, study.pack()));
  const auto picture = study.key().study.folder / "bark0.png";
  replace_file(picture, std::string("another"));
  CHECK_THROWS_WITH(session::require_decryptable(study.key(), station, study.pack()),
                    names(picture.string()));
}

}  // namespace touchtrial
