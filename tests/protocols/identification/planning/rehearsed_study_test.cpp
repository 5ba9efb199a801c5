#include "protocols/identification/planning/rehearsed_study.hpp"

#include "core/errors.hpp"
#include "protocols/identification/analysis/report.hpp"
#include "protocols/identification/planning/rehearsed_tiny_study.hpp"
#include "protocols/identification/study/identification.hpp"
#include "protocols/session/commitment.hpp"
#include "protocols/simulation/simulation.hpp"
#include "record/study_store.hpp"
#include "study/protocol.hpp"
#include "support/catch.hpp"
#include "support/names.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace touchtrial {
namespace {

using namespace analysis;
using namespace planning::identification;
using namespace std::chrono_literals;

/// Slow reference: outcomes of the same participants through sessions, events and a database.
Outcomes simulated_and_loaded(TinyStudy& tiny, const simulation::SubjectModel& subject,
                              int participants, std::uint64_t seed) {
  record::StudyStore store = record::StudyStore::create(
      tiny.next_database(), session::commitment_of(tiny.key(), tiny.pack(), true, false), 0ns,
      tiny.key().signer());
  simulation::simulate_study(tiny.key(), tiny.pack(), subject, {participants, seed, 2}, store);
  store.close_study(0ns);
  store.unblind(0ns, "test", false);
  return analysis::load_outcomes(store, tiny.key());
}

std::vector<TrialOutcome> scored(const Outcomes& outcomes) {
  std::vector<TrialOutcome> trials;
  for (const TrialOutcome& trial : outcomes.trials) {
    if (trial.scored) trials.push_back(trial);
  }
  // Simulate has everybody's first visit before the second ones.
  std::ranges::stable_sort(trials, {}, [](const TrialOutcome& trial) {
    return std::tuple(trial.participant, trial.visit, trial.row.trial);
  });
  return trials;
}

/// Compares presentations and answers, in order.
void check_same_answers(const Outcomes& one, const Outcomes& other) {
  const auto a = scored(one);
  const auto b = scored(other);
  REQUIRE(a.size() == b.size());
  int same = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool alike = a[i].participant == b[i].participant && a[i].stimulus == b[i].stimulus &&
                       a[i].response == b[i].response && a[i].row.trial == b[i].row.trial &&
                       a[i].row.block == b[i].row.block && a[i].counted == b[i].counted;
    same += alike ? 1 : 0;
  }
  CHECK(same == static_cast<int>(a.size()));
}

void check_same_figures(const PowerRun& run, const identification::StudyReport& report) {
  const identification::MethodReport& method = report.methods.front();
  CHECK(run.p == report.primary->p);
  CHECK(run.estimate == method.mean.mean);
  CHECK(run.low == method.mean.interval.low);
  CHECK(run.high == method.mean.interval.high);
}

TEST_CASE("a power run on the servo path gives the answers and numbers of simulate and report") {
  RehearsedTinyStudy study;
  const RehearsedStudy planned = study.planned(study.servo);
  const std::uint64_t seed = planning::identification::study_seed(1, 3, Hypothesis::population, 0);
  const Outcomes fast = planned.outcomes(3, Hypothesis::population, seed);
  const Outcomes whole = simulated_and_loaded(study.tiny, study.subject, 3, seed);
  check_same_answers(fast, whole);
  check_same_figures(analyse_run(study.test, fast, false), identification::make_report(whole));
}

TEST_CASE(
    "the servo path agrees with simulate for several exemplars, catch trials, lead-ins and "
    "breaks") {
  TinyStudyOptions options;
  options.images = 2;
  options.side_px = 60;
  options.trials = R"({"repeats":2,"catch":3,"lead_in":2,"break_every":4,"max_run":2})";
  RehearsedTinyStudy study(options);
  const RehearsedStudy planned = study.planned(study.servo);
  const Outcomes fast = planned.outcomes(2, Hypothesis::population, 5);
  const Outcomes whole = simulated_and_loaded(study.tiny, study.subject, 2, 5);
  check_same_answers(fast, whole);
  const PowerRun run = analyse_run(study.test, fast, false);
  const identification::StudyReport report = identification::make_report(whole);
  CHECK(run.estimate == report.methods.front().mean.mean);
  CHECK(run.p == report.primary->p);
}

