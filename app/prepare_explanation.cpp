#include "app/prepare_explanation.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

using Json = nlohmann::ordered_json;

/// Stages by what became of them.
struct Totals {
  std::array<int, 3> stages{};           ///< by StageState
  std::array<std::uint64_t, 3> bytes{};  ///< the same
  double seconds = 0.0;
  std::uint64_t written = 0;  ///< to the pack's folder
};

bool is_file(const engine::Stage& stage) {
  return stage.name == "write field" || stage.name == "pack.json";
}

void add_stages(const std::vector<engine::Stage>& stages, Totals& totals) {
  for (const engine::Stage& stage : stages) {
    const auto state = static_cast<std::size_t>(stage.state);
    ++totals.stages[state];
    totals.bytes[state] += stage.bytes;
    totals.seconds += stage.seconds;
    if (is_file(stage) && stage.state == engine::StageState::computed)
      totals.written += stage.bytes;
  }
}

Totals totals_of(const design::PrepareReport& report) {
  Totals totals;
  for (const design::PreparedStimulus& stimulus : report.stimuli)
    add_stages(stimulus.stages, totals);
  add_stages(report.study_stages, totals);
  const auto skipped = static_cast<std::size_t>(engine::StageState::skipped);
  for (const design::SkippedWork& work : report.skipped) {
    ++totals.stages[skipped];
    totals.bytes[skipped] += work.bytes;
  }
  return totals;
}

std::string bytes_text(std::uint64_t bytes) {
  constexpr double kKilo = 1e3;
  const auto number = static_cast<double>(bytes);
  if (number < 10 * kKilo) return fmt::format("{} B", bytes);
  if (number < 10 * kKilo * kKilo) return fmt::format("{:.0f} kB", number / kKilo);
  return fmt::format("{:.0f} MB", number / kKilo / kKilo);
}

std::string row(std::string_view name, std::string_view state, const std::string& time,
                std::uint64_t bytes, const std::string& why) {
  return fmt::format("  {:<15} {:<9} {:>9} {:>9}  {}\n", name, state, time, bytes_text(bytes), why);
}

std::string rows_of(const std::vector<engine::Stage>& stages) {
  std::string text;
  for (const engine::Stage& stage : stages) {
    const std::string time = stage.state == engine::StageState::skipped
                                 ? ""
                                 : fmt::format("{:.1f} ms", 1e3 * stage.seconds);
    text += row(stage.name, name_of(stage.state), time, stage.bytes, stage.why);
  }
  return text;
}

std::string stimulus_text(const design::PreparedStimulus& stimulus) {
  return fmt::format("{}, exemplar {}, {}: {}\n", stimulus.class_label, stimulus.exemplar + 1,
                     stimulus.method, stimulus.reused ? "reused" : "built") +
         rows_of(stimulus.stages);
}

std::string totals_text(const Totals& totals) {
  const auto of = [](engine::StageState state) { return static_cast<std::size_t>(state); };
  return fmt::format(
      "computed {} stages in {:.0f} ms, {} written; reused {}, {}; skipped {}, {} not made\n",
      totals.stages[of(engine::StageState::computed)], 1e3 * totals.seconds,
      bytes_text(totals.written), totals.stages[of(engine::StageState::reused)],
      bytes_text(totals.bytes[of(engine::StageState::reused)]),
      totals.stages[of(engine::StageState::skipped)],
      bytes_text(totals.bytes[of(engine::StageState::skipped)]));
}

Json stages_json(const std::vector<engine::Stage>& stages) {
  Json list = Json::array();
  for (const engine::Stage& stage : stages) {
    list.push_back({{"stage", stage.name},
                    {"state", name_of(stage.state)},
                    {"why", stage.why},
                    {"seconds", stage.seconds},
                    {"bytes", stage.bytes}});
  }
  return list;
}

Json statistics_json(const engine::FieldStatistics& figures) {
  return {{"tangential_rms_n", figures.tangential_rms_n},
          {"tangential_p999_n", figures.tangential_p999_n},
          {"normal_rms_n", figures.normal_rms_n},
          {"stiffness_p99_n_per_mm", figures.stiffness_p99_n_per_mm},
          {"share_below_1_mm", figures.share_below_1_mm},
          {"share_above_250_hz", figures.share_above_250_hz}};
}

Json stimulus_json(const design::PreparedStimulus& stimulus) {
  Json object = {{"class", stimulus.class_label},
                 {"exemplar", stimulus.exemplar + 1},
                 {"method", stimulus.method},
                 {"state", stimulus.reused ? "reused" : "built"},
                 {"seconds", stimulus.seconds},
                 {"bytes", stimulus.bytes},
                 {"gains",
                  {{"tangential_n", stimulus.gains.tangential_n},
                   {"normal_n", stimulus.gains.normal_n},
                   {"height_mm", stimulus.gains.height_mm}}},
                 {"statistics", statistics_json(stimulus.statistics)}};
  if (!stimulus.stages.empty()) object["stages"] = stages_json(stimulus.stages);
  return object;
}

Json totals_json(const Totals& totals) {
  Json object = {{"seconds", totals.seconds}, {"bytes_written", totals.written}};
  for (const engine::StageState state :
       {engine::StageState::computed, engine::StageState::reused, engine::StageState::skipped}) {
    const auto i = static_cast<std::size_t>(state);
    object[std::string(name_of(state))] = {{"stages", totals.stages[i]},
                                           {"bytes", totals.bytes[i]}};
  }
  return object;
}

}  // namespace

std::string explanation_text(const design::PrepareReport& report) {
  std::string text;
  for (const design::PreparedStimulus& stimulus : report.stimuli) text += stimulus_text(stimulus);
  text += "all stimuli\n" + rows_of(report.study_stages);
  for (const design::SkippedWork& work : report.skipped) {
    text += row("fields", "skipped", "", work.bytes, work.what + ": " + work.why);
  }
  return text + totals_text(totals_of(report));
}

std::string prepare_json(const design::PrepareReport& report, const design::PackPlace& place) {
  Json stimuli = Json::array();
  for (const design::PreparedStimulus& stimulus : report.stimuli)
    stimuli.push_back(stimulus_json(stimulus));
  Json skipped = Json::array();
  for (const design::SkippedWork& work : report.skipped) {
    skipped.push_back({{"what", work.what}, {"why", work.why}, {"bytes", work.bytes}});
  }
  Json object = {{"pack", place.pack.string()},
                 {"key", place.key.string()},
                 {"stimuli", stimuli},
                 {"skipped", skipped},
                 {"warnings", report.warnings}};
  if (!report.study_stages.empty()) {
    object["stages"] = stages_json(report.study_stages);
    object["totals"] = totals_json(totals_of(report));
  }
  return object.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace touchtrial::app
