#include "analysis/planning/fit_uncertainty.hpp"
#include "analysis/planning/noise_lines.hpp"
#include "core/parallel.hpp"
#include "core/random.hpp"

#include <algorithm>
#include <cmath>

namespace touchtrial::planning {
namespace {

/// A local approximation of a fitted model: log-linear in the changes of the parameters, and
/// normalised. It has the fitted model's probabilities and slopes at the fit, and its likelihood
/// has one maximum. Immutable, thread-safe.
class LocalAnswers {
 public:
  explicit LocalAnswers(const FittedProblem& fitted);

  /// \return the maximum-likelihood parameters for the counts
  [[nodiscard]] std::vector<double> maximum_likelihood_fit(const Cells& counts) const;
  /// \return the answer probabilities at these parameter values
  [[nodiscard]] AnswerTable table_at(std::span<const double> numbers) const;

 private:
  [[nodiscard]] double log_likelihood(const Cells& counts, std::span<const double> change,
                                      std::span<double> slopes) const;
  /// Writes the probabilities of one layout and stimulus to `answers`.
  void answers_at(std::size_t layout, std::size_t place, std::span<const double> change,
                  std::span<double> answers) const;

  std::size_t classes_;
  std::size_t stimuli_;
  std::vector<double> fit_point_;
  Bounds change_bounds_;
  Cells probability_;
  std::vector<Cells> log_slopes_;  ///< [layout][cell][number]
};

/// Rarer answers keep their probability, because their slopes hold only at the fit itself.
constexpr double kMinSlopeProbability = 1e-6;

LocalAnswers::LocalAnswers(const FittedProblem& fitted)
    : classes_(fitted.counts.classes.size()),
      stimuli_(fitted.counts.stimuli.size()),
      fit_point_(fitted.best.point),
      change_bounds_(fitted.problem.bounds()) {
  const auto& [table, tangent_slopes] = fitted.tangent;
  for (std::size_t i = 0; i < fit_point_.size(); ++i) {
    change_bounds_.lower[i] -= fit_point_[i];
    change_bounds_.upper[i] -= fit_point_[i];
  }
  for (std::size_t layout = 0; layout < fitted.counts.layouts.size(); ++layout) {
    auto& row = probability_.emplace_back();
    auto& slopes = log_slopes_.emplace_back();
    for (std::size_t cell = 0; cell < stimuli_ * classes_; ++cell) {
      const auto answers =
          table.answers(static_cast<int>(layout), static_cast<int>(cell / classes_));
      row.push_back(answers[cell % classes_]);
      auto& cell_slopes = slopes.emplace_back(fit_point_.size(), 0.0);
      for (std::size_t i = 0; i < fit_point_.size() && row.back() > kMinSlopeProbability; ++i) {
        cell_slopes[i] = tangent_slopes[i][layout][cell] / row.back();
      }
    }
  }
}

void LocalAnswers::answers_at(std::size_t layout, std::size_t place, std::span<const double> change,
                              std::span<double> answers) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < classes_; ++c) {
    const std::size_t cell = place * classes_ + c;
    double log_change = 0.0;
    for (std::size_t i = 0; i < change.size(); ++i) {
      log_change += log_slopes_[layout][cell][i] * change[i];
    }
    answers[c] = probability_[layout][cell] * std::exp(std::clamp(log_change, -300.0, 300.0));
    sum += answers[c];
  }
  for (double& answer : answers) answer /= sum;
}

AnswerTable LocalAnswers::table_at(std::span<const double> numbers) const {
  std::vector<double> change(numbers.begin(), numbers.end());
  for (std::size_t i = 0; i < change.size(); ++i) change[i] -= fit_point_[i];
  AnswerTable table(static_cast<int>(probability_.size()), static_cast<int>(stimuli_),
                    static_cast<int>(classes_), false);
  for (std::size_t layout = 0; layout < probability_.size(); ++layout) {
    for (std::size_t place = 0; place < stimuli_; ++place) {
      answers_at(layout, place, change,
                 table.answers(static_cast<int>(layout), static_cast<int>(place)));
    }
  }
  return table;
}

double LocalAnswers::log_likelihood(const Cells& counts, std::span<const double> change,
                                    std::span<double> slopes) const {
  std::ranges::fill(slopes, 0.0);
  std::vector<double> answers(classes_);
  double sum = 0.0;
  for (std::size_t layout = 0; layout < counts.size(); ++layout) {
    for (std::size_t place = 0; place < stimuli_; ++place) {
      const std::size_t row = place * classes_;
      const double presented = presentations(counts[layout], row, classes_);
      if (presented == 0.0) continue;
      answers_at(layout, place, change, answers);
      for (std::size_t c = 0; c < classes_; ++c) {
        const double count = counts[layout][row + c];
        if (count > 0.0) sum += count * std::log(std::max(answers[c], kMinProbability));
        for (std::size_t i = 0; i < slopes.size(); ++i) {
          slopes[i] += (count - presented * answers[c]) * log_slopes_[layout][row + c][i];
        }
      }
    }
  }
  return sum;
}

