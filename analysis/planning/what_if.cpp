#include "analysis/planning/what_if.hpp"

#include "analysis/planning/power_report.hpp"
#include "analysis/statistics/chance_test.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "analysis/text_figures.hpp"
#include "analysis/text_table.hpp"
#include "core/parallel.hpp"
#include "core/strict_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::planning {
namespace {

using Json = nlohmann::ordered_json;

/// Keys of a subject file that change how people answer, but not what they feel and learn.
constexpr std::array<std::string_view, 12> kAnswerKeys{"threshold_spread_db",
                                                       "feature_noise",
                                                       "common_noise",
                                                       "feature_noise_spread",
                                                       "lapse",
                                                       "lapse_spread",
                                                       "bias",
                                                       "label_swap",
                                                       "learning",
                                                       "period_noise_spread",
                                                       "serial",
                                                       "fatigue"};
/// The first has rows of its own, the second no effect on answers.
constexpr std::array<std::string_view, 2> kNotByKey{"sense", "thought"};
/// Keys that only go together.
constexpr std::array<std::string_view, 2> kSpeeds{"slowest_mm_s", "fastest_mm_s"};

Json json_of(const simulation::SubjectModel& subject) {
  return Json::parse(simulation::subject_model_json(subject));
}

/// \param source  where the change comes from
simulation::SubjectModel subject_of(const Json& json, const simulation::SubjectModel& base,
                                    const std::string& source) {
  simulation::SubjectModel subject = simulation::parse_subject_model(json.dump(), source);
  subject.device = base.device;
  return subject;
}

/// What differs between two values of a key, on one line: of objects the members that differ.
/// \return the first's words, and the second's
std::pair<std::string, std::string> words_of_change(const Json& from, const Json& to) {
  const auto plain = [](const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
  };
  if (!from.is_object() || !to.is_object()) return {plain(from), plain(to)};
  std::pair<std::string, std::string> words;
  for (const auto& [member, value] : to.items()) {
    const Json before = from.value(member, Json());
    if (before == value) continue;
    const char* comma = words.first.empty() ? "" : ", ";
    words.first += fmt::format("{}{} {}", comma, member, plain(before));
    words.second += fmt::format("{}{} {}", comma, member, plain(value));
  }
  return words;
}

/// The device's name; the device that is none is the ideal one.
std::string device_name(const simulation::SubjectModel& subject) {
  return subject.device.name.empty() ? "ideal" : subject.device.name;
}

std::string words_of_speeds(const Json& subject) {
  return fmt::format("{} to {} mm/s", subject.at("slowest_mm_s").dump(),
                     subject.at("fastest_mm_s").dump());
}

void add_senses(const simulation::SubjectModel& base, std::vector<Assumption>& all) {
  using Sense = std::optional<engine::ThresholdCurve>;
  for (const Sense& sense : {Sense{}, Sense{engine::ThresholdCurve::israr_2006},
                             Sense{engine::ThresholdCurve::tan_1994}}) {
    if (sense == base.sense) continue;
    Assumption one{"sense", std::string(simulation::name_of_sense(base.sense)),
                   std::string(simulation::name_of_sense(sense)), base};
    one.subject.sense = sense;
    all.push_back(std::move(one));
  }
}

void add_hands(const simulation::SubjectModel& base, std::vector<Assumption>& all) {
  for (const device::HandKind hand :
       {device::HandKind::point_mass, device::HandKind::stylus_grip}) {
    if (hand == base.hand) continue;
    Assumption one{"hand", std::string(device::name_of(base.hand)),
                   std::string(device::name_of(hand)), base};
    one.subject.hand = hand;
    all.push_back(std::move(one));
  }
}

void add_devices(const simulation::SubjectModel& base, std::vector<Assumption>& all) {
  for (const device::DeviceModel& model : device::shipped_device_models()) {
    const bool is_same = base.device.name.empty() ? model.name == device_name(base)
                                                  : device::device_model_json(model) ==
                                                        device::device_model_json(base.device);
    if (is_same) continue;
    Assumption one{"device", device_name(base), model.name, base};
    one.subject.device = model;
    all.push_back(std::move(one));
  }
}

void add_keys(const simulation::SubjectModel& base, const simulation::SubjectModel& other,
              std::vector<Assumption>& all) {
  const Json from = json_of(base);
  const Json to = json_of(other);
  bool matters = from.at("sense") != to.at("sense");
  bool has_speeds = false;
  for (const auto& [key, value] : to.items()) {
    const bool is_left_out = std::ranges::find(kNotByKey, key) != kNotByKey.end();
    const bool is_speed = std::ranges::find(kSpeeds, key) != kSpeeds.end();
    if (is_left_out || from.at(key) == value) continue;
    matters = true;
    Json changed = from;
    changed[key] = value;
    // The other model of a hand has a row already.
    if (key == "hand") changed[key]["model"] = from.at(key).at("model");
    if (changed == from || (is_speed && has_speeds)) continue;
    auto [words_from, words_to] = words_of_change(from.at(key), changed.at(key));
    if (is_speed) {
      has_speeds = true;
      for (const std::string_view speed : kSpeeds) {
        changed[std::string(speed)] = to.at(std::string(speed));
      }
      words_from = words_of_speeds(from);
      words_to = words_of_speeds(to);
    }
    all.push_back({is_speed ? "speeds" : key, std::move(words_from), std::move(words_to),
                   subject_of(changed, base, other.source)});
  }
  if (!matters) return;
  Assumption whole{"all of the other subject", "", other.source, other};
  whole.subject.device = base.device;
  all.push_back(std::move(whole));
}

std::vector<PowerRun> runs_of(const Rehearsal& study, const PrimaryTest& test,
                              const PowerPlan& plan, int jobs) {
  const int participants = plan.participants.front();
  std::vector<PowerRun> runs(static_cast<std::size_t>(plan.runs));
  in_parallel(jobs, runs.size(), [&](std::size_t run) {
    const std::uint64_t seed =
        study_seed(plan.seed, participants, Hypothesis::population, static_cast<int>(run));
    runs[run] = judged(test, study.outcomes(participants, Hypothesis::population, seed), false);
  });
  return runs;
}

WhatIfRow row_from(const Assumption& assumption, const std::vector<PowerRun>& base,
                   const std::vector<PowerRun>& runs, double level) {
  WhatIfRow row{assumption.name, assumption.from, assumption.to, {}, 0.0, 0.0, {}};
  const auto count = static_cast<int>(runs.size());
  int base_only = 0;
  int own_only = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const bool own = is_significant(runs[i], level);
    const bool before = is_significant(base[i], level);
    row.significant.correct += own ? 1 : 0;
    own_only += own && !before ? 1 : 0;
    base_only += before && !own ? 1 : 0;
    row.estimate += runs[i].estimate / count;
  }
  row.significant.n = count;
  row.difference = static_cast<double>(own_only - base_only) / count;
  row.interval = analysis::paired_share_interval(count, own_only, base_only);
  return row;
}

