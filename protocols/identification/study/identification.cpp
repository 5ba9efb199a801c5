#include "protocols/identification/study/identification.hpp"

#include "protocols/identification/study/block_order.hpp"
#include "protocols/identification/study/schedule.hpp"
#include "study/study.hpp"

namespace touchtrial::study::identification {
namespace {

/// The task of both protocols, which differ only in their methods.
class Identification final : public Task {
 public:
  explicit Identification(int min_methods) : min_methods_(min_methods) {}

  void check(const JsonValue& file, const Study& study) const override {
    if (static_cast<int>(study.methods.size()) < min_methods_) {
      file.refuse_below("/methods",
                        "has 1 entry, but the protocol comparison needs at least 2; add one, or "
                        "choose the protocol classification");
    }
    if (const auto obstacle = obstacle_to_order(study)) {
      file.refuse_below("/trials" + obstacle->key, obstacle->what);
    }
  }
  int scored_trials(const Study& study) const override {
    return static_cast<int>(study.classes.size()) * study.presented_methods() *
           study.trials.repeats;
  }
  std::string rule(const Study& study) const override { return rule_of_schedule(study); }
  TrialQuestion ask(const Study& study, const Place& /*place*/) const override {
    ChoiceQuestion question;
    for (const StudyClass& one : study.classes) {
      question.choices.push_back({one.label, static_cast<int>(question.choices.size())});
    }
    return {.question = question, .confidence_levels = study.session.confidence_levels};
  }
  std::unique_ptr<Order> order(const Study& study, const ScheduleDraw& draw) const override {
    return identifying_order(study, draw);
  }

 private:
  int min_methods_;
};

template <int min_methods>
std::shared_ptr<const Task> make_task(const std::optional<JsonValue>& /*section*/) {
  return std::make_shared<Identification>(min_methods);
}

constexpr Estimand kEstimands[] = {Estimand::mean_accuracy, Estimand::difference};

}  // namespace

const Protocol& classification() {
  static constexpr Protocol kProtocol{.name = "classification",
                                      .section = {},
                                      .read = make_task<1>,
                                      .all_methods = false,
                                      .estimands = kEstimands};
  return kProtocol;
}

const Protocol& comparison() {
  static constexpr Protocol kProtocol{.name = "comparison",
                                      .section = {},
                                      .read = make_task<2>,
                                      .min_methods = 2,
                                      .estimands = kEstimands};
  return kProtocol;
}

}  // namespace touchtrial::study::identification
