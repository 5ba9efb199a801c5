#include "analysis/planning/fit_bootstrap.hpp"

#include "analysis/planning/fit_jobs.hpp"
#include "analysis/planning/local_answers.hpp"
#include "analysis/planning/noise_points.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

constexpr int kPool = 32;

bool people_differ(const session::SubjectModel& subject) {
  return subject.weber_spread > 0.0 || subject.lapse_spread > 0.0 ||
         subject.position_bias_spread > 0.0 || subject.class_bias_spread > 0.0;
}

/// Deviates of the pool's people: the same ones, in an order of their own for each difference.
std::vector<double> deviates(RandomStream& random) {
  std::vector<double> groups = normal_groups(kPool);
  shuffle(std::span(groups), random);
  return groups;
}

session::SubjectModel without_spreads(session::SubjectModel subject) {
  subject.weber_spread = 0.0;
  subject.lapse_spread = 0.0;
  subject.position_bias_spread = 0.0;
  subject.class_bias_spread = 0.0;
  return subject;
}

/// People who together are like the population.
std::vector<session::SubjectModel> pool_of(const session::SubjectModel& population,
                                           const std::vector<std::string>& classes,
                                           std::uint64_t seed) {
  if (!people_differ(population)) return {population};
  RandomStream random(seed, "fit: people of the bootstrap");
  std::vector<session::SubjectModel> pool(kPool, without_spreads(population));
  const std::vector<double> acuity = deviates(random);
  const std::vector<double> lapse = deviates(random);
  const std::vector<double> position = deviates(random);
  for (int i = 0; i < kPool; ++i) {
    pool[i].weber *= std::exp(population.weber_spread * acuity[i]);
    if (population.lapse > 0.0 && population.lapse < 1.0) {
      const double odds = population.lapse / (1.0 - population.lapse) *
                          std::exp(population.lapse_spread * lapse[i]);
      pool[i].lapse = odds / (1.0 + odds);
    }
    pool[i].position_bias += population.position_bias_spread * position[i];
  }
  for (const std::string& label : classes) {
    if (population.class_bias_spread == 0.0) break;
    const std::vector<double> liking = deviates(random);
    for (int i = 0; i < kPool; ++i) {
      pool[i].class_bias.push_back({label, population.class_bias_spread * liking[i]});
    }
  }
  return pool;
}

int drawn_answer(std::span<const double> answers, RandomStream& random) {
  double left = random.uniform();
  for (std::size_t c = 0; c + 1 < answers.size(); ++c) {
    left -= answers[c];
    if (left < 0.0) return static_cast<int>(c);
  }
  return static_cast<int>(answers.size()) - 1;
}

std::vector<CountedPerson> drawn_study(const FitCounts& counts,
                                       const std::vector<AnswerTable>& pool, RandomStream& random) {
  const std::size_t classes = counts.classes.size();
  std::vector<CountedPerson> people;
  for (const CountedPerson& person : counts.people) {
    CountedPerson drawn{person.layout, std::vector<double>(person.counts.size(), 0.0)};
    const AnswerTable& own = pool[random.below(pool.size())];
    for (std::size_t row = 0; row < person.counts.size(); row += classes) {
      double presented = 0.0;
      for (std::size_t c = 0; c < classes; ++c) presented += person.counts[row + c];
      const auto answers = own.answers(person.layout, static_cast<int>(row / classes));
      for (int trial = 0; trial < std::lround(presented); ++trial) {
        drawn.counts[row + static_cast<std::size_t>(drawn_answer(answers, random))] += 1.0;
      }
    }
    people.push_back(std::move(drawn));
  }
  return people;
}

}  // namespace

FitBootstrap bootstrap_fit(const FitProblem& problem, const FitCounts& counts,
                           const std::vector<double>& at, int draws, std::uint64_t seed, int jobs) {
  const session::SubjectModel fitted = problem.subject_at(at);
  std::vector<AnswerTable> pool;
  for (const session::SubjectModel& person : pool_of(fitted, counts.classes, seed)) {
    pool.push_back(problem.model().answers(person, counts.layouts));
  }
  const LocalAnswers local(counts, problem.tangent(at), at, problem.bounds());
  FitBootstrap bootstrap;
  bootstrap.numbers.resize(static_cast<std::size_t>(draws));
  bootstrap.g_squared.resize(static_cast<std::size_t>(draws));
  const auto draw = [&](std::size_t i) {
    RandomStream random(seed, "fit: study of the bootstrap", i);
    const std::vector<CountedPerson> people = drawn_study(counts, pool, random);
    bootstrap.numbers[i] = local.fitted_to(by_layout(counts, people));
    bootstrap.g_squared[i] = g_squared(observed_confusions(counts, people),
                                       expected_confusions(counts, local.at(bootstrap.numbers[i])));
  };
  on_threads(jobs, bootstrap.numbers.size(), draw);
  return bootstrap;
}

}  // namespace touchtrial::planning
