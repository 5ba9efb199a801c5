#include "protocols/rating/planning/rating_plan.hpp"

#include "analysis/statistics/descriptive.hpp"
#include "analysis/statistics/paired_tests.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"

#include <cmath>
#include <span>

namespace touchtrial::planning::rating {
namespace {

struct SampleResult {
  std::optional<double> width;
  bool significant = false;
  bool false_alarm = false;
};

/// A participant drawn from a pool, and a random sign for the differences under the null
/// hypothesis.
struct SampledPerson {
  std::size_t person = 0;
  double sign = 1.0;
};

std::vector<SampledPerson> draw_sample(int people, int size, RandomStream& random) {
  std::vector<SampledPerson> sample(static_cast<std::size_t>(size));
  for (SampledPerson& one : sample) {
    one.person = static_cast<std::size_t>(random.below(static_cast<std::uint64_t>(people)));
    one.sign = random.below(2) == 0 ? 1.0 : -1.0;
  }
  return sample;
}

bool is_rejected(std::span<const double> differences, double alpha) {
  const auto p = analysis::sign_flip_p(differences);
  return p && *p <= alpha;
}

SampleResult result_of(const PooledScale& scale, std::span<const SampledPerson> sample,
                       double alpha) {
  std::vector<double> differences;
  std::vector<double> null_differences;
  for (const SampledPerson& one : sample) {
    const auto& difference = scale.people[one.person].difference;
    if (!difference) continue;
    differences.push_back(*difference);
    null_differences.push_back(one.sign * *difference);
  }
  const double range = scale.ends.high - scale.ends.low;
  const auto interval = analysis::participant_mean(differences, {-range, range}).known_interval();
  SampleResult result;
  if (interval) result.width = interval->high - interval->low;
  result.significant = is_rejected(differences, alpha);
  result.false_alarm = is_rejected(null_differences, alpha);
  return result;
}

DifferencePower power_of(std::span<const std::vector<SampleResult>> samples, std::size_t scale) {
  DifferencePower power;
  std::vector<double> widths;
  for (const std::vector<SampleResult>& sample : samples) {
    const SampleResult& result = sample[scale];
    power.significant.add(result.significant);
    power.false_alarms.add(result.false_alarm);
    if (result.width) {
      widths.push_back(*result.width);
    } else {
      ++power.without_interval;
    }
  }
  power.power = analysis::wilson_interval(power.significant);
  power.type_one = analysis::wilson_interval(power.false_alarms);
  if (!widths.empty()) power.width = analysis::mean_of(widths);
  return power;
}

}  // namespace

int min_participants(double alpha) {
  int participants = 2;
  while (std::ldexp(2.0, -participants) > alpha) ++participants;
  return participants;
}

double attainable_error(int participants, double alpha) {
  if (participants > analysis::kExactSignFlips) return alpha;
  // Opposite sign patterns have the same p.
  const double pairs = std::ldexp(1.0, participants - 1);
  return std::floor(alpha * pairs) / pairs;
}

std::vector<RatingRow> rows_of(const RatingPool& pool, const RatingPlan& plan, int jobs) {
  std::vector<RatingRow> rows;
  for (const int size : plan.participants) {
    std::vector<std::vector<SampleResult>> samples(static_cast<std::size_t>(plan.runs));
    in_parallel(jobs, samples.size(), [&](std::size_t run) {
      RandomStream random(plan.seed, "power: sample of " + std::to_string(size), run);
      const std::vector<SampledPerson> sample = draw_sample(pool.people, size, random);
      for (const PooledScale& scale : pool.scales) {
        samples[run].push_back(result_of(scale, sample, plan.alpha));
      }
    });
    RatingRow& row = rows.emplace_back();
    row.participants = size;
    row.attainable = attainable_error(size, plan.alpha);
    for (std::size_t scale = 0; scale < pool.scales.size(); ++scale) {
      row.scales.push_back(power_of(samples, scale));
    }
  }
  return rows;
}

}  // namespace touchtrial::planning::rating
