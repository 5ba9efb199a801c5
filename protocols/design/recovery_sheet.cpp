#include "protocols/design/recovery_sheet.hpp"

#include "core/errors.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace touchtrial::design {
namespace {

constexpr int kSecretLines = 4;
constexpr int kIdentityLine = 5;  ///< the number of lines, and digits of the study's identity
constexpr int kSealLine = 6;
constexpr std::size_t kLineDigits = 16;
constexpr std::size_t kGroupDigits = 4;

/// Supplies a stored secret, so that the same code makes and rebuilds a key.
class StoredEntropy final : public Entropy {
 public:
  explicit StoredEntropy(const SecretKey& master) : master_(master) {}
  [[nodiscard]] SecretKey secret(std::string_view) override { return master_; }

 private:
  SecretKey master_;
};

std::string check_digits(int number, std::string_view content) {
  return to_hex(FieldHasher()
                    .add("touchtrial recovery sheet 1")
                    .add(std::int64_t{number})
                    .add(content)
                    .finish())
      .substr(0, kGroupDigits);
}

std::vector<std::string> words_in(std::string_view text) {
  std::vector<std::string> words;
  bool begins = true;
  for (const char letter : text) {
    const bool is_space = letter == ' ' || letter == '\t' || letter == '\r' || letter == '\n';
    if (!is_space && begins) words.emplace_back();
    if (!is_space) words.back() += letter;
    begins = is_space;
  }
  return words;
}

/// Digits as they were meant: capitals, and the letters that look like 0 and 1.
std::string as_digits(std::string word) {
  for (char& letter : word) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    if (letter == 'o') letter = '0';
    if (letter == 'l' || letter == 'i') letter = '1';
  }
  return word;
}

[[noreturn]] void refuse_line(int number) {
  const std::string line = "line " + std::to_string(number);
  throw UsageError(line + " is not what the sheet says: its check digits do not fit; type " + line +
                   " again");
}

/// A line of digits, of which the check digits are the last group, however they are spaced.
std::pair<std::string, std::string> digits_and_check(const std::vector<std::string>& words) {
  std::string digits;
  for (const std::string& word : words) digits += as_digits(word);
  const std::size_t end = digits.size() - std::min(digits.size(), kGroupDigits);
  return {in_fours(digits.substr(0, end)), digits.substr(end)};
}

std::pair<std::string, std::string> words_and_check(const std::vector<std::string>& words) {
  std::string content;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) content += (i > 0 ? " " : "") + words[i];
  return {content, words.empty() ? "" : as_digits(words.back())};
}

std::string without_spaces(std::string text) {
  std::erase(text, ' ');
  return text;
}

/// "NAME FIRST-LAST"
struct StationLine {
  std::string name;
  EnrolmentRange range;
};

std::optional<StationLine> station_line_in(const std::string& content) {
  const std::vector<std::string> words = words_in(content);
  if (words.size() != 2) return std::nullopt;
  const std::string_view range = words[1];
  const std::size_t dash = std::min(range.find('-'), range.size());
  const auto first = number_in<int>(range.substr(0, dash));
  const auto last =
      dash < range.size() ? number_in<int>(range.substr(dash + 1)) : std::optional<int>();
  if (!first || !last || *first < 1 || *last < *first || *last > kMostEnrolments)
    return std::nullopt;
  return StationLine{words[0], {*first, *last}};
}

}  // namespace

StudyKey key_from_master(const SecretKey& master, const Study& study, std::vector<Station> stations,
                         bool simulated) {
  StoredEntropy stored(master);
  StudyKey key = make_study_key(study, stored, simulated);
  divide(key, std::move(stations));
  return key;
}