constexpr const char* kStamp = "SIMULATED: power given the assumed sensitivity, and others";

std::string points(double share) {
  return fmt::format("{:+.1f}", 100.0 * share);
}

std::vector<std::string> cells_of_row(const WhatIfRow& row, bool is_base) {
  return {row.name,
          row.to,
          power_per_cent(row.estimate),
          power_per_cent(row.significant.share().value_or(0.0)),
          is_base ? "" : points(row.difference),
          is_base ? "" : "[" + points(row.interval.low) + ", " + points(row.interval.high) + "]"};
}

Json row_json(const WhatIfRow& row) {
  return {{"assumption", row.name},
          {"from", row.from},
          {"to", row.to},
          {"estimate", row.estimate},
          {"runs", row.significant.n},
          {"significant", row.significant.correct},
          {"power", row.significant.share().value_or(0.0)},
          {"difference", row.difference},
          {"interval", {row.interval.low, row.interval.high}}};
}

}  // namespace

std::vector<Assumption> assumptions_about(const simulation::SubjectModel& base,
                                          const simulation::SubjectModel& other) {
  std::vector<Assumption> all;
  add_senses(base, all);
  add_hands(base, all);
  add_devices(base, all);
  add_keys(base, other, all);
  return all;
}

bool feel_alike(const simulation::SubjectModel& one, const simulation::SubjectModel& other) {
  Json a = json_of(one);
  Json b = json_of(other);
  for (const std::string_view key : kAnswerKeys) {
    a.erase(std::string(key));
    b.erase(std::string(key));
  }
  return a == b && device::device_model_json(one.device) == device::device_model_json(other.device);
}