std::vector<double> LocalAnswers::maximum_likelihood_fit(const Cells& counts) const {
  const SmoothFunction function = [&](std::span<const double> change, std::span<double> slopes) {
    return log_likelihood(counts, change, slopes);
  };
  std::vector<double> numbers = maximise(function, std::vector<double>(fit_point_.size(), 0.0),
                                         change_bounds_, {.tolerance = 1e-8})
                                    .point;
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] += fit_point_[i];
  return numbers;
}

/// The number of people who represent the population.
constexpr int kPoolSize = 32;

bool people_differ(const simulation::SubjectModel& subject) {
  return subject.feature_noise_spread > 0.0 || subject.lapse_spread > 0.0 ||
         subject.position_bias_spread > 0.0 || subject.class_bias_spread > 0.0;
}

/// Deviates of the pool's people: a fixed set in random order.
std::vector<double> deviates(RandomStream& random) {
  std::vector<double> groups = normal_groups(kPoolSize);
  shuffle(std::span(groups), random);
  return groups;
}

simulation::SubjectModel without_spreads(simulation::SubjectModel subject) {
  subject.feature_noise_spread = 0.0;
  subject.lapse_spread = 0.0;
  subject.position_bias_spread = 0.0;
  subject.class_bias_spread = 0.0;
  return subject;
}

/// People who together represent the population.
std::vector<simulation::SubjectModel> pool_of(const simulation::SubjectModel& population,
                                              const std::vector<std::string>& classes,
                                              std::uint64_t seed) {
  if (!people_differ(population)) return {population};
  RandomStream random(seed, "fit: people of the bootstrap");
  std::vector<simulation::SubjectModel> pool(kPoolSize, without_spreads(population));
  const std::vector<double> acuity = deviates(random);
  const std::vector<double> lapse = deviates(random);
  const std::vector<double> position = deviates(random);
  for (int i = 0; i < kPoolSize; ++i) {
    pool[i].feature_noise *= std::exp(population.feature_noise_spread * acuity[i]);
    if (population.lapse > 0.0 && population.lapse < 1.0) {
      const double odds = population.lapse / (1.0 - population.lapse) *
                          std::exp(population.lapse_spread * lapse[i]);
      pool[i].lapse = odds / (1.0 + odds);
    }
    pool[i].position_bias += population.position_bias_spread * position[i];
  }
  for (const std::string& label : classes) {
    if (population.class_bias_spread == 0.0) break;
    const std::vector<double> preference = deviates(random);
    for (int i = 0; i < kPoolSize; ++i) {
      pool[i].class_bias.push_back({label, population.class_bias_spread * preference[i]});
    }
  }
  return pool;
}

int draw_answer(std::span<const double> answers, RandomStream& random) {
  double remaining = random.uniform();
  for (std::size_t c = 0; c + 1 < answers.size(); ++c) {
    remaining -= answers[c];
    if (remaining < 0.0) return static_cast<int>(c);
  }
  return static_cast<int>(answers.size()) - 1;
}

std::vector<CountedPerson> draw_study(const FitCounts& counts, const std::vector<AnswerTable>& pool,
                                      RandomStream& random) {
  const std::size_t classes = counts.classes.size();
  std::vector<CountedPerson> people;
  for (const CountedPerson& person : counts.people) {
    CountedPerson simulated{person.layout, std::vector<double>(person.counts.size(), 0.0)};
    const AnswerTable& table = pool[random.below(pool.size())];
    for (std::size_t row = 0; row < person.counts.size(); row += classes) {
      const double presented = presentations(person.counts, row, classes);
      const auto answers = table.answers(person.layout, static_cast<int>(row / classes));
      for (int trial = 0; trial < std::lround(presented); ++trial) {
        simulated.counts[row + static_cast<std::size_t>(draw_answer(answers, random))] += 1.0;
      }
    }
    people.push_back(std::move(simulated));
  }
  return people;
}

}  // namespace

FitBootstrap bootstrap_fit(const FittedProblem& fitted, int draws, std::uint64_t seed, int jobs) {
  const FitCounts& counts = fitted.counts;
  const simulation::SubjectModel subject = fitted.problem.subject_at(fitted.best.point);
  std::vector<AnswerTable> pool;
  for (const simulation::SubjectModel& person : pool_of(subject, counts.classes, seed)) {
    pool.push_back(fitted.problem.model().answers(person, counts.layouts));
  }
  const LocalAnswers local(fitted);
  FitBootstrap bootstrap;
  bootstrap.numbers.resize(static_cast<std::size_t>(draws));
  bootstrap.g_squared.resize(static_cast<std::size_t>(draws));
  const auto draw = [&](std::size_t i) {
    RandomStream random(seed, "fit: study of the bootstrap", i);
    const std::vector<CountedPerson> people = draw_study(counts, pool, random);
    bootstrap.numbers[i] = local.maximum_likelihood_fit(counts_by_layout(counts, people));
    bootstrap.g_squared[i] =
        g_squared(observed_confusions(counts, people),
                  expected_confusions(counts, local.table_at(bootstrap.numbers[i])));
  };
  in_parallel(jobs, bootstrap.numbers.size(), draw);
  return bootstrap;
}

}  // namespace touchtrial::planning
