// The file of a bring-up: JSON, read strictly, as strangers send it.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "device/bring_up/findings.hpp"
#include "device/registry.hpp"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

namespace touchtrial::device {
namespace {

constexpr std::string_view kKind = "touchtrial device bring-up 1";
constexpr std::uintmax_t kMostBytes = 1U << 20U;
constexpr std::size_t kLongestLine = 200;
constexpr std::size_t kMostFindings = 200;
constexpr NumberRange kNumbers{.low = -1e9, .high = 1e9};

struct TextField {
  std::string_view key;
  std::string BringUp::*text;
};
constexpr std::array kTexts = {TextField{"program", &BringUp::program},
                               TextField{"driver", &BringUp::driver},
                               TextField{"device_mark", &BringUp::device_mark},
                               TextField{"model", &BringUp::model},
                               TextField{"firmware", &BringUp::firmware},
                               TextField{"library", &BringUp::library},
                               TextField{"stand_in", &BringUp::stand_in},
                               TextField{"scheduling", &BringUp::scheduling},
                               TextField{"why", &BringUp::why}};

/// \return the names of the first `count` values of an enumeration
template <typename Value>
std::vector<std::string_view> names_of(std::size_t count) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(name_of(static_cast<Value>(i)));
  return names;
}
const std::vector<std::string_view> kSteps = names_of<BringUpStep>(kBringUpSteps);
const std::vector<std::string_view> kOutcomes = names_of<StepOutcome>(5);
const std::vector<std::string_view> kEnds = names_of<BringUpEnd>(4);

/// Several numbers are a text on one line, where a list would take a line for each.
nlohmann::ordered_json value_of(const Finding& finding) {
  if (!finding.word.empty()) return finding.word;
  if (finding.numbers.size() == 1) return finding.numbers.front();
  std::string text;
  for (const double number : finding.numbers) {
    text += (text.empty() ? "" : " ") + number_text(number);
  }
  return text;
}

std::string read_line(const JsonValue& place) {
  std::string text = place.text();
  if (text.size() > kLongestLine || one_line(text) != text) {
    place.refuse("must be one line of at most 200 bytes");
  }
  return text;
}

std::vector<double> read_numbers(const JsonValue& place) {
  if (!place.is_text()) return {place.number(kNumbers)};
  std::vector<double> numbers;
  std::string_view text = place.text();
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const auto number = number_in<double>(text.substr(0, end));
    if (!number || !kNumbers.contains(*number) || end + 1 == text.size()) {
      place.refuse("must be numbers from -1e9 to 1e9 with one space between them");
    }
    numbers.push_back(*number);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return numbers;
}

/// What a step has found needs the step, and a greater force needs the signs.
void read_finding(const JsonValue& place, const std::vector<UnverifiedFact>& facts,
                  BringUp& record) {
  const JsonObject object = place.object({"step", "name", "unit", "value"});
  const std::string& name = object.at("name").text();
  const JsonValue value = object.at("value");
  const FindingKind* const kind = kind_of(name);
  const auto fact = std::ranges::find(facts, name, &UnverifiedFact::id);
  if (record.find(name) != nullptr) object.at("name").refuse("occurs twice");
  if (kind == nullptr && (fact == facts.end() || fact->answers.empty())) {
    object.at("name").refuse("is nothing that a step can find");
  }
  if (kind == nullptr) {
    const std::vector<std::string_view> answers(fact->answers.begin(), fact->answers.end());
    record.note(name, answers.at(value.choice(answers)));
  } else if (!kind->words.empty()) {
    record.note(name, kind->words[value.choice(kind->words)]);
  } else {
    record.note(name, read_numbers(value));
  }
  const Finding& finding = record.findings.back();
  if (object.at("step").text() != name_of(finding.step)) {
    object.at("step").refuse("is not the step that finds this");
  }
  if (object.at("unit").text() != finding.unit) object.at("unit").refuse("is another unit");
  if (record.outcome(finding.step) == StepOutcome::not_reached) {
    object.at("step").refuse("was not reached; the file was changed by hand");
  }
  const bool is_strong = finding.step == BringUpStep::weight || finding.step == BringUpStep::wall;
  if (is_strong && !record.signs_confirmed()) {
    object.at("step").refuse(
        "was reached, but not all signs are confirmed; the file was changed by hand");
  }
}

}  // namespace

std::string bring_up_json(const BringUp& record) {
  using nlohmann::ordered_json;
  ordered_json file = {{"kind", kKind}};
  for (const auto& [key, text] : kTexts) file[std::string(key)] = record.*text;
  file["memory_locked"] = record.memory_locked;
  file["ended"] = name_of(record.ended);
  for (std::size_t i = 0; i < kBringUpSteps; ++i) {
    file["steps"][std::string(kSteps[i])] = name_of(record.outcomes.at(i));
  }
  ordered_json& findings = file["findings"] = ordered_json::array();
  for (const Finding& finding : record.findings) {
    findings.push_back({{"step", name_of(finding.step)},
                        {"name", finding.name},
                        {"unit", finding.unit},
                        {"value", value_of(finding)}});
  }
  return json_text(file);
}

BringUp parse_bring_up(std::string_view text, const std::string& source) {
  std::vector<std::string_view> keys = {"kind", "memory_locked", "ended", "steps", "findings"};
  for (const TextField& field : kTexts) keys.push_back(field.key);
  const JsonObject file = parse_strict_json(text, source).object(keys);
  if (file.at("kind").text() != kKind) {
    file.at("kind").refuse("must be " + in_quotes(kKind) +
                           "; make such a file with touchtrial device bring-up");
  }
  BringUp record;
  for (const auto& [key, field] : kTexts) record.*field = read_line(file.at(key));
  if (record.device_mark.size() > 4 ||
      record.device_mark.find_first_not_of("0123456789abcdef") != std::string::npos) {
    file.at("device_mark").refuse("must be four hexadecimal digits, or empty");
  }
  record.memory_locked = file.at("memory_locked").truth();
  record.ended = static_cast<BringUpEnd>(file.at("ended").choice(kEnds));
  const JsonObject steps = file.at("steps").object(kSteps);
  for (std::size_t i = 0; i < kBringUpSteps; ++i) {
    record.outcomes.at(i) = static_cast<StepOutcome>(steps.at(kSteps[i]).choice(kOutcomes));
  }
  std::vector<std::string_view> drivers;
  for (const DeviceDriver& driver : device_drivers()) drivers.emplace_back(driver.name);
  const DeviceDriver& driver = device_drivers().at(file.at("driver").choice(drivers));
  for (const JsonValue& place : file.at("findings").items(0, kMostFindings)) {
    read_finding(place, driver.unverified, record);
  }
  return record;
}

BringUp read_bring_up(const std::filesystem::path& file) {
  return parse_bring_up(text_of(read_file(file, kMostBytes)), file.string());
}

}  // namespace touchtrial::device
