/// Stations: which numbers they hand out, what their schedules are drawn from, and their files.
#include "study/station.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "study/random_orders.hpp"
#include "study/study_examples.hpp"
#include "study/study_key.hpp"
#include "support/names.hpp"
#include "support/refusal.hpp"
#include "support/temp_folder.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include <sys/stat.h>

namespace touchtrial {
namespace {

using namespace study;

Study study_with_methods(int methods) {
  nlohmann::json study = comparison_of(2);
  study["methods"] = nlohmann::json::array();
  for (int i = 0; i < methods; ++i) {
    study["methods"].push_back(
        {{"name", "fixed"}, {"label", "m" + std::to_string(i)}, {"order", 0.1 * (i + 1)}});
  }
  return parsed(study);
}

std::vector<Station> stations_with(int participants, int count) {
  std::vector<std::string> names;
  for (int i = 1; i <= count; ++i) names.push_back("s" + std::to_string(i));
  std::vector<Station> stations = study::stations_named(names);
  study::assign_enrolments(stations, participants);
  return stations;
}

StudyKey divided_key(const Study& study, int participants, int count, std::uint64_t seed = 1) {
  SeededEntropy entropy(seed);
  StudyKey key = study::make_study_key(study, entropy, false);
  study::assign_stations(key, stations_with(participants, count));
  return key;
}

/// Which station has each number, from 1; every number has one.
std::vector<std::string> owners(const std::vector<Station>& stations) {
  std::vector<std::string> owner(static_cast<std::size_t>(enrolment_count(stations)));
  for (const Station& station : stations) {
    for (const EnrolmentRange& range : station.ranges) {
      for (int number = range.first; number <= range.last; ++number) {
        std::string& place = owner.at(static_cast<std::size_t>(number - 1));
        CHECK(place.empty());
        place = station.name;
      }
    }
  }
  CHECK(std::ranges::none_of(owner, &std::string::empty));
  return owner;
}

void check_even(const std::vector<Station>& stations) {
  std::vector<int> sizes;
  for (const Station& station : stations) sizes.push_back(station.size());
  const auto [least, most] = std::ranges::minmax(sizes);
  CAPTURE(stations.size(), least, most);
  CHECK(most - least <= 1);
}

}  // namespace

TEST_CASE("every number belongs to one station, and each gets as many as can be") {
  for (int participants = 1; participants <= 60; ++participants) {
    for (int count = 1; count <= 7; ++count) {
      const std::vector<Station> stations = stations_with(participants, count);
      CHECK(owners(stations).size() == static_cast<std::size_t>(participants));
      check_even(stations);
    }
  }
}

TEST_CASE("numbers that are handed out later leave every other where it was") {
  std::vector<Station> stations = stations_with(10, 4);
  const std::vector<std::string> before = owners(stations);
  study::assign_enrolments(stations, 31);
  const std::vector<std::string> after = owners(stations);
  REQUIRE(after.size() == 31);
  CHECK(std::equal(before.begin(), before.end(), after.begin()));
  check_even(stations);
  CHECK_THROWS_AS(study::assign_enrolments(stations, 30), std::invalid_argument);
  CHECK(study::station_of(stations, 1)->name == "s1");
  CHECK(study::station_of(stations, 32) == nullptr);
}

TEST_CASE("a station takes its smallest number that nobody has") {
  const std::vector<Station> stations = stations_with(6, 2);
  CHECK(study::next_enrolment_of(stations[1], {}) == 4);
  CHECK(study::next_enrolment_of(stations[1], {4, 1}) == 5);
  CHECK(study::next_enrolment_of(stations[0], {1, 3}) == 2);
  CHECK_THAT(message_of<StudyError>([&] {
               return study::next_enrolment_of(stations[0], {1, 2, 3});
             }),
             names("s1 --extend"));
}

TEST_CASE("names of stations are simple, and each is one station's") {
  const auto refused = [](const std::vector<std::string>& names) {
    CHECK_THROWS_AS(study::stations_named(names), UsageError);
  };
  refused({});
  refused({""});
  refused({"lab/2"});
  refused({std::string(33, 'a')});
  refused({"a", "a"});
  refused(std::vector<std::string>(kMaxStations + 1, "a"));
}

TEST_CASE("each station has every order of methods equally often, in blocks that nobody can tell") {
  for (int methods = 2; methods <= 5; ++methods) {
    const int rows = methods % 2 == 0 ? methods : 2 * methods;
    const StudyKey key = divided_key(study_with_methods(methods), 12 * rows, 3);
    std::set<std::vector<int>> blocks;
    std::set<int> numbers_of_blocks;
    for (const Station& station : key.stations) {
      int number = station.ranges.front().first;
      for (int block = 0; block < 4; ++block) {
        std::vector<int> orders;
        std::set<int> dealt_together;
        for (int i = 0; i < rows; ++i) {
          dealt_together.insert(order_block_of(key.study, key.stations, number));
          orders.push_back(key.draw_of(number++, Draws::people).method_order);
        }
        CHECK(dealt_together.size() == 1);
        CHECK(numbers_of_blocks.insert(*dealt_together.begin()).second);
        blocks.insert(orders);
        std::ranges::sort(orders);
        for (int row = 0; row < rows; ++row) CHECK(orders[static_cast<std::size_t>(row)] == row);
      }
    }
    CHECK(*numbers_of_blocks.begin() >= 0);
    CHECK(order_block_of(key.study, key.stations, 12 * rows + 1) == -1);
    CHECK(blocks.size() > 1);  // 12 blocks in one and the same order: once in 2048 at most
  }
}

TEST_CASE("in a study of mixed blocks methods have no order") {
  nlohmann::json document = comparison_of(2);
  document["trials"] = {{"blocks", "mixed"}};
  const StudyKey key = divided_key(parsed(document), 6, 2);
  CHECK(method_orders(key.study) == 1);
  for (int number = 1; number <= 6; ++number) {
    CHECK(key.draw_of(number, Draws::people).method_order == 0);
  }
}

TEST_CASE("a schedule follows from the key's secret, and never from the study's seed") {
  const Study study = parsed(study_of(5));
  const auto schedule = [&](std::uint64_t secret, Draws draws, int number = 1) {
    const StudyKey key = divided_key(study, 20, 1, secret);
    return study::make_schedule(study, key.draw_of(number, draws));
  };
  CHECK(schedule(1, Draws::people) == schedule(1, Draws::people));
  CHECK_FALSE(schedule(1, Draws::people) == schedule(2, Draws::people));
  CHECK_FALSE(schedule(1, Draws::people) == schedule(1, Draws::rehearsal));
  CHECK_FALSE(schedule(1, Draws::people) == schedule(1, Draws::people, 2));
  const StudyKey simulated = simulated_study_key(study);
  const Schedule shown = study::make_schedule(study, simulated.draw_of(1, Draws::people));
  CHECK_FALSE(shown == schedule(1, Draws::people));
}

TEST_CASE("a station's file has its own secret alone, and draws as the investigator's key does") {
  const Study study = study_with_methods(2);
  const StudyKey key = divided_key(study, 10, 2);
  const StationKey own = study::station_key(key, "s2");
  for (int number = 6; number <= 10; ++number) {
    const ScheduleDraw drawn = own.draw_of(number, Draws::people);
    CHECK(drawn.secret == key.draw_of(number, Draws::people).secret);
    CHECK(drawn.method_order == key.draw_of(number, Draws::people).method_order);
  }
  CHECK_THROWS_AS(own.draw_of(5, Draws::people), UsageError);
  CHECK_THROWS_AS(key.draw_of(11, Draws::people), UsageError);
  CHECK(own.station.secret != study::station_key(key, "s1").station.secret);
  CHECK_THAT(message_of<UsageError>([&] { return study::station_key(key, "s3"); }),
             names("s3 s1 s2"));
  const Bytes statement = station_statement(key.study_id, "s2", own.signer().public_half());
  CHECK(is_signed_by(key.investigator_signature, statement, own.certificate));
  CHECK_FALSE(is_signed_by(key.investigator_signature,
                           station_statement(key.study_id, "s1", own.signer().public_half()),
                           own.certificate));
}

TEST_CASE("key and station file come back as they were written") {
  const TempFolder folder;
  const Study study = study::parse_study(comparison_of(3, 2).dump(1), folder.path(), "study.json");
  const StudyKey key = divided_key(study, 9, 3);
  study::save_study_key(folder.path() / "small.key", key);
  CHECK(load_study_key(folder.path() / "small.key").stations == key.stations);

  const StationKey own = study::station_key(key, "s3");
  const auto path = folder.path() / "small.s3.station";
  study::save_station_key(path, own);
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == 0600U);
  const StationKey loaded = load_station_key(path);
  CHECK(loaded.station == own.station);
  CHECK(loaded.certificate == own.certificate);
  CHECK(loaded.study_id == key.study_id);
  CHECK(loaded.seal == key.seal);
  CHECK(loaded.configuration == key.configuration);
  CHECK(loaded.catch_code == key.catch_code);
  CHECK(loaded.investigator_box == key.investigator_box);
  CHECK(are_same(loaded.study, study));
  REQUIRE(loaded.stimuli.size() == key.stimuli.size());
  for (const KeyedStimulus& stimulus : key.stimuli) {
    CHECK(loaded.stimulus_of(stimulus.code) == stimulus.stimulus);
  }
  const std::string text = text_of(read_file(path));
  CHECK(text.find(to_hex(key.master)) == std::string::npos);
  for (const char* other : {"s1", "s2"}) {
    const SecretKey secret = study::station_key(key, other).station.secret;
    CHECK(text.find(to_hex(secret)) == std::string::npos);
  }
}

