#include "analysis/exports/trial_columns.hpp"

#include <array>
#include <optional>

namespace touchtrial::analysis {
namespace {

bool has_stimulus(const TrialView& trial) {
  return trial.outcome->kind != design::PresentationKind::catch_trial;
}

/// The time between two moments of a trial; missing unless both occurred.
DataCell time_between(const std::optional<std::chrono::nanoseconds>& from,
                      const std::optional<std::chrono::nanoseconds>& to) {
  if (!from || !to) return std::monostate{};
  return *to - *from;
}

DataCell response_of(const TrialView& trial) {
  if (!trial.outcome->response) return std::monostate{};
  return trial.study->choices[*trial.outcome->response];
}

/// Empty for a trial that did not end, so that the mean of the column is an accuracy.
DataCell correctness_of(const TrialView& trial) {
  if (!has_stimulus(trial)) return std::monostate{};
  const store::TrialState state = trial.row.state;
  if (state != store::TrialState::answered && state != store::TrialState::timed_out)
    return std::monostate{};
  return flag(trial.outcome->correct());
}

DataCell method_of(const TrialView& trial) {
  if (!has_stimulus(trial)) return std::monostate{};
  return trial.study->methods[trial.outcome->stimulus.method];
}

DataCell class_of(const TrialView& trial) {
  if (!has_stimulus(trial)) return std::monostate{};
  return trial.study->classes[trial.outcome->stimulus.class_index];
}

DataCell exemplar_of(const TrialView& trial) {
  if (!has_stimulus(trial)) return std::monostate{};
  return image_of(*trial.study, *trial.outcome);
}

DataCell kind_of(const TrialView& trial) {
  switch (trial.outcome->kind) {
    case design::PresentationKind::lead_in:
      return std::string("lead-in");
    case design::PresentationKind::catch_trial:
      return std::string("catch");
    case design::PresentationKind::scored:
      break;
  }
  return std::string("scored");
}

DataCell state_of(const TrialView& trial) {
  switch (trial.row.state) {
    case store::TrialState::answered:
      return std::string("answered");
    case store::TrialState::timed_out:
      return std::string("timed-out");
    case store::TrialState::interrupted:
      return std::string("interrupted");
    case store::TrialState::voided:
      return std::string("voided");
    case store::TrialState::presented:
      break;
  }
  return std::string("presented");
}

template <std::optional<int> store::TrialRow::*kNumber>
DataCell number_of(const TrialView& trial) {
  if (!(trial.row.*kNumber)) return std::monostate{};
  return std::int64_t{*(trial.row.*kNumber)};
}

template <double store::TrialMeasures::*kMeasure>
DataCell measured(const TrialView& trial) {
  if (trial.outcome == nullptr || !trial.outcome->measures) return std::monostate{};
  return (*trial.outcome->measures).*kMeasure;
}

DataCell limits_of(const TrialView& trial) {
  if (!trial.outcome->measures) return std::monostate{};
  return flag(trial.outcome->measures->within_limits);
}

DataCell limited_ticks_of(const TrialView& trial) {
  if (!trial.outcome->measures || !trial.outcome->measures->limited_ticks) return std::monostate{};
  return *trial.outcome->measures->limited_ticks;
}

/// The verdict of the validity rule, which judges the trace; missing without a trace. Before
/// unblinding, the verdict of the part of the rule that is in clear.
DataCell validity_of(const TrialView& trial) {
  if (trial.row.samples == 0) return std::monostate{};
  return flag(trial.outcome != nullptr ? trial.outcome->valid() : trial.row.valid);
}

constexpr std::array<TrialColumn, 32> kTrialColumns{{
    {"participant", false, [](const TrialView& t) -> DataCell { return t.participant; }},
    {"session", false, [](const TrialView& t) -> DataCell { return std::int64_t{t.row.session}; }},
    {"trial", false, [](const TrialView& t) -> DataCell { return std::int64_t{t.row.trial}; }},
    {"block", false, [](const TrialView& t) -> DataCell { return std::int64_t{t.row.block}; }},
    {"method", true, method_of},
    {"class", true, class_of},
    {"exemplar", true, exemplar_of},
    {"response", true, response_of},
    {"correct", true, correctness_of},
    {"confidence", false, number_of<&store::TrialRow::confidence>},
    {"reaction_time_s", false,
     [](const TrialView& t) { return time_between(t.row.presented_at, t.row.answered_at); }},
    {"from_contact_s", false,
     [](const TrialView& t) { return time_between(t.row.contact_at, t.row.answered_at); }},
    {"contact_s", false, measured<&store::TrialMeasures::contact_s>},
    {"path_mm", false, measured<&store::TrialMeasures::path_mm>},
    {"force_rms_n", false, measured<&store::TrialMeasures::force_rms_n>},
    {"saturated_share", false, measured<&store::TrialMeasures::saturated_share>},
    {"valid", false, validity_of},
    {"presented_at_s", false, [](const TrialView& t) -> DataCell { return t.row.presented_at; }},
    {"simulated", false, [](const TrialView& t) { return flag(t.simulated); }},
    {"counted", true, [](const TrialView& t) { return flag(t.outcome->counted); }},
    {"kind", true, kind_of},
    {"state", false, state_of},
    {"explorations", false,
     [](const TrialView& t) -> DataCell { return std::int64_t{t.row.explorations}; }},
    {"first_contact_s", false,
     [](const TrialView& t) { return time_between(t.row.presented_at, t.row.contact_at); }},
    {"position", true, number_of<&store::TrialRow::position>},
    {"first_position", true, number_of<&store::TrialRow::first_position>},
    {"valid_in_clear", false, [](const TrialView& t) { return flag(t.row.valid); }},
    {"within_limits", true, limits_of},
    {"limited_ticks", true, limited_ticks_of},
    {"samples", false, [](const TrialView& t) -> DataCell { return t.row.samples; }},
    {"sampling_hz", false, [](const TrialView& t) -> DataCell { return t.row.rate_hz; }},
    {"overruns", false, [](const TrialView& t) -> DataCell { return t.row.overruns; }},
}};

}  // namespace

std::span<const TrialColumn> trial_columns() {
  return kTrialColumns;
}

const std::string& image_of(const Outcomes& study, const TrialOutcome& trial) {
  return study.exemplars[trial.stimulus.class_index][trial.stimulus.exemplar];
}

DataCell flag(bool value) {
  return std::int64_t{value ? 1 : 0};
}

}  // namespace touchtrial::analysis