TEST_CASE("the servo path agrees with simulate for a comparison of two methods") {
  for (const char* trials : {R"({"repeats":1,"blocks":"mixed"})", R"({"repeats":1})"}) {
    INFO(trials);
    TinyStudyOptions options{.comparison = true, .side_px = 60, .trials = trials};
    RehearsedTinyStudy study(options);
    const RehearsedStudy planned = study.planned(study.servo);
    const Outcomes fast = planned.outcomes(3, Hypothesis::population, 8);
    const Outcomes whole = simulated_and_loaded(study.tiny, study.subject, 3, 8);
    check_same_answers(fast, whole);
    const PowerRun run = analyse_run(study.test, fast, true);
    const identification::StudyReport report = identification::make_report(whole);
    CHECK(run.p == report.primary->p);
    CHECK(run.estimate == report.primary->registered().estimate);
    CHECK(run.low == report.primary->registered().interval->low);
    CHECK(run.high == report.primary->registered().interval->high);
    if (report.primary->crossover) {
      CHECK(analysis::crossover_permutation(choices::primary_values(study.test, fast), 0.0,
                                            Sides::two)
                ->p == report.primary->permutation->p);
    } else {
      CHECK(run.p == report.comparison->p);
      CHECK(run.low == report.comparison->interval.low);
    }
  }
}

/// Somebody with every kind of change from trial to trial.
simulation::SubjectModel changing_subject(simulation::Training training) {
  simulation::SubjectModel subject = hasty_subject();
  subject.training = training;
  subject.memory_noise = 0.3;
  subject.learning = {.factor = 6.0, .trials = 30.0, .forgotten = 0.9, .spread = 0.5};
  subject.period_noise_spread = 0.5;
  subject.serial = {.answer = 1.0, .answer_spread = 0.5, .stimulus = -2.0, .stimulus_spread = 0.5};
  subject.fatigue = {.noise_per_min = 0.8, .lapse_per_min = 3.0, .recovered = 0.6};
  subject.thought = simulation::ThoughtTime{};
  return subject;
}

TEST_CASE(
    "the servo path agrees with simulate for people who change, over visits, blocks, breaks, catch "
    "trials and lead-ins") {
  const auto training = GENERATE(simulation::Training::own, simulation::Training::shared);
  TinyStudyOptions options;
  options.pictures = true;
  options.comparison = true;
  options.images = 2;
  options.side_px = 60;
  options.trials = R"({"repeats":2,"catch":4,"lead_in":2,"break_every":7})";
  options.visits = GENERATE(R"({"count":2})", R"({"count":2,"methods":"divided"})");
  RehearsedTinyStudy study(options, changing_subject(training));
  const RehearsedStudy planned = study.planned(study.servo);
  const Outcomes fast = planned.outcomes(2, Hypothesis::population, 5);
  const Outcomes whole = simulated_and_loaded(study.tiny, study.subject, 2, 5);
  check_same_answers(fast, whole);
}

TEST_CASE("every change from trial to trial changes answers, and how long people think does not") {
  TinyStudyOptions options{.side_px = 60,
                           .trials = R"({"repeats":4,"lead_in":2,"break_every":7})",
                           .visits = R"({"count":2})"};
  RehearsedTinyStudy study(options, changing_subject(simulation::Training::own));
  const PrecomputedPerception bank = study.bank();
  const auto answers = [&](const simulation::SubjectModel& subject) {
    const RehearsedStudy planned(study.tiny.key().study, subject, study.test, bank, 10);
    std::vector<std::optional<int>> given;
    for (const TrialOutcome& trial : scored(planned.outcomes(10, Hypothesis::population, 5))) {
      given.push_back(trial.response);
    }
    return given;
  };
  const auto all = answers(study.subject);
  REQUIRE(all.size() == 10 * 2 * 20);
  using Subject = simulation::SubjectModel;
  const auto differs_with = [&](const std::function<void(Subject&)>& change) {
    Subject other = study.subject;
    change(other);
    return answers(other) != all;
  };
  CHECK(differs_with([](Subject& one) { one.learning = {}; }));
  CHECK(differs_with([](Subject& one) { one.learning.forgotten = 0.0; }));
  CHECK(differs_with([](Subject& one) { one.learning.spread = 0.0; }));
  CHECK(differs_with([](Subject& one) { one.period_noise_spread = 0.0; }));
  CHECK(differs_with([](Subject& one) { one.serial.answer = 0.0; }));
  CHECK(differs_with([](Subject& one) { one.serial.stimulus = 0.0; }));
  CHECK(differs_with([](Subject& one) { one.fatigue.noise_per_min = 0.0; }));
  CHECK(differs_with([](Subject& one) { one.fatigue.lapse_per_min = 0.0; }));
  CHECK(differs_with([](Subject& one) { one.fatigue.recovered = 0.0; }));
  CHECK(differs_with([](Subject& one) { one.memory_noise = 0.0; }));
  CHECK_FALSE(differs_with([](Subject& one) { one.thought.reset(); }));
}

