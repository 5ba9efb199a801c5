// The file of a bring-up: JSON, read strictly, as strangers send it.
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "device/bring_up/bring_up.hpp"
#include "device/registry.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <type_traits>

#include <nlohmann/json.hpp>

namespace touchtrial::device {
namespace {

constexpr std::string_view kKind = "touchtrial device bring-up 1";
constexpr std::uintmax_t kMostBytes = 1U << 20U;
constexpr std::size_t kLongestLine = 200;
constexpr std::size_t kMostPushes = 12;  ///< two forces, two signs, three axes
constexpr int kMostUm = 10'000'000;
constexpr NumberRange kSize{.low = 0.0, .high = 1e9};
constexpr NumberRange kSigned{.low = -1e6, .high = 1e6};
constexpr NumberRange kPushes{.low = -kSecondPushN, .high = kSecondPushN};

constexpr std::array<std::string_view, 5> kOutcomes = {"not_reached", "interrupted", "left_out",
                                                       "failed", "done"};
constexpr std::array<std::string_view, 4> kEnds = {"stopped", "complete", "wrong_sign", "fault"};
constexpr std::array<std::string_view, 7> kFelt = {"right",   "left", "up",     "down",
                                                   "towards", "away", "nothing"};
constexpr std::array<std::string_view, 4> kSilentForces = {"gone_at_once", "gone_within_a_second",
                                                           "stayed_longer", "stronger"};
constexpr std::array<std::string_view, 3> kAxes = {"y", "x", "z"};
constexpr std::array<std::string_view, 2> kShapes = {"box", "ellipsoid"};

/// The answers to the questions of a driver's facts.
struct Answers {
  std::string driver;
  std::map<std::string, std::string> by_fact;
};
struct DriverName {};  ///< says that a text is one
using Outcomes = std::array<StepOutcome, kBringUpSteps>;

/// \name The content of each part, for the three that follow: names of keys, writing, reading
///@{
template <typename File>
void content(File& file, Measured& measured) {
  file("value", measured.value, kSize);
  file("error", measured.error, kSize);
}
template <typename File>
void content(File& file, RestFigures& rest) {
  file("noise_mm", rest.noise_mm, kSize);
  file("drift_mm", rest.drift_mm, kSize);
}
template <typename File>
void content(File& file, LoopFigures& loop) {
  file("rate_hz", loop.rate_hz, kSize);
  file("readings_hz", loop.readings_hz, kSize);
  file("longest_gap_ms", loop.longest_gap_ms, kSize);
  file("late_p50_us", loop.p50_us, kSize);
  file("late_p99_us", loop.p99_us, kSize);
  file("late_worst_us", loop.worst_us, kSize);
  file("overruns", loop.overruns, kSize);
}
template <typename File>
void content(File& file, Workspace& reach) {
  file("shape", reach.shape, kShapes);
  file("least_mm", reach.least_mm);
  file("greatest_mm", reach.greatest_mm);
}
template <typename File>
void content(File& file, DeviceInfo& stated) {
  file("max_force_n", stated.max_force_n, kSize);
  file("continuous_force_n", stated.continuous_force_n, kSize);
  file("max_stiffness_n_per_mm", stated.max_stiffness_n_per_mm, kSize);
  file("max_damping_n_s_per_mm", stated.max_damping_n_s_per_mm, kSize);
  file("max_rate_hz", stated.max_rate_hz, kSize);
  file("workspace", stated.workspace);
}
template <typename File>
void content(File& file, CarriedWay& way) {
  file("axis", way.axis, kAxes);
  file("moved_mm", way.moved_mm);
  file("ruler_mm", way.ruler_mm, kSize);
}
template <typename File>
void content(File& file, FeltPush& push) {
  file("axis", push.axis, kAxes);
  file("force_n", push.force_n, kPushes);
  file("felt", push.felt, kFelt);
  file("moved_mm", push.moved_mm);
}
template <typename File>
void content(File& file, WeighResult& weight) {
  constexpr NumberRange kAboveZero{.low = 0.0, .high = 100.0, .open_low = true};
  file("expected_n", weight.expected_n, kAboveZero);
  file("measured_n", weight.measured_n, kAboveZero);
  file("error_n", weight.error_n, kSize);
}
template <typename File>
void content(File& file, HungWeight& weight) {
  file("load_n", weight.load_n, kSigned);
  file("friction_n", weight.friction_n);
  file("weight", weight.weight);
}
template <typename File>
void content(File& file, PressedWall& wall) {
  file("stiffness_n_per_mm", wall.stiffness_n_per_mm, kSize);
  file("swung", wall.swung);
  file("contact_s", wall.contact_s, kSize);
  file("delivered_share", wall.delivered_share, kSize);
  file("ms", wall.ms);
  file("height_um", wall.height_um);
  file("force_mn", wall.force_mn);
}
template <typename File>
void content(File& file, SilenceSeen& seen) {
  file("force", seen.force, kSilentForces);
  file("ended", seen.ended);
  file("fault", seen.fault);
  file("device_fault", seen.device_fault);
}
template <typename File>
void content(File& file, Outcomes& outcomes) {
  for (std::size_t i = 0; i < kBringUpSteps; ++i) {
    file(name_of(static_cast<BringUpStep>(i)), outcomes.at(i), kOutcomes);
  }
}
template <typename File>
void content(File& file, Answers& answers) {
  for (const UnverifiedFact& fact : device_driver(answers.driver).unverified) {
    if (fact.evidence == Evidence::answer) file(fact.id, answers.by_fact, fact);
  }
}
template <typename File>
void content(File& file, BringUp& record) {
  std::string kind(kKind);
  file("kind", kind, kKind);
  file("program", record.program);
  file("driver", record.driver, DriverName{});
  file("device_mark", record.device_mark);
  file("model", record.model);
  file("firmware", record.firmware);
  file("library", record.library);
  file("stated", record.stated);
  file("scheduling", record.scheduling);
  file("memory_locked", record.memory_locked);
  file("steps", record.outcomes);
  file("ended", record.ended, kEnds);
  file("why", record.why);
  file("rest", record.rest);
  file("loop", record.loop);
  file("ways", record.ways, kDeviceAxes.size());
  file("pushes", record.pushes, kMostPushes);
  file("step_mm", record.step_mm);
  file("reached", record.reached);
  file("weight", record.weight);
  file("wall", record.wall);
  file("program_silent", record.program_silent);
  file("cable_silent", record.cable_silent);
  Answers answers{record.driver, std::move(record.answers)};
  file("answers", answers);
  record.answers = std::move(answers.by_fact);
}
///@}

/// \name What does not follow from the form of a part
///@{
template <typename Part>
void check(const JsonValue& /*place*/, const Part& /*part*/) {}

void check(const JsonValue& place, const Workspace& reach) {
  if (reach.least_mm.x > reach.greatest_mm.x || reach.least_mm.y > reach.greatest_mm.y ||
      reach.least_mm.z > reach.greatest_mm.z) {
    place.refuse_below("/least_mm", "must not exceed greatest_mm");
  }
}

void check(const JsonValue& place, const PressedWall& wall) {
  if (std::ranges::adjacent_find(wall.ms, std::greater_equal<>()) != wall.ms.end()) {
    place.refuse_below("/ms", "must rise");
  }
  if (wall.height_um.size() != wall.ms.size() || wall.force_mn.size() != wall.ms.size()) {
    place.refuse_below("/ms", "must have as many numbers as height_um and force_mn");
  }
}

/// What a step has found needs the step, and a greater force needs the signs.
void check(const JsonValue& place, const BringUp& record) {
  const auto require = [&](bool found, BringUpStep step) {
    if (found && record.outcome(step) == StepOutcome::not_reached) {
      place.refuse_below("/steps/" + std::string(name_of(step)),
                         "is not reached, but has a result; the file was changed by hand");
    }
  };
  require(record.rest || record.loop, BringUpStep::rest);
  require(!record.ways.empty(), BringUpStep::ways);
  require(!record.pushes.empty(), BringUpStep::push);
  require(record.step_mm.has_value(), BringUpStep::steps);
  require(record.reached.has_value(), BringUpStep::range);
  require(record.weight.has_value(), BringUpStep::weight);
  require(record.wall.has_value(), BringUpStep::wall);
  require(record.program_silent.has_value(), BringUpStep::program);
  require(record.cable_silent.has_value(), BringUpStep::cable);
  require(!record.answers.empty(), BringUpStep::questions);
  if ((record.weight || record.wall) && !record.signs_confirmed()) {
    place.refuse_below(record.wall ? "/wall" : "/weight",
                       "is there, but not all signs are confirmed; the file was changed by hand");
  }
  if (record.device_mark.size() > 4 ||
      record.device_mark.find_first_not_of("0123456789abcdef") != std::string::npos) {
    place.refuse_below("/device_mark", "must be four hexadecimal digits, or empty");
  }
}
///@}

/// The keys that a part may have.
struct KeyNames {
  std::vector<std::string_view> names;
  template <typename... Value>
  void operator()(std::string_view key, const Value&... /*value*/) {
    names.push_back(key);
  }
};

struct Writing {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();

