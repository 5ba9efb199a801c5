/// The investigator's key on paper.
#include "protocols/design/recovery_sheet.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/hash.hpp"
#include "protocols/design/refusal.hpp"
#include "protocols/design/study_examples.hpp"
#include "support/temp_folder.hpp"

#include <vector>

namespace touchtrial {
namespace {

/// A study of three stations, two of which got numbers twice.
design::StudyKey divided_study_key(std::uint64_t seed = 1) {
  SeededEntropy entropy(seed);
  design::StudyKey key = design::make_study_key(parsed(comparison_of(3, 2)), entropy, false);
  const std::vector<std::string> names = {"attic", "b-2", "cellar"};
  std::vector<design::Station> stations = design::stations_named(names);
  design::hand_out_enrolments(stations, 10);
  design::hand_out_enrolments(stations, 17);
  design::divide(key, std::move(stations));
  return key;
}

std::vector<std::string> numbered(const std::vector<std::string>& lines) {
  std::vector<std::string> all;
  for (const std::string& line : lines) all.push_back(std::to_string(all.size() + 1) + ": " + line);
  return all;
}

design::RecoveryReader reader_of(const std::vector<std::string>& lines) {
  design::RecoveryReader reader;
  for (const std::string& line : lines) CHECK(reader.take(line));
  return reader;
}

/// Whether the line is refused with its own number.
bool is_refused(const std::string& line, int number) {
  design::RecoveryReader reader;
  try {
    return !reader.take(line);
  } catch (const UsageError& error) {
    return std::string(error.what()).starts_with("line " + std::to_string(number) + " ");
  }
}

}  // namespace

TEST_CASE("a line of too few digits is refused, even if its check fits") {
  for (const int number : {3, 5, 6}) {
    const std::string check = to_hex(FieldHasher()
                                         .add("touchtrial recovery sheet 1")
                                         .add(std::int64_t{number})
                                         .add("7")
                                         .finish())
                                  .substr(0, 4);
    CHECK(is_refused(std::to_string(number) + ": 7 " + check, number));
  }
}

TEST_CASE("a key made again from its lines is the same file, and so are its stations'") {
  const TempFolder folder;
  const design::StudyKey key = divided_study_key();
  const std::vector<std::string> lines = numbered(design::recovery_lines(key));
  CHECK(lines.size() == 6 + 6);
  design::RecoveryReader reader;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) CHECK(reader.take(*line));
  CHECK(reader.missing() == 0);
  const design::StudyKey again = reader.key_for(key.study);
  CHECK(reader.is_sealed_as(again));
  const auto bytes_of_key = [&](const design::StudyKey& one) {
    design::save_study_key(folder.path() / "one.key", one);
    return read_file(folder.path() / "one.key");
  };
  CHECK(bytes_of_key(again) == bytes_of_key(key));
  for (const design::Station& station : key.stations) {
    const auto bytes_of_station = [&](const design::StudyKey& one) {
      design::save_station_key(folder.path() / "one.station",
                               design::station_key(one, station.name));
      return read_file(folder.path() / "one.station");
    };
    CHECK(bytes_of_station(again) == bytes_of_station(key));
  }
}

TEST_CASE("a wrong digit and two that changed places are found in their line") {
  const std::vector<std::string> lines = numbered(design::recovery_lines(divided_study_key()));
  int tried = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const std::string& line = lines[n];
    const auto number = static_cast<int>(n + 1);
    for (std::size_t i = line.find(':') + 2; i < line.size(); ++i) {
      if (line[i] == ' ') continue;
      for (const char digit : std::string("0123456789abcdef")) {
        std::string wrong = line;
        wrong[i] = digit;
        if (wrong == line) continue;
        INFO(wrong);
        CHECK(is_refused(wrong, number));
        ++tried;
      }
      std::string swapped = line;
      if (i + 1 == line.size() || line[i + 1] == ' ' || line[i + 1] == line[i]) continue;
      std::swap(swapped[i], swapped[i + 1]);
      CHECK(is_refused(swapped, number));
    }
  }
  CHECK(tried > 1500);
}

TEST_CASE("a line under another number is refused") {
  const std::vector<std::string> lines = design::recovery_lines(divided_study_key());
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const auto other = static_cast<int>((n + 1) % lines.size() + 1);
    CHECK(is_refused(std::to_string(other) + ": " + lines[n], other));
  }
}

TEST_CASE("spaces, capitals and letters that look like digits are forgiven") {
  const std::vector<std::string> lines = design::recovery_lines(divided_study_key());
  for (int number = 1; number <= 6; ++number) {
    std::string typed = lines[static_cast<std::size_t>(number - 1)];
    std::erase(typed, ' ');
    for (char& letter : typed) {
      if (letter == '0') letter = 'O';
      if (letter == '1') letter = 'l';
      if (letter >= 'a' && letter <= 'f') letter = static_cast<char>(letter - 'a' + 'A');
    }
    design::RecoveryReader reader;
    CHECK(reader.take("  " + std::to_string(number) + " :\t" + typed + "\r"));
  }
}

TEST_CASE("other text of a page is passed over") {
  design::RecoveryReader reader;
  for (const char* text : {"", "Recovery sheet of the study small", "study: small", "line 1: a",
                           ": 12", "-1: 2", "Lines 1 to 4 are the secret: keep it", "12"}) {
    INFO(text);
    CHECK_FALSE(reader.take(text));
  }
  CHECK(reader.missing() == 1);
}

TEST_CASE("a missing line is named, and lines of two sheets are told apart") {
  const design::StudyKey key = divided_study_key();
  const std::vector<std::string> lines = numbered(design::recovery_lines(key));
  for (std::size_t left_out = 0; left_out < lines.size(); ++left_out) {
    std::vector<std::string> others = lines;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const design::RecoveryReader reader = reader_of(others);
    CHECK(reader.missing() == static_cast<int>(left_out + 1));
    CHECK(refuses<UsageError>([&] { return reader.key_for(key.study); },
                              "line " + std::to_string(left_out + 1) + " of the sheet is missing"));
  }
  std::vector<std::string> mixed = lines;
  mixed[2] = numbered(design::recovery_lines(divided_study_key(2)))[2];
  CHECK(refuses<UsageError>([&] { return reader_of(mixed).key_for(key.study); },
                            "of different sheets"));
}

TEST_CASE("a sheet says when the study has changed since it was printed") {
  const design::StudyKey key = divided_study_key();
  const design::RecoveryReader reader = reader_of(numbered(design::recovery_lines(key)));
  nlohmann::json changed = comparison_of(3, 2);
  changed["trials"] = {{"repeats", 4}};
  const design::StudyKey other = reader.key_for(parsed(changed));
  CHECK_FALSE(reader.is_sealed_as(other));
  CHECK(other.master == key.master);
  CHECK(other.box().public_half == key.box().public_half);
}

}  // namespace touchtrial
