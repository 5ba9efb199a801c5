#include "analysis/planning/power_plan.hpp"

#include "core/errors.hpp"
#include "core/hash.hpp"
#include "core/strict_json.hpp"
#include "core/text.hpp"
#include "device/drivers/simulated/simulated_hand.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

constexpr int kMaxExplorations = 100'000;
constexpr int kMaxTrainings = 1'000;

void require_range(const char* option, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw UsageError(fmt::format("{}: {} is out of range; give {} to {}", option, value, low, high));
}

void check_and_sort_sizes(PowerPlan& plan) {
  if (plan.participants.empty()) {
    throw UsageError("--participants: no size is given; give one or more, for instance 8,12,16");
  }
  if (plan.participants.size() > kMaxPowerSizes) {
    throw UsageError(fmt::format("--participants: {} sizes are given; give at most {}",
                                 plan.participants.size(), kMaxPowerSizes));
  }
  for (const int size : plan.participants) {
    // One participant gives no interval over participants.
    require_range("--participants", size, 2, kMaxPowerParticipants);
  }
  std::ranges::sort(plan.participants);
  const auto duplicate = std::ranges::adjacent_find(plan.participants);
  if (duplicate != plan.participants.end()) {
    throw UsageError(
        fmt::format("--participants: {} is given twice; give each size once", *duplicate));
  }
}

/// Distinguishes subject models with equal main numbers, because the text shows only these.
std::string digest_of(const simulation::SubjectModel& subject) {
  constexpr std::size_t kDigits = 12;
  FieldHasher hasher;
  hasher.add(simulation::subject_model_json(subject));
  hasher.add(device::device_model_json(subject.device));
  return to_hex(hasher.finish()).substr(0, kDigits);
}

}  // namespace

void validate_plan(PowerPlan& plan) {
  check_and_sort_sizes(plan);
  require_range("--runs", plan.runs, 1, kMaxPowerRuns);
  require_range("--explorations", plan.explorations, 1, kMaxExplorations);
  require_range("--trainings", plan.trainings, 1, kMaxTrainings);
  const std::int64_t total_runs =
      static_cast<std::int64_t>(plan.participants.size()) * std::int64_t{plan.runs};
  if (total_runs > kMaxTotalPowerRuns) {
    throw UsageError(
        fmt::format("--runs: {} runs of {} sizes are {} in total; give fewer runs or sizes, at "
                    "most {} in total",
                    plan.runs, plan.participants.size(), total_runs, kMaxTotalPowerRuns));
  }
}

std::vector<int> parse_numbers(std::string_view text, const std::string& option,
                               const std::string& what) {
  std::vector<int> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    const auto number = number_in<int>(part);
    if (!number || *number < 0) {
      throw UsageError(one_line(fmt::format("{}: '{}' is not {}; give for instance 8,12,16", option,
                                            part.substr(0, 60), what)));
    }
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

std::string words_of(const simulation::SubjectModel& subject) {
  return fmt::format(
      "{}, {}, sense {}, feature_noise {} (spread {}), lapse {} (spread {}); digest {}",
      subject.source.empty() ? "built-in subject"
                             : one_line(std::filesystem::path(subject.source).filename().string()),
      device::simulated_device_name(subject.device), simulation::name_of_sense(subject.sense),
      number_text(subject.feature_noise), number_text(subject.feature_noise_spread),
      number_text(subject.lapse), number_text(subject.lapse_spread), digest_of(subject));
}

std::string power_per_cent(double share) {
  return fmt::format("{:.1f}", 100.0 * share);
}

std::string power_range(const analysis::Interval& interval) {
  return "[" + power_per_cent(interval.low) + ", " + power_per_cent(interval.high) + "]";
}

}  // namespace touchtrial::planning