std::vector<std::string> recovery_lines(const StudyKey& key) {
  const std::string master = to_hex(key.master);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < master.size(); i += kLineDigits) {
    lines.push_back(in_fours(std::string_view(master).substr(i, kLineDigits)));
  }
  lines.emplace_back();
  lines.push_back(in_fours(to_hex(key.seal).substr(0, kLineDigits)));
  for (const Station& station : key.stations) {
    for (const EnrolmentRange& range : station.ranges) {
      lines.push_back(station.name + " " + std::to_string(range.first) + "-" +
                      std::to_string(range.last));
    }
  }
  const std::string count = std::to_string(lines.size());
  if (count.size() > kGroupDigits) {
    throw UsageError("study " + key.study.name + ": has " + count +
                     " ranges of enrolment numbers, too many for a sheet; copy the key instead");
  }
  lines[kIdentityLine - 1] = std::string(kGroupDigits - std::min(kGroupDigits, count.size()), '0') +
                             count + " " + in_fours(key.study_id.substr(0, kLineDigits));
  int number = 0;
  for (std::string& line : lines) {
    ++number;
    line += " " + check_digits(number, line);
  }
  return lines;
}

bool RecoveryReader::take(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return false;
  const std::vector<std::string> label = words_in(text.substr(0, colon));
  const auto number = label.size() == 1 ? number_in<int>(label[0]) : std::optional<int>();
  if (!number || *number < 1) return false;
  const std::vector<std::string> words = words_in(text.substr(colon + 1));
  const auto [content, check] =
      *number <= kSealLine ? digits_and_check(words) : words_and_check(words);
  if (check != check_digits(*number, content)) refuse_line(*number);
  const std::size_t counted_digits = *number == kIdentityLine ? kGroupDigits : 0;
  const std::size_t expected = kLineDigits + counted_digits;
  if (*number <= kSealLine && without_spaces(content).size() != expected) refuse_line(*number);
  if (*number > kSealLine && !station_line_in(content)) refuse_line(*number);
  lines_[*number] = content;
  return true;
}

int RecoveryReader::count() const {
  return number_in<int>(lines_.at(kIdentityLine).substr(0, kGroupDigits)).value_or(0);
}

int RecoveryReader::missing() const {
  for (int number = 1; number <= kSealLine; ++number) {
    if (!lines_.contains(number)) return number;
  }
  for (int number = kSealLine + 1; number <= count(); ++number) {
    if (!lines_.contains(number)) return number;
  }
  return 0;
}

std::vector<Station> RecoveryReader::stations() const {
  std::vector<StationLine> lines;
  std::vector<std::string> names;
  for (int number = kSealLine + 1; number <= count(); ++number) {
    lines.push_back(station_line_in(lines_.at(number)).value());
    const std::string& name = lines.back().name;
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  std::vector<Station> stations = stations_named(names);
  for (const StationLine& line : lines) {
    std::ranges::find(stations, line.name, &Station::name)->ranges.push_back(line.range);
  }
  return stations;
}

StudyKey RecoveryReader::key_for(const Study& study) const {
  if (const int line = missing(); line > 0) {
    throw UsageError("line " + std::to_string(line) +
                     " of the sheet is missing; type every line of the sheet");
  }
  std::string digits;
  for (int number = 1; number <= kSecretLines; ++number) {
    digits += without_spaces(lines_.at(number));
  }
  const auto master = digest_from_hex(digits);
  if (!master) throw UsageError("lines 1 to 4 of the sheet are not 64 digits; type them again");
  StudyKey key = key_from_master(*master, study, stations(), false);
  const std::string identity = without_spaces(lines_.at(kIdentityLine)).substr(kGroupDigits);
  if (!key.study_id.starts_with(identity)) {
    throw UsageError(
        "the lines are of different sheets: line 5 is not of the study whose secret lines 1 to 4 "
        "are; take every line from one sheet");
  }
  return key;
}

bool RecoveryReader::is_sealed_as(const StudyKey& key) const {
  const auto line = lines_.find(kSealLine);
  return line != lines_.end() && to_hex(key.seal).starts_with(without_spaces(line->second));
}

}  // namespace touchtrial::design