  template <typename Part>
  static nlohmann::ordered_json written(Part& part) {
    Writing file;
    content(file, part);
    return file.object;
  }

  template <typename Number>
  void operator()(std::string_view key, Number value, NumberRange /*range*/) {
    object[std::string(key)] = value;
  }
  void operator()(std::string_view key, std::optional<double> value, NumberRange /*range*/) {
    if (value) object[std::string(key)] = *value;
  }
  template <typename Value, std::size_t size>
  void operator()(std::string_view key, Value value,
                  const std::array<std::string_view, size>& words) {
    object[std::string(key)] = words.at(static_cast<std::size_t>(value));
  }
  void operator()(std::string_view key, std::string& text, std::string_view /*only*/ = {}) {
    object[std::string(key)] = text;
  }
  void operator()(std::string_view key, const std::string& name, DriverName /*is*/) {
    object[std::string(key)] = name;
  }
  void operator()(std::string_view key, bool& value) { object[std::string(key)] = value; }
  void operator()(std::string_view key, Vec3& v) { object[std::string(key)] = {v.x, v.y, v.z}; }
  /// On one line, where a list would take one for each number.
  void operator()(std::string_view key, std::vector<int>& values) {
    std::string text;
    for (const int value : values) text += (text.empty() ? "" : " ") + std::to_string(value);
    object[std::string(key)] = text;
  }
  template <typename Part>
  void operator()(std::string_view key, Part& part) {
    object[std::string(key)] = written(part);
  }
  template <typename Part>
  void operator()(std::string_view key, std::optional<Part>& part) {
    if (part) object[std::string(key)] = written(*part);
  }
  template <typename Part>
  void operator()(std::string_view key, std::vector<Part>& parts, std::size_t /*most*/) {
    nlohmann::ordered_json& all = object[std::string(key)] = nlohmann::ordered_json::array();
    for (Part& part : parts) all.push_back(written(part));
  }
  void operator()(const std::string& key, const std::map<std::string, std::string>& all,
                  const UnverifiedFact& /*fact*/) {
    if (const auto found = all.find(key); found != all.end()) object[key] = found->second;
  }
};

class Reading {
 public:
  template <typename Part>
  static void read(const JsonValue& place, Part& part) {
    KeyNames keys;
    content(keys, part);
    Reading file(place.object(std::span<const std::string_view>(keys.names)));
    content(file, part);
    check(place, part);
  }

