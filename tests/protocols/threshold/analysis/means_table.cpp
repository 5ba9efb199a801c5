/// \file Prints the table "Means over people" of docs/procedures-recovery.md: means_table PEOPLE.
/// Simulates the tracks of people, and takes the means of studies that draw from these
/// people as the report does.
#include "core/parallel.hpp"
#include "protocols/procedures/simulated_tracks.hpp"
#include "protocols/threshold/analysis/person_threshold.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

using namespace touchtrial;
using namespace touchtrial::procedures;
using namespace touchtrial::tracked;
using analysis::Bounds;
using analysis::CensoredMean;

namespace {

constexpr double kSpread_db = 5.0;

/// Studies of one kind. Thresholds are normal over people.
struct Kind {
  const char* words;
  double mean_db;
  int people;
  std::array<double, 2> slopes;  ///< log-uniform between these
  std::array<double, 2> lapses;
  const char* procedure = "quest-plus";
  int trials = 60;
};

constexpr std::array kUsualSlopes{2.0, 6.0};
constexpr std::array kUsualLapses{0.0, 0.05};
constexpr std::array kFlat{1.17, 1.17};
constexpr std::array kTenth{0.1, 0.1};
constexpr std::array kFifth{0.2, 0.2};

constexpr std::array kKinds{
    Kind{"usual", -18, 12, kUsualSlopes, kUsualLapses},
    Kind{"usual", -18, 36, kUsualSlopes, kUsualLapses},
    Kind{"usual", -18, 36, kUsualSlopes, kUsualLapses, "up-down"},
    Kind{"usual", -2, 12, kUsualSlopes, kUsualLapses},
    Kind{"usual", -2, 12, kUsualSlopes, kUsualLapses, "quest-plus", 30},
    Kind{"slope 1.17", -5, 24, kFlat, kUsualLapses},
    Kind{"slope 1.17", -5, 24, kFlat, kUsualLapses, "quest-plus", 120},
    Kind{"slope 1.17", -18, 24, kFlat, kUsualLapses},
    Kind{"lapse rate 0.1", -18, 24, kUsualSlopes, kTenth},
    Kind{"lapse rate 0.2", -18, 24, kUsualSlopes, kFifth},
    Kind{"lapse rate 0.2", -18, 24, kUsualSlopes, kFifth, "quest-plus", 120}};

struct Person {
  double truth = 0.0;
  Bounds bounds;  ///< with which the estimate of the person's track enters a mean
};

Person person_of(const Kind& kind, const TrackSettings& settings, std::size_t number) {
  RandomStream random(number, "means table/people");
  Observer observer;
  observer.shape = Shape::weibull;
  observer.threshold = kind.mean_db + kSpread_db * random.normal();
  observer.slope = std::exp(random.uniform(std::log(kind.slopes[0]), std::log(kind.slopes[1])));
  observer.lapse = random.uniform(kind.lapses[0], kind.lapses[1]);
  const std::vector<TrackTrial> trials = answered_track(settings, observer, number);
  const ThresholdEstimate estimate = estimate_of(settings, trials, observer, number);
  return {observer.threshold, analysis::threshold::bounds_of(estimate, settings.levels)};
}

/// The mean of one study's people, drawn from all.
CensoredMean study_of(const std::vector<Person>& all, int people, std::size_t number) {
  RandomStream random(number, "means table/studies");
  std::vector<Bounds> drawn;
  for (int i = 0; i < people; ++i) drawn.push_back(all[random.below(all.size())].bounds);
  return analysis::censored_mean(drawn);
}

std::string share_text(std::size_t count, std::size_t of) {
  return of == 0 ? "-"
                 : fmt::format("{:.2f}", static_cast<double>(count) / static_cast<double>(of));
}

void print_kind(const Kind& kind, std::size_t pool, std::size_t studies) {
  const TrackSettings settings = usual_track(kind.procedure, kind.trials);
  std::vector<Person> all(pool);
  in_parallel(0, pool, [&](std::size_t i) { all[i] = person_of(kind, settings, i + 1); });
  double truth = 0.0;
  std::size_t beyond = 0;
  std::size_t beyond_as_known = 0;
  for (const Person& one : all) {
    truth += one.truth / static_cast<double>(pool);
    if (one.truth <= settings.levels.back()) continue;
    ++beyond;
    beyond_as_known += one.bounds.exact() ? 1 : 0;
  }
  std::vector<CensoredMean> means(studies);
  in_parallel(0, studies, [&](std::size_t i) { means[i] = study_of(all, kind.people, i + 1); });
  std::size_t found = 0;
  std::size_t covered = 0;
  double error = 0.0;
  for (const CensoredMean& mean : means) {
    if (!mean.interval) continue;
    ++found;
    error += *mean.mean - truth;
    covered += mean.interval->low <= truth && truth <= mean.interval->high ? 1 : 0;
  }
  fmt::print("| {} | {} | {} | {:.0f} | {} | {} | {} | {} | {:+.1f} | {} |\n", kind.words,
             kind.procedure, kind.trials, kind.mean_db, kind.people, share_text(beyond, pool),
             share_text(beyond_as_known, beyond), share_text(found, studies),
             error / static_cast<double>(found), share_text(covered, found));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int pool = argc > 1 ? std::atoi(argv[1]) : 600;
  if (pool < 20) return 2;
  constexpr std::size_t kStudies = 2000;
  fmt::print(
      "\n## Means over people\n\n"
      "By `means_table {}` of `scripts/recovery-procedures`: as many people of each kind, "
      "with one track each and thresholds\n"
      "with an SD of 5 dB. Levels are -40 to 0 dB. {} studies draw from these people; the "
      "true value is their mean. *Taken as\n"
      "inside*: the share of people beyond the levels who contribute a value to the mean.\n\n"
      "| observers | procedure | trials | mean of all, dB | people of a study | beyond | "
      "taken as inside | studies with a mean | bias, dB | interval covers |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      pool, kStudies);
  for (const Kind& kind : kKinds) print_kind(kind, static_cast<std::size_t>(pool), kStudies);
}