/// Repeats what the servo path felt, without a servo.
class RememberedFeelings final : public PerceptionSource {
 public:
  RememberedFeelings(const RehearsedTinyStudy& study, int participants, std::uint64_t seed)
      : knowledge_(study.servo.knowledge(seed)) {
    for (int number = 1; number <= participants; ++number) {
      const study::Schedule schedule = study::make_schedule(
          study.tiny.key().study, study.tiny.key().draw_of(number, study::Draws::rehearsal));
      for (std::size_t i = 0; i < schedule.trials.size(); ++i) {
        const planning::identification::FeltTrial trial{seed, number, i + 1, 0};
        felt_[{number, i + 1}] = study.servo.felt(schedule.trials[i].field(), trial);
      }
    }
  }
  [[nodiscard]] std::shared_ptr<const simulation::FeltKnowledge> knowledge(
      std::uint64_t) const override {
    return knowledge_;
  }
  [[nodiscard]] engine::FeltFeatures felt(
      const study::StimulusIndex&,
      const planning::identification::FeltTrial& trial) const override {
    return felt_.at({trial.participant, trial.nth});
  }

 private:
  std::shared_ptr<const simulation::FeltKnowledge> knowledge_;
  std::map<std::pair<int, std::uint64_t>, engine::FeltFeatures> felt_;
};

TEST_CASE(
    "the fast path answers as the servo path does when the bank holds its very explorations") {
  const RehearsedTinyStudy study(
      {}, GENERATE(hasty_subject(), changing_subject(simulation::Training::own)));
  const RememberedFeelings remembered(study, 2, 9);
  const Outcomes fast = study.planned(remembered).outcomes(2, Hypothesis::population, 9);
  const Outcomes slow = study.planned(study.servo).outcomes(2, Hypothesis::population, 9);
  check_same_answers(fast, slow);
}

/// Accuracies and confusions of many small studies.
struct Answers {
  double trials = 0.0;
  double correct = 0.0;
  std::map<std::pair<int, int>, double> confusion;
};

Answers answers_of(const RehearsedStudy& planned, int studies, std::uint64_t seed) {
  Answers answers;
  for (int i = 0; i < studies; ++i) {
    const Outcomes outcomes =
        planned.outcomes(4, Hypothesis::population,
                         planning::identification::study_seed(seed, 4, Hypothesis::population, i));
    for (const TrialOutcome& trial : outcomes.trials) {
      ++answers.trials;
      if (trial.correct()) ++answers.correct;
      ++answers.confusion[{trial.stimulus.class_index, *trial.response}];
    }
  }
  return answers;
}

TEST_CASE("a bank of independent explorations gives the accuracies and confusions of the servo") {
  TinyStudyOptions options{.side_px = 60};
  const RehearsedTinyStudy study(options);
  const PrecomputedPerception bank = study.bank(60, 12);
  constexpr int kStudies = 12;
  const Answers fast = answers_of(study.planned(bank), kStudies, 1);
  const Answers slow = answers_of(study.planned(study.servo), kStudies, 2);
  REQUIRE(fast.trials == slow.trials);
  // People and trainings differ between the two, so the error is more than binomial: allow four
  // standard errors at twice the binomial variance.
  const double n = fast.trials;
  const double p = (fast.correct + slow.correct) / (2.0 * n);
  CHECK(p > 0.3);
  CHECK(p < 0.98);
  CHECK(std::abs(fast.correct - slow.correct) / n < 4.0 * std::sqrt(4.0 * p * (1.0 - p) / n));
  for (int presented = 0; presented < 5; ++presented) {
    const double shown = n / 5.0;
    for (int answered = 0; answered < 5; ++answered) {
      const std::pair cell(presented, answered);
      const double a = fast.confusion.contains(cell) ? fast.confusion.at(cell) : 0.0;
      const double b = slow.confusion.contains(cell) ? slow.confusion.at(cell) : 0.0;
      const double share = (a + b + 1.0) / (2.0 * shown + 2.0);
      CHECK(std::abs(a - b) / shown < 4.0 * std::sqrt(4.0 * share * (1.0 - share) / shown) + 0.01);
    }
  }
}

TEST_CASE("under the null nobody feels what is presented") {
  const RehearsedTinyStudy study({}, [] {
    simulation::SubjectModel sure = hasty_subject();
    sure.feature_noise = 0.05;
    sure.lapse = 0.0;
    return sure;
  }());
  const PrecomputedPerception bank = study.bank();
  const RehearsedStudy planned = study.planned(bank);
  int correct = 0;
  int trials = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const TrialOutcome& trial : planned.outcomes(5, Hypothesis::null, seed).trials) {
      correct += trial.correct() ? 1 : 0;
      ++trials;
    }
  }
  REQUIRE(trials == 20 * 5 * 25);
  // 500 of 2,500 by chance; the standard error is at most 20.
  CHECK(std::abs(correct - 500) < 90);
}