WhatIf what_if(const design::Study& study, const PrimaryTest& test,
               const simulation::SubjectModel& base, const std::vector<Assumption>& assumptions,
               const PowerPlan& plan, PowerSetting setting, const MakeFeelings& feelings, int jobs,
               const std::function<void(int done, int of)>& progress) {
  for (const Assumption& one : assumptions) require_answers(study, one.subject);
  const auto of = static_cast<int>(assumptions.size()) + 1;
  int done = 0;
  const auto tell = [&] {
    if (progress) progress(++done, of);
  };
  const int participants = plan.participants.front();
  const RehearsalOptions options{.first_half_loss = plan.first_half_loss};
  const auto rehearsed = [&](const simulation::SubjectModel& subject, const Feelings& felt) {
    const RehearsedStudy own(study, subject, test, felt, participants, options);
    return runs_of(own, test, plan, jobs);
  };
  const std::unique_ptr<const Feelings> shared = feelings(base);
  const std::vector<PowerRun> unchanged = rehearsed(base, *shared);
  tell();
  WhatIf result{std::move(setting), plan, {}, {}};
  result.base = row_from({"as assumed", "", "", base}, unchanged, unchanged, plan.level);
  for (const Assumption& assumption : assumptions) {
    const bool shares = feel_alike(base, assumption.subject);
    const std::unique_ptr<const Feelings> own = shares ? nullptr : feelings(assumption.subject);
    result.rows.push_back(row_from(
        assumption, unchanged, rehearsed(assumption.subject, shares ? *shared : *own), plan.level));
    tell();
  }
  std::ranges::stable_sort(result.rows, std::greater{},
                           [](const WhatIfRow& row) { return std::abs(row.difference); });
  return result;
}

std::string what_if_text(const WhatIf& result) {
  std::string text = analysis::simulated_on_line(result.setting.device) + kStamp + "\n";
  text += analysis::wrapped("study    ", result.setting.study + ", " + result.setting.protocol);
  text += analysis::wrapped("test     ", result.setting.test);
  text += analysis::wrapped("assumed  ", result.setting.subject);
  const int participants = result.plan.participants.front();
  text += analysis::heading(
      fmt::format("Power with {} participants, each assumption changed alone", participants), true);
  const bool compares = result.setting.estimate == kDifferenceWords;
  analysis::TextTable table(
      {"assumption", "instead", compares ? "effect %" : "accuracy %", "power %", "change", "95 %"});
  table.add(cells_of_row(result.base, true));
  for (const WhatIfRow& row : result.rows) table.add(cells_of_row(row, false));
  text += table.text() + "\n";
  text += analysis::wrapped(
      "", fmt::format("{} simulated studies, seed {}, the same ones under each assumption. "
                      "Intervals are Agresti and Min's of the paired difference; they leave out "
                      "the error of the {} explorations and {} trainings.",
                      result.plan.runs, result.plan.seed, result.plan.explorations,
                      result.plan.trainings));
  if (result.plan.first_half_loss > 0.0) {
    text += analysis::wrapped(
        "", fmt::format("In the first half of their trials, people miss {:.4g} % of their right "
                        "answers.",
                        100.0 * result.plan.first_half_loss));
  }
  if (result.plan.margin > 0.0) {
    text += analysis::wrapped(
        "",
        "Power is that for methods that feel alike: each presentation is felt as one of the "
        "two at random.");
  }
  return text + kStamp + "\n";
}

std::string what_if_json(const WhatIf& result) {
  Json object;
  object["simulated"] = true;
  object["stamp"] = "SIMULATED";
  object["simulated_on"] = result.setting.device;
  object["claim"] = kStamp;
  object["study"] = result.setting.study;
  object["protocol"] = result.setting.protocol;
  object["test"] = {{"words", result.setting.test},
                    {"level", result.plan.level},
                    {"estimate", result.setting.estimate}};
  object["assumed"] = result.setting.subject;
  object["participants"] = result.plan.participants.front();
  object["plan"] = {{"runs", result.plan.runs},
                    {"seed", result.plan.seed},
                    {"explorations", result.plan.explorations},
                    {"trainings", result.plan.trainings},
                    {"margin", result.plan.margin},
                    {"first_half_loss", result.plan.first_half_loss}};
  object["base"] = row_json(result.base);
  object["assumptions"] = Json::array();
  for (const WhatIfRow& row : result.rows) object["assumptions"].push_back(row_json(row));
  object["program"] = {{"version", result.setting.program},
                       {"seal", result.setting.seal},
                       {"fields", result.setting.fields}};
  return json_text(object);
}

}  // namespace touchtrial::planning
