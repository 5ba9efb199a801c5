#include "protocols/identification/planning/stated_people.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "study/protocol.hpp"
#include "study/study_key.hpp"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/beta.hpp>
#include <fmt/format.h>

namespace touchtrial::planning::identification {
namespace {

bool compares_two_methods(const PrimaryTest& test) {
  return test.estimand == study::Estimand::difference;
}

/// The range of a person's accuracy, or of the difference of two accuracies.
analysis::Interval range_of(const StatedPeople& people, const PrimaryTest& test) {
  if (!compares_two_methods(test)) return {0.0, 1.0};
  const double max_difference = 2.0 * std::min(*people.accuracy, 1.0 - *people.accuracy);
  return {-max_difference, max_difference};
}

void require_spread(double mean, double sd, const analysis::Interval& range,
                    const char* condition) {
  const bool is_in_range = mean >= range.low && mean <= range.high;
  const double max_sd = is_in_range ? std::sqrt((mean - range.low) * (range.high - mean)) : 0.0;
  if (!is_in_range) {
    throw UsageError(
        fmt::format("--mean: {:.4g}{} is out of range; give a share from {:.4g} to {:.4g}", mean,
                    condition, range.low, range.high));
  }
  if (sd >= 0.0 && (sd < max_sd || sd == 0.0)) return;
  throw UsageError(fmt::format(
      "--sd-between: {:.4g} is impossible with a mean of {:.4g}{}; give 0, or less than {:.4g}", sd,
      mean, condition, max_sd));
}

/// Draws a person's accuracy, or the difference of two accuracies.
double draw_person_quantity(double mean, double sd, const analysis::Interval& range,
                            RandomStream& random) {
  const double share = random.uniform();
  // A smaller spread has no effect on trials and exceeds the precision of the beta distribution.
  if (sd < 1e-6 * (range.high - range.low)) return mean;
  const double width = range.high - range.low;
  const double m = (mean - range.low) / width;
  const double v = (sd / width) * (sd / width);
  const double n = m * (1.0 - m) / v - 1.0;
  return range.low + width * boost::math::quantile(
                                 boost::math::beta_distribution<>(m * n, (1.0 - m) * n), share);
}

struct StatedPerson {
  double first = 0.0;   ///< with the test's first method
  double second = 0.0;  ///< with the test's second method, if it compares two
  double other = 0.0;   ///< with any other method
};

StatedPerson person_with(double quantity, const StatedPeople& people, const PrimaryTest& test) {
  if (!compares_two_methods(test)) return {quantity, quantity, quantity};
  const double accuracy = *people.accuracy;
  return {accuracy + quantity / 2.0, accuracy - quantity / 2.0, accuracy};
}

double accuracy_with(const StatedPerson& person, int method, const PrimaryTest& test) {
  if (method == test.first) return person.first;
  return compares_two_methods(test) && method == test.second ? person.second : person.other;
}

double mean_under_null(const PrimaryTest& test, std::size_t classes) {
  if (!compares_two_methods(test)) return 1.0 / static_cast<double>(classes);
  return test.margin ? -*test.margin : 0.0;
}

}  // namespace

void require_possible(const StatedPeople& people, const PrimaryTest& test) {
  if (compares_two_methods(test) && !people.accuracy) {
    throw UsageError(
        "--mean: is a difference of accuracies in this study; also give the mean accuracy of both "
        "methods, for instance --accuracy 0.5");
  }
  if (!compares_two_methods(test) && people.accuracy) {
    throw UsageError(
        "--accuracy: applies to studies that compare two methods; remove it, and give the accuracy "
        "with --mean");
  }
  if (people.accuracy && !(*people.accuracy > 0.0 && *people.accuracy < 1.0)) {
    throw UsageError(fmt::format("--accuracy: {:.4g} is out of range; give a share between 0 and 1",
                                 *people.accuracy));
  }
  const analysis::Interval range = range_of(people, test);
  require_spread(people.mean, people.sd_between, range, "");
  if (test.margin)
    require_spread(-*test.margin, people.sd_between, range, " (worse by the margin)");
  else if (compares_two_methods(test))
    require_spread(0.0, people.sd_between, range, " (no difference)");
}

std::string words_of(const StatedPeople& people) {
  return fmt::format(
      "stated people: mean {} {}, SD {} between people{}",
      people.accuracy ? "difference" : "accuracy", people.mean, people.sd_between,
      people.accuracy ? fmt::format(", everybody's accuracy {}", *people.accuracy) : std::string());
}

StatedRehearsal::StatedRehearsal(const study::Study& study, const StatedPeople& people,
                                 const PrimaryTest& test, int max_participants)
    : people_(people), test_(test), visits_(study.visits.count), empty_(empty_outcomes(study)) {
  require_possible(people, test);
  const study::StudyKey key = study::simulated_study_key(study);
  for (int number = 1; number <= max_participants; ++number) {
    for (int visit = 1; visit <= visits_; ++visit) {
      planned_visits_.push_back(
          {study::make_schedule(study, key.draw_of(number, study::Draws::rehearsal, visit)),
           study::order_block_of(study, key.stations, number, study::Draws::rehearsal)});
    }
  }
}

analysis::Outcomes StatedRehearsal::outcomes(int participants, Hypothesis hypothesis,
                                             std::uint64_t study_seed) const {
  analysis::Outcomes outcomes = empty_;
  const bool is_null = hypothesis == Hypothesis::null;
  const double mean = is_null ? mean_under_null(test_, empty_.classes.size()) : people_.mean;
  const double sd = is_null && !compares_two_methods(test_) ? 0.0 : people_.sd_between;
  const analysis::Interval range = range_of(people_, test_);
  for (int number = 1; number <= participants; ++number) {
    RandomStream random(study_seed, "power: stated people", static_cast<std::uint64_t>(number));
    const StatedPerson person =
        person_with(draw_person_quantity(mean, sd, range, random), people_, test_);
    for (int visit = 1; visit <= visits_; ++visit) {
      const int session = (number - 1) * visits_ + visit;
      const PlannedVisit& planned = planned_visits_[static_cast<std::size_t>(session) - 1];
      outcomes.sessions.push_back(completed_session(number, session, visit, planned.order_block));
      const std::vector<int>& layout = planned.schedule.layout;
      for (const study::Trial& one : planned.schedule.trials) {
        if (one.role != study::Role::scored) continue;
        const auto right =
            static_cast<int>(std::ranges::find(layout, one.field().class_index) - layout.begin());
        const bool is_right = random.uniform() < accuracy_with(person, one.field().method, test_);
        outcomes.trials.push_back(
            answered_trial(number, session, visit, one, planned.schedule,
                           is_right ? right : another_position(right, layout.size(), random)));
      }
    }
  }
  return outcomes;
}

}  // namespace touchtrial::planning::identification