/// The share of right answers in many simulated studies, by method.
struct SharesRight {
  Proportion method[2];

  SharesRight(const RehearsedStudy& planned, Hypothesis hypothesis) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      for (const TrialOutcome& trial : planned.outcomes(12, hypothesis, seed).trials) {
        Proportion& one = method[trial.stimulus.method];
        ++one.n;
        one.correct += trial.correct() ? 1 : 0;
      }
    }
  }
};

double share_right(const Proportion& proportion) {
  return proportion.share().value();
}

RehearsedTinyStudy two_methods() {
  TinyStudyOptions options{.comparison = true, .side_px = 60, .trials = R"({"repeats":2})"};
  return RehearsedTinyStudy(options);
}

TEST_CASE("with a margin, methods are alike, or the first is worse by the margin") {
  RehearsedTinyStudy study = two_methods();
  study.test.margin = 0.1;
  study.test.sides = Sides::one;
  const PrecomputedPerception bank = study.bank();
  const RehearsedStudy planned = study.planned(bank);
  const SharesRight alike(planned, Hypothesis::population);
  const SharesRight worse(planned, Hypothesis::null);
  CHECK(share_right(alike.method[0]) - share_right(alike.method[1]) == Approx(0.0).margin(0.04));
  CHECK(share_right(worse.method[0]) - share_right(worse.method[1]) == Approx(-0.1).margin(0.04));
  CHECK(analyse_run(study.test, planned.outcomes(12, Hypothesis::null, 1), true).attainable ==
        0.05);
  study.test.margin = 1.0;
  CHECK_THROWS_AS(study.planned(bank), UsageError);
}

TEST_CASE("with trainings of their own people are on average no better than with a shared one") {
  TinyStudyOptions options{.side_px = 60};
  simulation::SubjectModel subject = hasty_subject();
  subject.training_passes = 2;
  const RehearsedTinyStudy shared(options, subject);
  subject.training = simulation::Training::own;
  const RehearsedTinyStudy own(options, subject);
  subject.memory_noise = 0.4;
  const RehearsedTinyStudy forgetful(options, subject);
  constexpr int kStudies = 40;
  const auto share = [&](const RehearsedTinyStudy& study) {
    const PrecomputedPerception bank = study.bank(60, 12);
    const Answers answers = answers_of(study.planned(bank), kStudies, 1);
    return answers.correct / answers.trials;
  };
  // 4,000 answers each: binomial standard errors of 0.8 points, of a difference between people and
  // trainings of 1.5.
  const double with_own = share(own);
  CHECK(with_own < share(shared) + 0.045);
  CHECK(share(forgetful) < with_own - 0.02);
}

TEST_CASE("a study whose participants could never answer is refused") {
  TinyStudyOptions options{.side_px = 60,
                           .trials = R"({"explore_limit_s":1,"on_timeout":"no-response"})"};
  const RehearsedTinyStudy study(options);
  CHECK_THROWS_WITH(study.planned(study.servo),
                    holds_text("/explore_s") && holds_text("explore_limit_s"));
}

TEST_CASE("the two methods of a primary test must be named if there are three") {
  study::Study study;
  study.protocol = &study::identification::comparison();
  study.task = study.protocol->read(std::nullopt);
  for (const char* label : {"adaptive", "edge", "luminance"}) {
    study.methods.emplace_back();
    study.methods.back().label = label;
  }
  CHECK_THROWS_WITH(planning::identification::primary_test_of(study, {}), holds_text("--methods"));
  CHECK_THROWS_WITH(planning::identification::primary_test_of(study, MethodLabels{"edge", "edge"}),
                    names("--methods edge"));
  CHECK_THROWS_WITH(
      planning::identification::primary_test_of(study, MethodLabels{"edge", "adaptiv"}),
      names("adaptiv luminance"));
  const PrimaryTest test =
      planning::identification::primary_test_of(study, MethodLabels{"luminance", "adaptive"});
  CHECK(test.first == 2);
  CHECK(test.second == 0);
  study.protocol = &study::identification::classification();
  CHECK_THROWS_AS(
      planning::identification::primary_test_of(study, MethodLabels{"edge", "adaptive"}),
      UsageError);
}

}  // namespace
}  // namespace touchtrial