  template <typename Number>
  void operator()(std::string_view key, Number& value, const NumberRange& range) {
    value = static_cast<Number>(object_.at(key).number(range));
  }
  void operator()(std::string_view key, std::optional<double>& value, const NumberRange& range) {
    if (const auto place = object_.find(key)) value = place->number(range);
  }
  template <typename Value, std::size_t size>
  void operator()(std::string_view key, Value& value,
                  const std::array<std::string_view, size>& words) {
    value = static_cast<Value>(object_.at(key).choice(std::span<const std::string_view>(words)));
  }
  void operator()(std::string_view key, std::string& text, std::string_view only = {}) {
    const JsonValue place = object_.at(key);
    text = place.text();
    if (!only.empty() && text != only) {
      place.refuse("must be " + in_quotes(only) +
                   "; make such a file with touchtrial device bring-up");
    }
    if (text.size() > kLongestLine || one_line(text) != text) {
      place.refuse("must be one line of at most 200 bytes");
    }
  }
  void operator()(std::string_view key, std::string& name, DriverName /*is*/) {
    std::vector<std::string_view> names;
    for (const DeviceDriver& driver : device_drivers()) names.emplace_back(driver.name);
    name = names.at(object_.at(key).choice(std::span<const std::string_view>(names)));
  }
  void operator()(std::string_view key, bool& value) { value = object_.at(key).truth(); }
  void operator()(std::string_view key, Vec3& v) {
    const std::vector<JsonValue> axes = object_.at(key).items(3, 3);
    v = {axes[0].number(kSigned), axes[1].number(kSigned), axes[2].number(kSigned)};
  }
  void operator()(std::string_view key, std::vector<int>& values) {
    const JsonValue place = object_.at(key);
    std::string_view text = place.text();
    while (!text.empty()) {
      const std::size_t end = std::min(text.find(' '), text.size());
      const auto value = number_in<int>(text.substr(0, end));
      const bool is_value = value && *value >= -kMostUm && *value <= kMostUm;
      if (!is_value || values.size() == PressedWall::kMostTicks || end + 1 == text.size()) {
        place.refuse("must be at most 2000 whole numbers with one space between them");
      }
      values.push_back(*value);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }
  template <typename Part>
  void operator()(std::string_view key, Part& part) {
    read(object_.at(key), part);
  }
  template <typename Part>
  void operator()(std::string_view key, std::optional<Part>& part) {
    if (const auto place = object_.find(key)) read(*place, part.emplace());
  }
  template <typename Part>
  void operator()(std::string_view key, std::vector<Part>& parts, std::size_t most) {
    for (const JsonValue& place : object_.at(key).items(0, most)) read(place, parts.emplace_back());
  }
  void operator()(const std::string& key, std::map<std::string, std::string>& all,
                  const UnverifiedFact& fact) {
    const auto place = object_.find(key);
    if (!place) return;
    const std::vector<std::string_view> words(fact.answers.begin(), fact.answers.end());
    all[key] = fact.answers.at(place->choice(std::span(words)));
  }

 private:
  explicit Reading(JsonObject object) : object_(std::move(object)) {}
  JsonObject object_;
};

}  // namespace

std::string_view name_of(StepOutcome outcome) noexcept {
  return kOutcomes.at(static_cast<std::size_t>(outcome));
}
std::string_view name_of(FeltSide side) noexcept {
  return kFelt.at(static_cast<std::size_t>(side));
}
std::string_view name_of(SilentForce force) noexcept {
  return kSilentForces.at(static_cast<std::size_t>(force));
}
std::string_view name_of(BringUpEnd end) noexcept {
  return kEnds.at(static_cast<std::size_t>(end));
}

std::string bring_up_json(BringUp record) {
  return json_text(Writing::written(record));
}

BringUp parse_bring_up(std::string_view text, const std::string& source) {
  BringUp record;
  Reading::read(parse_strict_json(text, source), record);
  return record;
}

BringUp read_bring_up(const std::filesystem::path& file) {
  return parse_bring_up(text_of(read_file(file, kMostBytes)), file.string());
}

}  // namespace touchtrial::device