TEST_CASE(
    "a station file whose name or numbers were edited is refused, with or without a checksum") {
  const TempFolder folder;
  const auto path = folder.path() / "small.station";
  study::save_station_key(path,
                          study::station_key(divided_key(parsed(minimal_study()), 2, 1), "s1"));
  nlohmann::json document = nlohmann::json::parse(text_of(read_file(path)));
  document["station"] = "s9";
  document.erase("check");
  document["check"] = to_hex(sha256(bytes_of(document.dump())));
  replace_file(path, document.dump(2) + "\n", FileMode::owner_only);
  CHECK_THAT(message_of<FileError>([&] { return load_station_key(path); }), names(path.string()));
}

TEST_CASE("a file of secrets that others may read is refused") {
  const TempFolder folder;
  const StudyKey key = divided_key(parsed(minimal_study()), 2, 1);
  const auto path = folder.path() / "small.key";
  study::save_study_key(path, key);
  for (const mode_t mode : {0640U, 0604U, 0620U}) {
    REQUIRE(::chmod(path.c_str(), mode) == 0);
    CHECK_THAT(message_of<FileError>([&] { return load_study_key(path); }), names("chmod 600"));
  }
  REQUIRE(::chmod(path.c_str(), 0400) == 0);
  CHECK_NOTHROW(load_study_key(path));
}

}  // namespace touchtrial
